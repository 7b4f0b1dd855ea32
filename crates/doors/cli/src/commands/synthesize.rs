//! `wakemix synthesize`: a controller for a model.

use super::output::{print_json, print_text, tell};
use clap::Args;
use design::{
    ChannelMargins, DiscMargin, SynthesizeQuestion, Synthesized, report_synthesized, synthesize,
};
use miette::Result;
use serde_json::json;
use std::path::PathBuf;
use wakemix::formats::linear_model::LinearModel;
use wakemix::report::text_table::{Column, TextTable};

/// Delay that counts as rounding (s).
const LEFT: f64 = 1e-9;

/// Arguments of `wakemix synthesize`.
#[derive(Args)]
pub(crate) struct SynthesizeArguments {
    /// Model that `wakemix identify` wrote (JSON)
    model: PathBuf,
    /// What the controller is to do (TOML)
    #[arg(long, value_name = "FILE")]
    weights: PathBuf,
    /// File to write the controller into (JSON); it is not written when left out
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Folder for a page, `report.html`, and its figures, which lie there as SVG and PNG too
    #[arg(long, value_name = "FOLDER")]
    report: Option<PathBuf>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Synthesises, writes the controller, and prints what it does.
///
/// # Errors
/// Models and weights that cannot be read or have no controller, files that cannot be written.
pub(crate) fn run(arguments: &SynthesizeArguments) -> Result<()> {
    let question =
        SynthesizeQuestion { model: arguments.model.clone(), weights: arguments.weights.clone() };
    let found = synthesize(&question)?;
    if let Some(folder) = &arguments.report {
        let page = report_synthesized(&found, &arguments.model.display().to_string(), folder)?;
        tell(&format!("report: {}", page.display()));
    }
    if let Some(path) = &arguments.output {
        found.controller.write(path)?;
        tell(&format!("controller: {}", path.display()));
    }
    if arguments.json { print_json(&json(&found)) } else { print_text(&text(&found)) }
}

/// A number, or a dash where there is none.
fn or_dash(value: Option<f64>, digits: usize) -> String {
    value.map_or("–".to_owned(), |value| format!("{value:.digits$}"))
}

fn text(found: &Synthesized) -> String {
    let [inner, whole] = found.orders;
    let mut text = format!("{} controller of order {inner}", found.method);
    if found.delay_samples > 0 {
        text += &format!(
            ", {whole} with the Smith predictor that bridges {} samples",
            found.delay_samples
        );
    }
    text += "\n";
    if found.delay_left.abs() > LEFT {
        text += &format!(
            "the model's delay is no whole number of its samples: {:+.3} s of it are left out\n",
            found.delay_left
        );
    }
    if found.bandwidth.is_none() {
        text += "it holds no disturbance down: weights that ask for less, or a model that says more, may give one that does\n";
    }
    if let Some(achieved) = found.achieved {
        text += &format!("norm of the weighted loop {achieved:.5}");
        if let Some(bound) = found.bound {
            text += &format!(", made for a bound of {bound:.5}");
        }
        if let Some(before) = found.before_reduction {
            text += &format!(", {before:.5} before the reduction");
        }
        text += "\n";
    }
    if let Some([x, y]) = found.riccati_residuals {
        text += &format!("residuals of the Riccati equations {x:.1e}, {y:.1e}\n");
    }
    let aside = if found.delay_samples > 0 { "without the delay: " } else { "" };
    text += &format!(
        "{aside}peak of S {:.3}, of T {:.3}, bandwidth {} rad/s\n",
        found.peaks[0],
        found.peaks[1],
        or_dash(found.bandwidth, 4)
    );
    text += &of_all(&found.disc);
    text += &of_each(&found.controller, &found.margins);
    if let Some(delayed) = &found.with_delay {
        text += &format!(
            "with the delay and its predictor: peak of S {:.3}\n",
            delayed.sensitivity.gain
        );
        text += &of_all(&delayed.disc);
        text += &of_each(&found.controller, &delayed.channels);
        let [shorter, longer] = delayed.mismatch.map(|time| or_dash(time, 2));
        text += &format!(
            "the true delay of all outputs may be {shorter} s shorter, {longer} s longer than the predicted one\n"
        );
    }
    text + "margins: one output opened at a time, the others closed; –: none\n"
}

/// What all outputs stand at once.
fn of_all(disc: &DiscMargin) -> String {
    format!(
        "disc margin of all outputs at once {:.3}: gains {:.2} to {:.2}, phase {:.1}°, at {:.4} rad/s\n",
        disc.size,
        disc.gain[0],
        disc.gain[1],
        disc.phase.to_degrees(),
        disc.frequency
    )
}

/// A table of what each output stands by itself.
fn of_each(controller: &LinearModel, margins: &[ChannelMargins]) -> String {
    let headings = ["gain up", "gain down", "phase °", "delay s", "crossover rad/s"];
    let mut table = TextTable::new([Column::words("output")], headings.map(Column::number));
    for (port, margins) in controller.inputs.iter().zip(margins) {
        table.row([
            port.name.clone(),
            or_dash(margins.gain_increase, 2),
            or_dash(margins.gain_decrease, 2),
            or_dash(margins.phase.map(f64::to_degrees), 1),
            or_dash(margins.delay, 2),
            or_dash(margins.crossover, 4),
        ]);
    }
    table.fitted(super::output::columns())
}

/// The same for other programs.
fn json_of_each(controller: &LinearModel, margins: &[ChannelMargins]) -> serde_json::Value {
    let each = controller.inputs.iter().zip(margins).map(|(port, margins)| {
        json!({
            "output": port.name,
            "gain_increase": margins.gain_increase,
            "gain_decrease": margins.gain_decrease,
            "phase_deg": margins.phase.map(f64::to_degrees),
            "delay_s": margins.delay,
            "crossover_rad_s": margins.crossover,
        })
    });
    each.collect()
}

fn json(found: &Synthesized) -> serde_json::Value {
    let with_delay = found.with_delay.as_ref().map(|delayed| {
        let [shorter, longer] = delayed.mismatch;
        json!({
            "peak_sensitivity": delayed.sensitivity.gain,
            "disc_margin": delayed.disc.size,
            "disc_margin_gains": delayed.disc.gain,
            "disc_margin_phase_deg": delayed.disc.phase.to_degrees(),
            "margins": json_of_each(&found.controller, &delayed.channels),
            "delay_shorter_s": shorter,
            "delay_longer_s": longer,
        })
    });
    let channels = found.responses.channels.iter().map(|channel| {
        json!({
            "shaped": (["S", "T", "KS"][channel.shaped]),
            "channel": channel.name,
            "gains": channel.gains,
            "bounds": channel.bounds,
        })
    });
    json!({
        "controller": found.controller,
        "method": found.method.to_string(),
        "bound": found.bound,
        "achieved": found.achieved,
        "before_reduction": found.before_reduction,
        "riccati_residuals": found.riccati_residuals,
        "order": found.orders[0],
        "order_with_predictor": found.orders[1],
        "delay_samples": found.delay_samples,
        "delay_left_s": found.delay_left,
        "peak_sensitivity": found.peaks[0],
        "peak_complementary_sensitivity": found.peaks[1],
        "bandwidth_rad_s": found.bandwidth,
        "disc_margin": found.disc.size,
        "disc_margin_gains": found.disc.gain,
        "disc_margin_phase_deg": found.disc.phase.to_degrees(),
        "margins": json_of_each(&found.controller, &found.margins),
        "with_delay": with_delay,
        "frequencies_rad_s": found.responses.frequencies,
        "gains": found.responses.gains,
        "bounds": found.responses.bounds,
        "by_channel": channels.collect::<Vec<_>>(),
        "steps": found.steps,
    })
}
