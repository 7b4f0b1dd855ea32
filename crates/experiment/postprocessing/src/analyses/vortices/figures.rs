//! Figures of vortices: where they are phase by phase, and where they leapfrog.

use super::{Fitted, Found, Passed};
use crate::PostprocessingError;
use crate::wake_fields::{axes, by_phase, conditions, panel};
use analysis::vortices::{SineFit, Track, Vortex, cubic_fit};
use basis::records::Moments;
use report::{CurveAt, CurveFigure, CurvePanel, MapColours, MapFigure, Signals};

/// The figures of what was `found`.
pub(super) fn signals(found: &Found) -> Result<Signals, PostprocessingError> {
    let (averaged, setting) = (&found.averaged, &found.averaged.setting);
    let n = found.frames.len();
    let mut panels = Vec::new();
    for index in (0..n).step_by(n.div_ceil(3).max(1)) {
        let scale = setting.diameter / setting.wind_speed;
        let vorticity: Vec<f64> =
            found.section(index)?.vorticity().iter().map(|value| value * scale).collect();
        let title = averaged.name_of_bin(index);
        let Some(mut panel) = panel(&found.cut.grid, setting, title, &vorticity) else { continue };
        panel.points = marks(found, index);
        panels.push(panel);
    }
    let map = MapFigure {
        colours: MapColours::AboutZero,
        is_to_scale: true,
        has_lines: false,
        name: "vortices-by-phase".to_owned(),
        title: "Vortices by phase".to_owned(),
        caption: format!(
            "Vorticity across the plane, times D/U; marked: vortices that were fitted. {}; {}.",
            conditions(setting),
            averaged.samples()
        ),
        along: axes(&found.cut.grid),
        unit: "U/D".to_owned(),
        panels,
    };
    let (maps, curves) = (vec![map, velocity(found)?], curves(found));
    Ok(Signals { title: "Vortices".to_owned(), maps, curves, ..Signals::default() })
}

/// Places of the vortices of bin number `index`, in diameters from the hub.
fn marks(found: &Found, index: usize) -> Vec<[f64; 2]> {
    let (setting, spanned) = (&found.averaged.setting, found.cut.grid.spanned());
    let place = |vortex: &Vortex| {
        [0, 1].map(|a| (vortex.position[a] - setting.hub[spanned[a]]) / setting.diameter)
    };
    found.frames[index].iter().map(place).collect()
}

/// Mean velocity along the wind, and that at some phases with the vortices.
///
/// # Errors
/// [`PostprocessingError::File`].
pub(crate) fn velocity(found: &Found) -> Result<MapFigure, PostprocessingError> {
    let downwind = |moments: &Moments| {
        let [u, ..] = found.cut.velocity(moments);
        u
    };
    let mut map = by_phase(&found.averaged, &found.cut.grid, downwind, |bin| marks(found, bin))?;
    let n_marked: usize = map.panels.iter().map(|panel| panel.points.len()).sum();
    map.caption = match n_marked {
        0 => format!("No vortex was found in these bins. {}", map.caption),
        1 => format!("Marked: one vortex that was fitted. {}", map.caption),
        n => format!("Marked: {n} vortices that were fitted. {}", map.caption),
    };
    Ok(map)
}

/// Where vortices leapfrog over the azimuth of the helix, and how strong they are over the distance, where
/// enough of them were followed.
pub(crate) fn curves(found: &Found) -> Vec<CurveFigure> {
    let leapfrogs = found.sines().next().is_some().then(|| leapfrog_figure(found));
    leapfrogs.into_iter().chain(strength_figure(found)).collect()
}

/// Places of leapfrogs over the azimuth of the helix, and the sine through them, side by side.
fn leapfrog_figure(found: &Found) -> CurveFigure {
    let setting = &found.averaged.setting;
    let at = |fit: &SineFit, degrees: u32| {
        let [mean, half] = fit.at(f64::from(degrees).to_radians());
        CurveAt {
            at: f64::from(degrees),
            mean: mean / setting.diameter,
            band_95: [(mean - half) / setting.diameter, (mean + half) / setting.diameter],
        }
    };
    let point = |Passed { azimuth, one, .. }: &Passed| {
        Some([(*azimuth)?.to_degrees(), (one.place - setting.hub[0]) / setting.diameter])
    };
    let panel = |Fitted { side, sine: fit, .. }: &Fitted| {
        let of_side = found.counted().filter(|passed| passed.side == *side);
        CurvePanel {
            title: format!("{side}, {} leapfrogs", fit.n),
            points: of_side.filter_map(point).collect(),
            curve: (0..=360).step_by(5).map(|degrees| at(fit, degrees)).collect(),
            mark: None,
        }
    };
    CurveFigure {
        name: "leapfrogging-over-helix-azimuth".to_owned(),
        title: "Where vortices leapfrog".to_owned(),
        caption: format!(
            "On either side of the hub: the sine through leapfrogs with its interval of 95 % at each azimuth. {}; {}.",
            conditions(setting),
            found.averaged.samples()
        ),
        along: "helix azimuth (deg)".to_owned(),
        label: "x/D".to_owned(),
        panels: found.sines().map(panel).collect(),
    }
}

/// Vorticity in the middle of vortices over the distance, blade by blade where they are told, with a cubic
/// through it; none where too few were followed.
fn strength_figure(found: &Found) -> Option<CurveFigure> {
    let setting = &found.averaged.setting;
    let n_blades = found.blades.iter().map(|(_, blade)| blade + 1).max();
    let panel = |blade: Option<usize>| {
        let is_one = |track: &&Track| match blade {
            Some(blade) => found.blades.contains(&(track.id, blade)),
            None => track.is_born,
        };
        let sightings = found.tracks.iter().filter(is_one).flat_map(|track| &track.sightings);
        let points: Vec<[f64; 2]> = sightings
            .map(|one| {
                let place = (one.vortex.position[0] - setting.hub[0]) / setting.diameter;
                let peak = one.vortex.peak_vorticity().abs();
                [place, peak * setting.diameter / setting.wind_speed]
            })
            .collect();
        let (places, values): (Vec<f64>, Vec<f64>) = points.iter().map(|[x, y]| (*x, *y)).unzip();
        let fit = cubic_fit(&places, &values).ok()?;
        let [low, high] = places
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)]);
        let at = |step: u32| {
            let at = low + (high - low) * f64::from(step) / 60.0;
            let (mean, half) = fit.at(at);
            CurveAt { at, mean, band_95: [mean - half, mean + half] }
        };
        let title = blade.map_or(String::new(), |blade| format!("blade {} in turn", blade + 1));
        let curve = (0..=60).map(at).collect();
        Some(CurvePanel { title, points, curve, mark: None })
    };
    let panels: Vec<CurvePanel> = match n_blades {
        Some(n) => (0..n).filter_map(|blade| panel(Some(blade))).collect(),
        None => panel(None).into_iter().collect(),
    };
    (!panels.is_empty()).then(|| CurveFigure {
        name: "vortices-strength-over-distance".to_owned(),
        title: "How strong vortices are".to_owned(),
        caption: format!(
            "Vorticity in the middle of each vortex, bin by bin, and a cubic with its interval of 95 %. {}; {}.",
            conditions(setting),
            found.averaged.samples()
        ),
        along: "x/D".to_owned(),
        label: "vorticity (U/D)".to_owned(),
        panels,
    })
}
