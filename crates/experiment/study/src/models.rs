//! The turbines of a case: each kind of machine once, with the controller that the case gives it.

use crate::StudyError;
use farm::assemble::TurbineModel;
use farm::case::{Case, Placement};
use farm::plan::Footprint;
use formats::case::{CaseFile, objection};
use formats::rosco::{self, Discon};
use formats::turbine_file::{TurbineFile, TurbineFileError};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use turbine::Definition;

/// Radius of the rotor in a controller's input file over the turbine's, less one, beyond which a reader must
/// know (–).
const RADIUS_TO_WARN: f64 = 0.05;

/// The kinds of machine that stand in a case.
#[derive(Default)]
pub(crate) struct Machines {
    /// By the name of the machine, [`Placement::machine`].
    pub(crate) models: BTreeMap<String, TurbineModel>,
    /// Text of each turbine model's file by the model's name, and of each controller's input file and its
    /// table by the names that [`text_names`] gives.
    pub(crate) texts: BTreeMap<String, String>,
    /// What a reader of the numbers must know.
    pub(crate) warnings: Vec<String>,
}

impl Machines {
    /// What the layout needs to know of each, in a mean wind of `wind_speed` (m/s).
    pub(crate) fn footprints(&self, wind_speed: f64) -> BTreeMap<String, Footprint> {
        let of =
            |(name, model): (&String, &TurbineModel)| (name.clone(), model.footprint(wind_speed));
        self.models.iter().map(of).collect()
    }

    /// The model of each turbine of `case`, in its order, equipped for its wind; all kinds are there.
    pub(crate) fn equipped(&self, case: &Case) -> Vec<TurbineModel> {
        // Once a kind, not once a turbine and run: a table of coefficients takes a fraction of a second.
        let equip = |model: &TurbineModel| {
            model.equipped(case.flow.solver, case.wind.air_density).into_owned()
        };
        let equipped: BTreeMap<&String, TurbineModel> =
            self.models.iter().map(|(name, model)| (name, equip(model))).collect();
        case.turbines.iter().map(|placement| equipped[&placement.machine()].clone()).collect()
    }
}

/// The machines of the case in `file`.
///
/// # Errors
/// [`StudyError`] for a turbine or a controller's input file that cannot be used.
pub(crate) fn load(file: &CaseFile) -> Result<Machines, StudyError> {
    let mut machines = Machines::default();
    for placement in &file.case.turbines {
        if machines.models.contains_key(&placement.machine()) {
            continue;
        }
        let (text, turbine) = turbine(&placement.model, file.folder())?;
        machines.texts.insert(placement.model.clone(), text);
        let mut constants = turbine.controller;
        if let Some(path) = &placement.discon {
            let discon = discon_of(file, placement, path)?;
            machines.warnings.extend(warnings(placement, path, &discon, &turbine.definition));
            let [name, table_name] = text_names(path);
            machines.texts.insert(name, discon.text);
            // Empty where there is none, so that one that appears later is noticed.
            machines.texts.insert(table_name, discon.table_text);
            constants = discon.constants;
        }
        if let Some(gain) = placement.torque_gain {
            constants.torque_gain = gain;
        }
        let model = TurbineModel { definition: Arc::new(turbine.definition), constants };
        machines.models.insert(placement.machine(), model);
    }
    Ok(machines)
}

/// Names under which the texts of the controller's input file at `path` and of its table of coefficients are
/// kept.
pub(crate) fn text_names(path: &str) -> [String; 2] {
    [format!("discon {path}"), format!("PerfFileName of discon {path}")]
}

/// The turbine of the library called `model`, or that in the file of this path, relative to `folder`; with
/// its text.
pub(crate) fn turbine(model: &str, folder: &Path) -> Result<(String, TurbineFile), StudyError> {
    if let Some(text) = formats::library::text(model) {
        return Ok((text.to_owned(), formats::library::load(model)?));
    }
    let path = folder.join(model);
    if path.is_file() {
        let text = formats::atomic::read_text(&path, "a turbine file")?;
        let parsed = formats::turbine_file::parse(&path.display().to_string(), &text)?;
        return Ok((text, parsed));
    }
    // Neither: the library says what there is.
    Ok((String::new(), formats::library::load(model)?))
}

/// The controller's input file at `path`, relative to the folder of `file`; one that cannot be opened is
/// pointed at there.
fn discon_of(file: &CaseFile, placement: &Placement, path: &str) -> Result<Discon, StudyError> {
    rosco::read(&file.folder().join(path)).map_err(|error| match error {
        TurbineFileError::Unreadable { path, source, .. } => {
            let message = format!(
                "{} has no controller: cannot read {} ({source}); put ROSCO's DISCON.IN there, or correct the path",
                placement.name,
                path.display()
            );
            let key = ["turbine", placement.name.as_str(), "discon"];
            StudyError::Case(objection(file, &key, message))
        }
        error => StudyError::Turbine(error),
    })
}

fn warnings(
    placement: &Placement,
    path: &str,
    discon: &Discon,
    definition: &Definition,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if let Some(table) = &discon.missing_table {
        warnings.push(format!(
            "{path} names a table of coefficients that is not there, {}: where the controller needs one it gets that of {}'s own \
             blade-element momentum",
            table.display(),
            placement.model
        ));
    }
    let (given, radius) = (discon.constants.rotor_radius, definition.rotor_radius());
    if (given / radius - 1.0).abs() > RADIUS_TO_WARN {
        warnings.push(format!(
            "{path} is for a rotor of {given:.1} m radius, and controls {} of {radius:.1} m",
            placement.model
        ));
    }
    warnings
}
