//! What tasks cost, from some of them.

use super::*;

#[test]
fn samples_are_spread_over_all_tasks() {
    let sample = |wall_time, memory, disk| study::Sample { wall_time, memory, disk, series: 5 };
    let samples = [sample(Some(2.0), 10, 70), sample(None, 30, 40), sample(Some(4.0), 20, 60)];
    let times = |seconds: &[f64]| plan::Times {
        seconds: seconds.to_owned(),
        n_sampled: 3,
        made_whole: false,
    };
    // Ten tasks of 3 s in four rounds of three, on two threads each.
    let cost = plan::spread(&samples, &times(&[2.0, 4.0]), 10, 3, 2, formats::case::Keep::All);
    assert_eq!((cost.cpu_time, cost.wall_time), (Some(60.0), Some(12.0)));
    assert_eq!((cost.memory, cost.passing, cost.disk), (90, 210, 10 * (70 + (8 << 10))));
    let unknown = plan::spread(&samples[1..2], &times(&[]), 10, 3, 2, formats::case::Keep::Series);
    assert_eq!((unknown.cpu_time, unknown.wall_time), (None, None));
    assert_eq!(unknown.disk, 10 * (5 + (8 << 10)));
}
