//! Figures of vortices: where they are phase by phase, and where they leapfrog.

use super::{Found, section};
use crate::PostprocessingError;
use crate::wake_fields::{axes, conditions, panel};
use analysis::vortices::{Leapfrog, SineFit, Vortex};
use report::{CurveAt, CurveFigure, CurvePanel, MapFigure, Signals};

/// The figures of what was `found`.
pub(super) fn signals(found: &Found) -> Result<Signals, PostprocessingError> {
    let (averaged, setting) = (&found.averaged, &found.averaged.setting);
    let n = found.frames.len();
    let spanned = averaged.grid().spanned();
    let mut panels = Vec::new();
    for index in (0..n).step_by(n.div_ceil(3).max(1)) {
        let scale = setting.diameter / setting.wind_speed;
        let vorticity: Vec<f64> =
            section(averaged, index)?.vorticity().iter().map(|value| value * scale).collect();
        let title = format!("rotor {:.0}°", averaged.head.bins[index].rotor.to_degrees());
        let Some(mut panel) = panel(averaged.grid(), setting, title, &vorticity) else { continue };
        let place = |vortex: &Vortex| {
            [0, 1].map(|a| (vortex.position[a] - setting.hub[spanned[a]]) / setting.diameter)
        };
        panel.points = found.frames[index].iter().map(place).collect();
        panels.push(panel);
    }
    let map = MapFigure {
        name: "vortices-by-phase".to_owned(),
        title: "Vortices by phase".to_owned(),
        caption: format!(
            "Vorticity across the plane, times D/U; marked: vortices that were fitted. {}; {}.",
            conditions(setting),
            averaged.samples()
        ),
        along: axes(averaged.grid()),
        unit: "U/D".to_owned(),
        panels,
    };
    let curves = found.fit.map(|fit| leapfrog_figure(found, &fit)).into_iter().collect();
    Ok(Signals { title: "Vortices".to_owned(), maps: vec![map], curves, ..Signals::default() })
}

/// Places of leapfrogs over the azimuth of the helix, and the sine through them.
fn leapfrog_figure(found: &Found, fit: &SineFit) -> CurveFigure {
    let setting = &found.averaged.setting;
    let at = |degrees: u32| {
        let mean = fit.mean + fit.amplitude * (f64::from(degrees).to_radians() + fit.phase).sin();
        let half = fit.half_widths[0].hypot(fit.half_widths[1]);
        CurveAt {
            at: f64::from(degrees),
            mean: mean / setting.diameter,
            band_95: [(mean - half) / setting.diameter, (mean + half) / setting.diameter],
        }
    };
    let point = |(azimuth, one): &(f64, Leapfrog)| {
        [azimuth.to_degrees(), (one.place - setting.hub[0]) / setting.diameter]
    };
    CurveFigure {
        name: "leapfrogging-over-helix-azimuth".to_owned(),
        title: "Where vortices leapfrog".to_owned(),
        caption: format!(
            "The sine through {} leapfrogs with its interval of 95 %. {}; {}.",
            fit.n,
            conditions(setting),
            found.averaged.samples()
        ),
        along: "helix azimuth (deg)".to_owned(),
        label: "x/D".to_owned(),
        panels: vec![CurvePanel {
            title: String::new(),
            points: found.leapfrogs.iter().map(point).collect(),
            curve: (0..=360).step_by(5).map(at).collect(),
            mark: None,
        }],
    }
}
