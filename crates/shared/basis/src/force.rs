//! How machines push on the air.

use crate::Vector3;

/// A force on the air, spread over a Gaussian of width `smearing_length`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce {
    /// Where it acts, farm frame (m).
    pub position: Vector3,
    /// Force of the machine **on the air**, farm frame (N).
    pub force: Vector3,
    /// Gaussian width ε (m): the force density is f exp(−r²/ε²) / (ε³ π^{3/2}).
    pub smearing_length: f64,
    /// Turbine that it comes from: its place among the farm's machines, 0 for a turbine on its own (–).
    pub turbine: usize,
    /// The bound vortex behind it; none for a body without circulation, such as a tower or a nacelle, and in
    /// air that does not ask for bound vortices.
    pub bound: Option<BoundVortex>,
    /// Radius of the disc across which it acts (m), for air that follows the wakes of bodies: that of a
    /// nacelle. None for a blade element, and for a body whose wake is not followed, such as a tower.
    pub disc_radius: Option<f64>,
}

/// Element of a lifting line: what a solver that sheds vorticity needs beside the force.
///
/// Kutta-Joukowski, with V the wind relative to the element (m/s) and Γ⃗ = Γ · `along`: the lift of the
/// element on the air is −ρ V × Γ⃗, what is left of [`PointForce::force`] is drag, along V. Γ is counted
/// right-handed about the direction from root to tip, so that it is positive where lift drives a rotor that
/// turns clockwise seen from upwind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundVortex {
    /// Blade, from 0 (–).
    pub blade: usize,
    /// Place along the blade, from 0 at the root (–).
    pub station: usize,
    /// Circulation Γ, the mean over the interval in which the force acts (m²/s).
    pub circulation: f64,
    /// From the element's inner to its outer end, farm frame (m).
    pub along: Vector3,
    /// Share of it that lies inside of the force's position (–): about a half.
    pub inner_share: f64,
    /// Where the force's position has come to at the end of the interval in which it acts, farm frame (m).
    pub position_after: Vector3,
    /// As `along`, at the end of that interval (m).
    pub along_after: Vector3,
}

/// How the wind at a turbine's blade elements answers to their circulation, where the air feels bound
/// vortices and the answer comes at once: what is bound and what leaves the blades in this very interval.
///
/// The wind at element i is what was sampled there plus the sum over j of `influence[i, j]` times
/// (Γⱼ − `circulations[j]`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer<'a> {
    /// Circulation of each element with which the wind was sampled, blade after blade from root to tip
    /// (m²/s).
    pub circulations: &'a [f64],
    /// Wind at an element (row) per unit of circulation of another (column), farm frame (1/m).
    pub influence: &'a [Vector3],
    /// What the wake of the turbine's own nacelle brings about where the nacelle stands (m/s): its drag
    /// coefficient is that of the wind without it.
    pub at_nacelle: Vector3,
}

impl PointForce {
    /// The force (N) of a body without circulation at `position` (m), spread over `smearing_length` (m).
    pub fn of_body(position: Vector3, force: Vector3, smearing_length: f64) -> Self {
        Self { position, force, smearing_length, turbine: 0, bound: None, disc_radius: None }
    }
}
