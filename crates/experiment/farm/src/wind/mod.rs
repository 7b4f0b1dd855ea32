//! The one place that makes the wind of a case: profile, veer, event and turbulence, for whatever moves the
//! air.

mod around_rotors;
mod at_inlet;
mod from_file;
mod length_scale;
mod surroundings;
mod walls;

pub use around_rotors::{prescribed, unsuited_grid};
pub use at_inlet::entering;
pub use from_file::{ForeignWind, Recorded, enters_from_file};
pub use length_scale::{length_scale, usual_length_scale};
pub use surroundings::{Surroundings, SurroundingsError};
pub use walls::{inflow_share, wall_gain};

use crate::assemble::TurbineModel;
use crate::case::{Case, Ground, Shear, WindEvent};
use crate::plan::Plan;
use crate::solvers::WindSource;
use flow::Inflow;
use flow::inflow::deterministic::{Event, RotatingDisk};
use flow::inflow::{DeterministicWind, InflowError, MeanProfile};
use std::sync::Arc;

/// What the wind is made for.
#[derive(Clone, Copy)]
pub struct Site<'a> {
    /// The study.
    pub case: &'a Case,
    /// Its domain and steps.
    pub plan: &'a Plan,
    /// One for each turbine of the case, in its order.
    pub models: &'a [TurbineModel],
    /// The atmosphere that its air is; none where air is alike everywhere.
    pub surroundings: Option<&'a Surroundings>,
}

/// Turbulence that a case will have made.
#[derive(Clone, Debug, PartialEq)]
pub struct Turbulence {
    /// Most memory that making it takes (bytes).
    pub memory: u64,
    /// Points of its box along, across and up (–); another box holds another wind, whatever the seed.
    pub n_points: [usize; 3],
    /// What a reader of the numbers must know of it.
    pub warning: Option<String>,
}

/// The turbulence that `site` will have made; none where none is made.
pub fn turbulence(site: &Site) -> Option<Turbulence> {
    at_inlet::turbulence(site).or_else(|| around_rotors::turbulence(site))
}

/// The wind of `case` without turbulence.
///
/// # Errors
/// [`InflowError::Setting`] for an event that cannot be.
pub fn without_turbulence(case: &Case, plan: &Plan) -> Result<Arc<dyn Inflow>, InflowError> {
    let wind = deterministic(case, plan);
    if wind.veer == 0.0 && wind.event == Event::Steady {
        // The same wind, found faster.
        return Ok(Arc::new(wind.profile));
    }
    wind.check()?;
    Ok(Arc::new(wind))
}

/// The mean profile that blows into the air of `case`, with the hub height that `plan` found for its first
/// turbine.
pub fn profile(case: &Case, plan: &Plan) -> MeanProfile {
    let (hub_height, speed) = (plan.hub_height, case.wind.speed * inflow_share(case, plan));
    match case.wind.shear {
        Shear::PowerLaw { exponent } => MeanProfile::PowerLaw { hub_height, speed, exponent },
        Shear::LogLaw { roughness_length } => {
            MeanProfile::LogLaw { hub_height, speed, roughness_length }
        }
    }
}

/// Why the profile that blows into `case` is not the one that its rough ground keeps, with the fix; none
/// where it is, where a file brings it, and where no air meets a rough ground.
pub fn off_balance(case: &Case) -> Option<String> {
    if case.wind_source() != WindSource::AtInlet || case.wind.is_brought() {
        return None;
    }
    let Ground::Rough { roughness_length: ground } = case.flow.domain().ground else { return None };
    let blows_in = match case.wind.shear {
        Shear::LogLaw { roughness_length } if roughness_length == ground => return None,
        Shear::LogLaw { roughness_length } => {
            format!("the logarithmic law of z₀ = {roughness_length} m")
        }
        Shear::PowerLaw { exponent } => format!("a power law of exponent {exponent}"),
    };
    Some(format!(
        "the ground keeps the logarithmic law of z₀ = {ground} m, and {blows_in} blows in: the profile changes on its way through \
         the domain; write wind.roughness_length = {ground}, and no wind.shear_exponent"
    ))
}

/// The wind of `case` without turbulence; lengths in diameters are those of its first turbine in `plan`.
///
/// The event's place is that turbine: its hub is the middle of the rotating disk's path and of the extreme
/// shear.
pub fn deterministic(case: &Case, plan: &Plan) -> DeterministicWind {
    let event = case.wind.event.map_or(Event::Steady, |event| event_of(&event, case, plan));
    let profile = profile(case, plan);
    DeterministicWind { profile, hub_height: plan.hub_height, veer: case.wind.veer, event }
}

fn event_of(event: &WindEvent, case: &Case, plan: &Plan) -> Event {
    let diameter = plan.diameter;
    let hub_y = plan.positions.first().map_or(0.0, |foot| foot.y);
    match *event {
        WindEvent::Everywhere(change) => Event::Everywhere(change),
        WindEvent::ExtremeShear { start, duration, vertical, horizontal } => {
            Event::ExtremeShear { start, duration, diameter, hub_y, vertical, horizontal }
        }
        WindEvent::RotatingDisk(disk) => Event::RotatingDisk(RotatingDisk {
            middle: [hub_y, plan.hub_height],
            offsets: disk.offsets_diameters.map(|offset| offset * diameter),
            radius: disk.radius_diameters * diameter,
            edge: disk.edge_diameters * diameter,
            speed: disk.speed,
            frequencies: disk.strouhal.map(|strouhal| strouhal * case.wind.speed / diameter),
            sweep: disk.sweep,
            clockwise: disk.sense == crate::case::Sense::Clockwise,
        }),
    }
}
