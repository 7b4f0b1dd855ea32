//! What a windIO file does not state and its figures lead to: mode shapes of blades and tower, gains of
//! torque and pitch control. What is assumed instead is said with the group that it is in, and to the user.

use super::tuning;
use crate::turbine_file::{
    BladeStructure, Document, DriveTrain, Mode, PitchActuator, Tower, TurbineFileError,
};
use turbine::structure::{BeamSection, BendingMode, EndBody, bending_modes};

/// Damping ratios of blade and tower modes, which no file of the kind has (–): those of the NREL 5 MW
/// turbine's (Jonkman et al., NREL/TP-500-38060, 2009, §2 and §6).
const BLADE_DAMPING: f64 = 0.004_774_65;
const TOWER_DAMPING: f64 = 0.01;
/// Lag of a pitch actuator (rad/s, –): that of ROSCO's input for the IEA 22 MW turbine.
const ACTUATOR: [f64; 2] = [std::f64::consts::TAU, 0.707];
/// A shaft that does not twist (N m/rad, N m s/rad): ElastoDyn's input for the IEA 22 MW turbine.
const SHAFT: [f64; 2] = [1e12, 1e9];

/// On return `document` has what follows from its own figures; `notes` say what was derived or assumed.
///
/// # Errors
/// [`TurbineFileError`] for figures of which nothing can follow.
pub(super) fn derive(
    document: &mut Document,
    tune: &tuning::Targets,
    (air_density, origin): (f64, &str),
    notes: &mut Vec<String>,
) -> Result<(), TurbineFileError> {
    if let Some(structure) = &mut document.blade_structure {
        let length = document.rotor.as_ref().map(|rotor| rotor.tip_radius - rotor.hub_radius);
        blade_modes(structure, length.unwrap_or(f64::NAN), notes);
    }
    if let Some(actuator) = &mut document.pitch_actuator {
        actuator_lag(actuator, notes);
    }
    if let Some(drive_train) = &mut document.drive_train {
        shaft(drive_train, notes);
    }
    let end = tower_end(document);
    if let (Some(tower), Some(end)) = (&mut document.tower, end) {
        tower_modes(tower, end, notes);
    }
    tuning::derive(document, tune, (air_density, origin), notes)
}

/// Whether a mode is yet to be found.
fn is_open(mode: &Mode) -> bool {
    mode.coefficients.iter().any(|value| !value.is_finite())
}

fn mode_of(found: &BendingMode, damping_ratio: f64) -> Mode {
    Mode { coefficients: found.coefficients, damping_ratio }
}

fn hertz(mode: &BendingMode) -> f64 {
    mode.frequency / std::f64::consts::TAU
}

fn blade_modes(structure: &mut BladeStructure, length: f64, notes: &mut Vec<String>) {
    let modes = |column: usize| {
        let section =
            |row: &[f64; 5]| BeamSection { position: row[0], mass: row[2], stiffness: row[column] };
        let sections: Vec<BeamSection> = structure.sections.iter().map(section).collect();
        bending_modes(length, &sections, EndBody::default())
    };
    let open = [&structure.flap_mode_1, &structure.flap_mode_2, &structure.edge_mode_1];
    let (Some([first, second]), Some([edge, _])) = (modes(3), modes(4)) else { return };
    if !open.into_iter().all(is_open) {
        return;
    }
    structure.flap_mode_1 = mode_of(&first, BLADE_DAMPING);
    structure.flap_mode_2 = mode_of(&second, BLADE_DAMPING);
    structure.edge_mode_1 = mode_of(&edge, BLADE_DAMPING);
    structure.source += &format!(
        "; modes of a blade that stands still, from its sections; damping ratio {BLADE_DAMPING} assumed"
    );
    notes.push(format!(
        "blade_structure: modes from mass and stiffness of the sections, {:.3} and {:.3} Hz flapwise, {:.3} Hz edgewise; damping ratio {BLADE_DAMPING} is assumed",
        hertz(&first),
        hertz(&second),
        hertz(&edge)
    ));
}

fn actuator_lag(actuator: &mut PitchActuator, notes: &mut Vec<String>) {
    if actuator.natural_frequency.is_finite() || actuator.damping_ratio.is_finite() {
        return;
    }
    [actuator.natural_frequency, actuator.damping_ratio] = ACTUATOR;
    actuator.source += "; natural_frequency and damping_ratio assumed";
    notes.push(format!(
        "pitch_actuator: natural_frequency = {:.3} rad/s and damping_ratio = {} are assumed",
        ACTUATOR[0], ACTUATOR[1]
    ));
}

fn shaft(drive_train: &mut DriveTrain, notes: &mut Vec<String>) {
    if drive_train.stiffness.is_finite() || drive_train.damping.is_finite() {
        return;
    }
    [drive_train.stiffness, drive_train.damping] = SHAFT;
    drive_train.source += "; stiffness and damping assumed: a shaft that does not twist";
    notes.push(
        "drive_train: stiffness and damping are assumed, those of a shaft that does not twist"
            .to_owned(),
    );
}

/// Rotor and nacelle as a body on the tower; none while their masses are not known.
fn tower_end(document: &Document) -> Option<EndBody> {
    let (rotor, blade) = (document.rotor.as_ref()?, document.blade_structure.as_ref()?);
    let (hub, nacelle) = (document.hub.as_ref()?, document.nacelle.as_ref()?);
    let top_to_shaft = document.tower.as_ref()?.top_to_shaft;
    let n_blades = document.n_blades as f64;
    let parts = blade.sections.windows(2);
    let (mut mass, mut inertia) = (0.0, 0.0);
    for pair in parts {
        let part = 0.5 * (pair[0][2] + pair[1][2]) * (pair[1][0] - pair[0][0]);
        let radius = rotor.hub_radius + 0.5 * (pair[0][0] + pair[1][0]);
        mass += n_blades * part;
        inertia += n_blades * part * radius.powi(2);
    }
    let (sine, cosine) = rotor.shaft_tilt_deg.to_radians().sin_cos();
    let hub_place = [-rotor.overhang * cosine, top_to_shaft + rotor.overhang * sine];
    let [downwind, _, up] = nacelle.center_of_mass;
    let bodies = [
        (mass + hub.mass, hub_place),
        (nacelle.mass, [downwind, up]),
        (nacelle.yaw_bearing_mass, [0.0, 0.0]),
    ];
    let total: f64 = bodies.iter().map(|(mass, _)| mass).sum();
    let height = bodies.iter().map(|(mass, [_, up])| mass * up).sum::<f64>() / total;
    // About an axis across the wind, or along it: alike but for the overhang, which the fore-aft motion has.
    let offset = |(mass, [downwind, up]): &(f64, [f64; 2])| {
        mass * (downwind.powi(2) + (up - height).powi(2))
    };
    let inertia = 0.5 * (inertia + hub.inertia) + bodies.iter().map(offset).sum::<f64>();
    let end = EndBody { mass: total, distance: height, inertia };
    (total.is_finite() && inertia.is_finite()).then_some(end)
}

fn tower_modes(tower: &mut Tower, end: EndBody, notes: &mut Vec<String>) {
    let height = tower.top_height - tower.base_height;
    let base = tower.base_height;
    let modes = |column: usize| {
        let section = |row: &[f64; 4]| BeamSection {
            position: row[0] - base,
            mass: row[1],
            stiffness: row[column],
        };
        let sections: Vec<BeamSection> = tower.sections.iter().map(section).collect();
        bending_modes(height, &sections, end)
    };
    let open = [
        &tower.fore_aft_mode_1,
        &tower.fore_aft_mode_2,
        &tower.side_to_side_mode_1,
        &tower.side_to_side_mode_2,
    ];
    let (Some(fore_aft), Some(side)) = (modes(2), modes(3)) else { return };
    if !open.into_iter().all(is_open) {
        return;
    }
    [tower.fore_aft_mode_1, tower.fore_aft_mode_2] =
        fore_aft.map(|mode| mode_of(&mode, TOWER_DAMPING));
    [tower.side_to_side_mode_1, tower.side_to_side_mode_2] =
        side.map(|mode| mode_of(&mode, TOWER_DAMPING));
    tower.source += &format!(
        "; modes of the tower clamped at its base under a rigid rotor and nacelle, from its sections; damping ratio {TOWER_DAMPING} assumed"
    );
    notes.push(format!(
        "tower: modes from its sections under rotor and nacelle, {:.3} and {:.3} Hz; damping ratio {TOWER_DAMPING} is assumed",
        hertz(&fore_aft[0]),
        hertz(&fore_aft[1])
    ));
}
