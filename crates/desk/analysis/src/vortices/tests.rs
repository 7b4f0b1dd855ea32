//! Criteria and fits against vortices whose place, circulation and core are known.

use super::*;
use basis::records::Grid;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// A Lamb-Oseen vortex at `place` of `circulation` and length `length`: velocity at `at`.
pub(super) fn lamb_oseen(place: [f64; 2], circulation: f64, length: f64, at: [f64; 2]) -> [f64; 2] {
    let [x, y] = [at[0] - place[0], at[1] - place[1]];
    let square = x * x + y * y;
    if square == 0.0 {
        return [0.0; 2];
    }
    let turn = -circulation * (-square / (length * length)).exp_m1() / (TAU * square);
    [-y * turn, x * turn]
}

pub(super) fn section(
    n_points: [usize; 2],
    spacing: f64,
    velocity: impl Fn([f64; 2]) -> [f64; 2],
) -> Section {
    let mut section = Section {
        origin: [-1.0, -1.0],
        spacing: [spacing; 2],
        n_points,
        velocity: [Vec::new(), Vec::new()],
    };
    for index in 0..n_points[0] * n_points[1] {
        let [u, v] = velocity(section.position(index));
        section.velocity[0].push(u);
        section.velocity[1].push(v);
    }
    section
}

proptest! {
    /// Place within 2 % of a core, circulation within 1 %, anywhere between the points, in air that drifts
    /// and strains.
    #[test]
    fn a_vortex_is_found_with_circulation_and_core(
        x in -0.2..0.2_f64, y in -0.2..0.2_f64, strength in 0.2..3.0_f64, is_positive: bool,
        length in 0.09..0.25_f64, drift in prop::array::uniform2(-8.0..8.0_f64), strain in -0.3..0.3_f64,
    ) {
        let circulation = if is_positive { strength } else { -strength };
        let velocity = |at: [f64; 2]| {
            let own = lamb_oseen([x, y], circulation, length, at);
            [own[0] + drift[0] + strain * at[0], own[1] + drift[1] - strain * at[1]]
        };
        let section = section([51, 51], 0.04, velocity);
        let peak = strength / (PI * length * length);
        let search = Search {
            least_vorticity: 0.3 * peak,
            separation: 0.2,
            within: [[-0.9, 0.9]; 2],
            most_misfit: 0.05,
        };
        let (found, n_lost) = vortices(&section, &search);
        prop_assert_eq!((found.len(), n_lost), (1, 0));
        let core = PEAK_OVER_LENGTH * length;
        let away = (found[0].position[0] - x).hypot(found[0].position[1] - y);
        prop_assert!(away < 1e-5 * core, "{away}");
        prop_assert!((found[0].circulation / circulation - 1.0).abs() < 1e-5);
        prop_assert!((found[0].core_radius / core - 1.0).abs() < 1e-5);
        prop_assert!((found[0].drift[0] - drift[0] - strain * x).abs() < 1e-5);
        prop_assert!((found[0].peak_vorticity() / (circulation / (PI * length * length)) - 1.0).abs() < 1e-4);
        let speed = lamb_oseen([0.0; 2], strength, length, [core, 0.0])[1];
        prop_assert!((found[0].peak_speed() / speed - 1.0).abs() < 1e-4);
    }

    /// In a linear field u = G x: Q, vorticity and λ₂ of the matrix itself.
    #[test]
    fn criteria_of_a_linear_field_are_those_of_its_matrix(
        values in prop::array::uniform9(-2.0..2.0_f64),
    ) {
        let g: Gradient = std::array::from_fn(|i| std::array::from_fn(|j| values[3 * i + j]));
        let grid = Grid { origin: [0.0; 3], spacing: [0.5, 1.0, 2.0], n_points: [3, 3, 3] };
        let component = |i: usize| (0..grid.len()).map(|index| {
            let at = grid.position(grid.place(index));
            (0..3).map(|j| g[i][j] * at[j]).sum::<f64>()
        }).collect();
        let velocity: [Vec<f64>; 3] = std::array::from_fn(component);
        let found = gradients(&grid, &velocity)[13];
        let own = vorticity(&found);
        prop_assert!((own[2] - (g[1][0] - g[0][1])).abs() < 1e-9);
        // Q = ½ (|Ω|² − |S|²) + ½ (tr)².
        let (mut turn, mut strain) = (0.0, 0.0);
        for (i, row) in g.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                turn += (0.5 * (value - g[j][i])).powi(2);
                strain += (0.5 * (value + g[j][i])).powi(2);
            }
        }
        let trace = g[0][0] + g[1][1] + g[2][2];
        prop_assert!((q_criterion(&found) - 0.5 * (turn - strain + trace * trace)).abs() < 1e-8);
        // λ₂ is an eigenvalue: the determinant of S² + Ω² − λ is zero, and one is on each side.
        let middle = lambda_2(&found);
        let m: Gradient = std::array::from_fn(|i| std::array::from_fn(|j| {
            let s = |a: usize, b: usize| 0.5 * (g[a][b] + g[b][a]);
            let o = |a: usize, b: usize| 0.5 * (g[a][b] - g[b][a]);
            (0..3).map(|k| s(i, k) * s(k, j) + o(i, k) * o(k, j)).sum::<f64>()
                - if i == j { middle } else { 0.0 }
        }));
        let minor = |a: usize, b: usize, c: usize, d: usize| m[1][a] * m[2][b] - m[1][c] * m[2][d];
        let determinant = m[0][0] * minor(1, 2, 2, 1) - m[0][1] * minor(0, 2, 2, 0)
            + m[0][2] * minor(0, 1, 1, 0);
        let size: f64 = m.iter().flatten().map(|v| v * v).sum::<f64>().sqrt() + middle.abs();
        prop_assert!(determinant.abs() <= 1e-9 * size.powi(3).max(1e-12), "{determinant} {size}");
        // The middle one: not all the others on one side of it.
        let principal = (0..3).map(|i| {
            let (a, b) = ((i + 1) % 3, (i + 2) % 3);
            m[a][a] * m[b][b] - m[a][b] * m[b][a]
        }).sum::<f64>();
        prop_assert!(principal <= 1e-9 * size * size.max(1e-12));
    }
}

/// Of two vortices nearer than three cores each is found, as far as the strain of the other allows: 1 %.
#[test]
fn neighbours_do_not_spoil_a_fit() {
    let length = 0.08;
    let velocity = |at: [f64; 2]| {
        let [a, b] = [[-0.17, 0.02], [0.17, -0.03]].map(|place| lamb_oseen(place, 1.0, length, at));
        [a[0] + b[0] + 5.0, a[1] + b[1]]
    };
    let section = section([67, 67], 0.03, velocity);
    let search = Search {
        least_vorticity: 10.0,
        separation: 0.1,
        within: [[-0.9, 0.9]; 2],
        most_misfit: 0.1,
    };
    let (mut found, _) = vortices(&section, &search);
    found.sort_by(|a, b| a.position[0].total_cmp(&b.position[0]));
    assert_eq!(found.len(), 2);
    for (vortex, place) in found.iter().zip([[-0.17, 0.02], [0.17, -0.03]]) {
        let away = (vortex.position[0] - place[0]).hypot(vortex.position[1] - place[1]);
        assert!(away < 0.02 * vortex.core_radius, "{away}");
        assert!((vortex.circulation - 1.0).abs() < 0.01, "{}", vortex.circulation);
    }
}

/// Γ₁ is ±1 in the middle of a vortex that stands still; Γ₂ stays that in air that drifts.
#[test]
fn turning_is_one_in_the_middle_and_knows_no_drift() {
    let still = section([21, 21], 0.1, |at| lamb_oseen([0.0, 0.0], -1.0, 0.3, at));
    let middle = 10 * 21 + 10;
    let (first, second) = still.turning(3);
    assert!((first[middle] + 1.0).abs() < 1e-9 && (second[middle] + 1.0).abs() < 1e-9);
    let drifting = section([21, 21], 0.1, |at| {
        let [u, v] = lamb_oseen([0.0, 0.0], -1.0, 0.3, at);
        [u + 7.0, v]
    });
    let (first, second) = drifting.turning(3);
    assert!(first[middle].abs() < 0.2 && (second[middle] + 1.0).abs() < 1e-9);
    assert!(first[0].is_nan());
}

/// What is fitted tells Γ₁ and Γ₂ too: in air that drifts Γ₂ of a core alone shows it, and none at an edge.
#[test]
fn a_fitted_vortex_tells_how_it_turns() {
    let drifting = section([31, 31], 0.05, |at| {
        let [u, v] = lamb_oseen([0.01, -0.02], -1.0, 0.2, at);
        [u + 7.0, v]
    });
    let vortex = fit_vortex(&drifting, [0.0, 0.0], 0.2).expect("a vortex");
    let [first, second] = vortex.turning.expect("a window");
    // Where the middle stands between points, the window is a little off it.
    assert!((-1.0..-0.9).contains(&second) && first.abs() < 0.2, "{first} {second}");
    let at_the_edge = section([31, 31], 0.05, |at| lamb_oseen([-0.9, 0.0], -1.0, 0.2, at));
    let vortex = fit_vortex(&at_the_edge, [-0.9, 0.0], 0.2).expect("a vortex");
    assert_eq!(vortex.turning, None);
}

#[test]
fn a_hole_in_the_core_and_plain_shear_are_no_vortex_made_up() {
    let shear = section([31, 31], 0.06, |at| [4.0 * at[1], 0.0]);
    let search = Search {
        least_vorticity: 1.0,
        separation: 0.1,
        within: [[-1.0, 1.0]; 2],
        most_misfit: 0.2,
    };
    assert!(vortices(&shear, &search).0.is_empty());
    let mut holed = section([31, 31], 0.06, |at| lamb_oseen([0.0, 0.0], 1.0, 0.2, at));
    for values in &mut holed.velocity {
        values[15 * 31 + 15] = f64::NAN;
    }
    for vortex in vortices(&holed, &search).0 {
        assert!(vortex.position.iter().all(|x| x.abs() < 0.05) && vortex.circulation.is_finite());
    }
}
