//! `vortices`: tip vortices from phase to phase, where they leapfrog, and the hub vortex.

mod figures;

use super::phases::setting_json;
use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, BINS, CYCLES, DIAMETER, FIELD, FROM, HUB, LENGTHS, ROTOR_HZ, TURBINE, WIDTH,
    WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Averaged, conditions, refused};
use analysis::grids::widened;
use analysis::vortices::{
    Leapfrog, Pairs, Search, Section, SineFit, Track, Tracking, Vortex, follow, leapfrogs,
    sine_fit, vortices,
};
use basis::angle::wrap_to_turn;
use report::text_table::{Column, TextTable};
use serde_json::json;
use std::f64::consts::TAU;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "vortices",
    about: "Vortices in a plane averaged by phase: places, circulations and cores by a fit, followed from phase to phase, where one passes the one before it over the phase of the helix, and the hub vortex in a plane across the wind: figures 13 to 15 of van der Hoek et al. (2024)",
    of: Of::Run("Folder of a run, or a file of fields or of averages by phase, of a plane"),
    settings: &[
        FIELD, TURBINE, LEAST, BLADES, PAIR, ROTOR_HZ, BINS, CYCLES, WIDTH, FROM, AZIMUTHS,
        DIAMETER, WIND_SPEED, HUB, LENGTHS, ZEROS, FIGURES,
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
    "Which of the pairs of a revolution counts, from 1, with --blades; 1 when left out",
);
/// Nearest that two vortices of one sense may be, and how far one may be from where it is expected (rotor
/// diameters).
const SEPARATION: f64 = 0.06;
const GATE: f64 = 0.08;
/// Length in which vortices are taken as new (rotor diameters).
const BIRTH: f64 = 0.15;
/// Greatest misfit of a vortex (–).
const MOST_MISFIT: f64 = 0.5;
/// Revolutions for which a vortex is followed at least (–).
const REVOLUTIONS: f64 = 8.0;

/// What was found in all bins.
struct Found {
    averaged: Averaged,
    frames: Vec<Vec<Vortex>>,
    n_lost: usize,
    least: f64,
    tracks: Vec<Track>,
    leapfrogs: Vec<(f64, Leapfrog)>,
    fit: Option<SineFit>,
}

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let averaged = Averaged::of(request)?;
    if averaged.grid().spanned().len() != 2 {
        let fix = "name a plane with --field, such as streamwise";
        return Err(refused(&averaged.path, "spans no plane, in which vortices are sought", fix));
    }
    let least = least(request, &averaged)?;
    let mut found = Found {
        frames: Vec::new(),
        n_lost: 0,
        least,
        tracks: Vec::new(),
        leapfrogs: Vec::new(),
        fit: None,
        averaged,
    };
    for index in 0..found.averaged.head.bins.len() {
        let section = section(&found.averaged, index)?;
        let (vortices, n_lost) = vortices(&section, &search(&found.averaged, least));
        found.frames.push(vortices);
        found.n_lost += n_lost;
    }
    let mut remarks = found.averaged.remarks.clone();
    if is_along(&found.averaged) {
        match rotor_frequency(request, &found.averaged) {
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
    remarks.extend(drawn(request, &[figures::signals(&found)?])?);
    Ok(Answer { text: text(&found, request.width()), json: json(&found), remarks })
}

/// Whether the plane lies along the wind.
fn is_along(averaged: &Averaged) -> bool {
    averaged.grid().n_points[0] > 1
}

fn section(averaged: &Averaged, index: usize) -> Result<Section, PostprocessingError> {
    let mean = averaged.bin(index)?.mean;
    let velocity = mean.each_ref().map(|values| widened(values));
    Section::of(averaged.grid(), &velocity).ok_or_else(|| {
        refused(&averaged.path, "spans no plane", "name a plane with --field, such as streamwise")
    })
}

/// Least vorticity of a peak (1/s).
fn least(request: &Request, averaged: &Averaged) -> Result<f64, PostprocessingError> {
    let setting = &averaged.setting;
    let unit = setting.wind_speed / setting.diameter;
    if request.number(LEAST.name).is_some() {
        return Ok(settings::positive(request, &LEAST, 1.0)? * unit);
    }
    let mut greatest = 0.0_f64;
    let area = search(averaged, 0.0).within;
    for index in 0..averaged.head.bins.len() {
        let section = section(averaged, index)?;
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

/// Where vortices are sought: along the wind beyond the rotor, across it about the hub.
fn search(averaged: &Averaged, least_vorticity: f64) -> Search {
    let (grid, setting) = (averaged.grid(), &averaged.setting);
    let spanned = grid.spanned();
    let range = |axis: usize| {
        let last = grid.coordinate(axis, grid.n_points[axis] - 1);
        match axis {
            0 => [grid.origin[0].max(setting.hub[0] + 0.1 * setting.diameter), last],
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

fn rotor_frequency(request: &Request, averaged: &Averaged) -> Option<f64> {
    let told = request.number(ROTOR_HZ.name).filter(|frequency| *frequency > 0.0);
    told.or(averaged.rates.map(|(rotor, _)| rotor))
}

fn follow_all(
    request: &Request,
    found: &mut Found,
    frequency: f64,
) -> Result<(), PostprocessingError> {
    let (grid, setting) = (*found.averaged.grid(), found.averaged.setting.clone());
    let in_turn = TAU / found.averaged.head.rotor_width;
    let start = search(&found.averaged, found.least).within[0][0];
    let rounds = (REVOLUTIONS * in_turn / found.frames.len() as f64).ceil() as usize + 1;
    let tracking = Tracking {
        interval: 1.0 / (frequency * in_turn),
        gate: GATE * setting.diameter,
        n_rounds: if found.frames.len() > 1 { rounds } else { 1 },
        birth: start + BIRTH * setting.diameter + grid.spacing[0],
        most_missed: 1,
    };
    found.tracks = follow(&found.frames, &tracking);
    let pairs = match request.number(BLADES.name) {
        None => Pairs::All,
        Some(_) => {
            let n_blades = settings::whole(request, &BLADES, 1, 3)?;
            let pair = settings::whole(request, &PAIR, 1, 1)?;
            Pairs::OfBlades { n_blades, first: (pair - 1) % n_blades }
        }
    };
    let n = found.frames.len();
    for leapfrog in leapfrogs(&found.tracks, pairs) {
        let bin = &found.averaged.head.bins[leapfrog.step as usize % n];
        // The helix goes on between bins, by as much as from this one to the next.
        let next = &found.averaged.head.bins[(leapfrog.step as usize + 1) % n];
        let azimuth = bin.helix.zip(next.helix).map_or(bin.rotor, |(a, b)| {
            a + leapfrog.step.fract() * basis::angle::wrap_to_half_turn(b - a)
        });
        found.leapfrogs.push((wrap_to_turn(azimuth), leapfrog));
    }
    let (angles, places): (Vec<f64>, Vec<f64>) =
        found.leapfrogs.iter().map(|(angle, one)| (*angle, one.place - setting.hub[0])).unzip();
    // Too few, or all at one azimuth: no sine.
    found.fit = sine_fit(&angles, &places).ok();
    Ok(())
}

/// Means over the sightings of a track: circulation over UD, core over D.
fn means(track: &Track, found: &Found) -> [f64; 2] {
    let setting = &found.averaged.setting;
    let n = track.sightings.len() as f64;
    let mean =
        |of: fn(&Vortex) -> f64| track.sightings.iter().map(|s| of(&s.vortex)).sum::<f64>() / n;
    [
        mean(|vortex| vortex.circulation) / (setting.wind_speed * setting.diameter),
        mean(|vortex| vortex.core_radius) / setting.diameter,
    ]
}

/// Tracks that are worth a line: seen in three frames at least, the longest first.
fn worth(found: &Found) -> Vec<&Track> {
    let mut tracks: Vec<&Track> =
        found.tracks.iter().filter(|track| track.sightings.len() > 2).collect();
    tracks.sort_by_key(|track| (std::cmp::Reverse(track.sightings.len()), track.id));
    tracks
}

fn text(found: &Found, width: usize) -> String {
    let setting = &found.averaged.setting;
    let over = |x: f64| (x - setting.hub[0]) / setting.diameter;
    let mut text = format!("{}\n{}\n", conditions(setting), found.averaged.samples());
    let n_vortices: usize = found.frames.iter().map(Vec::len).sum();
    text += &format!(
        "{n_vortices} vortices of {:.1} U/D at least in {} bins\n",
        found.least * setting.diameter / setting.wind_speed,
        found.frames.len()
    );
    let headings = ["from x/D", "to x/D", "bins", "circulation UD", "core D"].map(Column::number);
    let mut table = TextTable::new([Column::number("track")], headings);
    for track in worth(found).into_iter().take(16) {
        let [circulation, core] = means(track, found);
        let ends = [0, track.sightings.len() - 1].map(|i| track.sightings[i].vortex.position[0]);
        table.row([
            track.id.to_string(),
            format!("{:.3}", over(ends[0])),
            format!("{:.3}", over(ends[1])),
            track.sightings.len().to_string(),
            format!("{circulation:.4}"),
            format!("{core:.4}"),
        ]);
    }
    if !found.tracks.is_empty() {
        text += &table.fitted(width);
    }
    if !is_along(&found.averaged) {
        text += &hub_text(found);
    }
    if !found.leapfrogs.is_empty() {
        let n = found.leapfrogs.len() as f64;
        let mean = found.leapfrogs.iter().map(|(_, one)| over(one.place)).sum::<f64>() / n;
        text += &format!("{n} leapfrogs, at {mean:.3} D on the average\n");
    }
    if let Some(fit) = &found.fit {
        let [mean, amplitude, phase] = fit.half_widths;
        text += &format!(
            "over the azimuth φ of the helix: {:.3} ± {:.3} D + {:.3} ± {:.3} D sin(φ + {:.0} ± {:.0}°), 95 %\n",
            fit.mean / setting.diameter,
            mean / setting.diameter,
            fit.amplitude / setting.diameter,
            amplitude / setting.diameter,
            fit.phase.to_degrees(),
            phase.to_degrees()
        );
    }
    text + "leapfrog: where a vortex first gets as far downwind as the one before it; core: radius of the greatest speed\n"
}

/// The hub vortex of each bin: the strongest within a quarter of a diameter of the hub.
fn hub_vortices(found: &Found) -> Vec<Option<Vortex>> {
    let setting = &found.averaged.setting;
    let nearest = |frame: &Vec<Vortex>| {
        let near = frame.iter().filter(|vortex| {
            let [y, z] = vortex.position;
            (y - setting.hub[1]).hypot(z - setting.hub[2]) < 0.25 * setting.diameter
        });
        near.max_by(|a, b| a.circulation.abs().total_cmp(&b.circulation.abs())).copied()
    };
    found.frames.iter().map(nearest).collect()
}

fn hub_text(found: &Found) -> String {
    let setting = &found.averaged.setting;
    let seen: Vec<Vortex> = hub_vortices(found).into_iter().flatten().collect();
    if seen.is_empty() {
        return "no hub vortex within 0.25 D of the hub\n".to_owned();
    }
    let n = seen.len() as f64;
    let mean = |of: &dyn Fn(&Vortex) -> f64| seen.iter().map(of).sum::<f64>() / n;
    let [y, z] = [0, 1].map(|axis| mean(&|vortex| vortex.position[axis]));
    let orbit = mean(&|v| (v.position[0] - y).powi(2) + (v.position[1] - z).powi(2)).sqrt();
    format!(
        "hub vortex in {} of {} bins: {:.3} D left and {:.3} D above the hub, {:.3} D about that (root mean square), circulation {:.4} UD\n",
        seen.len(),
        found.frames.len(),
        (y - setting.hub[1]) / setting.diameter,
        (z - setting.hub[2]) / setting.diameter,
        orbit / setting.diameter,
        mean(&|vortex| vortex.circulation) / (setting.wind_speed * setting.diameter)
    )
}

fn json(found: &Found) -> serde_json::Value {
    let vortex = |vortex: &Vortex| {
        json!({
            "position_m": vortex.position,
            "circulation_m2_s": vortex.circulation,
            "core_radius_m": vortex.core_radius,
            "misfit": vortex.misfit,
        })
    };
    let tracks = found.tracks.iter().filter(|track| track.sightings.len() > 2).map(|track| {
        let sightings = track.sightings.iter().map(|one| {
            json!({ "bin": one.step % found.frames.len(), "step": one.step, "vortex": vortex(&one.vortex) })
        });
        json!({ "id": track.id, "born": track.is_born, "sightings": sightings.collect::<Vec<_>>() })
    });
    let leapfrogs = found.leapfrogs.iter().map(|(azimuth, one)| {
        json!({
            "tracks": one.ids,
            "x_m": one.place,
            "step": one.step,
            "helix_azimuth_deg": azimuth.to_degrees(),
        })
    });
    let fit = found.fit.map(|fit| {
        json!({
            "mean_m": fit.mean,
            "amplitude_m": fit.amplitude,
            "phase_deg": fit.phase.to_degrees(),
            "half_widths_95": [fit.half_widths[0], fit.half_widths[1], fit.half_widths[2].to_degrees()],
            "n": fit.n,
        })
    });
    let hub = if is_along(&found.averaged) { Vec::new() } else { hub_vortices(found) };
    json!({
        "setting": setting_json(&found.averaged),
        "samples": found.averaged.samples(),
        "least_vorticity_1_s": found.least,
        "peaks_without_a_vortex": found.n_lost,
        "tracks": tracks.collect::<Vec<_>>(),
        "leapfrogs": leapfrogs.collect::<Vec<_>>(),
        "leapfrog_sine": fit,
        "hub_vortex": hub.iter().map(|one| one.as_ref().map(vortex)).collect::<Vec<_>>(),
    })
}
