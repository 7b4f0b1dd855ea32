//! What becomes of a turbine that a wind or a command has driven out of all bounds.

use thiserror::Error;

/// A quantity of a turbine that is no longer a finite number.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{quantity} is {value} {unit}")]
pub struct Breakdown {
    /// What it is, in words.
    pub quantity: &'static str,
    /// Its value in that unit, infinite or not a number.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

impl Breakdown {
    /// # Errors
    /// The first of `quantities` (words, value, unit) that is not finite.
    pub(crate) fn among(
        quantities: impl IntoIterator<Item = (&'static str, f64, &'static str)>,
    ) -> Result<(), Self> {
        let found = quantities.into_iter().find(|(_, value, _)| !value.is_finite());
        found.map_or(Ok(()), |(quantity, value, unit)| Err(Self { quantity, value, unit }))
    }
}

/// `value`, kept between `least` and `most`: the bits of `clamp`, which panics where a limit is no number.
pub(crate) fn within(value: f64, [least, most]: [f64; 2]) -> f64 {
    if value < least {
        least
    } else if value > most {
        most
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_hold_as_a_clamp_does_and_may_be_no_number() {
        for value in [-3.0, -1.0, -0.0, 0.0, 0.4, 1.0, 7.0, f64::NAN, f64::NEG_INFINITY] {
            let expected = f64::clamp(value, -1.0, 1.0);
            assert_eq!(within(value, [-1.0, 1.0]).to_bits(), expected.to_bits(), "{value}");
        }
        assert_eq!(within(2.0, [f64::NAN, f64::NAN]), 2.0);
        assert!(within(f64::NAN, [f64::NAN; 2]).is_nan());
    }

    #[test]
    fn the_first_that_is_not_finite_is_told() {
        let sound = ("thrust", 2e6, "N");
        assert_eq!(Breakdown::among([sound, sound]), Ok(()));
        let found = Breakdown::among([sound, ("rotor speed", f64::INFINITY, "rad/s"), sound]);
        assert_eq!(found.unwrap_err().to_string(), "rotor speed is inf rad/s");
    }
}
