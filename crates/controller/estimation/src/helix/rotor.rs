//! The measurement function: from the wind in the fixed frame to the moments at the blade roots.

use super::flap::{Bend, Flap};
use super::options::{self, HelixOptions};
use super::settings::HelixSettings;
use super::weight::Weight;
use basis::mbc::{to_blades, to_fixed_frame};
use basis::{FixedFrame, Measurements, PerBlade, Sense};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use turbine::Definition;
use turbine::actuator_line::ActuatorLine;
use turbine::aero::Induction;
use turbine::aero::blade_element::Theory;
use turbine::aero::blade_moments::{BladeMoments, Conditions, Wake};
use turbine::aero::induction::{SnelSchepers, TwoConstant};

/// Range of the mean wind in the model (m/s).
pub(super) const WINDS: [f64; 2] = [1.0, 50.0];
/// Steps (–), and their length (s), over which the wake settles at the start.
const N_SETTLING: usize = 120;
const SETTLING: f64 = 2.0;
/// Relaxation of the search for the initial wind (–).
const CAUTION: f64 = 0.3;
/// Effective radius of a blade's moment, over the rotor's (–).
const EFFECTIVE_RADIUS: f64 = 0.75;
/// Wind of the initial wake, before the first measurement (m/s).
const NOMINAL_WIND: f64 = 9.0;

/// Parameters.
#[derive(Clone, Debug)]
pub(super) struct Rotor {
    blades: BladeMoments,
    /// None for blades without weight.
    weight: Option<Weight>,
    flap: Option<Flap>,
    /// Share of tilt and yaw of the induction, where it is fixed in space (–).
    in_air: Option<f64>,
    pitch_gain: f64,
    /// Rate of the helix in the blade over the rotor's (rad/s): positive for ccw.
    swing_rate: f64,
    pitch_azimuth_offset: f64,
    reading_delay: f64,
    n_blades: usize,
    radius: f64,
    settled: Wake,
}

/// State of the rotor model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct RotorModelState {
    /// Induction of the blades, or of sectors fixed in space.
    wake: Wake,
}

/// Working memory.
#[derive(Clone, Debug)]
pub(super) struct Memory {
    met: Wake,
}

/// Rotor kinematics at the time of the moments, from the measurements.
#[derive(Clone, Copy, Debug)]
pub(super) struct RotorKinematics {
    pub(super) azimuth: f64,
    pub(super) rotor_speed: f64,
    pub(super) pitch: PerBlade<f64>,
}

/// Expected blade-root moments, with their derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expected {
    /// Moments at the roots (N m).
    pub(super) moments: PerBlade<f64>,
    /// Derivative of the aerodynamic moment on each rigid blade by its wind (N m/(m/s)).
    pub(super) slopes: PerBlade<f64>,
    /// Effect of blade bending on the moments.
    pub(super) bend: Bend,
}

impl Rotor {
    pub(super) fn new(
        definition: &Arc<Definition>,
        settings: &HelixSettings,
        options: &HelixOptions,
    ) -> Self {
        let HelixSettings { n_elements, air_density, .. } = *settings;
        let radius = definition.rotor_radius();
        let line =
            ActuatorLine::new(Arc::clone(definition), n_elements, air_density, 0.1 * radius, 0.0);
        let induction = match options.rotor.wake {
            options::Wake::Static => Induction::QuasiSteady,
            options::Wake::WithBlades { time_factor }
            | options::Wake::InAir { time_factor, .. } => {
                Induction::SnelSchepers(SnelSchepers { time_factor })
            }
            options::Wake::TwoConstantWithBlades => Induction::TwoConstant(TwoConstant::varying()),
        };
        let elements = line.elements();
        let blades =
            BladeMoments::new(definition, elements, induction, Theory::default(), air_density);
        let n_blades = definition.n_blades;
        let settled = blades.settled(&Conditions {
            winds: PerBlade::splat(n_blades, NOMINAL_WIND),
            rotor_speed: 0.8 * definition.rated_rotor_speed,
            pitch: PerBlade::splat(n_blades, 0.0),
        });
        Self {
            weight: options.rotor.weight.then(|| Weight::new(definition)),
            flap: options.rotor.flexible.then(|| Flap::new(definition)),
            in_air: match options.rotor.wake {
                options::Wake::InAir { share, .. } => Some(share),
                _ => None,
            },
            pitch_gain: options.rotor.pitch_gain,
            swing_rate: match settings.sense {
                Sense::CounterClockwise => settings.rate,
                Sense::Clockwise => -settings.rate,
            },
            pitch_azimuth_offset: options.rotor.pitch_azimuth_offset,
            reading_delay: options.rotor.reading_delay,
            n_blades,
            radius,
            settled,
            blades,
        }
    }

    pub(super) fn start(&self) -> RotorModelState {
        RotorModelState { wake: self.settled.clone() }
    }

    pub(super) fn memory(&self) -> Memory {
        Memory { met: self.settled.clone() }
    }

    pub(super) fn n_blades(&self) -> usize {
        self.n_blades
    }

    /// Rotor kinematics at the time of the moments of `measurements`, reading delay included.
    pub(super) fn kinematics(&self, measurements: &Measurements) -> RotorKinematics {
        let azimuth = measurements.azimuth - self.reading_delay * measurements.rotor_speed;
        let untouched =
            self.pitch_gain == 1.0 && self.pitch_azimuth_offset == 0.0 && self.reading_delay == 0.0;
        let pitch = if untouched {
            measurements.pitch
        } else {
            let FixedFrame { average, tilt, yaw } =
                to_fixed_frame(measurements.azimuth, &measurements.pitch);
            let (tilt, yaw) = (self.pitch_gain * tilt, self.pitch_gain * yaw);
            let fixed = FixedFrame { average, tilt, yaw };
            to_blades(azimuth - self.pitch_azimuth_offset, fixed, self.n_blades)
        };
        RotorKinematics { azimuth, rotor_speed: measurements.rotor_speed, pitch }
    }

    /// Approximate wind equivalent of the pitch of `kinematics`, tilt and yaw (m/s): the angle times the
    /// blades' speed at the effective radius.
    pub(super) fn wind_equivalent_of_pitch(&self, kinematics: &RotorKinematics) -> [f64; 2] {
        let fixed = to_fixed_frame(kinematics.azimuth, &kinematics.pitch);
        let speed = EFFECTIVE_RADIUS * self.radius * kinematics.rotor_speed;
        [-speed * fixed.tilt, -speed * fixed.yaw]
    }

    /// Finds the uniform wind (m/s) that gives the `mean_moment` (N m); on return `state` is the steady wake
    /// in it.
    pub(super) fn settle(
        &self,
        mean_moment: f64,
        kinematics: &RotorKinematics,
        state: &mut RotorModelState,
        memory: &mut Memory,
    ) -> f64 {
        let mut wind = NOMINAL_WIND;
        for _ in 0..N_SETTLING {
            let fixed = FixedFrame { average: wind, ..FixedFrame::default() };
            self.move_wake(SETTLING, fixed, kinematics, state, memory);
            let expected = self.still(fixed, kinematics, state, memory);
            let moment = expected.moments.mean();
            let slope = expected.bend.apply(&expected.slopes).mean();
            // The wake's response makes the steady derivative smaller than the immediate one.
            if slope > 0.0 {
                let change = CAUTION * (mean_moment - moment) / slope;
                wind = (wind + change.clamp(-1.0, 1.0)).clamp(WINDS[0], WINDS[1]);
            }
        }
        wind
    }

    /// On return `state` is the steady wake in `wind` (m/s).
    pub(super) fn rest(
        &self,
        wind: FixedFrame,
        kinematics: &RotorKinematics,
        state: &mut RotorModelState,
        memory: &mut Memory,
    ) {
        for _ in 0..N_SETTLING {
            self.move_wake(SETTLING, wind, kinematics, state, memory);
        }
    }

    /// Advances `state` by `interval` (s) to the instant of `kinematics`, at which the fixed frame's wind is
    /// `wind` (m/s); gives the expected moments.
    pub(super) fn advance(
        &self,
        interval: f64,
        wind: FixedFrame,
        kinematics: &RotorKinematics,
        state: &mut RotorModelState,
        memory: &mut Memory,
    ) -> Expected {
        self.move_wake(interval, wind, kinematics, state, memory);
        self.still(wind, kinematics, state, memory)
    }

    /// Moments (N m) in `wind` (m/s) with the wake held, blades bending by `bend`.
    pub(super) fn moments_beside(
        &self,
        wind: FixedFrame,
        kinematics: &RotorKinematics,
        bend: &Bend,
        memory: &Memory,
        state: &RotorModelState,
    ) -> PerBlade<f64> {
        let conditions = self.conditions(wind, kinematics);
        let weight = self.weight_at(kinematics.rotor_speed);
        let moments = self.blades.moments(&conditions, self.met(state, memory));
        bend.apply(&moments.map(|moment| moment + weight))
    }

    /// Expected moments with the wake held.
    fn still(
        &self,
        wind: FixedFrame,
        kinematics: &RotorKinematics,
        state: &RotorModelState,
        memory: &Memory,
    ) -> Expected {
        let conditions = self.conditions(wind, kinematics);
        let (moments, slopes) =
            self.blades.moments_with_slopes(&conditions, self.met(state, memory));
        let RotorKinematics { azimuth, rotor_speed, .. } = *kinematics;
        let bend = match &self.flap {
            Some(flap) => {
                flap.bend(rotor_speed + self.swing_rate, rotor_speed, azimuth, slopes.mean())
            }
            None => Bend::none(azimuth),
        };
        let weight = self.weight_at(rotor_speed);
        Expected { moments: bend.apply(&moments.map(|moment| moment + weight)), slopes, bend }
    }

    /// Moment (N m) of the weight of a blade at `rotor_speed` (rad/s).
    fn weight_at(&self, rotor_speed: f64) -> f64 {
        self.weight.as_ref().map_or(0.0, |weight| weight.moment(rotor_speed))
    }

    fn conditions(&self, wind: FixedFrame, kinematics: &RotorKinematics) -> Conditions {
        Conditions {
            winds: to_blades(kinematics.azimuth, wind, self.n_blades),
            rotor_speed: kinematics.rotor_speed,
            pitch: kinematics.pitch,
        }
    }

    fn met<'a>(&self, state: &'a RotorModelState, memory: &'a Memory) -> &'a Wake {
        if self.in_air.is_some() { &memory.met } else { &state.wake }
    }

    fn move_wake(
        &self,
        interval: f64,
        wind: FixedFrame,
        kinematics: &RotorKinematics,
        state: &mut RotorModelState,
        memory: &mut Memory,
    ) {
        if let Some(share) = self.in_air {
            // Each sector responds to the wind at its azimuth, and to a blade with the pitch of one that
            // passes there.
            let pitch = to_fixed_frame(kinematics.azimuth, &kinematics.pitch);
            let conditions = Conditions {
                winds: to_blades(0.0, wind, self.n_blades),
                rotor_speed: kinematics.rotor_speed,
                pitch: to_blades(0.0, pitch, self.n_blades),
            };
            self.blades.advance(interval, &conditions, &mut state.wake);
            self.blades.meet(&state.wake, kinematics.azimuth, share, &mut memory.met);
        } else {
            self.blades.advance(interval, &self.conditions(wind, kinematics), &mut state.wake);
        }
    }
}
