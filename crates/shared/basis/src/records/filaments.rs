//! Vortices of wakes at one instant, as nodes and straight pieces between them.

/// All vortices of all wakes at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filaments {
    /// Instant (s).
    pub time: f64,
    /// Nodes, farm frame (m).
    pub nodes: Vec<[f32; 3]>,
    /// Straight pieces between them.
    pub pieces: Vec<Piece>,
}

/// A straight piece of vortex between two nodes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Places of its nodes: where it begins and where it ends (–).
    pub ends: [u32; 2],
    /// What it is a piece of.
    pub kind: PieceKind,
    /// Turbine that it comes from, by its place among those of the run, from 0 (–).
    pub turbine: u32,
    /// Blade that it comes from, from 0 (–).
    pub blade: u32,
    /// Where on the blade it comes from: distance from the root over the blade's length (–).
    pub span: f32,
    /// Time since it left the blade (s).
    pub age: f32,
    /// Circulation, right-handed about the way from begin to end (m²/s).
    pub circulation: f32,
    /// Radius of its core (m).
    pub core_radius: f32,
}

/// What a piece of vortex is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PieceKind {
    /// Along the wake, of what differs between neighbouring blade elements.
    Trailing,
    /// Across the wake, of what changes in time.
    Shed,
    /// On the blade itself.
    Bound,
}

impl PieceKind {
    /// All of them, each at the place of its number.
    pub const ALL: [Self; 3] = [Self::Trailing, Self::Shed, Self::Bound];

    /// Its number in files: 0 trailing, 1 shed, 2 bound.
    pub fn number(self) -> u8 {
        self as u8
    }
}
