//! The wake of one turbine in sheared wind, in free vortices with and without the shear that carries them,
//! beside the lattice's.

use crate::Row;
use crate::row::Tolerance::Within;
use crate::studies::{Carried, failure, summaries};
use analysis::wake::{disc_average, middle_of_deficit};
use basis::records::{Plane, PlaneAxes};
use flow::inflow::MeanProfile;
use formats::records::read_study;

const CASE: &str = include_str!("../../cases/free-vortex-shear.toml");
const SPEED: f64 = 10.0;
const EXPONENT: f64 = 0.2;
/// Hub height and diameter of the NREL 5 MW (m).
const HUB_HEIGHT: f64 = 90.0;
const DIAMETER: f64 = 126.0;
const DISTANCES: [f64; 4] = [1.0, 2.0, 3.0, 4.0];
const SOURCE: &str = "the lattice on 20 cells a diameter";
/// Accepted distance of the wake's height (diameters), and of the wind over a rotor's disc (over the hub's),
/// from the lattice's.
const HEIGHT: f64 = 0.03;
const WIND: f64 = 0.05;
/// Within so many diameters of the rotor's axis the middle of the deficit is the wake's place: as far as the
/// ground allows.
const AROUND: f64 = 0.7;

/// What moves the air, and the keys of the case that say so.
const LATTICE: [&str; 1] = ["flow.cells_per_diameter=20"];
const VORTEX: [&str; 6] = [
    "flow.solver=\"vortex\"",
    "flow.step=0.1",
    "flow.wake_length_diameters=6",
    "flow.near_wake_diameters=0.15",
    "flow.far_wake_filaments=7",
    "flow.far_wake_steps=4",
];
const FREE: [&str; 2] = ["carried", "left-out"];

/// At each distance: height of the wake over the hub (diameters), and mean wind over the disc of a rotor
/// there over the hub's wind.
type Wake = [[f64; 2]; DISTANCES.len()];

pub(super) fn rows() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let lattice = wake("lattice", LATTICE.map(str::to_owned).to_vec())?;
    let mut rows = Vec::new();
    for shear in FREE {
        let keys = VORTEX.into_iter().map(str::to_owned);
        let found = wake(shear, keys.chain([format!("flow.wake_shear=\"{shear}\"")]).collect())?;
        for ((distance, found), expected) in DISTANCES.iter().zip(found).zip(lattice) {
            let row = |what: &str, index: usize, tolerance: f64, unit: &'static str| Row {
                what: format!(
                    "nrel-5mw, {SPEED} m/s, shear exponent {EXPONENT}, no turbulence, wake_shear = \"{shear}\", {distance} D behind: {what}"
                ),
                measured: found[index] - expected[index],
                expected: 0.0,
                tolerance: Within(tolerance),
                unit,
                source: SOURCE,
            };
            rows.push(row("middle of the deficit above the lattice's", 0, HEIGHT, "D"));
            let what = "mean wind over a rotor's disc less the lattice's, over the hub's wind";
            rows.push(row(what, 1, WIND, "–"));
        }
    }
    Ok(rows)
}

/// The wake as `keys` have the case, in the study that `name` tells.
fn wake(name: &str, keys: Vec<String>) -> Result<Wake, String> {
    let study = format!("free-vortex-shear-{name}");
    let (_, folder) = summaries(Carried::Own(CASE), &study, keys)?;
    let records = read_study(&folder).map_err(|error| error.to_string())?;
    let run = records.runs.first().ok_or_else(|| format!("{study}: there is no run"))?;
    let mut wake = [[f64::NAN; 2]; DISTANCES.len()];
    for (found, distance) in wake.iter_mut().zip(DISTANCES) {
        let is_it = |plane: &&Plane| {
            plane.axes == PlaneAxes::Crosswind
                && (plane.origin[0] / DIAMETER - distance).abs() < 0.05
        };
        let plane = run.mean_planes.iter().find(is_it);
        let plane = plane.ok_or_else(|| format!("{study}: there is no plane at {distance} D"))?;
        *found = seen(plane).map_err(|error| error.to_string())?;
        tell!("{name}, {distance} D: {:+.3} D above the hub, disc {:.3}", found[0], found[1]);
    }
    Ok(wake)
}

fn seen(plane: &Plane) -> Result<[f64; 2], analysis::AnalysisError> {
    let profile =
        MeanProfile::PowerLaw { hub_height: HUB_HEIGHT, speed: SPEED, exponent: EXPONENT };
    let around = [0.0, HUB_HEIGHT];
    let free_stream = |height| profile.speed(height);
    let [_, height] = middle_of_deficit(plane, free_stream, around, AROUND * DIAMETER)?;
    let disc = disc_average(plane, around, 0.5 * DIAMETER)?;
    Ok([(height - HUB_HEIGHT) / DIAMETER, disc.mean / SPEED])
}
