//! `vortices`: tip vortices from phase to phase, where they leapfrog, and the hub vortex.

mod answer;
mod cut;
mod figures;
mod surfaces;

use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, BINS, CYCLES, DIAMETER, FIELD, FROM, HUB, LENGTHS, MEMORY, ROTOR_HZ, TURBINE,
    WIDTH, WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Averaged, Wanted};
use analysis::vortices::{
    Blades, Leapfrog, Pairs, Search, Section, SineFit, Track, Tracking, Vortex, blades_of, follow,
    leapfrogs, sine_fit, vortices,
};
use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use cut::Cut;
use std::f64::consts::TAU;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "vortices",
    about: "Vortices in a plane averaged by phase, or in the one along the wind through the hub of a volume: places, circulations and cores by a fit, followed from phase to phase, their strength over distance, where one passes the one before it over the phase of the helix, and the hub vortex in a plane across the wind; isosurfaces of Q of a volume: figures 9 and 13 to 15 of van der Hoek et al. (2024)",
    of: Of::Run("Folder of a run, or a file of fields or of averages by phase"),
    settings: &[
        FIELD, TURBINE, LEAST, BLADES, PAIR, SURFACES, CRITERION, LEVEL, ROTOR_HZ, BINS, CYCLES,
        WIDTH, FROM, AZIMUTHS, DIAMETER, WIND_SPEED, HUB, LENGTHS, ZEROS, MEMORY, FIGURES,
    ],
    run,
};

const LEAST: AnalysisSetting = settings::setting(
    "least-vorticity",
    "D/U",
    Takes::Number,
    "Least vorticity of a vortex, times diameter over free stream; a quarter of the greatest when left out",
);
const BLADES: AnalysisSetting = settings::setting(
    "blades",
    "N",
    Takes::Number,
    "Blades, whose vortices make pairs; each vortex with the next when left out",
);
const PAIR: AnalysisSetting = settings::setting(
    "pair",
    "N",
    Takes::Number,
    "Which of the pairs of a revolution counts, from 1, in the order in which vortices come after the first bin, with --blades; 1 when left out",
);
const SURFACES: AnalysisSetting = settings::setting(
    "surfaces",
    "FOLDER",
    Takes::Text,
    "Folder to write an isosurface of each bin of a volume into, for ParaView: q-000.vtp and so on; none when left out",
);
const CRITERION: AnalysisSetting = AnalysisSetting {
    name: "criterion",
    value: "CRITERION",
    takes: Takes::Choice(&[
        ("q", "Q: turning outweighs straining"),
        ("lambda2", "Minus the middle eigenvalue of the squares of strain and turning"),
    ]),
    about: "What the isosurfaces are of; Q when left out",
};
const LEVEL: AnalysisSetting = settings::setting(
    "level",
    "(U/D)2",
    Takes::Number,
    "Value on the isosurfaces, times squared diameter over squared free stream; a twentieth of the greatest when left out",
);
/// Nearest that two vortices of one sense may be, and how far one may be from where it is expected (rotor
/// diameters).
const SEPARATION: f64 = 0.06;
const GATE: f64 = 0.08;
/// Distance downwind of the rotor from which on vortices are sought (rotor diameters).
const BEYOND: f64 = 0.1;
/// Length in which vortices are taken as new (rotor diameters).
const BIRTH: f64 = 0.15;
/// Greatest misfit of a vortex (–).
const MOST_MISFIT: f64 = 0.5;
/// Revolutions for which a vortex is followed at least (–).
const REVOLUTIONS: f64 = 8.0;

/// What was found in all bins.
struct Found {
    averaged: Averaged,
    cut: Cut,
    frames: Vec<Vec<Vortex>>,
    n_lost: usize,
    least: f64,
    tracks: Vec<Track>,
    /// The blade of each track that was born in the plane, where blades are told.
    blades: Vec<(usize, usize)>,
    /// Those with the azimuth of the helix (rad), where there is a helix.
    leapfrogs: Vec<(Option<f64>, Leapfrog)>,
    fit: Option<SineFit>,
}

impl Found {
    /// Whether the plane lies along the wind.
    fn is_along(&self) -> bool {
        self.cut.grid.n_points[0] > 1
    }

    /// The plane in bin number `index`.
    fn section(&self, index: usize) -> Result<Section, PostprocessingError> {
        section(&self.averaged, &self.cut, index)
    }

    /// Where vortices are sought: along the wind beyond the rotor, across it about the hub; those of
    /// `least_vorticity` (1/s) at least.
    fn search(&self, least_vorticity: f64) -> Search {
        search(&self.averaged, &self.cut, least_vorticity)
    }
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let averaged = Averaged::of(request, Wanted::Bins)?;
    let cut = Cut::of(&averaged)?;
    let least = least(request, &averaged, &cut)?;
    let mut found = Found {
        frames: Vec::new(),
        n_lost: 0,
        least,
        tracks: Vec::new(),
        blades: Vec::new(),
        leapfrogs: Vec::new(),
        fit: None,
        averaged,
        cut,
    };
    for index in 0..found.averaged.head.bins.len() {
        let (vortices, n_lost) = vortices(&found.section(index)?, &found.search(least));
        found.frames.push(vortices);
        found.n_lost += n_lost;
    }
    let mut remarks = found.averaged.remarks.clone();
    if found.is_along() {
        match rotor_frequency(request, &found.averaged)? {
            Some(frequency) => follow_all(request, &mut found, frequency)?,
            None => remarks.push(
                "vortices are not followed: the rotor's frequency is not known (--rotor-hz)"
                    .to_owned(),
            ),
        }
    }
    if found.n_lost > 0 {
        remarks.push(format!(
            "{} peaks of vorticity were no vortex: their fit did not settle",
            found.n_lost
        ));
    }
    let (surface, told) = surfaces::made(request, &found)?;
    remarks.extend(told);
    let mut signals = figures::signals(&found)?;
    signals.surfaces.extend(surface);
    remarks.extend(drawn(request, &[signals])?);
    Ok(Answer { text: answer::text(&found, request.width()), json: answer::json(&found), remarks })
}

fn section(averaged: &Averaged, cut: &Cut, index: usize) -> Result<Section, PostprocessingError> {
    let velocity = cut.velocity(&averaged.bin(index)?);
    Section::of(&cut.grid, &velocity).ok_or_else(|| cut::refusal(averaged))
}

/// Least vorticity of a peak (1/s).
fn least(request: &Request, averaged: &Averaged, cut: &Cut) -> Result<f64, PostprocessingError> {
    let setting = &averaged.setting;
    let unit = setting.wind_speed / setting.diameter;
    if request.number(LEAST.name).is_some() {
        return Ok(settings::positive(request, &LEAST, 1.0)? * unit);
    }
    let mut greatest = 0.0_f64;
    let area = search(averaged, cut, 0.0).within;
    for index in 0..averaged.head.bins.len() {
        let section = section(averaged, cut, index)?;
        for (point, vorticity) in section.vorticity().iter().enumerate() {
            let at = section.position(point);
            let is_in = (0..2).all(|a| (area[a][0]..=area[a][1]).contains(&at[a]));
            if is_in && vorticity.is_finite() {
                greatest = greatest.max(vorticity.abs());
            }
        }
    }
    Ok(0.25 * greatest)
}

fn search(averaged: &Averaged, cut: &Cut, least_vorticity: f64) -> Search {
    let (grid, setting) = (&cut.grid, &averaged.setting);
    let spanned = grid.spanned();
    let range = |axis: usize| {
        let last = grid.coordinate(axis, grid.n_points[axis] - 1);
        match axis {
            0 => [grid.origin[0].max(setting.hub[0] + BEYOND * setting.diameter), last],
            _ => [grid.origin[axis], last],
        }
    };
    Search {
        least_vorticity,
        separation: SEPARATION * setting.diameter,
        within: [range(spanned[0]), range(spanned[1])],
        most_misfit: MOST_MISFIT,
    }
}

fn rotor_frequency(
    request: &Request,
    averaged: &Averaged,
) -> Result<Option<f64>, PostprocessingError> {
    if request.text(ROTOR_HZ.name).is_some() {
        return settings::positive(request, &ROTOR_HZ, 1.0).map(Some);
    }
    Ok(averaged.rates.map(|(rotor, _)| rotor))
}

fn follow_all(
    request: &Request,
    found: &mut Found,
    frequency: f64,
) -> Result<(), PostprocessingError> {
    let setting = found.averaged.setting.clone();
    let in_turn = TAU / found.averaged.head.rotor_width;
    let start = found.search(found.least).within[0][0];
    let rounds = (REVOLUTIONS * in_turn / found.frames.len() as f64).ceil() as usize + 1;
    let birth = start + BIRTH * setting.diameter + found.cut.grid.spacing[0];
    let tracking = Tracking {
        interval: 1.0 / (frequency * in_turn),
        gate: GATE * setting.diameter,
        n_rounds: if found.frames.len() > 1 { rounds } else { 1 },
        birth,
        most_missed: 1,
    };
    found.tracks = follow(&found.frames, &tracking);
    let mut pairs = Pairs::All;
    if request.text(BLADES.name).is_some() {
        let n = settings::whole(request, &BLADES, 1, 3)?;
        let pair = settings::whole(request, &PAIR, 1, 1)?;
        if pair > n {
            return Err(PostprocessingError::Setting {
                setting: PAIR.name,
                given: pair.to_string(),
                expected: "a number up to that of the blades is expected",
                fix: "write such as 1",
            });
        }
        let blades = Blades { n, per_revolution: in_turn.round() as usize, line: birth };
        pairs = Pairs::Of { blades, first: pair - 1 };
        found.blades = blades_of(&found.tracks, &blades);
    }
    let n = found.frames.len();
    for leapfrog in leapfrogs(&found.tracks, pairs) {
        let [bin, next] =
            [0, 1].map(|ahead| &found.averaged.head.bins[(leapfrog.step as usize + ahead) % n]);
        // The helix goes on between bins, by as much as from this one to the next.
        let azimuth = bin
            .helix
            .zip(next.helix)
            .map(|(a, b)| wrap_to_turn(a + leapfrog.step.fract() * wrap_to_half_turn(b - a)));
        found.leapfrogs.push((azimuth, leapfrog));
    }
    let over_helix = found.leapfrogs.iter().filter_map(|(a, one)| Some(((*a)?, one.place)));
    let (angles, places): (Vec<f64>, Vec<f64>) =
        over_helix.map(|(angle, place)| (angle, place - setting.hub[0])).unzip();
    // Too few, or all at one azimuth: no sine.
    found.fit = sine_fit(&angles, &places).ok();
    Ok(())
}
