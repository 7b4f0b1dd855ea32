//! The loop's laws: one, or several that were made at wind speeds of their own, blended by the wind that the
//! turbine measures.
//!
//! All laws of a family see the same error at the same instants. What is applied is the blend of the two
//! whose wind speeds lie next to the measured one, linear between them and constant beyond the first and the
//! last, brought within the loop's limits. Every law learns of it by its back-calculation as if it had asked
//! for something that was limited: its own command follows that one as fast as its `K` lets it, and is the
//! same at once only of a law that makes good all of the difference in a sample. The rest goes over with the
//! wind, which is filtered, so that the blend is continuous in time; and the loop's limit of rate holds.

use basis::Measurements;
use lti::Recursion;
use lti::lag::kept;
use serde::{Deserialize, Serialize};

/// Laws of one interval, and how they are blended.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Family {
    /// How they are blended; none of one law alone.
    pub(super) schedule: Option<Schedule>,
    /// Time between their samples (s).
    pub(super) interval: f64,
}

/// How several laws are blended.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Schedule {
    /// Wind speeds that the laws were made at (m/s), ascending.
    pub(super) speeds: Vec<f64>,
    /// The sensor whose first value is the wind speed.
    pub(super) anemometer: String,
    /// Time constant of the low-pass filter on that (s).
    pub(super) filter_time: f64,
}

/// The laws as they are now.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct FamilyState {
    laws: Vec<Recursion>,
    /// Filtered wind speed (m/s); none before it was measured.
    wind: Option<f64>,
}

impl Schedule {
    /// Number of the law below `wind` (m/s), and the share of the next one in the blend (–).
    fn place_of(&self, wind: f64) -> (usize, f64) {
        let n_below = self.speeds.partition_point(|speed| *speed <= wind);
        let lower = n_below.saturating_sub(1);
        match (n_below, self.speeds.get(n_below)) {
            (0, _) | (_, None) => (lower, 0.0),
            (_, Some(upper)) => (lower, (wind - self.speeds[lower]) / (upper - self.speeds[lower])),
        }
    }
}

impl FamilyState {
    /// `laws` at rest, in ascending order of their wind speeds.
    pub(super) fn at_rest(laws: Vec<Recursion>) -> Self {
        Self { laws, wind: None }
    }

    /// Filtered wind speed (m/s); none before it was measured, and of one law alone.
    pub(super) fn wind(&self) -> Option<f64> {
        self.wind
    }

    /// On return all laws are at rest; what is known of the wind stays.
    pub(super) fn reset(&mut self) {
        self.laws.iter_mut().for_each(Recursion::reset);
    }
}

impl Family {
    /// Takes in the wind that the turbine measures; what is no number leaves it as it was.
    pub(super) fn watch_wind(&self, state: &mut FamilyState, measurements: &Measurements) {
        let Some(schedule) = &self.schedule else { return };
        let reading = measurements.reading(&schedule.anemometer).and_then(<[f64]>::first);
        let Some(measured) = reading.copied().filter(|wind| wind.is_finite()) else { return };
        let wind = state.wind.get_or_insert(measured);
        *wind += (1.0 - kept(measurements.interval, schedule.filter_time)) * (measured - *wind);
    }

    /// Whether it is known which laws run.
    pub(super) fn is_known(&self, state: &FamilyState) -> bool {
        self.schedule.is_none() || state.wind.is_some()
    }

    /// One sample: gives what is applied after `errors`, in the units of the laws' ports. `limit` brings what
    /// the blend asks for within what can be reached.
    pub(super) fn step_within(
        &self,
        state: &mut FamilyState,
        errors: &[f64; 2],
        limit: impl FnOnce([f64; 2]) -> [f64; 2],
    ) -> [f64; 2] {
        let place = self.schedule.as_ref().zip(state.wind);
        let (lower, share) = place.map_or((0, 0.0), |(schedule, wind)| schedule.place_of(wind));
        let mut wanted = [0.0; 2];
        state.laws[lower].look(errors, &mut wanted);
        if share > 0.0 {
            let mut upper = [0.0; 2];
            state.laws[lower + 1].look(errors, &mut upper);
            wanted = [0, 1].map(|axis| (1.0 - share) * wanted[axis] + share * upper[axis]);
        }
        let applied = limit(wanted);
        for law in &mut state.laws {
            let mut own = [0.0; 2];
            law.step_within(errors, &mut own, |own| own.copy_from_slice(&applied));
        }
        applied
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::Reading;
    use proptest::prelude::*;

    /// A law of `gain` (deg/m) on each axis, without a state.
    fn static_law(gain: f64) -> Recursion {
        let diagonal = vec![vec![gain, 0.0], vec![0.0, gain]];
        Recursion::new(&[], &[], &[Vec::new(), Vec::new()], &diagonal)
    }

    /// A lag of pole `pole` with this static `gain`, whose state learns of limits.
    fn lag(pole: f64, gain: f64) -> Recursion {
        let diagonal = |value: f64| vec![vec![value, 0.0], vec![0.0, value]];
        Recursion::new(
            &diagonal(pole),
            &diagonal(1.0 - pole),
            &diagonal(gain),
            &diagonal(0.1 * gain),
        )
        .with_back_calculation(&diagonal(0.5 / gain))
    }

    fn family(speeds: &[f64]) -> Family {
        let schedule = Schedule {
            speeds: speeds.to_vec(),
            anemometer: "anemometer".to_owned(),
            filter_time: 60.0,
        };
        Family { schedule: Some(schedule), interval: 0.5 }
    }

    /// A state in a wind of `wind` (m/s).
    fn in_wind(laws: &[Recursion], wind: f64) -> FamilyState {
        FamilyState { laws: laws.to_vec(), wind: Some(wind) }
    }

    /// Half a second in a measured wind of `measured` (m/s).
    fn watch(family: &Family, state: &mut FamilyState, measured: f64) {
        let (sensor, values) = ("anemometer".to_owned(), vec![measured, 0.0]);
        let readings = &[Reading { sensor, values }][..];
        let interval = family.interval;
        let measured = Measurements { interval, readings, ..Measurements::at_rest(3) };
        family.watch_wind(state, &measured);
    }

    /// An error at sample `k` (m).
    fn error(k: u32) -> [f64; 2] {
        let angle = 0.05 * f64::from(k);
        [3.0 * angle.sin() + 1.0, 2.0 * (0.7 * angle).cos()]
    }

    #[test]
    fn at_the_wind_speed_of_a_law_it_is_that_law_to_the_bit() {
        let speeds = [8.0, 10.0, 12.0];
        let laws = [lag(0.9, 0.5), lag(0.8, 0.3), lag(0.7, 0.2)];
        let family = family(&speeds);
        let limit = |wanted: [f64; 2]| wanted.map(|w| w.clamp(-1.0, 1.0));
        // Beyond the first and the last it is these.
        for (wind, own) in [(8.0, 0), (10.0, 1), (12.0, 2), (5.0, 0), (20.0, 2)] {
            let mut state = in_wind(&laws, wind);
            let mut alone = laws[own].clone();
            for k in 0..400 {
                let applied = family.step_within(&mut state, &error(k), limit);
                let mut wanted = [0.0; 2];
                alone.step_within(&error(k), &mut wanted, |wanted| {
                    wanted.copy_from_slice(&limit([wanted[0], wanted[1]]));
                });
                assert_eq!(applied, wanted, "{wind} m/s, sample {k}");
            }
        }
    }

    proptest! {
        #[test]
        fn between_two_static_laws_it_is_their_convex_blend(
            wind in 8.0..12.0_f64,
            gains in prop::array::uniform3(-2.0..2.0_f64),
            errors in prop::array::uniform2(-20.0..20.0_f64),
        ) {
            let speeds = [8.0, 9.0, 12.0];
            let mut state = in_wind(&gains.map(static_law), wind);
            let applied = family(&speeds).step_within(&mut state, &errors, |wanted| wanted);
            let gain = if wind < 9.0 {
                gains[0] + (wind - 8.0) * (gains[1] - gains[0])
            } else {
                gains[1] + (wind - 9.0) / 3.0 * (gains[2] - gains[1])
            };
            for axis in 0..2 {
                prop_assert!((applied[axis] - gain * errors[axis]).abs() < 1e-12);
            }
        }
    }

    /// With a constant error and static laws all change comes from the schedule: at most the share that
    /// passed from one law to the next, of what the two differ by.
    #[test]
    fn a_ramp_of_wind_moves_the_command_no_more_than_the_laws_differ() {
        let (speeds, gains) = ([8.0, 9.0, 12.0], [0.5, -0.2, 1.0]);
        let family = family(&speeds);
        let mut state = FamilyState::at_rest(gains.map(static_law).to_vec());
        let errors = [4.0, -3.0];
        let mut before: Option<([f64; 2], f64)> = None;
        for k in 0..800 {
            let measured = 7.0 + 6.0 * (f64::from(k) / 500.0).min(1.0);
            watch(&family, &mut state, measured);
            let wind = state.wind().expect("it is measured");
            let applied = family.step_within(&mut state, &errors, |wanted| wanted);
            if let Some((last, last_wind)) = before {
                // The steepest change of gain over wind speed.
                let steepest = 0.7_f64.max(1.2 / 3.0);
                for axis in 0..2 {
                    let most = steepest * (wind - last_wind) * errors[axis].abs() + 1e-12;
                    assert!((applied[axis] - last[axis]).abs() <= most, "sample {k}");
                }
            }
            before = Some((applied, wind));
        }
        // It came from the first law alone to the last alone: after 150 s of 60 s.
        let (applied, wind) = before.expect("samples");
        assert!(wind > 12.0 && (applied[0] - 4.0).abs() < 1e-12, "{wind} {applied:?}");
    }

    /// Laws that integrate, and whose `K` makes good all of the difference in a sample, follow what is
    /// applied, so that one that was not asked for minutes begins where the others left off.
    #[test]
    fn a_law_that_follows_at_once_begins_where_the_others_left_off() {
        let integrating = |gain: f64| {
            let diagonal = |value: f64| vec![vec![value, 0.0], vec![0.0, value]];
            Recursion::new(&diagonal(1.0), &diagonal(gain), &diagonal(1.0), &diagonal(0.0))
                .with_back_calculation(&diagonal(1.0))
        };
        let family = family(&[8.0, 10.0]);
        let mut state = in_wind(&[integrating(0.01), integrating(0.04)], 8.0);
        let mut last = [0.0; 2];
        for k in 0..600 {
            let errors = error(k);
            if k == 300 {
                state.wind = Some(10.0);
            }
            let applied = family.step_within(&mut state, &errors, |wanted| wanted);
            // An integrator moves by its gain times the last error, whoever moved before.
            let gain = if k < 300 { 0.01 } else { 0.04 };
            for axis in 0..2 {
                let moved = if k == 0 { 0.0 } else { gain * error(k - 1)[axis] };
                assert!((applied[axis] - last[axis] - moved).abs() < 1e-12, "sample {k}");
            }
            last = applied;
        }
    }

    #[test]
    fn the_wind_is_filtered_from_its_first_reading_on_and_kept_through_gaps() {
        let family = family(&[8.0, 10.0]);
        let mut state = FamilyState::at_rest(vec![static_law(1.0); 2]);
        family.watch_wind(&mut state, &Measurements::at_rest(3));
        watch(&family, &mut state, f64::NAN);
        assert!(!family.is_known(&state));
        watch(&family, &mut state, 8.0);
        assert_eq!(state.wind(), Some(8.0));
        for k in 1..=240 {
            watch(&family, &mut state, 10.0);
            let expected = 10.0 - 2.0 * (-0.5 * f64::from(k) / 60.0).exp();
            assert!((state.wind().expect("known") - expected).abs() < 1e-9);
            watch(&family, &mut state, f64::INFINITY);
        }
    }
}
