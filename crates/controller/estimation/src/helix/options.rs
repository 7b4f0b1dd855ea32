//! What can be chosen about the helix estimator, and its two ready-made choices.

use super::wave::Form;
use crate::EstimationError;
use serde::{Deserialize, Serialize};

/// Choices; [`Options::default`] is the robust form, [`Options::published`] that of the authors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// What the states of the wave are.
    pub form: Form,
    /// The rotor that the filter believes in.
    pub rotor: Rotor,
    /// Noise that the filter believes in.
    pub noise: Noise,
    /// Lasting tilt and yaw that the model knows nothing of, as shear, gravity and the shaft's tilt make: how fast they
    /// wander ((m/s)²/s, a variance per time); none without such states.
    pub bias: Option<f64>,
    /// Tilt and yaw of passing eddies; none without such states. With them the wave's wandering grows and falls with their
    /// variance as it is learnt.
    pub eddies: Option<Eddies>,
    /// How wrong the model's answer to the rotor's own pitch may be at first (–, a standard deviation over the wind that the
    /// pitch is worth), learnt as the pitch begins or changes; none where the model is believed.
    pub response: Option<f64>,
    /// How wrong the model's answer to the rotor's own pitch is taken to be when trust is judged (–, a standard deviation over
    /// the wind that the pitch is worth): it does not shrink with time, as what noise does, and changes no estimate.
    pub doubt: f64,
    /// How fast the excitation rate wanders ((rad/s)²/s); none where it is taken to be the nominal one.
    pub rate: Option<f64>,
    /// Noise learnt from the innovation; none where it stays as it is.
    pub adaptation: Option<Adaptation>,
    /// Correlation of what comes in on tilt and on yaw (–, 0 to below 1): one would be a helix that stays round.
    pub roundness: f64,
    /// How slopes are found.
    pub jacobian: Jacobian,
    /// Control instants from one update to the next (–).
    pub update_every: usize,
}

/// The rotor that the filter believes in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rotor {
    /// How its wake answers.
    pub wake: Wake,
    /// Whether its blades bend: first flapwise mode, with the air's damping.
    pub flexible: bool,
    /// Factor on tilt and yaw of the pitch (–): what the blades make of it over what the model makes of it.
    pub pitch_gain: f64,
    /// Angle by which a blade runs ahead of its pitch (rad): the pitch that acts is that measured this much of a turn
    /// before. For lags that neither the wake nor the blades' bending make.
    pub pitch_azimuth_offset: f64,
    /// Age of the moments when they are read (s): lag of the instruments, or half a step of a simulation.
    pub reading_delay: f64,
}

/// How the wake's induction answers to a change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Wake {
    /// At once: blade-element momentum at every instant.
    Static,
    /// With the delay of Snel and Schepers times `time_factor` (–), which runs with each blade.
    WithBlades {
        /// Factor on the model's time constant (–).
        time_factor: f64,
    },
    /// With the same delay, which runs in the air that the blades cross.
    ///
    /// A load that swings from side to side of the rotor moves less induction, and sooner, than one that changes everywhere
    /// alike (as in Pitt and Peters's inflow, whose tilt and yaw have half the average's time constant). In large-eddy
    /// records of rotors that pitch a helix in a wind without one, a factor of 0.4 and a share of 0.6 leave the least helix
    /// that is not there; docs/phase-estimation.md has the table.
    InAir {
        /// Factor on the model's time constant (–).
        time_factor: f64,
        /// Share of momentum theory's induction that a tilt or yaw of the load makes (–).
        share: f64,
    },
}

/// Noise that the filter believes in; variances per time grow with the time between updates.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Of one blade's moment at one instant.
    pub measurement: Measurement,
    /// Wandering of the mean wind ((m/s)²/s).
    pub mean_wind: f64,
    /// Wandering of amplitudes, or of sine and cosine components ((m/s)²/s).
    pub amplitude: f64,
    /// Wandering of phases (rad²/s).
    pub phase: f64,
    /// Standard deviation of what is not known of amplitudes at first (m/s).
    pub initial_amplitude: f64,
}

/// Noise of one blade's moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Measurement {
    /// Standard deviation (N m).
    Moment(f64),
    /// Standard deviation over the mean moment of the moment (–).
    Share(f64),
}

/// Tilt and yaw of passing eddies: noise that forgets itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Eddies {
    /// Standard deviation of each axis (m/s).
    pub deviation: f64,
    /// Time in which they forget themselves, over rotor diameter over mean wind (–).
    pub time_constant: f64,
}

/// Noise learnt from the innovation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptation {
    /// Time over which is learnt (s).
    pub time_constant: f64,
    /// Largest factor on the standard deviations of noise and eddies, up and down (–).
    pub bound: f64,
    /// Whether the wandering of the wave is learnt too.
    pub wave: bool,
}

/// How the slopes of the moments over the states are found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Jacobian {
    /// By the chain rule: one slope per blade, from its sections' polars.
    Analytic,
    /// By central differences over all of the model, each state tried a `step` (m/s or rad) apart.
    CentralDifferences {
        /// Distance of the two trials (m/s or rad).
        step: f64,
    },
}

impl Default for Options {
    fn default() -> Self {
        Self {
            form: Form::Quadrature,
            rotor: Rotor {
                wake: Wake::InAir { time_factor: 0.4, share: 0.6 },
                flexible: true,
                pitch_gain: 1.0,
                pitch_azimuth_offset: 0.0,
                reading_delay: 0.0,
            },
            noise: Noise {
                measurement: Measurement::Share(0.05),
                mean_wind: 0.02,
                amplitude: 8e-4,
                phase: 1e-3,
                initial_amplitude: 1.5,
            },
            bias: Some(1e-5),
            eddies: Some(Eddies { deviation: 0.6, time_constant: 0.5 }),
            response: None,
            doubt: 0.03,
            rate: None,
            adaptation: Some(Adaptation { time_constant: 200.0, bound: 5.0, wave: false }),
            roundness: 0.7,
            jacobian: Jacobian::Analytic,
            update_every: 1,
        }
    }
}

impl Options {
    /// The form of van Vondelen et al. (2025): mean wind, one amplitude, two phases; a wake with delay; fixed noise; slopes
    /// by central differences.
    ///
    /// The paper gives no numbers for its noise; with these the filter converges within about two periods on its own model.
    /// [`tuning`](super::tuning) finds others from records.
    pub fn published() -> Self {
        Self {
            form: Form::SharedAmplitude,
            rotor: Rotor {
                wake: Wake::WithBlades { time_factor: 1.0 },
                flexible: false,
                pitch_gain: 1.0,
                pitch_azimuth_offset: 0.0,
                reading_delay: 0.0,
            },
            noise: Noise {
                measurement: Measurement::Share(0.05),
                mean_wind: 0.02,
                amplitude: 1e-4,
                phase: 1e-4,
                initial_amplitude: 0.5,
            },
            bias: None,
            eddies: None,
            response: None,
            doubt: 0.03,
            rate: None,
            adaptation: None,
            roundness: 0.0,
            jacobian: Jacobian::CentralDifferences { step: 1e-5 },
            update_every: 1,
        }
    }

    /// # Errors
    /// [`EstimationError`] names what cannot be used.
    pub(super) fn check(&self) -> Result<(), EstimationError> {
        let Noise { measurement, mean_wind, amplitude, phase, initial_amplitude } = self.noise;
        let (Measurement::Moment(noise) | Measurement::Share(noise)) = measurement;
        positive_variance("measurement", "standard deviation of a moment", noise)?;
        positive_variance("process", "wandering of the mean wind", mean_wind)?;
        positive_variance("process", "wandering of the amplitudes", amplitude)?;
        if self.form != Form::Quadrature {
            positive_variance("process", "wandering of the phases", phase)?;
        }
        positive("initial deviation of the amplitudes (m/s)", initial_amplitude)?;
        if let Some(bias) = self.bias {
            positive_variance("process", "wandering of the bias", bias)?;
        }
        if let Some(rate) = self.rate {
            positive_variance("process", "wandering of the excitation rate", rate)?;
        }
        if let Some(Eddies { deviation, time_constant }) = self.eddies {
            positive_variance("process", "standard deviation of the eddies", deviation)?;
            positive("time constant of the eddies (–)", time_constant)?;
        }
        if let Some(Adaptation { time_constant, bound, .. }) = self.adaptation {
            positive("time constant of the adaptation (s)", time_constant)?;
            within("bound of the adaptation (–)", bound, bound >= 1.0, "1 or more")?;
        }
        let round = (0.0..1.0).contains(&self.roundness);
        if !round {
            let (name, entry) = ("process", "1 − roundness²");
            let value = 1.0 - self.roundness * self.roundness;
            if self.roundness.is_finite() && value <= 0.0 {
                return Err(EstimationError::NotPositiveDefinite { name, entry, value });
            }
            within("roundness (–)", self.roundness, false, "from 0 to below 1")?;
        }
        if let Wake::WithBlades { time_factor } | Wake::InAir { time_factor, .. } = self.rotor.wake
        {
            positive("factor on the wake's time constant (–)", time_factor)?;
        }
        if let Wake::InAir { share, .. } = self.rotor.wake {
            let good = (0.0..=1.5).contains(&share);
            within("share of the induction (–)", share, good, "from 0 to 1.5")?;
        }
        let sane = (0.0..1.0).contains(&self.doubt);
        within("doubt of the pitch's effect (–)", self.doubt, sane, "from 0 to below 1")?;
        if let Some(response) = self.response {
            positive_variance("process", "initial deviation of the pitch's effect", response)?;
        }
        let delay = self.rotor.reading_delay;
        within(
            "age of the moments (s)",
            delay,
            (0.0..10.0).contains(&delay),
            "from 0 to below 10",
        )?;
        let offset = self.rotor.pitch_azimuth_offset;
        positive("gain of the pitch (–)", self.rotor.pitch_gain)?;
        within("azimuth offset of the pitch (rad)", offset, offset.is_finite(), "a finite number")?;
        if let Jacobian::CentralDifferences { step } = self.jacobian {
            within("step of the differences", step, (1e-9..1.0).contains(&step), "from 1e-9 to 1")?;
        }
        let every = self.update_every as f64;
        within("control instants from update to update (–)", every, every >= 1.0, "1 or more")
    }
}

pub(super) fn positive(name: &'static str, value: f64) -> Result<(), EstimationError> {
    within(name, value, value.is_finite() && value > 0.0, "above zero")
}

fn within(
    name: &'static str,
    value: f64,
    good: bool,
    expected: &'static str,
) -> Result<(), EstimationError> {
    if good { Ok(()) } else { Err(EstimationError::Setting { name, value, expected }) }
}

fn positive_variance(
    name: &'static str,
    entry: &'static str,
    value: f64,
) -> Result<(), EstimationError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(EstimationError::NotPositiveDefinite { name, entry, value })
    }
}
