//! Fatigue: rainflow counting, damage-equivalent loads, pitch bearings, pitch travel.
//!
//! The convention, wherever no other is named: ranges are peak to peak; cycles are counted by rainflow after
//! ASTM E1049-85 (2017), §5.4.4, ranges that stay open count one half; a load that repeats N_eq times in the
//! record, with N_eq = duration × 1 Hz and duration from the first sample to the last, does the same damage;
//! no correction for the mean.
//!
//! Equations of van der Hoek et al. are those of van der Hoek, Dammann and van Wingerden, "Gaussian process
//! surrogate modeling for efficient controller tuning and fatigue load prediction of the helix wake-mixing
//! method".
//!
//! Everything works on streams: [`Rainflow`] takes samples one by one and hands cycles to a closure,
//! [`LoadCounter`] adds them up for any number of slopes. Neither allocates while it counts.

mod bearing;
mod bins;
mod damage;
mod load;
mod rainflow;
mod travel;

pub use bearing::{
    BEARING_SLOPE, BearingLoad, N_BEARING_POSITIONS, PitchBearing, REFERENCE_TRAVEL_RATE,
    duty_convention,
};
pub use bins::RangeBins;
pub use damage::Damage;
pub use load::{EquivalentLoad, Fatigue, LoadCounter, damage_equivalent_load};
pub use rainflow::{Cycle, Rainflow, cycles};
pub use travel::{PitchTravel, Travel};

/// How often the equivalent load repeats, by the convention of the field (Hz).
pub const REFERENCE_FREQUENCY: f64 = 1.0;

/// The convention in words, for printing beside a figure; `n_bins` (–) as given to [`RangeBins`], if any.
pub fn convention(n_bins: Option<usize>) -> String {
    let counted = match n_bins {
        None => "every range at its own size".to_owned(),
        Some(n_bins) => {
            format!("ranges in {n_bins} equal bins from 0 to the largest, each at its middle")
        }
    };
    format!(
        "1-Hz damage-equivalent load: ranges peak to peak, rainflow after ASTM E1049-85 §5.4.4, open ranges as half \
         cycles, {counted}; N_eq = duration × 1 Hz, duration from first to last sample; no mean correction"
    )
}

#[cfg(test)]
mod tests;
