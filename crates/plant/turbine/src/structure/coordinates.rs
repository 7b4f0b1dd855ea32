//! Generalised coordinates: six degrees of freedom that all blades share, three of each blade.

use basis::blades::MAXIMUM_BLADES;
use serde::{Deserialize, Serialize};

/// Coordinates that all blades share: tower, generator, drive train.
pub(super) const N_SHARED: usize = 6;
/// Modes of the tower: two fore-aft, two side-to-side.
pub(super) const N_TOWER: usize = 4;
/// Modes of each blade: two flapwise, one edgewise.
pub(super) const N_MODES: usize = 3;
/// Index of the generator's azimuth among the shared coordinates.
pub(super) const GENERATOR: usize = 4;
/// Index of the drive train's twist among the shared coordinates.
pub(super) const TORSION: usize = 5;

/// One value for each degree of freedom.
///
/// Modal coordinates are displacements of the tip (m, for a blade without twist), angles are on the low-speed
/// side (rad); velocities and accelerations use the same order, per second and per second squared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Coordinates {
    /// Tower fore-aft 1 and 2 (m, downwind), side-to-side 1 and 2 (m, to the left looking downwind), azimuth
    /// of the generator (rad), rotor ahead of the generator (rad).
    pub shared: [f64; N_SHARED],
    /// Flapwise 1 and 2 (m, downwind), edgewise 1 (m, towards the trailing edge) of each blade.
    pub blades: [[f64; N_MODES]; MAXIMUM_BLADES],
}

impl Coordinates {
    /// `self` + `factor` × `other`.
    pub(super) fn plus(mut self, factor: f64, other: &Self) -> Self {
        for (value, change) in self.shared.iter_mut().zip(&other.shared) {
            *value += factor * change;
        }
        for (values, changes) in self.blades.iter_mut().zip(&other.blades) {
            for (value, change) in values.iter_mut().zip(changes) {
                *value += factor * change;
            }
        }
        self
    }

    /// The tower's own coordinates (m).
    pub(super) fn tower(&self) -> [f64; N_TOWER] {
        std::array::from_fn(|mode| self.shared[mode])
    }
}

/// A degree of freedom; for blades, the same one on all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DegreeOfFreedom {
    /// First fore-aft mode of the tower.
    TowerForeAft1,
    /// Second fore-aft mode of the tower.
    TowerForeAft2,
    /// First side-to-side mode of the tower.
    TowerSideToSide1,
    /// Second side-to-side mode of the tower.
    TowerSideToSide2,
    /// Azimuth of the generator.
    Generator,
    /// Torsion of the drive train.
    DriveTrain,
    /// First flapwise mode of all blades.
    Flap1,
    /// Second flapwise mode of all blades.
    Flap2,
    /// First edgewise mode of all blades.
    Edge1,
}

impl DegreeOfFreedom {
    /// All of them, in the order of [`Coordinates`].
    pub const ALL: [Self; N_SHARED + N_MODES] = [
        Self::TowerForeAft1,
        Self::TowerForeAft2,
        Self::TowerSideToSide1,
        Self::TowerSideToSide2,
        Self::Generator,
        Self::DriveTrain,
        Self::Flap1,
        Self::Flap2,
        Self::Edge1,
    ];

    /// Its name in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::TowerForeAft1 => "tower fore-aft 1",
            Self::TowerForeAft2 => "tower fore-aft 2",
            Self::TowerSideToSide1 => "tower side-to-side 1",
            Self::TowerSideToSide2 => "tower side-to-side 2",
            Self::Generator => "generator",
            Self::DriveTrain => "drive-train torsion",
            Self::Flap1 => "blade flapwise 1",
            Self::Flap2 => "blade flapwise 2",
            Self::Edge1 => "blade edgewise 1",
        }
    }
}

/// Which degrees of freedom are locked: no acceleration, so that what moves keeps its speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Locks {
    pub(super) shared: [bool; N_SHARED],
    pub(super) modes: [bool; N_MODES],
}

impl Locks {
    /// Exactly `degrees` locked.
    pub(super) fn of(degrees: &[DegreeOfFreedom]) -> Self {
        let mut locks = Self::default();
        for (index, degree) in DegreeOfFreedom::ALL.iter().enumerate() {
            let held = degrees.contains(degree);
            match index.checked_sub(N_SHARED) {
                None => locks.shared[index] = held,
                Some(mode) => locks.modes[mode] = held,
            }
        }
        locks
    }
}
