//! The wake by phase of the helix: seen from above with its centre line, and its deficit about its own
//! centre.

use super::{Joined, Synchronised};
use crate::PostprocessingError;
use analysis::AnalysisError;
use analysis::wake::{PhasePlane, centre_line, recentred_deficit};
use basis::records::{Plane, Rotor};
use farm::case::Placement;
use report::{
    CentreLine, DeficitFigure, DeficitLine, DeficitPanel, SliceFigure, SlicePanel, SliceRotor,
};

/// Width of the Gaussian that finds a centre (rotor diameters).
const WIDTH: f64 = 0.5;
/// Distances behind the synchronised turbine at which deficits are shown (rotor diameters).
const DISTANCES: [f64; 4] = [2.0, 3.0, 4.0, 4.75];
/// Half width of a recentred profile (rotor diameters), and its points (–).
const HALF_WIDTH: f64 = 1.25;
const N_POINTS: usize = 81;

/// One of the two cases that are shown.
struct Shown<'a> {
    colour: usize,
    name: String,
    /// Planes by phase (rad), in the order of the phases.
    planes: &'a [(f64, Plane)],
}

/// Both figures; none where no planes were averaged by phase.
pub(super) fn wake(
    study: &Synchronised,
) -> Result<(Option<SliceFigure>, Option<DeficitFigure>), PostprocessingError> {
    let (Some(best), Some(worst)) = (ranked(study, true), ranked(study, false)) else {
        return Ok((None, None));
    };
    let shown = |(place, run): (usize, &Joined)| Shown {
        colour: place + 1,
        name: run.name.clone(),
        planes: planes(study, run.run),
    };
    let cases: Vec<Shown> = [best, worst].into_iter().enumerate().map(shown).collect();
    if cases.iter().any(|case| case.planes.is_empty()) {
        return Ok((None, None));
    }
    let free_stream = |_: f64| study.case.wind.speed;
    let width = WIDTH * study.diameter;
    // Ends of the plane are left out: upstream of the first rotor there is no wake.
    let feet = study.case.feet(study.diameter);
    let x = |index: usize| feet[index][0];
    let line_of = |plane: &Plane| -> Result<Vec<[f64; 2]>, AnalysisError> {
        let line = centre_line(plane, free_stream, width)?;
        Ok(line.into_iter().filter(|[at, _]| *at > x(0) + 0.5 * study.diameter).collect())
    };
    let mut panels = Vec::new();
    let mut lines = Vec::new();
    for Shown { colour, name, planes } in &cases {
        let plane = planes[0].1.clone();
        let line = line_of(&plane)?;
        lines.push(CentreLine { name: name.clone(), colour: *colour, points: line.clone() });
        panels.push(SlicePanel { title: name.clone(), colour: *colour, plane, centre_line: line });
    }
    // Beside them the run that they compare with, and the helix of the first turbine alone.
    let others = study.records.runs.iter().enumerate().filter(|(_, run)| {
        let compared = study.records.runs[best.run].summary.compare_with.as_deref();
        run.summary.turbines.len() == 1 || compared == Some(run.manifest.run.as_str())
    });
    for (place, (run, records)) in others.enumerate() {
        let Some((_, plane)) = planes(study, run).first() else { continue };
        let colour = if place == 0 { 0 } else { cases.len() + place };
        let points = line_of(plane)?;
        lines.push(CentreLine { name: records.manifest.run.clone(), colour, points });
    }
    let slices = SliceFigure {
        diameter: study.diameter,
        free_stream: study.case.wind.speed,
        rotors: rotors(study),
        planes: panels,
        centre_lines: lines,
        phase: "t = 0 Te".into(),
    };
    Ok((Some(slices), deficits(study, &cases, width)?))
}

/// The rotors of the case; as large as the first and at the height of the planes where no record tells.
fn rotors(study: &Synchronised) -> Vec<SliceRotor> {
    let runs = || study.records.runs.iter();
    let turbines = || runs().flat_map(|run| &run.summary.turbines);
    let height = runs().flat_map(|run| &run.phase_planes).map(|(_, plane)| plane.origin[2]).next();
    let rotor = |(placed, [x, y]): (&Placement, [f64; 2])| {
        let told = turbines().filter(|turbine| turbine.name == placed.name);
        let hub = [x, y, height.unwrap_or(0.0)];
        let alike = Rotor { diameter: study.diameter, hub, yaw_deg: 0.0 };
        let Rotor { diameter, hub, yaw_deg } =
            told.filter_map(|turbine| turbine.rotor).next().unwrap_or(alike);
        SliceRotor { name: placed.name.clone(), hub, diameter, yaw: yaw_deg.to_radians() }
    };
    study.case.turbines.iter().zip(study.case.feet(study.diameter)).map(rotor).collect()
}

fn deficits(
    study: &Synchronised,
    cases: &[Shown],
    width: f64,
) -> Result<Option<DeficitFigure>, PostprocessingError> {
    let [own, _] = study.case.places_in_diameters(study.diameter)[study.turbine];
    let half = HALF_WIDTH * study.diameter;
    let offsets: Vec<f64> =
        (0..N_POINTS).map(|k| half * (2.0 * k as f64 / (N_POINTS - 1) as f64 - 1.0)).collect();
    let mut panels = Vec::new();
    for distance in DISTANCES {
        let x = (own + distance) * study.diameter;
        let mut lines = Vec::new();
        for Shown { colour, name, planes } in cases {
            let planes: Vec<PhasePlane> = planes
                .iter()
                .map(|(phase, plane)| PhasePlane {
                    phase: *phase,
                    n_instants: 1,
                    plane: plane.clone(),
                })
                .collect();
            let speed = |_: f64| study.case.wind.speed;
            match recentred_deficit(&planes, speed, width, x, &offsets) {
                Ok(deficits) => lines.push(DeficitLine {
                    name: name.clone(),
                    colour: *colour,
                    offsets: offsets.clone(),
                    deficits,
                }),
                // Beyond the domain there is nothing to show.
                Err(AnalysisError::OutsidePlane { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        if !lines.is_empty() {
            panels.push(DeficitPanel {
                title: format!("{distance} D behind {}", study.case.turbines[study.turbine].name),
                lines,
            });
        }
    }
    let (diameter, free_stream) = (study.diameter, study.case.wind.speed);
    Ok((!panels.is_empty()).then_some(DeficitFigure { diameter, free_stream, panels }))
}

/// The joined run with the greatest, or least, gain of the turbines downstream.
fn ranked<'a>(study: &'a Synchronised, best: bool) -> Option<&'a Joined> {
    let places = study.case.places();
    let [own, _] = places[study.turbine];
    let gain = |run: &Joined| -> Option<f64> {
        let turbines = &study.records.runs[run.run].summary.turbines;
        let behind = study.case.turbines.iter().zip(&places).filter(|(_, [x, _])| *x > own);
        let (last, _) = behind.max_by(|a, b| a.1[0].total_cmp(&b.1[0]))?;
        turbines.iter().find(|turbine| turbine.name == last.name)?.power_gain.map(|gain| gain.mean)
    };
    let ranked = study.runs.iter().filter(|run| run.offset().is_some());
    let ranked = ranked.filter_map(|run| Some((gain(run)?, run)));
    let sign = if best { 1.0 } else { -1.0 };
    ranked.max_by(|a, b| (sign * a.0).total_cmp(&(sign * b.0))).map(|found| found.1)
}

/// Planes of a run by phase, in the order of the phases.
fn planes<'a>(study: &'a Synchronised, run: usize) -> &'a [(f64, Plane)] {
    &study.records.runs[run].phase_planes
}
