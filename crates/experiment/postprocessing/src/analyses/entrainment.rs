//! `entrainment`: flux of mean kinetic energy into a wake, and the power that it leaves for a rotor.

pub(crate) mod figures;
pub(crate) mod found;

use super::phases::setting_json;
use super::{Analysis, Answer, FIGURES, Of, Request, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    AZIMUTHS, BINS, CYCLES, DIAMETER, FIELD, FROM, HUB, LENGTHS, MEMORY, TURBINE, WIDTH,
    WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Averaged, Wanted, conditions};
use analysis::entrainment::{FluxPoint, wake_edge};
use analysis::phases::Decomposition;
use found::{AtPhase, DiscRow, Energy, RADIUS, SMOOTHING, discs};
use report::text_table::{Column, TextTable};
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

/// Share of the free stream at which a wake ends (–).
const EDGE: f64 = 0.95;

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let found = Averaged::of(request, Wanted::Bins)?;
    let parts = found.decomposition()?;
    let energy = Energy::of(request, &found, &parts)?;
    let (discs, why) = discs(&found)?;
    let mut remarks = found.remarks.clone();
    remarks.extend(why);
    if energy.fluxes.is_empty() {
        remarks.push("no line along the wind at the rotor's edge lies on the field".to_owned());
    }
    remarks.extend(drawn(request, &[figures::signals(&found, &parts, &energy, &discs)])?);
    let text = text(&energy, &discs, request.width());
    Ok(Answer { text, json: json(&found, &parts, &energy, &discs), remarks })
}

fn text(energy: &Energy, discs: &[DiscRow], width: usize) -> String {
    let setting = &energy.setting;
    let mut text = format!("{}\n{}\n", conditions(setting), energy.samples);
    let headings =
        ["from D", "to D", "all", "periodic", "random", "turns at D"].map(Column::number);
    let mut table = TextTable::new([Column::words("through")], headings);
    for one in &energy.fluxes {
        let [all, periodic, random] = energy.integrals(one);
        let [first, last] = [0, one.points.len() - 1].map(|i| energy.distance(one.points[i].x));
        let flip = energy.turns_at(one).map(|x| energy.distance(x));
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
    if !energy.fluxes.is_empty() {
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

fn json(
    found: &Averaged,
    parts: &Decomposition,
    energy: &Energy,
    discs: &[DiscRow],
) -> serde_json::Value {
    let cube = energy.setting.wind_speed.powi(3);
    let fluxes = energy.fluxes.iter().map(|one| {
        let [all, periodic, random] = energy.integrals(one);
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
            "turns_at_m": energy.turns_at(one),
        })
    });
    let discs = discs.iter().map(|row| {
        json!({
            "from_rotor_m": row.x,
            "f_ap": row.mean,
            "deviation_over_phases": row.deviation,
            "least": row.range[0],
            "greatest": row.range[1],
            "by_phase": row.by_phase.iter().map(by_phase).collect::<Vec<_>>(),
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

fn by_phase(at: &AtPhase) -> serde_json::Value {
    json!({
        "rotor_azimuth_deg": at.rotor.to_degrees(),
        "helix_azimuth_deg": at.helix.map(f64::to_degrees),
        "f_ap": at.fraction,
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
