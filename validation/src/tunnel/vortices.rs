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

impl Found {
    /// `x` (m) in diameters behind the hub.
    fn behind(&self, x: f64) -> f64 {
        (x - self.setting.hub_m[0]) / self.setting.diameter_m
    }

    /// Where `pair` leapfrogs (D), the mean of the places on `side` of the hub, if it does.
    fn place(&self, pair: usize, side: &str) -> Option<f64> {
        let of_pair = self.leapfrogs.iter().filter(|one| one.pair == pair && one.side == side);
        let places: Vec<f64> = of_pair.map(|one| self.behind(one.x_m)).collect();
        if places.is_empty() {
            return None;
        }
        let mean = places.iter().sum::<f64>() / places.len() as f64;
        tell!("{side}: pair {pair} leapfrogs at {mean:.2} D, mean of {}", places.len());
        Some(mean)
    }

    /// The place at which each pair leapfrogs, the mean of the sides on which it does (D), the nearest first,
    /// with the pair's number from 1.
    fn places(&self) -> Vec<(usize, f64)> {
        let place = |pair: usize| {
            let on_side = |side| self.place(pair, side);
            let places: Vec<f64> = ["above", "below"].into_iter().filter_map(on_side).collect();
            (!places.is_empty()).then(|| (pair, places.iter().sum::<f64>() / places.len() as f64))
        };
        let mut places: Vec<(usize, f64)> = (1..=N_BLADES).filter_map(place).collect();
        places.sort_by(|a, b| a.1.total_cmp(&b.1));
        places
    }

    /// Mean place and amplitude of the sine through the places of `pair` over the azimuth of the helix, each
    /// the mean of both sides (D). The mean of the places themselves would weigh azimuths by how often
    /// vortices happen to be followed there.
    fn sine(&self, pair: usize) -> [f64; 2] {
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
        let mean = |of: fn(&Sine) -> f64| {
            over(sines.iter().map(|sine| of(sine)).sum::<f64>() / sines.len() as f64)
        };
        [mean(|sine| sine.mean_m), mean(|sine| sine.amplitude_m)]
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
        early.iter().sum::<f64>() / early.len() as f64
    }

    /// Mean strength of all blades' vortices soon behind the rotor (1/s), and the weakest's over the mean of
    /// the others (–).
    fn strengths(&self) -> (f64, f64) {
        let mut of_blades: Vec<f64> = (1..=N_BLADES).map(|blade| self.strength(blade)).collect();
        of_blades.sort_by(f64::total_cmp);
        let mean = of_blades.iter().sum::<f64>() / N_BLADES as f64;
        let others = of_blades[1..].iter().sum::<f64>() / (N_BLADES - 1) as f64;
        (mean, of_blades[0] / others)
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

/// Power left at the place of the second turbine, over that of the baseline.
fn left(folder: &Path) -> Result<Vec<Row>, String> {
    let at = |run: &str| {
        let path = RunFolder::new(folder, run).phase_averages_path("discs-5D");
        let plane = StoredPhaseAverages::open(&path).map_err(|error| error.to_string())?;
        let [mean, spread] = of_disc(&plane)?;
        tell!("{run}: fraction of available power at 5 D {mean:.3} ± {spread:.3} over the phases");
        Ok::<f64, String>(mean)
    };
    let baseline = at("baseline")?;
    let row = |run: &str| {
        Ok(Row {
            what: format!(
                "fraction of available power at 5 D, no turbine there, {run} over baseline"
            ),
            measured: at(run)? / baseline,
            expected: 1.0,
            tolerance: AtLeast,
            unit: "–",
            source: FURTHER,
        })
    };
    ["cw", "ccw"].into_iter().map(row).collect()
}

fn of_runs([baseline, cw, ccw]: &[Found; 3]) -> Vec<Row> {
    // Each pair of the baseline meets one phase: it leapfrogs once in each revolution, at one place.
    let places = baseline.places();
    let mut rows = of_baseline(baseline, &places);
    let first = places.first().copied().unwrap_or((1, f64::NAN));
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

fn of_baseline(baseline: &Found, places: &[(usize, f64)]) -> Vec<Row> {
    let place = |number: usize| places.get(number).map_or(f64::NAN, |(_, place)| *place);
    vec![
        row(
            "place where the first pair leapfrogs, baseline, to which a blade's mounting is fitted",
            place(0),
            (1.75, Within(PLACE_TOLERANCE)),
            "D",
        ),
        row(
            "place where the second pair leapfrogs, baseline",
            place(1),
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
    for ((name, run), [mean, _]) in [("cw", cw), ("ccw", ccw)].into_iter().zip(sines) {
        rows.push(row(
            &format!("mean of the sine through places where that first pair leapfrogs, {name} over baseline"),
            ratio(mean, place),
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
    rows.push(row(
        "amplitude of that sine over the azimuth of the helix, cw over ccw",
        ratio(sines[0][1], sines[1][1]),
        (1.0, AtLeast),
        "–",
    ));
    rows
}
