//! The estimator where it is hard: wrong polars, poor instruments, wakes aside, a gust, a helix that goes and
//! comes.

use super::rig::{self, Errors, Instruments, SETTLED};
use super::wind::{HelixWind, Swing, turbulent};
use super::{AIM, Machine, OWN, PERIOD, SHEAR, SPEED, robust, row, tell, trial};
use crate::Row;
use basis::Sense;
use estimation::EstimationError;
use std::sync::Arc;
use turbine::{Definition, Polar};

/// Wrong polars, poor instruments, a wake half beside the rotor, a gust, a helix that goes and comes.
pub(super) fn robustness(machine: &Machine, rows: &mut Vec<Row>) -> Result<(), EstimationError> {
    let ccw = Sense::CounterClockwise;
    let poor = Instruments { noise: 0.05, dropouts: 0.1 };
    let fine = Instruments::default();
    let gusty = HelixWind { gust: (500.0, 1.5), ..machine.gradient(ccw, 0.06) };
    let coming = HelixWind { absent: [0.0, 450.0], ..machine.gradient(ccw, 0.06) };
    let wake = |aside: f64| {
        let mean = turbulent(SPEED, SHEAR, 0.05, machine.hub(), 2);
        machine.wind(Swing::Wake { depth: 3.5, width: 70.0, offset: 25.0, aside }, ccw, mean)
    };
    let more = scaled(&machine.definition, 1.1);
    let less = scaled(&machine.definition, 0.9);
    let right = &machine.definition;
    let cases = [
        ("lift and drag 10 % too large", machine.gradient(ccw, 0.06), fine, &more),
        ("lift and drag 10 % too small", machine.gradient(ccw, 0.06), fine, &less),
        ("noise 5 %, one reading in ten lost", machine.gradient(ccw, 0.06), poor, right),
        ("wind 1.5 m/s up at once", gusty, fine, right),
        ("a wake that circles", wake(0.0), fine, right),
        ("a wake that circles a quarter diameter aside", wake(60.0), fine, right),
        ("a wake that circles half a diameter aside", wake(120.0), fine, right),
    ];
    for (name, wind, instruments, model) in cases {
        let mut estimators =
            [machine.estimator(model, ccw, robust())?, machine.calibrated(model, ccw)?];
        let errors = machine.run(&trial(wind, OWN, instruments, 1200.0), &mut estimators);
        for (form, errors) in ["", ", calibrated"].iter().zip(&errors) {
            for (axis, rms) in ["tilt", "yaw"].iter().zip(errors.rms) {
                rows.push(row(format!("{name}{form}: {axis}, rms error"), rms, AIM, "deg"));
            }
        }
        // Between 0 and 1 by its making; how low is right hangs on the error beside it.
        tell(&format!("{name}, calibrated: mean trust"), &format!("{:.2}", errors[1].trust));
    }
    // Without a helix nothing is trusted; three periods after it has come the phase is found.
    let mut estimators = [machine.estimator(right, ccw, robust())?];
    let truth = coming.truth();
    let trial = trial(coming, 0.0, fine, 1500.0);
    let (mut before, mut after) = ((0.0, 0.0), Errors::default());
    rig::follow(
        &machine.definition,
        &machine.constants,
        &trial,
        &mut estimators,
        |time, _, estimate| {
            if (SETTLED..450.0).contains(&time) {
                before = (before.0 + estimate.trust.overall(), before.1 + 1.0);
            } else if time > 450.0 + 3.0 * PERIOD {
                after.add(estimate, truth);
            }
        },
    );
    let after = after.finish();
    let what = "no helix yet, turbulence 6 %: mean trust".to_owned();
    rows.push(row(what, before.0 / before.1, 0.3, "–"));
    let what = "three periods after it has come: worse axis, rms error".to_owned();
    rows.push(row(what, after.worst(), AIM, "deg"));
    // No claim: neither is beyond the aim where the rms errors are within it.
    let [tilt, yaw] = after.mean;
    let what = "three periods after it has come: mean error of tilt / yaw, deg";
    tell(what, &format!("{tilt:+.1} / {yaw:+.1}"));
    Ok(())
}

/// The same turbine with lift and drag times `factor` (–).
fn scaled(definition: &Definition, factor: f64) -> Arc<Definition> {
    let mut scaled = definition.clone();
    for polar in &mut scaled.polars {
        let column = |of: fn(&turbine::aero::SectionCoefficients) -> f64| -> Vec<f64> {
            polar.rows().map(|(_, row)| of(&row)).collect()
        };
        let angles: Vec<f64> = polar.rows().map(|(angle, _)| angle).collect();
        let [lift, drag] = [column(|row| row.lift), column(|row| row.drag)]
            .map(|column| column.iter().map(|value| factor * value).collect::<Vec<_>>());
        let moment = column(|row| row.moment);
        *polar = Polar::new(polar.name.clone(), &angles, &lift, &drag, &moment)
            .expect("a polar stays one when its coefficients are scaled");
    }
    Arc::new(scaled)
}
