//! `vortices`: tip vortices from phase to phase, where they leapfrog, and the hub vortex.

mod answer;
mod cut;
pub(crate) mod figures;
mod following;
pub(crate) mod surfaces;

use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, BINS, CYCLES, DIAMETER, FIELD, FROM, HUB, LENGTHS, MEMORY, ROTOR_HZ, TURBINE,
    WIDTH, WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Averaged, Wanted};
use analysis::vortices::{Search, Section, Track, Vortex, vortices};
use cut::Cut;
use following::{Fitted, Passed, follow_all};
use rayon::prelude::*;

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
    "Least vorticity of a vortex, times diameter over free stream; when left out a quarter of the greatest, along the wind of that beyond half the rotor's radius: roots leave stronger ones than tips",
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
/// Nearest that two vortices of one sense may be (rotor diameters).
const SEPARATION: f64 = 0.06;
/// Distance downwind of the rotor from which on vortices are sought (rotor diameters).
const BEYOND: f64 = 0.1;
/// Greatest misfit of a vortex (–).
const MOST_MISFIT: f64 = 0.5;
/// Least distance from the hub at which a vortex comes from a tip, not from a root (rotor diameters).
const TIP: f64 = 0.25;
/// That vortices are not followed, and why.
const NOT_FOLLOWED: &str =
    "vortices are not followed: the rotor's frequency is not known (--rotor-hz)";

/// What was found in the bins.
pub(crate) struct Found {
    averaged: Averaged,
    cut: Cut,
    frames: Vec<Vec<Vortex>>,
    n_lost: usize,
    least: f64,
    tracks: Vec<Track>,
    /// The blade of each track that was born in the plane, where blades are told.
    blades: Vec<(usize, usize)>,
    /// Of all pairs.
    leapfrogs: Vec<Passed>,
    /// Where the vortex after next passes that of each blade, where blades are told.
    later: Vec<Passed>,
    fits: Vec<Fitted>,
    /// The pair that counts, from 1, where blades are told.
    pair: Option<usize>,
    /// What must be said.
    remarks: Vec<String>,
}

impl Found {
    /// The vortices in the fields of `averaged`, as `request` asks for them.
    ///
    /// # Errors
    /// [`PostprocessingError`].
    pub(crate) fn of(request: &Request, averaged: Averaged) -> Result<Self, PostprocessingError> {
        let mut found = Self::sought(request, averaged)?;
        if found.is_along() {
            match rotor_frequency(request, &found.averaged)? {
                Some(frequency) => follow_all(request, &mut found, frequency)?,
                None => found.remarks.push(NOT_FOLLOWED.to_owned()),
            }
        }
        if found.n_lost > 0 {
            found.remarks.push(format!(
                "{} peaks of vorticity were no vortex: their fit did not settle",
                found.n_lost
            ));
        }
        Ok(found)
    }

    /// The vortices in the bins of `averaged`, not followed yet.
    fn sought(request: &Request, averaged: Averaged) -> Result<Self, PostprocessingError> {
        let cut = Cut::of(&averaged)?;
        let least = least(request, &averaged, &cut)?;
        let mut found = Self {
            frames: Vec::new(),
            n_lost: 0,
            least,
            tracks: Vec::new(),
            blades: Vec::new(),
            leapfrogs: Vec::new(),
            later: Vec::new(),
            fits: Vec::new(),
            pair: None,
            remarks: averaged.remarks.clone(),
            averaged,
            cut,
        };
        let search = found.search(least);
        let of_bin = |index| Ok(vortices(&found.section(index)?, &search));
        let bins = (0..found.averaged.head.bins.len()).into_par_iter().map(of_bin);
        let frames: Vec<(Vec<Vortex>, usize)> = bins.collect::<Result<_, PostprocessingError>>()?;
        found.n_lost = frames.iter().map(|(_, n_lost)| n_lost).sum();
        found.frames = frames.into_iter().map(|(vortices, _)| vortices).collect();
        Ok(found)
    }

    /// Leapfrogs of the pair that counts.
    fn counted(&self) -> impl Iterator<Item = &Passed> {
        self.leapfrogs.iter().filter(|passed| passed.pair == self.pair)
    }

    /// Their sines.
    fn sines(&self) -> impl Iterator<Item = &Fitted> {
        self.fits.iter().filter(|fitted| fitted.pair == self.pair)
    }

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
    let found = Found::of(request, Averaged::of(request, Wanted::Bins)?)?;
    let mut remarks = found.remarks.clone();
    let (surface, told) = surfaces::made(request, &found, request.text(FIGURES.name).is_some())?;
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
    let (mut greatest, mut of_tips) = (0.0_f64, 0.0_f64);
    let area = search(averaged, cut, 0.0).within;
    for index in 0..averaged.head.bins.len() {
        let section = section(averaged, cut, index)?;
        for (point, vorticity) in section.vorticity().iter().enumerate() {
            let at = section.position(point);
            let is_in = (0..2).all(|a| (area[a][0]..=area[a][1]).contains(&at[a]));
            if is_in && vorticity.is_finite() {
                greatest = greatest.max(vorticity.abs());
                if is_of_a_tip(averaged, cut, at) {
                    of_tips = of_tips.max(vorticity.abs());
                }
            }
        }
    }
    // Fields about the hub alone show no tips.
    Ok(0.25 * if of_tips > 0.0 { of_tips } else { greatest })
}

/// Whether what is at `place` in a plane along the wind can come from the tip of a blade; anything in one
/// across it.
fn is_of_a_tip(averaged: &Averaged, cut: &Cut, place: [f64; 2]) -> bool {
    let [along, across] = [0, 1].map(|axis| cut.grid.spanned()[axis]);
    let setting = &averaged.setting;
    along != 0 || (place[1] - setting.hub[across]).abs() >= TIP * setting.diameter
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
