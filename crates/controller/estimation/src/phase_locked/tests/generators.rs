//! Generators against their transfer functions.

use super::*;

#[test]
fn gain_of_the_offset_places_the_poles() {
    for m in [0.5, 1.0, 2.0] {
        for k in [0.5, 1.0, SQRT_2] {
            let gain = dc_gain(k, m).unwrap();
            // Symbols of Eq. 2-13: α from the first relation, β² from the second; the third must then hold.
            let alpha = (k + gain) / (m + 2.0);
            let beta_squared = 1.0 - (2.0 * m + 1.0) * alpha * alpha;
            let left = m * alpha * (alpha * alpha + beta_squared);
            assert!((left - gain).abs() < 1e-14, "k {k}, m {m}: {left} and {gain}");
        }
    }
    assert!(matches!(dc_gain(SQRT_2, 0.0), Err(PhaseLockedError::PoleRatio { .. })));
    assert!(matches!(dc_gain(2.2, 1.0), Err(PhaseLockedError::Damping { .. })));
}

/// In-phase, quadrature and offset of a generator at `centre` fed with a sine at `ratio` times that, as gain
/// and phase.
fn measured(kind: GeneratorKind, centre: f64, ratio: f64) -> [Response; 3] {
    let mut generator = Generator::new(kind, SQRT_2).unwrap();
    let rate = ratio * centre;
    let n_period = (TAU / (rate * INTERVAL)).round();
    // A whole number of samples a period, so that sums over it are exact.
    let interval = TAU / rate / n_period;
    let mut sums = [[0.0; 2]; 3];
    for step in 0..30 * n_period as usize {
        let (sine, cosine) = (rate * interval * step as f64).sin_cos();
        generator.update(centre * interval, sine);
        if step >= 29 * n_period as usize {
            let outputs = [generator.in_phase(), generator.quadrature(), generator.offset()];
            for (sum, output) in sums.iter_mut().zip(outputs) {
                sum[0] += output * sine * 2.0 / n_period;
                sum[1] += output * cosine * 2.0 / n_period;
            }
        }
    }
    sums.map(|[re, im]| Response { gain: re.hypot(im), phase: im.atan2(re) })
}

#[test]
fn generators_have_their_transfer_functions() {
    for kind in kinds() {
        for centre in [BAND[0], BAND[1]] {
            for ratio in [0.3, 0.7, 0.95, 1.0, 1.3, 2.0, 4.0] {
                let closed = transfer(kind, SQRT_2, ratio);
                let expected = [closed.in_phase, closed.quadrature, closed.offset];
                for (measured, expected) in measured(kind, centre, ratio).into_iter().zip(expected)
                {
                    let (gain, phase) = (measured.gain, expected.phase - measured.phase);
                    assert!((gain - expected.gain).abs() <= 0.01 * expected.gain + 1e-9);
                    let turned = gain * wrap_to_half_turn(phase).abs();
                    assert!(turned < 0.01 * expected.gain + 1e-9, "{kind:?} {ratio}: {turned}");
                }
            }
        }
    }
}

#[test]
fn at_the_centre_gain_and_phase_are_exact_for_any_interval() {
    for kind in kinds() {
        for turned in [0.003, 0.1, 0.9] {
            let mut generator = Generator::new(kind, SQRT_2).unwrap();
            let n_steps = (60.0 * TAU / turned) as usize;
            for step in 0..=n_steps {
                generator.update(turned, (turned * step as f64).sin());
            }
            let phase = turned * n_steps as f64;
            assert!((generator.in_phase() - phase.sin()).abs() < 1e-9);
            assert!((generator.quadrature() + phase.cos()).abs() < 1e-9);
            assert!(generator.offset().abs() < 1e-9);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever the centre does, the state forgets where it came from.
    #[test]
    fn generators_forget_while_the_centre_jumps(
        kind in 0_usize..3, damping in 0.3..1.9_f64, seed in 0.0..100.0_f64, swing in 0.0..2.8_f64,
    ) {
        let kind = match kind {
            1 => GeneratorKind::Extended { dc_gain: 0.22 },
            0 => GeneratorKind::Second,
            _ => GeneratorKind::Mixed,
        };
        let mut one = Generator::new(kind, damping).unwrap();
        let mut other = one;
        one.update(0.1, 7.0);
        other.update(0.1, -3.0);
        for step in 0..3000 {
            // From hardly turning to nearly half a turn a sample.
            let turned = 0.05 + 0.5 * swing * (1.0 + (seed * f64::from(step * step)).sin());
            let sample = (0.37 * f64::from(step)).sin();
            one.update(turned, sample);
            other.update(turned, sample);
        }
        prop_assert!((one.in_phase() - other.in_phase()).abs() < 1e-6);
        prop_assert!((one.quadrature() - other.quadrature()).abs() < 1e-6);
        prop_assert!((one.offset() - other.offset()).abs() < 1e-6);
    }
}
