//! What tip vortices of free wakes do, beside what the experiment tells of them.

use super::TUNNEL;
use super::wake::of_disc;
use crate::Row;
use crate::folds::ratio;
use crate::row::Tolerance::{self, AtLeast, AtMost, Within};
use crate::studies::failure;
use formats::records::{RunFolder, StoredPhaseAverages};
use postprocessing::ANALYSES;
use postprocessing::analyses::Request;
use serde::Deserialize;
use std::path::Path;

/// Blades, whose vortices make as many pairs.
const N_BLADES: usize = 3;
/// Accepted distance of places that are told as "around" a number (D), as of the flux.
const PLACE_TOLERANCE: f64 = 0.25;
/// Accepted distance of the third vortex's strength over the others', told as "almost twice as low" (–).
const STRENGTH_TOLERANCE: f64 = 0.1;
/// Where the expected value comes from of what lies behind the measured wake.
const FURTHER: &str = "this program's claim: the source measured up to 4.3 D";
/// How far behind the rotor vortices are as strong as they came (D).
const EARLY: f64 = 0.5;

/// What `wakemix analyse vortices --json` tells, as far as it is used here.
#[derive(Deserialize)]
struct Found {
    setting: Setting,
    tracks: Vec<Track>,
    leapfrogs: Vec<Leapfrog>,
    leapfrogs_of_the_vortex_after_next: Vec<Leapfrog>,
    leapfrog_sines: Vec<Sine>,
}

#[derive(Deserialize)]
struct Setting {
    diameter_m: f64,
    hub_m: [f64; 3],
}

#[derive(Deserialize)]
struct Track {
    blade: Option<usize>,
    sightings: Vec<Sighting>,
}

#[derive(Deserialize)]
struct Sighting {
    vortex: Vortex,
}

#[derive(Deserialize)]
struct Vortex {
    position_m: [f64; 2],
    peak_vorticity_1_s: f64,
}

#[derive(Deserialize)]
struct Leapfrog {
    pair: usize,
    side: String,
    x_m: f64,
}

#[derive(Deserialize)]
struct Sine {
    pair: usize,
    side: String,
    mean_m: f64,
    amplitude_m: f64,
    half_widths_95: [f64; 3],
    n: usize,
}

/// The vortices of `run` in `folder`.
fn found(folder: &Path, run: &str) -> Result<Found, String> {
    let analysis = ANALYSES.iter().find(|one| one.name == "vortices").ok_or("no such analysis")?;
    let request = Request::of(folder.join(run)).with("blades", &N_BLADES.to_string());
    let answer = (analysis.run)(&request).map_err(|error| error.to_string())?;
    serde_json::from_value(answer.json).map_err(|error| error.to_string())
}

/// Mean of `values`, not a number where there are none.
fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

impl Found {
    /// `x` (m) in diameters behind the hub.
    fn behind(&self, x: f64) -> f64 {
        (x - self.setting.hub_m[0]) / self.setting.diameter_m
    }

    /// Where vortices of `pair` pass each other (D), by the `passages` of all pairs: the mean of the sides of
    /// the hub on which they do, each the mean of its places; not a number where they never do.
    fn place(&self, pair: usize, passages: &[Leapfrog], which: &str) -> f64 {
        let on_side = |side: &str| {
            let of_pair = passages.iter().filter(|one| one.pair == pair && one.side == side);
            let places: Vec<f64> = of_pair.map(|one| self.behind(one.x_m)).collect();
            let place = mean(&places);
            tell!("{side}: {which} of pair {pair} at {place:.2} D, mean of {}", places.len());
            (!places.is_empty()).then_some(place)
        };
        mean(&["above", "below"].into_iter().filter_map(on_side).collect::<Vec<f64>>())
    }

    /// The pair that leapfrogs nearest to the rotor, from 1, and where it does (D).
    fn first_pair(&self) -> (usize, f64) {
        let places =
            (1..=N_BLADES).map(|pair| (pair, self.place(pair, &self.leapfrogs, "the leapfrog")));
        let found = places.filter(|(_, place)| place.is_finite());
        found.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((1, f64::NAN))
    }

    /// Mean place and amplitude of the sine through the places of `pair` over the azimuth of the helix, each
    /// the mean of both sides (D) with half of its 95 % interval, sides taken as independent. The mean of the
    /// places themselves would weigh azimuths by how often vortices happen to be followed there.
    fn sine(&self, pair: usize) -> [[f64; 2]; 2] {
        let sines: Vec<&Sine> = self.leapfrog_sines.iter().filter(|one| one.pair == pair).collect();
        let over = |length: f64| length / self.setting.diameter_m;
        for sine in &sines {
            let [place, amplitude] = [sine.mean_m, sine.amplitude_m].map(over);
            let [of_place, of_amplitude] = [0, 1].map(|k| over(sine.half_widths_95[k]));
            tell!(
                "{}: {place:.2} ± {of_place:.2} D, amplitude {amplitude:.2} ± {of_amplitude:.2} D, {} leapfrogs",
                sine.side,
                sine.n
            );
        }
        [0, 1].map(|k| {
            let values: Vec<f64> =
                sines.iter().map(|sine| over([sine.mean_m, sine.amplitude_m][k])).collect();
            let squares = sines.iter().map(|sine| over(sine.half_widths_95[k]).powi(2));
            [mean(&values), squares.sum::<f64>().sqrt() / sines.len() as f64]
        })
    }

    /// The first place of all (D).
    fn earliest(&self) -> f64 {
        self.leapfrogs.iter().map(|one| self.behind(one.x_m)).fold(f64::NAN, f64::min)
    }

    /// Mean vorticity in the middle of the vortices of `blade`, from 1, soon behind the rotor (1/s).
    fn strength(&self, blade: usize) -> f64 {
        let of_blade = self.tracks.iter().filter(|track| track.blade == Some(blade));
        let early: Vec<f64> = of_blade
            .flat_map(|track| &track.sightings)
            .filter(|one| self.behind(one.vortex.position_m[0]) <= EARLY)
            .map(|one| one.vortex.peak_vorticity_1_s.abs())
            .collect();
        mean(&early)
    }

    /// Mean strength of all blades' vortices soon behind the rotor (1/s), and the weakest's over the mean of
    /// the others (–).
    fn strengths(&self) -> (f64, f64) {
        let mut of_blades: Vec<f64> = (1..=N_BLADES).map(|blade| self.strength(blade)).collect();
        of_blades.sort_by(f64::total_cmp);
        (mean(&of_blades), of_blades[0] / mean(&of_blades[1..]))
    }
}

/// Tip vortices of the runs in `folder` beside what the experiment tells of them, and the power that is left
/// where the second turbine would stand.
pub(super) fn rows(folder: &Path) -> Vec<Row> {
    let runs = || Ok([found(folder, "baseline")?, found(folder, "cw")?, found(folder, "ccw")?]);
    let mut rows = match runs() {
        Ok(runs) => of_runs(&runs),
        Err(problem) => return failure(problem),
    };
    match left(folder) {
        Ok(left) => rows.extend(left),
        Err(problem) => rows.extend(failure(problem)),
    }
    rows
}

/// Power left at the place of the second turbine, over that of the baseline, and where the helices cross.
fn left(folder: &Path) -> Result<Vec<Row>, String> {
    let at = |run: &str, distance: f64| {
        let path = RunFolder::new(folder, run).phase_averages_path(&format!("discs-{distance}D"));
        let plane = StoredPhaseAverages::open(&path).map_err(|error| error.to_string())?;
        let [mean, spread] = of_disc(&plane)?;
        tell!(
            "{run}: fraction of available power at {distance} D {mean:.3} ± {spread:.3} over the phases"
        );
        Ok::<f64, String>(mean)
    };
    let row = |what: String, (run, over): (&str, &str), distance: f64, source| {
        let measured = at(run, distance)? / at(over, distance)?;
        Ok(Row { what, measured, expected: 1.0, tolerance: AtLeast, unit: "–", source })
    };
    let what = |run: &str, over: &str, distance: f64| {
        format!("fraction of available power at {distance} D, no turbine there, {run} over {over}")
    };
    [
        ("cw", "ccw", 4.0, TUNNEL),
        ("cw", "baseline", 5.0, FURTHER),
        ("ccw", "baseline", 5.0, FURTHER),
    ]
    .into_iter()
    .map(|(run, over, distance, source)| {
        row(what(run, over, distance), (run, over), distance, source)
    })
    .collect()
}

fn of_runs([baseline, cw, ccw]: &[Found; 3]) -> Vec<Row> {
    // Each pair of the baseline meets one phase: it leapfrogs once in each revolution, at one place.
    let first = baseline.first_pair();
    let mut rows = of_baseline(baseline, first);
    rows.extend(of_helices(baseline, first, [cw, ccw]));
    rows
}

fn row(
    what: &str,
    measured: f64,
    (expected, tolerance): (f64, Tolerance),
    unit: &'static str,
) -> Row {
    Row { what: what.to_owned(), measured, expected, tolerance, unit, source: TUNNEL }
}

fn of_baseline(baseline: &Found, (first, place): (usize, f64)) -> Vec<Row> {
    let later = &baseline.leapfrogs_of_the_vortex_after_next;
    vec![
        row(
            "place where the first pair leapfrogs, baseline, to which a blade's mounting is fitted",
            place,
            (1.75, Within(PLACE_TOLERANCE)),
            "D",
        ),
        // "The first vortex is subsequently passed by the last trailing vortex, which completes the
        // leapfrogging of the second vortex around x/D = 3" can be read as either of the two.
        row(
            "place where the second pair leapfrogs, baseline",
            baseline.place(first % N_BLADES + 1, &baseline.leapfrogs, "the leapfrog"),
            (3.0, Within(PLACE_TOLERANCE)),
            "D",
        ),
        row(
            "place where the third vortex passes the first of that pair, baseline",
            baseline.place(first, later, "the third vortex's passage"),
            (3.0, Within(PLACE_TOLERANCE)),
            "D",
        ),
        row(
            "vorticity of the weakest blade's vortices over that of the others', baseline",
            baseline.strengths().1,
            (0.5, Within(STRENGTH_TOLERANCE)),
            "–",
        ),
    ]
}

/// What helices do to the vortices, beside the `baseline` whose `first` pair leapfrogs at a place (D).
fn of_helices(baseline: &Found, (first, place): (usize, f64), [cw, ccw]: [&Found; 2]) -> Vec<Row> {
    let strength = baseline.strengths().0;
    let sines = [cw.sine(first), ccw.sine(first)];
    let mut rows = Vec::new();
    for ((name, run), [[mean, half], _]) in [("cw", cw), ("ccw", ccw)].into_iter().zip(sines) {
        rows.push(row(
            &format!(
                "mean of the sine through places where that first pair leapfrogs, {name} over baseline, upper end of its 95 % interval"
            ),
            ratio(mean + half, place),
            (1.0, AtMost),
            "–",
        ));
        rows.push(row(
            &format!("vorticity of vortices soon behind the rotor, {name} over baseline"),
            ratio(run.strengths().0, strength),
            (1.0, AtLeast),
            "–",
        ));
    }
    rows.push(row(
        "nearest place where any pair leapfrogs, ccw",
        ccw.earliest(),
        (1.5, AtMost),
        "D",
    ));
    let [[_, [of_cw, half_cw]], [_, [of_ccw, half_ccw]]] = sines;
    rows.push(row(
        "amplitude of that sine over the azimuth of the helix, cw less ccw, lower end of its 95 % interval",
        of_cw - of_ccw - half_cw.hypot(half_ccw),
        (0.0, AtLeast),
        "D",
    ));
    rows
}
