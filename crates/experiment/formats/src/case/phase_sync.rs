//! Azimuth offset and noise of `kind = "phase-sync"`, read and written.

use super::error::ProblemKind;
use super::section::Section;
use super::write::{degrees, shortest};
use farm::case::{PhaseEstimator, PhaseNoise};
use std::fmt::Write;

/// Newton metres of a meganewton metre.
const MEGA: f64 = 1e6;

/// The azimuth offset (rad) that `section` gives; none where it is to be found, for an `amplitude` (rad) that is not zero.
pub(super) fn azimuth_offset_of(section: &Section, amplitude: f64) -> Option<f64> {
    let given = section.optional_number("azimuth_offset_deg").map(f64::to_radians);
    // Nothing is pitched, with whatever offset.
    given.or((amplitude == 0.0).then_some(0.0))
}

/// The key of an azimuth `offset` (rad) that is given, after a comma.
pub(super) fn azimuth_offset_text(offset: Option<f64>) -> String {
    offset
        .map_or_else(String::new, |offset| format!(", azimuth_offset_deg = {:?}", degrees(offset)))
}

/// The noise that `section` gives to `estimator`; notes what is of no use to it.
pub(super) fn noise_of(section: &Section, estimator: PhaseEstimator) -> PhaseNoise {
    if estimator == PhaseEstimator::Robust && section.has("wandering_phase") {
        let why = "it goes with estimator = \"published\"; the states of \"robust\" are sine and cosine components, which wander as wandering_amplitude says".to_owned();
        let kind = ProblemKind::NoUse { key: section.key_path("wandering_phase"), why };
        let span = section.span_of("wandering_phase");
        section.findings().note(span, kind, Some("leave it out".into()));
    }
    PhaseNoise {
        measurement: section.optional_number("measurement_noise_mnm").map(|n| n * MEGA),
        wandering_amplitude: section.optional_number("wandering_amplitude"),
        wandering_phase: section.optional_number("wandering_phase"),
    }
}

/// The keys of `noise` that are given, each after a comma.
pub(super) fn noise_text(noise: &PhaseNoise) -> String {
    let measurement = noise.measurement.map(|n| shortest(n, n / MEGA, |text| text * MEGA));
    let keys = [
        ("measurement_noise_mnm", measurement),
        ("wandering_amplitude", noise.wandering_amplitude),
        ("wandering_phase", noise.wandering_phase),
    ];
    let mut text = String::new();
    for (key, value) in keys {
        if let Some(value) = value {
            // Writing to a string cannot fail.
            let _ = write!(text, ", {key} = {value:?}");
        }
    }
    text
}
