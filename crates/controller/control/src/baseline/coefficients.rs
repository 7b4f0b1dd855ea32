//! Power and thrust coefficient of a rotor, tabulated for use while it runs.

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Power and thrust coefficient against tip-speed ratio and collective pitch.
///
/// Bilinear between the rows and columns, constant beyond them; a look-up allocates nothing. Coefficients
/// refer to the free-stream speed and to the disc of the radius that tip-speed ratios are formed with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CoefficientTable {
    tip_speed_ratios: Vec<f64>,
    pitches: Vec<f64>,
    power: Vec<f64>,
    thrust: Vec<f64>,
}

/// Why figures are no table of coefficients.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum CoefficientTableError {
    /// Too few rows or columns, or they do not increase.
    #[error("{axis}: two or more increasing numbers are needed, entry {entry} does not increase")]
    Axis {
        /// "tip-speed ratios" or "pitch angles".
        axis: &'static str,
        /// Entry at fault, from 1 (–).
        entry: usize,
    },
    /// More or fewer coefficients than rows times columns.
    #[error("{coefficient} coefficients: {expected} are needed, {found} are there")]
    Count {
        /// "power" or "thrust".
        coefficient: &'static str,
        /// Rows times columns (–).
        expected: usize,
        /// Coefficients given (–).
        found: usize,
    },
    /// A coefficient that is not a number.
    #[error("{coefficient} coefficient {entry} is not a number")]
    NotFinite {
        /// "power" or "thrust".
        coefficient: &'static str,
        /// Entry at fault, from 1, row after row (–).
        entry: usize,
    },
}

/// Where a value lies between the entries of an axis.
#[derive(Clone, Copy)]
struct Place {
    low: usize,
    /// Share of the entry after `low` (–, 0 to 1).
    share: f64,
}

impl CoefficientTable {
    /// The table of `power` and `thrust` (–), `n_tip_speed_ratios × n_pitches` each, row after row of one
    /// tip-speed ratio; `tip_speed_ratios` (–) and `pitches` (rad) rise.
    ///
    /// # Errors
    /// [`CoefficientTableError`] when an axis has fewer than two entries or does not rise, or when there are
    /// more or fewer coefficients than places for them, or one is not a number.
    pub fn new(
        tip_speed_ratios: Vec<f64>,
        pitches: Vec<f64>,
        power: Vec<f64>,
        thrust: Vec<f64>,
    ) -> Result<Self, CoefficientTableError> {
        for (axis, entries) in [("tip-speed ratios", &tip_speed_ratios), ("pitch angles", &pitches)]
        {
            if let Some(entry) = first_that_breaks(entries) {
                return Err(CoefficientTableError::Axis { axis, entry });
            }
        }
        let expected = tip_speed_ratios.len() * pitches.len();
        for (coefficient, values) in [("power", &power), ("thrust", &thrust)] {
            if values.len() != expected {
                let found = values.len();
                return Err(CoefficientTableError::Count { coefficient, expected, found });
            }
            if let Some(index) = values.iter().position(|value| !value.is_finite()) {
                return Err(CoefficientTableError::NotFinite { coefficient, entry: index + 1 });
            }
        }
        Ok(Self { tip_speed_ratios, pitches, power, thrust })
    }

    /// The table of `of` (tip-speed ratio (–), pitch (rad) to power and thrust coefficient (–)) at rising
    /// `tip_speed_ratios` (–) and `pitches` (rad).
    ///
    /// # Errors
    /// As [`CoefficientTable::new`].
    pub fn from_fn(
        tip_speed_ratios: Vec<f64>,
        pitches: Vec<f64>,
        mut of: impl FnMut(f64, f64) -> [f64; 2],
    ) -> Result<Self, CoefficientTableError> {
        let n = tip_speed_ratios.len() * pitches.len();
        let (mut power, mut thrust) = (Vec::with_capacity(n), Vec::with_capacity(n));
        for tip_speed_ratio in &tip_speed_ratios {
            for pitch in &pitches {
                let [p, t] = of(*tip_speed_ratio, *pitch);
                power.push(p);
                thrust.push(t);
            }
        }
        Self::new(tip_speed_ratios, pitches, power, thrust)
    }

    /// Tip-speed ratios of the rows (–).
    pub fn tip_speed_ratios(&self) -> &[f64] {
        &self.tip_speed_ratios
    }

    /// Pitch angles of the columns (rad).
    pub fn pitches(&self) -> &[f64] {
        &self.pitches
    }

    /// Power coefficient (–) at `tip_speed_ratio` (–) and `pitch` (rad).
    pub fn power(&self, tip_speed_ratio: f64, pitch: f64) -> f64 {
        self.between(&self.power, tip_speed_ratio, pitch)
    }

    /// Thrust coefficient (–) at `tip_speed_ratio` (–) and `pitch` (rad).
    pub fn thrust(&self, tip_speed_ratio: f64, pitch: f64) -> f64 {
        self.between(&self.thrust, tip_speed_ratio, pitch)
    }

    /// Change of the power coefficient per tip-speed ratio (–), at `tip_speed_ratio` (–) and `pitch` (rad);
    /// zero beyond the rows.
    pub fn power_slope(&self, tip_speed_ratio: f64, pitch: f64) -> f64 {
        let rows = &self.tip_speed_ratios;
        if tip_speed_ratio <= rows[0] || tip_speed_ratio >= rows[rows.len() - 1] {
            return 0.0;
        }
        let (row, column) = (place(rows, tip_speed_ratio), place(&self.pitches, pitch));
        let [low, high] = [0, 1].map(|step| self.in_row(&self.power, row.low + step, column));
        (high - low) / (rows[row.low + 1] - rows[row.low])
    }

    /// Greatest tip-speed ratio λ (–) at which C_P/λ³ reaches `power_over_cube` (–) at `pitch` (rad): the one
    /// at which a rotor of known speed and pitch gives a known power, on the branch where more wind gives
    /// more power.
    ///
    /// The least of the table's tip-speed ratios where none gives that much.
    pub fn tip_speed_ratio(&self, power_over_cube: f64, pitch: f64) -> f64 {
        let rows = &self.tip_speed_ratios;
        let column = place(&self.pitches, pitch);
        let excess = |row: usize| {
            self.in_row(&self.power, row, column) - power_over_cube * rows[row].powi(3)
        };
        let last = rows.len() - 1;
        if excess(last) >= 0.0 {
            return rows[last];
        }
        let Some(row) = (0..last).rev().find(|row| excess(*row) >= 0.0) else { return rows[0] };
        let [p, q] = [row, row + 1].map(|row| self.in_row(&self.power, row, column));
        let (mut low, mut high) = (rows[row], rows[row + 1]);
        let width = high - low;
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let power = p + (middle - rows[row]) / width * (q - p);
            if power >= power_over_cube * middle.powi(3) { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    fn between(&self, values: &[f64], tip_speed_ratio: f64, pitch: f64) -> f64 {
        let row = place(&self.tip_speed_ratios, tip_speed_ratio);
        let column = place(&self.pitches, pitch);
        let [low, high] = [0, 1].map(|step| self.in_row(values, row.low + step, column));
        low + row.share * (high - low)
    }

    fn in_row(&self, values: &[f64], row: usize, column: Place) -> f64 {
        let at = row * self.pitches.len() + column.low;
        values[at] + column.share * (values[at + 1] - values[at])
    }
}

/// Entry (from 1) at which `entries` is no rising list of two or more numbers.
fn first_that_breaks(entries: &[f64]) -> Option<usize> {
    if entries.len() < 2 {
        return Some(entries.len());
    }
    let rises = |k: usize| entries[k].is_finite() && (k == 0 || entries[k] > entries[k - 1]);
    (0..entries.len()).find(|k| !rises(*k)).map(|k| k + 1)
}

/// Place of `value` on a rising `axis`; at its nearer end beyond it, at its first entry where it is no
/// number.
fn place(axis: &[f64], value: f64) -> Place {
    let low = axis.partition_point(|entry| *entry <= value).clamp(1, axis.len() - 1) - 1;
    let share = (value - axis[low]) / (axis[low + 1] - axis[low]);
    let share = if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) };
    Place { low, share }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table(of: impl Fn(f64, f64) -> f64) -> CoefficientTable {
        let ratios = vec![2.0, 3.0, 5.0, 9.0];
        CoefficientTable::from_fn(ratios, vec![-0.1, 0.0, 0.3], |l, p| [of(l, p), 2.0 * of(l, p)])
            .expect("axes rise")
    }

    proptest! {
        #[test]
        fn a_bilinear_function_is_met_everywhere(
            a in -1.0..1.0_f64, b in -1.0..1.0_f64, c in -1.0..1.0_f64, d in -1.0..1.0_f64,
            ratio in 2.0..9.0_f64, pitch in -0.1..0.3_f64,
        ) {
            let of = |l: f64, p: f64| a + b * l + c * p + d * l * p;
            let table = table(of);
            prop_assert!((table.power(ratio, pitch) - of(ratio, pitch)).abs() < 1e-12);
            prop_assert!((table.thrust(ratio, pitch) - 2.0 * of(ratio, pitch)).abs() < 1e-12);
            prop_assert!((table.power_slope(ratio, pitch) - (b + d * pitch)).abs() < 1e-10);
        }

        #[test]
        fn the_tip_speed_ratio_of_a_power_gives_that_power(
            ratio in 3.0..8.9_f64, pitch in -0.1..0.3_f64,
        ) {
            // C_P/λ³ falls throughout, so that there is one such ratio.
            let table = table(|l, p| 0.4 + 0.01 * l - 0.2 * p);
            let found = table.tip_speed_ratio(table.power(ratio, pitch) / ratio.powi(3), pitch);
            prop_assert!((found - ratio).abs() < 1e-9, "{found} for {ratio}");
        }
    }

    #[test]
    fn beyond_its_edges_it_is_constant_and_no_number_is_its_first_entry() {
        let table = table(|l, p| l + 10.0 * p);
        assert_eq!(table.power(1.0, -9.0), table.power(2.0, -0.1));
        assert_eq!(table.power(99.0, 9.0), table.power(9.0, 0.3));
        assert_eq!(table.power_slope(99.0, 0.0), 0.0);
        assert_eq!(table.power(f64::NAN, f64::NAN), table.power(2.0, -0.1));
        assert_eq!(table.tip_speed_ratio(1e9, 0.0), 2.0);
        assert_eq!(table.tip_speed_ratio(0.0, 0.0), 9.0);
    }

    #[test]
    fn what_is_no_table_is_refused_with_its_place() {
        let new = |ratios: &[f64], power: usize, last: f64| {
            let mut powers = vec![0.1; power];
            powers[power - 1] = last;
            CoefficientTable::new(ratios.to_vec(), vec![0.0, 0.1], powers, vec![0.1; 6])
                .map_err(|error| error.to_string())
        };
        assert!(new(&[1.0, 2.0, 3.0], 6, 0.1).is_ok());
        let refused = |result: Result<CoefficientTable, String>| result.expect_err("refused");
        assert!(
            refused(new(&[1.0, 3.0, 2.0], 6, 0.1))
                .contains("ratios: two or more increasing numbers are needed, entry 3")
        );
        assert!(refused(new(&[1.0], 2, 0.1)).contains("entry 1"));
        assert!(refused(new(&[1.0, 2.0, 3.0], 5, 0.1)).contains("6 are needed, 5 are there"));
        assert!(
            refused(new(&[1.0, 2.0, 3.0], 6, f64::NAN)).contains("coefficient 6 is not a number")
        );
    }
}
