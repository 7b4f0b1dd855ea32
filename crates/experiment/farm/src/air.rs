//! The air of a farm: solved, or prescribed.

use basis::{PointForce, Vector3};
use flow::inflow::PrescribedWind;
use flow::lattice::Lattice;
use flow::{FlowError, FlowSolver, WindField};

/// One of the ways to have wind.
pub enum Air {
    /// Solved: it feels the rotors.
    Lattice(Box<Lattice>),
    /// Prescribed: it blows as it is told.
    Prescribed(Box<PrescribedWind>),
}

impl Air {
    /// The lattice, where the air is solved: planes and volumes come from it.
    pub fn lattice(&self) -> Option<&Lattice> {
        match self {
            Self::Lattice(lattice) => Some(lattice),
            Self::Prescribed(_) => None,
        }
    }
}

impl WindField for Air {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        match self {
            Self::Lattice(air) => air.sample(positions, velocities),
            Self::Prescribed(air) => air.sample(positions, velocities),
        }
    }
}

impl FlowSolver for Air {
    fn advance(&mut self, duration: f64, forces: &[PointForce]) -> Result<(), FlowError> {
        match self {
            Self::Lattice(air) => air.advance(duration, forces),
            Self::Prescribed(air) => air.advance(duration, forces),
        }
    }

    fn resolves_induction(&self) -> bool {
        match self {
            Self::Lattice(air) => air.resolves_induction(),
            Self::Prescribed(air) => air.resolves_induction(),
        }
    }
}
