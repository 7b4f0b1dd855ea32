//! OpenFAST input decks, read by key: order, quotes, comments and most of the differences between versions do
//! not matter.

mod aerodyn;
pub(crate) mod deck;
pub(crate) mod discon;
mod elastodyn;
mod torque_gain;
mod version;

use crate::turbine_file::{Document, DriveTrain, PitchActuator, TorqueControl, TurbineFileError};
use deck::Deck;
use std::path::Path;

/// What an import cannot find in the deck.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ImportOptions {
    /// Short name of the turbine; the stem of the main file when absent.
    pub name: Option<String>,
    /// Name of the turbine in words; the deck's title line when absent.
    pub title: Option<String>,
    /// Where the deck comes from, with commit or edition; "imported from" the main file when absent.
    pub source: Option<String>,
}

/// The turbine of the main file `path` (`.fst`), with the files that it names.
///
/// Structure, drive train and geometry come from ElastoDyn, blades and polars from AeroDyn 15, the generator
/// from ServoDyn and the controller from the ROSCO input file that ServoDyn names. A ServoDyn file without
/// one leaves the groups `controller` and `pitch_actuator` out. A file whose first line states no version is
/// taken to be of one that is read: OpenFAST up to 5 or FAST 8, AeroDyn 15, ElastoDyn 1, ServoDyn 1.
///
/// # Errors
/// [`TurbineFileError`] naming file, line, key and what was expected; also for a stated version that is not
/// read.
pub fn import(path: &Path, options: &ImportOptions) -> Result<Document, TurbineFileError> {
    let main = Deck::read(path)?;
    version::MAIN.check(&main)?;
    let elastodyn = main.deck("EDFile")?;
    version::ELASTODYN.check(&elastodyn)?;
    let aerodyn = main.deck("AeroFile")?;
    version::AERODYN.check(&aerodyn)?;
    let servodyn = main.deck("ServoFile")?;
    version::SERVODYN.check(&servodyn)?;
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    let origin = options.source.clone().unwrap_or_else(|| format!("imported from {}", main.name()));
    let source = |files: &[&Deck]| {
        let names: Vec<&str> = files.iter().map(|deck| deck.name()).collect();
        format!("{origin}: {}", names.join(", "))
    };
    let structure = elastodyn::read(&elastodyn, &source)?;
    let n_blades = elastodyn.number("NumBl")? as usize;
    let (blade, airfoils, tower_profile) = aerodyn::read(&aerodyn, &source)?;
    let mut tower = structure.tower;
    tower.profile = tower_profile;
    tower.source = format!("{}; outer shape: {}", tower.source, aerodyn.name());
    let generator_efficiency = servodyn.number("GenEff")? / 100.0;
    let gear_ratio = elastodyn.number("GBRatio")?;
    let drive_train = DriveTrain {
        source: source(&[&elastodyn, &servodyn]),
        gear_ratio,
        generator_inertia: elastodyn.number("GenIner")?,
        gearbox_efficiency: elastodyn.number("GBoxEff")? / 100.0,
        generator_efficiency,
        stiffness: elastodyn.number("DTTorSpr")?,
        damping: elastodyn.number("DTTorDmp")?,
    };
    let mut document = Document {
        name: options.name.clone().or(stem).unwrap_or_else(|| "turbine".to_owned()),
        title: options.title.clone().unwrap_or_else(|| main.title().to_owned()),
        n_blades,
        rotor: Some(structure.rotor),
        blade: Some(blade),
        blade_structure: Some(structure.blade),
        tower: Some(tower),
        hub: Some(structure.hub),
        nacelle: Some(structure.nacelle),
        drive_train: Some(drive_train),
        pitch_actuator: None,
        // No file of a deck tells.
        operation: None,
        controller: None,
        airfoils: Some(airfoils),
    };
    if let Some(discon) = servodyn.optional_deck("DLL_InFile")? {
        document.controller = Some(discon::controller(&discon, gear_ratio, source(&[&discon]))?);
        document.pitch_actuator = Some(pitch_actuator(&discon, source(&[&discon]))?);
        let torque_control = document.controller.as_ref().and_then(|known| known.torque_control);
        if torque_control == Some(TorqueControl::TipSpeedRatio) {
            let origin = format!("{} as imported", path.display());
            torque_gain::derive(&mut document, air_density(&main)?, &origin)?;
        }
    }
    Ok(document)
}

/// The pitch actuator that the controller's deck `discon` knows.
fn pitch_actuator(discon: &Deck, source: String) -> Result<PitchActuator, TurbineFileError> {
    Ok(PitchActuator {
        source,
        natural_frequency: discon.number("PA_CornerFreq")?,
        damping_ratio: discon.number("PA_Damping")?,
        maximum_rate_deg_s: discon.number("PC_MaxRat")?.to_degrees(),
        minimum_pitch_deg: discon.number("PC_MinPit")?.to_degrees(),
        maximum_pitch_deg: discon.number("PC_MaxPit")?.to_degrees(),
        swashplate: None,
    })
}

/// Air density of the deck (kg/m³); that of the standard atmosphere where the main file leaves it to the
/// modules.
///
/// # Errors
/// A density that is none.
fn air_density(main: &Deck) -> Result<f64, TurbineFileError> {
    if !main.has("AirDens") || main.value("AirDens")?.text.eq_ignore_ascii_case("default") {
        return Ok(1.225);
    }
    let density = main.number("AirDens")?;
    if density > 0.0 && density <= 5.0 {
        return Ok(density);
    }
    Err(main.value("AirDens")?.error("a density above zero, at most 5 kg/m³"))
}

#[cfg(test)]
mod numbers_tests;
#[cfg(test)]
pub(crate) mod tests;
