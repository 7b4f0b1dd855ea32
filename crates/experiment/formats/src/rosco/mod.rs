//! Input of the ROSCO controller: the file that its decks call DISCON.IN, and its table of rotor coefficients.

mod coefficients;

pub use coefficients::{coefficients, parse_coefficients};

use crate::openfast::deck::Deck;
use crate::openfast::discon;
use crate::turbine_file::{Controller, TurbineFileError, controller_of};
use control::baseline::Constants;
use std::path::Path;

/// Constants of the controller whose input file stands at `path` (versions 2.6 to 2.10), estimator included.
///
/// Keys are read by name, so that their order and further ones do not matter. Rotor radius, efficiency, inertia and air
/// density are those that the file itself names; the table of coefficients is the one that it points to. Wind speeds
/// that the controller believes in are then those of ROSCO, errors of the table included.
/// Source: <https://rosco.readthedocs.io>, description of the input file; `ReadSetParameters.f90` of ROSCO.
///
/// # Errors
/// [`TurbineFileError`] naming file, line, key and what was expected: for a key that is missing or no number, for a kind of
/// control that is not known here, for a table that cannot be read.
pub fn read(path: &Path) -> Result<Constants, TurbineFileError> {
    let deck = Deck::read(path)?;
    let above_zero = |key: &'static str| {
        let number = deck.number(key)?;
        if number > 0.0 { Ok(number) } else { Err(deck.value(key)?.error("a number above zero")) }
    };
    let gear_ratio = above_zero("WE_GearboxRatio")?;
    let radius = above_zero("WE_BladeRadius")?;
    let efficiency = above_zero("VS_GenEff")? / 100.0;
    let inertia = above_zero("WE_Jtot")?;
    let air_density = above_zero("WE_RhoAir")?;
    let controller: Controller = discon::controller(&deck, gear_ratio, deck.name().to_owned())?;
    let named = deck.value("PerfFileName")?;
    let table = coefficients(&named.path()).map_err(|error| named.unread(error))?;
    let constants = controller_of(&controller, radius, efficiency);
    Ok(constants.with_estimator(inertia, air_density, table))
}

#[cfg(test)]
pub(crate) mod tests;
