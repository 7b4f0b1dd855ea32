//! H2 and LQG.

use super::*;

fn lqg_weights(n: usize, n_u: usize, n_y: usize) -> LqgWeights {
    LqgWeights {
        states: identity(n),
        controls: 0.5 * identity(n_u),
        process_noise: identity(n),
        measurement_noise: 0.2 * identity(n_y),
    }
}

/// dx/dt = a x + u with all weights one: both Riccati solutions are p = a + √(a² + 1), and the least cost
/// is p (1 + p²).
#[test]
fn a_scalar_regulator_has_the_cost_of_its_closed_form() {
    for a in [-1.0_f64, 0.7] {
        let plant = StateSpace::new(mat![[a]], mat![[1.0]], mat![[1.0]], mat![[0.0]], None);
        let one = || mat![[1.0]];
        let weights = LqgWeights {
            states: one(),
            controls: one(),
            process_noise: one(),
            measurement_noise: one(),
        };
        let found = lqg(&plant, &weights).unwrap();
        let p = a + (a * a + 1.0).sqrt();
        assert!((found.norm / (p * (1.0 + p * p)).sqrt() - 1.0).abs() < 1e-12, "{found:?}");
        assert!(found.riccati_residuals.iter().all(|residual| *residual < 1e-13));
    }
}

/// No controller near the one found has a lower norm, in either time.
#[test]
fn controllers_near_the_best_are_worse() {
    for interval in [None, Some(0.3)] {
        let mut numbers = Numbers::new(11);
        let mut system = numbers.system(5, 6, 5, 0.3);
        system.d = 0.3 * numbers.matrix(5, 6);
        for row in 0..3 {
            for column in 0..4 {
                system.d[(row, column)] = 0.0;
            }
        }
        let continuous = system.clone();
        if let Some(interval) = interval {
            let held = zero_order_hold(&continuous, interval).unwrap();
            system = StateSpace { d: continuous.d.clone(), ..held };
        }
        let plant = GeneralisedPlant::new(system, 2, 2).unwrap();
        let best = h2(&plant).unwrap();
        for part in 0..4 {
            let mut controller = best.controller.clone();
            let step = 1e-4;
            match part {
                0 => controller.a += step * numbers.matrix(5, 5),
                1 => controller.b += step * numbers.matrix(5, 2),
                2 => controller.c += step * numbers.matrix(2, 5),
                // The norm in continuous time is infinite with gain without delay.
                _ if interval.is_some() => controller.d += step * numbers.matrix(2, 2),
                _ => continue,
            }
            let norm = plant.closed(&controller).unwrap().h2_norm().unwrap();
            assert!(norm >= best.norm * (1.0 - 1e-12), "{interval:?} {part}: {norm} {}", best.norm);
            assert!(norm < best.norm * 1.01);
        }
    }
}

#[test]
fn integral_action_leaves_no_steady_error() {
    let plant = Numbers::new(3).system(4, 2, 2, -0.3);
    let sampled = zero_order_hold(&plant, 0.2).unwrap();
    for plant in [plant, sampled] {
        let mut weights = lqg_weights(4, 2, 2);
        weights.states = identity(6);
        let controller = lqg_with_integral_action(&plant, &weights).unwrap();
        let around = Loop::new(plant, controller).unwrap();
        around.stable_or_error().unwrap();
        let complementary = around.complementary_sensitivity().unwrap();
        let gain = complementary.gain_at_rest().unwrap();
        assert!((gain - identity(2)).norm_l2() < 1e-9);
    }
}

#[test]
fn weights_that_do_not_fit_are_named() {
    let plant = Numbers::new(3).system(4, 2, 2, -0.3);
    let weights = LqgWeights { controls: -identity(2), ..lqg_weights(4, 2, 2) };
    let found = lqg(&plant, &weights).map(|_| ());
    assert_eq!(found, Err(SynthesisError::NotPositive("weight of the controls")));
    // A plant with a zero at rest cannot hold a steady output.
    let differentiator = rational(&[1.0, 0.0], &[1.0, 2.0, 2.0]);
    let mut weights = lqg_weights(2, 1, 1);
    weights.states = identity(3);
    let found = lqg_with_integral_action(&differentiator, &weights).map(|_| ());
    let Err(SynthesisError::NotStabilisable { mode }) = found else { panic!("{found:?}") };
    assert!(mode.norm() < 1e-12);
}
