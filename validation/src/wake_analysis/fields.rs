//! Flux, available power and budget of a wake that is given in closed form.

use crate::Row;
use crate::row::Tolerance::{AtMost, Within};
use analysis::entrainment::{MeanFlow, Region, available_power, budget, flux_through_tube};
use analysis::phases::Decomposition;
use basis::records::Grid;

const CLOSED: &str = "closed form";
/// Wind (m/s), rotor diameter (m), and the stress at its edge (m²/s²).
const WIND: f64 = 5.0;
const DIAMETER: f64 = 0.58;
const STRESS: f64 = 0.3;

fn filled(grid: &Grid, value: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
    (0..grid.len()).map(|index| value(grid.position(grid.place(index)))).collect()
}

/// A wake of u = U (1 − a e^{−r²/b²}) with ⟨u'u_r'⟩ = −s (r/R) e^{½ (1 − r²/R²)}, on the published grid.
fn wake() -> (Grid, Decomposition) {
    let grid =
        Grid { origin: [0.4, -0.4, -0.4], spacing: [0.1, 0.01, 0.01], n_points: [6, 81, 81] };
    let zeros = || vec![0.0; grid.len()];
    let radius = 0.5 * DIAMETER;
    let over_r = move |[_, y, z]: [f64; 3]| {
        let square = (y * y + z * z) / (radius * radius);
        -STRESS / radius * (0.5 * (1.0 - square)).exp()
    };
    let stresses = || {
        let uv = filled(&grid, |at| over_r(at) * at[1]);
        let uw = filled(&grid, |at| over_r(at) * at[2]);
        [zeros(), zeros(), zeros(), uv, uw, zeros()]
    };
    let u = filled(&grid, |[_, y, z]| speed(y * y + z * z));
    let found = Decomposition {
        mean: [u, zeros(), zeros()],
        total: stresses(),
        periodic: [zeros(), zeros(), zeros(), zeros(), zeros(), zeros()],
        random: stresses(),
        ..Decomposition::default()
    };
    (grid, found)
}

fn speed(square: f64) -> f64 {
    WIND * (1.0 - 0.6 * (-square / (0.25 * 0.25)).exp())
}

/// Mean of the cube of the wake's speed over the free stream over the disc, by many rings.
fn mean_cube() -> f64 {
    let n = 100_000;
    let radius = 0.5 * DIAMETER;
    let ring = |i: usize| (speed(radius * radius * (i as f64 + 0.5) / n as f64) / WIND).powi(3);
    (0..n).map(ring).sum::<f64>() / n as f64
}

pub(super) fn rows() -> Vec<Row> {
    let (grid, found) = wake();
    let radius = 0.5 * DIAMETER;
    let points = flux_through_tube(&found, &grid, [0.0, 0.0], radius);
    let flux = points.first().map_or(f64::NAN, |point| point.total);
    let power = available_power(&grid, &found.mean[0], (0.6, [0.0, 0.0]), radius, WIND);
    let region = Region { steps: [[0, 5], [20, 60], [20, 60]] };
    let flow = MeanFlow { grid: &grid, mean: &found.mean, stress: &found.total, pressure: None };
    let parts = budget(&flow, &region).unwrap_or_default();
    // What stresses carry in, less what they hand over to fluctuations: −∫ ū ∂ⱼ⟨u'uⱼ'⟩ dV, by points.
    let divergence = filled(&grid, |[_, y, z]| {
        let square = (y * y + z * z) / (radius * radius);
        let over = -STRESS / radius * (0.5 * (1.0 - square)).exp();
        -speed(y * y + z * z) * over * (2.0 - square)
    });
    let weight = |step: usize, ends: [usize; 2]| if ends.contains(&step) { 0.5 } else { 1.0 };
    let mut expected = 0.0;
    for (index, value) in divergence.iter().enumerate() {
        let place = grid.place(index);
        let is_in = (0..3).all(|a| (region.steps[a][0]..=region.steps[a][1]).contains(&place[a]));
        if is_in {
            let share: f64 = (0..3).map(|a| weight(place[a], region.steps[a])).product();
            expected += share * value * grid.spacing.iter().product::<f64>();
        }
    }
    let error = (parts.turbulent_flux + parts.production - expected).abs() / expected.abs();
    vec![
        Row {
            what: "flux of mean kinetic energy through a tube at the rotor's edge, points 0.017 D apart".to_owned(),
            measured: flux / WIND.powi(3),
            expected: STRESS * speed(radius * radius) / WIND.powi(3),
            tolerance: Within(1e-4),
            unit: "U³",
            source: CLOSED,
        },
        Row {
            what: "fraction of available power of a Gaussian wake, points 0.017 D apart".to_owned(),
            measured: power.map_or(f64::NAN, |one| one.fraction),
            expected: mean_cube(),
            tolerance: Within(1e-3),
            unit: "–",
            source: CLOSED,
        },
        Row {
            what: "flux by stresses and production in a box against the work of their divergence: error".to_owned(),
            measured: 100.0 * error,
            expected: 1.0,
            tolerance: AtMost,
            unit: "%",
            source: CLOSED,
        },
    ]
}
