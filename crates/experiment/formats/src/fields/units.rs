//! Units of lengths, speeds and times, as files write them.

use std::fmt;

/// The unit of lengths that a file gives without one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lengths {
    /// Metres.
    #[default]
    Metres,
    /// Millimetres.
    Millimetres,
}

impl Lengths {
    /// Metres of one.
    pub fn in_metres(self) -> f64 {
        match self {
            Self::Metres => 1.0,
            Self::Millimetres => 1e-3,
        }
    }
}

impl fmt::Display for Lengths {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Metres => "m",
            Self::Millimetres => "mm",
        })
    }
}

/// Metres of a length in `unit`; none where it is no unit of length.
pub(crate) fn length_in(unit: &str) -> Option<f64> {
    match unit.trim() {
        "m" | "metre" | "meter" | "metres" | "meters" => Some(1.0),
        "mm" | "millimetre" | "millimeter" => Some(1e-3),
        "cm" => Some(1e-2),
        _ => None,
    }
}

/// Metres a second of a speed in `unit`; none where it is no unit of speed.
pub(crate) fn speed_in(unit: &str) -> Option<f64> {
    let bare: String = unit.chars().filter(|c| !c.is_whitespace()).collect();
    match bare.as_str() {
        "m/s" | "ms-1" | "m.s-1" | "m*s-1" | "ms^-1" => Some(1.0),
        "mm/s" | "mms-1" => Some(1e-3),
        _ => None,
    }
}

/// Seconds of a time in `unit`; none where it is no unit of time.
pub(crate) fn time_in(unit: &str) -> Option<f64> {
    match unit.trim() {
        "s" | "second" | "seconds" | "sec" => Some(1.0),
        "ms" => Some(1e-3),
        "us" | "µs" => Some(1e-6),
        _ => None,
    }
}
