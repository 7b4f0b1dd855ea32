//! What controllers know of their rotors: coefficients by blade-element momentum.

use control::baseline::CoefficientTable;
use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};
use turbine::Definition;
use turbine::aero::blade_element::Theory;
use turbine::steady::SteadyRotor;

/// Tip-speed ratios of the table (–): closest where rotors run.
const TIP_SPEED_RATIOS: [f64; 21] = [
    2.0, 3.0, 4.0, 5.0, 6.0, 6.5, 7.0, 7.5, 8.0, 8.5, 9.0, 9.5, 10.0, 10.5, 11.0, 11.5, 12.0, 13.0,
    14.0, 15.0, 16.0,
];
/// Pitch angles of the table (deg): closest where rotors take the most power.
const PITCHES_DEG: [f64; 22] = [
    -4.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0,
    22.0, 24.0, 26.0, 28.0, 30.0,
];

/// Rotors whose tables are kept (–).
const MOST_KEPT: usize = 8;

/// Tables that were made, with their rotors, oldest first: a campaign makes thousands of studies of one
/// rotor, and its table takes as long as minutes of a simulation.
static MADE: Mutex<VecDeque<(Definition, CoefficientTable)>> = Mutex::new(VecDeque::new());

/// Power and thrust coefficient of the rotor of `definition` by blade-element momentum, for its
/// [`Definition::rotor_radius`]; linear between entries half a tip-speed ratio and a degree apart where it
/// runs. A rotor that the process has met before has the table that was made then.
pub fn coefficient_table(definition: &Definition) -> CoefficientTable {
    let made = || MADE.lock().unwrap_or_else(PoisonError::into_inner);
    let known = |made: &VecDeque<(Definition, CoefficientTable)>| {
        made.iter().find(|(rotor, _)| rotor == definition).map(|(_, table)| table.clone())
    };
    if let Some(table) = known(&made()) {
        return table;
    }
    // Not under the lock: other rotors need not wait.
    let table = make(definition);
    let mut made = made();
    if known(&made).is_none() {
        if made.len() == MOST_KEPT {
            made.pop_front();
        }
        made.push_back((definition.clone(), table.clone()));
    }
    table
}

fn make(definition: &Definition) -> CoefficientTable {
    let rotor = SteadyRotor::new(definition, Theory::default());
    let pitches = PITCHES_DEG.map(f64::to_radians).to_vec();
    let of = |tip_speed_ratio: f64, pitch: f64| {
        let found = rotor.coefficients(tip_speed_ratio, pitch);
        // Where the theory has no answer the rotor is taken to give nothing.
        [found.power, found.thrust].map(|value| if value.is_finite() { value } else { 0.0 })
    };
    CoefficientTable::from_fn(TIP_SPEED_RATIOS.to_vec(), pitches, of)
        .expect("the axes above rise, and every coefficient is a number")
}
