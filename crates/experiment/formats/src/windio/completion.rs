//! Figures that a user adds to those of an import: a file of the same groups and keys as a turbine file, with
//! as few of them as are missing.

use crate::atomic;
use crate::turbine_file::{Document, TurbineFileError};
use std::path::Path;
use toml::{Table, Value};

/// On return `document` has the figures of the file at `path` in the place of its own.
///
/// # Errors
/// [`TurbineFileError`] for a file that is no TOML, with line, and for groups and keys that no turbine file
/// has.
pub(super) fn complete(document: &mut Document, path: &Path) -> Result<(), TurbineFileError> {
    let file = path.display().to_string();
    let text = atomic::read_whole(path)
        .and_then(|bytes| String::from_utf8(bytes).map_err(std::io::Error::other))
        .map_err(|source| TurbineFileError::unreadable(path, source))?;
    let added: Table =
        text.parse().map_err(|error| TurbineFileError::syntax(&file, &text, &error))?;
    let refuse = |error: &dyn std::fmt::Display| {
        TurbineFileError::Value {
        file: file.clone().into(),
        line: 0,
        key: "the file".into(),
        expected: "groups and keys of a turbine file, whole groups where the import has none".into(),
        found: error.to_string().trim().into(),
        fix: "begin with the template that the import writes; `wakemix turbine show nrel-5mw --file` has all groups".into(),
    }
    };
    let mut own = Table::try_from(&*document).map_err(|error| refuse(&error))?;
    merge(&mut own, added);
    *document = Value::Table(own).try_into().map_err(|error| refuse(&error))?;
    Ok(())
}

/// On return `own` holds what `added` has, and else what it had; lists go as a whole.
fn merge(own: &mut Table, added: Table) {
    for (key, value) in added {
        match (own.get_mut(&key), value) {
            (Some(Value::Table(own)), Value::Table(added)) => merge(own, added),
            (_, value) => {
                own.insert(key, value);
            }
        }
    }
}

/// Groups that windIO files may lack as a whole, with their keys; and what is to be known of keys.
const GROUPS: [(&str, &[&str]); 5] = [
    ("blade_structure", &["sections", "flap_mode_1", "flap_mode_2", "edge_mode_1"]),
    ("hub", &["mass", "inertia"]),
    ("nacelle", &["mass", "yaw_inertia", "center_of_mass", "yaw_bearing_mass"]),
    (
        "pitch_actuator",
        &[
            "natural_frequency",
            "damping_ratio",
            "maximum_rate_deg_s",
            "minimum_pitch_deg",
            "maximum_pitch_deg",
        ],
    ),
    ("tower", &["sections"]),
];
const ABOUT: [(&str, &str); 17] = [
    (
        "blade_structure.sections",
        "rows of span (m), twist (deg), mass (kg/m), flapwise and edgewise stiffness (N m^2)",
    ),
    (
        "blade_structure.flap_mode_1",
        "{ coefficients = [x^2 to x^6, sum 1], damping_ratio = 0.005 }",
    ),
    ("hub.mass", "kg"),
    ("hub.inertia", "about the shaft, kg m^2"),
    ("nacelle.mass", "kg, without rotor, hub and yaw bearing"),
    ("nacelle.yaw_inertia", "about the yaw axis, kg m^2"),
    ("nacelle.center_of_mass", "[downwind, left, up] from the tower top, m"),
    ("nacelle.yaw_bearing_mass", "kg; may be 0.0"),
    (
        "tower.sections",
        "rows of height (m), mass (kg/m), fore-aft and side-to-side stiffness (N m^2)",
    ),
    ("drive_train.generator_inertia", "about the generator's own shaft, kg m^2"),
    ("drive_train.gearbox_efficiency", "a share; 1.0 without a gearbox"),
    ("drive_train.generator_efficiency", "a share, such as 0.95"),
    ("drive_train.stiffness", "torsion, low-speed side, N m/rad"),
    ("drive_train.damping", "torsion, low-speed side, N m s/rad"),
    ("controller.pitch_gains", "rows of pitch (deg), proportional (s) and integral gain (-)"),
    ("controller.speed_filter_corner", "rad/s; a quarter of the first edgewise frequency is usual"),
    ("pitch_actuator.natural_frequency", "rad/s"),
];
/// Groups whose figures follow from others once those are known.
const FOLLOW: [&str; 2] = ["tower", "controller"];

/// A template for the figures that are `missing` of a turbine file: each on a line of its own, commented out.
pub fn template(missing: &[String]) -> String {
    let mut text = String::from(
        "# What the import could not find: take away the # of a group and of its keys, write a figure for each ?, and where it comes from, then import again\n# with --complete and the name of this file. Modes and gains follow by themselves where the rest is known.\n",
    );
    let (mut group, mut later) = (String::new(), Vec::new());
    for entry in missing {
        let (name, key) = entry.split_once('.').unwrap_or((entry, ""));
        if FOLLOW.contains(&name) && !key.is_empty() && key != "sections" {
            later.push(entry.as_str());
            continue;
        }
        if group != name {
            text += &format!("\n# [{name}]\n");
            if key.is_empty() {
                text += "# source = \"?\"\n";
            }
            name.clone_into(&mut group);
        }
        let known = GROUPS.iter().find(|(known, _)| *known == name);
        let keys: &[&str] =
            if key.is_empty() { known.map_or(&[], |(_, keys)| keys) } else { &[key] };
        for key in keys {
            let about = ABOUT.iter().find(|(path, _)| *path == format!("{name}.{key}"));
            let about = about.map_or(String::new(), |(_, about)| format!("  # {about}"));
            text += &format!("# {key} = ?{about}\n");
        }
    }
    if !later.is_empty() {
        text += "\n# These follow once the figures above are there, or may be written here in their groups:\n";
        later.iter().for_each(|entry| text += &format!("# {entry}\n"));
    }
    text
}
