//! What a lattice is built from, and the assumptions that are checked before it is.

use super::atmosphere::{Atmosphere, AtmosphereError};
use super::scaling::Scaling;
use super::subgrid::{DEFAULT_SMAGORINSKY, Subgrid};
use crate::simd::Backend;
use basis::Vector3;
use thiserror::Error;

/// Fastest reference speed, in cells per step: Mach 0.26, where the compressibility error is a few percent.
const FASTEST_REFERENCE: f64 = 0.15;
/// Most viscous air, in cells² per step: relaxation time 2, beyond which the discretisation error dominates.
const MOST_VISCOUS: f64 = 0.5;
/// The same between open sides, whose slopes of the wind are told by a stress that is lost at a relaxation
/// time of one.
const MOST_VISCOUS_OPEN: f64 = 0.05;
/// Best conducting air, in cells² per step: steps of Adams and Bashforth grow from 1/12 on.
const MOST_CONDUCTING: f64 = 0.08;
/// Fewest cells between inlet and outlet, between open sides, or along a periodic x.
const FEWEST_CELLS: usize = 4;
/// Longest zone of raised viscosity before the outlet, in cells.
const LONGEST_SPONGE: usize = 24;
/// Share of the box's length that it may take, as a divisor.
const SPONGE_DIVISOR: usize = 10;

/// A box of air, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeSettings {
    /// Corner with the least coordinates, farm frame (m).
    pub origin: Vector3,
    /// Edge of a cell (m).
    pub spacing: f64,
    /// Cells along x, y, z (–).
    pub n_cells: [usize; 3],
    /// Duration of a step (s).
    pub interval: f64,
    /// Density of undisturbed air (kg/m³).
    pub air_density: f64,
    /// Kinematic viscosity of air (m²/s).
    pub kinematic_viscosity: f64,
    /// Speed that the box is laid out for, such as the free stream's (m/s).
    pub reference_speed: f64,
    /// What the air meets upstream and downstream.
    pub ends: Ends,
    /// What it meets at the sides.
    pub sides: Sides,
    /// What it meets at the ground and at the top.
    pub ground: Ground,
    /// Acceleration of all air, as by a pressure gradient (m/s²).
    pub acceleration: Vector3,
    /// Model of the eddies that the grid does not resolve.
    pub subgrid: Subgrid,
    /// Rotation, temperature and what comes with it; none where the air is alike everywhere.
    pub atmosphere: Option<Atmosphere>,
    /// Velocity set.
    pub stencil: Stencil,
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
    /// Instruction set; the fastest that the machine has when absent.
    pub backend: Option<Backend>,
}

impl LatticeSettings {
    /// Real air between inlet and outlet, slip sides, slip ground, and the defaults of everything else.
    pub fn new(
        origin: Vector3,
        spacing: f64,
        n_cells: [usize; 3],
        interval: f64,
        reference_speed: f64,
    ) -> Self {
        Self {
            origin,
            spacing,
            n_cells,
            interval,
            air_density: 1.225,
            kinematic_viscosity: 1.5e-5,
            reference_speed,
            ends: Ends::InletOutlet,
            sides: Sides::Periodic,
            ground: Ground::Slip,
            acceleration: Vector3::ZERO,
            subgrid: Subgrid::smagorinsky(DEFAULT_SMAGORINSKY),
            atmosphere: None,
            stencil: Stencil::D3Q19,
            threads: None,
            backend: None,
        }
    }

    /// Between SI and lattice units.
    pub fn scaling(&self) -> Scaling {
        Scaling::new(self.origin, self.spacing, self.interval, self.air_density)
    }

    /// Cells in all (–).
    pub fn cells(&self) -> usize {
        self.n_cells.iter().product()
    }

    /// Cells before the outlet in which a raised viscosity stills eddies (–).
    pub fn sponge_cells(&self) -> usize {
        match self.ends {
            Ends::InletOutlet => (self.n_cells[0] / SPONGE_DIVISOR).min(LONGEST_SPONGE),
            Ends::Periodic => 0,
        }
    }

    /// Reference speed in cells per step (–).
    pub fn lattice_speed(&self) -> f64 {
        self.reference_speed * self.interval / self.spacing
    }

    /// Checks what the method assumes.
    ///
    /// # Errors
    /// [`LatticeError`] names the quantity, its value and what would do.
    pub fn check(&self) -> Result<(), LatticeError> {
        let positive = [
            ("spacing", self.spacing),
            ("interval", self.interval),
            ("air density", self.air_density),
            ("kinematic viscosity", self.kinematic_viscosity),
        ];
        for (name, value) in positive {
            if !(value.is_finite() && value > 0.0) {
                return Err(LatticeError::NotPositive { name, value });
            }
        }
        let constant = self.subgrid.constant;
        let not_negative =
            [("reference speed", self.reference_speed), ("subgrid constant", constant)];
        for (name, value) in not_negative {
            if !(value.is_finite() && value >= 0.0) {
                return Err(LatticeError::NotPositive { name, value });
            }
        }
        self.check_cells()?;
        let viscosity = self.check_motion()?;
        if let Ground::WallStress { roughness_length } = self.ground {
            // The logarithmic law is applied at the centre of the lowest cell.
            let highest = 0.5 * self.spacing / std::f64::consts::E;
            if !(roughness_length > 0.0 && roughness_length <= highest) {
                return Err(LatticeError::Roughness { roughness_length, highest });
            }
        }
        self.check_atmosphere(viscosity)?;
        if self.threads == Some(0) {
            return Err(LatticeError::NoThreads);
        }
        match self.backend {
            Some(backend) if !backend.is_available() => {
                Err(LatticeError::MissingBackend { backend })
            }
            _ => Ok(()),
        }
    }

    /// Checks the numbers of cells.
    fn check_cells(&self) -> Result<(), LatticeError> {
        for (axis, (name, n_cells)) in ["x", "y", "z"].into_iter().zip(self.n_cells).enumerate() {
            let ends = axis == 0 || (axis == 1 && self.sides == Sides::Open);
            let needed = if ends { FEWEST_CELLS } else { 1 };
            if n_cells < needed {
                return Err(LatticeError::TooFewCells { axis: name, n_cells, needed });
            }
        }
        Ok(())
    }

    /// Checks wind, viscosity and sides; gives the viscosity (cells² a step).
    fn check_motion(&self) -> Result<f64, LatticeError> {
        if self.sides == Sides::Open && self.ends == Ends::Periodic {
            return Err(LatticeError::OpenSides);
        }
        let lattice_speed = self.lattice_speed();
        if lattice_speed > FASTEST_REFERENCE {
            return Err(LatticeError::TooFast {
                speed: self.reference_speed,
                lattice_speed,
                longest: FASTEST_REFERENCE * self.spacing / self.reference_speed,
            });
        }
        let viscosity = self.scaling().to_lattice_viscosity(self.kinematic_viscosity);
        let most = match self.sides {
            Sides::Open => MOST_VISCOUS_OPEN,
            Sides::Periodic | Sides::Slip => MOST_VISCOUS,
        };
        if viscosity > most {
            return Err(LatticeError::TooViscous {
                viscosity,
                most,
                longest: most * self.spacing * self.spacing / self.kinematic_viscosity,
            });
        }
        Ok(viscosity)
    }

    /// Checks the atmosphere, if there is one, in air of `viscosity` (cells² a step).
    fn check_atmosphere(&self, viscosity: f64) -> Result<(), LatticeError> {
        let Some(atmosphere) = &self.atmosphere else { return Ok(()) };
        atmosphere.check(self.interval, self.ground)?;
        let conducted = viscosity / atmosphere.prandtl;
        if conducted > MOST_CONDUCTING {
            return Err(LatticeError::TooViscous {
                viscosity: conducted,
                most: MOST_CONDUCTING,
                longest: MOST_CONDUCTING / conducted * self.interval,
            });
        }
        Ok(())
    }
}

/// Upstream and downstream boundary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Wind enters at the least x and leaves at the greatest.
    InletOutlet,
    /// What leaves downstream enters upstream.
    Periodic,
}

/// Lateral boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// What leaves on one side enters on the other.
    Periodic,
    /// Air slips along them.
    Slip,
    /// Wind enters and leaves as the inflow has it there: at each height and time it enters through a side by
    /// which the inflow's mean along it blows in, and leaves where that blows out.
    Open,
}

/// Lower and upper boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ground {
    /// Air slips along the ground and along the top.
    Slip,
    /// The ground holds the air back after the logarithmic law; air slips along the top.
    WallStress {
        /// Roughness length z₀ (m).
        roughness_length: f64,
    },
    /// The ground holds the air fast, as it does where every eddy is resolved; air slips along the top.
    NoSlip,
    /// Ground and top both hold the air fast.
    Plates,
    /// No ground: what leaves through the top enters from below.
    Periodic,
}

/// Velocity set of the lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stencil {
    /// Rest, faces and edges of the cube: for wakes, which are young when they leave the box. Wind that
    /// carries eddies over hundreds of their own size feeds them (docs/validation/atmosphere.md).
    D3Q19,
    /// Rest, faces, edges and corners of the cube, at twice the cost: for eddies that live long.
    D3Q27,
}

impl Stencil {
    /// Populations of a cell (–).
    pub fn n_directions(self) -> u64 {
        match self {
            Self::D3Q19 => 19,
            Self::D3Q27 => 27,
        }
    }
}

/// Why a lattice cannot be built with these settings.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LatticeError {
    /// A quantity that must be positive is not.
    #[error("the {name} must be a positive number, not {value}")]
    NotPositive {
        /// Quantity.
        name: &'static str,
        /// Its value, in SI units.
        value: f64,
    },
    /// Too few cells along an axis.
    #[error("{n_cells} cells along {axis} are too few, at least {needed} are needed")]
    TooFewCells {
        /// Axis.
        axis: &'static str,
        /// Cells given (–).
        n_cells: usize,
        /// Fewest cells (–).
        needed: usize,
    },
    /// Open sides between periodic ends.
    #[error(
        "open sides need an inlet and an outlet: what comes in through a side has not passed the ends before; use those, or periodic sides"
    )]
    OpenSides,
    /// The wind moves too far in a step.
    #[error(
        "at {speed} m/s the wind moves {lattice_speed:.3} cells a step, the maximum is {FASTEST_REFERENCE}; use a step of at most {longest:.4} s"
    )]
    TooFast {
        /// Reference speed (m/s).
        speed: f64,
        /// Cells per step (–).
        lattice_speed: f64,
        /// Longest step (s).
        longest: f64,
    },
    /// The air is too viscous for the step, or conducts too well.
    #[error(
        "the viscosity, or the diffusivity of temperature, is {viscosity:.3} cells² a step, the maximum is {most}; use a step of at most {longest:.4} s"
    )]
    TooViscous {
        /// Cells² per step (–).
        viscosity: f64,
        /// Most that there may be (cells² per step).
        most: f64,
        /// Longest step (s).
        longest: f64,
    },
    /// The roughness does not fit below the lowest cell centre.
    #[error(
        "a roughness length of {roughness_length} m does not suit these cells: it must lie between 0 and {highest:.3} m"
    )]
    Roughness {
        /// Roughness length (m).
        roughness_length: f64,
        /// Greatest that the logarithmic law allows on this grid (m).
        highest: f64,
    },
    /// The atmosphere cannot be.
    #[error(transparent)]
    Atmosphere(#[from] AtmosphereError),
    /// No thread to run on.
    #[error("at least one thread is needed")]
    NoThreads,
    /// The requested instruction set is not available.
    #[error("this machine does not have the instructions of the {backend:?} back-end")]
    MissingBackend {
        /// Back-end given.
        backend: Backend,
    },
    /// The memory is not there.
    #[error(
        "{n_cells} cells need {bytes} bytes of memory, which the system refuses; use fewer cells"
    )]
    Memory {
        /// Cells in all (–).
        n_cells: usize,
        /// Bytes requested.
        bytes: usize,
    },
}
