//! Two turbines with a helix on the first in four winds, beside a published study with free vortices.

use crate::Row;
use crate::four_winds::{
    Changes, FIRST_SEED, FREE, FarmWind, OPEN, QUANTITIES, WHOSE, WINDS, all_changes, over_shared,
    print_changes, series_of, together,
};
use crate::row::Tolerance::{AtLeast, AtMost};
use crate::studies::failure;

/// Where the expected signs come from: its text, for figure 11 shows bars without figures. It has one seed,
/// and gives no interval.
const SOURCE: &str = "Chen, van Vondelen, van Wingerden (2026), section 4.2";

/// Seeds of the turbulence.
const SEEDS: [u64; 3] = [FIRST_SEED, 2, 3];

/// Signs that the source tells of, and no others: wind, quantity and whose by number, and whether it is
/// more than in OL1. Shear: power of both turbines is less, and so are the sums of their loads. Turbulence:
/// power and loads of each are more. Both: the sum of power is less, those of loads are more.
const SIGNS: [(usize, usize, usize, bool); 13] = [
    (1, 0, 0, false),
    (1, 0, 1, false),
    (1, 1, 2, false),
    (1, 2, 2, false),
    (2, 0, 0, true),
    (2, 0, 1, true),
    (2, 1, 0, true),
    (2, 1, 1, true),
    (2, 2, 0, true),
    (2, 2, 1, true),
    (3, 0, 2, false),
    (3, 1, 2, true),
    (3, 2, 2, true),
];

/// Makes the open loops of `cases/lidar-closed-loop.toml`, which are the helices of `lidar-open-loop.toml`
/// with a lidar that watches, in its four winds, and those in turbulence with further seeds; prints all
/// changes with their intervals, and gives those of whose sign the source tells as rows.
pub(super) fn rows() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let mut even = None;
    let of_winds = FREE.of_winds(&SEEDS, &[OPEN], |folder, wind, seed| {
        let now = series_of(folder, wind, OPEN)?;
        let changes = all_changes(&now, even.get_or_insert_with(|| now.clone()))?;
        print_changes(&format!("OL{} over OL1, seed {seed}", wind.number), &changes);
        Ok(changes)
    })?;
    let mut all = Vec::new();
    for (wind, of_seeds) in WINDS.into_iter().zip(&of_winds) {
        let mut changes = together(of_seeds)?;
        if let (true, Some(even)) = (wind.has_seeds(), &even) {
            changes = over_shared(changes, even)?;
            let words = format!("OL{} over OL1, {} seeds", wind.number, of_seeds.len());
            print_changes(&words, &changes);
        }
        all.push(changes);
    }
    Ok(SIGNS.into_iter().map(|sign| row(sign, &all[sign.0])).collect())
}

/// The row of one of [`SIGNS`], of the `changes` in its wind.
fn row((wind, quantity, index, is_more): (usize, usize, usize, bool), changes: &[Changes]) -> Row {
    let FarmWind { number, shear, intensity } = WINDS[wind];
    let (what, ..) = QUANTITIES[quantity];
    let whose = WHOSE[index];
    let seeds = match WINDS[wind].has_seeds() {
        true => format!(", mean of {} seeds", SEEDS.len()),
        false => String::new(),
    };
    Row {
        what: format!(
            "OL{number} (shear {shear}, intensity {intensity}), two nrel-5mw at 4 D, helix 3° ccw on T1, St 0.3, 10 m/s, 10 min{seeds}: change of {what} of {whose} over OL1 (even)"
        ),
        measured: changes[quantity][index].mean,
        expected: 0.0,
        tolerance: if is_more { AtLeast } else { AtMost },
        unit: "%",
        source: SOURCE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_of_other_winds_than_the_even_one() {
        for (index, sign) in SIGNS.iter().enumerate() {
            assert!((1..WINDS.len()).contains(&sign.0), "{sign:?}");
            assert!(sign.1 < QUANTITIES.len() && sign.2 < WHOSE.len(), "{sign:?}");
            let same =
                |other: &&(usize, usize, usize, bool)| other.0 == sign.0 && other.1 == sign.1;
            let again = SIGNS[..index].iter().filter(same).any(|other| other.2 == sign.2);
            assert!(!again, "{sign:?}");
        }
    }
}
