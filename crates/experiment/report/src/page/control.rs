//! The tables of what controllers did, found and were given, as rows of ready text.

use crate::study::{ExcitationKind, Study};
use crate::words::{SPACE, number, percent, three_figures};
use basis::Sense;
use basis::records::{MeanderingAxis, PitchResponse};
use minijinja::{Value, context};

/// How well each run found the phases of the helix, a row for each axis.
pub(crate) fn phases(study: &Study) -> Vec<Value> {
    let degrees = |angle: f64| number(angle.to_degrees(), 1);
    let found = study.records.synchronisation.iter();
    let rows = found.flat_map(|found| found.phases.iter().map(move |row| (&found.name, row)));
    let axes = rows.flat_map(|(turbine, row)| {
        [(turbine, row, "tilt", &row.tilt), (turbine, row, "yaw", &row.yaw)]
    });
    axes.map(|(turbine, row, axis, numbers)| {
        context! {
            run => row.run.clone(),
            turbine => turbine.clone(),
            offset => row.offset.map_or("monitoring".to_owned(), |offset| number(offset.to_degrees(), 0)),
            axis,
            rmse => degrees(numbers.rmse),
            bias => degrees(numbers.bias),
            spread => degrees(numbers.spread),
            locking => number(numbers.locking, 2),
            coherence => numbers.coherence.map_or("–".to_owned(), |found| number(found, 2)),
            error => numbers.phase_error.map_or("–".to_owned(), |[error, _]| degrees(error)),
            error_interval => numbers
                .phase_error
                .map_or(String::new(), |[_, half]| format!("±{SPACE}{}", degrees(half))),
            amplitude => number(numbers.amplitude, 2),
            true_amplitude => number(numbers.true_amplitude, 2),
        }
    })
    .collect()
}

/// Every excited turbine.
pub(crate) fn excitations(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        for excitation in study.excitations(run) {
            let pitch = &excitation.pitch;
            let turning = |sense: Sense| match sense {
                Sense::CounterClockwise => "counter-clockwise",
                Sense::Clockwise => "clockwise",
            };
            let kind = match excitation.kind {
                ExcitationKind::Helix(sense) => format!("helix, {}", turning(sense)),
                ExcitationKind::Synchronised(sense) => {
                    format!("synchronised helix, {}", turning(sense))
                }
                ExcitationKind::Pulse => "pulse".to_owned(),
                ExcitationKind::Named(_) => excitation.turbine.control.description.clone(),
            };
            rows.push(context! {
                run => run.summary.run.clone(),
                colour,
                turbine => excitation.turbine.name.clone(),
                kind,
                strouhal => number(excitation.strouhal, 3),
                target => number(pitch.commanded_amplitude_deg, 2),
                delivered => number(pitch.delivered_amplitude_deg, 2),
                frequency => number(pitch.frequency_hz, 4),
                excitation_period => number(1.0 / pitch.excitation_frequency_hz.abs(), 1),
                clipped => percent(pitch.clipped_share),
            });
        }
    }
    rows
}

/// How pitch acts where a controller must know, as it was given it: a row for each thing that it acts on.
pub(crate) fn responses(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        for turbine in &run.summary.turbines {
            let mut add = |on: &str, gain: String, offset: f64, delay: String, remark: String| {
                rows.push(context! {
                    run => run.summary.run.clone(),
                    colour,
                    turbine => turbine.name.clone(),
                    on,
                    gain,
                    offset => number(offset.to_degrees(), 1),
                    delay,
                    remark,
                });
            };
            if let Some(offset) = turbine.individual_pitch_offset {
                let on = "blades, under individual pitch control";
                add(on, String::new(), offset, String::new(), String::new());
            }
            let transformation = match turbine.pitch_response {
                Some(PitchResponse::Estimator { transformation_offset, .. }) => {
                    transformation_offset
                }
                Some(PitchResponse::Transformation { azimuth_offset }) => Some(azimuth_offset),
                Some(PitchResponse::IndividualPitch { .. } | PitchResponse::Loads { .. })
                | None => None,
            };
            if let Some(offset) = transformation {
                let on = "blades, by the inverse multi-blade transformation";
                add(on, String::new(), offset, String::new(), String::new());
            }
            match turbine.pitch_response {
                Some(PitchResponse::Estimator { gain, azimuth_offset, before, after, .. }) => {
                    let remark = format!(
                        "helix found without one: {}{SPACE}m/s before, {}{SPACE}m/s after",
                        number(before, 2),
                        number(after, 2)
                    );
                    let gain = format!("× {}", number(gain, 3));
                    let on = "model of the phase estimator";
                    add(on, gain, azimuth_offset, String::new(), remark);
                }
                Some(PitchResponse::Loads { azimuth_offset, delay, gain }) => {
                    let gain = number(1e-6 * gain * 1f64.to_radians(), 3);
                    let gain = format!("−{gain}{SPACE}MN{SPACE}m/°");
                    let on = "tilt and yaw moment of the blades";
                    add(on, gain, azimuth_offset, number(delay, 2), String::new());
                }
                Some(
                    PitchResponse::Transformation { .. } | PitchResponse::IndividualPitch { .. },
                )
                | None => {}
            }
        }
    }
    rows
}

/// What turbines found of meandering and made of it, a row for each axis.
pub(crate) fn meanderings(study: &Study) -> Vec<Value> {
    let stated = |value: Option<f64>, decimals: fn(f64) -> usize| {
        value.map_or("–".to_owned(), |value| number(value, decimals(value)))
    };
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        let conditions = &run.summary.conditions;
        let strouhal =
            |frequency: f64| frequency * conditions.rotor_diameter / conditions.target_wind_speed;
        for turbine in &run.summary.turbines {
            let Some(found) = turbine.meandering else { continue };
            for (axis, moment) in [("tilt", found.tilt), ("yaw", found.yaw)] {
                let mega = |of: fn(MeanderingAxis) -> Option<f64>| {
                    moment.and_then(of).map(|newton_metres| 1e-6 * newton_metres)
                };
                rows.push(context! {
                    run => run.summary.run.clone(),
                    colour,
                    turbine => turbine.name.clone(),
                    control => turbine.control.description.clone(),
                    locked => percent(found.locked_share),
                    frequency => stated(found.frequency_hz, |_| 4),
                    strouhal => stated(found.frequency_hz.map(strouhal), |_| 3),
                    axis,
                    amplitude => stated(mega(|moment| Some(moment.amplitude)), three_figures),
                    reference => stated(mega(|moment| moment.reference), three_figures),
                    factor => stated(moment.and_then(|moment| moment.factor), |_| 2),
                });
            }
        }
    }
    rows
}

/// What controllers found or reached, in their own terms.
pub(crate) fn findings(study: &Study) -> Vec<Value> {
    let mut rows = Vec::new();
    for (run, &colour) in study.runs().iter().zip(&study.colours) {
        for turbine in &run.summary.turbines {
            for finding in &turbine.control.findings {
                rows.push(context! {
                    run => run.summary.run.clone(),
                    colour,
                    turbine => turbine.name.clone(),
                    control => turbine.control.description.clone(),
                    about => finding.about.clone(),
                    value => finding.value.map_or("–".to_owned(), |value| number(value, three_figures(value))),
                    unit => finding.unit.clone(),
                });
            }
        }
    }
    rows
}
