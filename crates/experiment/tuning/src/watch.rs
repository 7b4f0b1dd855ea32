//! Watching a tuning under way.

use study::Observer;

/// Watches a tuning; every method may be left out.
pub trait Watch: Observer {
    /// Points are about to be run: `words` tells of each, the first is number `first`, from 0, of at most
    /// `n_runs`; improvement `expected_gain` (–) is expected of the first.
    fn proposed(
        &mut self,
        _first: usize,
        _n_runs: usize,
        _words: &[String],
        _expected_gain: Option<f64>,
    ) {
    }
}

impl Watch for study::Silent {}
