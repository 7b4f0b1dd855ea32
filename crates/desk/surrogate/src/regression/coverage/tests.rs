//! Tests of the interval: what defines it.

use super::{Coverage, NORMAL_97_5};

/// Its ends q are where the share found lies 1.96 deviations √(q (1 − q)/n) of a binomial from q.
#[test]
fn the_share_lies_on_the_edge_of_the_band_of_each_end() {
    for (n_inside, n) in [(9, 10), (18, 20), (95, 100), (0, 7), (7, 7), (1, 1)] {
        let found = Coverage::new(n_inside, n);
        let share = n_inside as f64 / n as f64;
        for end in found.interval.map(|end| end / 100.0) {
            let deviation = (end * (1.0 - end) / n as f64).sqrt();
            let away = (share - end).abs() - NORMAL_97_5 * deviation;
            // An end at 0 or 1 turns rounding into its root.
            assert!(away.abs() < 1e-7, "{n_inside} of {n}: {found:?}");
        }
        assert!(found.interval[0] <= found.share && found.share <= found.interval[1]);
    }
}
