//! A made-up helix gives back its phases; bad records are refused.

use super::*;
use basis::angle::wrap_to_half_turn;
use basis::{FixedFrame, Vector3};
use proptest::prelude::*;
use std::f64::consts::PI;

const INTERVAL: f64 = 0.5;
/// St 0.25 at 10.5 m/s past 240 m.
const PERIOD: f64 = 240.0 / 2.625;
const N_SAMPLES: usize = 5400;

fn reference() -> Reference {
    Reference { rate: TAU / PERIOD, sense: Sense::CounterClockwise }
}

fn winds(reference: &Reference, start: f64, tilt: [f64; 2], yaw: [f64; 2]) -> Vec<FixedFrame> {
    (0..N_SAMPLES)
        .map(|index| {
            let time = start + index as f64 * INTERVAL;
            FixedFrame {
                average: 9.0,
                tilt: 0.3 + reference.tilt_wind(time, tilt[0], tilt[1]),
                yaw: reference.yaw_wind(time, yaw[0], yaw[1]) - 0.1,
            }
        })
        .collect()
}

fn truth(winds: &[FixedFrame], start: f64, reference: &Reference) -> GroundTruth {
    let band = Band::around(reference.frequency(), Band::RATIO);
    ground_truth(winds, start, INTERVAL, reference, band).expect("a good record")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The definition itself: what went in as φ comes out, in either sense, from any start. The slowest pole
    /// of the band from f/1.5 to 1.5 f decays by e^{1.3} a period; eleven periods in, what an end did is
    /// below 10⁻⁶.
    #[test]
    fn a_pure_helix_gives_back_its_phases(
        tilt in -3.1..3.1_f64, yaw in -3.1..3.1_f64, start in 0.0..900.0_f64, ccw: bool,
        amplitudes in (0.2..2.0_f64, 0.2..2.0_f64),
    ) {
        let sense = if ccw { Sense::CounterClockwise } else { Sense::Clockwise };
        let reference = Reference { sense, ..reference() };
        let winds = winds(&reference, start, [amplitudes.0, tilt], [amplitudes.1, yaw]);
        let truth = truth(&winds, start, &reference);
        let inner = (11.0 * PERIOD / INTERVAL) as usize;
        for index in (inner..N_SAMPLES - inner).step_by(41) {
            prop_assert!(wrap_to_half_turn(truth.tilt.phase[index] - tilt).abs() < 1e-6);
            prop_assert!(wrap_to_half_turn(truth.yaw.phase[index] - yaw).abs() < 1e-6);
            prop_assert!((truth.tilt.amplitude[index] / amplitudes.0 - 1.0).abs() < 1e-6);
            let time = truth.time(index);
            let wind = reference.yaw_wind(time, amplitudes.1, yaw);
            prop_assert!((truth.yaw.wind[index] - wind).abs() < 1e-6 * amplitudes.1);
            prop_assert_eq!(truth.index_at(time), Some(index));
        }
        // Within the part that is called trusted the ends have less than a twentieth of the weight.
        for index in truth.trusted.clone() {
            prop_assert!(wrap_to_half_turn(truth.tilt.phase[index] - tilt).abs() < 0.05);
        }
    }

    /// Lines over a linear wind: its slopes at half the radius, whatever the wind's mean.
    #[test]
    fn lines_see_the_slopes_of_a_linear_wind(
        n_lines in 3..40_usize, n_points in 1..30_usize, mean in 5.0..12.0_f64,
        right in -0.01..0.01_f64, up in -0.01..0.01_f64,
    ) {
        let lines =
            Lines { center: Vector3::new(1200.0, 3.0, 150.0), radius: 120.0, n_lines, n_points };
        let velocities: Vec<Vector3> = lines
            .positions()
            .iter()
            .map(|p| Vector3::new(mean - right * (p.y - 3.0) + up * (p.z - 150.0), 7.0, -7.0))
            .collect();
        let mut means = vec![0.0; n_lines];
        lines.means(&velocities, &mut means);
        let fixed = lines_to_fixed_frame(&means);
        prop_assert!((fixed.average - mean).abs() < 1e-9);
        prop_assert!((fixed.tilt - 60.0 * up).abs() < 1e-9);
        prop_assert!((fixed.yaw - 60.0 * right).abs() < 1e-9);
    }
}

/// What is definition in Eq. 20: ccw yaw is a cosine, and the tilt leads it by nothing.
#[test]
fn the_reference_is_equation_20() {
    let reference = reference();
    let time = 33.0;
    let angle = reference.rate * time + 0.4;
    assert!((reference.tilt_wind(time, 2.0, 0.4) - 2.0 * angle.sin()).abs() < 1e-12);
    assert!((reference.yaw_wind(time, 2.0, 0.4) - 2.0 * angle.cos()).abs() < 1e-12);
    let cw = Reference { sense: Sense::Clockwise, ..reference };
    assert!((cw.yaw_wind(time, 2.0, 0.4) + 2.0 * angle.cos()).abs() < 1e-12);
}

#[test]
fn turbulence_off_the_band_moves_the_phase_little_and_a_slow_drift_is_followed() {
    let reference = reference();
    let drift = |time: f64| 0.5 + 0.8 * (TAU * time / 1500.0).sin();
    let winds: Vec<FixedFrame> = (0..N_SAMPLES)
        .map(|index| {
            let time = index as f64 * INTERVAL;
            let fast = 0.8 * (TAU * 0.3 * time).sin() + 0.5 * (TAU * 0.05 * time + 1.0).sin();
            let tilt = reference.tilt_wind(time, 1.0, drift(time)) + fast;
            FixedFrame { average: 9.0, tilt, yaw: reference.yaw_wind(time, 1.0, 0.0) }
        })
        .collect();
    let truth = truth(&winds, 0.0, &reference);
    for index in truth.trusted.clone() {
        let error = wrap_to_half_turn(truth.tilt.phase[index] - drift(truth.time(index)));
        assert!(error.abs() < 0.06, "{error} at {}", truth.time(index));
    }
}

/// The filter is its formula: a sine at the band's edges passes at half, one two octaves off at next to
/// nothing.
#[test]
fn the_band_passes_its_centre_and_half_its_edges() {
    let band = Band::around(0.02, 1.5);
    for (frequency, expected) in [(0.02, 1.0), (0.03, 0.5), (0.02 / 1.5, 0.5), (0.08, 0.0025)] {
        let samples: Vec<f64> =
            (0..8000).map(|i| 4.0 + 2.0 * (TAU * frequency * f64::from(i) * 0.5).cos()).collect();
        let filtered = narrowband(&samples, 0.5, band).expect("a good record");
        let amplitude = filtered.amplitude[4000] / 2.0;
        assert!((amplitude - expected).abs() < 2e-4, "{frequency}: {amplitude}");
        let angle = TAU * frequency * 2000.0;
        assert!(wrap_to_half_turn(filtered.angle[4000] - angle).abs() < 1e-4);
    }
}

#[test]
fn columns_of_lines_and_moments_of_blades_reach_the_fixed_frame() {
    let columns: Vec<Vec<f64>> = (0..36)
        .map(|line| (0..5).map(|i| 8.0 + f64::from(i) * line_azimuth(line, 36).cos()).collect())
        .collect();
    let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    for (index, wind) in winds_of_lines(&columns).expect("36 lines").iter().enumerate() {
        assert!((wind.average - 8.0).abs() < 1e-12 && wind.yaw.abs() < 1e-12);
        assert!((wind.tilt - index as f64).abs() < 1e-12);
    }
    let azimuths: Vec<f64> = (0..7).map(|i| 0.7 * f64::from(i)).collect();
    let blades: Vec<Vec<f64>> = (0..3)
        .map(|b| {
            azimuths.iter().map(|a| 5.0 + 2.0 * (a + TAU * f64::from(b) / 3.0).sin()).collect()
        })
        .collect();
    let blades: Vec<&[f64]> = blades.iter().map(Vec::as_slice).collect();
    for moments in fixed_frame_moments(&azimuths, &blades).expect("three blades") {
        assert!((moments.average - 5.0).abs() < 1e-12 && (moments.yaw - 2.0).abs() < 1e-12);
    }
    assert!(fixed_frame_moments(&azimuths, &blades[..2]).is_err());
    assert!(fixed_frame_moments(&azimuths[..3], &blades).is_err());
    assert!(winds_of_lines(&columns[..2]).is_err());
}

#[test]
fn agreement_is_on_the_circle() {
    let truth: Vec<f64> = (0..1200).map(|i| 0.01 * f64::from(i)).collect();
    // Half a turn less a little, one turn too many, ±0.2 about a bias of 0.3.
    let estimated: Vec<f64> = truth
        .iter()
        .enumerate()
        .map(|(i, t)| t + TAU + 0.3 + if i % 2 == 0 { 0.2 } else { -0.2 })
        .collect();
    let found = agreement(&estimated, &truth, 1.0, 300.0).expect("whole records");
    assert!((found.bias - 0.3).abs() < 1e-12 && (found.spread - 0.2).abs() < 1e-12);
    assert!((found.rmse - 0.13_f64.sqrt()).abs() < 1e-12);
    assert!((found.locking - 0.2_f64.cos()).abs() < 1e-12);
    assert!(found.bias_half_width_95.expect("four blocks") < 1e-9);
    let across: Vec<f64> = truth.iter().map(|t| t + PI - 0.1).collect();
    assert!(
        (agreement(&across, &truth, 1.0, 300.0).expect("whole").rmse - (PI - 0.1)).abs() < 1e-9
    );
    assert!(agreement(&[], &[], 1.0, 1.0).is_err());
    assert!(agreement(&truth[1..], &truth, 1.0, 1.0).is_err());
    assert!(agreement(&[f64::NAN], &[0.0], 1.0, 1.0).is_err());
}

/// Uniform on [−½, ½), the same on every machine.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    }
}

#[test]
fn coherence_tells_a_delayed_copy_from_a_stranger() {
    let mut random = noise(7);
    let common: Vec<f64> = (0..N_SAMPLES).map(|_| random()).collect();
    // Five samples behind, at 0.02 Hz and half a second: 0.1 π of phase, twice as large.
    let delayed: Vec<f64> =
        (0..N_SAMPLES).map(|i| if i < 5 { 0.0 } else { 2.0 * common[i - 5] }).collect();
    let found = coherence(&delayed, &common, INTERVAL, 0.02, 512).expect("long enough");
    assert!(found.coherence > 0.99 && found.coherence_95[0] > 0.97, "{found:?}");
    assert!((found.phase_error + 0.1 * PI).abs() < found.phase_error_half_width_95.max(0.02));
    assert!((found.gain - 2.0).abs() < 0.1);
    let stranger: Vec<f64> = (0..N_SAMPLES).map(|_| random()).collect();
    let found = coherence(&stranger, &common, INTERVAL, 0.02, 512).expect("long enough");
    assert!(found.coherence < found.floor_95 && found.phase_error_half_width_95 > 0.5);
}

/// With noise of known power the coherence is 1/(1 + noise/signal)², and the intervals hold what they
/// promise.
#[test]
fn intervals_of_coherence_and_phase_cover_the_truth() {
    let (mut held, mut phase_held, n_trials) = (0, 0, 200);
    for trial in 0..n_trials {
        let mut random = noise(trial);
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for _ in 0..4096 {
            let shared = random();
            first.push(shared + 0.5 * random());
            second.push(shared + 0.5 * random());
        }
        let found = coherence(&first, &second, 1.0, 0.1, 256).expect("long enough");
        let true_coherence = (1.0_f64 / 1.25).powi(2);
        let [low, high] = found.coherence_95;
        held += u64::from((low..=high).contains(&true_coherence));
        phase_held += u64::from(found.phase_error.abs() < found.phase_error_half_width_95);
    }
    // 95 % of 200 trials, three standard deviations either way.
    assert!((181..=199).contains(&held), "{held}");
    assert!((181..=199).contains(&phase_held), "{phase_held}");
}

/// Five segments, as in a record of twelve periods: a normal distribution's 1.96 would hold the truth nine
/// times in ten.
#[test]
fn the_interval_of_the_phase_holds_the_truth_with_few_segments() {
    let (mut held, n_trials) = (0, 600);
    for trial in 0..n_trials {
        let mut random = noise(trial);
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for _ in 0..192 {
            let shared = random();
            first.push(shared + 0.5 * random());
            second.push(shared + 0.5 * random());
        }
        let found = coherence(&first, &second, 1.0, 0.1, 64).expect("long enough");
        assert_eq!(found.n_segments, 5);
        held += u64::from(found.phase_error.abs() < found.phase_error_half_width_95);
    }
    // 95 % of 600 trials, three standard deviations either way.
    assert!((554..=586).contains(&held), "{held}");
}

#[test]
fn bad_records_are_refused_by_name() {
    let reference = reference();
    let winds = winds(&reference, 0.0, [1.0, 0.0], [1.0, 0.0]);
    let band = Band::around(reference.frequency(), Band::RATIO);
    let refusal = |winds: &[FixedFrame], interval: f64, band| {
        ground_truth(winds, 0.0, interval, &reference, band).expect_err("bad")
    };
    assert!(matches!(refusal(&winds, 60.0, band), AnalysisError::AboveNyquist { .. }));
    assert!(matches!(refusal(&winds[..100], INTERVAL, band), AnalysisError::TooShort { .. }));
    assert!(matches!(
        refusal(&winds, INTERVAL, Band { low: 0.02, high: 0.01 }),
        AnalysisError::Band { .. }
    ));
    let mut gap = winds.clone();
    gap[17].yaw = f64::NAN;
    assert_eq!(refusal(&gap, INTERVAL, band), AnalysisError::NotFinite { index: 17 });
    let mut times: Vec<f64> = (0..50).map(|i| 600.0 + 0.1 * f64::from(i)).collect();
    assert!((uniform_interval(&times).expect("even") - 0.1).abs() < 1e-9);
    times.remove(20);
    assert!(matches!(uniform_interval(&times), Err(AnalysisError::UnevenTimes { .. })));
    assert!(uniform_interval(&[0.0]).is_err() && uniform_interval(&[0.0, f64::NAN, 1.0]).is_err());
    assert!(coherence(&[0.0; 100], &[0.0; 100], 1.0, 0.6, 32).is_err());
    assert!(coherence(&[0.0; 40], &[0.0; 40], 1.0, 0.1, 32).is_err());
    assert_eq!(coherence(&[0.0; 64], &[0.0; 64], 1.0, 0.1, 32).expect("still").coherence, 0.0);
}
