//! What was found of vortices in words and in numbers.

use super::Found;
use super::following::{Fitted, Passed, tips};
use crate::analyses::phases::setting_json;
use crate::wake_fields::conditions;
use analysis::vortices::{Track, Vortex};
use report::text_table::{Column, TextTable};
use serde_json::json;

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

pub(super) fn text(found: &Found, width: usize) -> String {
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
        text += &breakdown_text(found);
    }
    if !found.is_along() {
        text += &hub_text(found);
    }
    text += &leapfrog_text(found);
    text + "leapfrog: where a vortex first gets as far downwind as the one before it; core: radius of the greatest speed\n"
}

/// Where the pair that counts leapfrogs, in words.
fn leapfrog_text(found: &Found) -> String {
    let setting = &found.averaged.setting;
    let mut text = String::new();
    let spread = |passed: &[&Passed]| {
        let n = passed.len() as f64;
        let places =
            || passed.iter().map(|passed| (passed.one.place - setting.hub[0]) / setting.diameter);
        let mean = places().sum::<f64>() / n;
        let deviation = (places().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
        format!("{mean:.3} ± {deviation:.3} D (standard deviation)")
    };
    let counted: Vec<&Passed> = found.counted().collect();
    if !counted.is_empty() {
        text += &format!("{} leapfrogs, at {}\n", counted.len(), spread(&counted));
    }
    let later: Vec<&Passed> = found.later.iter().filter(|one| one.pair == found.pair).collect();
    if !later.is_empty() {
        let n = later.len();
        text += &format!(
            "{n} times the vortex after next passes the first of the pair too, at {}\n",
            spread(&later)
        );
    }
    for Fitted { side, sine: fit, .. } in found.sines() {
        let [mean, amplitude, phase] = fit.half_widths;
        text += &format!(
            "{side} the hub over the azimuth φ of the helix: {:.3} ± {:.3} D + {:.3} ± {:.3} D sin(φ + {:.0} ± {:.0}°), 95 %; none over {:.0}° of φ\n",
            fit.mean / setting.diameter,
            mean / setting.diameter,
            fit.amplitude / setting.diameter,
            amplitude / setting.diameter,
            fit.phase.to_degrees(),
            phase.to_degrees(),
            fit.largest_gap.to_degrees()
        );
    }
    text
}

/// How far tip vortices are followed, and where they have lost half of their strength, in words.
fn breakdown_text(found: &Found) -> String {
    let setting = &found.averaged.setting;
    let tips: Vec<Track> = tips(found).into_iter().filter(|track| track.is_born).collect();
    let spread = |places: &[f64]| {
        let n = places.len() as f64;
        let over = || places.iter().map(|x| (x - setting.hub[0]) / setting.diameter);
        let mean = over().sum::<f64>() / n;
        let deviation = (over().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
        format!("{mean:.3} ± {deviation:.3} D")
    };
    let ends: Vec<f64> = tips
        .iter()
        .filter_map(|track| track.sightings.last())
        .map(|last| last.vortex.position[0])
        .collect();
    if ends.is_empty() {
        return String::new();
    }
    let halves: Vec<f64> = tips.iter().filter_map(Track::half_strength_at).collect();
    let half = match halves.len() {
        0 => "none of them loses half of its vorticity before that".to_owned(),
        n => format!("{n} of them have half of their first vorticity left at {}", spread(&halves)),
    };
    let (n, end) = (ends.len(), spread(&ends));
    format!("{n} tip vortices are followed from the rotor to {end}; {half} (standard deviations)\n")
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

pub(super) fn json(found: &Found) -> serde_json::Value {
    let vortex = |vortex: &Vortex| {
        json!({
            "position_m": vortex.position,
            "circulation_m2_s": vortex.circulation,
            "core_radius_m": vortex.core_radius,
            "peak_vorticity_1_s": vortex.peak_vorticity(),
            "misfit": vortex.misfit,
            "gamma_1": vortex.turning.map(|[first, _]| first),
            "gamma_2": vortex.turning.map(|[_, second]| second),
        })
    };
    let tracks = found.tracks.iter().filter(|track| track.sightings.len() > 2).map(|track| {
        let sightings = track.sightings.iter().map(|one| {
            json!({ "bin": one.step % found.frames.len(), "step": one.step, "vortex": vortex(&one.vortex) })
        });
        let blade = found.blades.iter().find(|(id, _)| *id == track.id).map(|(_, blade)| blade + 1);
        json!({
            "id": track.id,
            "born": track.is_born,
            "blade": blade,
            "half_strength_x_m": track.half_strength_at(),
            "sightings": sightings.collect::<Vec<_>>(),
        })
    });
    let passed = |Passed { pair, side, azimuth, one }: &Passed| {
        json!({
            "pair": pair,
            "side": side,
            "tracks": one.ids,
            "x_m": one.place,
            "step": one.step,
            "helix_azimuth_deg": azimuth.map(f64::to_degrees),
        })
    };
    let fits = found.fits.iter().map(|Fitted { pair, side, sine: fit }| {
        json!({
            "pair": pair,
            "side": side,
            "mean_m": fit.mean,
            "amplitude_m": fit.amplitude,
            "phase_deg": fit.phase.to_degrees(),
            "half_widths_95": [fit.half_widths[0], fit.half_widths[1], fit.half_widths[2].to_degrees()],
            "n": fit.n,
            "largest_gap_deg": fit.largest_gap.to_degrees(),
        })
    });
    let hub = if found.is_along() { Vec::new() } else { hub_vortices(found) };
    json!({
        "setting": setting_json(&found.averaged),
        "samples": found.averaged.samples(),
        "least_vorticity_1_s": found.least,
        "peaks_without_a_vortex": found.n_lost,
        "tracks": tracks.collect::<Vec<_>>(),
        "leapfrogs": found.leapfrogs.iter().map(passed).collect::<Vec<_>>(),
        "leapfrogs_of_the_vortex_after_next": found.later.iter().map(passed).collect::<Vec<_>>(),
        "leapfrog_sines": fits.collect::<Vec<_>>(),
        "hub_vortex": hub.iter().map(|one| one.as_ref().map(vortex)).collect::<Vec<_>>(),
    })
}
