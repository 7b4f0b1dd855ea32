//! Slices of the wind across it, behind a turbine or before it: each a full field of which
//! [cuts](flow::inflow::CutPlanes) are the wind of other cases.
//!
//! A case asks for them by a name, `output.further.NAME = { kind = "wind-slices", … }`, as often as it likes.

mod keys;

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use super::wind_record::{POINT_BYTES, POINT_MEMORY, Recorded, WindRecord};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::Vector3;
use basis::keys::Values;
use farm::Plan;
use farm::case::Run;
use flow::inflow::PlaneGrid;
use formats::case::{CaseFile, objection};
use keys::{OWN, USUAL_HEIGHT, USUAL_WIDTH};

pub(super) static KIND: OutputKind = OutputKind {
    name: "wind-slices",
    keys: Keys::Own(&OWN),
    // Prescribed wind is alike behind a turbine and before it.
    fed_by: FedBy::ResolvedFlow,
    disk,
    begin,
};

/// Part of a spacing by which lengths may miss whole ones (–).
const ROUNDING: f64 = 1e-6;

/// Slices that are asked for.
struct Slices<'a> {
    setup: &'a Prepared,
    values: &'a Values,
    /// Turbine behind which they lie.
    turbine: usize,
}

impl<'a> Slices<'a> {
    /// What `values` ask for; none where there is no turbine of the name that they have.
    fn of(setup: &'a Prepared, values: &'a Values) -> Option<Self> {
        let turbine = match values.word("turbine") {
            "" => 0,
            name => setup.case.turbines.iter().position(|turbine| turbine.name == name)?,
        };
        Some(Self { setup, values, turbine })
    }

    /// Steps from one plane to the next (–).
    fn stride(&self) -> u64 {
        (self.values.number("interval") / self.setup.plan.interval).round().max(1.0) as u64
    }

    fn schedule(&self) -> Schedule {
        Schedule::analysed_steps(&self.setup.plan, self.stride())
    }

    fn hub_height(&self) -> f64 {
        self.setup.models[self.turbine].definition.rotor.hub_height
    }

    /// Distances behind the turbine (diameters).
    fn distances(&self) -> &'a [f64] {
        self.values.numbers("distances_diameters")
    }

    /// The place on the ground in the middle of the slice `distance` (diameters) behind the turbine (m).
    fn foot(&self, distance: f64) -> Vector3 {
        let plan = &self.setup.plan;
        plan.positions[self.turbine] + Vector3::X * (distance * plan.diameter)
    }

    /// Points of a slice: half of the width to either side of the hub, half of the height above it and below,
    /// as far down as half a cell above the ground.
    fn grid(&self) -> PlaneGrid {
        let (plan, hub_height) = (&self.setup.plan, self.hub_height());
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
            speed: self.setup.case.wind.speed,
            n_steps: 0,
            repeats: false,
        }
    }

    /// Points of all slices (–).
    fn n_points(&self) -> u64 {
        let grid = self.grid();
        (self.distances().len() * grid.n_y * grid.n_z) as u64
    }

    /// What of them cannot be recorded: the key, and what would do.
    fn fault(&self) -> Option<(&'static str, String)> {
        let plan = &self.setup.plan;
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

/// Whether the slices that the case of `file`, prepared as `setup`, asks for can be recorded.
///
/// # Errors
/// [`StudyError::Case`] at the key that does not fit.
pub(crate) fn check(file: &CaseFile, setup: &Prepared) -> Result<(), StudyError> {
    for one in setup.case.output.further.iter().filter(|one| one.kind.name() == KIND.name) {
        let fault = match Slices::of(setup, &one.values) {
            Some(slices) => slices.fault(),
            None => {
                let names: Vec<&str> =
                    setup.case.turbines.iter().map(|turbine| turbine.name.as_str()).collect();
                let name = one.values.word("turbine");
                Some((
                    "turbine",
                    format!("there is no turbine {name}: take one of {}", names.join(", ")),
                ))
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

/// Memory (bytes) that the slices of a run of `setup` take.
pub(crate) fn memory(setup: &Prepared) -> u64 {
    let further = setup.case.output.further.iter().filter(|one| one.kind.name() == KIND.name);
    let slices = further.filter_map(|one| Slices::of(setup, &one.values));
    slices.map(|slices| slices.n_points() * POINT_MEMORY).sum()
}

fn disk(setup: &Prepared, _: &Run, values: &Values) -> u64 {
    let Some(slices) = Slices::of(setup, values) else { return 0 };
    slices.schedule().count(setup.plan.n_steps) * slices.n_points() * POINT_BYTES
}

struct WindSlices {
    schedule: Schedule,
    records: Vec<WindRecord>,
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Scene { setup, run, folder, name, values, .. } = *scene;
    let Some(slices) = Slices::of(setup, values) else { return Ok(None) };
    // So many bytes of each are sure.
    let n_bytes: Option<Vec<u64>> = stored.map(Stored::state).transpose()?;
    let turbine = &setup.case.turbines[slices.turbine].name;
    let record = |(place, &distance): (usize, &f64)| {
        let n_bytes = n_bytes.as_ref().and_then(|n_bytes| n_bytes.get(place)).copied();
        let slice = format!("{distance}D");
        let recorded = Recorded {
            grid: slices.grid(),
            foot: slices.foot(distance),
            hub_height: slices.hub_height(),
            description: format!(
                "wakemix: {}, run {}, {slice} behind {turbine}",
                setup.case.name, run.name
            ),
        };
        WindRecord::begin(&folder.slice_path(name, &slice), recorded, n_bytes)
    };
    let records = slices.distances().iter().enumerate().map(record).collect::<Result<_, _>>()?;
    Ok(Some(Box::new(WindSlices { schedule: slices.schedule(), records })))
}

impl Output for WindSlices {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        self.records.iter_mut().try_for_each(|record| record.write(scene.farm.flow()))
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let flushed = self.records.iter_mut().map(WindRecord::flush);
        let n_bytes: Vec<u64> = flushed.collect::<Result<_, _>>()?;
        section.keep(&n_bytes)
    }

    fn finish(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        self.records.iter_mut().try_for_each(WindRecord::finish)
    }
}

#[cfg(test)]
mod tests;
