//! HelixOptions of the helix estimator, with its two presets.

use super::wave::Form;
use crate::EstimationError;
use serde::{Deserialize, Serialize};

/// Innovations beyond this many standard deviations have less weight in the robust form (–).
const HUBER_LIMIT: f64 = 3.0;

/// Choices; [`HelixOptions::default`] is the robust form, [`HelixOptions::published`] that of the authors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HelixOptions {
    /// States of the wave.
    pub form: Form,
    /// Rotor model of the filter.
    pub rotor: Rotor,
    /// Noise model of the filter.
    pub noise: Noise,
    /// Constant tilt and yaw outside the model, as of shear, gravity and shaft tilt: their process noise
    /// intensity ((m/s)²/s); none without such states.
    pub bias: Option<f64>,
    /// Tilt and yaw of passing eddies; none without such states. With them the process noise intensity of the
    /// wave scales with their adapted variance.
    pub eddies: Option<Eddies>,
    /// Initial uncertainty of the model's response to the rotor's own pitch (–, a standard deviation over the
    /// wind equivalent of the pitch), with states that estimate it as the pitch begins or changes; none
    /// without such states.
    pub response: Option<f64>,
    /// Uncertainty of the model's response to the rotor's own pitch in the confidence of the phases (–, a
    /// standard deviation over the wind equivalent of the pitch). It does not decrease with time, as the
    /// effect of noise does, and it changes no estimate.
    pub model_uncertainty: f64,
    /// Process noise intensity of the excitation rate ((rad/s)²/s); none where the rate is taken to be the
    /// nominal one.
    pub rate: Option<f64>,
    /// Adaptation of the noise to the innovation; none for constant noise.
    pub adaptation: Option<Adaptation>,
    /// Innovations beyond this many standard deviations (–) have less weight, after Huber; none where all
    /// have their full weight.
    pub huber_limit: Option<f64>,
    /// Correlation of the process noise of tilt and yaw (–, 0 to below 1): one would be a helix that stays
    /// round.
    pub roundness: f64,
    /// Method for the Jacobian.
    pub jacobian: Jacobian,
    /// Control instants from one update to the next (–).
    pub update_every: usize,
}

/// Rotor model of the filter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rotor {
    /// Model of its wake.
    pub wake: Wake,
    /// Whether its blades bend: first flapwise mode, with aerodynamic damping.
    pub flexible: bool,
    /// Whether its blades have weight: gravity and centrifugal force at their roots.
    pub weight: bool,
    /// Factor on tilt and yaw of the pitch (–): the blades' response to it over the model's.
    pub pitch_gain: f64,
    /// Angle by which a blade leads its pitch (rad): the pitch that acts is the one measured this part of a
    /// turn before. For lags outside the models of wake and bending.
    pub pitch_azimuth_offset: f64,
    /// Age of the moments when they are read (s): delay of the instruments, or half a step of a simulation.
    pub reading_delay: f64,
}

/// Dynamics of the wake's induction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Wake {
    /// Quasi-steady: blade-element momentum at every instant.
    Static,
    /// Dynamic inflow of Snel and Schepers, time constant times `time_factor` (–), in the rotating frame of
    /// each blade.
    WithBlades {
        /// Factor on the model's time constant (–).
        time_factor: f64,
    },
    /// Dynamic inflow of Øye with two time constants that follow wind and induction, in the rotating frame of
    /// each blade.
    TwoConstantWithBlades,
    /// The same dynamic inflow in the non-rotating frame, fixed in space.
    ///
    /// A load that oscillates from side to side of the rotor changes the induction less, and sooner, than one
    /// that changes uniformly (as in Pitt and Peters's inflow, whose tilt and yaw have half the average's
    /// time constant). In records of resolved flow with rotors that pitch a helix in a wind without one, a
    /// factor of 0.4 and a share of 0.6 leave the smallest spurious helix; docs/phase-estimation.md has the
    /// table.
    InAir {
        /// Factor on the model's time constant (–).
        time_factor: f64,
        /// Share of momentum theory's induction caused by a tilt or yaw of the load (–).
        share: f64,
    },
}

/// Noise model of the filter: intensities of continuous white noise (two-sided spectral densities), so that
/// the filter does not depend on how often it is updated. Process noise grows a variance by its intensity
/// times the time that passes; a reading that stands for an interval has the variance of its intensity over
/// that interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Noise {
    /// Measurement noise of one blade's moment.
    pub measurement: Measurement,
    /// Process noise intensity of the mean wind ((m/s)²/s).
    pub mean_wind: f64,
    /// Process noise intensity of amplitudes, or of sine and cosine components ((m/s)²/s).
    pub amplitude: f64,
    /// Process noise intensity of phases (rad²/s).
    pub phase: f64,
    /// Initial standard deviation of the amplitudes (m/s).
    pub initial_amplitude: f64,
}

/// Measurement noise of one blade's moment: the square root of its intensity, which is the standard deviation
/// of its mean over a second. A reading at every Δt seconds has that over √Δt.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Measurement {
    /// In moments (N m √s).
    Moment(f64),
    /// Over the mean of the moment (√s).
    Share(f64),
}

impl Measurement {
    /// Variance (N² m²) of a reading that stands for an `interval` (s), where the mean moment is
    /// `mean_moment` (N m). The only place where measurement noise is made discrete.
    pub(super) fn variance(self, interval: f64, mean_moment: f64) -> f64 {
        let density = match self {
            Self::Moment(density) => density,
            Self::Share(share) => share * mean_moment,
        };
        (density * density / interval).max(f64::MIN_POSITIVE)
    }
}

/// Interval (s) between the readings of the trials from which the default noise comes.
const TRIAL_INTERVAL: f64 = 0.1;
/// Noise of a reading there, over the mean moment (–).
const TRIAL_NOISE: f64 = 0.05;

/// Tilt and yaw of passing eddies: first-order Gauss-Markov noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Eddies {
    /// Standard deviation of each axis (m/s).
    pub deviation: f64,
    /// Correlation time, over rotor diameter over mean wind (–).
    pub time_constant: f64,
}

/// Adaptation of the noise to the innovation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Adaptation {
    /// Time constant of the adaptation (s).
    pub time_constant: f64,
    /// Largest factor on the standard deviations of noise and eddies, up and down (–).
    pub bound: f64,
    /// Whether the process noise intensity of the wave is adapted too.
    pub wave: bool,
}

impl Adaptation {
    /// That of the robust form.
    pub const USUAL: Self = Self { time_constant: 200.0, bound: 5.0, wave: false };
}

/// Method for the derivatives of the moments by the states.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Jacobian {
    /// Chain rule: one derivative per blade, from its sections' polars.
    Analytic,
    /// Central differences of the whole model, each state varied by a `step` (m/s or rad).
    CentralDifferences {
        /// Distance of the two trials (m/s or rad).
        step: f64,
    },
}

impl Default for HelixOptions {
    fn default() -> Self {
        Self {
            form: Form::Quadrature,
            rotor: Rotor {
                wake: Wake::InAir { time_factor: 0.4, share: 0.6 },
                flexible: true,
                weight: true,
                pitch_gain: 1.0,
                pitch_azimuth_offset: 0.0,
                reading_delay: 0.0,
            },
            noise: Noise {
                measurement: Measurement::Share(TRIAL_NOISE * TRIAL_INTERVAL.sqrt()),
                mean_wind: 0.02,
                amplitude: 8e-4,
                phase: 1e-3,
                initial_amplitude: 1.5,
            },
            bias: Some(1e-5),
            eddies: Some(Eddies { deviation: 0.6, time_constant: 0.5 }),
            response: None,
            model_uncertainty: 0.03,
            rate: None,
            adaptation: Some(Adaptation::USUAL),
            huber_limit: Some(HUBER_LIMIT),
            roundness: 0.7,
            jacobian: Jacobian::Analytic,
            update_every: 1,
        }
    }
}

impl HelixOptions {
    /// The form of van Vondelen et al. (2025): mean wind, one amplitude, two phases; a wake with delay; stiff
    /// blades without weight; fixed noise, all innovations with their full weight; slopes by central
    /// differences.
    ///
    /// The paper gives the model an azimuth offset of the pitch, identified for its turbine (§2.4): with
    /// [`HelixOptions::with_azimuth_offset`].
    ///
    /// The paper gives no numbers for its noise; with these the filter converges within about two periods on
    /// its own model. [`tuning`](super::tuning) finds others from records.
    pub fn published() -> Self {
        Self {
            form: Form::SharedAmplitude,
            rotor: Rotor {
                wake: Wake::WithBlades { time_factor: 1.0 },
                flexible: false,
                weight: false,
                pitch_gain: 1.0,
                pitch_azimuth_offset: 0.0,
                reading_delay: 0.0,
            },
            noise: Noise {
                measurement: Measurement::Share(TRIAL_NOISE * TRIAL_INTERVAL.sqrt()),
                mean_wind: 0.02,
                amplitude: 1e-4,
                phase: 1e-4,
                initial_amplitude: 0.5,
            },
            bias: None,
            eddies: None,
            response: None,
            model_uncertainty: 0.03,
            rate: None,
            adaptation: None,
            huber_limit: None,
            roundness: 0.0,
            jacobian: Jacobian::CentralDifferences { step: 1e-5 },
            update_every: 1,
        }
    }

    /// The same with a pitch that acts `offset` (rad) of a turn after it is measured.
    pub fn with_azimuth_offset(self, offset: f64) -> Self {
        Self { rotor: Rotor { pitch_azimuth_offset: offset, ..self.rotor }, ..self }
    }

    /// # Errors
    /// [`EstimationError`] names what cannot be used.
    pub(super) fn check(&self) -> Result<(), EstimationError> {
        self.check_process()?;
        self.check_rotor()?;
        if let Jacobian::CentralDifferences { step } = self.jacobian {
            within("step of the differences", step, (1e-9..1.0).contains(&step), "from 1e-9 to 1")?;
        }
        let every = self.update_every as f64;
        within("control instants from update to update (–)", every, every >= 1.0, "1 or more")
    }

    /// That the noise and the eddies make a filter.
    fn check_process(&self) -> Result<(), EstimationError> {
        let Noise { measurement, mean_wind, amplitude, phase, initial_amplitude } = self.noise;
        let (Measurement::Moment(noise) | Measurement::Share(noise)) = measurement;
        positive_variance("measurement", "root of the intensity for a moment", noise)?;
        positive_variance("process", "intensity for the mean wind", mean_wind)?;
        positive_variance("process", "intensity for the amplitudes", amplitude)?;
        if self.form != Form::Quadrature {
            positive_variance("process", "intensity for the phases", phase)?;
        }
        positive("initial standard deviation of the amplitudes (m/s)", initial_amplitude)?;
        if let Some(bias) = self.bias {
            positive_variance("process", "intensity for the constant tilt and yaw", bias)?;
        }
        if let Some(rate) = self.rate {
            positive_variance("process", "intensity for the excitation rate", rate)?;
        }
        if let Some(Eddies { deviation, time_constant }) = self.eddies {
            positive_variance("process", "standard deviation of the eddies", deviation)?;
            positive("time constant of the eddies (–)", time_constant)?;
        }
        if let Some(Adaptation { time_constant, bound, .. }) = self.adaptation {
            positive("time constant of the adaptation (s)", time_constant)?;
            within("bound of the adaptation (–)", bound, bound >= 1.0, "1 or more")?;
        }
        if let Some(limit) = self.huber_limit {
            positive("standard deviations from which innovations have less weight (–)", limit)?;
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
        Ok(())
    }

    /// That the wake and the pitch are those of a rotor.
    fn check_rotor(&self) -> Result<(), EstimationError> {
        if let Wake::WithBlades { time_factor } | Wake::InAir { time_factor, .. } = self.rotor.wake
        {
            positive("factor on the wake's time constant (–)", time_factor)?;
        }
        if let Wake::InAir { share, .. } = self.rotor.wake {
            let good = (0.0..=1.5).contains(&share);
            within("share of the induction (–)", share, good, "from 0 to 1.5")?;
        }
        let sane = (0.0..1.0).contains(&self.model_uncertainty);
        within(
            "model uncertainty of the pitch response (–)",
            self.model_uncertainty,
            sane,
            "from 0 to below 1",
        )?;
        if let Some(response) = self.response {
            positive_variance(
                "process",
                "initial standard deviation of the pitch response",
                response,
            )?;
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
        within("azimuth offset of the pitch (rad)", offset, offset.is_finite(), "a finite number")
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
