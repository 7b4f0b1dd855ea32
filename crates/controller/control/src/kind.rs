//! What the program knows of a kind of controller: its keys, its checks, how it is built, what the summary
//! says of it.

use crate::baseline::{CoefficientTable, Constants};
use crate::error::ControlError;
use crate::excitation::excitation_rate;
use crate::library::{Hosted, Libraries};
use crate::linear_law::{LawFiles, LinearLaws};
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use crate::phase_sync::PhaseSyncSettings;
use crate::{Baseline, Controller};
use basis::keys::{LeftOut, Objection, Table, Value, Values};
use basis::records::PitchResponse;
use basis::registry::Named;
use basis::{Channel, Sense};
use estimation::Definition;
use std::fmt;
use std::sync::Arc;

/// A kind of controller.
///
/// The methods without a body are all that a kind must have; the others say what a study can do with it.
pub trait ControllerKind: Named + Sync {
    /// Its keys in the case file, beside `kind`.
    fn table(&self) -> &'static Table;

    /// Completes `values` by what `place` tells; gives what about them cannot be, beyond what the keys say
    /// one by one.
    fn check(&self, _values: &mut Values, _place: &Place) -> Vec<Objection> {
        Vec::new()
    }

    /// What runs on the turbine at `site` under `control`.
    ///
    /// # Errors
    /// [`ControlError`] for a controller that cannot be built.
    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError>;

    /// The shared library that it runs, or goes on top of.
    fn hosted(&self, _control: &Control) -> Option<Hosted> {
        None
    }

    /// Files of the linear control laws that it runs.
    fn law_files(&self, _control: &Control) -> Option<LawFiles> {
        None
    }

    /// Whether the turbine is there at all.
    fn is_there(&self) -> bool {
        true
    }

    /// Whether it pitches blades apart from each other, which takes three of them.
    fn pitches_individually(&self) -> bool {
        true
    }

    /// Whether it turns the nacelle.
    fn turns_nacelle(&self) -> bool {
        false
    }

    /// Sense and Strouhal number (–) of the helix that it makes, or joins.
    fn helix(&self, _control: &Control) -> Option<(Sense, f64)> {
        None
    }

    /// The periodic pitch whose amplitude at the blades is to be measured; none where there is none, or it
    /// varies.
    fn pitching(&self, _control: &Control) -> Option<Pitching> {
        None
    }

    /// Lowest Strouhal number (–) at which it excites the wake; none where it excites nothing.
    fn slowest_strouhal(&self, control: &Control) -> Option<f64> {
        self.pitching(control).map(|pitching| pitching.strouhal)
    }

    /// What must be known of how the turbine's pitch acts before it runs, and is not given.
    fn identification(&self, _control: &Control) -> Option<Identification> {
        None
    }

    /// How the turbine's pitch acts, as it is given or was found: for the record.
    fn pitch_response(&self, control: &Control) -> Option<PitchResponse> {
        control.response
    }

    /// Whatever response in the place of one that is yet to be found, so that a controller can be built for a
    /// check.
    fn any_response(&self) -> Option<PitchResponse> {
        None
    }

    /// Channels of the turbine, of `n_blades` blades, that [`Self::outcome`] reads, and time where it reads
    /// it.
    fn outcome_channels(&self, _control: &Control, _n_blades: usize) -> Vec<Channel> {
        Vec::new()
    }

    /// What it has to tell after a run, from the analysed part of the `record`.
    ///
    /// # Errors
    /// [`MissingChannel`] for a channel that records do not have.
    fn outcome(
        &self,
        _control: &Control,
        _record: &dyn TurbineRecord,
    ) -> Result<Outcome, MissingChannel> {
        Ok(Outcome::default())
    }

    /// What a reader of the numbers must know of the values of `control`, each as what follows "run R: T".
    fn warnings(&self, _control: &Control) -> Vec<String> {
        Vec::new()
    }
}

/// Where a controller stands in the layout, as far as its values may depend on it.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// Name of the turbine.
    pub turbine: &'a str,
    /// Sense and Strouhal number of the helix of the nearest turbine upstream that has one.
    pub upstream: Option<(Sense, f64)>,
    /// Duration of the run (s).
    pub duration: f64,
    /// The turbine's further sensors.
    pub sensors: &'a [FurtherSensor<'a>],
}

impl Place<'_> {
    /// The further sensor called `name`; none where the turbine has none of that name.
    pub fn sensor(&self, name: &str) -> Option<&FurtherSensor<'_>> {
        self.sensors.iter().find(|sensor| sensor.name == name)
    }
}

/// A further sensor of a turbine, as the case has it.
#[derive(Clone, Copy, Debug)]
pub struct FurtherSensor<'a> {
    /// Its name: readings go by it.
    pub name: &'a str,
    /// Name of its kind.
    pub kind: &'a str,
    /// What its keys hold.
    pub values: &'a Values,
}

/// What a controller is built for.
#[derive(Clone, Copy, Debug)]
pub struct Site<'a> {
    /// Constants of the turbine's torque and pitch control.
    pub constants: &'a Constants,
    /// The machine, as estimators model it.
    pub rotor: &'a Arc<Definition>,
    /// Power and thrust coefficient of a machine, for controllers that must know them; takes a fraction of a
    /// second.
    pub coefficients: fn(&Definition) -> CoefficientTable,
    /// Mean speed at hub height of the first turbine (m/s): Strouhal numbers are taken with it.
    pub wind_speed: f64,
    /// Rotor diameter of the first turbine (m), likewise.
    pub diameter: f64,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// Control interval (s).
    pub interval: f64,
    /// Duration of the run (s).
    pub duration: f64,
    /// Whether the flow resolves the rotor's induction; otherwise momentum theory makes it, with the blades.
    pub flow_resolves_induction: bool,
}

impl Site<'_> {
    /// Excitation rate (rad/s) of `strouhal` (–).
    pub fn rate(&self, strouhal: f64) -> f64 {
        excitation_rate(strouhal, self.wind_speed, self.diameter)
    }

    /// Greedy control of the turbine, on top of which excitations go.
    pub fn baseline(&self) -> Box<dyn Controller> {
        Box::new(Baseline::new(self.constants.clone()))
    }
}

/// How a periodic pitch moves the blades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Each blade on its own: periodic in the fixed frame.
    Cyclic,
    /// All blades alike.
    Collective,
}

/// A periodic pitch of constant amplitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pitching {
    /// How it moves the blades.
    pub motion: Motion,
    /// Amplitude of a blade's pitch (rad).
    pub amplitude: f64,
    /// Strouhal number (–).
    pub strouhal: f64,
    /// Which way the helix winds; none of a collective pitch.
    pub sense: Option<Sense>,
    /// Lead of the pitch over the helix in the wind that it joins (rad); none where it joins none.
    pub phase_offset: Option<f64>,
    /// Time at which it fades in (s).
    pub start: f64,
    /// Time at which it fades out (s); never when absent.
    pub stop: Option<f64>,
    /// Whether its phase is steady; a phase that follows the wind spreads the line, so that less of it is one
    /// line.
    pub is_steady: bool,
}

impl Pitching {
    /// What `values` with the usual keys describe where the phase follows from time alone.
    pub(crate) fn open_loop(values: &Values, motion: Motion, sense: Option<Sense>) -> Self {
        Self {
            motion,
            amplitude: values.angle("amplitude_deg"),
            strouhal: values.number("strouhal"),
            sense,
            phase_offset: None,
            start: values.number("start"),
            stop: values.optional_number("stop"),
            is_steady: true,
        }
    }
}

/// A pitch-response identification before the runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Identification {
    /// How cyclic pitch acts on tilt and yaw moment, in the middle of a range of Strouhal numbers (–).
    Loads {
        /// Lowest and highest.
        strouhal: [f64; 2],
    },
    /// Azimuth offset, and calibration of the estimator, of a turbine that joins a helix.
    OwnPitch(PhaseSyncSettings),
}

/// What runs on a turbine: a kind of controller with its values.
#[derive(Clone)]
pub struct Control {
    kind: &'static dyn ControllerKind,
    values: Values,
    /// What was found of how the turbine's pitch acts, before the runs.
    pub response: Option<PitchResponse>,
    /// Who opens the shared library that it runs; a study sets it where there is one.
    pub libraries: Option<Arc<dyn Libraries>>,
    /// The linear control laws that it runs; a study reads them where there are some.
    pub linear_laws: Option<Arc<LinearLaws>>,
}

impl Control {
    /// `kind` with `values` as they were read and checked.
    pub fn checked(kind: &'static dyn ControllerKind, values: Values) -> Self {
        let values = values.in_order_of(kind.table());
        Self { kind, values, response: None, libraries: None, linear_laws: None }
    }

    /// `kind` with the values `given`, in the units of the case file; the others have their defaults.
    ///
    /// ```
    /// let helix = control::Control::new(
    ///     &control::helix::HELIX,
    ///     &[("sense", "ccw".into()), ("amplitude_deg", 4.0.into()), ("strouhal", 0.25.into())],
    /// )?;
    /// assert_eq!(helix.values().number("start"), 0.0);
    /// # Ok::<(), control::ControlError>(())
    /// ```
    ///
    /// # Errors
    /// [`ControlError::Key`] for a key that the kind does not have, a value that it cannot hold, and one that
    /// is missing.
    pub fn new(
        kind: &'static dyn ControllerKind,
        given: &[(&str, Value)],
    ) -> Result<Self, ControlError> {
        let table = kind.table();
        let refuse = |key: &str, value: Option<&Value>, about: String| ControlError::Key {
            heading: table.heading,
            key: key.to_owned(),
            value: value.cloned(),
            about,
        };
        let names = || table.keys.iter().map(|key| key.name).collect::<Vec<_>>().join(", ");
        for (name, value) in given {
            if !table.keys.iter().any(|key| key.name == *name) {
                return Err(refuse(name, Some(value), format!("it knows {}", names())));
            }
        }
        let mut values = Values::default();
        for key in table.keys {
            match given.iter().find(|(name, _)| *name == key.name) {
                Some((_, value)) if key.holds.accepts(value) => values.set(key.name, value.clone()),
                Some((_, value)) => {
                    return Err(refuse(key.name, Some(value), key.about.to_owned()));
                }
                None if matches!(key.left_out, LeftOut::Required) => {
                    return Err(refuse(key.name, None, format!("add it: {}", key.about)));
                }
                None => values.extend(key.default()),
            }
        }
        Ok(Self::checked(kind, values))
    }

    /// Greedy control, nothing on top.
    pub fn baseline() -> Self {
        Self::checked(&crate::baseline::BASELINE, Values::default())
    }

    /// The turbine is not there.
    pub fn absent() -> Self {
        Self::checked(&crate::ABSENT, Values::default())
    }

    /// What kind of controller it is.
    pub fn kind(&self) -> &'static dyn ControllerKind {
        self.kind
    }

    /// What its keys hold, in the units of the case file.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// Whether it is of `kind`.
    pub fn is(&self, kind: &dyn ControllerKind) -> bool {
        self.kind.name() == kind.name()
    }

    /// Whether the turbine is there.
    pub fn is_there(&self) -> bool {
        self.kind.is_there()
    }

    /// Sense and Strouhal number (–) of the helix that it makes, or joins.
    pub fn helix(&self) -> Option<(Sense, f64)> {
        self.kind.helix(self)
    }

    /// What runs on the turbine at `site`.
    ///
    /// # Errors
    /// [`ControlError`] for a controller that cannot be built.
    pub fn build(&self, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        self.kind.build(self, site)
    }
}

impl fmt::Debug for Control {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, values, response, .. } = self;
        write!(formatter, "{} {values:?} {response:?}", kind.name())
    }
}

impl PartialEq for Control {
    fn eq(&self, other: &Self) -> bool {
        self.is(other.kind) && self.values == other.values && self.response == other.response
    }
}
