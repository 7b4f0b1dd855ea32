//! What becomes of a precursor's wind on its way through a study without turbines.

use crate::Row;
use crate::helix::wind_of_precursor;
use crate::row::Tolerance::Within;
use crate::studies::{Carried, failure, summaries};
use flow::inflow::PlaneGrid;
use formats::turbulence_box;
use std::ops::Range;
use std::path::{Path, PathBuf};

const SOURCE: &str = "the precursor, in which the mean is alike everywhere";
const CASE: &str = include_str!("../../cases/empty-in-atmosphere.toml");
/// Of the IEA 22 MW turbine (m).
const RADIUS: f64 = 142.0;
/// Accepted change of the mean speed over the rotor (%), of direction and of veer over the rotor (deg), and
/// of the turbulence intensity (%), over 8 D.
const SPEED: f64 = 1.0;
const DIRECTION: f64 = 0.5;
const VEER: f64 = 0.5;
const INTENSITY: f64 = 10.0;
/// Accepted difference of open from periodic sides, on the same planes: mean speed (%) and direction (deg).
const OTHER_SPEED: f64 = 0.5;
const OTHER_DIRECTION: f64 = 0.25;
/// Length (s) of the blocks whose scatter tells how sure such a difference is.
const BLOCK: f64 = 300.0;

/// A way to let the wind in: its name, whether it is judged, and its keys, in which `{}` is the precursor's
/// folder.
struct Way {
    name: &'static str,
    folder: &'static str,
    is_judged: bool,
    keys: &'static [&'static str],
}

const GROUND: &str = "flow.ground={ roughness_length = 0.001 }";
const PLANES: &str = "wind.precursor=\"{}\"";
const OPEN: &str = "flow.sides=open";
const WAYS: [Way; 4] = [
    Way {
        name: "planes, periodic sides",
        folder: "study-in-atmosphere-periodic",
        is_judged: true,
        keys: &[PLANES, GROUND],
    },
    Way {
        name: "planes, open sides",
        folder: "study-in-atmosphere-open",
        is_judged: true,
        keys: &[PLANES, GROUND, OPEN],
    },
    Way {
        name: "precursor beside, open sides",
        folder: "study-in-atmosphere-beside",
        is_judged: true,
        keys: &[PLANES, GROUND, OPEN, "wind.precursor_wind=beside"],
    },
    // As studies had it before they stood in an atmosphere; told, for nothing holds its wind.
    Way {
        name: "planes in air without temperature, slip ground",
        folder: "study-in-atmosphere-neutral",
        is_judged: false,
        keys: &[
            "wind.planes=\"{}/planes.bts\"",
            "wind.roughness_length=0.001",
            "wind.beyond_planes=mean",
        ],
    },
];

/// Wind over the rotor at a place.
#[derive(Clone, Copy, Debug, Default)]
struct OverRotor {
    /// Mean over the disc (m/s).
    speed: f64,
    /// Direction at hub height (deg, to the left looking downwind).
    direction: f64,
    /// By how much the wind turns to the right from the rotor's foot to its top (deg).
    veer: f64,
    /// √(2k/3) over the mean speed, over the disc (%).
    intensity: f64,
}

/// Changes from where T1 would stand to where T2 would, 8 D apart.
pub fn study_in_atmosphere() -> Vec<Row> {
    let folder = match wind_of_precursor() {
        Ok((_, folder)) => folder,
        Err(problem) => return failure(problem),
    };
    let mut rows: Vec<Row> =
        WAYS.iter().flat_map(|way| of_way(way, &folder).unwrap_or_else(failure)).collect();
    rows.extend(open_for_periodic(&folder).unwrap_or_else(failure));
    rows
}

/// What open sides change where periodic ones have the same planes: eddies are the same ones, so that little
/// of their chance is in the difference.
fn open_for_periodic(precursor: &Path) -> Result<Vec<Row>, String> {
    let [periodic, open] = [run_of(&WAYS[0], precursor)?, run_of(&WAYS[1], precursor)?];
    let mut rows = Vec::new();
    for name in ["inflow-T1.bts", "inflow-T2.bts"] {
        let [periodic, open] = [&periodic, &open].map(|run| blocks(&run.join(name)));
        let (periodic, open) = (periodic?, open?);
        let pairs = || periodic.iter().zip(&open);
        let speed = pairs().map(|(p, o)| 100.0 * (o.speed / p.speed - 1.0)).collect();
        let direction = pairs().map(|(p, o)| o.direction - p.direction).collect();
        let place = &name["inflow-".len()..name.len() - ".bts".len()];
        for (what, values, reach, unit) in [
            ("mean speed over the rotor", speed, OTHER_SPEED, "%"),
            ("direction at hub height", direction, OTHER_DIRECTION, "deg"),
        ] {
            let values: Vec<f64> = values;
            let n = values.len() as f64;
            let mean = values.iter().sum::<f64>() / n;
            let squares = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>();
            let error = (squares / (n - 1.0) / n).sqrt();
            tell!(
                "open less periodic sides, {what} at {place}: {mean:+.3} {unit}, standard error {error:.3} of {n} blocks"
            );
            rows.push(Row {
                what: format!("planes, open less periodic sides: {what} where {place} would stand"),
                measured: mean,
                expected: 0.0,
                tolerance: Within(reach),
                unit,
                source: "the same planes between periodic sides",
            });
        }
    }
    Ok(rows)
}

/// The folder of the run of `way`, which is made if it is not there.
fn run_of(way: &Way, precursor: &Path) -> Result<PathBuf, String> {
    let keys = way.keys.iter().map(|key| key.replace("{}", &precursor.display().to_string()));
    let (_, folder) = summaries(Carried::Own(CASE), way.folder, keys.collect())?;
    Ok(folder.join("empty"))
}

/// Wind over the rotor in each whole block of the record at `path`.
fn blocks(path: &Path) -> Result<Vec<OverRotor>, String> {
    let grid = turbulence_box::open(path).map_err(|error| error.to_string())?.grid();
    let n = (BLOCK / grid.interval).round() as usize;
    (0..grid.n_steps / n).map(|block| over_rotor(path, block * n..(block + 1) * n)).collect()
}

fn of_way(way: &Way, precursor: &Path) -> Result<Vec<Row>, String> {
    let run = run_of(way, precursor)?;
    let [before, behind] =
        ["inflow-T1.bts", "inflow-T2.bts"].map(|name| over_rotor(&run.join(name), 0..usize::MAX));
    let (before, behind) = (before?, behind?);
    tell!(
        "{}: speed {:.3} and {:.3} m/s, direction {:+.2} and {:+.2}°, veer {:.2} and {:.2}°, intensity {:.2} and {:.2} %",
        way.name,
        before.speed,
        behind.speed,
        before.direction,
        behind.direction,
        before.veer,
        behind.veer,
        before.intensity,
        behind.intensity
    );
    if !way.is_judged {
        return Ok(Vec::new());
    }
    let row = |what: &str, measured, reach, unit| Row {
        what: format!("{}: {what} over 8 D", way.name),
        measured,
        expected: 0.0,
        tolerance: Within(reach),
        unit,
        source: SOURCE,
    };
    let change = |before: f64, behind: f64| 100.0 * (behind / before - 1.0);
    Ok(vec![
        row(
            "change of the mean speed over the rotor",
            change(before.speed, behind.speed),
            SPEED,
            "%",
        ),
        row(
            "change of direction at hub height",
            behind.direction - before.direction,
            DIRECTION,
            "deg",
        ),
        row("change of the veer over the rotor", behind.veer - before.veer, VEER, "deg"),
        row(
            "change of the turbulence intensity over the rotor",
            change(before.intensity, behind.intensity),
            INTENSITY,
            "%",
        ),
    ])
}

/// What those of `steps` that the record at `path` has tell; its hub is the middle of its width.
fn over_rotor(path: &Path, steps: Range<usize>) -> Result<OverRotor, String> {
    let mut planes = turbulence_box::open(path).map_err(|error| error.to_string())?;
    let grid = planes.grid();
    let n_points = grid.n_y * grid.n_z;
    let (mut sums, mut squares) = (vec![[0.0; 3]; n_points], vec![0.0; n_points]);
    let mut plane = vec![[0.0; 3]; n_points];
    let steps = steps.start..steps.end.min(grid.n_steps);
    for step in steps.clone() {
        planes.read(step, &mut plane).map_err(|error| error.to_string())?;
        for ((wind, sum), square) in plane.iter().zip(&mut sums).zip(&mut squares) {
            for (value, sum) in wind.iter().copied().map(f64::from).zip(sum) {
                *sum += value;
                *square += value * value;
            }
        }
    }
    let n = steps.len() as f64;
    let means: Vec<[f64; 3]> = sums.iter().map(|sum| sum.map(|sum| sum / n)).collect();
    let hub = hub_of(&grid);
    let (mut speed, mut energy, mut n_inside) = (0.0, 0.0, 0.0);
    for (point, (mean, square)) in means.iter().zip(&squares).enumerate() {
        let (y, z) = place(&grid, point);
        if y.hypot(z - hub) <= RADIUS {
            speed += mean[0].hypot(mean[1]);
            energy += (square / n - mean.iter().map(|value| value * value).sum::<f64>()).max(0.0);
            n_inside += 1.0;
        }
    }
    let direction = |height: f64| {
        let row = ((height - grid.first[1]) / grid.spacing[1]).round().max(0.0) as usize;
        let row = &means[row.min(grid.n_z - 1) * grid.n_y..][..grid.n_y];
        let sum = |axis: usize| row.iter().map(|mean| mean[axis]).sum::<f64>();
        sum(1).atan2(sum(0)).to_degrees()
    };
    let speed = speed / n_inside;
    Ok(OverRotor {
        speed,
        direction: direction(hub),
        veer: direction(hub - RADIUS) - direction(hub + RADIUS),
        intensity: 100.0 * (energy / n_inside / 3.0).sqrt() / speed,
    })
}

/// Height of the hub in the middle of the width of `grid` (m): its rows reach as far above it as aside.
fn hub_of(grid: &PlaneGrid) -> f64 {
    grid.up()[1] - 0.5 * (grid.across()[1] - grid.across()[0])
}

/// Where point number `point` of `grid` stands along y and z (m).
fn place(grid: &PlaneGrid, point: usize) -> (f64, f64) {
    let (column, row) = ((point % grid.n_y) as f64, (point / grid.n_y) as f64);
    (grid.first[0] + column * grid.spacing[0], grid.first[1] + row * grid.spacing[1])
}
