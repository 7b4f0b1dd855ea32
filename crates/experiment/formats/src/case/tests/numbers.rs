//! Every number of every case that comes with the program, one at a time in the place of which no number can
//! be.

use super::{is_precursor, root};
use crate::case::{parse_all, parse_precursor};
use crate::fuzz::asks_for_what_studies_write;
use crate::fuzz::numbers::{NEVER, numbers_of};
use std::fs;
use std::path::Path;

/// Keys whose numbers may be negative: places, angles, exponents.
const SIGNED: [&str; 7] = [
    "turbine.position_diameters",
    "wind.cut.shift",
    "output.crosswind_diameters",
    "wind.shear_exponent",
    "offset_deg",
    "yaw_deg",
    "atmosphere.latitude_deg",
];

#[test]
fn what_no_number_can_be_is_refused_wherever_it_stands() {
    let mut n_numbers = 0;
    for entry in fs::read_dir(root().join("cases")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        if asks_for_what_studies_write(&text) {
            continue;
        }
        let refusal = |text: &str| {
            let name = Path::new("case.toml");
            if is_precursor(&path) {
                parse_precursor(name, text, &[]).err()
            } else {
                parse_all("case.toml", text, &[]).err()
            }
        };
        for number in numbers_of(&text) {
            n_numbers += 1;
            let key = number.key.rsplit('.').next().unwrap();
            let written = text[number.bytes.clone()].trim_start_matches('-');
            let is_zero = written.parse() == Ok(0.0);
            let negative = if is_zero { "-1".to_owned() } else { format!("-{written}") };
            let is_signed = SIGNED.iter().any(|signed| number.key.ends_with(signed));
            for bad in NEVER.into_iter().chain((!is_signed).then_some(negative.as_str())) {
                let mut damaged = text.clone();
                damaged.replace_range(number.bytes.clone(), bad);
                let lines = refusal(&damaged)
                    .unwrap_or_else(|| panic!("{}, {} = {bad}", path.display(), number.key))
                    .to_lines();
                let line = 1 + text[..number.bytes.start].matches('\n').count();
                let told =
                    lines.lines().find(|told| told.starts_with(&format!("case.toml:{line}: ")));
                let told = told.unwrap_or_else(|| panic!("{lines}, expected line {line}"));
                assert!(told.contains(key), "{told}, expected {key}");
            }
        }
    }
    assert!(n_numbers > 200, "{n_numbers}");
}
