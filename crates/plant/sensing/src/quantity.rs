//! The quantities that a turbine's standard instruments measure, by name.

use crate::instrument::{Instrument, Instruments};
use basis::Measurements;

/// One quantity with an instrument of its own.
#[derive(Debug)]
pub(crate) struct Quantity {
    /// Name, as the field of [`Instruments`] is called.
    pub(crate) name: &'static str,
    /// Stream of its noise, of the first blade's where there is one for each (–). A stream belongs to a
    /// quantity for good: noise of recorded runs depends on it.
    first_stream: usize,
    /// Whether it goes on beyond full turns and is shown within one.
    pub(crate) is_azimuth: bool,
    /// Its instrument among those of a turbine.
    pub(crate) instrument: fn(&Instruments) -> Instrument,
    /// Its values among what is measured: one, or one for each blade.
    pub(crate) values: for<'m> fn(&'m mut Measurements<'_>) -> &'m mut [f64],
}

/// Streams from one blade to the next (–).
const BLADE_STREAMS: usize = 3;

/// All quantities, in the order in which they are read.
pub(crate) static QUANTITIES: [Quantity; 9] = [
    Quantity {
        name: "azimuth",
        first_stream: 0,
        is_azimuth: true,
        instrument: |all| all.azimuth,
        values: |shown| std::slice::from_mut(&mut shown.azimuth),
    },
    quantity("rotor_speed", 1, |all| all.rotor_speed, |m| std::slice::from_mut(&mut m.rotor_speed)),
    quantity(
        "generator_speed",
        2,
        |all| all.generator_speed,
        |m| std::slice::from_mut(&mut m.generator_speed),
    ),
    quantity(
        "generator_torque",
        3,
        |all| all.generator_torque,
        |m| std::slice::from_mut(&mut m.generator_torque),
    ),
    quantity("power", 4, |all| all.power, |m| std::slice::from_mut(&mut m.power)),
    quantity(
        "tower_top_acceleration",
        5,
        |all| all.tower_top_acceleration,
        |m| std::slice::from_mut(&mut m.tower_top_acceleration),
    ),
    quantity("pitch", 6, |all| all.pitch, |m| &mut m.pitch),
    quantity("flap_moments", 7, |all| all.flap_moments, |m| &mut m.flap_moments),
    quantity("edge_moments", 8, |all| all.edge_moments, |m| &mut m.edge_moments),
];

const fn quantity(
    name: &'static str,
    first_stream: usize,
    instrument: fn(&Instruments) -> Instrument,
    values: for<'m> fn(&'m mut Measurements<'_>) -> &'m mut [f64],
) -> Quantity {
    Quantity { name, first_stream, is_azimuth: false, instrument, values }
}

impl Quantity {
    /// Stream of the noise of its value number `index`.
    pub(crate) fn stream(&self, index: usize) -> usize {
        self.first_stream + BLADE_STREAMS * index
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_value_has_noise_of_its_own() {
        let n_values = |quantity: &Quantity| (quantity.values)(&mut Measurements::at_rest(3)).len();
        let all = QUANTITIES.iter().map(n_values).sum::<usize>();
        let streams: BTreeSet<usize> = QUANTITIES
            .iter()
            .flat_map(|quantity| (0..n_values(quantity)).map(|index| quantity.stream(index)))
            .collect();
        assert_eq!((streams.len(), all), (15, 15));
    }
}
