//! From the file's figures to a turbine in SI, with every figure that cannot be named.

use super::controller::{self, controller_of, from_rpm};
use super::document::{self, Document};
use super::error::{Place, Step, TurbineFileError};
use super::operation::operation_of;
use super::swashplate::swashplate_of;
use super::{TurbineFile, document as file, ranges};
use basis::Vector3;
use basis::blades::MAXIMUM_BLADES;
use turbine::actuators::PitchActuator;
use turbine::definition::{
    BladeSection, BladeStation, BladeStructure, Definition, DriveTrain, Hub, Mode, Nacelle,
    RotorGeometry, Tower, TowerProfile, TowerSection,
};
use turbine::{Polar, aero};

use Step::{Key, Row};

type Checked<T> = Result<T, TurbineFileError>;

/// Coefficients of a mode may miss one by this: printed to a few digits, they do not add up exactly (–).
const SHAPE_TOLERANCE: f64 = 2e-3;
/// Height of the hub may miss that of tower and shaft by this (m), on a model by a twentieth of its radius.
const HUB_TOLERANCE: f64 = 0.5;
/// First and last station may miss root and tip by this share of the blade (–).
const END_TOLERANCE: f64 = 1e-4;

pub(super) fn check(document: &Document, place: &Place) -> Checked<TurbineFile> {
    ranges::check(document, place)?;
    let missing = |group| missing(group, place);
    let rotor = document.rotor.as_ref().ok_or_else(|| missing("rotor"))?;
    let blade = document.blade.as_ref().ok_or_else(|| missing("blade"))?;
    let structure = document.blade_structure.as_ref().ok_or_else(|| missing("blade_structure"))?;
    let tower = document.tower.as_ref().ok_or_else(|| missing("tower"))?;
    let hub = document.hub.as_ref().ok_or_else(|| missing("hub"))?;
    let nacelle = document.nacelle.as_ref().ok_or_else(|| missing("nacelle"))?;
    let drive_train = document.drive_train.as_ref().ok_or_else(|| missing("drive_train"))?;
    let actuator = document.pitch_actuator.as_ref().ok_or_else(|| missing("pitch_actuator"))?;
    let controller_group = document.controller.as_ref().ok_or_else(|| missing("controller"))?;
    let airfoils = document.airfoils.as_ref().ok_or_else(|| missing("airfoils"))?;
    check_blades(document.n_blades, place)?;
    let polars = polars_of(airfoils, place)?;
    let length = rotor.tip_radius - rotor.hub_radius;
    let definition = Definition {
        name: document.name.clone(),
        n_blades: document.n_blades,
        rotor: rotor_of(rotor, place)?,
        blade: stations_of(blade, length, airfoils, place)?,
        polars,
        blade_structure: blade_structure_of(structure, length, place)?,
        tower: tower_of(tower, rotor, place)?,
        hub: hub_of(hub),
        nacelle: nacelle_of(nacelle),
        drive_train: drive_train_of(drive_train),
        pitch_actuator: actuator_of(actuator, place)?,
        swashplate: plate_of(actuator, document.n_blades, place)?,
        operation: document.operation.as_ref().map(|o| operation_of(o, place)).transpose()?,
        rated_power: 1e3 * controller_group.rated_power_kw,
        rated_rotor_speed: from_rpm(controller_group.rated_rotor_speed_rpm),
    };
    controller::check(controller_group, place)?;
    let radius = definition.rotor_radius();
    let mut sources = vec![
        ("rotor", &rotor.source),
        ("blade", &blade.source),
        ("blade_structure", &structure.source),
        ("tower", &tower.source),
        ("hub", &hub.source),
        ("nacelle", &nacelle.source),
        ("drive_train", &drive_train.source),
        ("pitch_actuator", &actuator.source),
        ("controller", &controller_group.source),
        ("airfoils", &airfoils.source),
    ];
    sources.extend(
        actuator.swashplate.as_ref().map(|plate| ("pitch_actuator.swashplate", &plate.source)),
    );
    sources.extend(document.operation.as_ref().map(|group| ("operation", &group.source)));
    Ok(TurbineFile {
        title: document.title.clone(),
        definition,
        controller: controller_of(controller_group, radius, drive_train.generator_efficiency),
        sources: checked_sources(&sources, place)?,
    })
}

/// What is told of a `group` that is not there.
fn missing(group: &'static str, place: &Place) -> TurbineFileError {
    let fix =
        format!("add [{group}]; `wakemix turbine show nrel-5mw --file` prints a complete one");
    place.error(&[Key(group)], format!("a group [{group}]"), "none", fix)
}

fn check_blades(n_blades: usize, place: &Place) -> Checked<()> {
    if (1..=MAXIMUM_BLADES).contains(&n_blades) {
        return Ok(());
    }
    let (expected, found) = (format!("1 to {MAXIMUM_BLADES} blades"), n_blades.to_string());
    Err(place.error(&[Key("n_blades")], expected, found, "count the blades"))
}

/// Groups with their `sources`, each of which names one.
fn checked_sources(
    sources: &[(&'static str, &String)],
    place: &Place,
) -> Checked<Vec<(String, String)>> {
    match sources.iter().find(|(_, source)| source.trim().is_empty()) {
        Some((group, _)) => {
            let fix = "name publication or input set, with its commit or edition";
            Err(place.error(&[Key(group), Key("source")], "a source", "an empty text", fix))
        }
        None => Ok(sources
            .iter()
            .map(|(group, source)| ((*group).to_owned(), (*source).clone()))
            .collect()),
    }
}

fn rotor_of(rotor: &file::Rotor, place: &Place) -> Checked<RotorGeometry> {
    let at = |key| [Key("rotor"), Key(key)];
    if rotor.tip_radius <= rotor.hub_radius {
        let expected = format!("more than hub_radius, {} m", rotor.hub_radius);
        let fix = "both count from the rotor apex, along the blade";
        return Err(place.error(&at("tip_radius"), expected, rotor.tip_radius.to_string(), fix));
    }
    if rotor.hub_height < rotor.tip_radius {
        let expected = format!("more than tip_radius, {} m", rotor.tip_radius);
        let fix = "raise the hub, or the blades meet the ground";
        return Err(place.error(&at("hub_height"), expected, rotor.hub_height.to_string(), fix));
    }
    Ok(RotorGeometry {
        hub_radius: rotor.hub_radius,
        tip_radius: rotor.tip_radius,
        precone: rotor.precone_deg.to_radians(),
        shaft_tilt: rotor.shaft_tilt_deg.to_radians(),
        overhang: rotor.overhang,
        hub_height: rotor.hub_height,
    })
}

fn spans_end_at(place: &Place, path: [Step; 2], spans: &[f64], length: f64) -> Checked<()> {
    let rows = spans.len();
    for (row, span, end) in [(0, spans[0], 0.0), (rows - 1, spans[rows - 1], length)] {
        if (span - end).abs() > END_TOLERANCE * length {
            let fix = "spans count from the blade root; the last is tip_radius - hub_radius";
            let expected = format!("{end:.4} m");
            return Err(place.error(
                &[path[0], path[1], Row(row)],
                expected,
                span.to_string(),
                fix,
            ));
        }
    }
    Ok(())
}

fn stations_of(
    blade: &file::Blade,
    length: f64,
    airfoils: &file::Airfoils,
    place: &Place,
) -> Checked<Vec<BladeStation>> {
    let spans: Vec<f64> = blade.stations.iter().map(|station| station.0).collect();
    place.rising("blade", "stations", &spans, 2, true)?;
    spans_end_at(place, [Key("blade"), Key("stations")], &spans, length)?;
    let station_of = |(row, station): (usize, &document::Station)| {
        let (span, chord, twist, prebend, sweep, polar_name) = station;
        let path = [Key("blade"), Key("stations"), Row(row)];
        place.within(&path, *prebend, -0.3 * length, 0.3 * length, " m prebend")?;
        place.within(&path, *sweep, -0.3 * length, 0.3 * length, " m sweep")?;
        let polar = airfoils.polar.iter().position(|polar| polar.name == *polar_name);
        let polar = polar.ok_or_else(|| {
            let fix = "name a polar of [[airfoils.polar]], or add it there";
            place.error(&path, "the name of a polar", format!("\"{polar_name}\""), fix)
        })?;
        Ok(BladeStation {
            span: *span,
            chord: *chord,
            twist: twist.to_radians(),
            prebend: *prebend,
            sweep: *sweep,
            polar,
        })
    };
    blade.stations.iter().enumerate().map(station_of).collect()
}

fn polars_of(airfoils: &file::Airfoils, place: &Place) -> Checked<Vec<Polar>> {
    let polar_of = |(row, table): (usize, &document::PolarTable)| {
        let path = [Key("airfoils"), Key("polar"), Row(row)];
        let twin = airfoils.polar[..row].iter().any(|other| other.name == table.name);
        if twin {
            let found = format!("\"{}\" a second time", table.name);
            return Err(place.error(&path, "a name of its own", found, "rename one of the two"));
        }
        let column = |index: usize| table.table.iter().map(|row| row[index]).collect::<Vec<f64>>();
        let angles: Vec<f64> = column(0).into_iter().map(f64::to_radians).collect();
        let mut polar = Polar::new(&table.name, &angles, &column(1), &column(2), &column(3))
            .map_err(|error| polar_error(place, row, &error))?;
        polar.reynolds_number = table.reynolds_number;
        polar.unsteady = table.unsteady.as_ref().map(unsteady_of);
        Ok(polar)
    };
    airfoils.polar.iter().enumerate().map(polar_of).collect()
}

fn polar_error(place: &Place, index: usize, error: &aero::PolarError) -> TurbineFileError {
    let base = [Key("airfoils"), Key("polar"), Row(index), Key("table")];
    let path = match error {
        aero::PolarError::NotRising { row, .. } | aero::PolarError::Value { row, .. } => {
            [base.as_slice(), &[Row(row - 1)]].concat()
        }
        _ => base.to_vec(),
    };
    let expected = "rows of angle (deg), lift, drag, moment from -180 to 180 degrees";
    place.error(
        &path,
        expected,
        error.to_string(),
        "correct the table; angles rise from row to row",
    )
}

fn unsteady_of(unsteady: &document::Unsteady) -> aero::UnsteadyConstants {
    aero::UnsteadyConstants {
        zero_lift_angle: unsteady.zero_lift_angle_deg.to_radians(),
        upper_separation_angle: unsteady.upper_separation_angle_deg.to_radians(),
        lower_separation_angle: unsteady.lower_separation_angle_deg.to_radians(),
        normal_force_slope: unsteady.normal_force_slope,
        upper_critical_normal_force: unsteady.upper_critical_normal_force,
        lower_critical_normal_force: unsteady.lower_critical_normal_force,
        zero_lift_drag: unsteady.zero_lift_drag,
        zero_lift_moment: unsteady.zero_lift_moment,
        time_constants: unsteady.time_constants,
        indicial_amplitudes: unsteady.indicial_amplitudes,
        indicial_exponents: unsteady.indicial_exponents,
    }
}

fn mode_of(mode: &file::Mode, group: &str, key: &str, place: &Place) -> Checked<Mode> {
    let sum: f64 = mode.coefficients.iter().sum();
    if (sum - 1.0).abs() > SHAPE_TOLERANCE {
        let fix = "divide the coefficients by their sum, so that the free end moves by one";
        let path = [Key(group), Key(key)];
        return Err(place.error(&path, "coefficients that add up to 1", format!("{sum:.6}"), fix));
    }
    Ok(Mode { coefficients: mode.coefficients, damping_ratio: mode.damping_ratio })
}

fn blade_structure_of(
    structure: &file::BladeStructure,
    length: f64,
    place: &Place,
) -> Checked<BladeStructure> {
    let spans: Vec<f64> = structure.sections.iter().map(|section| section[0]).collect();
    place.rising("blade_structure", "sections", &spans, 2, true)?;
    spans_end_at(place, [Key("blade_structure"), Key("sections")], &spans, length)?;
    let section_of = |section: &[f64; 5]| BladeSection {
        span: section[0],
        twist: section[1].to_radians(),
        mass: section[2],
        flap_stiffness: section[3],
        edge_stiffness: section[4],
    };
    let mode = |mode, key| mode_of(mode, "blade_structure", key, place);
    Ok(BladeStructure {
        sections: structure.sections.iter().map(section_of).collect(),
        flap_modes: [
            mode(&structure.flap_mode_1, "flap_mode_1")?,
            mode(&structure.flap_mode_2, "flap_mode_2")?,
        ],
        edge_mode: mode(&structure.edge_mode_1, "edge_mode_1")?,
    })
}

fn tower_of(tower: &file::Tower, rotor: &file::Rotor, place: &Place) -> Checked<Tower> {
    let at = |key| [Key("tower"), Key(key)];
    if tower.top_height <= tower.base_height {
        let expected = format!("more than base_height, {} m", tower.base_height);
        let fix = "both count from ground or mean sea level";
        return Err(place.error(&at("top_height"), expected, tower.top_height.to_string(), fix));
    }
    // The hub height follows from tower, shaft and overhang; the file says it twice so that a wrong figure
    // shows.
    let tilt = rotor.shaft_tilt_deg.to_radians();
    let hub_height = tower.top_height + tower.top_to_shaft + rotor.overhang * tilt.sin();
    if (hub_height - rotor.hub_height).abs() > HUB_TOLERANCE.min(0.05 * rotor.tip_radius) {
        let expected = format!("{hub_height:.2} m, from tower, shaft and overhang");
        let fix =
            "check hub_height, tower.top_height, tower.top_to_shaft, overhang and shaft_tilt_deg";
        let path = [Key("rotor"), Key("hub_height")];
        return Err(place.error(&path, expected, rotor.hub_height.to_string(), fix));
    }
    let heights: Vec<f64> = tower.profile.iter().map(|row| row[0]).collect();
    place.rising("tower", "profile", &heights, 2, true)?;
    let section_heights: Vec<f64> = tower.sections.iter().map(|row| row[0]).collect();
    place.rising("tower", "sections", &section_heights, 2, true)?;
    let profile_of = |profile: &[f64; 3]| TowerProfile {
        height: profile[0],
        diameter: profile[1],
        drag_coefficient: profile[2],
    };
    let section_of = |section: &[f64; 4]| TowerSection {
        height: section[0],
        mass: section[1],
        fore_aft_stiffness: section[2],
        side_to_side_stiffness: section[3],
    };
    let mode = |mode, key| mode_of(mode, "tower", key, place);
    Ok(Tower {
        base_height: tower.base_height,
        top_height: tower.top_height,
        top_to_shaft: tower.top_to_shaft,
        profile: tower.profile.iter().map(profile_of).collect(),
        sections: tower.sections.iter().map(section_of).collect(),
        fore_aft_modes: [
            mode(&tower.fore_aft_mode_1, "fore_aft_mode_1")?,
            mode(&tower.fore_aft_mode_2, "fore_aft_mode_2")?,
        ],
        side_to_side_modes: [
            mode(&tower.side_to_side_mode_1, "side_to_side_mode_1")?,
            mode(&tower.side_to_side_mode_2, "side_to_side_mode_2")?,
        ],
    })
}

fn hub_of(hub: &file::Hub) -> Hub {
    Hub { mass: hub.mass, inertia: hub.inertia }
}

fn nacelle_of(nacelle: &file::Nacelle) -> Nacelle {
    Nacelle {
        mass: nacelle.mass,
        yaw_inertia: nacelle.yaw_inertia,
        center_of_mass: Vector3::from_array(nacelle.center_of_mass),
        yaw_bearing_mass: nacelle.yaw_bearing_mass,
    }
}

fn drive_train_of(drive_train: &file::DriveTrain) -> DriveTrain {
    DriveTrain {
        gear_ratio: drive_train.gear_ratio,
        generator_inertia: drive_train.generator_inertia,
        gearbox_efficiency: drive_train.gearbox_efficiency,
        generator_efficiency: drive_train.generator_efficiency,
        stiffness: drive_train.stiffness,
        damping: drive_train.damping,
    }
}

fn actuator_of(actuator: &file::PitchActuator, place: &Place) -> Checked<PitchActuator> {
    let (low, high) = (actuator.minimum_pitch_deg, actuator.maximum_pitch_deg);
    place.within(&[Key("pitch_actuator"), Key("maximum_pitch_deg")], high, low, 180.0, "°")?;
    Ok(PitchActuator {
        natural_frequency: actuator.natural_frequency,
        damping_ratio: actuator.damping_ratio,
        maximum_rate: actuator.maximum_rate_deg_s.to_radians(),
        minimum_pitch: low.to_radians(),
        maximum_pitch: high.to_radians(),
    })
}

fn plate_of(
    actuator: &file::PitchActuator,
    n_blades: usize,
    place: &Place,
) -> Checked<Option<turbine::actuators::Swashplate>> {
    let limits = [actuator.minimum_pitch_deg, actuator.maximum_pitch_deg];
    let plate = actuator.swashplate.as_ref();
    plate.map(|plate| swashplate_of(plate, n_blades, limits, place)).transpose()
}
