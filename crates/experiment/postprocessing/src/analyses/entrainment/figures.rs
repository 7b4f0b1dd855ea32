//! Figures of the energy that enters a wake: over the plane, and over the distance.

use super::found::{DiscRow, Energy, PARTS, Part, Through};
use crate::wake_fields::{Averaged, axes, conditions, panel};
use analysis::phases::Decomposition;
use analysis::vortices::sine_fit;
use basis::records::{FieldSetting, stress_of};
use report::{
    Along, CurveAt, CurveFigure, CurvePanel, MapColours, MapFigure, Signals, TrackFigure,
    TrackLine, TrackRow,
};

/// In what fluxes are drawn, and its name: of U³ they are thousandths.
const THOUSANDTH: f64 = 1e-3;
pub(crate) const UNIT: &str = "0.001 U³";
/// What figures over the distance run along.
pub(crate) const DISTANCE: Along = Along { label: "x/D", unit: "D" };
/// What figures of available power show.
pub(crate) const POWER: &str = "f_AP (–)";

/// The figures of the fields of `found`, whose parts are `parts`.
pub(super) fn signals(
    found: &Averaged,
    parts: &Decomposition,
    energy: &Energy,
    discs: &[DiscRow],
) -> Signals {
    let caption = format!("{}; {}.", conditions(&found.setting), found.samples());
    let rows = energy.fluxes.iter().map(|one| flux_row(energy, one));
    let line = disc_line(&found.setting, discs, "mean over phases, ± 2σ", 1);
    let disc_row = TrackRow { label: POWER.to_owned(), is_angle: false, lines: vec![line] };
    let tracks = TrackFigure {
        along: DISTANCE,
        name: "entrainment-over-distance".to_owned(),
        title: "Energy that enters the wake".to_owned(),
        caption: format!("Flux through lines or tube, positive into the wake. {caption}"),
        rows: rows.chain((discs.len() > 1).then_some(disc_row)).collect(),
        mark: None,
    };
    let tracks = if tracks.rows.is_empty() { Vec::new() } else { vec![tracks] };
    let maps = vec![flux_map(found, parts)];
    let panels = discs.last().and_then(|disc| phase_panel(&found.setting, disc, String::new()));
    let curves = panels.map(|panel| phase_figure(vec![panel], "", &caption));
    let curves = curves.into_iter().collect();
    Signals { title: "Entrainment".to_owned(), maps, tracks, curves, ..Signals::default() }
}

/// Available power in `disc` over the azimuth of the helix, bin by bin, titled `name` and the distance; none
/// where the helix plays no part.
pub(crate) fn phase_panel(
    setting: &FieldSetting,
    disc: &DiscRow,
    name: String,
) -> Option<CurvePanel> {
    let at = disc.by_phase.iter().filter_map(|one| Some((one.helix?, one.fraction)));
    let (angles, values): (Vec<f64>, Vec<f64>) = at.unzip();
    let fit = sine_fit(&angles, &values, 0.0).ok()?;
    let curve = (0..=360).step_by(5).map(|degrees| {
        let at = f64::from(degrees);
        let mean = fit.mean + fit.amplitude * (at.to_radians() + fit.phase).sin();
        CurveAt { at, mean, band_95: [mean - 2.0 * fit.scatter, mean + 2.0 * fit.scatter] }
    });
    let place = format!("{:.1} D", disc.x / setting.diameter);
    Some(CurvePanel {
        title: [name, place]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join(", "),
        points: angles.iter().zip(&values).map(|(a, v)| [a.to_degrees(), *v]).collect(),
        curve: curve.collect(),
        mark: None,
    })
}

/// The figure of `panels`, of the fields `of`, taken as `samples` tells.
pub(crate) fn phase_figure(panels: Vec<CurvePanel>, of: &str, samples: &str) -> CurveFigure {
    let suffix =
        |between: &str| if of.is_empty() { String::new() } else { format!("{between}{of}") };
    CurveFigure {
        name: format!("available-power-over-helix-azimuth{}", suffix("-")),
        title: format!("Available power by phase of the helix{}", suffix(": ")),
        caption: format!(
            "Each cross is a bin of rotor and helix azimuth at the furthest disc; the line is a sine through them, the band two deviations of what it leaves (bins share instants, so that it is no interval). {samples}"
        ),
        along: "helix azimuth (deg)".to_owned(),
        label: POWER.to_owned(),
        panels,
    }
}

/// All parts of what crosses one line or tube, over the distance.
fn flux_row(energy: &Energy, one: &Through) -> TrackRow {
    let line = |(colour, part): (usize, Part)| flux_line(energy, one, part, (part.0, colour + 1));
    TrackRow {
        label: format!("{} ({UNIT})", one.name),
        is_angle: false,
        lines: PARTS.into_iter().enumerate().map(line).collect(),
    }
}

/// A part of what crosses one line or tube, over the distance, with a `name` and a `colour`.
pub(crate) fn flux_line(
    energy: &Energy,
    one: &Through,
    (_, part): Part,
    (name, colour): (&str, usize),
) -> TrackLine {
    let scale = THOUSANDTH * energy.setting.wind_speed.powi(3);
    TrackLine {
        name: name.to_owned(),
        colour,
        times: one.points.iter().map(|point| energy.distance(point.x)).collect(),
        values: one.points.iter().map(|point| part(point) / scale).collect(),
        band: Vec::new(),
    }
}

/// Available power over the distance, with its spread over the phases.
pub(crate) fn disc_line(
    setting: &FieldSetting,
    discs: &[DiscRow],
    name: &str,
    colour: usize,
) -> TrackLine {
    TrackLine {
        name: name.to_owned(),
        colour,
        times: discs.iter().map(|row| row.x / setting.diameter).collect(),
        values: discs.iter().map(|row| row.mean).collect(),
        band: discs.iter().map(|row| 2.0 * row.deviation).collect(),
    }
}

/// The flux all over the plane, of all, periodic and random fluctuations.
pub(crate) fn flux_map(found: &Averaged, parts: &Decomposition) -> MapFigure {
    let grid = found.grid();
    let axis = if grid.n_points[2] > 1 { 2 } else { 1 };
    let stress = stress_of(0, axis);
    let field = |values: &[f64]| -> Vec<f64> {
        let scale = THOUSANDTH * found.setting.wind_speed.powi(3);
        values.iter().zip(&parts.mean[0]).map(|(s, u)| -s * u / scale).collect()
    };
    let panels = [
        ("all", &parts.total[stress]),
        ("periodic", &parts.periodic[stress]),
        ("random", &parts.random[stress]),
    ];
    MapFigure {
        colours: MapColours::AboutZero,
        is_to_scale: true,
        has_lines: false,
        name: "entrainment-flux".to_owned(),
        title: "Flux of mean kinetic energy".to_owned(),
        caption: format!(
            "−⟨u'{0}'⟩ū: positive towards lower {1}. {2}; {3}.",
            ["u", "v", "w"][axis],
            ["x", "y", "z"][axis],
            conditions(&found.setting),
            found.samples()
        ),
        along: axes(grid),
        unit: UNIT.to_owned(),
        panels: panels
            .iter()
            .filter_map(|(name, v)| panel(grid, &found.setting, *name, &field(v)))
            .collect(),
    }
}
