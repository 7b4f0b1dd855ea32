//! The backward pass against closed forms and against least squares over all of a record.

use super::*;
use crate::helix::state_estimate::{MEAN_WIND, WAVE};
use crate::helix::transition::identity;

/// A linear world: states that go over by `transition` with process noise, and one reading of their sum by
/// `slopes` at each instant.
struct Linear {
    transition: Transition,
    /// Variances of the process noise of each state at each step.
    incoming: Vector,
    slopes: Vector,
    /// Variance of the noise of a reading.
    noise: f64,
}

impl Linear {
    /// Filter and smoother from `start` over `readings`: filtered and smoothed states.
    fn run(&self, start: &StateEstimate, readings: &[f64]) -> [Vec<StateEstimate>; 2] {
        let mut state = start.clone();
        let (mut filtered, mut predicted) = (Vec::new(), Vec::new());
        for (index, reading) in readings.iter().enumerate() {
            if index > 0 {
                state.mean = std::array::from_fn(|row| dot(&self.transition[row], &state.mean));
                state.carry(&self.transition);
                state.spread(&self.incoming, &[]);
            }
            predicted.push(state.clone());
            let innovation = reading - dot(&self.slopes, &state.mean);
            state.correct(&self.slopes, innovation, self.noise);
            filtered.push(state.clone());
        }
        let mut smoothed = vec![state];
        for index in (1..readings.len()).rev() {
            let next = smoothed.last().expect("one at least");
            let (before, after) = (&filtered[index - 1], &predicted[index]);
            smoothed.push(back(before, &self.transition, after, next, |_| false));
        }
        smoothed.reverse();
        [filtered, smoothed]
    }
}

#[test]
fn a_random_walk_has_the_variance_of_the_closed_form() {
    let mut incoming = [0.0; N_STATES];
    let mut slopes = [0.0; N_STATES];
    let (walk, noise) = (0.03, 2.0);
    (incoming[MEAN_WIND], slopes[MEAN_WIND]) = (walk, 1.0);
    let world = Linear { transition: identity(), incoming, slopes, noise };
    let mut start = StateEstimate::zero();
    start.covariance[MEAN_WIND][MEAN_WIND] = 1.0;
    let [filtered, smoothed] = world.run(&start, &[0.0; 400]);
    let variance = |states: &[StateEstimate]| states[200].covariance[MEAN_WIND][MEAN_WIND];
    // In the middle of a long record, with q = walk and r = noise: (√(q² + 4qr) − q)/2 from the past, and
    // qr/√(q² + 4qr) from both sides.
    let root = f64::sqrt(walk * walk + 4.0 * walk * noise);
    assert!((variance(&filtered) / (0.5 * (root - walk)) - 1.0).abs() < 1e-12);
    assert!((variance(&smoothed) / (walk * noise / root) - 1.0).abs() < 1e-12);
    // At the end nothing is known of the future.
    assert_eq!(filtered[399], smoothed[399]);
}

/// Solves `matrix` x = e for each unit vector e: the inverse, by elimination with pivots.
fn inverse(matrix: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let n = matrix.len();
    let mut rows: Vec<Vec<f64>> = matrix
        .iter()
        .enumerate()
        .map(|(index, row)| {
            let unit = (0..n).map(|column| if column == index { 1.0 } else { 0.0 });
            row.iter().copied().chain(unit).collect()
        })
        .collect();
    for column in 0..n {
        let size = |row: &usize| rows[*row][column].abs();
        let pivot = (column..n).max_by(|a, b| size(a).total_cmp(&size(b))).expect("rows");
        rows.swap(column, pivot);
        let scale = 1.0 / rows[column][column];
        rows[column].iter_mut().for_each(|value| *value *= scale);
        for row in (0..n).filter(|row| *row != column) {
            let factor = rows[row][column];
            let pivot = rows[column].clone();
            for (value, taken) in rows[row].iter_mut().zip(pivot) {
                *value -= factor * taken;
            }
        }
    }
    rows.into_iter().map(|row| row[n..].to_vec()).collect()
}

#[test]
fn a_turning_wave_is_that_of_least_squares_over_the_whole_record() {
    const N: usize = 14;
    let (angle, noise) = (0.7_f64, 0.4);
    let deviations = [0.05_f64, 0.02];
    let (sine, cosine) = angle.sin_cos();
    let turn = [[cosine, -sine], [sine, cosine]];
    let readings: Vec<f64> =
        (0..N).map(|k| (1.3 * k as f64).sin() + 0.1 * (k % 3) as f64).collect();
    let (mut transition, mut incoming, mut slopes) = (identity(), [0.0; N_STATES], [0.0; N_STATES]);
    let mut start = StateEstimate::zero();
    for a in 0..2 {
        (incoming[WAVE + a], slopes[WAVE + a]) = (deviations[a], 0.8 - 0.5 * a as f64);
        (start.mean[WAVE + a], start.covariance[WAVE + a][WAVE + a]) = (0.3, 1.5);
        for b in 0..2 {
            transition[WAVE + a][WAVE + b] = turn[a][b];
        }
    }
    start.covariance[WAVE][WAVE + 1] = 0.4;
    start.covariance[WAVE + 1][WAVE] = 0.4;
    let world = Linear { transition, incoming, slopes, noise };
    let [_, smoothed] = world.run(&start, &readings);

    // Information of all states at once: the beginning, each step, each reading.
    let mut information = vec![vec![0.0; 2 * N]; 2 * N];
    let mut pull = vec![0.0; 2 * N];
    let prior = inverse(&[vec![1.5, 0.4], vec![0.4, 1.5]]);
    for a in 0..2 {
        for b in 0..2 {
            information[a][b] += prior[a][b];
            pull[a] += prior[a][b] * 0.3;
        }
    }
    for k in 0..N {
        for a in 0..2 {
            pull[2 * k + a] += slopes[WAVE + a] * readings[k] / noise;
            for b in 0..2 {
                information[2 * k + a][2 * k + b] += slopes[WAVE + a] * slopes[WAVE + b] / noise;
            }
        }
        if k + 1 == N {
            break;
        }
        // Σ (x' − F x)²/q over both states.
        for (state, variance) in deviations.into_iter().enumerate() {
            let row: [(usize, f64); 3] = [
                (2 * (k + 1) + state, 1.0),
                (2 * k, -turn[state][0]),
                (2 * k + 1, -turn[state][1]),
            ];
            for (a, of_a) in row {
                for (b, of_b) in row {
                    information[a][b] += of_a * of_b / variance;
                }
            }
        }
    }
    let covariance = inverse(&information);
    for k in 0..N {
        for a in 0..2 {
            let mean = dot_of(&covariance[2 * k + a], &pull);
            assert!((smoothed[k].mean[WAVE + a] - mean).abs() < 1e-10, "{k} {a}");
            for b in 0..2 {
                let found = smoothed[k].covariance[WAVE + a][WAVE + b];
                assert!((found - covariance[2 * k + a][2 * k + b]).abs() < 1e-10, "{k} {a} {b}");
            }
        }
    }
}

fn dot_of(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn an_angle_comes_back_the_short_way_round() {
    let mut filtered = StateEstimate::zero();
    let phase = WAVE + 1;
    (filtered.mean[phase], filtered.covariance[phase][phase]) = (3.1, 0.5);
    let mut predicted = filtered.clone();
    predicted.covariance[phase][phase] = 1.0;
    let mut next = predicted.clone();
    // 0.04 rad beyond half a turn, as it is told between −π and π.
    (next.mean[phase], next.covariance[phase][phase]) = (-3.1, 0.25);
    let found = back(&filtered, &identity(), &predicted, &next, |index| index == phase);
    let ahead = std::f64::consts::TAU - 6.2;
    assert!((found.mean[phase] - (3.1 + 0.5 * ahead)).abs() < 1e-12);
    assert!((found.covariance[phase][phase] - (0.5 + 0.25 * (0.25 - 1.0))).abs() < 1e-12);
}

#[test]
fn a_state_that_is_another_is_left_out() {
    // Two states in step, and a third one of its own: a singular covariance.
    let mut covariance = [[0.0; N_STATES]; N_STATES];
    for row in &mut covariance[..2] {
        row[..2].fill(4.0);
    }
    covariance[5][5] = 9.0;
    let mut right = [0.0; N_STATES];
    (right[0], right[1], right[5]) = (8.0, 8.0, 18.0);
    let x = Factor::of(&covariance).solve(right);
    assert!((x[0] + x[1] - 2.0).abs() < 1e-12 && (x[5] - 2.0).abs() < 1e-12, "{x:?}");
    assert!(x[2..5].iter().chain(&x[6..]).all(|value| *value == 0.0));
}
