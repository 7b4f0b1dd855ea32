//! `wakemix analyse`: what the records of runs tell.

mod gains;
mod lock;

use clap::{Args, Subcommand, ValueEnum};
use miette::{IntoDiagnostic, Result};
use serde_json::json;
use std::path::PathBuf;
use wakemix::estimation::helix::tuning::Tuned;
use wakemix::estimation::helix::{Form, Measurement};
use wakemix::farm::case::PhaseEstimator;
use wakemix::postprocessing::{PhaseAnswer, PhaseAxis, PhaseQuestion, phases, tune};

/// What to analyse.
#[derive(Subcommand)]
pub(crate) enum AnalyseCommand {
    /// How well a turbine finds the phase of the helix that meets it, against the true wind of a run without it
    Phase(PhaseArguments),
    /// Noise for the phase estimator from the record of a run and the true wind of another, after Algorithm 1 of van Vondelen et al. (2025)
    Tune(PhaseArguments),
    /// Gains of one case in several winds, from studies that differ in wind.seed, each and all together with a 95 % interval
    Gains(gains::GainsArguments),
    /// How well a phase-locked loop would follow the slow swing of a turbine's blade moments in the records of a run, whatever its control
    Lock(lock::LockArguments),
}

/// Arguments of `wakemix analyse phase` and `wakemix analyse tune`.
#[derive(Args)]
pub(crate) struct PhaseArguments {
    /// Folder of a run, such as runs/synchronised-helix/offset-150
    run: PathBuf,
    /// Turbine that the helix meets; when left out each that seeks one, for `tune` the first of them
    #[arg(long, value_name = "NAME")]
    turbine: Option<String>,
    /// Folder of a run without that turbine, with the wind along lines at its place; one beside RUN when left out
    #[arg(long, value_name = "RUN")]
    truth: Option<PathBuf>,
    /// Run this estimator over the records, instead of reading what the run itself believed
    #[arg(long, value_name = "NAME")]
    estimator: Option<Choice>,
    /// First time that counts (s); the end of the spin-up when left out
    #[arg(long, value_name = "T")]
    from: Option<f64>,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// Estimators.
#[derive(Clone, Copy, ValueEnum)]
enum Choice {
    /// With states for what its model lacks
    Robust,
    /// The four states of van Vondelen et al. (2025)
    Published,
}

/// Prints the answer; data goes to stdout.
///
/// # Errors
/// Records that cannot be read or do not hold what is asked for.
pub(crate) fn run(command: &AnalyseCommand) -> Result<()> {
    let arguments = match command {
        AnalyseCommand::Phase(arguments) | AnalyseCommand::Tune(arguments) => arguments,
        AnalyseCommand::Gains(arguments) => return gains::run(arguments),
        AnalyseCommand::Lock(arguments) => return lock::run(arguments),
    };
    let question = PhaseQuestion {
        run: arguments.run.clone(),
        turbine: arguments.turbine.clone(),
        truth: arguments.truth.clone(),
        estimator: arguments.estimator.map(|choice| match choice {
            Choice::Robust => PhaseEstimator::Robust,
            Choice::Published => PhaseEstimator::Published,
        }),
        from: arguments.from,
    };
    if matches!(command, AnalyseCommand::Tune(_)) {
        let tuned = tune(&question)?;
        print!("{}", if arguments.json { tuned_json(&tuned)? } else { tuned_text(&tuned) });
        return Ok(());
    }
    let found = phases(&question)?;
    for error in &found.without_truth {
        eprintln!("{error}");
    }
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&all_json(&found.answers)).into_diagnostic()?);
    } else {
        let texts: Vec<String> = found.answers.iter().map(text).collect();
        print!("{}", texts.join("\n"));
    }
    Ok(())
}

/// An object, or a list of them where several turbines seek a helix.
fn all_json(answers: &[PhaseAnswer]) -> serde_json::Value {
    match answers {
        [answer] => json(answer),
        several => several.iter().map(json).collect(),
    }
}

fn text(answer: &PhaseAnswer) -> String {
    let [estimated, truth] = answer.mean_winds;
    let span = match (answer.times.first(), answer.times.last()) {
        (Some(first), Some(last)) => format!("{first:.0} to {last:.0} s"),
        _ => "no time".to_owned(),
    };
    let mut text = format!(
        "{} in {}, against the wind of {} at its place; {span}\nmean wind {estimated:.2} m/s estimated, {truth:.2} m/s true; trust {:.2}\n",
        answer.turbine, answer.run, answer.truth, answer.trust
    );
    text += &format!(
        "{:<6} {:>14} {:>10} {:>10} {:>16} {:>10} {:>9} {:>11} {:>18}\n",
        "axis",
        "amplitude m/s",
        "true m/s",
        "RMSE deg",
        "bias deg",
        "spread deg",
        "locking",
        "coherence",
        "phase error deg"
    );
    for (name, axis) in [("tilt", &answer.tilt), ("yaw", &answer.yaw)] {
        let agreement = &axis.agreement;
        let bias = match agreement.bias_half_width_95 {
            Some(half) => with_interval(agreement.bias, half),
            None => format!("{:.1}", agreement.bias.to_degrees()),
        };
        let coherence =
            axis.coherence.map_or("–".to_owned(), |found| format!("{:.3}", found.coherence));
        let error = axis.coherence.map_or("–".to_owned(), |found| {
            with_interval(found.phase_error, found.phase_error_half_width_95)
        });
        text += &format!(
            "{name:<6} {:>14.2} {:>10.2} {:>10.1} {bias:>16} {:>10.1} {:>9.3} {coherence:>11} {error:>18}\n",
            axis.amplitude,
            axis.true_amplitude,
            agreement.rmse.to_degrees(),
            agreement.spread.to_degrees(),
            agreement.locking,
        );
    }
    text += "± 95 %; coherence and phase error, estimate before truth, at the helix's frequency, from the cross-spectrum\n";
    if let Some([tilt, yaw]) = answer.hindsight {
        let [tilt, yaw] =
            [tilt, yaw].map(|found| (found.spread.to_degrees(), found.bias.to_degrees()));
        text += &format!(
            "in hindsight, the same blade moments through the filter of the truth: spread {:.1}° about {:+.1}° in tilt, {:.1}° about {:+.1}° in yaw\n",
            tilt.0, tilt.1, yaw.0, yaw.1
        );
    }
    text
}

/// An angle and its half width (rad), in degrees.
fn with_interval(angle: f64, half_width: f64) -> String {
    format!("{:.1} ± {:.1}", angle.to_degrees(), half_width.to_degrees())
}

fn json(answer: &PhaseAnswer) -> serde_json::Value {
    let axis = |axis: &PhaseAxis| {
        let agreement = &axis.agreement;
        json!({
            "amplitude_m_s": axis.amplitude,
            "true_amplitude_m_s": axis.true_amplitude,
            "rmse_deg": agreement.rmse.to_degrees(),
            "bias_deg": agreement.bias.to_degrees(),
            "bias_half_width_95_deg": agreement.bias_half_width_95.map(f64::to_degrees),
            "spread_deg": agreement.spread.to_degrees(),
            "locking": agreement.locking,
            "coherence": axis.coherence.map(|found| found.coherence),
            "coherence_95": axis.coherence.map(|found| found.coherence_95),
            "phase_error_deg": axis.coherence.map(|found| found.phase_error.to_degrees()),
            "phase_error_half_width_95_deg":
                axis.coherence.map(|found| found.phase_error_half_width_95.to_degrees()),
        })
    };
    json!({
        "run": answer.run,
        "turbine": answer.turbine,
        "truth": answer.truth,
        "from_s": answer.times.first(),
        "to_s": answer.times.last(),
        "mean_wind_m_s": answer.mean_winds[0],
        "true_mean_wind_m_s": answer.mean_winds[1],
        "trust": answer.trust,
        "tilt": axis(&answer.tilt),
        "yaw": axis(&answer.yaw),
        "hindsight": answer.hindsight.map(|axes| axes.map(|found| json!({
            "spread_deg": found.spread.to_degrees(),
            "bias_deg": found.bias.to_degrees(),
        }))),
    })
}

/// Standard deviation of a moment, with its unit.
fn measurement(tuned: &Tuned) -> (f64, &'static str) {
    match tuned.options.noise.measurement {
        Measurement::Moment(deviation) => (deviation, "N m"),
        Measurement::Share(share) => (share, "of the mean moment"),
    }
}

/// What of `tuned` a case file takes: keys of `kind = "phase-sync"`, to four figures.
fn case_keys(tuned: &Tuned) -> String {
    let noise = &tuned.options.noise;
    let mut keys = Vec::new();
    if let Measurement::Moment(deviation) = noise.measurement {
        keys.push(("measurement_noise_mnm", 1e-6 * deviation));
    }
    keys.push(("wandering_amplitude", noise.amplitude));
    if tuned.options.form != Form::Quadrature {
        keys.push(("wandering_phase", noise.phase));
    }
    let rounded = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
    let keys: Vec<String> =
        keys.into_iter().map(|(key, value)| format!("{key} = {:?}", rounded(value))).collect();
    keys.join(", ")
}

fn tuned_text(tuned: &Tuned) -> String {
    let noise = &tuned.options.noise;
    let (deviation, unit) = measurement(tuned);
    let estimator = if tuned.options.form == Form::Quadrature { "robust" } else { "published" };
    format!(
        "R: standard deviation of a blade's moment {deviation:.4e} {unit}\n\
         Q: amplitude {:.3e} (m/s)²/s, phase {:.3e} rad²/s, mean wind {:.3e} (m/s)²/s; scaled by {:.3}\n\
         phase error {:.1}° on this record\n\
         for kind = \"phase-sync\" with estimator = \"{estimator}\":\n{}\n",
        noise.amplitude,
        noise.phase,
        noise.mean_wind,
        tuned.scale,
        tuned.error.to_degrees(),
        case_keys(tuned),
    )
}

fn tuned_json(tuned: &Tuned) -> Result<String> {
    let noise = &tuned.options.noise;
    let (deviation, unit) = measurement(tuned);
    let value = json!({
        "measurement_deviation": deviation,
        "measurement_unit": unit,
        "amplitude_wandering_m2_s3": noise.amplitude,
        "phase_wandering_rad2_s": noise.phase,
        "mean_wind_wandering_m2_s3": noise.mean_wind,
        "scale": tuned.scale,
        "phase_error_deg": tuned.error.to_degrees(),
        "case_keys": case_keys(tuned),
    });
    Ok(serde_json::to_string_pretty(&value).into_diagnostic()? + "\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use wakemix::analysis::phase::{Agreement, Coherence};
    use wakemix::estimation::helix::Options;
    use wakemix::farm::case::{Control, PhaseNoise};
    use wakemix::formats;

    /// An axis with an error of `error` (deg) at the helix's frequency, or in a record too short to tell.
    fn axis(error: Option<f64>) -> PhaseAxis {
        let coherence = error.map(|error| Coherence {
            coherence: 0.9,
            coherence_95: [0.8, 0.95],
            floor_95: 0.2,
            phase_error: error.to_radians(),
            phase_error_half_width_95: 4.56_f64.to_radians(),
            gain: 1.0,
            n_segments: 8,
        });
        PhaseAxis {
            amplitude: 1.0,
            true_amplitude: 1.1,
            agreement: Agreement {
                rmse: 0.2,
                rmse_95: None,
                bias: 0.1,
                bias_half_width_95: Some(0.05),
                spread: 0.17,
                locking: 0.98,
            },
            coherence,
            phase: vec![0.0],
            true_phase: vec![0.0],
        }
    }

    #[test]
    fn the_phase_error_at_the_helix_frequency_stands_in_text_and_json() {
        let answer = PhaseAnswer {
            run: "joined".into(),
            turbine: "T2".into(),
            truth: "alone".into(),
            times: vec![600.0],
            mean_winds: [8.0, 8.1],
            tilt: axis(Some(-12.34)),
            yaw: axis(None),
            trust: 0.5,
            hindsight: None,
        };
        let text = text(&answer);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[2].ends_with("coherence    phase error deg"), "{text}");
        assert!(lines[3].starts_with("tilt") && lines[3].ends_with(" -12.3 ± 4.6"), "{text}");
        assert!(lines[4].starts_with("yaw") && lines[4].ends_with(" –"), "{text}");
        let width = |line: &str| line.chars().count();
        assert_eq!([width(lines[3]), width(lines[4])], [width(lines[2]); 2], "{text}");
        let json = json(&answer);
        let half_width = json["tilt"]["phase_error_half_width_95_deg"].as_f64().expect("a number");
        assert!((half_width - 4.56).abs() < 1e-9, "{half_width}");
        assert!(json["yaw"]["phase_error_half_width_95_deg"].is_null());
    }

    /// The noise of T2 in a case whose control holds `estimator` and the last line of what is told of `options`.
    fn pasted(options: Options, estimator: &str) -> PhaseNoise {
        let text = tuned_text(&Tuned { options, scale: 1.0, error: 0.2 });
        let (head, keys) = text.trim_end().rsplit_once('\n').expect("lines");
        assert!(head.ends_with(&format!("estimator = \"{estimator}\":")), "{text}");
        let case = format!(
            r#"
name = "tuned"
[wind]
speed = 9.0
turbulence_intensity = 0.05
[time]
spin_up = 300.0
duration = 900.0
[[turbine]]
name = "T2"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "joined"
control.T2 = {{ kind = "phase-sync", offset_deg = 90, amplitude_deg = 4, sense = "ccw", strouhal = 0.25, estimator = "{estimator}", {keys} }}
"#
        );
        let case = formats::case::parse("pasted", &case, &[]);
        let case = case.unwrap_or_else(|error| panic!("{keys}: {}", error.to_lines()));
        let Control::PhaseSync(sync) = case.runs[0].control[0] else { panic!("no phase-sync") };
        sync.noise
    }

    #[test]
    fn what_tuning_tells_can_be_pasted_into_a_case() {
        let with_noise = |mut options: Options| {
            options.noise.measurement = Measurement::Moment(314_159.0);
            options.noise.amplitude = 7.654_32e-6;
            options.noise.phase = 2.5e-4;
            options
        };
        let robust = pasted(with_noise(Options::default()), "robust");
        let measurement = robust.measurement.expect("a number");
        assert!((measurement - 314_200.0).abs() < 1e-3, "{measurement}");
        assert_eq!((robust.wandering_amplitude, robust.wandering_phase), (Some(7.654e-6), None));
        let published = pasted(with_noise(Options::published()), "published");
        assert_eq!(published.wandering_phase, Some(2.5e-4));
    }
}
