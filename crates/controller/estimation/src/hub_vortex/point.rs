//! Points of a scan that are looked at, and their middle.

/// A point that is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Place: left and up (m).
    pub(super) place: [f64; 2],
    /// Speed along the line of sight, or the axial wind that makes it (m/s).
    pub(super) speed: f64,
    /// When it was measured (s).
    pub(super) time: f64,
}

/// The middle of `values`, which are put in another order; of two in the middle their mean. There must be
/// one.
pub(super) fn median(values: &mut [f64]) -> f64 {
    let (middle, is_odd) = (values.len() / 2, values.len() % 2 == 1);
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let lower = if is_odd { *upper } else { below.iter().copied().fold(f64::MIN, f64::max) };
    0.5 * (lower + *upper)
}
