//! A disc of uniform thrust against momentum theory in a box of the same blockage.

use super::{advance, lattice};
use crate::Row;
use crate::folds::larger;
use crate::row::Tolerance::Within;
use basis::{PointForce, Vector3};
use flow::WindField;
use flow::lattice::spreading::Spreader;
use flow::lattice::{Ground, Lattice, LatticeSettings};
use std::f64::consts::PI;

/// Where the expected values come from.
const SOURCE: &str = "momentum theory of a disc in a duct (Garrett, Cummins 2007)";

const DIAMETER: f64 = 100.0;
const SPEED: f64 = 10.0;
const WIDTH: f64 = 4.0;
const CELLS_PER_DIAMETER: f64 = 24.0;
/// Diameters of wind that pass before the wake is looked at.
const SETTLING: f64 = 9.0;

/// Wind at the disc, and head lost in it, for two thrust coefficients.
pub fn momentum_theory() -> Vec<Row> {
    [0.4, 0.8].into_iter().flat_map(disc).collect()
}

/// Momentum theory of a disc in a duct, speeds over that far upstream: at the disc, in the wake, beside it.
///
/// Bernoulli beside the wake and along it, mass and momentum of the whole duct: Garrett, Cummins (2007), J.
/// Fluid Mech. 588, 243. `blockage` is the disc's share of the cross-section (–).
fn ducted_disc(thrust_coefficient: f64, blockage: f64) -> [f64; 3] {
    let speeds = |beside: f64| {
        let wake = (beside * beside - thrust_coefficient).sqrt();
        [wake * (beside - 1.0) / (blockage * (beside - wake)), wake, beside]
    };
    let momentum = |beside: f64| {
        let [disc, wake, _] = speeds(beside);
        let pressure = 0.5 * (beside * beside - 1.0) / blockage;
        let outflow =
            beside * beside * (1.0 / blockage - disc / wake) + wake * disc - 1.0 / blockage;
        pressure - 0.5 * thrust_coefficient - outflow
    };
    let (mut low, mut high) = (thrust_coefficient.sqrt().max(1.0) + 1e-9, 1.5);
    let sign = momentum(low).signum();
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if momentum(middle).signum() == sign { low = middle } else { high = middle }
    }
    speeds(low)
}

fn disc(thrust_coefficient: f64) -> Vec<Row> {
    let spacing = DIAMETER / CELLS_PER_DIAMETER;
    let cells = |diameters: f64| (diameters * CELLS_PER_DIAMETER).round() as usize;
    let half_width = 0.5 * WIDTH * DIAMETER;
    let origin = Vector3::new(-3.0 * DIAMETER, -half_width, -half_width);
    let n_cells = [cells(7.0), cells(WIDTH), cells(WIDTH)];
    let mut settings = LatticeSettings::new(origin, spacing, n_cells, 0.1 * spacing / SPEED, SPEED);
    settings.ground = Ground::Periodic;
    let air_density = settings.air_density;
    let mut air = lattice(settings, |_, _| Vector3::new(SPEED, 0.0, 0.0));

    // Points twice as dense as the cells, smeared over a cell.
    let n = cells(2.0);
    let points: Vec<Vector3> = (0..n * n)
        .map(|i| [i % n, i / n].map(|j| ((j as f64 + 0.5) / n as f64 - 0.5) * DIAMETER))
        .filter(|[y, z]| y.hypot(*z) <= 0.5 * DIAMETER)
        .map(|[y, z]| Vector3::new(0.0, y, z))
        .collect();
    let area = PI / 4.0 * DIAMETER * DIAMETER;
    let head = 0.5 * air_density * SPEED * SPEED;
    let thrust = head * thrust_coefficient * area / points.len() as f64;
    let forces: Vec<PointForce> = points
        .iter()
        .map(|position| PointForce::of_body(*position, Vector3::new(-thrust, 0.0, 0.0), spacing))
        .collect();
    advance(&mut air, SETTLING * CELLS_PER_DIAMETER / 0.1, &forces);

    // Smearing makes the disc wider and its rim weaker: the theory is given the thrust coefficient that the
    // loading has of itself, and the area that then carries the same thrust.
    let (wind, loading, centre) = loaded_wind(&air, &forces, head);
    let blockage = PI / 4.0 / (WIDTH * WIDTH);
    let [expected, ..] = ducted_disc(loading, blockage * thrust_coefficient / loading);
    let total = |x: f64| {
        let position = Vector3::new(x * DIAMETER, 0.0, 0.0);
        let mut velocity = [Vector3::ZERO];
        air.sample(&[position], &mut velocity);
        (velocity[0].length() / SPEED).powi(2) + air.pressure(position) / head
    };
    vec![
        Row {
            what: format!(
                "disc, thrust coefficient {thrust_coefficient}: wind at the loaded cells over free stream"
            ),
            measured: wind / SPEED,
            expected,
            tolerance: Within(0.01 * expected),
            unit: "-",
            source: SOURCE,
        },
        Row {
            what: format!(
                "disc, thrust coefficient {thrust_coefficient}: head lost on the axis over ½ρU²"
            ),
            measured: total(-0.5) - total(0.5),
            expected: centre,
            tolerance: Within(0.01 * centre),
            unit: "-",
            source: SOURCE,
        },
    ]
}

/// Wind (m/s) weighted with the force on each cell; thrust coefficient of the loading (–), weighted with
/// itself; that on the axis.
fn loaded_wind(air: &Lattice, forces: &[PointForce], head: f64) -> (f64, f64, f64) {
    let mut spreader = Spreader::new(*air.scaling(), air.n_cells());
    let spacing = air.scaling().spacing();
    let (mut work, mut thrust, mut squares, mut centre) = (0.0, 0.0, 0.0, 0.0_f64);
    for block in spreader.spread(forces) {
        let [n_x, n_y, n_z] = block.size;
        for column in 0..n_y * n_z {
            let cells =
                [block.origin[1] + column % n_y, block.origin[2] + column / n_y].map(|c| c as f64);
            let mut on_column = 0.0;
            for x in 0..n_x {
                let cell = Vector3::new((block.origin[0] + x) as f64, cells[0], cells[1]);
                let force = Vector3::new(f64::from(block.force[0][column * n_x + x]), 0.0, 0.0);
                let force = -air.scaling().to_si_force(force).x;
                let mut velocity = [Vector3::ZERO];
                air.sample(&[air.scaling().to_si_position(cell)], &mut velocity);
                work += force * velocity[0].x;
                on_column += force;
            }
            thrust += on_column;
            squares += on_column * on_column;
            if (air.scaling().to_si_position(Vector3::new(0.0, cells[0], cells[1]))
                * Vector3::new(0.0, 1.0, 1.0))
            .length()
                < spacing
            {
                centre = larger(centre, on_column);
            }
        }
    }
    let per_cell = 1.0 / (head * spacing * spacing);
    (work / thrust, squares / thrust * per_cell, centre * per_cell)
}
