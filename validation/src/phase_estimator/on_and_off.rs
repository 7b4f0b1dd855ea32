//! A helix that is switched off for several periods and on again, and an aeroelastic turbine that joins it:
//! trust, fallback and phase.

use super::rig::{self, Errors, Instruments};
use super::wind::HelixWind;
use super::{AIM, Machine, OWN, PERIOD, SOURCE, row, trial};
use crate::Row;
use crate::row::Tolerance::Within;
use basis::Sense;
use control::PhaseSync;
use control::phase_sync::{SyncSettings, TRUST};
use estimation::EstimationError;
use estimation::helix::HelixEstimate;

/// Times at which the turbine begins to join, at which the helix goes and comes back, and at which the record
/// ends (s).
const START: f64 = 3.0 * PERIOD;
const GONE: f64 = 8.0 * PERIOD;
const BACK: f64 = GONE + ABSENCE * PERIOD;
const END: f64 = BACK + 8.0 * PERIOD;
/// Periods without a helix (–): three times the four periods over which trust judges its steadiness.
const ABSENCE: f64 = 12.0;
/// Lead of the pitch over the wind (deg): the published best.
const OFFSET: f64 = 150.0;

/// What was seen of the turbine.
#[derive(Default)]
struct Seen {
    /// Last share of the pitch (–) before the helix went, before it came back, and of the record.
    shares: [f64; 3],
    /// Time after the helix went at which less than half of the pitch was left (s); none if it never was.
    faded: Option<f64>,
    /// Sum of the trust in the last period without the helix (–), and its instants.
    trust: [f64; 2],
    /// Errors from three periods after its return on.
    after: Errors,
}

impl Seen {
    fn add(&mut self, time: f64, share: f64, estimate: &HelixEstimate, truth: [f64; 2]) {
        let part = usize::from(time >= GONE) + usize::from(time >= BACK);
        self.shares[part] = share;
        if part == 1 && share < 0.5 && self.faded.is_none() {
            self.faded = Some(time - GONE);
        }
        if part == 1 && time >= BACK - PERIOD {
            self.trust[0] += estimate.trust.overall();
            self.trust[1] += 1.0;
        }
        if time >= BACK + 3.0 * PERIOD {
            self.after.add(estimate, truth);
        }
    }
}

/// Turbulence 6 %, ccw, calibrated, with the fallback to the baseline.
pub(super) fn on_and_off(machine: &Machine, rows: &mut Vec<Row>) -> Result<(), EstimationError> {
    let sense = Sense::CounterClockwise;
    let wind = HelixWind { absent: [GONE, BACK], ..machine.gradient(sense, 0.06) };
    let truth = wind.truth();
    let settings = SyncSettings {
        sense,
        amplitude: OWN,
        rate: wind.rate,
        offset: OFFSET.to_radians(),
        azimuth_offset: 0.0,
        start: START,
        trust: Some(TRUST),
    };
    let mut sync = PhaseSync::new(settings, machine.calibrated(&machine.definition, sense)?);
    // The own pitch is the controller's.
    let trial = trial(wind, 0.0, Instruments::default(), END);
    let mut seen = Seen::default();
    rig::fly(&machine.definition, &machine.constants, &trial, |reading| {
        let pitch = sync.pitch(reading);
        if let Some(estimate) = sync.estimate() {
            seen.add(reading.time, sync.share(), estimate, truth);
        }
        pitch
    });
    let name = "in step, the helix goes for twelve periods";
    let whole = |what: &str, measured: f64| Row {
        what: format!("{name}: share of the pitch {what}"),
        measured,
        expected: 1.0,
        tolerance: Within(0.1),
        unit: "–",
        source: SOURCE,
    };
    let [before, without, again] = seen.shares;
    rows.push(whole("before it goes", before));
    rows.push(row(
        format!("{name}: time until less than half of the pitch is left, over the period"),
        seen.faded.map_or(f64::INFINITY, |time| time / PERIOD),
        ABSENCE,
        "–",
    ));
    let [sum, n_instants] = seen.trust;
    let what = format!("{name}: mean trust in the last of them");
    rows.push(row(what, sum / n_instants, TRUST[0], "–"));
    rows.push(row(format!("{name}: share of the pitch at their end"), without, 0.0, "–"));
    rows.push(whole("eight periods after it has come back", again));
    for (axis, rms) in ["tilt", "yaw"].iter().zip(seen.after.finish().rms) {
        let what = format!("{name}: three periods after it has come back: {axis}, rms error");
        rows.push(row(what, rms, AIM, "deg"));
    }
    Ok(())
}
