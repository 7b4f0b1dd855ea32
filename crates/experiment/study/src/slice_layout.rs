//! Where the slices of `kind = "wind-slices"` lie: known before any run, and checked when a case is prepared.

use crate::StudyError;
use crate::outputs::Schedule;
use basis::Vector3;
use basis::keys::Values;
use farm::Plan;
use farm::assemble::TurbineModel;
use farm::case::Case;
use flow::inflow::PlaneGrid;
use formats::case::{CaseFile, objection};

/// Name of the kind of output.
pub(crate) const KIND_NAME: &str = "wind-slices";
/// Width and height of slices (diameters) unless the case says otherwise: room for a rotor that stands more
/// than a diameter aside.
const USUAL_WIDTH: f64 = 4.0;
const USUAL_HEIGHT: f64 = 1.2;
/// Part of a spacing by which lengths may miss whole ones (–).
const ROUNDING: f64 = 1e-6;

/// A case that is laid out.
#[derive(Clone, Copy)]
pub(crate) struct Laid<'a> {
    /// The study.
    pub(crate) case: &'a Case,
    /// Its domain and steps.
    pub(crate) plan: &'a Plan,
    /// One for each turbine of the case, in its order.
    pub(crate) models: &'a [TurbineModel],
}

/// Slices that are asked for.
pub(crate) struct Slices<'a> {
    laid: Laid<'a>,
    values: &'a Values,
    /// Turbine behind which they lie.
    pub(crate) turbine: usize,
}

impl<'a> Slices<'a> {
    /// What `values` ask for; none where there is no turbine of the name that they have.
    pub(crate) fn of(laid: Laid<'a>, values: &'a Values) -> Option<Self> {
        let turbine = match values.word("turbine") {
            "" => 0,
            name => laid.case.turbines.iter().position(|turbine| turbine.name == name)?,
        };
        Some(Self { laid, values, turbine })
    }

    /// Steps from one plane to the next (–).
    fn stride(&self) -> u64 {
        (self.values.number("interval") / self.laid.plan.interval).round().max(1.0) as u64
    }

    pub(crate) fn schedule(&self) -> Schedule {
        Schedule::analysed_steps(self.laid.plan, self.stride())
    }

    pub(crate) fn hub_height(&self) -> f64 {
        self.laid.models[self.turbine].definition.rotor.hub_height
    }

    /// Distances behind the turbine (diameters).
    pub(crate) fn distances(&self) -> &'a [f64] {
        self.values.numbers("distances_diameters")
    }

    /// The place on the ground in the middle of the slice `distance` (diameters) behind the turbine (m).
    pub(crate) fn foot(&self, distance: f64) -> Vector3 {
        let plan = self.laid.plan;
        plan.positions[self.turbine] + Vector3::X * (distance * plan.diameter)
    }

    /// Points of a slice: half of the width to either side of the hub, half of the height above it and below,
    /// as far down as half a cell above the ground.
    pub(crate) fn grid(&self) -> PlaneGrid {
        let (plan, hub_height) = (self.laid.plan, self.hub_height());
        let length = |key: &str, diameters: f64| {
            self.values.optional_number(key).unwrap_or(diameters * plan.diameter)
        };
        let spacing = self.values.optional_number("spacing").unwrap_or(plan.spacing);
        let intervals = |length: f64| (length / spacing + ROUNDING).floor();
        let [across, up] = [("width", USUAL_WIDTH), ("height", USUAL_HEIGHT)]
            .map(|(key, usual)| intervals(length(key, usual)));
        let lowest = hub_height - 0.5 * up * spacing;
        let left_out = ((0.5 * plan.spacing - lowest) / spacing - ROUNDING).ceil().clamp(0.0, up);
        PlaneGrid {
            n_y: across as usize + 1,
            n_z: (up - left_out) as usize + 1,
            spacing: [spacing; 2],
            first: [-0.5 * across * spacing, lowest + left_out * spacing],
            interval: self.stride() as f64 * plan.interval,
            speed: self.laid.case.wind.speed,
            n_steps: 0,
            repeats: false,
        }
    }

    /// Points of all slices (–).
    pub(crate) fn n_points(&self) -> u64 {
        let grid = self.grid();
        (self.distances().len() * grid.n_y * grid.n_z) as u64
    }

    /// What of them cannot be recorded: the key, and what would do.
    fn fault(&self) -> Option<(&'static str, String)> {
        let plan = self.laid.plan;
        if self.schedule().count(plan.n_steps) < 2 {
            let message = "two planes at least make a record, and the analysed time is too short for them: lower interval, or raise time.duration";
            return Some(("interval", message.to_owned()));
        }
        // Air without cells is known everywhere.
        if plan.n_cells[0] == 0 {
            return None;
        }
        let grid = self.grid();
        let [[first, last], [right, left], [_, top]] = held(plan);
        let slack = ROUNDING * plan.spacing;
        for &distance in self.distances() {
            let foot = self.foot(distance);
            if foot.x < first - slack || foot.x > last + slack {
                let [low, high] =
                    [first, last].map(|x| (x - plan.positions[self.turbine].x) / plan.diameter);
                let message = format!(
                    "the slice {distance} D behind the turbine lies outside of the domain, which reaches from {low:.2} to {high:.2} D: raise flow.downstream_diameters or flow.upstream_diameters, or leave it out"
                );
                return Some(("distances_diameters", message));
            }
            let [low, high] = grid.across().map(|y| foot.y + y);
            if low < right - slack || high > left + slack {
                let most = 2.0 * (left - foot.y).min(foot.y - right).max(0.0);
                let message = format!(
                    "slices {:.1} m wide reach beyond the sides of the domain: give a width of {most:.1} m at most, or raise flow.width_diameters",
                    high - low
                );
                return Some(("width", message));
            }
        }
        let highest = grid.up()[1];
        (highest > top + slack).then(|| {
            let most = (2.0 * (top - self.hub_height())).max(0.0);
            let message = format!(
                "slices reach up to {highest:.1} m, and the domain to {top:.1} m: give a height of {most:.1} m at most, or raise flow.height_diameters"
            );
            ("height", message)
        })
    }
}

/// What the middles of the cells of `plan` span along x, y, z (m).
fn held(plan: &Plan) -> [[f64; 2]; 3] {
    let origin = plan.origin.to_array();
    std::array::from_fn(|axis| {
        let end = (plan.n_cells[axis] as f64 - 0.5) * plan.spacing;
        [origin[axis] + 0.5 * plan.spacing, origin[axis] + end]
    })
}

/// Whether the slices that the case of `file`, `laid` out, asks for can be recorded.
///
/// # Errors
/// [`StudyError::Case`] at the key that does not fit.
pub(crate) fn check(file: &CaseFile, laid: Laid) -> Result<(), StudyError> {
    for one in laid.case.output.further.iter().filter(|one| one.kind.name() == KIND_NAME) {
        let fault = match Slices::of(laid, &one.values) {
            Some(slices) => slices.fault(),
            None => {
                let names: Vec<&str> =
                    laid.case.turbines.iter().map(|turbine| turbine.name.as_str()).collect();
                let (name, names) = (one.values.word("turbine"), names.join(", "));
                Some(("turbine", format!("there is no turbine {name}: take one of {names}")))
            }
        };
        if let Some((key, message)) = fault {
            let path = ["output", "further", one.name.as_str(), key];
            let message = format!("output.further.{}.{key}: {message}", one.name);
            return Err(StudyError::Case(objection(file, &path, message)));
        }
    }
    Ok(())
}
