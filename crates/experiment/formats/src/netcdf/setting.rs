//! What a plane was taken of: case, run, wind and turbines.

use super::text;
use netcdf_writer::{Error, NcAttrValue, NcFileBuilder};

/// A turbine of the case, where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedTurbine {
    /// Its name.
    pub name: String,
    /// Middle of its rotor's hub over the foot of its tower, farm frame (m).
    pub hub: [f64; 3],
    /// Rotor diameter (m).
    pub rotor_diameter: f64,
    /// Whether it stands there in the run.
    pub is_there: bool,
}

/// What a plane was taken of.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneSetting {
    /// Name of the case.
    pub case: String,
    /// Name of the run.
    pub run: String,
    /// Mean speed at hub height of the first turbine that the case sets (m/s).
    pub wind_speed: f64,
    /// Where the mean wind comes from, clockwise from north (deg).
    pub wind_direction_deg: f64,
    /// Turbulence intensity that the case sets (–).
    pub turbulence_intensity: f64,
    /// Air density (kg/m³).
    pub air_density: f64,
    /// The turbines of the case, the first upstream; one at least.
    pub turbines: Vec<PlacedTurbine>,
}

impl PlaneSetting {
    /// Two turbines, of which the second is not there, for trials.
    #[cfg(test)]
    pub(crate) fn example() -> Self {
        let turbine = |name: &str, x: f64, is_there| PlacedTurbine {
            name: name.to_owned(),
            hub: [x, 0.0, 150.0],
            rotor_diameter: 240.0,
            is_there,
        };
        Self {
            case: "first-study".to_owned(),
            run: "helix".to_owned(),
            wind_speed: 9.0,
            wind_direction_deg: 270.0,
            turbulence_intensity: 0.05,
            air_density: 1.225,
            turbines: vec![turbine("T1", 0.0, true), turbine("north-2", 1200.0, false)],
        }
    }

    pub(super) fn add_attributes(&self, file: &mut NcFileBuilder) -> Result<(), Error> {
        file.add_attribute("case", text(&self.case))?;
        file.add_attribute("run", text(&self.run))?;
        let numbers = [
            ("wind_speed_m_s", self.wind_speed),
            ("wind_from_direction_deg", self.wind_direction_deg),
            ("turbulence_intensity", self.turbulence_intensity),
            ("air_density_kg_m3", self.air_density),
        ];
        let first = self.turbines.first();
        let of_first = first.map(|first| {
            [("rotor_diameter_m", first.rotor_diameter), ("hub_height_m", first.hub[2])]
        });
        for (name, value) in numbers.into_iter().chain(of_first.into_iter().flatten()) {
            file.add_attribute(name, NcAttrValue::Doubles(vec![value]))?;
        }
        let frame = "x downwind, y to the left looking downwind, z upward from the ground; wind_speed_m_s and turbulence_intensity are what the case asks for";
        file.add_attribute("comment", text(frame))
    }

    pub(super) fn add_turbines(&self, file: &mut NcFileBuilder) -> Result<(), Error> {
        let Some(longest) = self.turbines.iter().map(|turbine| turbine.name.len()).max() else {
            return Ok(());
        };
        let dimension = file.add_dimension("turbine", self.turbines.len() as u64)?;
        let letters = file.add_dimension("letters", longest.max(1) as u64)?;
        let names = file.add_char_variable("turbine", &[dimension, letters])?;
        file.add_variable_attribute(names, "long_name", text("name of the turbine"))?;
        file.add_variable_attribute(names, "_Encoding", text("utf-8"))?;
        let all: Vec<&str> = self.turbines.iter().map(|turbine| turbine.name.as_str()).collect();
        file.write_char_variable_strings(names, &all)?;
        type Part = fn(&PlacedTurbine) -> f64;
        let parts: [(&str, &str, Part); 4] = [
            ("hub_x", "distance of the hub downwind of the first turbine", |one| one.hub[0]),
            ("hub_y", "distance of the hub to the left of the first turbine", |one| one.hub[1]),
            ("hub_z", "height of the hub above the ground", |one| one.hub[2]),
            ("rotor_diameter", "rotor diameter", |one| one.rotor_diameter),
        ];
        for (name, long_name, part) in parts {
            let variable = file.add_variable::<f64>(name, &[dimension])?;
            file.add_variable_attribute(variable, "units", text("m"))?;
            file.add_variable_attribute(variable, "long_name", text(long_name))?;
            file.write_variable(variable, &self.turbines.iter().map(part).collect::<Vec<f64>>())?;
        }
        let variable = file.add_variable::<i8>("turbine_present", &[dimension])?;
        let long_name = "1 where the turbine stands in the run, 0 where its place is empty";
        file.add_variable_attribute(variable, "long_name", text(long_name))?;
        let there = self.turbines.iter().map(|turbine| i8::from(turbine.is_there));
        file.write_variable(variable, &there.collect::<Vec<i8>>())
    }
}
