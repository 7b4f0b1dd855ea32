//! Which phases figures show.

use basis::angle::wrap_to_half_turn;
use basis::records::PhaseAverages;
use std::f64::consts::TAU;

/// Phases that a figure shows beside the mean (–).
const N_PHASES: usize = 5;

/// Numbers of the bins that a figure shows, spread over a cycle of the helix, or else a revolution; none of
/// them empty.
pub(crate) fn shown(head: &PhaseAverages) -> Vec<usize> {
    let n = head.bins.len();
    if n < 2 {
        return Vec::new();
    }
    let advance = |index: usize| {
        let pair = head.bins[index].helix.zip(head.bins[index + 1].helix);
        pair.map_or(0.0, |(a, b)| wrap_to_half_turn(b - a).abs())
    };
    // Up to a rounding of the azimuths.
    let is_within = |turned: &mut f64, index: usize| {
        let before = *turned;
        *turned += if index + 1 < n { advance(index) } else { 0.0 };
        (before < TAU - 1e-3).then_some(index)
    };
    let cycle = (0..n).scan(0.0, is_within);
    let sound: Vec<usize> = cycle.filter(|index| head.bins[*index].n_instants > 0).collect();
    let n_shown = sound.len().min(N_PHASES);
    (0..n_shown).map(|place| sound[place * sound.len() / n_shown]).collect()
}
