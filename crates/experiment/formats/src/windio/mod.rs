//! windIO turbine files (YAML, the ontology of WISDEM 2 and 3): what they hold of a turbine file.
//!
//! They hold outer shape, polars, blade sections, tower, some of the controller, and hub and nacelle where
//! they are of a finished design. Mode shapes and gains [follow](derive); generator inertia and what else is
//! not there a [user adds](completion). Figures that nobody knows are left out and named by the reader of the
//! result.

mod blade;
mod completion;
mod derive;
mod elastic;
mod node;
mod tower;
mod tuning;

pub use completion::template;

use crate::openfast::ImportOptions;
use crate::turbine_file::{
    Controller, Document, DriveTrain, Hub, Nacelle, Operation, PitchActuator, Rotor,
    SetPointSmoothing, TurbineFileError,
};
pub use blade::PolarChoice;
use node::{File, Node};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use tuning::Targets;

/// Pitch (rad) that ROSCO's smoother, for which the file's gains are meant, divides by.
const SMOOTHER_PITCH: f64 = 0.524;

/// The turbine of the windIO file at `path`; figures that it does not hold are not a number, groups without
/// any are absent.
///
/// # Errors
/// [`TurbineFileError`] naming file, line, key and what was expected.
pub fn import(path: &Path, options: &ImportOptions) -> Result<Document, TurbineFileError> {
    Ok(import_with(path, options, &WindioOptions::default())?.document)
}

/// What a user decides or adds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WindioOptions {
    /// Which polars to take where an airfoil has several.
    pub polars: PolarChoice,
    /// File with figures that the windIO file does not have.
    pub completion: Option<PathBuf>,
}

/// A turbine as it was imported.
#[derive(Clone, Debug, PartialEq)]
pub struct Imported {
    /// The turbine.
    pub document: Document,
    /// What was chosen, derived and assumed, each in a sentence.
    pub notes: Vec<String>,
}

/// Density of air where the file states none (kg/m³).
const AIR_DENSITY: f64 = 1.225;

/// The turbine of the windIO file at `path` with what `further` adds, and with what follows from all that.
///
/// # Errors
/// Those of [`import`]; those of the file that completes it.
pub fn import_with(
    path: &Path,
    options: &ImportOptions,
    further: &WindioOptions,
) -> Result<Imported, TurbineFileError> {
    let file = File::read(path)?;
    let root = file.root()?;
    let mut notes = Vec::new();
    let mut document = read(path, &root, options, &further.polars, &mut notes)?;
    if let Some(completion) = &further.completion {
        completion::complete(&mut document, completion)?;
    }
    let air_density = match root.optional("environment") {
        Some(environment) => environment.number_or("air_density", AIR_DENSITY)?,
        None => AIR_DENSITY,
    };
    let origin = format!("{} as imported", path.display());
    let targets = Targets::read(&root)?;
    derive::derive(&mut document, &targets, (air_density, &origin), &mut notes)?;
    Ok(Imported { document, notes })
}

/// What the file at `path` under `root` states.
fn read(
    path: &Path,
    root: &Node,
    options: &ImportOptions,
    polars: &PolarChoice,
    notes: &mut Vec<String>,
) -> Result<Document, TurbineFileError> {
    let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into());
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    let origin = options.source.clone().unwrap_or_else(|| "imported".to_owned());
    let source = format!("{origin}: {name}");
    let title = match (&options.title, root.optional("name")) {
        (Some(title), _) => title.clone(),
        (None, Some(node)) => node.text()?.to_owned(),
        (None, None) => name,
    };
    let components = root.get("components")?;
    let assembly = root.get("assembly")?;
    let hub = components.get("hub")?;
    let hub_radius = 0.5 * hub.number("diameter")?;
    let whole_blade = components.get("blade")?;
    let shape = whole_blade.get("outer_shape_bem")?;
    let blade = blade::read(&shape, &root.get("airfoils")?, &source, polars, notes)?;
    let nacelle = components.get("nacelle")?.get("drivetrain")?;
    let (mut tower, tower_top) = tower::read(root, &source)?;
    let rotor = rotor(&nacelle, &hub, hub_radius, blade.length, tower_top, &source)?;
    tower.top_to_shaft =
        rotor.hub_height - tower_top - rotor.overhang * rotor.shaft_tilt_deg.to_radians().sin();
    let radius = rotor.tip_radius;
    Ok(Document {
        name: options.name.clone().or(stem).unwrap_or_else(|| "turbine".to_owned()),
        title,
        n_blades: assembly.number("number_of_blades")? as usize,
        rotor: Some(rotor),
        blade: Some(blade.shape),
        blade_structure: elastic::read(&whole_blade, blade.length, &source)?,
        tower: Some(tower),
        hub: multibody(&hub).map(|elastic| hub_of(&elastic, &source)).transpose()?,
        nacelle: multibody(&nacelle).map(|elastic| nacelle_of(&elastic, &source)).transpose()?,
        drive_train: Some(drive_train(&nacelle, &source)?),
        pitch_actuator: pitch_actuator(root, &source)?,
        operation: operation(root, &source)?,
        controller: controller(root, &assembly, radius, &source)?,
        airfoils: Some(blade.airfoils),
    })
}

fn multibody<'a>(component: &Node<'a>) -> Option<Node<'a>> {
    component.optional("elastic_properties_mb").or_else(|| component.optional("elastic_properties"))
}

fn rotor(
    nacelle: &Node,
    hub: &Node,
    hub_radius: f64,
    blade_length: f64,
    tower_top: f64,
    source: &str,
) -> Result<Rotor, TurbineFileError> {
    let tilt = nacelle.number("uptilt")?;
    // The file's overhang is horizontal, ours along the shaft.
    let overhang = nacelle.number("overhang")? / tilt.cos();
    Ok(Rotor {
        source: source.to_owned(),
        hub_radius,
        tip_radius: hub_radius + blade_length,
        precone_deg: hub.number("cone_angle")?.to_degrees(),
        shaft_tilt_deg: tilt.to_degrees(),
        overhang,
        hub_height: tower_top + nacelle.number("distance_tt_hub")?,
    })
}

fn hub_of(elastic: &Node, source: &str) -> Result<Hub, TurbineFileError> {
    let inertia = elastic.get("system_inertia")?.numbers()?;
    Ok(Hub {
        source: source.to_owned(),
        mass: elastic.number("system_mass")?,
        inertia: inertia.first().copied().unwrap_or(f64::NAN),
    })
}

fn nacelle_of(elastic: &Node, source: &str) -> Result<Nacelle, TurbineFileError> {
    let center = elastic.get("system_center_mass")?;
    let numbers = center.numbers()?;
    let Ok(center_of_mass) = <[f64; 3]>::try_from(numbers.as_slice()) else {
        return Err(center.error("three coordinates", "[downwind, left, up] in metres"));
    };
    let inertia = elastic.get("system_inertia_tt")?.numbers()?;
    Ok(Nacelle {
        source: source.to_owned(),
        mass: elastic.number("system_mass")?,
        yaw_inertia: inertia.get(2).copied().unwrap_or(f64::NAN),
        center_of_mass,
        yaw_bearing_mass: elastic.number_or("yaw_mass", f64::NAN)?,
    })
}

fn drive_train(nacelle: &Node, source: &str) -> Result<DriveTrain, TurbineFileError> {
    // The efficiency at the highest speed, which is the rated one.
    let efficiency = match nacelle.optional("generator_rpm_efficiency_user") {
        Some(curve) => curve.get("values")?.numbers()?.last().copied().unwrap_or(f64::NAN),
        None => f64::NAN,
    };
    Ok(DriveTrain {
        source: source.to_owned(),
        gear_ratio: nacelle.number("gear_ratio")?,
        generator_inertia: nacelle.number_or("generator_inertia_user", f64::NAN)?,
        gearbox_efficiency: nacelle.number_or("gearbox_efficiency", f64::NAN)?,
        generator_efficiency: efficiency,
        stiffness: f64::NAN,
        damping: f64::NAN,
    })
}

fn pitch_actuator(root: &Node, source: &str) -> Result<Option<PitchActuator>, TurbineFileError> {
    let Some(pitch) = root.optional("control").and_then(|control| control.optional("pitch")) else {
        return Ok(None);
    };
    Ok(Some(PitchActuator {
        source: source.to_owned(),
        natural_frequency: f64::NAN,
        damping_ratio: f64::NAN,
        maximum_rate_deg_s: pitch.number("max_pitch_rate")?.to_degrees(),
        minimum_pitch_deg: pitch.number("min_pitch")?.to_degrees(),
        maximum_pitch_deg: pitch.number("max_pitch")?.to_degrees(),
        swashplate: None,
    }))
}

/// Cut-in and cut-out; none where the file does not tell both.
fn operation(root: &Node, source: &str) -> Result<Option<Operation>, TurbineFileError> {
    let supervisory = root.optional("control").and_then(|control| control.optional("supervisory"));
    let Some(supervisory) = supervisory else { return Ok(None) };
    if supervisory.optional("Vin").is_none() || supervisory.optional("Vout").is_none() {
        return Ok(None);
    }
    Ok(Some(Operation {
        source: source.to_owned(),
        cut_in_wind_speed: supervisory.number("Vin")?,
        cut_out_wind_speed: supervisory.number("Vout")?,
    }))
}

fn controller(
    root: &Node,
    assembly: &Node,
    radius: f64,
    source: &str,
) -> Result<Option<Controller>, TurbineFileError> {
    let Some(control) = root.optional("control") else { return Ok(None) };
    let torque = control.get("torque")?;
    let pitch = control.get("pitch")?;
    let tip_speed = control.get("supervisory")?.number_or("maxTS", f64::INFINITY)?;
    let rated_speed = torque.number_or("VS_maxspd", f64::INFINITY)?.min(tip_speed / radius);
    let smoothing = match control.optional("setpoint_smooth") {
        Some(smooth) => SetPointSmoothing {
            torque_shift: smooth.number("ss_vsgain")? / SMOOTHER_PITCH,
            pitch_shift: smooth.number("ss_pcgain")?,
            filter_corner: f64::NAN,
        },
        None => SetPointSmoothing {
            torque_shift: f64::NAN,
            pitch_shift: f64::NAN,
            filter_corner: f64::NAN,
        },
    };
    Ok(Some(Controller {
        source: source.to_owned(),
        rated_power_kw: assembly.number("rated_power")? / 1e3,
        rated_rotor_speed_rpm: rated_speed * 30.0 / PI,
        minimum_rotor_speed_rpm: torque.number("VS_minspd")? * 30.0 / PI,
        optimal_tip_speed_ratio: torque.number("tsr")?,
        torque_gain: f64::NAN,
        rated_torque: f64::NAN,
        minimum_torque: 0.0,
        maximum_torque: f64::NAN,
        maximum_torque_rate: torque.number("max_torque_rate")?,
        constant_power: true,
        torque_proportional: f64::NAN,
        torque_integral: f64::NAN,
        fine_pitch_deg: pitch.number("min_pitch")?.to_degrees(),
        maximum_pitch_deg: pitch.number("max_pitch")?.to_degrees(),
        maximum_pitch_rate_deg_s: pitch.number("max_pitch_rate")?.to_degrees(),
        minimum_pitch: Vec::new(),
        pitch_gains: Vec::new(),
        set_point_smoothing: smoothing,
        speed_filter_corner: f64::NAN,
        speed_filter_damping: None,
        speed_notches: Vec::new(),
        torque_control: None,
        wind_speed_filter_corner: None,
        tower_damping: None,
        individual_pitch: None,
    }))
}

#[cfg(test)]
pub(crate) mod tests;
