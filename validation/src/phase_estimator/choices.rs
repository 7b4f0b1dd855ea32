//! Effect of each choice of the robust form, and the linear filter of the earlier method, on the aeroelastic
//! turbine.

use super::rig::Instruments;
use super::{AIM, Machine, OWN, ROTOR_SPEED, SPEED, robust, row, setting, tell, trial};
use crate::Row;
use basis::Sense;
use estimation::EstimationError;
use estimation::helix::{
    Adaptation, Form, HelixOptions, LinearEstimator, OperatingPoint, Rotor, Wake,
};

/// Each choice of the robust form against what it replaces, turbulence 6 %, own pitch.
///
/// A choice that changes noise, correlation, rate or interval alone leaves the filter's model of rotor and
/// wind whole, and has the form's own aim. One that takes a part of either away, or lets the filter learn it,
/// has none: 4° of own pitch change the moments as much as 3 to 4 m/s of tilt and yaw in the wind. A part of
/// the model stands for a fifth of that, which is as much as a helix of 0.7 m/s.
pub(super) fn options(machine: &Machine, rows: &mut Vec<Row>) -> Result<(), EstimationError> {
    let base = robust();
    let of_the_wave = base.adaptation.map(|adaptation| Adaptation { wave: true, ..adaptation });
    let wake = |wake| HelixOptions { rotor: Rotor { wake, ..base.rotor }, ..base };
    let whole = [
        ("as it is", base),
        ("without adaptation", HelixOptions { adaptation: None, ..base }),
        ("adapting the wave's process noise too", HelixOptions { adaptation: of_the_wave, ..base }),
        ("tilt and yaw apart", HelixOptions { roundness: 0.0, ..base }),
        ("with an excitation rate of its own", HelixOptions { rate: Some(1e-9), ..base }),
        ("every fifth instant", HelixOptions { update_every: 5, ..base }),
    ];
    let parted = [
        ("without lasting tilt and yaw", HelixOptions { bias: None, ..base }),
        ("without eddies", HelixOptions { eddies: None, ..base }),
        (
            "amplitude and phase for each axis",
            HelixOptions { form: Form::SeparateAmplitudes, ..base },
        ),
        ("learning its own pitch", HelixOptions { response: Some(0.03), ..base }),
        ("blades stiff", HelixOptions { rotor: Rotor { flexible: false, ..base.rotor }, ..base }),
        ("wake at once", wake(Wake::Static)),
        ("wake in the air", HelixOptions::default()),
    ];
    let ccw = Sense::CounterClockwise;
    let mut estimators = Vec::new();
    for (_, options) in whole.iter().chain(&parted) {
        estimators.push(machine.estimator(&machine.definition, ccw, *options)?);
    }
    let trial = trial(machine.gradient(ccw, 0.06), OWN, Instruments::default(), 1200.0);
    let errors = machine.run(&trial, &mut estimators);
    for (place, ((name, _), errors)) in whole.iter().chain(&parted).zip(errors).enumerate() {
        let what = format!("turbulence 6 %, own pitch, robust form {name}: worse axis, rms error");
        if place < whole.len() {
            rows.push(row(what, errors.worst(), AIM, "deg"));
        } else {
            tell(&format!("{what}, deg"), &format!("{:.1}", errors.worst()));
        }
    }
    Ok(())
}

/// The linear Kalman filter of van Vondelen et al. (2023), around the point at which the turbine runs,
/// turbulence 6 %.
///
/// It has no aim: its model has neither the wake's delay nor blades that bend, as the choices above without
/// one.
pub(super) fn linear(machine: &Machine) -> Result<(), EstimationError> {
    let ccw = Sense::CounterClockwise;
    let pitch = machine.constants.fine_pitch;
    let point = OperatingPoint { wind: SPEED, rotor_speed: ROTOR_SPEED, pitch };
    for (name, own) in [("no own pitch", 0.0), ("own pitch", OWN)] {
        let mut filter =
            [LinearEstimator::new(&machine.definition, &setting(ccw), point, robust())?];
        let trial = trial(machine.gradient(ccw, 0.06), own, Instruments::default(), 1200.0);
        for errors in machine.run(&trial, &mut filter) {
            let what = format!("turbulence 6 %, {name}, linear filter: worse axis, rms error, deg");
            tell(&what, &format!("{:.1}", errors.worst()));
        }
    }
    Ok(())
}
