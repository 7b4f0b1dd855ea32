//! A turbine file as text: groups with their sources, tables in aligned columns.

use super::document::{
    Airfoils, Blade, BladeStructure, Document, DriveTrain, Hub, Nacelle, PitchActuator, PolarTable,
    Rotor, Tower, Unsteady,
};
use super::operation::Operation;
use super::swashplate::Swashplate;
use super::text::{Text, number, numbers, quoted};
use super::write_controller::controller;

/// A turbine file as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Groups and keys that the document does not hold and a turbine needs; comments stand in their places.
    pub missing: Vec<String>,
}

/// The text of `document`, figures to seven digits. Groups that are absent, figures that are not a number and
/// tables without rows (but for `controller.minimum_pitch`, which may be empty) are missing.
pub fn write(document: &Document) -> Written {
    let mut out = Text::default();
    out.line(&format!("# {}", document.title));
    out.line("# SI units unless the key says otherwise. Every group names its source.");
    out.line(
        "# Positive precone, tilt, overhang and prebend carry the blade tips away from the tower;",
    );
    out.line(
        "# twist and pitch are positive to feather; heights count from ground or mean sea level.",
    );
    out.line("");
    out.text("name", &document.name);
    out.text("title", &document.title);
    out.line(&format!("n_blades = {}", document.n_blades));
    out.group("rotor", &document.rotor, rotor);
    out.group("blade", &document.blade, blade);
    out.group("blade_structure", &document.blade_structure, blade_structure);
    out.group("tower", &document.tower, tower);
    out.group("hub", &document.hub, hub);
    out.group("nacelle", &document.nacelle, nacelle);
    out.group("drive_train", &document.drive_train, drive_train);
    out.group("pitch_actuator", &document.pitch_actuator, pitch_actuator);
    operation(&mut out, document.operation.as_ref());
    out.group("controller", &document.controller, controller);
    out.group("airfoils", &document.airfoils, airfoils);
    let Text { text, missing, .. } = out;
    Written { text, missing }
}

fn rotor(out: &mut Text, rotor: &Rotor) {
    out.text("source", &rotor.source);
    out.number("hub_radius", rotor.hub_radius, "rotor apex to blade root");
    out.number("tip_radius", rotor.tip_radius, "rotor apex to blade tip, along the pitch axis");
    out.number("precone_deg", rotor.precone_deg, "");
    out.number("shaft_tilt_deg", rotor.shaft_tilt_deg, "");
    out.number("overhang", rotor.overhang, "yaw axis to rotor apex, along the shaft");
    out.number("hub_height", rotor.hub_height, "rotor apex");
}

fn blade(out: &mut Text, blade: &Blade) {
    out.text("source", &blade.source);
    let columns = ["span", "chord", "twist_deg", "prebend", "sweep", "polar"];
    let rows = blade.stations.iter().map(|(span, chord, twist, prebend, sweep, polar)| {
        let numbers = [span, chord, twist, prebend, sweep].map(|value| number(*value));
        numbers.into_iter().chain([quoted(polar)])
    });
    out.table("stations", &columns, rows);
}

fn blade_structure(out: &mut Text, structure: &BladeStructure) {
    out.text("source", &structure.source);
    out.line(
        "# Shape of a mode: coefficients of x^2 to x^6, x the share of the blade from its root.",
    );
    out.mode("flap_mode_1", &structure.flap_mode_1);
    out.mode("flap_mode_2", &structure.flap_mode_2);
    out.mode("edge_mode_1", &structure.edge_mode_1);
    let columns = ["span", "twist_deg", "mass", "flap_stiffness", "edge_stiffness"];
    out.table("sections", &columns, structure.sections.iter().map(numbers));
}

fn tower(out: &mut Text, tower: &Tower) {
    out.text("source", &tower.source);
    out.number("base_height", tower.base_height, "clamped here");
    out.number("top_height", tower.top_height, "yaw bearing");
    out.number("top_to_shaft", tower.top_to_shaft, "yaw bearing up to the shaft, on the yaw axis");
    out.table("profile", &["height", "diameter", "drag"], tower.profile.iter().map(numbers));
    let columns = ["height", "mass", "fore_aft_stiffness", "side_to_side_stiffness"];
    out.table("sections", &columns, tower.sections.iter().map(numbers));
    out.line(
        "# Shape of a mode: coefficients of x^2 to x^6, x the share of the tower from its base.",
    );
    out.mode("fore_aft_mode_1", &tower.fore_aft_mode_1);
    out.mode("fore_aft_mode_2", &tower.fore_aft_mode_2);
    out.mode("side_to_side_mode_1", &tower.side_to_side_mode_1);
    out.mode("side_to_side_mode_2", &tower.side_to_side_mode_2);
}

fn hub(out: &mut Text, hub: &Hub) {
    out.text("source", &hub.source);
    out.number("mass", hub.mass, "");
    out.number("inertia", hub.inertia, "about the shaft");
}

fn nacelle(out: &mut Text, nacelle: &Nacelle) {
    out.text("source", &nacelle.source);
    out.number("mass", nacelle.mass, "");
    out.number("yaw_inertia", nacelle.yaw_inertia, "about the yaw axis");
    let center = numbers(&nacelle.center_of_mass).join(", ");
    out.line(&format!(
        "center_of_mass = [{center}]  # from the tower top: downwind, left looking downwind, up"
    ));
    out.number("yaw_bearing_mass", nacelle.yaw_bearing_mass, "");
}

fn drive_train(out: &mut Text, drive_train: &DriveTrain) {
    out.text("source", &drive_train.source);
    out.number("gear_ratio", drive_train.gear_ratio, "generator speed over rotor speed");
    out.number(
        "generator_inertia",
        drive_train.generator_inertia,
        "about the generator's own shaft",
    );
    out.number("gearbox_efficiency", drive_train.gearbox_efficiency, "");
    out.number("generator_efficiency", drive_train.generator_efficiency, "");
    out.number("stiffness", drive_train.stiffness, "torsion, low-speed side");
    out.number("damping", drive_train.damping, "torsion, low-speed side");
}

fn pitch_actuator(out: &mut Text, actuator: &PitchActuator) {
    out.text("source", &actuator.source);
    out.number("natural_frequency", actuator.natural_frequency, "rad/s");
    out.number("damping_ratio", actuator.damping_ratio, "");
    out.number("maximum_rate_deg_s", actuator.maximum_rate_deg_s, "");
    out.number("minimum_pitch_deg", actuator.minimum_pitch_deg, "");
    out.number("maximum_pitch_deg", actuator.maximum_pitch_deg, "");
    if let Some(plate) = &actuator.swashplate {
        out.line("");
        out.line("# Lag, rate and limits of its motors are those above, in collective pitch.");
        out.line("[pitch_actuator.swashplate]");
        swashplate(out, plate);
    }
}

fn swashplate(out: &mut Text, plate: &Swashplate) {
    out.text("source", &plate.source);
    if let Some(travel) = plate.travel_per_turn {
        out.number("travel_per_turn", travel, "of a rod, by a nut on a threaded shaft");
    }
    if let Some(length) = plate.crank_length {
        out.number("crank_length", length, "arm that moves a rod");
    }
    out.number("rod_radius", plate.rod_radius, "shaft to rods");
    out.number("link_radius", plate.link_radius, "shaft to pitch links");
    out.number("horn_length", plate.horn_length, "pitch axis of a blade to its link");
    out.number("rod_azimuth_deg", plate.rod_azimuth_deg, "of the first rod");
    let bias = numbers(&plate.bias_deg).join(", ");
    out.line(&format!("bias_deg = [{bias}]  # tilt and yaw pitch with the plate straight"));
    out.number("slack_deg", plate.slack_deg, "play of the plate about the shaft, either way");
    out.number("gain_with_rotor", plate.gain_with_rotor, "tilt of the plate over that of the rods");
    out.number("gain_against_rotor", plate.gain_against_rotor, "its direction going round so");
}

/// The group that not every source tells of: a comment stands in its place then, and nothing is missing.
fn operation(out: &mut Text, operation: Option<&Operation>) {
    let Some(operation) = operation else {
        out.line("");
        out.line("# [operation] is not in the source: with it, cases are held against cut-in and cut-out;");
        out.line(
            "# source, cut_in_wind_speed and cut_out_wind_speed, mean wind at hub height (m/s)",
        );
        return;
    };
    let write = |out: &mut Text, group: &Operation| {
        out.text("source", &group.source);
        out.number("cut_in_wind_speed", group.cut_in_wind_speed, "mean wind at hub height");
        out.number("cut_out_wind_speed", group.cut_out_wind_speed, "");
    };
    out.group("operation", &Some(operation.clone()), write);
}

fn airfoils(out: &mut Text, airfoils: &Airfoils) {
    out.text("source", &airfoils.source);
    for table in &airfoils.polar {
        out.line("");
        out.line("[[airfoils.polar]]");
        polar(out, table);
    }
}

fn polar(out: &mut Text, polar: &PolarTable) {
    out.text("name", &polar.name);
    if let Some(reynolds_number) = polar.reynolds_number {
        out.number("reynolds_number", reynolds_number, "");
    }
    let columns = ["angle_deg", "lift", "drag", "moment"];
    // Coefficients are known to a few digits; five decimals keep the file small.
    let rows = polar.table.iter().map(|[angle, lift, drag, moment]| {
        let coefficient = |value: f64| {
            let text = format!("{value:.5}");
            if text == "-0.00000" { "0.00000".to_owned() } else { text }
        };
        [format!("{angle:.4}"), coefficient(*lift), coefficient(*drag), coefficient(*moment)]
    });
    out.table("table", &columns, rows);
    if let Some(constants) = &polar.unsteady {
        out.line("[airfoils.polar.unsteady]");
        unsteady(out, constants);
    }
}

fn unsteady(out: &mut Text, unsteady: &Unsteady) {
    out.number("zero_lift_angle_deg", unsteady.zero_lift_angle_deg, "");
    out.number("upper_separation_angle_deg", unsteady.upper_separation_angle_deg, "");
    out.number("lower_separation_angle_deg", unsteady.lower_separation_angle_deg, "");
    out.number("normal_force_slope", unsteady.normal_force_slope, "");
    out.number("upper_critical_normal_force", unsteady.upper_critical_normal_force, "");
    out.number("lower_critical_normal_force", unsteady.lower_critical_normal_force, "");
    out.number("zero_lift_drag", unsteady.zero_lift_drag, "");
    out.number("zero_lift_moment", unsteady.zero_lift_moment, "");
    let mut list = |key: &str, values: Option<&[f64]>| {
        if let Some(values) = values {
            let values: Vec<String> = values.iter().map(|value| number(*value)).collect();
            out.line(&format!("{key} = [{}]", values.join(", ")));
        }
    };
    list("time_constants", unsteady.time_constants.as_ref().map(|values| values.as_slice()));
    list("indicial_amplitudes", unsteady.indicial_amplitudes.as_ref().map(|v| v.as_slice()));
    list("indicial_exponents", unsteady.indicial_exponents.as_ref().map(|v| v.as_slice()));
}
