//! Figures of a tuning: the curve iteration by iteration, maps, cuts, and power against loads.

use crate::{Compromise, Tuned, TuningError};
use report::{CurveAt, CurveFigure, CurvePanel, MapColours, MapFigure, MapPanel, Signals};
use search::{Normal, Sum};

/// Places along a curve, and along each side of a map (–).
const N_ALONG: usize = 121;
const N_ASIDE: usize = 41;
/// Iterations that are drawn at most (–).
const MOST: usize = 12;

/// What is drawn of a point's processes.
#[derive(Clone, Copy)]
enum Part {
    Turbine(usize),
    Array,
}

impl Part {
    /// It at `points` (%).
    fn at(self, sum: &Sum, points: &[Vec<f64>]) -> Result<Vec<Normal>, TuningError> {
        let found = match self {
            Self::Turbine(place) => sum.output(place, points)?,
            Self::Array => sum.at(points)?,
        };
        // What all runs share belongs to the array's gain alone.
        let shared = if matches!(self, Self::Array) { sum.shared_deviation() } else { 0.0 };
        let percent = |one: Normal| Normal {
            mean: 100.0 * one.mean,
            deviation: 100.0 * one.deviation.hypot(shared),
        };
        Ok(found.into_iter().map(percent).collect())
    }

    /// Its blocks in the first `n` evaluations (%), with their points.
    fn blocks(self, tuned: &Tuned, n: usize) -> Vec<(Vec<f64>, f64)> {
        let history = &tuned.found.history;
        let runs = history.points.iter().zip(&history.evaluations).take(n);
        let of_run = |(point, one): (&Vec<f64>, &search::Evaluation)| {
            let n_blocks = one.outputs[0].len();
            let value = |block: usize| match self {
                Self::Turbine(place) => one.outputs[place][block],
                Self::Array => {
                    one.outputs[..tuned.turbines.len()].iter().map(|output| output[block]).sum()
                }
            };
            (0..n_blocks).map(|block| (point.clone(), 100.0 * value(block))).collect::<Vec<_>>()
        };
        runs.flat_map(of_run).collect()
    }
}

/// Every turbine with its name, and the array.
fn parts(tuned: &Tuned) -> Vec<(Part, String)> {
    let turbines = tuned.turbines.iter().enumerate();
    let mut parts: Vec<(Part, String)> =
        turbines.map(|(place, name)| (Part::Turbine(place), name.clone())).collect();
    parts.push((Part::Array, "array".to_owned()));
    parts
}

/// All figures of `tuned`.
///
/// # Errors
/// [`TuningError::Search`].
pub(crate) fn all(tuned: &Tuned) -> Result<Signals, TuningError> {
    let n = tuned.file.variables.len();
    let (mut maps, mut curves) = (Vec::new(), Vec::new());
    if n == 1 {
        curves.push(iterations(tuned)?);
    }
    if n == 2 {
        maps.push(map(tuned)?);
    }
    for variable in 0..n {
        curves.push(cut(tuned, variable)?);
    }
    curves.extend(tuned.compromises.iter().map(front));
    Ok(Signals { maps, curves, ..Signals::default() })
}

/// Values from one end of variable `variable` to the other.
fn along(tuned: &Tuned, variable: usize, n: usize) -> Vec<f64> {
    let axis = &tuned.file.variables[variable].axis;
    let share = |place: usize| place as f64 / (n - 1) as f64;
    (0..n).map(|place| axis.from + share(place) * (axis.to - axis.from)).collect()
}

/// The curve of `part` along `variable` through `through`.
fn curve(
    tuned: &Tuned,
    (sum, part): (&Sum, Part),
    variable: usize,
    through: &[f64],
) -> Result<Vec<CurveAt>, TuningError> {
    let places = along(tuned, variable, N_ALONG);
    let point = |place: &f64| {
        let mut point = through.to_vec();
        point[variable] = *place;
        point
    };
    let found = part.at(sum, &places.iter().map(point).collect::<Vec<_>>())?;
    let one =
        |(at, one): (&f64, Normal)| CurveAt { at: *at, mean: one.mean, band_95: one.band_95() };
    Ok(places.iter().zip(found).map(one).collect())
}

/// The gain of the array after each iteration, of one variable.
fn iterations(tuned: &Tuned) -> Result<CurveFigure, TuningError> {
    let steps = &tuned.found.steps;
    let stride = steps.len().div_ceil(MOST);
    let is_drawn = |place: usize| place.is_multiple_of(stride) || place + 1 == steps.len();
    let mut panels = Vec::new();
    for (_, step) in steps.iter().enumerate().filter(|(place, _)| is_drawn(*place)) {
        let blocks = Part::Array.blocks(tuned, step.n_evaluations);
        panels.push(CurvePanel {
            title: format!("{} runs", step.n_evaluations),
            points: blocks.into_iter().map(|(point, value)| [point[0], value]).collect(),
            curve: curve(tuned, (&step.sum, Part::Array), 0, &step.optimum.point)?,
            mark: Some(step.optimum.point[0]),
        });
    }
    Ok(CurveFigure {
        name: "iterations".to_owned(),
        title: "Gain of the array, iteration by iteration".to_owned(),
        caption: "Crosses: blocks of the runs; line and band: the Gaussian processes' sum and where it lies with 95\u{a0}%; dashed: its highest place."
            .to_owned(),
        along: tuned.file.variables[0].label(),
        label: "gain (%)".to_owned(),
        panels,
    })
}

/// Turbines and array over both of two variables.
fn map(tuned: &Tuned) -> Result<MapFigure, TuningError> {
    let places = [along(tuned, 0, N_ASIDE), along(tuned, 1, N_ASIDE)];
    let points: Vec<Vec<f64>> =
        places[1].iter().flat_map(|y| places[0].iter().map(move |x| vec![*x, *y])).collect();
    let optimum = &tuned.found.optimum.point;
    let panel = |(part, title): (Part, String)| {
        let values = part.at(&tuned.found.sum, &points)?;
        Ok(MapPanel {
            title,
            places: places.clone(),
            values: values.iter().map(|value| value.mean).collect(),
            points: tuned.found.history.points.iter().map(|point| [point[0], point[1]]).collect(),
            mark: Some([optimum[0], optimum[1]]),
        })
    };
    let variables = &tuned.file.variables;
    Ok(MapFigure {
        colours: MapColours::AboutZero,
        is_to_scale: false,
        has_lines: true,
        name: "maps".to_owned(),
        title: "Gain over both variables".to_owned(),
        caption: "Share of the baseline's array power that each turbine and the array gain, means of the Gaussian processes; crosses: runs; dashed: the optimum."
            .to_owned(),
        along: [variables[0].label(), variables[1].label()],
        unit: "%".to_owned(),
        panels: parts(tuned).into_iter().map(panel).collect::<Result<_, TuningError>>()?,
    })
}

/// Turbines and array along `variable`, the others as at the optimum.
fn cut(tuned: &Tuned, variable: usize) -> Result<CurveFigure, TuningError> {
    let optimum = &tuned.found.optimum.point;
    let is_alone = tuned.file.variables.len() == 1;
    let panel = |(part, title): (Part, String)| {
        let blocks = part.blocks(tuned, tuned.found.history.len());
        // Of several variables only what was run on the line itself lies on it.
        let is_on = |point: &[f64]| {
            (0..point.len()).all(|other| other == variable || point[other] == optimum[other])
        };
        let on = blocks.into_iter().filter(|(point, _)| is_alone || is_on(point));
        Ok(CurvePanel {
            title,
            points: on.map(|(point, value)| [point[variable], value]).collect(),
            curve: curve(tuned, (&tuned.found.sum, part), variable, optimum)?,
            mark: Some(optimum[variable]),
        })
    };
    let own = &tuned.file.variables[variable];
    Ok(CurveFigure {
        name: format!("cut-{}", variable + 1),
        title: format!("Gain over {}", own.name),
        caption: format!(
            "Share of the baseline's array power{}; bands: where the curves lie with 95\u{a0}%; crosses: blocks of runs there.",
            if is_alone { "" } else { ", the other variables as at the optimum" }
        ),
        along: own.label(),
        label: "gain (%)".to_owned(),
        panels: parts(tuned).into_iter().map(panel).collect::<Result<_, TuningError>>()?,
    })
}

/// Power against a load.
fn front(compromise: &Compromise) -> CurveFigure {
    let one = |(_, gain, load): &(Vec<f64>, Normal, Normal)| CurveAt {
        at: 100.0 * load.mean,
        mean: 100.0 * gain.mean,
        band_95: gain.band_95().map(|end| 100.0 * end),
    };
    let panel = CurvePanel {
        title: format!("array and {}", compromise.channel),
        curve: compromise.settings.iter().map(one).collect(),
        ..CurvePanel::default()
    };
    CurveFigure {
        name: format!("front-{}", compromise.channel.replace('.', "-")),
        title: format!("Power against {}", compromise.channel),
        caption: format!(
            "Settings that no other one betters in both: gain of the array with its 95\u{a0}% band over the change of the damage-equivalent load (Wöhler exponent {}).",
            compromise.exponent
        ),
        along: "change of the equivalent load (%)".to_owned(),
        label: "gain (%)".to_owned(),
        panels: vec![panel],
    }
}
