//! Input of the ROSCO controller: the file that its decks call DISCON.IN, and its table of rotor
//! coefficients.

mod coefficients;
mod limits;

pub use coefficients::parse_coefficients;

use crate::atomic;
use crate::openfast::deck::Deck;
use crate::openfast::discon;
use crate::turbine_file::{Controller, TurbineFileError, controller_of};
use control::baseline::Constants;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// What an input file of the controller says, with the texts that say it.
#[derive(Clone, Debug, PartialEq)]
pub struct Discon {
    /// Constants of the controller; with the estimator of the wind speed where the table of coefficients is
    /// there.
    pub constants: Constants,
    /// Text of the file.
    pub text: String,
    /// Text of the table of coefficients; empty where there is none.
    pub table_text: String,
    /// The table that the file names, where no such file is there.
    pub missing_table: Option<PathBuf>,
}

/// The controller whose input file stands at `path` (versions 2.6 to 2.10).
///
/// Keys are read by name, so that their order and further ones do not matter. Rotor radius, efficiency,
/// inertia and air density are those that the file itself names; the table of coefficients is the one that it
/// points to. Wind speeds of the controller are then those of ROSCO, errors of the table included. Without a
/// table the constants come without an estimator.
/// Source: <https://rosco.readthedocs.io>, description of the input file; `ReadSetParameters.f90` of ROSCO.
///
/// # Errors
/// [`TurbineFileError`] naming file, line, key and what was expected: for a key that is missing or no number,
/// for a kind of control that is not known here, for a figure that no controller can have, for a table that
/// is there but cannot be read.
pub fn read(path: &Path) -> Result<Discon, TurbineFileError> {
    // Decks carry degree signs in whatever encoding their author's editor had.
    let bytes =
        atomic::read_whole(path).map_err(|source| TurbineFileError::unreadable(path, source))?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let deck = Deck::parse(path, &text);
    let above_zero = |key: &'static str, most: f64| {
        let number = deck.number(key)?;
        let expected = || format!("a number above zero, at most {most}");
        let fits = number > 0.0 && number <= most;
        if fits { Ok(number) } else { Err(deck.value(key)?.error(&expected())) }
    };
    let gear_ratio = above_zero("WE_GearboxRatio", 1e3)?;
    let radius = above_zero("WE_BladeRadius", 300.0)?;
    let efficiency = above_zero("VS_GenEff", 100.0)? / 100.0;
    let inertia = above_zero("WE_Jtot", 1e12)?;
    let air_density = above_zero("WE_RhoAir", 5.0)?;
    let controller: Controller = discon::controller(&deck, gear_ratio, deck.name().to_owned())?;
    limits::check(&controller, &deck, &path.display().to_string())?;
    let mut constants = controller_of(&controller, radius, efficiency);
    let (mut table_text, mut missing_table) = (String::new(), None);
    if deck.has("PerfFileName") {
        let named = deck.value("PerfFileName")?;
        let place = named.path();
        match atomic::read_whole(&place) {
            Ok(bytes) => {
                table_text = String::from_utf8_lossy(&bytes).into_owned();
                let table = parse_coefficients(&place.display().to_string(), &table_text)?;
                constants = constants.with_estimator(inertia, air_density, table);
            }
            Err(source) if source.kind() == ErrorKind::NotFound => missing_table = Some(place),
            Err(source) => return Err(named.unread(TurbineFileError::unreadable(&place, source))),
        }
    }
    Ok(Discon { constants, text, table_text, missing_table })
}

#[cfg(test)]
pub(crate) mod tests;
