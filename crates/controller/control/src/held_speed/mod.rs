//! Rotor speed held by torque at one tip-speed ratio of the case's wind, as turbines in wind tunnels are run
//! upstream: thrust then does not follow the rotor's speed.
//!
//! PI control of torque on measured speed with the gains of the turbine's own torque control, within its
//! limits on torque and its rate; collective pitch is that of greedy control. Source: van der Hoek et al.,
//! Wind Energy (2024), doi:10.1002/we.2896, §2.1. Limits: for winds below rated; above, torque ends at
//! rated and pitch holds rated speed.

mod kind;

pub use kind::HELD_SPEED;
pub(crate) use kind::{HELD_RATIO, held_or_greedy, held_twice};

use crate::baseline::{Baseline, Constants, SpeedFilter, Torque};
use crate::controller::{Controller, ForeignState, from_bytes, to_bytes};
use basis::{Commands, Measurements};
use serde::{Deserialize, Serialize};

/// Greedy control whose torque holds the rotor's speed.
pub struct HeldSpeed {
    inner: Baseline,
    /// Speed that is held (rad/s).
    reference: f64,
    state: Option<State>,
}

/// What it remembers from one instant to the next, the pitch aside.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct State {
    rotor_speed: SpeedFilter,
    torque: Torque,
}

impl HeldSpeed {
    /// Control of the turbine with `constants` that holds its rotor at `tip_speed_ratio` (–) of `wind_speed`
    /// (m/s).
    pub fn new(constants: &Constants, tip_speed_ratio: f64, wind_speed: f64) -> Self {
        let reference = tip_speed_ratio * wind_speed / constants.rotor_radius;
        Self { inner: Baseline::new(constants.clone()), reference, state: None }
    }
}

impl Controller for HeldSpeed {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let commands = self.inner.update(measurements);
        let constants = self.inner.constants();
        let speed = measurements.generator_speed;
        let state = self.state.get_or_insert_with(|| State {
            rotor_speed: SpeedFilter::settled(speed, constants),
            torque: Torque::settled(constants, speed),
        });
        let filtered = state.rotor_speed.update(measurements.interval, speed);
        let generator_torque =
            state.torque.track(measurements.interval, filtered, self.reference, constants);
        Commands { generator_torque, ..commands }
    }

    fn describe(&self) -> String {
        format!("held speed {:.1} rpm", self.reference * 30.0 / std::f64::consts::PI)
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&(self.inner.save(), self.state))
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let (inner, own): (Vec<u8>, Option<State>) = from_bytes(state)?;
        self.inner.restore(&inner)?;
        self.state = own;
        Ok(())
    }
}
