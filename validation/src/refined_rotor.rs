//! A rotor and its wake in boxes of finer cells beside the same on fine cells everywhere: whole studies, as a
//! case asks for them.

use crate::Row;
use crate::row::Tolerance::{self, AtMost, Within};
use crate::studies::{Carried, failure, summaries};
use basis::records::{Plane, PlaneAxes, Summary};

const CASE: &str = include_str!("../cases/refined-rotor.toml");
/// Where expected values come from.
const UNIFORM: &str = "the same on fine cells everywhere";
const COARSE: &str = "the same on coarse cells alone";
const LIMIT: &str = "limit, set beforehand";

/// Accepted distance of power and thrust from those on fine cells everywhere (–).
const POWER: f64 = 0.005;
/// Accepted distance of the wind over the disc behind the rotor, in a box and past all (free streams).
const WIND: [f64; 2] = [0.01, 0.02];
/// Share of wall time and memory on fine cells everywhere that a box is to take at most (–).
const SHARE: f64 = 0.5;

/// A flow that is made on cells of several sizes.
struct Flow {
    name: &'static str,
    /// Name of its folders.
    folder: &'static str,
    /// What all of its studies set.
    shared: &'static [&'static str],
    /// What those on fine cells everywhere, in boxes, and on coarse cells alone set.
    cells: [&'static str; 3],
    boxes: &'static str,
    steps: [&'static str; 3],
    /// Planes behind the rotor (diameters), and whether they lie in a box.
    planes: &'static [(f64, bool)],
}

const FLOWS: [Flow; 2] = [
    Flow {
        name: "16 cells a diameter in a box, 8 around it",
        folder: "one",
        shared: &["output.crosswind_diameters=[1.0, 2.0, 4.0, 5.0]"],
        cells: ["16", "8", "8"],
        boxes: "[{ upstream_diameters = 1.0, downstream_diameters = 3.0 }]",
        steps: ["0.05", "0.05", "0.1"],
        planes: &[(1.0, true), (2.0, true), (4.0, false), (5.0, false)],
    },
    Flow {
        name: "32 cells a diameter in a box in a box, 8 around them",
        folder: "two",
        shared: &[
            "output.crosswind_diameters=[0.5, 1.5, 3.0]",
            "flow.upstream_diameters=2.0",
            "flow.downstream_diameters=4.0",
            "flow.width_diameters=3.0",
            "flow.height_diameters=3.0",
            "time.spin_up=90.0",
            "time.duration=120.0",
        ],
        cells: ["32", "8", "8"],
        boxes: "[{ upstream_diameters = 1.25, downstream_diameters = 2.25, width_diameters = 2.25, height_diameters = 2.25 }, { upstream_diameters = 0.8, downstream_diameters = 1.0, width_diameters = 1.75, height_diameters = 1.75 }]",
        steps: ["0.025", "0.025", "0.1"],
        planes: &[(0.5, true), (1.5, true), (3.0, false)],
    },
];

/// Power, thrust, wake, time and memory of a rotor in one box and in a box in a box.
pub fn refined_rotor() -> Vec<Row> {
    FLOWS.iter().flat_map(|flow| rows(flow).unwrap_or_else(failure)).collect()
}

/// What a study left.
struct Made {
    summary: Summary,
    planes: Vec<Plane>,
}

/// The study of `flow` number `which`: on fine cells everywhere, in boxes, on coarse cells alone.
fn made(flow: &Flow, which: usize) -> Result<Made, String> {
    let names = ["fine", "boxed", "coarse"];
    let name = format!("refined-rotor-{}-{}", flow.folder, names[which]);
    let mut keys: Vec<String> = flow.shared.iter().map(|&key| key.to_owned()).collect();
    keys.push(format!("flow.cells_per_diameter={}", flow.cells[which]));
    keys.push(format!("flow.step={}", flow.steps[which]));
    if which == 1 {
        keys.push(format!("flow.refinement={}", flow.boxes));
    }
    let (_, folder) = summaries(Carried::Own(CASE), &name, keys)?;
    let study = formats::records::read_study(&folder).map_err(|error| error.to_string())?;
    let records = study.runs.into_iter().next().ok_or("the study left no run")?;
    let across = |plane: &Plane| plane.axes == PlaneAxes::Crosswind;
    let planes = records.mean_planes.into_iter().filter(across).collect();
    Ok(Made { summary: records.summary, planes })
}

fn rows(flow: &Flow) -> Result<Vec<Row>, String> {
    let [fine, boxed, coarse] = [made(flow, 0)?, made(flow, 1)?, made(flow, 2)?];
    let name = flow.name;
    let of_rotor = |made: &Made| {
        let turbine = &made.summary.turbines[0];
        [turbine.power.mean, turbine.thrust.mean]
    };
    let of_cost = |made: &Made| [made.summary.cost.wall_time, made.summary.cost.memory as f64];
    let row = |what: String, measured: f64, expected: f64, tolerance: Tolerance, source| Row {
        what: format!("{name}: {what}"),
        measured,
        expected,
        tolerance,
        unit: "-",
        source,
    };
    let mut rows = Vec::new();
    let of_rotors = [&fine, &boxed, &coarse].map(of_rotor);
    for (index, what) in ["power", "thrust"].into_iter().enumerate() {
        let [fine, boxed, coarse] = of_rotors.map(|values| values[index]);
        tell!(
            "{name}: {what} {:.4} of that on fine cells; {:.4} on coarse ones",
            boxed / fine,
            coarse / fine
        );
        let what = format!("{what} over that on fine cells everywhere");
        rows.push(row(what, boxed / fine, 1.0, Within(POWER), UNIFORM));
    }
    for (place, (distance, inside)) in flow.planes.iter().enumerate() {
        let of = |made: &Made| Wake::of(&made.planes[place], &made.summary);
        let [fine, boxed, coarse] = [of(&fine), of(&boxed), of(&coarse)];
        let where_ = if *inside { "in a box" } else { "past the boxes" };
        let (off, off_coarse) = (boxed.off(&fine), coarse.off(&fine));
        tell!(
            "{name}, {distance} D, {where_}: wind over the disc {:.4} fine, {:.4} boxed, {:.4} coarse; off by {off:.4}, coarse {off_coarse:.4}",
            fine.over_disc(),
            boxed.over_disc(),
            coarse.over_disc()
        );
        let what = format!(
            "wind over the disc {distance} D behind, {where_}, less that on fine cells everywhere, over free stream"
        );
        let tolerance = Within(WIND[usize::from(!inside)]);
        rows.push(row(what, boxed.over_disc() - fine.over_disc(), 0.0, tolerance, UNIFORM));
        let what = format!(
            "wake {distance} D behind, {where_}: root of the mean square difference from fine cells, over that of coarse cells alone"
        );
        rows.push(row(what, off / off_coarse, 1.0, AtMost, COARSE));
    }
    let [[time, memory], boxed_cost] = [of_cost(&fine), of_cost(&boxed)];
    tell!(
        "{name}: {time:.0} s and {:.0} MB on fine cells everywhere, {:.0} s and {:.0} MB in boxes; {:.2} and {:.2} million cells",
        1e-6 * memory,
        boxed_cost[0],
        1e-6 * boxed_cost[1],
        1e-6 * fine.summary.cost.n_cells as f64,
        1e-6 * boxed.summary.cost.n_cells as f64,
    );
    rows.push(row(
        "wall time over that on fine cells everywhere".to_owned(),
        boxed_cost[0] / time,
        SHARE,
        AtMost,
        LIMIT,
    ));
    rows.push(row(
        "memory of the air over that on fine cells everywhere".to_owned(),
        boxed_cost[1] / memory,
        SHARE,
        AtMost,
        LIMIT,
    ));
    Ok(rows)
}

/// Mean streamwise wind across a wake, on the coarse cells (free streams), with the distance of each from the
/// axis (diameters).
struct Wake {
    points: Vec<(f64, f64)>,
}

/// Coarse cells a diameter (–).
const COARSE_CELLS: f64 = 8.0;

impl Wake {
    /// The wake on `plane`, as the means over coarse cells.
    fn of(plane: &Plane, summary: &Summary) -> Self {
        let diameter = summary.conditions.rotor_diameter;
        // Cells a coarse one holds along an axis.
        let n = (diameter / COARSE_CELLS / plane.spacing[0]).round().max(1.0) as usize;
        let [n_y, n_z] = plane.n_points.map(|points| points / n);
        // The hub of the turbine, 90 m above the ground.
        const HUB: f64 = 90.0;
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
