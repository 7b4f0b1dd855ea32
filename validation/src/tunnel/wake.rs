//! What averages by phase tell of the first turbine's wake: power that it leaves, energy that enters it.

use super::TUNNEL;
use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance::{AtLeast, Within};
use crate::studies::failure;
use analysis::entrainment::{Edge, FluxPoint, available_power, flux_along, integral, sign_flip};
use analysis::grids::widened;
use analysis::phases::Decomposer;
use basis::records::Moments;
use formats::records::{RunFolder, StoredPhaseAverages};
use std::path::Path;

/// Distances of the discs behind T1, as `cases/tunnel-helix.toml` has them (rotor diameters), and the places
/// of 2 and 4 among them.
const DISCS: [f64; 7] = [1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];
const AT_TWO: usize = 2;
const AT_FOUR: usize = 6;
/// Flux through the rotor's edge is added up as far as here (rotor diameters).
const FARTHEST: f64 = 4.0;
/// Length over which it is smoothed before its change of sign is looked for (rotor diameters).
const SMOOTHING: f64 = 0.25;
/// Accepted distances: of power that "settles to a near-constant value" (–); of the least power, told to lie
/// "between x/D = 1.5 and x/D = 2" of discs half a diameter apart (D); of the change of sign "around x/D = 2"
/// (D).
const CONSTANT_TOLERANCE: f64 = 0.1;
const LEAST_TOLERANCE: f64 = 0.5;
const FLIP_TOLERANCE: f64 = 0.25;

/// The wake of T1 in one run.
struct Wake {
    /// Fraction of available power at each of [`DISCS`], its mean over the phases (–), and twice its standard
    /// deviation over them.
    power: Vec<[f64; 2]>,
    /// Flux into the wake through z = ± R in the plane of the hub, over U³; distances from the hub (D).
    flux: Vec<FluxPoint>,
}

impl Wake {
    fn read(run: &RunFolder) -> Result<Self, String> {
        let open = |name: &str| {
            StoredPhaseAverages::open(&run.phase_averages_path(name))
                .map_err(|error| error.to_string())
        };
        let disc = |distance: &f64| of_disc(&open(&format!("discs-{distance}D"))?);
        let power = DISCS.iter().map(disc).collect::<Result<_, String>>()?;
        Ok(Self { power, flux: through_edges(&open("wake-0D-beside")?)? })
    }

    /// All random flux up to [`FARTHEST`] (–).
    fn random(&self) -> f64 {
        let points: Vec<FluxPoint> =
            self.flux.iter().filter(|point| point.x <= FARTHEST).copied().collect();
        integral(&points, |point| point.random)
    }
}

fn bin_of(plane: &StoredPhaseAverages, index: usize) -> Result<Moments, String> {
    plane.bin(index).map_err(|error| error.to_string())
}

/// Mean and twice the deviation over the phases of the fraction of available power on a plane (–).
pub(super) fn of_disc(plane: &StoredPhaseAverages) -> Result<[f64; 2], String> {
    let (grid, setting) = (&plane.head.grid, &plane.setting);
    let (place, radius) =
        ((grid.origin[0], [setting.hub[1], setting.hub[2]]), 0.5 * setting.diameter);
    let mut fractions = Vec::new();
    let bins = plane.head.bins.iter().enumerate().filter(|(_, bin)| bin.n_instants > 0);
    for (index, _) in bins {
        let u = widened(&bin_of(plane, index)?.mean[0]);
        let found = available_power(grid, &u, place, radius, setting.wind_speed);
        fractions.push(found.map_err(|error| error.to_string())?.fraction);
    }
    let n = fractions.len() as f64;
    let mean = fractions.iter().sum::<f64>() / n;
    let variance = fractions.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / n;
    Ok([mean, 2.0 * variance.sqrt()])
}

/// The mean of the flux through both edges on an upright plane.
fn through_edges(plane: &StoredPhaseAverages) -> Result<Vec<FluxPoint>, String> {
    let (grid, setting) = (&plane.head.grid, &plane.setting);
    let mut decomposer = Decomposer::new(&plane.head.all);
    for index in 0..plane.head.bins.len() {
        decomposer.add(&bin_of(plane, index)?);
    }
    let (parts, [hub_x, hub_y, hub_z]) = (decomposer.finish(), setting.hub);
    let [upper, lower] = [1.0, -1.0].map(|side| {
        let place = [hub_y, hub_z + side * 0.5 * setting.diameter];
        flux_along(&parts, grid, &Edge { axis: 2, place, inward: -side })
    });
    let cube = setting.wind_speed.powi(3);
    let both = |(a, b): (&FluxPoint, &FluxPoint)| FluxPoint {
        x: (a.x - hub_x) / setting.diameter,
        total: 0.5 * (a.total + b.total) / cube,
        periodic: 0.5 * (a.periodic + b.periodic) / cube,
        random: 0.5 * (a.random + b.random) / cube,
    };
    Ok(upper.iter().zip(&lower).map(both).collect())
}

/// The wakes of the runs in `folder` beside what the experiment tells of them in words.
pub(super) fn rows(folder: &Path) -> Vec<Row> {
    let read = |run: &str| Wake::read(&RunFolder::new(folder, run));
    let wakes = || Ok([read("baseline")?, read("cw")?, read("ccw")?, read("ccw-optimum")?]);
    match wakes() {
        Ok(wakes) => powers(&wakes).into_iter().chain(fluxes(&wakes)).collect(),
        Err(problem) => failure(problem),
    }
}

fn powers([baseline, cw, ccw, optimum]: &[Wake; 4]) -> Vec<Row> {
    let at = |wake: &Wake, disc: usize| wake.power[disc][0];
    let mut rows = vec![row(
        "fraction of available power at 4 D over that at 2 D, baseline",
        at(baseline, AT_FOUR) / at(baseline, AT_TWO),
        (1.0, Within(CONSTANT_TOLERANCE)),
        "–",
    )];
    for (name, wake) in [("cw", cw), ("ccw", ccw)] {
        let least = (0..DISCS.len()).min_by(|a, b| at(wake, *a).total_cmp(&at(wake, *b)));
        rows.push(row(
            &format!("distance of the least fraction of available power, {name}"),
            least.map_or(f64::NAN, |disc| DISCS[disc]),
            (1.75, Within(LEAST_TOLERANCE)),
            "D",
        ));
    }
    let pairs = [
        ("cw over baseline", cw, baseline),
        ("ccw over baseline", ccw, baseline),
        ("ccw-optimum over baseline", optimum, baseline),
        ("ccw-optimum over ccw", optimum, ccw),
        ("cw over ccw", cw, ccw),
    ];
    for (name, wake, other) in pairs {
        rows.push(row(
            &format!("fraction of available power at 4 D, {name}"),
            at(wake, AT_FOUR) / at(other, AT_FOUR),
            (1.0, AtLeast),
            "–",
        ));
    }
    for (name, wake) in [("cw", cw), ("ccw", ccw)] {
        rows.push(row(
            &format!("its spread over the phases at 4 D, two deviations, {name} over baseline"),
            wake.power[AT_FOUR][1] / baseline.power[AT_FOUR][1],
            (1.0, AtLeast),
            "–",
        ));
    }
    rows
}

fn fluxes([baseline, cw, ccw, _]: &[Wake; 4]) -> Vec<Row> {
    let furthest = worst(baseline.flux.iter().map(|point| point.x));
    let turn = sign_flip(&baseline.flux, SMOOTHING);
    if turn.is_none() {
        tell!("the baseline's flux of mean kinetic energy turns nowhere up to {furthest:.2} D");
    }
    let mut rows = vec![row(
        "distance at which the flux of mean kinetic energy through z = ± R turns into the wake, baseline, the furthest looked at where it does not",
        turn.unwrap_or(furthest),
        (2.0, Within(FLIP_TOLERANCE)),
        "D",
    )];
    for (name, wake) in [("cw", cw), ("ccw", ccw)] {
        rows.push(row(
            &format!("flux by random fluctuations through z = ± R up to 4 D, {name} over baseline"),
            wake.random() / baseline.random(),
            (1.0, AtLeast),
            "–",
        ));
    }
    rows
}

fn row(
    what: &str,
    measured: f64,
    (expected, tolerance): (f64, crate::Tolerance),
    unit: &'static str,
) -> Row {
    Row { what: what.to_owned(), measured, expected, tolerance, unit, source: TUNNEL }
}
