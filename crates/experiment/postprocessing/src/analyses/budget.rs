//! `budget`: the budget of mean kinetic energy in control volumes along a wake.

use super::phases::setting_json;
use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, BINS, CYCLES, DIAMETER, FIELD, FROM, HUB, LENGTHS, MEMORY, TURBINE, WIDTH,
    WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Averaged, Wanted, conditions, refused};
use analysis::entrainment::{Budget, MeanFlow, Region, budget};
use report::text_table::{Column, TextTable};
use report::{Along, Signals, TrackFigure, TrackLine, TrackRow};
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "budget",
    about: "Budget of mean kinetic energy in boxes along a wake, of fields that fill a volume: advection, work of pressure where it is on record, flux by stresses, production of turbulence, and what is left",
    of: Of::Run("Folder of a run, or a file of fields or of averages by phase"),
    settings: &[
        FIELD, TURBINE, LENGTH, SIDE, BINS, CYCLES, WIDTH, FROM, AZIMUTHS, DIAMETER, WIND_SPEED,
        HUB, LENGTHS, ZEROS, MEMORY, FIGURES,
    ],
    run,
};

const LENGTH: AnalysisSetting = settings::setting(
    "length",
    "D",
    Takes::Number,
    "Length of a box along the wind (rotor diameters); 0.5 when left out",
);
const SIDE: AnalysisSetting = settings::setting(
    "side",
    "D",
    Takes::Number,
    "Width and height of the boxes about the hub (rotor diameters); 1 when left out",
);

/// A box and its budget.
struct BoxRow {
    /// From where to where along x, from the hub (m).
    span: [f64; 2],
    budget: Budget,
}

impl BoxRow {
    fn holds_rotor(&self) -> bool {
        self.span[0] <= 0.0 && self.span[1] >= 0.0
    }
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let found = Averaged::of(request, Wanted::PARTS)?;
    let (rows, told) = boxes(request, &found)?;
    let mut remarks = found.remarks.clone();
    remarks.extend(told);
    remarks.extend(drawn(request, &[signals(&found, &rows)])?);
    let text = text(&found, &rows, request.width());
    Ok(Answer { text, json: json(&found, &rows), remarks })
}

/// The figure of the fields of `found`, and what must be said.
///
/// # Errors
/// [`PostprocessingError::Fields`] for fields without a budget.
pub(crate) fn shown(request: &Request, found: &Averaged) -> Result<Signals, PostprocessingError> {
    let (rows, notes) = boxes(request, found)?;
    Ok(Signals { notes, ..signals(found, &rows) })
}

/// The boxes that `request` asks for, and what must be said.
fn boxes(
    request: &Request,
    found: &Averaged,
) -> Result<(Vec<BoxRow>, Vec<String>), PostprocessingError> {
    let length = settings::positive(request, &LENGTH, 0.5)? * found.setting.diameter;
    let side = settings::positive(request, &SIDE, 1.0)? * found.setting.diameter;
    if found.grid().spanned().len() < 3 {
        let fix = "give fields of a volume, such as `--field volumes` of a run with output.volume_interval";
        return Err(refused(&found.path, "spans no volume, which a budget needs", fix));
    }
    let (rows, n_holed) = in_a_row(found, length, side)?;
    let left = match found.head.pressure {
        Some(_) => "viscous and subgrid stresses are not on record: their work is in the residual",
        None => {
            "pressure is not on record: its work is in the residual, with that of viscous and subgrid stresses"
        }
    };
    let mut told = vec![left.to_owned()];
    if let Some(row) = rows.iter().find(|row| row.holds_rotor()) {
        let [from, to] = row.span.map(|x| x / found.setting.diameter);
        told.push(format!(
            "the box from {from:.2} to {to:.2} D holds the rotor: what the rotor takes is in its residual, and in its neighbours' as far as its forces are smeared"
        ));
    }
    if n_holed > 0 {
        told.push(format!("{n_holed} boxes have holes, and no budget"));
    }
    Ok((rows, told))
}

/// The boxes, one behind the other, and how many have holes.
fn in_a_row(
    found: &Averaged,
    length: f64,
    side: f64,
) -> Result<(Vec<BoxRow>, usize), PostprocessingError> {
    let (grid, hub) = (found.grid(), found.setting.hub);
    let parts = found.decomposition()?;
    let pressure = found.head.pressure.as_ref();
    let pressure: Option<Vec<f64>> =
        pressure.map(|values| values.iter().copied().map(f64::from).collect());
    let pressure = pressure.as_deref();
    let flow = MeanFlow { grid, mean: &parts.mean, stress: &parts.total, pressure };
    let mut steps = [[0, 0]; 3];
    for axis in 1..3 {
        let step = |way: f64| {
            let away = (hub[axis] + way * 0.5 * side - grid.origin[axis]) / grid.spacing[axis];
            away.round().clamp(0.0, (grid.n_points[axis] - 1) as f64) as usize
        };
        steps[axis] = [step(-1.0), step(1.0)];
    }
    let n_each = ((length / grid.spacing[0]).round() as usize).max(1);
    let (mut rows, mut n_holed) = (Vec::new(), 0);
    for first in (0..grid.n_points[0].saturating_sub(n_each)).step_by(n_each) {
        steps[0] = [first, first + n_each];
        let span = steps[0].map(|step| grid.coordinate(0, step) - hub[0]);
        match budget(&flow, &Region { steps }) {
            Some(budget) => rows.push(BoxRow { span, budget }),
            None => n_holed += 1,
        }
    }
    if rows.is_empty() {
        let fix = "choose a smaller --length or --side, within the field";
        return Err(refused(&found.path, "holds no box without holes", fix));
    }
    Ok((rows, n_holed))
}

/// Name and value of a part.
type Part = (&'static str, fn(&Budget) -> f64);

/// All parts.
const PARTS: [Part; 6] = [
    ("advection", |one| one.advection),
    ("pressure", |one| one.pressure),
    ("flux by stresses", |one| one.turbulent_flux),
    ("through the sides", |one| one.through_sides),
    ("production", |one| one.production),
    ("residual", Budget::residual),
];

/// The parts that `found` knows.
fn parts(found: &Averaged) -> impl Iterator<Item = Part> {
    let has_pressure = found.head.pressure.is_some();
    PARTS.into_iter().filter(move |(name, _)| has_pressure || *name != "pressure")
}

/// By what budgets are divided: U³D² (m⁵/s³).
fn scale(found: &Averaged) -> f64 {
    found.setting.wind_speed.powi(3) * found.setting.diameter.powi(2)
}

fn text(found: &Averaged, rows: &[BoxRow], width: usize) -> String {
    let mut text = format!("{}\n{}\n", conditions(&found.setting), found.samples());
    let headings = parts(found).map(|(name, _)| Column::number(name));
    let headings = headings.chain([Column::number("residual over flux %")]);
    let mut table = TextTable::new([Column::number("x/D")], headings);
    for row in rows {
        let [from, to] = row.span.map(|x| x / found.setting.diameter);
        let parts =
            parts(found).map(|(_, part)| format!("{:.5}", part(&row.budget) / scale(found)));
        let share = 100.0 * row.budget.residual() / row.budget.scale;
        let cells = std::iter::once(format!("{from:.2} to {to:.2}")).chain(parts);
        table.row(cells.chain([format!("{share:.2}")]));
    }
    text += &table.fitted(width);
    text + "in U³D², positive where the box gains mean kinetic energy; through the sides: the part of the flux by stresses that does not cross faces across the wind; flux: sum of the sizes of all fluxes through the six faces\n"
}

fn json(found: &Averaged, rows: &[BoxRow]) -> serde_json::Value {
    let has_pressure = found.head.pressure.is_some();
    let rows = rows.iter().map(|row| {
        let over = |value: f64| value / scale(found);
        json!({
            "from_rotor_m": row.span,
            "advection": over(row.budget.advection),
            "pressure": has_pressure.then(|| over(row.budget.pressure)),
            "flux_by_stresses": over(row.budget.turbulent_flux),
            "through_sides": over(row.budget.through_sides),
            "production": over(row.budget.production),
            "residual": over(row.budget.residual()),
            "scale": over(row.budget.scale),
        })
    });
    json!({
        "setting": setting_json(found),
        "samples": found.samples(),
        "unit": "U³D²",
        "boxes": rows.collect::<Vec<_>>(),
    })
}

fn signals(found: &Averaged, rows: &[BoxRow]) -> Signals {
    // The work of the rotor and of the pressure about it would dwarf what happens in the wake.
    let behind: Vec<&BoxRow> = rows.iter().filter(|row| row.span[0] > 0.0).collect();
    let middle = |row: &&BoxRow| 0.5 * (row.span[0] + row.span[1]) / found.setting.diameter;
    let line = |(colour, (name, part)): (usize, Part)| TrackLine {
        name: name.to_owned(),
        colour: colour + 1,
        times: behind.iter().map(middle).collect(),
        values: behind.iter().map(|row| part(&row.budget) / scale(found)).collect(),
        band: Vec::new(),
    };
    let row = TrackRow {
        label: "gain (U³D²)".to_owned(),
        is_angle: false,
        lines: parts(found).enumerate().map(line).collect(),
    };
    let tracks = TrackFigure {
        along: Along { label: "x/D", unit: "D" },
        name: "budget-over-distance".to_owned(),
        title: "Budget of mean kinetic energy".to_owned(),
        caption: format!(
            "Box by box behind the rotor. {}; {}.",
            conditions(&found.setting),
            found.samples()
        ),
        rows: vec![row],
        mark: None,
    };
    let tracks = if behind.len() > 1 { vec![tracks] } else { Vec::new() };
    Signals { title: "Budget".to_owned(), tracks, ..Signals::default() }
}
