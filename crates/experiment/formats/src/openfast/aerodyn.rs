//! AeroDyn 15: outer shape of blades and tower, polars.

use super::deck::{Deck, Table, Value};
use super::elastodyn::Source;
use super::version;
use crate::turbine_file::{Airfoils, Blade, PolarTable, Station, TurbineFileError, Unsteady};

/// Airfoil files at most (–): all are held at once, also one that is named again and again.
const MOST_FILES: usize = 1000;

/// Blade, polars, and the tower's height (m), diameter (m) and drag coefficient (–).
pub(super) type Aerodynamics = (Blade, Airfoils, Vec<[f64; 3]>);

pub(super) fn read(deck: &Deck, source: &Source) -> Result<Aerodynamics, TurbineFileError> {
    let n_files = deck.value("NumAFfiles")?;
    let count = n_files.count()?;
    if count > MOST_FILES {
        return Err(n_files.error(&format!("a number up to {MOST_FILES}")));
    }
    let columns = [
        column(deck, "InCol_Alfa")?,
        column(deck, "InCol_Cl")?,
        column(deck, "InCol_Cd")?,
        column(deck, "InCol_Cm")?,
    ];
    let files = deck.list("AFNames", count)?;
    let polars: Vec<PolarTable> =
        files.iter().map(|file| polar(&file.deck()?, &columns)).collect::<Result<_, _>>()?;
    let blade_deck = deck.deck("ADBlFile(1)")?;
    version::AERODYN.check(&blade_deck)?;
    let blade = blade(&blade_deck, &polars, source)?;
    let mut used: Vec<PolarTable> = Vec::new();
    for polar in polars {
        if blade.stations.iter().any(|station| station.5 == polar.name) {
            used.push(polar);
        }
    }
    let source = format!("{} and the {} airfoil files it names", source(&[deck]), used.len());
    Ok((blade, Airfoils { source, polar: used }, tower(deck)?))
}

/// Column (from 0) that the value before `key` (from 1) names; none for 0.
fn column(deck: &Deck, key: &str) -> Result<Option<usize>, TurbineFileError> {
    let value = deck.value(key)?;
    let number = value.number()?;
    if number < 0.0 || number.fract() != 0.0 || number > 20.0 {
        return Err(value.error("the number of a column, or 0"));
    }
    Ok((number as usize).checked_sub(1))
}

fn blade(deck: &Deck, polars: &[PolarTable], source: &Source) -> Result<Blade, TurbineFileError> {
    let names = ["BlSpn", "BlCrvAC", "BlSwpAC", "BlCrvAng", "BlTwist", "BlChord", "BlAFID"];
    let table = deck.table("NumBlNds", &names)?;
    let spans = table.column("BlSpn")?;
    let curves = table.column("BlCrvAC")?;
    let sweeps = table.column("BlSwpAC")?;
    let twists = table.column("BlTwist")?;
    let chords = table.column("BlChord")?;
    let airfoils = table.column("BlAFID")?;
    let station = |row: usize| -> Result<Station, TurbineFileError> {
        let polar = polar_number(&table, row, airfoils[row], polars)?;
        let name = polars[polar].name.clone();
        Ok((spans[row], chords[row], twists[row], -curves[row], sweeps[row], name))
    };
    let stations = (0..spans.len()).map(station).collect::<Result<_, _>>()?;
    Ok(Blade { source: source(&[deck]), stations })
}

fn polar_number(
    table: &Table,
    row: usize,
    number: f64,
    polars: &[PolarTable],
) -> Result<usize, TurbineFileError> {
    if number.fract() == 0.0 && (1.0..=polars.len() as f64).contains(&number) {
        return Ok(number as usize - 1);
    }
    let expected = format!("the number of an airfoil file, 1 to {}", polars.len());
    Err(table.error(row, "BlAFID", &expected, &number.to_string()))
}

fn tower(deck: &Deck) -> Result<Vec<[f64; 3]>, TurbineFileError> {
    let table = deck.table("NumTwrNds", &["TwrElev", "TwrDiam", "TwrCd", "TwrTI", "TwrCb"])?;
    let (heights, diameters) = (table.column("TwrElev")?, table.column("TwrDiam")?);
    let drag = table.column("TwrCd")?;
    Ok((0..heights.len()).map(|row| [heights[row], diameters[row], drag[row]]).collect())
}

/// The first table of an airfoil file.
fn polar(deck: &Deck, columns: &[Option<usize>; 4]) -> Result<PolarTable, TurbineFileError> {
    let table = deck.table("NumAlf", &["Alpha", "Cl", "Cd", "Cm"])?;
    let numbers = |index: usize, name: &str| match columns[index] {
        Some(column) => table.column_at(column, name),
        None => Ok(Vec::new()),
    };
    let (angles, lift, drag) = (numbers(0, "Alpha")?, numbers(1, "Cl")?, numbers(2, "Cd")?);
    let moment = numbers(3, "Cm")?;
    let row = |row: usize| {
        let at = |column: &[f64]| column.get(row).copied().unwrap_or(0.0);
        [at(&angles), at(&lift), at(&drag), at(&moment)]
    };
    let name = deck.name().rsplit_once('.').map_or(deck.name(), |(stem, _)| stem);
    Ok(PolarTable {
        name: name.to_owned(),
        // In millions there.
        reynolds_number: if deck.has("Re") { Some(1e6 * deck.number("Re")?) } else { None },
        unsteady: unsteady(deck)?,
        table: (0..angles.len()).map(row).collect(),
    })
}

fn unsteady(deck: &Deck) -> Result<Option<Unsteady>, TurbineFileError> {
    let given =
        deck.has("InclUAdata") && deck.value("InclUAdata")?.text.to_lowercase().starts_with('t');
    if !given || !deck.has("alpha0") || is_default(&deck.value("alpha0")?) {
        return Ok(None);
    }
    Ok(Some(Unsteady {
        zero_lift_angle_deg: deck.number("alpha0")?,
        upper_separation_angle_deg: deck.number("alpha1")?,
        lower_separation_angle_deg: deck.number("alpha2")?,
        normal_force_slope: deck.number("C_nalpha")?,
        upper_critical_normal_force: deck.number("Cn1")?,
        lower_critical_normal_force: deck.number("Cn2")?,
        zero_lift_drag: deck.number("Cd0")?,
        zero_lift_moment: deck.number("Cm0")?,
        time_constants: all_given(deck, ["T_f0", "T_V0", "T_p", "T_VL"])?,
        indicial_amplitudes: all_given(deck, ["A1", "A2", "A5"])?,
        indicial_exponents: all_given(deck, ["b1", "b2", "b5"])?,
    }))
}

fn is_default(value: &Value) -> bool {
    value.text.eq_ignore_ascii_case("default")
}

/// The numbers before `keys`; nothing when one is missing or left to the program's default.
fn all_given<const N: usize>(
    deck: &Deck,
    keys: [&str; N],
) -> Result<Option<[f64; N]>, TurbineFileError> {
    let mut numbers = [0.0; N];
    for (number, key) in numbers.iter_mut().zip(keys) {
        if !deck.has(key) || is_default(&deck.value(key)?) {
            return Ok(None);
        }
        *number = deck.number(key)?;
    }
    Ok(Some(numbers))
}
