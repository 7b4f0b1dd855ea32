//! A controller of your own on a turbine of the library: it sees what the instruments show, and commands
//! torque and pitch.
//!
//! cargo run --release -p wakemix --example 03-own-controller

use wakemix::basis::{Commands, Measurements, PerBlade};
use wakemix::control::{Controller, ForeignState};
use wakemix::farm::Unrecorded;
use wakemix::formats::case;
use wakemix::study::Prepared;

const CASE: &str = "name = \"own\"\n[wind]\nspeed = 8.0\nturbulence_intensity = 0.0\n\
    [flow]\nsolver = \"uniform\"\n[time]\nspin_up = 0.0\nduration = 200.0\n\
    [[turbine]]\nname = \"T1\"\nmodel = \"nrel-5mw\"\nposition_diameters = [0.0, 0.0]\nstructure = \"rigid\"\n\
    [[run]]\nname = \"own\"\n";

/// Rotor speed that the controller holds (rad/s).
const SPEED: f64 = 1.0;

/// Holds one rotor speed with the torque: a proportional and integral controller.
struct HoldSpeed {
    /// Integral of the speed error (rad).
    integral: f64,
}

impl Controller for HoldSpeed {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let error = measurements.generator_speed - SPEED;
        self.integral += error * measurements.interval;
        let generator_torque = (2e6 + 2e7 * error + 3e6 * self.integral).max(0.0);
        let pitch = PerBlade::splat(measurements.pitch.len(), 0.0);
        Commands { pitch, generator_torque, yaw_rate: 0.0 }
    }

    fn describe(&self) -> String {
        format!("rotor speed held at {SPEED} rad/s")
    }

    // What time changes goes into checkpoints.
    fn save(&self) -> Vec<u8> {
        self.integral.to_le_bytes().to_vec()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        self.integral = f64::from_le_bytes(state.try_into().map_err(|_| ForeignState)?);
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ready = Prepared::of(case::parse("own", CASE, &[])?)?.ready()?;
    let mut farm = ready.farm(&ready.prepared.case.runs[0])?;
    farm.machines_mut()[0].controller = Box::new(HoldSpeed { integral: 0.0 });
    while farm.time() < 200.0 {
        farm.advance(&mut Unrecorded)?;
    }
    let machine = &farm.machines()[0];
    let speed = machine.turbine.truth(farm.time(), 0.0).rotor_speed;
    println!("{}: {speed:.4} rad/s", machine.controller.describe());
    assert!((speed / SPEED - 1.0).abs() < 1e-3);
    Ok(())
}
