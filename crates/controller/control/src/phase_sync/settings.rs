//! `kind = "phase-sync"`: its keys, and what they say.

use super::TRUST;
use super::choices::EstimatorChoices;
use crate::keys::{BASE, PHASE_RANGE, START, sense};
use crate::kind::{Control, Site};
use basis::Sense;
use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Table, above, from, key};
use basis::records::PitchResponse;
use estimation::helix::{Calibration, HelixOptions, HelixSettings, Measurement, Wake};

pub(super) static TABLE: Table = Table {
    heading: "control.T2 = { kind = \"phase-sync\", … }",
    about: "A helix synchronised with the one from upstream: the phase is estimated from the blade loads, and the pitch follows it with an offset.",
    keys: &[
        key(
            "offset_deg",
            from(-3600.0, 3600.0),
            "deg",
            Required,
            "Lead of the pitch over the wind that meets the rotor, 0 to 360. 0: pitch rises where the wind does and takes load off; 180: it falls where the wind rises and adds load. Other angles are turned into the circle, with a warning.",
        ),
        key(
            "amplitude_deg",
            from(0.0, 10.0),
            "deg",
            Required,
            "Pitch amplitude of a blade; 0 is the baseline, bit for bit, with the estimate in the series.",
        ),
        key(
            "sense",
            Holds::Choice(&["cw", "ccw"]),
            "",
            Otherwise("that of the nearest turbine upstream with a helix"),
            "Sense of the helix that it joins.",
        ),
        key(
            "strouhal",
            above(0.0, 2.0),
            "–",
            Otherwise("that of the nearest turbine upstream with a helix"),
            "Strouhal number of the helix that it joins, with `wind.speed` and the diameter of the first turbine.",
        ),
        key(
            "azimuth_offset_deg",
            PHASE_RANGE,
            "deg",
            Otherwise(
                "identified before the runs, by a helix of a degree in either sense in prescribed wind",
            ),
            "Azimuth offset ψ of the inverse multi-blade transformation, with which tilt pitch changes the tilt moment alone; 0 with `amplitude_deg = 0`. At one frequency the blades pitch with it as with none and an `offset_deg` greater (`ccw`) or less (`cw`) by ψ.",
        ),
        key(
            "estimator",
            Holds::Choice(&["robust", "published", "published-with-offset"]),
            "",
            Value("\"robust\""),
            "`robust`: extended Kalman filter with states for shear, eddies and other model errors. `published`: the four states of van Vondelen et al. (2025), on stiff blades without weight. `published-with-offset`: the same, whose model takes the pitch to act with the azimuth offset ψ, as the paper has it.",
        ),
        key(
            "preview",
            Holds::Name,
            "",
            Otherwise("none: the phase is found in the blade loads alone"),
            "The turbine's lidar that looks upwind, by its name in `sensors`: the phase of the wind that it sees is known before it arrives, and found without lag. It must see the wind half a period of the helix ahead, D/(2 St) in the free wind, less in a wake as that is slower; the summary says by how much it falls short. Where the lidar is blind, the blade loads tell, faded.",
        ),
        key(
            "preview_speed_factor",
            from(0.3, 3.0),
            "–",
            Otherwise("1 with a `preview`"),
            "Speed at which the helix travels, over that of the free wind as the scan shows it, whose points count with the square of their distance from the axis. A percent turns the phase by a percent of the time of travel.",
        ),
        key(
            "fallback",
            Holds::Choice(&["baseline", "none"]),
            "",
            Value("\"baseline\""),
            "What it does where the estimate cannot be trusted. `baseline`: it fades out, and comes back with the helix. `none`: it keeps pitching.",
        ),
        key(
            "measurement_noise_1s_mnm",
            above(0.0, 1e4),
            "MN m",
            Otherwise("1.6 % of the mean moment, which are 5 % for a reading every 0.1 s"),
            "Noise in a blade's moment that the estimator assumes: the standard deviation of its mean over a second, root of its intensity. A reading every Δt seconds has that over √Δt. `wakemix analyse tune` finds it, and process noise intensities, on the records of a run.",
        ),
        key(
            "process_noise_mean_wind",
            above(0.0, 1e6),
            "m²/s³",
            Otherwise("0.02"),
            "Process noise intensity of the mean wind in the estimator, a variance per time, (m/s)²/s.",
        ),
        key(
            "process_noise_amplitude",
            above(0.0, 1e6),
            "m²/s³",
            Otherwise("8e-4; 1e-4 with a published estimator"),
            "Process noise intensity of the helix's amplitude in the estimator, a variance per time, (m/s)²/s; with `robust` of each of its sine and cosine components.",
        )
        .formerly(&["wandering_amplitude"]),
        key(
            "process_noise_phase",
            above(0.0, 1e6),
            "rad²/s",
            Otherwise("1e-4; only with a published estimator"),
            "Process noise intensity of each phase in the estimator, a variance per time.",
        )
        .formerly(&["wandering_phase"]),
        key(
            "process_noise_rate",
            above(0.0, 1.0),
            "rad²/s³",
            Otherwise("the excitation rate is taken to be the nominal one"),
            "Makes the excitation rate a state of the estimator, with this process noise intensity, a variance per time, (rad/s)²/s; 1e-9 follows a rate that is some percent off.",
        ),
        key(
            "adaptation",
            Holds::Choice(&["none", "noise", "noise-and-wave"]),
            "",
            Otherwise("\"noise\"; \"none\" with a published estimator"),
            "What the estimator adapts to its innovation: nothing; the noise of moments and eddies; the process noise of the wave too.",
        ),
        key(
            "amplitudes",
            Holds::Choice(&["shared", "separate"]),
            "",
            Otherwise("\"shared\"; only with a published estimator"),
            "Whether tilt and yaw of the helix share an amplitude in the estimator, or each has its own; the components of `robust` are each axis' own.",
        ),
        key(
            "dynamic_inflow",
            Holds::Choice(&["snel-schepers", "two-constant"]),
            "",
            Otherwise("\"snel-schepers\""),
            "Delay of the wake in the estimator's model. `snel-schepers`: with the inertia of the air. `two-constant`: with two time constants, after Øye; it turns with the blades in a resolved flow too.",
        ),
        key(
            "wake_time_factor",
            above(0.0, 10.0),
            "–",
            Otherwise("0.4 with `robust` in a resolved flow, else 1"),
            "Factor on the time constant of Snel and Schepers's delay in the estimator's model.",
        ),
        START,
        BASE[0],
        BASE[1],
        BASE[2],
        BASE[3],
        BASE[4],
    ],
};

/// Newton metres of a meganewton metre.
const MEGA: f64 = 1e6;

/// Settings of a turbine that joins the helix that comes from upstream.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseSyncSettings {
    /// Sense of the helix that it joins.
    pub sense: Sense,
    /// Pitch amplitude (rad); 0 is the baseline that only estimates.
    pub amplitude: f64,
    /// Strouhal number of the helix that it joins (–).
    pub strouhal: f64,
    /// Lead of the pitch over the wind that meets the rotor (rad, any turn).
    pub offset: f64,
    /// Azimuth offset of the inverse multi-blade transformation (rad); found before the runs when absent.
    pub azimuth_offset: Option<f64>,
    /// Time at which it fades in (s).
    pub start: f64,
    /// What finds the phase.
    pub estimator: PhaseEstimator,
    /// Whether it fades to the baseline where the estimate cannot be trusted.
    pub fallback: bool,
    /// Noise that the estimator assumes.
    pub noise: PhaseNoise,
    /// What else of it is chosen.
    pub choices: EstimatorChoices,
    /// What the estimator makes of the turbine's own pitch; found before the runs.
    pub calibration: Option<Calibration>,
}

impl PhaseSyncSettings {
    /// What `control` says, and what was found before the runs; none where it is of another kind.
    pub fn of(control: &Control) -> Option<Self> {
        if !control.is(&super::PHASE_SYNC) {
            return None;
        }
        let values = control.values();
        let amplitude = values.angle("amplitude_deg");
        let given = values.optional_number("azimuth_offset_deg").map(f64::to_radians);
        Some(Self {
            sense: sense(values),
            amplitude,
            strouhal: values.number("strouhal"),
            offset: values.angle("offset_deg"),
            // Nothing is pitched at amplitude zero, with whatever offset.
            azimuth_offset: given
                .or(control.response.as_ref().and_then(azimuth_offset_of))
                .or((amplitude == 0.0).then_some(0.0)),
            start: values.number("start"),
            estimator: match values.word("estimator") {
                "published" => PhaseEstimator::Published,
                "published-with-offset" => PhaseEstimator::PublishedWithOffset,
                _ => PhaseEstimator::Robust,
            },
            fallback: values.word("fallback") != "none",
            noise: PhaseNoise {
                measurement: values.optional_number("measurement_noise_1s_mnm").map(|n| n * MEGA),
                process_noise_mean_wind: values.optional_number("process_noise_mean_wind"),
                process_noise_amplitude: values.optional_number("process_noise_amplitude"),
                process_noise_phase: values.optional_number("process_noise_phase"),
            },
            choices: EstimatorChoices::of(values),
            calibration: control.response.as_ref().and_then(calibration_of),
        })
    }

    /// What its estimator is set to at `site`.
    pub fn estimator_setting(&self, site: &Site) -> HelixSettings {
        HelixSettings {
            sense: self.sense,
            rate: site.rate(self.strouhal),
            interval: site.interval,
            air_density: site.air_density,
            n_elements: HelixSettings::N_ELEMENTS,
        }
    }

    /// Choices of its estimator with its own noise, before calibration; the published one with the azimuth
    /// offset as far as it is known.
    pub fn estimator_options(&self, flow_resolves_induction: bool) -> HelixOptions {
        let options = self.estimator.options(flow_resolves_induction);
        let options = self.noise.apply(self.choices.apply(options));
        match (self.estimator, self.azimuth_offset) {
            (PhaseEstimator::PublishedWithOffset, Some(offset)) => {
                options.with_azimuth_offset(offset)
            }
            _ => options,
        }
    }

    /// Trust below which the excitation fades out, and above which it comes back (–).
    pub(super) fn trust(&self) -> Option<[f64; 2]> {
        self.fallback.then_some(TRUST)
    }
}

/// Noise that a phase estimator assumes; what is absent stays as the estimator has it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PhaseNoise {
    /// Standard deviation of one blade's moment over a second (N m √s).
    pub measurement: Option<f64>,
    /// Process noise intensity of the mean wind ((m/s)²/s).
    pub process_noise_mean_wind: Option<f64>,
    /// Process noise intensity of amplitudes, or of sine and cosine components ((m/s)²/s).
    pub process_noise_amplitude: Option<f64>,
    /// Process noise intensity of phases (rad²/s).
    pub process_noise_phase: Option<f64>,
}

impl PhaseNoise {
    /// `options` with this noise.
    pub fn apply(&self, options: HelixOptions) -> HelixOptions {
        let mut options = options;
        let noise = &mut options.noise;
        noise.measurement = self.measurement.map_or(noise.measurement, Measurement::Moment);
        noise.mean_wind = self.process_noise_mean_wind.unwrap_or(noise.mean_wind);
        noise.amplitude = self.process_noise_amplitude.unwrap_or(noise.amplitude);
        noise.phase = self.process_noise_phase.unwrap_or(noise.phase);
        options
    }
}

/// What finds the phase of a helix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhaseEstimator {
    /// The extended Kalman filter with states for what its model lacks.
    Robust,
    /// The extended Kalman filter as it was published, without the azimuth offset of its model.
    Published,
    /// The same with the azimuth offset of the transformation in its model.
    PublishedWithOffset,
}

impl PhaseEstimator {
    /// Its choices, before calibration, with the noise that it comes with.
    pub fn options(self, flow_resolves_induction: bool) -> HelixOptions {
        match self {
            Self::Robust if !flow_resolves_induction => {
                // Momentum theory keeps the wake's delay with the blade, a resolved flow where the blade has
                // passed.
                let mut options = HelixOptions::default();
                options.rotor.wake = Wake::WithBlades { time_factor: 1.0 };
                options
            }
            Self::Robust => HelixOptions::default(),
            Self::Published | Self::PublishedWithOffset => HelixOptions::published(),
        }
    }
}

/// The calibration of an estimator in `response`.
pub fn calibration_of(response: &PitchResponse) -> Option<Calibration> {
    match *response {
        PitchResponse::Estimator { gain, azimuth_offset, before, after, .. } => {
            Some(Calibration { gain, azimuth_offset, before, after })
        }
        PitchResponse::Transformation { .. }
        | PitchResponse::IndividualPitch { .. }
        | PitchResponse::Loads { .. } => None,
    }
}

/// The azimuth offset (rad) in `response` with which a turbine that joins a helix pitches.
pub fn azimuth_offset_of(response: &PitchResponse) -> Option<f64> {
    match *response {
        PitchResponse::Estimator { transformation_offset, .. } => transformation_offset,
        PitchResponse::Transformation { azimuth_offset } => Some(azimuth_offset),
        PitchResponse::IndividualPitch { .. } | PitchResponse::Loads { .. } => None,
    }
}

/// The record of an `azimuth_offset` (rad) of the transformation and of what was found with it.
pub fn response_of(azimuth_offset: f64, calibration: Option<Calibration>) -> PitchResponse {
    let transformation_offset = Some(azimuth_offset);
    match calibration {
        None => PitchResponse::Transformation { azimuth_offset },
        Some(Calibration { gain, azimuth_offset, before, after }) => {
            PitchResponse::Estimator { gain, azimuth_offset, before, after, transformation_offset }
        }
    }
}
