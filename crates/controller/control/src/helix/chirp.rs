//! A helix whose frequency changes evenly with time.

use crate::excitation::excitation_rate;
use crate::kind::Site;
use basis::keys::{Objection, Values};
use serde::{Deserialize, Serialize};

/// An excitation rate that goes evenly from that of the helix at time zero to another, and stays there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Chirp {
    /// Rate at the end and from then on (rad/s).
    pub last_rate: f64,
    /// How long it takes (s), above zero.
    pub duration: f64,
}

impl Chirp {
    /// Angle (rad) that has been turned at `time` (s) since time zero, where the rate was `first_rate`
    /// (rad/s) before and at time zero.
    pub(super) fn angle(&self, first_rate: f64, time: f64) -> f64 {
        let Self { last_rate, duration } = *self;
        let within = time.clamp(0.0, duration);
        let swept = within * (first_rate + 0.5 * (last_rate - first_rate) * within / duration);
        swept + first_rate * time.min(0.0) + last_rate * (time - duration).max(0.0)
    }

    /// What `values` of a helix say at `site`; none where its frequency stays.
    pub(super) fn of(values: &Values, site: &Site) -> Option<Self> {
        let strouhal = values.optional_number("strouhal_last")?;
        let last_rate = excitation_rate(strouhal, site.wind_speed, site.diameter);
        Some(Self { last_rate, duration: values.optional_number("strouhal_change_time")? })
    }
}

/// What about a chirp in `values` cannot be: one key without the other.
pub(super) fn objections(values: &Values) -> Option<Objection> {
    let (key, missing) = match (values.has("strouhal_last"), values.has("strouhal_change_time")) {
        (true, false) => ("strouhal_last", "strouhal_change_time"),
        (false, true) => ("strouhal_change_time", "strouhal_last"),
        _ => return None,
    };
    Some(Objection {
        key: Some(key),
        message: format!("has no effect without `{missing}`"),
        label: "alone",
        fix: "a frequency that changes needs `strouhal_last`, to which it goes, and `strouhal_change_time`, the time that it takes (s)".to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_the_integral_of_a_rate_that_changes_evenly() {
        let (first, chirp) = (0.04, Chirp { last_rate: 0.07, duration: 600.0 });
        let angle = |time: f64| chirp.angle(first, time);
        let rate = |time: f64| (angle(time + 1e-3) - angle(time - 1e-3)) / 2e-3;
        for (time, expected) in
            [(-50.0, 0.04), (100.0, 0.045), (300.0, 0.055), (599.0, 0.06995), (900.0, 0.07)]
        {
            assert!((rate(time) - expected).abs() < 1e-9, "{time} s: {}", rate(time));
        }
        // The mean rate over the chirp, then the last.
        assert!((angle(600.0) - 0.055 * 600.0).abs() < 1e-12);
        assert!((angle(700.0) - 0.055 * 600.0 - 7.0).abs() < 1e-12);
        assert_eq!(angle(0.0), 0.0);
    }
}
