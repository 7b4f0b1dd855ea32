//! Zeros beside closed forms, and what leaves them where they are.

use super::*;
use crate::matrices::dense::{complex, complex_singular_values, identity};
use crate::matrices::{TransferFunction, append, series};
use faer::{Mat, mat};
use proptest::prelude::*;

#[test]
fn a_gain_has_no_zeros() {
    let gain = StateSpace::gain(Mat::identity(2, 2), None);
    assert_eq!(gain.invariant_zeros(), Ok(Vec::new()));
}

fn sorted(system: &StateSpace) -> Vec<Complex64> {
    let mut zeros = system.invariant_zeros().expect("it converges");
    zeros.sort_by(|a, b| a.re.total_cmp(&b.re).then(a.im.total_cmp(&b.im)));
    zeros
}

/// (p + q s)/(s + pole), a matrix, of one state for each of two inputs: p + q s = q (s + pole) + p − pole q.
fn over_one_lag(pole: f64, p: &Mat<f64>, q: &Mat<f64>) -> StateSpace {
    let a = -pole * identity(2);
    StateSpace::new(a, identity(2), p - pole * q, q.clone(), None)
}

/// G = (s − 1, 4; 4.5, 2 (s − 1))/(s + 2): det = 2 (s − 4)(s + 2)/(s + 2)², one zero, at s = 4. Source:
/// Skogestad and Postlethwaite 2005, Example 4.11.
#[test]
fn a_plant_of_a_textbook_has_the_zero_that_it_tells() {
    let plant = over_one_lag(2.0, &mat![[-1.0, 4.0], [4.5, -2.0]], &mat![[1.0, 0.0], [0.0, 2.0]]);
    let zeros = sorted(&plant);
    // Two states on each channel are one more than G needs: the zero at −2 is that of the hidden one.
    assert_eq!(zeros.len(), 2, "{zeros:?}");
    assert!((zeros[0] + 2.0).norm() < 1e-12 && (zeros[1] - 4.0).norm() < 1e-12, "{zeros:?}");
}

/// Quadruple tank of Johansson (2000): G = (γ₁ k₁/(1 + T₁ s), (1 − γ₂) k₁/((1 + T₃ s)(1 + T₁ s)); (1 − γ₁)
/// k₂/((1 + T₄ s)(1 + T₂ s)), γ₂ k₂/(1 + T₂ s)), whose zeros solve (1 + T₃ s)(1 + T₄ s) = (1 − γ₁)(1 −
/// γ₂)/(γ₁ γ₂): one is in the right half plane where γ₁ + γ₂ < 1.
fn tanks(g1: f64, g2: f64, times: [f64; 4]) -> (StateSpace, [f64; 2]) {
    let [t1, t2, t3, t4] = times;
    // States: the two lower tanks, then the upper ones.
    let a = mat![
        [-1.0 / t1, 0.0, 1.0 / t1, 0.0],
        [0.0, -1.0 / t2, 0.0, 1.0 / t2],
        [0.0, 0.0, -1.0 / t3, 0.0],
        [0.0, 0.0, 0.0, -1.0 / t4]
    ];
    let b = mat![[g1 / t1, 0.0], [0.0, g2 / t2], [0.0, (1.0 - g2) / t3], [(1.0 - g1) / t4, 0.0]];
    let c = mat![[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
    let eta = (1.0 - g1) * (1.0 - g2) / (g1 * g2);
    let (sum, product) = (t3 + t4, t3 * t4);
    let root = (sum * sum - 4.0 * product * (1.0 - eta)).sqrt();
    let zeros = [-sum - root, -sum + root].map(|twice| twice / (2.0 * product));
    (StateSpace::new(a, b, c, Mat::zeros(2, 2), None), zeros)
}

#[test]
fn four_tanks_have_the_zeros_of_their_quadratic_whatever_the_units() {
    for (g1, g2) in [(0.7, 0.6), (0.43, 0.34)] {
        let (plant, expected) = tanks(g1, g2, [62.0, 90.0, 23.0, 30.0]);
        assert_eq!(expected[1] > 0.0, g1 + g2 < 1.0);
        // Pascal and megawatts in place of metres and volts, and states of their own.
        for units in [[1.0, 1.0], [1e-7, 1e6], [1e9, 1e-5]] {
            let mut other = plant.clone();
            other.b.col_mut(0).iter_mut().for_each(|entry| *entry *= units[0]);
            other.c.row_mut(1).iter_mut().for_each(|entry| *entry *= units[1]);
            let zeros = sorted(&other);
            assert_eq!(zeros.len(), 2, "{units:?}: {zeros:?}");
            for (zero, expected) in zeros.iter().zip(expected) {
                assert!((zero - expected).norm() < 1e-10 * expected.abs().max(0.01), "{zeros:?}");
            }
        }
    }
}

/// A system whose channels have zeros of their own, mixed by matrices of full rank: the zeros are those of
/// the channels.
#[test]
fn mixing_leaves_the_channels_zeros() {
    let channel = |numerator: &[f64], denominator: &[f64]| {
        let function = TransferFunction {
            numerator: numerator.to_vec(),
            denominator: denominator.to_vec(),
            interval: Some(0.5),
        };
        function.state_space().expect("proper")
    };
    // (z − 1.25)/…, and (z² − 0.6 z + 0.34)/… with zeros at 0.3 ± 0.5 i.
    let both = append(&[
        &channel(&[1.0, -1.25], &[1.0, -1.1, 0.3]),
        &channel(&[1.0, -0.6, 0.34], &[1.0, 0.2, -0.5, 0.1]),
    ])
    .expect("the same samples");
    let mix = |matrix| StateSpace::gain(matrix, Some(0.5));
    let left = mix(mat![[1.0, 2.0], [-0.5, 1.0]]);
    let right = mix(mat![[3.0, 1.0], [1.0, -1.0]]);
    let mixed = series(&series(&right, &both).expect("two"), &left).expect("two");
    let zeros = sorted(&mixed);
    let expected = [Complex64::new(0.3, -0.5), Complex64::new(0.3, 0.5), Complex64::new(1.25, 0.0)];
    assert_eq!(zeros.len(), 3, "{zeros:?}");
    assert!(zeros.iter().zip(expected).all(|(a, b)| (a - b).norm() < 1e-10), "{zeros:?}");
}

/// A system of `order` states, two inputs and two outputs, with entries from `seed`, and two gains.
fn any(order: usize, seed: u64) -> (StateSpace, [Mat<f64>; 2]) {
    let mut state = seed;
    let mut entry = |_: usize, _: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let system = StateSpace::new(
        Mat::from_fn(order, order, &mut entry),
        Mat::from_fn(order, 2, &mut entry),
        Mat::from_fn(2, order, &mut entry),
        Mat::zeros(2, 2),
        None,
    );
    let gains = [Mat::from_fn(2, order, &mut entry), Mat::from_fn(order, 2, &mut entry)];
    (system, gains)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// With C B regular there are as many zeros as states less outputs; at each the pencil drops in rank; and
    /// neither feedback of the state nor injection of the output moves them.
    #[test]
    fn zeros_are_where_the_pencil_drops_in_rank(seed in 1_u64..1_000_000, order in 2_usize..9) {
        let (system, [back, injected]) = any(order, seed);
        let [largest, least] = {
            let values = complex_singular_values(&complex(&(&system.c * &system.b))).unwrap();
            [values[0], values[1]]
        };
        prop_assume!(least > 0.05 * largest);
        let zeros = system.invariant_zeros().unwrap();
        prop_assert_eq!(zeros.len(), order - 2);
        for zero in &zeros {
            let pencil = Mat::from_fn(order + 2, order + 2, |i, j| {
                let whole = match (i < order, j < order) {
                    (true, true) => system.a[(i, j)],
                    (true, false) => system.b[(i, j - order)],
                    (false, true) => system.c[(i - order, j)],
                    (false, false) => 0.0,
                };
                Complex64::new(whole, 0.0) - if i == j && i < order { *zero } else { Complex64::default() }
            });
            let values = complex_singular_values(&pencil).unwrap();
            prop_assert!(values[order + 1] < 1e-9 * values[0], "{values:?}");
        }
        let moved = StateSpace::new(
            &system.a - &system.b * &back + &injected * &system.c,
            system.b.clone(),
            system.c.clone(),
            system.d.clone(),
            None,
        );
        for zero in moved.invariant_zeros().unwrap() {
            let nearest = zeros.iter().map(|other| (other - zero).norm()).fold(f64::INFINITY, f64::min);
            prop_assert!(nearest < 1e-6 * (1.0 + zero.norm()), "{zero} {zeros:?}");
        }
    }
}
