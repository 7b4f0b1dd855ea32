//! The turbines that come with the program.

use crate::turbine_file::{self, TurbineFile, TurbineFileError};
use std::path::Path;
use std::sync::OnceLock;

/// Name and file of each turbine.
const TURBINES: [(&str, &str); 4] = [
    ("iea-15mw", include_str!("../../../../turbines/iea-15mw.toml")),
    ("iea-22mw", include_str!("../../../../turbines/iea-22mw.toml")),
    ("mowito-06", include_str!("../../../../turbines/mowito-06.toml")),
    ("nrel-5mw", include_str!("../../../../turbines/nrel-5mw.toml")),
];

/// Names of the turbines that come with the program.
pub fn names() -> impl Iterator<Item = &'static str> {
    TURBINES.iter().map(|(name, _)| *name)
}

/// File of the turbine called `name`, as text.
pub fn text(name: &str) -> Option<&'static str> {
    TURBINES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The turbine called `name`, or the one in the file of that path.
///
/// # Errors
/// [`TurbineFileError`] when there is neither, or the file does not hold a turbine.
pub fn load(name: &str) -> Result<TurbineFile, TurbineFileError> {
    if let Some(index) = TURBINES.iter().position(|(known, _)| *known == name) {
        return shipped(index);
    }
    let path = Path::new(name);
    if path.exists() || path.extension().is_some() || name.contains(std::path::MAIN_SEPARATOR) {
        return turbine_file::read(path);
    }
    let known: Vec<&str> = names().collect();
    let fix = format!("known are {}; or give the path of a turbine file", known.join(", "));
    Err(TurbineFileError::Unknown { name: name.to_owned(), fix })
}

/// Turbine number `index` of [`TURBINES`], parsed once: a campaign asks for it thousands of times.
fn shipped(index: usize) -> Result<TurbineFile, TurbineFileError> {
    static PARSED: [OnceLock<TurbineFile>; TURBINES.len()] =
        [const { OnceLock::new() }; TURBINES.len()];
    if let Some(parsed) = PARSED[index].get() {
        return Ok(parsed.clone());
    }
    let (name, text) = TURBINES[index];
    let parsed = turbine_file::parse(&format!("turbines/{name}.toml"), text)?;
    Ok(PARSED[index].get_or_init(|| parsed).clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_loads_and_stands_as_published() {
        // Rated power (W), swept diameter, hub height (m), and published blade mass (kg) with the margin of
        // the versions between report and input set.
        let published = [
            ("iea-15mw", 15e6, 240.8, 150.0, 65.25e3, 0.06),
            ("iea-22mw", 22e6, 282.3, 170.0, 82.3e3, 0.01),
            ("nrel-5mw", 5e6, 125.9, 90.0, 17.74e3, 0.01),
        ];
        // One more, of a wind tunnel.
        assert_eq!(names().count(), published.len() + 1);
        for (name, power, diameter, height, mass, margin) in published {
            let file = load(name).unwrap();
            let definition = &file.definition;
            assert_eq!(definition.name, name);
            assert_eq!(definition.rated_power, power);
            assert!((definition.rotor_diameter() - diameter).abs() < 0.1, "{name}");
            assert!((definition.rotor.hub_height - height).abs() < 0.05, "{name}");
            assert!((definition.blade_mass() / mass - 1.0).abs() < margin, "{name}");
            assert_eq!(file.sources.len(), 11);
            let operation = definition.operation.unwrap();
            assert_eq!([operation.cut_in, operation.cut_out], [3.0, 25.0]);
            let rated = file.controller.rated_torque
                * file.controller.rated_rotor_speed
                * definition.efficiency();
            assert!((rated / power - 1.0).abs() < 2e-3, "{name}: {rated}");
        }
    }

    #[test]
    fn the_tunnel_turbine_stands_as_published() {
        // van der Hoek et al. (2024): diameter, electrical power coefficient at tip-speed ratio 5 in 5 m/s,
        // and motors to and fro by 216° at 2.41 Hz, which they just followed.
        let TurbineFile { definition, controller, .. } = load("mowito-06").unwrap();
        assert!((definition.rotor_diameter() - 0.58).abs() < 1e-12);
        assert_eq!(controller.optimal_tip_speed_ratio, 5.0);
        let speed = 5.0 * 5.0 / 0.29;
        let power = definition.efficiency() * controller.torque_gain * f64::powi(speed, 3);
        let coefficient = power / (0.5 * 1.225 * definition.rotor_area() * 125.0);
        assert!((coefficient - 0.27).abs() < 1e-3, "{coefficient}");
        let plate = definition.swashplate.unwrap();
        let fastest = 216.0_f64.to_radians() * std::f64::consts::TAU * 2.41;
        let limit = definition.pitch_actuator.maximum_rate * plate.motor_ratio();
        assert!((1.0..1.05).contains(&(limit / fastest)), "{}", limit / fastest);
        assert!((plate.amplitude_of(std::f64::consts::PI).to_degrees() - 2.25).abs() < 1e-3);
    }

    #[test]
    fn what_is_not_there_is_said_with_what_is() {
        let error = load("iea-10mw").unwrap_err();
        assert_eq!(error.to_string(), "no turbine is called \"iea-10mw\"");
        let TurbineFileError::Unknown { fix, .. } = error else { panic!("{error}") };
        assert!(fix.contains("iea-15mw, iea-22mw, mowito-06, nrel-5mw"));
        assert!(matches!(load("nowhere/t.toml"), Err(TurbineFileError::Unreadable { .. })));
    }
}
