//! Where a box of finer cells is joined to the grid around it.

/// Which ends, the first and the last, of each axis lie in the air of a grid around.
pub(crate) type Faces = [[bool; 2]; 3];

/// What a grid must know of where it lies in others.
#[derive(Clone, Debug)]
pub(crate) struct Joint {
    pub(crate) faces: Faces,
    /// Height of its lowest cells' lower sides above the ground (m).
    pub(crate) floor: f64,
    /// Height where the outermost grid ends (m).
    pub(crate) top: f64,
    /// What lies in a grid around has levels that follow from those of that one: the temperature of each (K
    /// above the reference), as damping goes to it.
    pub(crate) targets: Option<Vec<f32>>,
}

impl Joint {
    /// That of a grid of `height` (m) that lies in no other.
    pub(crate) fn none(height: f64) -> Self {
        Self { faces: Faces::default(), floor: 0.0, top: height, targets: None }
    }
}
