//! A rotor and its wake in a box of finer cells beside the same on fine cells everywhere: whole studies, as a
//! case asks for them.

use crate::Row;
use crate::row::Tolerance::{self, AtMost, Within};
use crate::studies::{Carried, failure, summaries};
use basis::records::{Cost, Plane, PlaneAxes, Summary};

const CASE: &str = include_str!("../cases/refined-rotor.toml");
/// Where expected values come from.
const UNIFORM: &str = "the same on fine cells everywhere";
const COARSE: &str = "the same on coarse cells alone";
const LIMIT: &str = "limit, set beforehand";

/// Accepted distance of power and thrust from those on fine cells everywhere (–).
const POWER: f64 = 0.005;
/// Accepted distance of the wind over the disc behind the rotor, in a box and past all (free streams).
const WIND: [f64; 2] = [0.01, 0.02];
/// Share of the memory on fine cells everywhere that a box is to take at most (–).
const SHARE: f64 = 0.5;

/// What names every row.
const NAME: &str = "16 cells a diameter in a box, 8 around it";
/// The studies: on fine cells everywhere, in a box of them, on coarse cells alone; with the keys that each
/// sets.
const STUDIES: [(&str, &[&str]); 3] = [
    ("fine", &["flow.cells_per_diameter=16", "flow.step=0.05"]),
    (
        "boxed",
        &[
            "flow.cells_per_diameter=8",
            "flow.step=0.05",
            "flow.refinement=[{ upstream_diameters = 1.0, downstream_diameters = 3.0 }]",
        ],
    ),
    ("coarse", &["flow.cells_per_diameter=8", "flow.step=0.1"]),
];
/// Planes behind the rotor (diameters), and whether they lie in the box.
const PLANES: [(f64, bool); 4] = [(1.0, true), (2.0, true), (4.0, false), (5.0, false)];

/// Power, thrust, wake, time and memory of a rotor in a box of finer cells.
pub fn refined_rotor() -> Vec<Row> {
    rows().unwrap_or_else(failure)
}

/// What a study left.
struct Made {
    summary: Summary,
    planes: Vec<Plane>,
}

/// What the study called `name` leaves, which sets `keys`.
fn made((name, keys): (&str, &[&str])) -> Result<Made, String> {
    let folder = format!("refined-rotor-{name}");
    let keys = keys.iter().map(|&key| key.to_owned()).collect();
    let (_, folder) = summaries(Carried::Own(CASE), &folder, keys)?;
    let study = formats::records::read_study(&folder).map_err(|error| error.to_string())?;
    let records = study.runs.into_iter().next().ok_or("the study left no run")?;
    let across = |plane: &Plane| plane.axes == PlaneAxes::Crosswind;
    let planes = records.mean_planes.into_iter().filter(across).collect();
    Ok(Made { summary: records.summary, planes })
}

fn rows() -> Result<Vec<Row>, String> {
    let [fine, boxed, coarse] = STUDIES;
    let studies = [made(fine)?, made(boxed)?, made(coarse)?];
    let mut rows = of_rotor(&studies).to_vec();
    for (place, plane) in PLANES.into_iter().enumerate() {
        rows.extend(of_wake(&studies, place, plane));
    }
    rows.push(of_cost(&studies));
    Ok(rows)
}

fn row(
    what: &str,
    measured: f64,
    expected: f64,
    tolerance: Tolerance,
    source: &'static str,
) -> Row {
    Row { what: format!("{NAME}: {what}"), measured, expected, tolerance, unit: "-", source }
}

/// Power and thrust.
fn of_rotor(studies: &[Made; 3]) -> [Row; 2] {
    let power = |made: &Made| made.summary.turbines[0].power.mean;
    let thrust = |made: &Made| made.summary.turbines[0].thrust.mean;
    let compare = |what: &str, values: [f64; 3]| {
        let [fine, boxed, coarse] = values;
        tell!(
            "{what}: {:.5} of that on fine cells; {:.5} on coarse ones",
            boxed / fine,
            coarse / fine
        );
        let what = format!("{what} over that on fine cells everywhere");
        row(&what, boxed / fine, 1.0, Within(POWER), UNIFORM)
    };
    [
        compare("power", studies.each_ref().map(power)),
        compare("thrust", studies.each_ref().map(thrust)),
    ]
}

/// The wake on plane number `place`.
fn of_wake(studies: &[Made; 3], place: usize, (distance, inside): (f64, bool)) -> [Row; 2] {
    let of = |made: &Made| Wake::of(&made.planes[place], &made.summary);
    let [fine, boxed, coarse] = studies.each_ref().map(of);
    let place = if inside { "in a box" } else { "past the boxes" };
    let (off, off_coarse) = (boxed.off(&fine), coarse.off(&fine));
    tell!(
        "{distance} D, {place}: wind over the disc {:.4} fine, {:.4} boxed, {:.4} coarse; off by {off:.4}, coarse {off_coarse:.4}",
        fine.over_disc(),
        boxed.over_disc(),
        coarse.over_disc()
    );
    let [disc, shape] = [
        format!(
            "wind over the disc {distance} D behind, {place}, less that on fine cells everywhere, over free stream"
        ),
        format!(
            "wake {distance} D behind, {place}: root of the mean square difference from fine cells, over that of coarse cells alone"
        ),
    ];
    let tolerance = Within(WIND[usize::from(!inside)]);
    [
        row(&disc, boxed.over_disc() - fine.over_disc(), 0.0, tolerance, UNIFORM),
        row(&shape, off / off_coarse, 1.0, AtMost, COARSE),
    ]
}

/// Memory; wall time depends on what else runs, and is told alone.
fn of_cost(studies: &[Made; 3]) -> Row {
    let [fine, boxed, _] = studies.each_ref().map(|made| made.summary.cost);
    let millions = |cost: Cost| 1e-6 * cost.n_cells as f64;
    tell!(
        "{:.0} s and {:.1} MB on {:.2} million fine cells, {:.0} s and {:.1} MB with a box, {:.2} million cells",
        fine.wall_time,
        1e-6 * fine.memory as f64,
        millions(fine),
        boxed.wall_time,
        1e-6 * boxed.memory as f64,
        millions(boxed)
    );
    let share = boxed.memory as f64 / fine.memory as f64;
    row("memory of the air over that on fine cells everywhere", share, SHARE, AtMost, LIMIT)
}

/// Mean streamwise wind across a wake, on the coarse cells (free streams), with the distance of each from the
/// axis (diameters).
struct Wake {
    points: Vec<(f64, f64)>,
}

/// Coarse cells a diameter (–).
const COARSE_CELLS: f64 = 8.0;
/// The turbine's hub above the ground (m).
const HUB: f64 = 90.0;

impl Wake {
    /// The wake on `plane`, as the means over coarse cells.
    fn of(plane: &Plane, summary: &Summary) -> Self {
        let diameter = summary.conditions.rotor_diameter;
        // Cells a coarse one holds along an axis.
        let n = (diameter / COARSE_CELLS / plane.spacing[0]).round().max(1.0) as usize;
        let [n_y, n_z] = plane.n_points.map(|points| points / n);
        let mut points = Vec::with_capacity(n_y * n_z);
        for (y, z) in (0..n_z).flat_map(|z| (0..n_y).map(move |y| (y, z))) {
            let mut sum = 0.0;
            for (j, k) in (0..n).flat_map(|k| (0..n).map(move |j| (j, k))) {
                let index = (n * z + k) * plane.n_points[0] + n * y + j;
                sum += f64::from(plane.velocity[0][index]);
            }
            let centre = |axis: usize, cell: usize| {
                let middle = (n * cell) as f64 + 0.5 * (n as f64 - 1.0);
                plane.origin[axis + 1] + middle * plane.spacing[axis]
            };
            let from_axis = centre(0, y).hypot(centre(1, z) - HUB) / diameter;
            let mean = sum / (n * n) as f64 / summary.conditions.target_wind_speed;
            points.push((from_axis, mean));
        }
        Self { points }
    }

    /// Mean wind over the rotor's disc (free streams).
    fn over_disc(&self) -> f64 {
        let disc = || self.points.iter().filter(|(from_axis, _)| *from_axis < 0.5);
        disc().map(|(_, wind)| wind).sum::<f64>() / disc().count() as f64
    }

    /// Root of the mean square difference from `other` within a diameter of the axis (free streams).
    fn off(&self, other: &Self) -> f64 {
        let pairs = || {
            let pairs = self.points.iter().zip(&other.points);
            pairs.filter(|((from_axis, _), _)| *from_axis < 1.0)
        };
        let sum: f64 = pairs().map(|((_, wind), (_, other))| (wind - other).powi(2)).sum();
        (sum / pairs().count() as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::records::examples;

    #[test]
    fn fine_cells_are_seen_as_the_means_over_coarse_ones() {
        let mut summary = examples::full();
        (summary.conditions.rotor_diameter, summary.conditions.target_wind_speed) = (80.0, 10.0);
        // A linear wind on cells of 10 m, and on the four in each.
        let plane = |n: usize| {
            let spacing = 10.0 / n as f64;
            let (n_y, n_z) = (16 * n, 20 * n);
            let y = |column: usize| -80.0 + (column as f64 + 0.5) * spacing;
            let z = |row: usize| (row as f64 + 0.5) * spacing;
            let wind = (0..n_y * n_z)
                .map(|index| (8.0 + 0.01 * y(index % n_y) + 0.02 * (z(index / n_y) - 90.0)) as f32)
                .collect();
            Plane {
                name: "2D".to_owned(),
                axes: PlaneAxes::Crosswind,
                origin: [0.0, y(0), z(0)],
                spacing: [spacing; 2],
                n_points: [n_y, n_z],
                time: 0.0,
                averaged: 0.0,
                velocity: [wind, Vec::new(), Vec::new()],
            }
        };
        let [coarse, fine] = [1, 2].map(|n| Wake::of(&plane(n), &summary));
        assert_eq!(coarse.points.len(), 16 * 20);
        assert!(fine.off(&coarse) < 1e-6, "{}", fine.off(&coarse));
        assert!((fine.over_disc() - 0.8).abs() < 1e-6, "{}", fine.over_disc());
        let mut other = Wake { points: coarse.points.clone() };
        other.points.iter_mut().for_each(|point| point.1 += 0.1);
        assert!((other.off(&coarse) - 0.1).abs() < 1e-9);
    }
}
