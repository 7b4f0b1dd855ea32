//! Pages of a model and of a controller.

use crate::figures::{of_identified, of_synthesized};
use crate::{ChannelMargins, DesignError, DiscMargin, Identified, Roots, Synthesized};
use formats::linear_model::{LinearModel, Port};
use lti::Complex64;
use report::{AnswerRecords, AnswerTable};
use std::path::{Path, PathBuf};

/// Variance (%) below which a model says little of an output.
const LITTLE: f64 = 50.0;

/// Writes the page of what was `identified` under `name` into `folder`, with its figures; gives its path.
///
/// # Errors
/// [`DesignError::Report`] where they cannot be written.
pub fn report_identified(
    found: &Identified,
    name: &str,
    folder: &Path,
) -> Result<PathBuf, DesignError> {
    let model = &found.model;
    let aside = || model.outputs.iter().zip(&found.accounted_for[1]);
    let shares: Vec<String> =
        aside().map(|(port, share)| format!("{share:.1} % of {}", port.name)).collect();
    let little = aside().filter(|(_, share)| **share < LITTLE).map(|(port, _)| {
        format!(
            "the model tells less than half of {} on what was kept aside; a controller made with it may do nothing but harm",
            port.name
        )
    });
    let unstable = found.poles.unstable().next().map(|_| {
        "the model is not stable: no predictor of its delay can be made; another order, or samples further apart, may give one that is".to_owned()
    });
    let mut tables = vec![of_outputs(found), roots(found)];
    tables.extend(found.relative_gains.as_ref().map(|gains| relative("as recorded", gains, model)));
    for (what, offset) in [
        ("that decouples at rest", &found.azimuth_offset),
        ("that comes nearest at the bandwidth", &found.azimuth_offset_at_bandwidth),
    ] {
        tables.extend(offset.as_ref().map(|offset| {
            let angle = offset.angle.to_degrees();
            let how = format!("with the azimuth offset {what}, {angle:.1}° on top of the record's");
            relative(&how, &offset.relative_gains, model)
        }));
    }
    let records = AnswerRecords {
        kind: "Identified model".to_owned(),
        name: name.to_owned(),
        headline: format!(
            "Simulated on what was kept aside, the model accounts for {}.",
            shares.join(" and ")
        ),
        warnings: little.chain(unstable).collect(),
        facts: facts_of_model(found),
        tables,
        signals: vec![of_identified(found)],
        file: Some(["The model".to_owned(), model.to_text()]),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    Ok(report::write_answer(&records, folder)?)
}

/// Writes the page of what was `synthesised` under `name` into `folder`, with its figures; gives its path.
///
/// # Errors
/// [`DesignError::Report`] where they cannot be written.
pub fn report_synthesized(
    found: &Synthesized,
    name: &str,
    folder: &Path,
) -> Result<PathBuf, DesignError> {
    let records = AnswerRecords {
        kind: "Controller".to_owned(),
        name: name.to_owned(),
        headline: match found.bandwidth {
            Some(rate) => format!("Holds down disturbances that are slower than {rate:.4} rad/s."),
            None => "Holds no disturbance down.".to_owned(),
        },
        warnings: Vec::new(),
        facts: facts_of_controller(found),
        tables: margins(found),
        signals: vec![of_synthesized(found)],
        file: Some(["The controller".to_owned(), found.controller.to_text()]),
        version: env!("CARGO_PKG_VERSION").to_owned(),
    };
    Ok(report::write_answer(&records, folder)?)
}

/// What it is, value with unit, remark.
fn fact(what: &str, value: impl ToString, remark: impl ToString) -> [String; 3] {
    [what.to_owned(), value.to_string(), remark.to_string()]
}

fn facts_of_model(found: &Identified) -> Vec<[String; 3]> {
    let model = &found.model;
    let [n_samples, n_aside] = found.n_samples;
    let interval = model.interval_s.unwrap_or(f64::NAN);
    let kept = format!("every {interval} s, the last {n_aside} kept aside");
    let unstable: Vec<Complex64> = found.zeros.unstable().copied().collect();
    let as_delay = match unstable.as_slice() {
        [] => String::new(),
        _ => format!("rad/s, as a delay of {:.1} s", found.delay_of_zeros),
    };
    let mut facts = vec![
        fact("Samples", n_samples, kept),
        fact("Order", model.a.len(), "states"),
        fact("Delay", format!("{} s", model.output_delay_s), "as asked for, beside the matrices"),
        fact("Poles", list(&found.poles.continuous), "rad/s"),
        fact("Transmission zeros", list(&found.zeros.continuous), "rad/s"),
        fact("Of them in the right half plane", list(&unstable), as_delay),
    ];
    if let Some(offset) = &found.azimuth_offset {
        let degrees = format!("{:.1}°", offset.angle.to_degrees());
        let remark = "that decouples at rest, on top of the record's";
        facts.push(fact("Azimuth offset", degrees, remark));
    }
    facts
}

fn facts_of_controller(found: &Synthesized) -> Vec<[String; 3]> {
    let [inner, whole] = found.orders;
    let mut facts = vec![fact("Method", found.method, "")];
    if let Some(achieved) = found.achieved {
        let remark = found.bound.map_or(String::new(), |bound| format!("made for {bound:.5}"));
        facts.push(fact("Norm of the weighted loop", format!("{achieved:.5}"), remark));
    }
    let predictor = format!("{whole} with a predictor of {} samples", found.delay_samples);
    facts.push(fact("Order", inner, if found.delay_samples > 0 { &predictor } else { "" }));
    let bandwidth = found.bandwidth.map_or("–".to_owned(), |rate| format!("{rate:.4} rad/s"));
    let aside = if found.with_delay.is_some() { " without the delay" } else { "" };
    facts.push(fact("Bandwidth", bandwidth, aside.trim_start()));
    let [s, t] = found.peaks;
    facts.push(fact("Peaks", format!("{s:.3}, {t:.3}"), format!("of S and T{aside}")));
    facts.push(disc_margin(&found.disc, aside));
    if let Some(delayed) = &found.with_delay {
        let with = " with the delay and its predictor";
        let peak = format!("{:.3}", delayed.sensitivity.gain);
        facts.push(fact("Peak", peak, format!("of S{with}")));
        facts.push(disc_margin(&delayed.disc, with));
        let [shorter, longer] = delayed.mismatch.map(|time| dash(time, 2));
        let remark =
            "s shorter, s longer than the predicted one may the true delay of all outputs be";
        facts.push(fact("Delay that differs", format!("{shorter}, {longer}"), remark));
    }
    facts
}

fn disc_margin(disc: &DiscMargin, how: &str) -> [String; 3] {
    let remark = format!(
        "of all outputs at once{how}: gains {:.2} to {:.2}, phase {:.1}°, at {:.4} rad/s",
        disc.gain[0],
        disc.gain[1],
        disc.phase.to_degrees(),
        disc.frequency
    );
    fact("Disc margin", format!("{:.3}", disc.size), remark)
}

/// A complex number as text.
fn complex(value: &Complex64) -> String {
    if value.im == 0.0 {
        format!("{:.4}", value.re)
    } else {
        format!("{:.4}{:+.4}i", value.re, value.im)
    }
}

/// Complex numbers, one after the other; of pairs the upper one.
fn list(values: &[Complex64]) -> String {
    if values.is_empty() {
        return "none".to_owned();
    }
    values.iter().filter(|value| value.im >= 0.0).map(pair).collect::<Vec<_>>().join(", ")
}

/// A complex number with its conjugate.
fn pair(value: &Complex64) -> String {
    complex(value).replacen('+', "±", 1)
}

/// Poles and zeros in both planes; of pairs the upper one.
fn roots(found: &Identified) -> AnswerTable {
    let of = |what: &'static str, roots: &Roots| {
        let each = roots.sampled.iter().zip(&roots.continuous).filter(|(z, _)| z.im >= 0.0);
        let row = |(z, s): (&Complex64, &Complex64)| {
            let damping = -s.re / s.norm();
            vec![
                what.to_owned(),
                pair(z),
                pair(s),
                format!("{:.4}", s.norm()),
                if damping.is_finite() { format!("{damping:.3}") } else { "–".to_owned() },
            ]
        };
        each.map(row).collect::<Vec<_>>()
    };
    let headings = ["", "in z (–)", "in s (rad/s)", "frequency (rad/s)", "damping (–)"];
    AnswerTable {
        caption: "Poles and transmission zeros, all that are finite, of all inputs and outputs together; s = ln z/T. A zero beside a pole is one that the record hardly tells."
            .to_owned(),
        headings: headings.map(str::to_owned).to_vec(),
        rows: [of("pole", &found.poles), of("zero", &found.zeros)].concat(),
    }
}

/// What the model says of each output.
fn of_outputs(found: &Identified) -> AnswerTable {
    let model = &found.model;
    let with_unit = |what: &str, port: &Port| format!("{what} {}", port.name);
    let headings = ["Output", "VAF (%)", "kept aside (%)", "one sample ahead (%)"];
    let gains = model.inputs.iter().map(|port| with_unit("gain at rest,", port));
    let delays = model.inputs.iter().map(|port| with_unit("delay (s),", port));
    let rows = model.outputs.iter().enumerate().map(|(index, port)| {
        let mut row = vec![format!("{} ({})", port.name, port.unit)];
        row.extend(found.accounted_for.iter().map(|shares| format!("{:.1}", shares[index])));
        row.push(format!("{:.1}", found.predicted[index]));
        row.extend(found.gain[index].iter().map(|gain| format!("{gain:.4}")));
        let delays = found.delays[index].iter();
        row.extend(delays.map(|delay| delay.map_or("–".to_owned(), |delay| format!("{delay:.1}"))));
        row
    });
    AnswerTable {
        caption: "Variance that simulation accounts for, on what was identified from and kept aside; gains; first significant lag of the prewhitened correlation.".to_owned(),
        rows: rows.collect(),
        headings: headings.into_iter().map(str::to_owned).chain(gains).chain(delays).collect(),
    }
}

/// Relative gains at rest, and real parts at the bandwidth, `how` the commands reach the blades.
fn relative(how: &str, [rest, there]: &[Vec<Vec<f64>>; 2], model: &LinearModel) -> AnswerTable {
    let rows = rest.iter().zip(there).zip(&model.outputs).map(|((rest, there), port)| {
        let numbers = rest.iter().chain(there).map(|gain| format!("{gain:.4}"));
        std::iter::once(port.name.clone()).chain(numbers).collect()
    });
    let at = |place: &str| -> Vec<String> {
        model.inputs.iter().map(|port| format!("{place}, {}", port.name)).collect()
    };
    let headings = [vec!["Output".to_owned()], at("at rest"), at("at the bandwidth")].concat();
    AnswerTable {
        caption: format!("Relative gains {how}; at the bandwidth asked for real parts."),
        headings,
        rows: rows.collect(),
    }
}

/// What each output stands by itself, without the delay and with it.
fn margins(found: &Synthesized) -> Vec<AnswerTable> {
    let aside = found.with_delay.as_ref().map_or("", |_| ", without the delay");
    let mut tables = vec![margins_of(found, &found.margins, aside)];
    tables.extend(
        found.with_delay.as_ref().map(|delayed| {
            margins_of(found, &delayed.channels, ", with the delay and its predictor")
        }),
    );
    tables
}

fn margins_of(found: &Synthesized, margins: &[ChannelMargins], what: &str) -> AnswerTable {
    let rows = found.controller.inputs.iter().zip(margins).map(|(port, margins)| {
        vec![
            port.name.clone(),
            dash(margins.gain_increase, 2),
            dash(margins.gain_decrease, 2),
            dash(margins.phase.map(f64::to_degrees), 1),
            dash(margins.delay, 2),
            dash(margins.crossover, 4),
        ]
    });
    let headings =
        ["Output", "gain up", "gain down", "phase (°)", "delay (s)", "crossover (rad/s)"];
    AnswerTable {
        caption: format!(
            "Margins of one output opened at a time, the others closed{what}; –: none."
        ),
        headings: headings.map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}

/// A number, or a dash where there is none.
fn dash(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".to_owned(), |value| format!("{value:.digits$}"))
}
