//! `entrainment`: flux of mean kinetic energy into a wake, and the power that it leaves for a rotor.

use super::phases::setting_json;
use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, BINS, CYCLES, DIAMETER, FIELD, FROM, HUB, LENGTHS, MEMORY, TURBINE, WIDTH,
    WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Averaged, Wanted, axes, conditions, panel};
use analysis::entrainment::{
    Edge, FluxPoint, available_power, flux_along, flux_through_tube, integral, sign_flip, wake_edge,
};
use analysis::grids::widened;
use analysis::phases::Decomposition;
use basis::records::stress_of;
use report::text_table::{Column, TextTable};
use report::{Along, MapFigure, Signals, TrackFigure, TrackLine, TrackRow};
use serde_json::json;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "entrainment",
    about: "Mean kinetic energy that fluctuations carry into a wake, all and random ones, through lines at the rotor's edge or a tube around it, and the fraction of available power over distance with its spread over the phases: figures 7, 10 and 12 of van der Hoek et al. (2024)",
    of: Of::Run("Folder of a run, or a file of fields or of averages by phase"),
    settings: &[
        FIELD, TURBINE, RADIUS, SMOOTHING, BINS, CYCLES, WIDTH, FROM, AZIMUTHS, DIAMETER,
        WIND_SPEED, HUB, LENGTHS, ZEROS, MEMORY, FIGURES,
    ],
    run,
};

const RADIUS: AnalysisSetting = settings::setting(
    "radius",
    "D",
    Takes::Number,
    "Distance of lines and tube from the hub (rotor diameters); 0.5 when left out",
);
const SMOOTHING: AnalysisSetting = settings::setting(
    "smoothing",
    "D",
    Takes::Number,
    "Length over which the flux is smoothed before its change of sign is looked for (rotor diameters); 0.25 when left out",
);
/// Share of the free stream at which a wake ends (–).
const EDGE: f64 = 0.95;

/// In what fluxes are drawn, and its name: of U³ they are thousandths.
const THOUSANDTH: f64 = 1e-3;
const UNIT: &str = "0.001 U³";

/// Name and value of a part of the flux.
type Part = (&'static str, fn(&FluxPoint) -> f64);

/// What crosses one line, or a tube.
struct Through {
    name: &'static str,
    points: Vec<FluxPoint>,
}

/// Power in a disc at one distance.
#[derive(Clone, Copy, Debug, PartialEq)]
struct DiscRow {
    /// Distance from the rotor (m).
    x: f64,
    /// Mean over the bins (–).
    mean: f64,
    /// Standard deviation over the bins (–).
    deviation: f64,
    /// Least and greatest (–).
    range: [f64; 2],
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let found = Averaged::of(request, Wanted::Bins)?;
    let parts = found.decomposition()?;
    let radius = settings::positive(request, &RADIUS, 0.5)? * found.setting.diameter;
    let smoothing = settings::positive(request, &SMOOTHING, 0.25)? * found.setting.diameter;
    let fluxes = fluxes(&found, &parts, radius);
    let (discs, why) = discs(&found)?;
    let mut remarks = found.remarks.clone();
    remarks.extend(why);
    if fluxes.is_empty() {
        remarks.push("no line along the wind at the rotor's edge lies on the field".to_owned());
    }
    remarks.extend(drawn(request, &[signals(&found, &parts, &fluxes, &discs)])?);
    let text = text(&found, &fluxes, &discs, smoothing, request.width());
    Ok(Answer { text, json: json(&found, &parts, &fluxes, &discs, smoothing), remarks })
}

/// What crosses the lines at the rotor's edge, or the tube around it, wherever the grid has them.
fn fluxes(found: &Averaged, parts: &Decomposition, radius: f64) -> Vec<Through> {
    let (grid, hub) = (found.grid(), found.setting.hub);
    if grid.n_points[0] < 2 {
        return Vec::new();
    }
    let tube = flux_through_tube(parts, grid, [hub[1], hub[2]], radius);
    if grid.n_points[1] > 1 && grid.n_points[2] > 1 && !tube.is_empty() {
        return vec![Through { name: "tube", points: tube }];
    }
    let lines = [("upper", 2, 1.0), ("lower", 2, -1.0), ("left", 1, 1.0), ("right", 1, -1.0)];
    let through = |(name, axis, side): (&'static str, usize, f64)| {
        let mut place = [hub[1], hub[2]];
        place[axis - 1] += side * radius;
        let edge = Edge { axis, place, inward: -side };
        let has_axis = grid.n_points[axis] > 1;
        let points = if has_axis { flux_along(parts, grid, &edge) } else { Vec::new() };
        Through { name, points }
    };
    lines.into_iter().map(through).filter(|one| one.points.len() > 1).collect()
}

/// The fraction of available power at each x, bin by bin; and why there is none.
fn discs(found: &Averaged) -> Result<(Vec<DiscRow>, Option<String>), PostprocessingError> {
    let (grid, setting) = (found.grid(), &found.setting);
    let (hub, radius) = (setting.hub, 0.5 * setting.diameter);
    let n_x = grid.n_points[0];
    let mut sums = vec![[0.0, 0.0, f64::INFINITY, f64::NEG_INFINITY, 0.0]; n_x];
    let mut why = None;
    for index in 0..found.head.bins.len() {
        if found.head.bins[index].n_instants == 0 {
            continue;
        }
        let u = widened(&found.bin(index)?.mean[0]);
        for (step, sum) in sums.iter_mut().enumerate() {
            let x = grid.coordinate(0, step);
            match available_power(grid, &u, (x, [hub[1], hub[2]]), radius, setting.wind_speed) {
                Ok(one) => {
                    sum[0] += one.fraction;
                    sum[1] += one.fraction.powi(2);
                    sum[2] = sum[2].min(one.fraction);
                    sum[3] = sum[3].max(one.fraction);
                    sum[4] += 1.0;
                }
                Err(error) => why = Some(format!("available power: {error}")),
            }
        }
    }
    let row = |(step, [sum, squares, low, high, n]): (usize, &[f64; 5])| {
        let mean = sum / n;
        (*n > 0.0).then(|| DiscRow {
            x: grid.coordinate(0, step) - hub[0],
            mean,
            deviation: (squares / n - mean * mean).max(0.0).sqrt(),
            range: [*low, *high],
        })
    };
    Ok((sums.iter().enumerate().filter_map(row).collect(), why))
}

fn text(
    found: &Averaged,
    fluxes: &[Through],
    discs: &[DiscRow],
    smoothing: f64,
    width: usize,
) -> String {
    let setting = &found.setting;
    let mut text = format!("{}\n{}\n", conditions(setting), found.samples());
    let headings =
        ["from D", "to D", "all", "periodic", "random", "turns at D"].map(Column::number);
    let mut table = TextTable::new([Column::words("through")], headings);
    for one in fluxes {
        let [all, periodic, random] = integrals(found, &one.points);
        let distance = |x: f64| (x - setting.hub[0]) / setting.diameter;
        let [first, last] = [one.points[0].x, one.points[one.points.len() - 1].x].map(distance);
        let flip = sign_flip(&one.points, smoothing).map(distance);
        table.row([
            one.name.to_owned(),
            format!("{first:.2}"),
            format!("{last:.2}"),
            format!("{all:.5}"),
            format!("{periodic:.5}"),
            format!("{random:.5}"),
            flip.map_or("–".to_owned(), |place| format!("{place:.2}")),
        ]);
    }
    if !fluxes.is_empty() {
        text += &table.fitted(width);
        text += "flux of mean kinetic energy into the wake, its integral over the distance in U³D; positive is recovery; turns: where the smoothed flux of all changes from leaving to entering\n";
    }
    if !discs.is_empty() {
        let headings = ["f_AP", "± 2σ of phases", "least", "greatest"].map(Column::number);
        let mut table = TextTable::new([Column::number("x/D")], headings);
        let stride = discs.len().div_ceil(16).max(1);
        for row in discs.iter().step_by(stride) {
            table.row([
                format!("{:.2}", row.x / setting.diameter),
                format!("{:.4}", row.mean),
                format!("{:.4}", 2.0 * row.deviation),
                format!("{:.4}", row.range[0]),
                format!("{:.4}", row.range[1]),
            ]);
        }
        text += &table.fitted(width);
        text += "f_AP: mean of (u/U)³ over the disc, of the velocity of each bin\n";
    }
    text
}

/// Integrals of all, periodic and random flux over the distance (U³D).
fn integrals(found: &Averaged, points: &[FluxPoint]) -> [f64; 3] {
    let scale = found.setting.wind_speed.powi(3) * found.setting.diameter;
    let of = |part: fn(&FluxPoint) -> f64| integral(points, part) / scale;
    [of(|one| one.total), of(|one| one.periodic), of(|one| one.random)]
}

fn json(
    found: &Averaged,
    parts: &Decomposition,
    fluxes: &[Through],
    discs: &[DiscRow],
    smoothing: f64,
) -> serde_json::Value {
    let setting = &found.setting;
    let cube = setting.wind_speed.powi(3);
    let fluxes = fluxes.iter().map(|one| {
        let [all, periodic, random] = integrals(found, &one.points);
        let over = |part: fn(&FluxPoint) -> f64| -> Vec<f64> {
            one.points.iter().map(|point| part(point) / cube).collect()
        };
        json!({
            "through": one.name,
            "x_m": one.points.iter().map(|point| point.x).collect::<Vec<_>>(),
            "all_over_u3": over(|point| point.total),
            "periodic_over_u3": over(|point| point.periodic),
            "random_over_u3": over(|point| point.random),
            "integral_over_u3d": { "all": all, "periodic": periodic, "random": random },
            "turns_at_m": sign_flip(&one.points, smoothing),
        })
    });
    let discs = discs.iter().map(|row| {
        json!({
            "from_rotor_m": row.x,
            "f_ap": row.mean,
            "deviation_over_phases": row.deviation,
            "least": row.range[0],
            "greatest": row.range[1],
        })
    });
    json!({
        "setting": setting_json(found),
        "samples": found.samples(),
        "fluxes": fluxes.collect::<Vec<_>>(),
        "available_power": discs.collect::<Vec<_>>(),
        "edges": edges(found, parts),
    })
}

/// Where the wake ends to each side, over the distance.
fn edges(found: &Averaged, parts: &Decomposition) -> serde_json::Value {
    let (grid, setting) = (found.grid(), &found.setting);
    let sides = [("upper", 2, 1.0), ("lower", 2, -1.0), ("left", 1, 1.0), ("right", 1, -1.0)];
    let side = |(name, axis, way): (&str, usize, f64)| {
        let at = |step: usize| {
            let x = grid.coordinate(0, step);
            let place = [setting.hub[1], setting.hub[2]];
            let threshold = EDGE * setting.wind_speed;
            wake_edge(grid, &parts.mean[0], (x, place), (axis, way), threshold)
        };
        let all: Vec<Option<f64>> = (0..grid.n_points[0]).map(at).collect();
        json!({ "side": name, "at_share_of_free_stream": EDGE, "from_hub_m": all })
    };
    let seen = sides.into_iter().filter(|(_, axis, _)| grid.n_points[*axis] > 1);
    seen.map(side).collect()
}

fn signals(
    found: &Averaged,
    parts: &Decomposition,
    fluxes: &[Through],
    discs: &[DiscRow],
) -> Signals {
    let caption = format!("{}; {}.", conditions(&found.setting), found.samples());
    let rows: Vec<TrackRow> =
        fluxes.iter().map(|one| flux_row(found, one)).chain(disc_row(found, discs)).collect();
    let tracks = TrackFigure {
        along: Along { label: "x/D", unit: "D" },
        name: "entrainment-over-distance".to_owned(),
        title: "Energy that enters the wake".to_owned(),
        caption: format!("Flux through lines or tube, positive into the wake. {caption}"),
        rows,
        mark: None,
    };
    let tracks = if tracks.rows.is_empty() { Vec::new() } else { vec![tracks] };
    let maps = vec![flux_map(found, parts, &caption)];
    Signals { title: "Entrainment".to_owned(), maps, tracks, ..Signals::default() }
}

/// What crosses one line or tube, over the distance.
fn flux_row(found: &Averaged, one: &Through) -> TrackRow {
    let scale = THOUSANDTH * found.setting.wind_speed.powi(3);
    let line = |(colour, (name, part)): (usize, Part)| TrackLine {
        name: name.to_owned(),
        colour: colour + 1,
        times: distances(found, one.points.iter().map(|point| point.x - found.setting.hub[0])),
        values: one.points.iter().map(|point| part(point) / scale).collect(),
        band: Vec::new(),
    };
    let kinds: [Part; 3] =
        [("all", |p| p.total), ("periodic", |p| p.periodic), ("random", |p| p.random)];
    TrackRow {
        label: format!("{} ({UNIT})", one.name),
        is_angle: false,
        lines: kinds.into_iter().enumerate().map(line).collect(),
    }
}

/// Available power over the distance; none where there are fewer than two discs.
fn disc_row(found: &Averaged, discs: &[DiscRow]) -> Option<TrackRow> {
    let line = TrackLine {
        name: "mean over phases, ± 2σ".to_owned(),
        colour: 1,
        times: distances(found, discs.iter().map(|row| row.x)),
        values: discs.iter().map(|row| row.mean).collect(),
        band: discs.iter().map(|row| 2.0 * row.deviation).collect(),
    };
    let row = TrackRow { label: "f_AP (–)".to_owned(), is_angle: false, lines: vec![line] };
    (discs.len() > 1).then_some(row)
}

/// The flux all over the plane, of all and of random fluctuations.
fn flux_map(found: &Averaged, parts: &Decomposition, caption: &str) -> MapFigure {
    let grid = found.grid();
    let axis = if grid.n_points[2] > 1 { 2 } else { 1 };
    let stress = stress_of(0, axis);
    let field = |values: &[f64]| -> Vec<f64> {
        let scale = THOUSANDTH * found.setting.wind_speed.powi(3);
        values.iter().zip(&parts.mean[0]).map(|(s, u)| -s * u / scale).collect()
    };
    let panels = [("all", &parts.total[stress]), ("random", &parts.random[stress])];
    MapFigure {
        has_lines: false,
        name: "entrainment-flux".to_owned(),
        title: "Flux of mean kinetic energy".to_owned(),
        caption: format!(
            "−⟨u'{0}'⟩ū: positive towards lower {1}. {caption}",
            ["u", "v", "w"][axis],
            ["x", "y", "z"][axis]
        ),
        along: axes(grid),
        unit: UNIT.to_owned(),
        panels: panels
            .iter()
            .filter_map(|(name, v)| panel(grid, &found.setting, *name, &field(v)))
            .collect(),
    }
}

fn distances(found: &Averaged, places: impl Iterator<Item = f64>) -> Vec<f64> {
    places.map(|x| x / found.setting.diameter).collect()
}
