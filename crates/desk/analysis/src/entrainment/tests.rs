//! Fluxes, discs and budgets of fields that are given in closed form.

use super::*;
use crate::phases::Decomposition;
use basis::records::Grid;

fn filled(grid: &Grid, value: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
    (0..grid.len()).map(|index| value(grid.position(grid.place(index)))).collect()
}

/// ū = 5 + z, ⟨u'w'⟩ = −(0.1 + 0.05 x) z, a third of it periodic.
fn sheared() -> (Grid, Decomposition) {
    let grid = Grid { origin: [0.0, 0.0, -1.0], spacing: [0.5, 1.0, 0.1], n_points: [9, 1, 21] };
    let stress = |share: f64| filled(&grid, move |[x, _, z]| -share * (0.1 + 0.05 * x) * z);
    let zeros = || vec![0.0; grid.len()];
    let with = |uw: Vec<f64>| [zeros(), zeros(), zeros(), zeros(), uw, zeros()];
    let found = Decomposition {
        mean: [filled(&grid, |[_, _, z]| 5.0 + z), zeros(), zeros()],
        total: with(stress(1.0)),
        periodic: with(stress(1.0 / 3.0)),
        random: with(stress(2.0 / 3.0)),
        n_bins: vec![12; grid.len()],
        fewest: vec![100; grid.len()],
    };
    (grid, found)
}

/// Fast air that comes down through the upper edge, and up through the lower one, is a positive flux.
#[test]
fn energy_that_enters_from_either_side_is_positive() {
    let (grid, found) = sheared();
    for (z, inward) in [(0.5, -1.0), (-0.5, 1.0)] {
        let edge = Edge { axis: 2, place: [0.0, z], inward };
        let points = flux_along(&found, &grid, &edge);
        assert_eq!(points.len(), 9);
        for point in &points {
            let expected = (0.1 + 0.05 * point.x) * 0.5 * (5.0 + z);
            assert!((point.total - expected).abs() < 1e-12, "{point:?}");
            assert!((point.periodic + point.random - point.total).abs() < 1e-12);
        }
        let expected = (0.1 * 4.0 + 0.05 * 8.0) * 0.5 * (5.0 + z);
        assert!((integral(&points, |point| point.total) - expected).abs() < 1e-12);
    }
    let outside = Edge { axis: 2, place: [0.0, 3.0], inward: -1.0 };
    assert!(flux_along(&found, &grid, &outside).is_empty());
}

/// A stress −τ r along the radius: through the tube of radius R its flux is τ R ū.
#[test]
fn the_flux_through_a_tube_is_that_of_its_radial_stress() {
    let grid = Grid { origin: [0.0, -1.0, -1.0], spacing: [1.0, 0.1, 0.1], n_points: [2, 21, 21] };
    let zeros = || vec![0.0; grid.len()];
    let stresses = || {
        let uv = filled(&grid, |[_, y, _]| -0.2 * y);
        let uw = filled(&grid, |[_, _, z]| -0.2 * z);
        [zeros(), zeros(), zeros(), uv, uw, zeros()]
    };
    let found = Decomposition {
        mean: [vec![4.0; grid.len()], zeros(), zeros()],
        total: stresses(),
        periodic: stresses().map(|values| vec![0.0; values.len()]),
        random: stresses(),
        ..Decomposition::default()
    };
    let points = flux_through_tube(&found, &grid, [0.0, 0.0], 0.6);
    assert_eq!(points.len(), 2);
    assert!((points[0].total - 0.2 * 0.6 * 4.0).abs() < 1e-12 && points[0].periodic == 0.0);
    assert!(flux_through_tube(&found, &grid, [0.0, 0.0], 1.5).is_empty());
}

#[test]
fn the_flux_flips_where_it_does() {
    let point = |x: f64| FluxPoint { x, total: (x - 2.03) * 0.1, periodic: 0.0, random: 0.0 };
    let points: Vec<FluxPoint> = (0..40).map(|i| point(0.1 * f64::from(i))).collect();
    assert!((sign_flip(&points, 0.0).unwrap() - 2.03).abs() < 1e-12);
    assert!((sign_flip(&points, 0.4).unwrap() - 2.03).abs() < 1e-9);
    assert_eq!(sign_flip(&points[25..], 0.0), None);
}

#[test]
fn the_edge_of_a_wake_is_where_the_speed_comes_back() {
    let grid = Grid { origin: [0.0, 0.0, -1.0], spacing: [1.0, 1.0, 0.05], n_points: [1, 1, 41] };
    // A jet of still faster air in the middle must not end the search.
    let u =
        filled(&grid, |[_, _, z]| if z.abs() < 0.1 { 6.0 } else { (2.0 + 5.0 * z.abs()).min(5.0) });
    let edge = wake_edge(&grid, &u, (0.0, [0.0, 0.0]), (2, 1.0), 0.9 * 5.0).unwrap();
    assert!((edge - 0.5).abs() < 1e-9, "{edge}");
    assert_eq!(wake_edge(&grid, &u, (0.0, [0.0, 0.0]), (2, -1.0), 7.0), None);
}

/// u = 5 (0.6 + 0.4 (r/R)²) of a disc: the mean of the cube in closed form.
#[test]
fn available_power_is_the_mean_cube() {
    let grid =
        Grid { origin: [0.0, -1.0, -1.0], spacing: [1.0, 0.02, 0.02], n_points: [2, 101, 101] };
    let u = filled(&grid, |[_, y, z]| 5.0 * (0.6 + 0.4 * (y * y + z * z) / 0.64));
    let found = available_power(&grid, &u, (0.5, [0.0, 0.0]), 0.8, 5.0).unwrap();
    // ∫₀¹ (0.6 + 0.4 s)³ ds = (1 − 0.6⁴) / 1.6.
    let expected = (1.0 - 0.6_f64.powi(4)) / 1.6;
    assert!((found.fraction / expected - 1.0).abs() < 1e-3 && found.covered == 1.0);
    let beyond = available_power(&grid, &u, (0.5, [0.0, 0.0]), 1.2, 5.0).unwrap_err();
    assert!(matches!(beyond, DiscError::Uncovered { covered, .. } if covered < 0.9));
    let line = Grid { n_points: [2, 101, 1], ..grid };
    assert_eq!(available_power(&line, &u, (0.5, [0.0, 0.0]), 0.8, 5.0), Err(DiscError::NoArea));
}

/// Uniform flow past a point source, which obeys Bernoulli, with stresses of their own: advection and
/// pressure cancel; the flux by stresses and production add up to −∫ ūᵢ ∂ⱼ⟨uᵢ'uⱼ'⟩ dV.
#[test]
fn a_budget_closes_with_its_pressure_and_its_stresses() {
    let residual = |spacing: f64| {
        let n = (2.0 / spacing).round() as usize + 1;
        let grid = Grid { origin: [1.0, -1.0, -1.0], spacing: [spacing; 3], n_points: [n; 3] };
        let at = |[x, y, z]: [f64; 3]| {
            let cube = (x * x + y * y + z * z).powf(1.5);
            [3.0 + 1.5 * x / cube, 1.5 * y / cube, 1.5 * z / cube]
        };
        let mean: [Vec<f64>; 3] = std::array::from_fn(|i| filled(&grid, |p| at(p)[i]));
        let pressure = filled(&grid, |p| -0.5 * at(p).iter().map(|u| u * u).sum::<f64>());
        let zeros = || vec![0.0; grid.len()];
        // ⟨u'w'⟩ = −0.3 z alone: its divergence along z is −0.3, so the sum of both is 0.3 ∫ ū dV.
        let uw = filled(&grid, |[_, _, z]| -0.3 * z);
        let stress = [zeros(), zeros(), zeros(), zeros(), uw, zeros()];
        let flow =
            MeanFlow { grid: &grid, mean: &mean, stress: &stress, pressure: Some(&pressure) };
        let region = Region { steps: [[0, n - 1]; 3] };
        let found = budget(&flow, &region).unwrap();
        // ∂⟨u'w'⟩/∂x = 0, so w takes no part: ∫ ū dV by the same sum.
        let whole =
            MeanFlow { stress: &[zeros(), zeros(), zeros(), zeros(), zeros(), zeros()], ..flow };
        assert_eq!(budget(&whole, &region).unwrap().turbulent_flux, 0.0);
        let volume: f64 = filled(&grid, |p| {
            let edge = |axis: usize, low: f64| {
                if (p[axis] - low).abs() < 1e-9 || (p[axis] - low - 2.0).abs() < 1e-9 {
                    0.5
                } else {
                    1.0
                }
            };
            at(p)[0] * edge(0, 1.0) * edge(1, -1.0) * edge(2, -1.0)
        })
        .iter()
        .sum::<f64>()
            * spacing.powi(3);
        let stresses = found.turbulent_flux + found.production - 0.3 * volume;
        let bernoulli = found.advection + found.pressure;
        assert!((found.volume - 8.0).abs() < 1e-9);
        (bernoulli.abs() / found.scale, stresses.abs() / (0.3 * volume))
    };
    let (coarse, fine) = (residual(0.2), residual(0.1));
    // Bernoulli holds point by point: nothing is left but rounding. The stresses close to second order.
    assert!(fine.0 < 1e-12 && fine.1 < 0.01, "{fine:?}");
    assert!(coarse.1 / fine.1 > 3.0, "{coarse:?} {fine:?}");
}

#[test]
fn a_budget_with_a_hole_is_none() {
    let grid = Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [3; 3] };
    let mut mean: [Vec<f64>; 3] = std::array::from_fn(|_| vec![1.0; 27]);
    let stress: [Vec<f64>; 6] = std::array::from_fn(|_| vec![0.0; 27]);
    let whole = Region { steps: [[0, 2]; 3] };
    let of = |mean: &[Vec<f64>; 3], region: &Region| {
        budget(&MeanFlow { grid: &grid, mean, stress: &stress, pressure: None }, region)
    };
    assert!(of(&mean, &whole).is_some());
    assert!(of(&mean, &Region { steps: [[0, 3], [0, 2], [0, 2]] }).is_none());
    mean[0][4] = f64::NAN;
    assert!(of(&mean, &whole).is_none());
}
