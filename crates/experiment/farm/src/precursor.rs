//! A precursor: a periodic box of atmosphere that is spun up, and from which planes of wind are taken for
//! studies.

mod air_box;
mod companion;
mod driving;
mod faults;
mod hub_control;
mod left_behind;
mod plan;
mod start;

pub use air_box::{AirBox, Drive, hub_wind};
pub use companion::{Accompanied, Companion};
use flow::lattice::SubgridModel;
pub use hub_control::HubControl;
pub use plan::PrecursorPlan;

/// What a precursor is made of, in SI units and radians.
///
/// The box's x axis points east, y north and z up.
#[derive(Clone, Debug, PartialEq)]
pub struct Precursor {
    /// Its name.
    pub name: String,
    /// What it is for, in a line.
    pub description: Option<String>,
    /// Number that the first noise follows from.
    pub seed: u64,
    /// The box of cells.
    pub domain: PeriodicBox,
    /// The air in it.
    pub air: AirColumn,
    /// How long it lasts.
    pub time: PrecursorTime,
    /// What is recorded.
    pub planes: WantedPlanes,
}

/// A box of cells that is periodic to all sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicBox {
    /// Length along x, y, z (m).
    pub size: [f64; 3],
    /// Edge of a cell (m).
    pub cell: f64,
    /// Model of unresolved eddies.
    pub subgrid: SubgridModel,
    /// Threads; all cores when absent.
    pub threads: Option<usize>,
}

/// The air of a box: what drives it, and its temperature over height at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirColumn {
    /// Latitude (rad), positive on the northern half.
    pub latitude: f64,
    /// Roughness length z₀ of the ground (m).
    pub roughness_length: f64,
    /// Speed of the geostrophic wind (m/s), where that is given.
    pub geostrophic_wind: Option<f64>,
    /// Where it comes from (rad), clockwise from north; west when absent.
    pub geostrophic_direction: Option<f64>,
    /// Speed of the mean wind at hub height (m/s), where that is given in its place and held.
    pub hub_wind: Option<f64>,
    /// Where that comes from (rad), clockwise from north; west when absent.
    pub hub_direction: Option<f64>,
    /// Potential temperature below the inversion (K).
    pub temperature: f64,
    /// Where the inversion begins (m).
    pub inversion_height: f64,
    /// Rise of temperature through it (K).
    pub inversion_strength: f64,
    /// Its depth (m).
    pub inversion_depth: f64,
    /// Rise of temperature above it (K/m).
    pub lapse_rate: f64,
    /// Kinematic heat flux through the ground, upwards (K m/s); none where it is not set.
    pub heat_flux: Option<f64>,
    /// How fast the ground cools (K/s); none where it has no temperature of its own.
    pub cooling_rate: Option<f64>,
    /// Where waves begin to be damped (m); three quarters of the box when absent.
    pub damping_from: Option<f64>,
    /// Rate of that at the top (1/s).
    pub damping_rate: f64,
}

/// How long a precursor lasts, and in which steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrecursorTime {
    /// Time before anything is recorded (s).
    pub spin_up: f64,
    /// Time that is recorded after it (s).
    pub record: f64,
    /// Step (s); chosen when absent.
    pub step: Option<f64>,
    /// Time between two statistics (s).
    pub statistics_interval: f64,
}

/// Planes of wind to be recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WantedPlanes {
    /// Height whose mean wind they stand across (m).
    pub hub_height: f64,
    /// Diameter of the rotors that they are for (m), where it is known.
    pub rotor_diameter: Option<f64>,
    /// Their width (m); the shorter side of the box when absent.
    pub width: Option<f64>,
    /// Their height (m); that of the inversion when absent.
    pub height: Option<f64>,
    /// Time between two of them (s); half a cell's crossing when absent.
    pub interval: Option<f64>,
}

impl Precursor {
    /// Where damping begins (m).
    pub fn damping_from(&self) -> f64 {
        self.air.damping_from.unwrap_or(0.75 * self.domain.size[2])
    }

    /// Highest point of the inversion (m).
    pub fn inversion_top(&self) -> f64 {
        self.air.inversion_height + self.air.inversion_depth
    }

    /// Width of the planes (m).
    pub fn plane_width(&self) -> f64 {
        let [length, width, _] = self.domain.size;
        self.planes.width.unwrap_or(length.min(width))
    }

    /// Height of the planes (m).
    pub fn plane_height(&self) -> f64 {
        self.planes.height.unwrap_or(self.air.inversion_height)
    }
}
