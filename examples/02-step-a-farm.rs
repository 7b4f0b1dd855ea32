//! A farm stepped by hand: look at it, or change it, between any two steps.
//!
//! cargo run --release -p wakemix --example 02-step-a-farm

use wakemix::basis::{Commands, Truth};
use wakemix::farm::Recorder;
use wakemix::formats::case;
use wakemix::study::Prepared;

const CASE: &str = r#"
name = "by-hand"
[wind]
speed = 9.0
turbulence_intensity = 0.0
event = { kind = "step", start = 120.0, speed = 7.0 }
[flow]
solver = "uniform"
[time]
spin_up = 0.0
duration = 300.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
"#;

/// State of the turbine in the last step: the truth, whatever its instruments show its controller.
#[derive(Default)]
struct Last {
    power: f64,
}

impl Recorder for Last {
    fn record(&mut self, _turbine: usize, truth: &Truth, _commands: &Commands) {
        self.power = truth.power;
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ready = Prepared::of(case::parse("by hand", CASE, &[])?)?.ready()?;
    let mut farm = ready.farm(&ready.prepared.case.runs[0])?;
    let (mut last, mut before) = (Last::default(), 0.0);
    while farm.time() < 300.0 {
        // Read, decide, sample the wind, move the rotors, move the air.
        farm.advance(&mut last)?;
        if farm.step().is_multiple_of(3000) {
            println!("{:.0} s: {:.0} kW", farm.time(), last.power / 1e3);
        }
        if farm.time() <= 120.0 {
            before = last.power;
        }
    }
    // Below rated, power goes with the third power of the wind.
    let (ratio, expected) = (last.power / before, (7.0_f64 / 9.0).powi(3));
    println!("power after over power before: {ratio:.3}, by the third power {expected:.3}");
    assert!((ratio / expected - 1.0).abs() < 0.03);
    Ok(())
}
