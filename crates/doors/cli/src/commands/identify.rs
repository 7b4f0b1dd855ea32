//! `wakemix identify`: a linear model of what answers an excitation.

use super::arguments::{count, finite, positive};
use super::output::{print_json, print_text, tell};
use clap::Args;
use design::{Identified, IdentifyQuestion, Offset, Source, Trend, identify, report_identified};
use miette::Result;
use serde_json::json;
use std::path::PathBuf;
use wakemix::report::text_table::{Column, TextTable};

/// Arguments of `wakemix identify`.
#[derive(Args)]
pub(crate) struct IdentifyArguments {
    /// CSV with a column of time, OpenFAST output (.outb, .out), or the folder of a run
    file: PathBuf,
    /// Channels that act, such as T1.HelixTilt,T1.HelixYaw
    #[arg(long, value_name = "NAME", required = true, value_delimiter = ',')]
    inputs: Vec<String>,
    /// Channels that answer, such as T1.HubVortexTilt,T1.HubVortexYaw
    #[arg(long, value_name = "NAME", required = true, value_delimiter = ',')]
    outputs: Vec<String>,
    /// Time from which the record is taken (s); all of it when left out
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = finite)]
    from: Option<f64>,
    /// Time up to which it is taken (s); all of it when left out
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = finite)]
    to: Option<f64>,
    /// Order of the model; where the singular values fall most when left out
    #[arg(long, value_name = "N", value_parser = order)]
    order: Option<usize>,
    /// Window of the past (samples)
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = window)]
    past: usize,
    /// Window of the future (samples); that of the past when left out
    #[arg(long, value_name = "N", value_parser = window)]
    future: Option<usize>,
    /// Keep every N-th sample, after a filter
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = decimation)]
    decimate: usize,
    /// Take the line of least squares off each channel, not its mean alone
    #[arg(long)]
    linear_trend: bool,
    /// Inputs act within the same sample
    #[arg(long)]
    feedthrough: bool,
    /// Delay of the outputs that is known (s): it is taken out of the record and written beside the model
    #[arg(long, value_name = "S", default_value_t = 0.0, value_parser = finite)]
    delay: f64,
    /// Share of the record that is kept aside to validate on
    #[arg(long, value_name = "SHARE", default_value_t = 0.3, value_parser = share)]
    aside: f64,
    /// Frequency of interest (rad/s), at which the relative gains are told beside zero
    #[arg(long, value_name = "RATE", default_value_t = 0.02, value_parser = positive)]
    bandwidth: f64,
    /// File to write the model into (JSON); it is not written when left out
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Folder for a page, `report.html`, and its figures, which lie there as SVG and PNG too
    #[arg(long, value_name = "FOLDER")]
    report: Option<PathBuf>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Most states that a model is taken to be meant with (–).
const MOST_STATES: usize = 200;
/// Longest window (samples), likewise.
const LONGEST_WINDOW: usize = 10_000;
/// Most samples of which one is kept (–), likewise.
const MOST_DECIMATED: usize = 100_000;

fn order(text: &str) -> Result<usize, String> {
    count(text, 1, MOST_STATES, "states (--order)")
}

fn window(text: &str) -> Result<usize, String> {
    count(text, 1, LONGEST_WINDOW, "samples of a window (--past, --future)")
}

fn decimation(text: &str) -> Result<usize, String> {
    count(text, 1, MOST_DECIMATED, "samples of which one is kept (--decimate)")
}

/// A share above zero and below one.
fn share(text: &str) -> Result<f64, String> {
    positive(text)
        .ok()
        .filter(|share| *share < 1.0)
        .ok_or_else(|| format!("\"{text}\" is no share: give one above 0 and below 1"))
}

/// Identifies, writes the model, and prints what was found.
///
/// # Errors
/// Records that cannot be identified from, files that cannot be written.
pub(crate) fn run(arguments: &IdentifyArguments) -> Result<()> {
    let question = IdentifyQuestion {
        source: Source {
            file: arguments.file.clone(),
            inputs: arguments.inputs.clone(),
            outputs: arguments.outputs.clone(),
            span: [
                arguments.from.unwrap_or(f64::NEG_INFINITY),
                arguments.to.unwrap_or(f64::INFINITY),
            ],
        },
        decimate: arguments.decimate,
        trend: if arguments.linear_trend { Trend::Linear } else { Trend::Constant },
        windows: [arguments.past, arguments.future.unwrap_or(arguments.past)],
        feedthrough: arguments.feedthrough,
        order: arguments.order,
        delay: arguments.delay,
        aside: arguments.aside,
        bandwidth: arguments.bandwidth,
    };
    let found = identify(&question)?;
    if let Some(folder) = &arguments.report {
        let page = report_identified(&found, &arguments.file.display().to_string(), folder)?;
        tell(&format!("report: {}", page.display()));
    }
    if let Some(path) = &arguments.output {
        found.model.write(path)?;
        tell(&format!("model: {}", path.display()));
    }
    if arguments.json {
        print_json(&json(&found))
    } else {
        print_text(&text(&found, arguments.bandwidth))
    }
}

/// Numbers in brackets, two digits behind the point.
fn numbers(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:.2}")).collect::<Vec<_>>().join(", ")
}

/// A pole or zero.
fn complex(value: &lti::Complex64) -> String {
    if value.im == 0.0 {
        format!("{:.4}", value.re)
    } else {
        format!("{:.4}{:+.4}i", value.re, value.im)
    }
}

fn text(found: &Identified, bandwidth: f64) -> String {
    let model = &found.model;
    let [n_samples, n_aside] = found.n_samples;
    let of_values: Vec<String> =
        found.singular_values.iter().take(10).map(|value| format!("{value:.3}")).collect();
    let mut text = format!(
        "order {} of {n_samples} samples every {} s, the last {n_aside} kept aside\n\
         singular values {}\n",
        model.a.len(),
        model.interval_s.unwrap_or(f64::NAN),
        of_values.join(" ")
    );
    let of_inputs = |what: &str| {
        model.inputs.iter().map(|port| Column::number(format!("{what} {}", port.name))).collect()
    };
    let mut columns = vec![
        Column::number("VAF %"),
        Column::number("kept aside %"),
        Column::number("one sample ahead %"),
    ];
    columns.extend::<Vec<_>>(of_inputs("gain at rest,"));
    columns.extend::<Vec<_>>(of_inputs("delay s,"));
    let mut table = TextTable::new([Column::words("output")], columns);
    for (index, port) in model.outputs.iter().enumerate() {
        let mut row = vec![port.name.clone()];
        row.extend(found.accounted_for.iter().map(|shares| format!("{:.1}", shares[index])));
        row.push(format!("{:.1}", found.predicted[index]));
        row.extend(found.gain[index].iter().map(|gain| format!("{gain:.4}")));
        let delays = found.delays[index].iter();
        row.extend(delays.map(|delay| delay.map_or("–".to_owned(), |delay| format!("{delay:.1}"))));
        table.row(row);
    }
    text += &table.fitted(super::output::columns());
    text += &of_dynamics(found, bandwidth);
    text + "VAF: variance that simulation accounts for, on what was identified from and kept aside; delay: first significant lag of the prewhitened correlation\n"
}

/// Poles, zeros, relative gains and azimuth offsets.
fn of_dynamics(found: &Identified, bandwidth: f64) -> String {
    let list = |values: &[lti::Complex64]| match values {
        [] => "none".to_owned(),
        _ => values.iter().map(complex).collect::<Vec<_>>().join(", "),
    };
    let mut text = format!(
        "poles (rad/s): {}\ntransmission zeros (rad/s): {}\n",
        list(&found.poles.continuous),
        list(&found.zeros.continuous)
    );
    let unstable: Vec<lti::Complex64> = found.zeros.unstable().copied().collect();
    text += &format!("zeros in the right half plane (rad/s): {}", list(&unstable));
    if !unstable.is_empty() {
        text += &format!(", as a delay of {:.1} s", found.delay_of_zeros);
    }
    text += "\n";
    let rows =
        |gains: &[Vec<f64>]| gains.iter().map(|row| numbers(row)).collect::<Vec<_>>().join("; ");
    if let Some([rest, there]) = &found.relative_gains {
        text += &format!("relative gains at rest: {}\n", rows(rest));
        text += &format!("relative gains at {bandwidth} rad/s: {}\n", rows(there));
    }
    for (what, offset) in [
        ("decouples at rest".to_owned(), &found.azimuth_offset),
        (
            format!("comes nearest to decoupling at {bandwidth} rad/s"),
            &found.azimuth_offset_at_bandwidth,
        ),
    ] {
        let Some(Offset { angle, relative_gains: [rest, there] }) = offset else { continue };
        text += &format!(
            "azimuth offset that {what}, on top of the record's: {:.1}°; relative gains with it at rest: {}; at {bandwidth} rad/s: {}\n",
            angle.to_degrees(),
            rows(rest),
            rows(there)
        );
    }
    text
}

fn json(found: &Identified) -> serde_json::Value {
    let pairs = |values: &[lti::Complex64]| -> Vec<[f64; 2]> {
        values.iter().map(|value| [value.re, value.im]).collect()
    };
    let all = |responses: &[Vec<Vec<lti::Complex64>>]| -> Vec<Vec<Vec<[f64; 2]>>> {
        responses.iter().map(|rows| rows.iter().map(|row| pairs(row)).collect()).collect()
    };
    let unstable: Vec<lti::Complex64> = found.zeros.unstable().copied().collect();
    let offset = |Offset { angle, relative_gains: [rest, there] }: &Offset| {
        json!({
            "azimuth_offset_deg": angle.to_degrees(),
            "relative_gains_at_rest": rest,
            "relative_gains_at_bandwidth": there,
        })
    };
    json!({
        "model": found.model,
        "n_samples": found.n_samples[0],
        "n_samples_kept_aside": found.n_samples[1],
        "singular_values": found.singular_values,
        "variance_accounted_for_pc": found.accounted_for[0],
        "variance_accounted_for_kept_aside_pc": found.accounted_for[1],
        "variance_predicted_kept_aside_pc": found.predicted,
        "poles_rad_s": pairs(&found.poles.continuous),
        "poles_z": pairs(&found.poles.sampled),
        "transmission_zeros_rad_s": pairs(&found.zeros.continuous),
        "transmission_zeros_z": pairs(&found.zeros.sampled),
        "right_half_plane_zeros_rad_s": pairs(&unstable),
        "delay_of_zeros_s": found.delay_of_zeros,
        "delays_by_correlation_s": found.delays,
        "gain_at_rest": found.gain,
        "relative_gains_at_rest": found.relative_gains.as_ref().map(|gains| &gains[0]),
        "relative_gains_at_bandwidth": found.relative_gains.as_ref().map(|gains| &gains[1]),
        "azimuth_offset_deg": found.azimuth_offset.as_ref().map(|found| found.angle.to_degrees()),
        "azimuth_offsets": {
            "at_rest": found.azimuth_offset.as_ref().map(offset),
            "at_bandwidth": found.azimuth_offset_at_bandwidth.as_ref().map(offset),
        },
        "response": {
            "frequencies_rad_s": found.response.frequencies,
            "record": all(&found.response.measured),
            "record_deviations": found.response.deviations,
            "coherences": found.response.coherences,
            "model": all(&found.response.modelled),
        },
    })
}
