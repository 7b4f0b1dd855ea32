//! Bins of rotor azimuth and helix azimuth.

use super::PhaseError;
use basis::Sense;
use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use basis::records::PhaseBin;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Bins of phase, in the order in which they follow one another in time.
///
/// Each revolution of the rotor has `n_azimuths` bins. With a helix, bins go on over as many revolutions as
/// `n_cycles` of its cycles take, and each has a window of helix azimuth about the value that it has there.
/// Windows may be wider than the distance between them: then they overlap, and an instant counts in each.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bins {
    n_azimuths: usize,
    n_revolutions: usize,
    helix: Option<Windows>,
}

/// Windows of helix azimuth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Windows {
    n_cycles: usize,
    /// Whether the helix azimuth grows (ccw) or shrinks (cw) with time: 1 or −1.
    way: f64,
    /// Width (rad).
    width: f64,
}

/// Azimuth of the helix (rad, (−π, π]): the angle of the rotor's moment, or of the pitch that makes it, from
/// its yaw towards its `tilt` component (one unit). It grows in a ccw helix and shrinks in a cw one.
///
/// Source: van der Hoek et al. (2024), Eq. 6, in all four quadrants.
pub fn helix_azimuth(tilt: f64, yaw: f64) -> f64 {
    tilt.atan2(yaw)
}

/// The fewest helix cycles, up to `most`, whose time is nearest to a whole number of revolutions, where the
/// rotor turns `ratio` times a cycle: nearer counts where it is by more than a hundredth of a revolution.
pub fn cycles_that_close(ratio: f64, most: usize) -> usize {
    let off = |n: usize| {
        let turns = ratio * n as f64;
        (turns - turns.round()).abs()
    };
    (1..=most.max(1)).fold(1, |best, n| if off(n) < off(best) - 0.01 { n } else { best })
}

impl Bins {
    /// Windows of the published slices (rad), 40°.
    pub const WIDTH: f64 = 40.0 / 180.0 * PI;
    /// Bins a revolution of the published slices (–), 30° each.
    pub const N_AZIMUTHS: usize = 12;
    /// Helix cycles of the published slices (–).
    pub const N_CYCLES: usize = 3;

    /// `n_azimuths` bins of rotor azimuth, blade 1 up at the beginning of the first.
    ///
    /// # Errors
    /// [`PhaseError::NoBins`].
    pub fn of_rotor(n_azimuths: usize) -> Result<Self, PhaseError> {
        if n_azimuths == 0 {
            return Err(PhaseError::NoBins { n_azimuths });
        }
        Ok(Self { n_azimuths, n_revolutions: 1, helix: None })
    }

    /// Bins of `n_azimuths` a revolution over `n_cycles` of a helix of `sense`, each of which takes `ratio`
    /// revolutions; windows of helix azimuth are `width` (rad) wide.
    ///
    /// Their number is the whole number nearest to `ratio` × `n_cycles`, times `n_azimuths`.
    /// Source: van der Hoek et al. (2024), §3.2: 168 and 204 bins of 12 azimuths over 3 cycles.
    ///
    /// # Errors
    /// [`PhaseError::NoBins`], [`PhaseError::Ratio`], [`PhaseError::Width`].
    pub fn of_helix(
        n_azimuths: usize,
        ratio: f64,
        n_cycles: usize,
        sense: Sense,
        width: f64,
    ) -> Result<Self, PhaseError> {
        let of_rotor = Self::of_rotor(n_azimuths)?;
        let revolutions = (ratio * n_cycles as f64).round();
        if n_cycles == 0 || !(1.0..1e6).contains(&revolutions) {
            return Err(PhaseError::Ratio { ratio, n_cycles });
        }
        if !(width > 0.0 && width <= TAU * (1.0 + 1e-12)) {
            return Err(PhaseError::Width { width_deg: width.to_degrees() });
        }
        let way = if sense == Sense::CounterClockwise { 1.0 } else { -1.0 };
        let helix = Some(Windows { n_cycles, way, width });
        Ok(Self { n_revolutions: revolutions as usize, helix, ..of_rotor })
    }

    /// Bins (–).
    pub fn len(&self) -> usize {
        self.n_azimuths * self.n_revolutions
    }

    /// Whether there is no bin; there always is.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Width of a bin in rotor azimuth (rad).
    pub fn rotor_width(&self) -> f64 {
        TAU / self.n_azimuths as f64
    }

    /// Width of a window of helix azimuth (rad); none where the helix plays no part.
    pub fn helix_width(&self) -> Option<f64> {
        self.helix.map(|windows| windows.width)
    }

    /// Helix cycles that the bins go over (–); none where the helix plays no part.
    pub fn n_cycles(&self) -> Option<usize> {
        self.helix.map(|windows| windows.n_cycles)
    }

    /// Revolutions of the rotor that the bins go over (–).
    pub fn n_revolutions(&self) -> usize {
        self.n_revolutions
    }

    /// Bins that an instant falls into, on the average over all phases (–).
    pub fn overlap(&self) -> f64 {
        self.helix.map_or(1.0, |windows| windows.width / TAU * self.n_revolutions as f64)
    }

    /// Rotor azimuth and helix azimuth at the middle of bin number `index` (rad, [0, 2π)).
    pub fn middle(&self, index: usize) -> (f64, Option<f64>) {
        let in_turn = (index % self.n_azimuths) as f64 + 0.5;
        let rotor = in_turn * self.rotor_width();
        let turns = (index / self.n_azimuths) as f64 + in_turn / self.n_azimuths as f64;
        let helix = self.helix.map(|windows| {
            let cycles = windows.n_cycles as f64 * turns / self.n_revolutions as f64;
            wrap_to_turn(windows.way * TAU * cycles)
        });
        (rotor, helix)
    }

    /// Bin number `index`, with so many instants and visits.
    pub(super) fn bin(&self, index: usize, n_instants: u64, n_visits: u64) -> PhaseBin {
        let (rotor, helix) = self.middle(index);
        PhaseBin { rotor, helix, n_instants, n_visits }
    }

    /// The bins of an instant at the azimuths `rotor` and `helix` (rad).
    pub fn of_instant(&self, rotor: f64, helix: f64) -> impl Iterator<Item = usize> + use<> {
        let bins = *self;
        let slot = (wrap_to_turn(rotor) / bins.rotor_width()) as usize;
        let slot = slot.min(bins.n_azimuths - 1);
        let numbers = (0..bins.n_revolutions).map(move |turn| turn * bins.n_azimuths + slot);
        numbers.filter(move |index| match (bins.helix, bins.middle(*index).1) {
            (Some(windows), Some(middle)) => {
                let away = wrap_to_half_turn(helix - middle);
                (-0.5 * windows.width..0.5 * windows.width).contains(&away) || windows.width >= TAU
            }
            _ => true,
        })
    }
}
