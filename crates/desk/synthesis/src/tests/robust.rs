//! H-infinity synthesis.

use super::*;

/// A plant with one zero z in the right half plane: the least norm of W_P S is |W_P(z)|, where controls cost
/// next to nothing.
#[test]
fn a_zero_in_the_right_half_plane_bounds_the_sensitivity() {
    for z in [0.5, 2.0, 8.0] {
        let plant = rational(&[-1.0, z], &[1.0, 3.0, 2.0]);
        let performance = performance_weight(0.4, 2.0, 0.01).unwrap();
        let control = StateSpace::gain(mat![[1e-4]], None);
        let exact = performance.at(z.into()).unwrap()[(0, 0)].norm();
        let weights = SensitivityWeights {
            performance: Some(performance),
            complementary: None,
            control: Some(control),
        };
        let problem = mixed_sensitivity(&plant, &weights).unwrap();
        let found = h_infinity(&problem, &HInfinityOptions::default()).unwrap();
        assert!((found.bound / exact - 1.0).abs() < 2e-3, "{} {exact}", found.bound);
        assert!(found.bound > exact * (1.0 - 1e-4));
        assert!(found.achieved.gain <= found.bound * (1.0 + 1e-5), "{found:?}");
        assert!(found.riccati_residuals.iter().all(|residual| *residual < 1e-10), "{found:?}");
    }
}

/// dx/dt = a x + w1 + u, z = (x, u), y = x + w2: both Riccati equations are a quadratic formula, and the
/// bound is where their product is its square.
#[test]
fn a_scalar_problem_has_the_bound_of_its_closed_form() {
    for a in [-1.0_f64, 0.0, 1.0] {
        let system = StateSpace::new(
            mat![[a]],
            mat![[1.0, 0.0, 1.0]],
            mat![[1.0], [0.0], [1.0]],
            mat![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
            None,
        );
        let plant = GeneralisedPlant::new(system, 1, 1).unwrap();
        let found = h_infinity(&plant, &HInfinityOptions::default()).unwrap();
        // x² (1 − γ⁻²) − 2 a x − 1 = 0 for both; x < γ is the bound: γ² − 1 − 2 a γ − 1 = 0.
        let exact = a + (a * a + 2.0).sqrt();
        assert!((found.bound / exact - 1.0).abs() < 2e-5, "{} {exact}", found.bound);
        assert!(found.achieved.gain <= found.bound * (1.0 + 1e-5));
    }
}

pub(super) fn random_problem(index: u64, order: usize) -> GeneralisedPlant {
    let mut numbers = Numbers::new(index);
    let growth = if index.is_multiple_of(2) { -0.2 } else { 0.4 };
    if index < 5 {
        let plant = numbers.system(order, 2, 2, growth);
        return mixed_sensitivity(&plant, &weights(2)).unwrap();
    }
    let mut system = numbers.system(order, 6, 5, growth);
    system.d = 0.2 * numbers.matrix(5, 6);
    for channel in 0..2 {
        system.d[(channel + 1, channel + 4)] += 1.0;
        system.d[(channel + 3, channel + 2)] += 1.0;
    }
    GeneralisedPlant::new(system, 2, 2).unwrap()
}

/// Ten plants of order 2 to 20: some not stable, five with gain without delay everywhere.
#[test]
pub(super) fn random_problems_keep_their_bounds() {
    let orders = [2, 4, 6, 10, 16, 2, 5, 9, 14, 20];
    for (index, order) in orders.into_iter().enumerate() {
        let plant = random_problem(index as u64, order);
        let found = h_infinity(&plant, &HInfinityOptions::default()).unwrap();
        let closed = plant.closed(&found.controller).unwrap();
        assert!(closed.is_stable().unwrap());
        assert!(found.achieved.gain <= found.bound * (1.0 + 1e-5), "{index}");
        assert!(found.bound <= found.lower_bound * (1.0 + 1e-4), "{index}");
        // The least norm is not below the bound that no controller keeps.
        assert!(found.achieved.gain > 0.99 * found.lower_bound, "{index}");
        assert!(found.riccati_residuals.iter().all(|residual| *residual < 1e-10), "{index}");
    }
}

/// The bilinear transformation leaves the least bound as it is.
#[test]
fn a_plant_in_discrete_time_has_the_bound_of_its_transform() {
    let plant = random_problem(1, 4);
    let sampled = plant.with_system(bilinear(&plant.system, 0.2).unwrap());
    let one = h_infinity(&plant, &HInfinityOptions::default()).unwrap();
    let other = h_infinity(&sampled, &HInfinityOptions::default()).unwrap();
    assert_eq!(other.controller.interval, Some(0.2));
    assert!((one.bound / other.bound - 1.0).abs() < 3e-5, "{} {}", one.bound, other.bound);
    assert!(other.achieved.gain <= other.bound * (1.0 + 1e-5));
}

/// Far above the least bound the central controller is that of the H2 problem.
#[test]
fn a_large_bound_gives_the_controller_of_least_h2_norm() {
    let mut plant = random_problem(8, 6);
    for row in 0..3 {
        for column in 0..4 {
            plant.system.d[(row, column)] = 0.0;
        }
    }
    let least = h2(&plant).unwrap();
    let options = HInfinityOptions { smallest: 1e5, tolerance: 1e-3, largest: 1e7 };
    let far = h_infinity(&plant, &options).unwrap();
    let difference = parallel(&least.controller, &far.controller.scaled(-1.0)).unwrap();
    for frequency in [0.0, 0.1, 1.0, 10.0] {
        let size = least.controller.singular_values(frequency).unwrap()[0];
        assert!(difference.singular_values(frequency).unwrap()[0] < 1e-7 * size);
    }
}

/// What does not meet the assumptions is refused by its name.
#[test]
fn failing_assumptions_are_named() {
    let options = HInfinityOptions::default();
    let plant = rational(&[1.0], &[1.0, 1.0]);
    let integrator = rational(&[1.0], &[1.0, 0.0]);
    let of = |plant: &StateSpace, performance, control| {
        let weights = SensitivityWeights { performance, complementary: None, control };
        mixed_sensitivity(plant, &weights)
    };
    let one = || Some(StateSpace::gain(mat![[1.0]], None));
    let weight = of(&plant, Some(integrator.clone()), one()).map(|_| ());
    assert!(matches!(weight, Err(SynthesisError::UnstableWeight { weight: "performance", .. })));
    let free = h_infinity(&of(&plant, one(), None).unwrap(), &options).map(|_| ());
    assert_eq!(free, Err(SynthesisError::FreeControl { rank: 0, controls: 1 }));
    let zero = h_infinity(&of(&integrator, one(), one()).unwrap(), &options).map(|_| ());
    let Err(SynthesisError::MeasurementZero { frequency }) = zero else { panic!("{zero:?}") };
    assert!(frequency < 1e-6);
    let system = StateSpace::new(
        mat![[0.5, 0.0], [0.0, -1.0]],
        mat![[1.0, 0.0, 0.0], [1.0, 0.0, 1.0]],
        mat![[1.0, 1.0], [0.0, 0.0], [1.0, 1.0]],
        mat![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]],
        None,
    );
    let fixed = h_infinity(&GeneralisedPlant::new(system, 1, 1).unwrap(), &options).map(|_| ());
    assert_eq!(fixed, Err(SynthesisError::NotStabilisable { mode: 0.5.into() }));
}

/// The weights of Eqs. 11 and 12 at rest and far beyond their corners.
#[test]
fn weights_have_their_gains() {
    let performance = performance_weight(0.02, 10.0, 0.625).unwrap();
    let gain = |system: &StateSpace, frequency: f64| system.singular_values(frequency).unwrap()[0];
    assert!((gain(&performance, 0.0) - 1.6).abs() < 1e-14);
    assert!((gain(&performance, 1e6) - 0.1).abs() < 1e-9);
    let control = control_weight(0.15, 10.0, 0.4).unwrap();
    assert!((gain(&control, 0.0) - 0.4).abs() < 1e-12);
    assert!((gain(&control, 1e6) - 40.0).abs() < 1e-6);
    // At ω: 0.4 B² √2/|B² − 1 + √2 B i|.
    let at_corner = 40.0 * 2.0_f64.sqrt() / (99.0_f64.powi(2) + 200.0).sqrt();
    assert!((gain(&control, 0.15) - at_corner).abs() < 1e-12);
    assert!(matches!(control_weight(-1.0, 10.0, 0.4), Err(SynthesisError::OutOfRange { .. })));
}
