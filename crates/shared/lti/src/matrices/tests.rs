//! Closed forms and invariants.

use super::dense::{eigenvalues, identity};
use super::*;
use faer::{Mat, mat};
use num_complex::Complex64;
use proptest::prelude::*;

/// 1/(τ s + 1) with τ in s.
fn lag(time_constant: f64) -> StateSpace {
    rational(&[1.0], &[time_constant, 1.0])
}

fn rational(numerator: &[f64], denominator: &[f64]) -> StateSpace {
    let (numerator, denominator) = (numerator.to_vec(), denominator.to_vec());
    TransferFunction { numerator, denominator, interval: None }.state_space().unwrap()
}

/// A stable system with `order` states, from numbers between −1 and 1.
fn stable(order: usize, n_inputs: usize, n_outputs: usize, seed: u64) -> StateSpace {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let free = Mat::from_fn(order, order, |_, _| next());
    let growth = eigenvalues(&free).unwrap().iter().map(|value| value.re).fold(-9.0, f64::max);
    StateSpace::new(
        free - (growth + 0.2) * identity(order),
        Mat::from_fn(order, n_inputs, |_, _| next()),
        Mat::from_fn(n_outputs, order, |_, _| next()),
        Mat::from_fn(n_outputs, n_inputs, |_, _| next()),
        None,
    )
}

/// Whether one of `values` is within `tolerance` of `point`.
fn has(values: &[Complex64], point: Complex64, tolerance: f64) -> bool {
    values.iter().any(|value| (value - point).norm() < tolerance)
}

#[test]
fn a_transfer_function_responds_as_its_polynomials() {
    let system = rational(&[2.0, 1.0, 3.0], &[1.0, 0.4, 4.0, 1.0]);
    let s = Complex64::new(0.0, 1.7);
    let exact = (2.0 * s * s + s + 3.0) / (s * s * s + 0.4 * s * s + 4.0 * s + 1.0);
    assert!((system.response(1.7).unwrap()[(0, 0)] - exact).norm() < 1e-14);
    let improper =
        TransferFunction { numerator: vec![1.0, 0.0], denominator: vec![2.0], interval: None };
    assert!(matches!(improper.state_space(), Err(MatrixError::Size { .. })));
}

#[test]
fn interconnections_respond_as_the_algebra_of_responses() {
    let (first, second) = (stable(3, 2, 2, 1), stable(4, 2, 2, 2));
    let at = |system: &StateSpace| system.response(0.8).unwrap();
    let (one, two) = (at(&first), at(&second));
    let near = |found: StateSpace, exact: &Mat<faer::c64>| {
        assert!((at(&found) - exact).norm_l2() < 1e-12);
    };
    near(series(&first, &second).unwrap(), &(&two * &one));
    near(parallel(&first, &second).unwrap(), &(&one + &two));
    let closed = feedback(&first, &second).unwrap();
    let unity = dense::complex(&identity(2));
    let exact = dense::solve_complex(&(&unity + &one * &two), &one).unwrap();
    near(closed, &exact);
    let beside = append(&[&first, &second]).unwrap();
    near(beside.selected(&[3, 2], &[2, 3]).unwrap(), &Mat::from_fn(2, 2, |i, j| two[(1 - i, j)]));
}

#[test]
fn what_does_not_fit_is_refused() {
    let (first, second) = (stable(3, 2, 2, 1), stable(4, 3, 3, 2));
    assert!(matches!(series(&first, &second), Err(MatrixError::Size { .. })));
    let sampled = StateSpace { interval: Some(0.1), ..first.clone() };
    assert!(matches!(parallel(&first, &sampled), Err(MatrixError::SampleTimes { .. })));
    let gain = StateSpace::gain(-identity(2), None);
    let one = StateSpace::gain(identity(2), None);
    assert_eq!(feedback(&gain, &one), Err(MatrixError::IllPosedLoop));
    assert!(matches!(rational(&[1.0], &[1.0, 0.0]).response(0.0), Err(MatrixError::PoleAt { .. })));
    assert!(matches!(rational(&[1.0], &[1.0, -1.0]).h2_norm(), Err(MatrixError::Unstable { .. })));
    assert_eq!(rational(&[1.0, 2.0], &[1.0, 1.0]).h2_norm(), Err(MatrixError::InfiniteNorm));
}

/// H2 norm of 1/(τ s + 1) is (2 τ)^−½; of ω²/(s² + 2 ζ ω s + ω²) it is (ω/(4 ζ))^½.
#[test]
fn h2_norms_are_their_closed_forms() {
    assert!((lag(3.0).h2_norm().unwrap() - 6.0_f64.sqrt().recip()).abs() < 1e-14);
    let (w, zeta) = (2.0, 0.05);
    let second = rational(&[w * w], &[1.0, 2.0 * zeta * w, w * w]);
    assert!((second.h2_norm().unwrap() - (w / (4.0 * zeta)).sqrt()).abs() < 1e-12);
    // x(k+1) = a x + u: the sum of a^(2k).
    let sampled = StateSpace::new(mat![[0.9]], mat![[1.0]], mat![[1.0]], mat![[0.0]], Some(0.1));
    assert!((sampled.h2_norm().unwrap() - (1.0_f64 / (1.0 - 0.81)).sqrt()).abs() < 1e-13);
}

/// ω²/(s² + 2 ζ ω s + ω²) peaks at ω √(1 − 2 ζ²) with 1/(2 ζ √(1 − ζ²)).
#[test]
fn h_infinity_norms_are_their_closed_forms() {
    for zeta in [1e-4_f64, 0.05, 0.3, 0.6] {
        let w = 2.0;
        let peak = rational(&[w * w], &[1.0, 2.0 * zeta * w, w * w]).h_infinity_norm().unwrap();
        let exact = 1.0 / (2.0 * zeta * (1.0 - zeta * zeta).sqrt());
        assert!((peak.gain / exact - 1.0).abs() < 1e-9, "{peak:?} {exact}");
        let frequency = w * (1.0 - 2.0 * zeta * zeta).sqrt();
        assert!((peak.frequency / frequency - 1.0).abs() < 1e-3, "{peak:?} {frequency}");
    }
    let high = rational(&[2.0, 0.0], &[1.0, 1.0]).h_infinity_norm().unwrap();
    assert!((high.gain - 2.0).abs() < 1e-7 && high.frequency > 1e3, "{high:?}");
    let all_pass = pade_delay(1.3, 6).unwrap().h_infinity_norm().unwrap();
    assert!((all_pass.gain - 1.0).abs() < 1e-6);
}

#[test]
fn an_h_infinity_norm_is_what_a_fine_search_finds_in_either_time() {
    for seed in 1..6 {
        let system = stable(6, 2, 3, seed);
        let found = system.h_infinity_norm().unwrap();
        let gain = |w: f64| system.singular_values(w).unwrap()[0];
        let searched = (0..40_000).map(|k| gain(1e-3 * f64::from(k))).fold(0.0, f64::max);
        assert!(searched <= found.gain * (1.0 + 1e-6) && searched > found.gain * (1.0 - 1e-4));
        let sampled = bilinear(&system, 0.4).unwrap().h_infinity_norm().unwrap();
        assert!((sampled.gain / found.gain - 1.0).abs() < 1e-6);
        let warped = 2.0 / 0.4 * (0.5 * sampled.frequency * 0.4).tan();
        let same = (warped - found.frequency).abs() <= 1e-3 * found.frequency.abs() + 1e-9;
        assert!(same || found.frequency.is_infinite());
    }
}

#[test]
fn zeros_are_those_of_the_numerator() {
    let system = rational(&[1.0, -2.0, 5.0], &[1.0, 3.0, 3.0, 2.0, 1.0]);
    let zeros = system.invariant_zeros().unwrap();
    assert_eq!(zeros.len(), 2, "{zeros:?}");
    assert!(has(&zeros, Complex64::new(1.0, 2.0), 1e-10), "{zeros:?}");
    assert!(rational(&[1.0], &[1.0, 3.0, 3.0, 2.0]).invariant_zeros().unwrap().is_empty());
}

/// Two inputs and two outputs: [1/(s+1), 2/(s+3); 1/(s+1), 1/(s+1)] has one zero, at s = 1.
#[test]
fn a_zero_of_two_channels_together_is_found() {
    let first = lag(1.0);
    let other = rational(&[2.0], &[1.0, 3.0]);
    let beside = append(&[&first, &other, &first, &first]).unwrap();
    let split = StateSpace::gain(mat![[1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0]], None);
    let sum = StateSpace::gain(mat![[1.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0]], None);
    let whole = series(&series(&split, &beside).unwrap(), &sum).unwrap();
    let zeros = whole.invariant_zeros().unwrap();
    assert!(has(&zeros, Complex64::new(1.0, 0.0), 1e-9), "{zeros:?}");
    // What is left are the doubled states, which no input moves or no output shows.
    assert!(zeros.iter().all(|zero| (zero - 1.0).norm() < 1e-9 || (zero + 1.0).norm() < 1e-7));
    // The first input alone leaves one state that its two outputs do not show (x = (0, 0, 1, −1)).
    let zeros = whole.selected(&[0, 1], &[0]).unwrap().invariant_zeros().unwrap();
    assert!(zeros.len() == 1 && (zeros[0] + 1.0).norm() < 1e-9, "{zeros:?}");
}

/// −x² + 2 a x + q = 0 has the stabilising root a + √(a² + q).
#[test]
fn a_scalar_riccati_equation_is_the_quadratic_formula() {
    for (a, r, q) in [(1.0_f64, 1.0_f64, 3.0_f64), (-2.0, -0.5, 1.0), (0.3, 1e6, 1e-6)] {
        let x = riccati(&mat![[a]], &mat![[r]], &mat![[q]]).unwrap()[(0, 0)];
        let exact = (a + (a * a + r * q).sqrt()) / r;
        assert!((x / exact - 1.0).abs() < 1e-13, "{x} {exact}");
    }
    let none = riccati(&mat![[-1.0]], &mat![[-1.0]], &mat![[2.0]]);
    let Err(MatrixError::NoStabilisingSolution { eigenvalue }) = none else { panic!("{none:?}") };
    assert!((eigenvalue.norm() - 1.0).abs() < 1e-12 && eigenvalue.re.abs() < 1e-12);
}

/// x = a² x/(1 + g x) + q.
#[test]
fn a_scalar_discrete_riccati_equation_is_the_quadratic_formula() {
    for (a, g, q) in [(1.2_f64, 1.0, 0.5_f64), (0.0, 2.0, 1.0), (2.0, 0.3, 0.0)] {
        let x = discrete_riccati(&mat![[a]], &mat![[g]], &mat![[q]]).unwrap()[(0, 0)];
        let half = 0.5 * (1.0 - a * a - g * q) / g;
        assert!((x - (-half + (half * half + q / g).sqrt())).abs() < 1e-13, "{x}");
    }
    let none = discrete_riccati(&mat![[1.0]], &mat![[0.0]], &mat![[1.0]]);
    assert!(matches!(none, Err(MatrixError::NoStabilisingSolution { .. })), "{none:?}");
}

#[test]
fn unmoved_and_hidden_modes_are_named() {
    let a = mat![[0.5, 0.0], [0.0, -1.0]];
    let system = |b, c| StateSpace::new(a.clone(), b, c, mat![[0.0]], None);
    let without = system(mat![[0.0], [1.0]], mat![[1.0, 1.0]]);
    assert_eq!(without.unstabilisable_mode(), Ok(Some(Complex64::new(0.5, 0.0))));
    assert_eq!(without.undetectable_mode(), Ok(None));
    let hidden = system(mat![[1.0], [0.0]], mat![[0.0, 1.0]]);
    assert_eq!(hidden.unstabilisable_mode(), Ok(None));
    assert_eq!(hidden.undetectable_mode(), Ok(Some(Complex64::new(0.5, 0.0))));
}

/// Relative gains of [1, a; b, 1]: 1/(1 − a b) on the diagonal.
#[test]
fn relative_gains_are_their_closed_form() {
    let gain = dense::complex(&mat![[1.0, 0.5], [-0.2, 1.0]]);
    let relative = relative_gain_array(&gain).unwrap();
    assert!((relative[(0, 0)] - 1.0 / 1.1).norm() < 1e-14);
    assert!((relative[(0, 0)] + relative[(0, 1)] - 1.0).norm() < 1e-14);
}

#[test]
fn delays_delay() {
    let delay = sample_delay(2, 3, 0.5).unwrap();
    let response = delay.response(0.9).unwrap();
    assert!((response[(1, 1)] - Complex64::cis(-0.9 * 1.5)).norm() < 1e-14);
    assert_eq!(response[(0, 1)], Complex64::default());
    let approximant = pade_delay(1.3, 5).unwrap().response(2.0).unwrap()[(0, 0)];
    assert!((approximant - Complex64::cis(-2.6)).norm() < 1e-4, "{approximant}");
    assert_eq!(sample_delay(1, 0, 0.5).unwrap().order(), 0);
}

/// The held lag keeps e^(−T/τ) of its state.
#[test]
fn a_held_lag_is_its_closed_form_and_comes_back() {
    let held = zero_order_hold(&lag(2.0), 0.5).unwrap();
    assert!((held.a[(0, 0)] - (-0.25_f64).exp()).abs() < 1e-15);
    assert!((held.gain_at_rest().unwrap()[(0, 0)] - 1.0).abs() < 1e-14);
    let system = stable(6, 2, 2, 7);
    let back = inverse_hold(&zero_order_hold(&system, 0.3).unwrap()).unwrap();
    assert!((&back.a - &system.a).norm_l2() < 1e-11 && (&back.b - &system.b).norm_l2() < 1e-11);
    let negative = StateSpace::new(mat![[-0.5]], mat![[1.0]], mat![[1.0]], mat![[0.0]], Some(0.1));
    assert!(matches!(inverse_hold(&negative), Err(MatrixError::PoleAt { .. })));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn the_bilinear_transformation_comes_back(seed in 1_u64..1_000_000, order in 0_usize..12) {
        let system = stable(order, 2, 3, seed);
        let sampled = bilinear(&system, 0.2).unwrap();
        prop_assert!(sampled.is_stable().unwrap());
        let back = inverse_bilinear(&sampled).unwrap();
        let near = |x: &Mat<f64>, y: &Mat<f64>| (x - y).norm_max() < 1e-11;
        prop_assert!(near(&back.a, &system.a) && near(&back.b, &system.b));
        prop_assert!(near(&back.c, &system.c) && near(&back.d, &system.d));
        // Gramians of both are the same.
        let (one, other) =
            (system.controllability_gramian().unwrap(), sampled.controllability_gramian().unwrap());
        prop_assert!((&one - &other).norm_l2() <= 1e-10 * one.norm_l2());
    }

    #[test]
    fn riccati_solutions_leave_rounding(seed in 1_u64..1_000_000, order in 1_usize..20) {
        let mut system = stable(order, 2, 2, seed);
        system.a += 0.7 * identity(order);
        let (r, q) = (&system.b * system.b.transpose(), system.c.transpose() * &system.c);
        let x = riccati(&system.a, &r, &q).unwrap();
        prop_assert!(riccati_residual(&system.a, &r, &q, &x) < 1e-12);
        let sampled = bilinear(&system, 0.1).unwrap();
        let (g, q) = (&sampled.b * sampled.b.transpose(), sampled.c.transpose() * &sampled.c);
        let x = discrete_riccati(&sampled.a, &g, &q).unwrap();
        prop_assert!(discrete_riccati_residual(&sampled.a, &g, &q, &x) < 1e-12);
    }

    #[test]
    fn balanced_truncation_keeps_its_bound(seed in 1_u64..1_000_000, kept in 1_usize..7) {
        let system = stable(7, 2, 2, seed);
        let reduced = balanced_truncation(&system, kept).unwrap();
        prop_assert_eq!(reduced.system.order(), kept);
        let gramian = reduced.system.controllability_gramian().unwrap();
        let first = reduced.hankel_singular_values[0];
        prop_assert!((gramian[(0, 0)] / first - 1.0).abs() < 1e-6);
        let difference = parallel(&system, &reduced.system.scaled(-1.0)).unwrap();
        let lost = difference.h_infinity_norm().unwrap().gain;
        prop_assert!(lost <= reduced.error_bound * (1.0 + 1e-6) + 1e-9, "{lost} {reduced:?}");
        // No system of this order is nearer than the first value left out.
        if kept < 7 {
            prop_assert!(lost >= 0.999 * reduced.hankel_singular_values[kept] - 1e-9);
        }
    }
}
