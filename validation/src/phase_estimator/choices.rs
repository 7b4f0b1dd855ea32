//! What each choice of the robust form is worth, and the linear filter of the earlier method, on the aeroelastic turbine.

use super::rig::Instruments;
use super::{Machine, OWN, ROTOR_SPEED, SPEED, asked, robust, row, setting};
use crate::Row;
use basis::Sense;
use estimation::EstimationError;
use estimation::helix::{Adaptation, Form, LinearEstimator, OperatingPoint, Options, Rotor, Wake};

/// Each choice of the robust form against what it replaces, turbulence 6 %, own pitch.
pub(super) fn options(machine: &Machine, rows: &mut Vec<Row>) -> Result<(), EstimationError> {
    let base = robust();
    let of_the_wave = base.adaptation.map(|adaptation| Adaptation { wave: true, ..adaptation });
    let wake = |wake| Options { rotor: Rotor { wake, ..base.rotor }, ..base };
    let forms = [
        ("as it is", base),
        ("without lasting tilt and yaw", Options { bias: None, ..base }),
        ("without eddies", Options { eddies: None, ..base }),
        ("without adaptation", Options { adaptation: None, ..base }),
        ("learning the wave's wandering too", Options { adaptation: of_the_wave, ..base }),
        ("tilt and yaw apart", Options { roundness: 0.0, ..base }),
        ("amplitude and phase for each axis", Options { form: Form::SeparateAmplitudes, ..base }),
        ("with an excitation rate of its own", Options { rate: Some(1e-9), ..base }),
        ("learning its own pitch", Options { response: Some(0.03), ..base }),
        ("blades stiff", Options { rotor: Rotor { flexible: false, ..base.rotor }, ..base }),
        ("wake at once", wake(Wake::Static)),
        ("wake in the air", Options::default()),
        ("every fifth instant", Options { update_every: 5, ..base }),
    ];
    let ccw = Sense::CounterClockwise;
    let mut estimators = Vec::new();
    for (_, options) in forms {
        estimators.push(machine.estimator(&machine.definition, ccw, options)?);
    }
    let asked = asked(machine.gradient(ccw, 0.06), OWN, Instruments::default(), 1200.0);
    let errors = machine.run(&asked, &mut estimators);
    for ((name, _), errors) in forms.iter().zip(errors) {
        let what = format!("turbulence 6 %, own pitch, robust form {name}: worse axis, rms error");
        rows.push(row(what, errors.worst(), 180.0, "deg"));
    }
    Ok(())
}

/// The linear Kalman filter of van Vondelen et al. (2023), around the point at which the turbine runs, turbulence 6 %.
pub(super) fn linear(machine: &Machine, rows: &mut Vec<Row>) -> Result<(), EstimationError> {
    let ccw = Sense::CounterClockwise;
    let pitch = machine.constants.fine_pitch;
    let point = OperatingPoint { wind: SPEED, rotor_speed: ROTOR_SPEED, pitch };
    for (name, own) in [("no own pitch", 0.0), ("own pitch", OWN)] {
        let mut filter =
            [LinearEstimator::new(&machine.definition, &setting(ccw), point, robust())?];
        let asked = asked(machine.gradient(ccw, 0.06), own, Instruments::default(), 1200.0);
        for errors in machine.run(&asked, &mut filter) {
            let what = format!("turbulence 6 %, {name}, linear filter: worse axis, rms error");
            rows.push(row(what, errors.worst(), 180.0, "deg"));
        }
    }
    Ok(())
}
