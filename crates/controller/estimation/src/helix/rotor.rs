//! The measurement function: from the wind in the fixed frame to the moments at the blade roots.

use super::estimator::Setting;
use super::flap::{Bend, Flap};
use super::options::{self, Options};
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
use turbine::aero::induction::SnelSchepers;

/// Least and largest mean wind that the model is asked for (m/s).
pub(super) const WINDS: [f64; 2] = [1.0, 50.0];
/// Steps, and their length (s), in which a wake comes to rest at the start.
const N_SETTLING: usize = 120;
const SETTLING: f64 = 2.0;
/// Share of the way that a step of the search for the first wind goes (–).
const CAUTION: f64 = 0.3;
/// Radius over the rotor's at which most of a blade's moment is made (–).
const EFFECTIVE_RADIUS: f64 = 0.75;
/// Wind in which the wake is laid out before anything has been read (m/s).
const NOMINAL_WIND: f64 = 9.0;

/// Parameters.
#[derive(Clone, Debug)]
pub(super) struct Rotor {
    blades: BladeMoments,
    weight: Weight,
    flap: Option<Flap>,
    /// Share of tilt and yaw of the induction, where sectors of air hold it (–).
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

/// What time changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct State {
    /// Induction of the blades, or of sectors that stand in the air.
    wake: Wake,
}

/// Working memory.
#[derive(Clone, Debug)]
pub(super) struct Memory {
    met: Wake,
}

/// What turns and pitches, as measured, and where it stood when the moments were read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Posture {
    pub(super) azimuth: f64,
    pub(super) rotor_speed: f64,
    pub(super) pitch: PerBlade<f64>,
}

/// What is expected of the blades.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expected {
    /// Moments at the roots (N m).
    pub(super) moments: PerBlade<f64>,
    /// How the moment of the air on each still blade grows with its wind (N m/(m/s)).
    pub(super) slopes: PerBlade<f64>,
    /// What bending makes of the air's moments.
    pub(super) bend: Bend,
}

impl Rotor {
    pub(super) fn new(definition: &Arc<Definition>, setting: &Setting, options: &Options) -> Self {
        let Setting { n_elements, air_density, .. } = *setting;
        let radius = definition.rotor_radius();
        let line =
            ActuatorLine::new(Arc::clone(definition), n_elements, air_density, 0.1 * radius, 0.0);
        let induction = match options.rotor.wake {
            options::Wake::Static => Induction::QuasiSteady,
            options::Wake::WithBlades { time_factor }
            | options::Wake::InAir { time_factor, .. } => {
                Induction::SnelSchepers(SnelSchepers { time_factor })
            }
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
            weight: Weight::new(definition),
            flap: options.rotor.flexible.then(|| Flap::new(definition)),
            in_air: match options.rotor.wake {
                options::Wake::InAir { share, .. } => Some(share),
                _ => None,
            },
            pitch_gain: options.rotor.pitch_gain,
            swing_rate: match setting.sense {
                Sense::CounterClockwise => setting.rate,
                Sense::Clockwise => -setting.rate,
            },
            pitch_azimuth_offset: options.rotor.pitch_azimuth_offset,
            reading_delay: options.rotor.reading_delay,
            n_blades,
            radius,
            settled,
            blades,
        }
    }

    pub(super) fn start(&self) -> State {
        State { wake: self.settled.clone() }
    }

    pub(super) fn memory(&self) -> Memory {
        Memory { met: self.settled.clone() }
    }

    pub(super) fn n_blades(&self) -> usize {
        self.n_blades
    }

    /// How the rotor stood when the moments of `measurements` were made.
    pub(super) fn posture(&self, measurements: &Measurements) -> Posture {
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
        Posture { azimuth, rotor_speed: measurements.rotor_speed, pitch }
    }

    /// Tilt and yaw of the wind (m/s) that the pitch of `posture` is about worth: the angle times the speed of the blades
    /// where most of their moment is made.
    pub(super) fn worth(&self, posture: &Posture) -> [f64; 2] {
        let fixed = to_fixed_frame(posture.azimuth, &posture.pitch);
        let speed = EFFECTIVE_RADIUS * self.radius * posture.rotor_speed;
        [-speed * fixed.tilt, -speed * fixed.yaw]
    }

    /// Finds the uniform wind (m/s) that makes the `mean_moment` (N m); on return `state` has come to rest in it.
    pub(super) fn settle(
        &self,
        mean_moment: f64,
        posture: &Posture,
        state: &mut State,
        memory: &mut Memory,
    ) -> f64 {
        let mut wind = NOMINAL_WIND;
        for _ in 0..N_SETTLING {
            let fixed = FixedFrame { average: wind, ..FixedFrame::default() };
            self.move_wake(SETTLING, fixed, posture, state, memory);
            let expected = self.still(fixed, posture, state, memory);
            let moment = expected.moments.mean();
            let slope = expected.bend.apply(&expected.slopes).mean();
            // The wake's answer makes the lasting slope smaller than the one at once.
            if slope > 0.0 {
                let change = CAUTION * (mean_moment - moment) / slope;
                wind = (wind + change.clamp(-1.0, 1.0)).clamp(WINDS[0], WINDS[1]);
            }
        }
        wind
    }

    /// On return `state` has come to rest in `wind` (m/s).
    pub(super) fn rest(
        &self,
        wind: FixedFrame,
        posture: &Posture,
        state: &mut State,
        memory: &mut Memory,
    ) {
        for _ in 0..N_SETTLING {
            self.move_wake(SETTLING, wind, posture, state, memory);
        }
    }

    /// Moves `state` on by `interval` (s) to the instant of `posture`, at which the fixed frame's wind is `wind` (m/s);
    /// gives what is expected of the blade roots.
    pub(super) fn advance(
        &self,
        interval: f64,
        wind: FixedFrame,
        posture: &Posture,
        state: &mut State,
        memory: &mut Memory,
    ) -> Expected {
        self.move_wake(interval, wind, posture, state, memory);
        self.still(wind, posture, state, memory)
    }

    /// Moments (N m) that `wind` (m/s) would make in the wake as it is, blades bending by `bend`.
    pub(super) fn moments_beside(
        &self,
        wind: FixedFrame,
        posture: &Posture,
        bend: &Bend,
        memory: &Memory,
        state: &State,
    ) -> PerBlade<f64> {
        let conditions = self.conditions(wind, posture);
        let weight = self.weight.moment(posture.rotor_speed);
        let moments = self.blades.moments(&conditions, self.met(state, memory));
        bend.apply(&moments.map(|moment| moment + weight))
    }

    /// What is expected in the wake as it is.
    fn still(
        &self,
        wind: FixedFrame,
        posture: &Posture,
        state: &State,
        memory: &Memory,
    ) -> Expected {
        let conditions = self.conditions(wind, posture);
        let (moments, slopes) =
            self.blades.moments_with_slopes(&conditions, self.met(state, memory));
        let Posture { azimuth, rotor_speed, .. } = *posture;
        let bend = match &self.flap {
            Some(flap) => {
                flap.bend(rotor_speed + self.swing_rate, rotor_speed, azimuth, slopes.mean())
            }
            None => Bend::none(azimuth),
        };
        let weight = self.weight.moment(rotor_speed);
        Expected { moments: bend.apply(&moments.map(|moment| moment + weight)), slopes, bend }
    }

    fn conditions(&self, wind: FixedFrame, posture: &Posture) -> Conditions {
        Conditions {
            winds: to_blades(posture.azimuth, wind, self.n_blades),
            rotor_speed: posture.rotor_speed,
            pitch: posture.pitch,
        }
    }

    fn met<'a>(&self, state: &'a State, memory: &'a Memory) -> &'a Wake {
        if self.in_air.is_some() { &memory.met } else { &state.wake }
    }

    fn move_wake(
        &self,
        interval: f64,
        wind: FixedFrame,
        posture: &Posture,
        state: &mut State,
        memory: &mut Memory,
    ) {
        if let Some(share) = self.in_air {
            // Each sector answers to the wind where it stands, and to a blade pitched as one that passes there.
            let pitch = to_fixed_frame(posture.azimuth, &posture.pitch);
            let conditions = Conditions {
                winds: to_blades(0.0, wind, self.n_blades),
                rotor_speed: posture.rotor_speed,
                pitch: to_blades(0.0, pitch, self.n_blades),
            };
            self.blades.advance(interval, &conditions, &mut state.wake);
            self.blades.meet(&state.wake, posture.azimuth, share, &mut memory.met);
        } else {
            self.blades.advance(interval, &self.conditions(wind, posture), &mut state.wake);
        }
    }
}
