//! The units that files hold channels in, and what they are in SI.

use std::f64::consts::{PI, TAU};

/// A unit in files, after OpenFAST.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// s
    Second,
    /// m
    Metre,
    /// m/s
    MetrePerSecond,
    /// m/s²
    MetrePerSecondSquared,
    /// deg, rad in memory
    Degree,
    /// deg/s, rad/s in memory
    DegreePerSecond,
    /// rpm, rad/s in memory
    TurnPerMinute,
    /// Hz
    Hertz,
    /// N
    Newton,
    /// N m
    NewtonMetre,
    /// kN, N in memory
    Kilonewton,
    /// kN m, N m in memory
    KilonewtonMetre,
    /// kW, W in memory
    Kilowatt,
    /// K
    Kelvin,
    /// Pa
    Pascal,
    /// A ratio, a share.
    One,
}

impl Unit {
    /// All of them.
    pub const ALL: [Self; 16] = [
        Self::Second,
        Self::Metre,
        Self::MetrePerSecond,
        Self::MetrePerSecondSquared,
        Self::Degree,
        Self::DegreePerSecond,
        Self::TurnPerMinute,
        Self::Hertz,
        Self::Newton,
        Self::NewtonMetre,
        Self::Kilonewton,
        Self::KilonewtonMetre,
        Self::Kilowatt,
        Self::Kelvin,
        Self::Pascal,
        Self::One,
    ];

    /// How files write it.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Second => "s",
            Self::Metre => "m",
            Self::MetrePerSecond => "m/s",
            Self::MetrePerSecondSquared => "m/s^2",
            Self::Degree => "deg",
            Self::DegreePerSecond => "deg/s",
            Self::TurnPerMinute => "rpm",
            Self::Hertz => "Hz",
            Self::Newton => "N",
            Self::NewtonMetre => "N-m",
            Self::Kilonewton => "kN",
            Self::KilonewtonMetre => "kN-m",
            Self::Kilowatt => "kW",
            Self::Kelvin => "K",
            Self::Pascal => "Pa",
            Self::One => "-",
        }
    }

    /// The unit that files write as `symbol`.
    pub fn of_symbol(symbol: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|unit| unit.symbol() == symbol)
    }

    /// One of it in SI units.
    const fn in_si(self) -> f64 {
        match self {
            Self::Degree | Self::DegreePerSecond => PI / 180.0,
            Self::TurnPerMinute => TAU / 60.0,
            Self::Kilonewton | Self::KilonewtonMetre | Self::Kilowatt => 1e3,
            _ => 1.0,
        }
    }

    /// `value`, in SI units, in this one.
    pub fn of_si(self, value: f64) -> f64 {
        value / self.in_si()
    }

    /// `value`, in this unit, in SI units.
    pub fn to_si(self, value: f64) -> f64 {
        value * self.in_si()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_comes_back_to_its_last_bits() {
        for unit in Unit::ALL {
            for value in [0.0, 1.0, -0.3, 5.123e6, 1e-12] {
                let back = unit.to_si(unit.of_si(value));
                assert!((back - value).abs() <= 4.0 * f64::EPSILON * value.abs(), "{unit:?}");
            }
        }
        assert_eq!(Unit::TurnPerMinute.of_si(TAU), 60.0);
        assert_eq!(Unit::Degree.of_si(PI), 180.0);
        assert_eq!(Unit::Kilowatt.of_si(5e6), 5000.0);
        assert_eq!(Unit::KilonewtonMetre.to_si(43.1), 43_100.0);
    }
}
