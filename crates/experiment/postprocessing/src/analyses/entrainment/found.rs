//! What crosses into a wake, and the power in discs across it.

use crate::PostprocessingError;
use crate::request::{AnalysisSetting, Request, Takes};
use crate::wake_fields::{Averaged, settings};
use analysis::entrainment::{
    Edge, FluxPoint, available_power, flux_along, flux_through_tube, integral, sign_flip,
};
use analysis::grids::widened;
use analysis::phases::Decomposition;
use basis::records::FieldSetting;

pub(super) const RADIUS: AnalysisSetting = settings::setting(
    "radius",
    "D",
    Takes::Number,
    "Distance of lines and tube from the hub (rotor diameters); 0.5 when left out",
);
pub(super) const SMOOTHING: AnalysisSetting = settings::setting(
    "smoothing",
    "D",
    Takes::Number,
    "Length over which the flux is smoothed before its change of sign is looked for (rotor diameters); 0.25 when left out",
);
/// Name and value of a part of the flux.
pub(crate) type Part = (&'static str, fn(&FluxPoint) -> f64);

/// All parts.
pub(crate) const PARTS: [Part; 3] =
    [("all", |p| p.total), ("periodic", |p| p.periodic), ("random", |p| p.random)];

/// What crosses one line, or a tube.
pub(crate) struct Through {
    /// Its name.
    pub(crate) name: &'static str,
    /// Place by place.
    pub(crate) points: Vec<FluxPoint>,
}

/// Power in a disc in the velocity of one bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AtPhase {
    /// Rotor azimuth at the bin's middle (rad).
    pub(crate) rotor: f64,
    /// Helix azimuth there (rad); none where the helix plays no part.
    pub(crate) helix: Option<f64>,
    /// Fraction of available power (–).
    pub(crate) fraction: f64,
}

/// Power in a disc at one distance.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct DiscRow {
    /// Distance from the rotor (m).
    pub(crate) x: f64,
    /// Bin by bin.
    pub(crate) by_phase: Vec<AtPhase>,
    /// Mean over the bins (–).
    pub(crate) mean: f64,
    /// Standard deviation over the bins (–).
    pub(crate) deviation: f64,
    /// Least and greatest (–).
    pub(crate) range: [f64; 2],
}

/// What crosses into a wake.
pub(crate) struct Energy {
    /// What the fields were taken of.
    pub(crate) setting: FieldSetting,
    /// Samples behind them in words.
    pub(crate) samples: String,
    /// Distance of lines and tube from the hub (m).
    pub(crate) radius: f64,
    /// Length over which the flux is smoothed before its change of sign is looked for (m).
    pub(crate) smoothing: f64,
    /// What crosses each line, or the tube; none where the grid has neither.
    pub(crate) fluxes: Vec<Through>,
}

impl Energy {
    /// What crosses in the fields of `found`, whose parts are `parts`, where `request` has it.
    ///
    /// # Errors
    /// [`PostprocessingError::Setting`].
    pub(crate) fn of(
        request: &Request,
        found: &Averaged,
        parts: &Decomposition,
    ) -> Result<Self, PostprocessingError> {
        let setting = found.setting.clone();
        let radius = settings::positive(request, &RADIUS, 0.5)? * setting.diameter;
        let smoothing = settings::positive(request, &SMOOTHING, 0.25)? * setting.diameter;
        let fluxes = fluxes(found, parts, radius);
        Ok(Self { setting, samples: found.samples(), radius, smoothing, fluxes })
    }

    /// Distance of `x` (m) from the rotor (rotor diameters).
    pub(crate) fn distance(&self, x: f64) -> f64 {
        (x - self.setting.hub[0]) / self.setting.diameter
    }

    /// Where the smoothed flux of all fluctuations turns from leaving to entering (m).
    pub(crate) fn turns_at(&self, one: &Through) -> Option<f64> {
        sign_flip(&one.points, self.smoothing)
    }

    /// Integrals of all, periodic and random flux over the distance (U³D).
    pub(crate) fn integrals(&self, one: &Through) -> [f64; 3] {
        let scale = self.setting.wind_speed.powi(3) * self.setting.diameter;
        PARTS.map(|(_, part)| integral(&one.points, part) / scale)
    }
}

/// What crosses the lines at the rotor's edge, or the tube around it, wherever the grid has them behind the
/// rotor: before it there is no wake, and its flux turns anywhere about zero.
fn fluxes(found: &Averaged, parts: &Decomposition, radius: f64) -> Vec<Through> {
    let (grid, hub) = (found.grid(), found.setting.hub);
    if grid.n_points[0] < 2 {
        return Vec::new();
    }
    let behind = |mut points: Vec<FluxPoint>| {
        points.retain(|point| point.x >= hub[0]);
        points
    };
    let tube = behind(flux_through_tube(parts, grid, [hub[1], hub[2]], radius));
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
        Through { name, points: behind(points) }
    };
    lines.into_iter().map(through).filter(|one| one.points.len() > 1).collect()
}

/// The fraction of available power at each x, bin by bin; and why there is none.
pub(crate) fn discs(
    found: &Averaged,
) -> Result<(Vec<DiscRow>, Option<String>), PostprocessingError> {
    let (grid, setting) = (found.grid(), &found.setting);
    let (hub, radius) = (setting.hub, 0.5 * setting.diameter);
    let n_x = grid.n_points[0];
    let mut discs = vec![Vec::new(); n_x];
    let mut why = None;
    for (index, bin) in found.head.bins.iter().enumerate() {
        if bin.n_instants == 0 {
            continue;
        }
        let u = widened(&found.bin(index)?.mean[0]);
        for (step, disc) in discs.iter_mut().enumerate() {
            let x = grid.coordinate(0, step);
            match available_power(grid, &u, (x, [hub[1], hub[2]]), radius, setting.wind_speed) {
                Ok(one) => {
                    let (rotor, helix) = (bin.rotor, bin.helix);
                    disc.push(AtPhase { rotor, helix, fraction: one.fraction });
                }
                Err(error) => why = Some(format!("available power: {error}")),
            }
        }
    }
    let rows = discs.into_iter().enumerate().filter(|(_, disc)| !disc.is_empty());
    let rows = rows.map(|(step, disc)| DiscRow::of(grid.coordinate(0, step) - hub[0], disc));
    Ok((rows.collect(), why))
}

impl DiscRow {
    /// The disc at `x` (m) behind the rotor, of its bins.
    fn of(x: f64, by_phase: Vec<AtPhase>) -> Self {
        let (n, values) = (by_phase.len() as f64, || by_phase.iter().map(|one| one.fraction));
        let mean = values().sum::<f64>() / n;
        let variance = values().map(|value| (value - mean).powi(2)).sum::<f64>() / n;
        let range = [values().fold(f64::INFINITY, f64::min), values().fold(0.0, f64::max)];
        Self { x, mean, deviation: variance.sqrt(), range, by_phase }
    }
}
