//! Steady coefficients of a turbine over its tip-speed ratio, by blade-element momentum: no simulation.
//!
//! cargo run --release -p wakemix --example 05-steady-curve

use wakemix::formats::library;
use wakemix::turbine::aero::blade_element::Theory;
use wakemix::turbine::steady::SteadyRotor;

/// Most power that an open disc takes out of the wind, Betz (–).
const BETZ: f64 = 16.0 / 27.0;
/// What the best of any rotor here exceeds (–): models in wind tunnels lose much to drag, at Reynolds numbers
/// of 1e5.
const LEAST: f64 = 0.35;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for name in library::names() {
        let turbine = library::load(name)?;
        let rotor = SteadyRotor::new(&turbine.definition, Theory::default());
        println!("\n{name}: {:.1} m across", turbine.definition.rotor_diameter());
        println!("tip-speed ratio   power   thrust   torque");
        let (mut best, mut best_ratio) = (0.0, 0.0);
        for step in 0..=16 {
            let ratio = 5.0 + 0.5 * f64::from(step);
            // Pitch positive to feather (rad).
            let found = rotor.coefficients(ratio, 0.0);
            if step % 4 == 0 {
                let (power, thrust, torque) = (found.power, found.thrust, found.torque);
                println!("{ratio:15.1} {power:7.3} {thrust:8.3} {torque:8.4}");
            }
            // Power is torque times speed.
            assert!((found.power - found.torque * ratio).abs() < 1e-9);
            if found.power > best {
                (best, best_ratio) = (found.power, ratio);
            }
        }
        println!("most power {best:.3} at a tip-speed ratio of {best_ratio:.1}");
        assert!((LEAST..BETZ).contains(&best), "{name}: {best}");
    }
    Ok(())
}
