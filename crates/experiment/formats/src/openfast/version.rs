//! Versions of OpenFAST's files: what the first line states must be one that is read.

use super::deck::Deck;
use crate::turbine_file::TurbineFileError;

/// A kind of file, and the versions of it that are read.
pub(super) struct Format {
    /// Module of OpenFAST that the file belongs to.
    module: &'static str,
    /// Numbers before the first dot.
    versions: &'static [u32],
}

/// The main file: OpenFAST up to 5, and FAST 8 before it, whose keys are the same.
pub(super) const MAIN: Format = Format { module: "OpenFAST", versions: &[0, 1, 2, 3, 4, 5, 8] };
/// AeroDyn's main file and blade.
pub(super) const AERODYN: Format = Format { module: "AeroDyn", versions: &[15] };
/// ElastoDyn's main file, blade and tower.
pub(super) const ELASTODYN: Format = Format { module: "ElastoDyn", versions: &[1] };
/// ServoDyn's main file.
pub(super) const SERVODYN: Format = Format { module: "ServoDyn", versions: &[1] };

impl Format {
    /// Nothing when the first line of `deck` states a version that is read, or none at all, as many do.
    pub(super) fn check(&self, deck: &Deck) -> Result<(), TurbineFileError> {
        let Some(version) = stated(deck.heading()) else { return Ok(()) };
        let first = version.split('.').next().and_then(|number| number.parse::<u32>().ok());
        if first.is_some_and(|number| self.versions.contains(&number)) {
            return Ok(());
        }
        let known: Vec<String> = self.versions.iter().map(|number| format!("v{number}")).collect();
        Err(deck.error(
            1,
            self.module,
            format!("version {}", known.join(" or ")),
            format!("v{version}"),
            "convert the deck to such a version with openfast_toolbox, or state one of them in this line if the format is the same",
        ))
    }
}

/// Digits and dots after the first `v` that begins a word and has a digit behind it: `15.03` of
/// `AERODYN v15.03.* INPUT FILE`.
fn stated(heading: &str) -> Option<&str> {
    heading.match_indices(['v', 'V']).find_map(|(place, _)| {
        if heading[..place].ends_with(char::is_alphanumeric) {
            return None;
        }
        let rest = &heading[place + 1..];
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let version = rest[..end].trim_end_matches('.');
        version.starts_with(|c: char| c.is_ascii_digit()).then_some(version)
    })
}

#[cfg(test)]
mod tests {
    use super::stated;

    #[test]
    fn versions_are_found_in_headings() {
        for (heading, expected) in [
            ("------- AERODYN v15.03.* INPUT FILE ----", Some("15.03")),
            ("------- AERODYN v15 for OpenFAST INPUT FILE ----", Some("15")),
            ("------- ELASTODYN V1.00.* TOWER INPUT FILE ----", Some("1.00")),
            ("! ------------ AirfoilInfo v1.01.x Input File", Some("1.01")),
            ("------- FAST v8.16.* INPUT FILE ----", Some("8.16")),
            ("------- OpenFAST example INPUT FILE ----", None),
            ("------- ELASTODYN for OpenFAST INPUT FILE ----", None),
            ("a very vague heading of rev2 — v. 3", None),
            ("é v9", Some("9")),
            ("", None),
        ] {
            assert_eq!(stated(heading), expected, "{heading}");
        }
    }
}
