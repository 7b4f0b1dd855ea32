//! The file of weights: what a controller is to do.

mod keys;
mod one_or_each;
mod problem;
mod quadratic;
#[cfg(test)]
mod tests;

pub use problem::WeightProblem;

use crate::DesignError;
use crate::model::short;
use formats::linear_model::{LinearModel, Port};
use formats::{FileError, atomic};
use keys::Keys;
use lti::matrices::{MatrixError, StateSpace, append};
use one_or_each::OneOrEach;
pub(crate) use quadratic::Diagonals;
use quadratic::Quadratic;
use serde::Deserialize;
use std::fmt;
use std::num::NonZeroUsize;
use std::path::Path;

/// What the file holds, in words.
const WHAT: &str = "weights of a controller";

/// How a controller is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Least peak of the weighted loop over all frequencies.
    #[default]
    HInfinity,
    /// Least mean square of it under white noise.
    H2,
    /// Linear quadratic regulator and Kalman filter.
    Lqg,
    /// The same with integral action.
    Lqi,
}

/// The file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct WeightsFile {
    #[serde(default)]
    pub(crate) method: Method,
    /// Of the sensitivity.
    performance: Option<OneOrEach<Keys>>,
    /// Of the complementary sensitivity.
    complementary: Option<OneOrEach<Keys>>,
    /// Of the control.
    control: Option<OneOrEach<Keys>>,
    #[serde(default)]
    quadratic: Quadratic,
    /// Order that the controller is reduced to, before the predictor is added.
    pub(crate) order: Option<NonZeroUsize>,
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::HInfinity => "H-infinity",
            Self::H2 => "H2",
            Self::Lqg => "LQG",
            Self::Lqi => "LQG with integral action",
        })
    }
}

/// A weight over frequency, in continuous time.
#[derive(Clone, Debug)]
pub(crate) struct Weight {
    /// From all channels on.
    pub(crate) whole: StateSpace,
    /// That of each channel; none where all have the same, or one ties them together.
    pub(crate) by_channel: Vec<StateSpace>,
}

/// Weights of sensitivity, complementary sensitivity and control, in this order.
pub(crate) type Weights = [Option<Weight>; 3];

impl WeightsFile {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// [`DesignError::File`] with line and key.
    pub(crate) fn read(path: &Path) -> Result<Self, DesignError> {
        Self::parse(path, &atomic::read_text(path, WHAT)?)
    }

    /// The file at `path` that holds `text`.
    ///
    /// # Errors
    /// As for [`read`](Self::read).
    fn parse(path: &Path, text: &str) -> Result<Self, DesignError> {
        toml::from_str(text).map_err(|error| {
            let fix = "write it as docs/control-design.md has it";
            FileError::content(WHAT, path, error.to_string().trim_end().to_owned(), fix).into()
        })
    }

    /// The weights on the channels of `model`; this file stands at `path`.
    ///
    /// # Errors
    /// [`DesignError::Weight`] naming file, table and key.
    pub(crate) fn on(&self, model: &LinearModel, path: &Path) -> Result<Weights, DesignError> {
        let of = |name: &'static str, entry: &Option<OneOrEach<Keys>>, ports: &[Port]| {
            let weight = entry.as_ref().map(|entry| on_channels(entry, name, ports)).transpose();
            weight.map_err(|refused| refused.at(path))
        };
        Ok([
            of("performance", &self.performance, &model.outputs)?,
            of("complementary", &self.complementary, &model.outputs)?,
            of("control", &self.control, &model.inputs)?,
        ])
    }

    /// Refuses weights over frequency, in the file at `path`, that leave nothing to find.
    ///
    /// # Errors
    /// [`DesignError::Weight`] naming the table that is missing.
    pub(crate) fn check_whole(&self, path: &Path) -> Result<(), DesignError> {
        let is_over_frequency = matches!(self.method, Method::HInfinity | Method::H2);
        let wanted = self.performance.is_some() || self.complementary.is_some();
        let costs = self.control.is_some() || self.complementary.is_some();
        let (table, problem) = match (is_over_frequency, wanted, costs) {
            (true, false, _) => ("[performance]", WeightProblem::NothingWanted),
            (true, true, false) => ("[control]", WeightProblem::FreeControl),
            _ => return Ok(()),
        };
        Err(Refused { place: table.to_owned(), problem }.at(path))
    }

    /// The weights of a linear quadratic problem on the channels of `model`; this file stands at `path`.
    ///
    /// # Errors
    /// [`DesignError::Weight`] naming file and key.
    pub(crate) fn quadratic_on(
        &self,
        model: &LinearModel,
        path: &Path,
    ) -> Result<Diagonals, DesignError> {
        let diagonals = self.quadratic.on([model.outputs.len(), model.inputs.len()]);
        let place = || "[quadratic]".to_owned();
        diagonals.map_err(|problem| Refused { place: place(), problem }.at(path))
    }
}

/// A weight that cannot be one, with the table that holds it.
struct Refused {
    place: String,
    problem: WeightProblem,
}

impl Refused {
    /// The error of the file at `path`.
    fn at(self, path: &Path) -> DesignError {
        DesignError::Weight { path: path.to_owned(), place: self.place, problem: self.problem }
    }
}

/// The weight of the table or tables of that `name`, on the channels `ports`.
fn on_channels(entry: &OneOrEach<Keys>, name: &str, ports: &[Port]) -> Result<Weight, Refused> {
    let tables = match entry {
        OneOrEach::One(table) => {
            let on_all = on_all(table, ports.len());
            return on_all.map_err(|problem| Refused { place: format!("[{name}]"), problem });
        }
        OneOrEach::Each(tables) => tables,
    };
    let refused = |problem| Refused { place: format!("[[{name}]]"), problem };
    let mut found: Vec<Option<StateSpace>> = vec![None; ports.len()];
    for table in tables {
        let channel = table.channel.clone().ok_or_else(|| refused(WeightProblem::NoChannel))?;
        let place = format!("[[{name}]] of {channel}");
        let refused = |problem| Refused { place: place.clone(), problem };
        let number = number_of(&channel, ports).map_err(refused)?;
        if found[number].is_some() {
            return Err(refused(WeightProblem::Twice));
        }
        found[number] = Some(on_one(table).map_err(refused)?);
    }
    let by_channel = found.into_iter().zip(ports).map(|(weight, port)| {
        weight.ok_or_else(|| refused(WeightProblem::Unweighted { channel: port.name.clone() }))
    });
    let by_channel = by_channel.collect::<Result<Vec<_>, _>>()?;
    let whole = append(&by_channel.iter().collect::<Vec<_>>());
    Ok(Weight { whole: whole.map_err(|error| refused(error.into()))?, by_channel })
}

/// The weight of a table without a channel: on each of `n` channels, or on all of them together.
fn on_all(table: &Keys, n: usize) -> Result<Weight, WeightProblem> {
    if table.channel.is_some() {
        return Err(WeightProblem::Single);
    }
    let system = table.system()?;
    let whole = match system.inputs() {
        1 => system.repeated(n)?,
        inputs if inputs == n => system,
        inputs => return Err(WeightProblem::Inputs { inputs, channels: n }),
    };
    Ok(Weight { whole, by_channel: Vec::new() })
}

/// The weight of one channel.
fn on_one(table: &Keys) -> Result<StateSpace, WeightProblem> {
    let system = table.system()?;
    match system.inputs() {
        1 => Ok(system),
        inputs => Err(WeightProblem::Inputs { inputs, channels: 1 }),
    }
}

/// Number of the `channel` among `ports`, by its name or by what stands behind its turbine's.
fn number_of(channel: &str, ports: &[Port]) -> Result<usize, WeightProblem> {
    let exact = ports.iter().position(|port| port.name == channel);
    let mut ends = (0..ports.len()).filter(|number| short(&ports[*number].name) == channel);
    match (exact, ends.next(), ends.next()) {
        (Some(number), ..) | (None, Some(number), None) => Ok(number),
        _ => {
            let known = ports.iter().map(|port| port.name.as_str()).collect::<Vec<_>>();
            Err(WeightProblem::UnknownChannel { known: known.join(", ") })
        }
    }
}

/// Gain (–) that a `weight` asks what it weighs to stay below at `frequency` (rad/s), its own bound being
/// one; none where it leaves a direction free.
///
/// # Errors
/// [`MatrixError`] for a pole there.
pub(crate) fn bound(weight: &StateSpace, frequency: f64) -> Result<Option<f64>, MatrixError> {
    let values = weight.singular_values(frequency)?;
    // ‖W S‖ ≥ (least of W) ‖S‖; with fewer outputs than inputs there are directions that W does not see.
    let least = values.get(weight.inputs() - 1).copied().unwrap_or(0.0);
    Ok((least > 0.0).then(|| least.recip()))
}
