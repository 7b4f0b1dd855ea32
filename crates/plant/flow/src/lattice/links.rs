//! Populations on their way from one cell to the next, for whoever exchanges them between two steps.

/// A population of a cell: the one that goes along a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Link {
    /// Cell along x, y, z (–).
    pub cell: [usize; 3],
    /// Number of the direction in the velocity set (–).
    pub direction: usize,
}

/// Which end of its way a [`Link`] names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The population left the cell in the last step.
    Leaving,
    /// It arrives at the cell in the next.
    Arriving,
}

/// An engine whose populations can be exchanged between two steps.
///
/// What leaves one cell arrives at its neighbour: both names may lead to the same place, or to two of which
/// only the one of the arriving population is read by the next step. So whoever writes first reads.
pub trait Exchange {
    /// Directions of the populations (cells a step).
    fn directions(&self) -> &'static [[i8; 3]];

    /// Where the populations of `links` lie after `n_steps` steps, and after any number that is even or odd
    /// as this one is.
    fn places(&self, way: Way, links: &[Link], n_steps: u64) -> Vec<usize>;

    /// On return `values` holds the populations at `places` (less those of air at rest), one each.
    ///
    /// # Panics
    /// When a place is none of this engine's.
    fn read(&mut self, places: &[usize], values: &mut [f32]);

    /// On return the populations at `places` are what `fill` gives: called with a number and room, it puts
    /// the population of that place and those of the next ones into the room, whichever thread asks.
    ///
    /// # Panics
    /// When a place is none of this engine's.
    fn write(&mut self, places: &[usize], fill: &Fill<'_>);
}

/// Gives populations from a number on, one for each value that there is room for.
pub type Fill<'a> = dyn Fn(usize, &mut [f32]) + Sync + 'a;
