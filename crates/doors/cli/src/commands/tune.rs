//! `wakemix tune`: settings of a controller from few simulations.

use super::output::{columns, print_json, print_text, refuse, say, tell, warn};
use super::stop;
use super::{BAD_INPUT, DIVERGED, INTERRUPTED};
use clap::Args;
use indicatif::{HumanBytes, HumanDuration, ProgressBar, ProgressStyle};
use miette::Result;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;
use tuning::{Cost, TuneOptions, TuneOutcome, Tuned, TuningError, Watch, tune};
use wakemix::report::text_table::{Column, TextTable};
use wakemix::study::{Observer, Progress, StudyError};

/// Arguments of `wakemix tune`.
#[derive(Args)]
pub(crate) struct TuneArguments {
    /// Study file (TOML): the case, its run, the variables with their ranges, the budget of runs; see
    /// docs/tuning.md
    study: PathBuf,
    /// Folder for runs and results; `runs/NAME-OF-THE-FILE` when left out
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Go on with a tuning that was stopped or killed, or with one whose budget was raised; runs that are
    /// complete are not made again
    #[arg(long)]
    resume: bool,
    /// Print what the runs would cost at most, and stop
    #[arg(long)]
    dry_run: bool,
    /// Print JSON on stdout instead of text
    #[arg(long)]
    json: bool,
}

/// What a person sees of a tuning under way.
struct Screen {
    bar: ProgressBar,
}

impl Screen {
    fn new() -> Self {
        let bar = ProgressBar::new(1);
        if !super::manner::says_remarks() {
            bar.set_draw_target(indicatif::ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{prefix:>24} [{bar:32}] {percent:>3} %  {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar }
    }
}

impl Observer for Screen {
    fn advanced(&mut self, progress: &Progress) {
        self.bar.set_prefix(progress.run.to_owned());
        self.bar.set_length(progress.n_steps);
        self.bar.set_position(progress.step);
        if progress.time_left.is_finite() && progress.time_left >= 0.0 {
            let left = HumanDuration(Duration::from_secs_f64(progress.time_left.min(3.2e7)));
            self.bar.set_message(format!("{left} left of this run"));
        }
    }

    fn warned(&mut self, warning: &str) {
        self.bar.suspend(|| warn(warning));
    }
}

impl Watch for Screen {
    fn proposed(
        &mut self,
        first: usize,
        n_runs: usize,
        words: &[String],
        expected_gain: Option<f64>,
    ) {
        self.bar.suspend(|| {
            for (place, words) in words.iter().enumerate() {
                let expected = match expected_gain.filter(|_| place == 0) {
                    Some(gain) => format!("; {:.3} % more expected of it", 100.0 * gain),
                    None => String::new(),
                };
                tell(&format!("run {} of at most {n_runs}: {words}{expected}", first + place + 1));
            }
        });
    }
}

/// Tunes; exit code 0 done, 2 bad input, 3 diverged, 130 interrupted.
pub(crate) fn run(arguments: &TuneArguments) -> ExitCode {
    let options = TuneOptions {
        study: arguments.study.clone(),
        output: arguments.output.clone(),
        resume: arguments.resume,
        dry_run: arguments.dry_run,
    };
    let stop = stop::on_interrupt();
    let mut screen = Screen::new();
    let outcome = tune(&options, &stop, &mut screen);
    screen.bar.finish_and_clear();
    let said = match outcome {
        Ok(TuneOutcome::Done(tuned)) => done(&tuned, arguments.json),
        Ok(TuneOutcome::Estimated(cost)) => print_text(&of_cost(&cost)),
        Ok(TuneOutcome::Interrupted { directory }) => {
            let folder = stop::shell_word(&directory.display().to_string());
            let study = stop::shell_word(&arguments.study.display().to_string());
            say(&format!("stopped; go on with: wakemix tune {study} -o {folder} --resume"));
            return ExitCode::from(INTERRUPTED);
        }
        Err(error) => {
            let code = if has_diverged(&error) { DIVERGED } else { BAD_INPUT };
            refuse(&miette::Report::new(error));
            return ExitCode::from(code);
        }
    };
    match said {
        Ok(()) => ExitCode::SUCCESS,
        Err(report) => refuse(&report),
    }
}

/// Whether a simulation broke down.
fn has_diverged(error: &TuningError) -> bool {
    matches!(error, TuningError::Study(inner) if matches!(**inner, StudyError::Diverged { .. }))
}

fn done(tuned: &Tuned, as_json: bool) -> Result<()> {
    tell(&format!("report: {}", tuned.page.display()));
    if as_json {
        return print_json(&tuned.to_json());
    }
    print_text(&text(tuned))
}

fn of_cost(cost: &Cost) -> String {
    let before: String = cost
        .cheaper
        .iter()
        .map(|(name, cost)| format!("cheaper source {name}: {}", of_cost(cost)))
        .collect();
    let Cost { n_runs, time_of_one, n_at_a_time, memory, disk, .. } = *cost;
    let time = time_of_one.map_or(String::new(), |seconds| {
        let [one, all] = [seconds, seconds * n_runs as f64]
            .map(|seconds| HumanDuration(Duration::from_secs_f64(seconds.clamp(0.0, 3.2e7))));
        format!(", {one} each, {all} in all")
    });
    let [memory, disk, all] =
        [memory * n_at_a_time as u64, disk, disk * n_runs as u64].map(HumanBytes);
    before
        + &format!(
            "at most {n_runs} runs{time}, {n_at_a_time} at a time; memory {memory}, disk {disk} a run, {all} in all\n"
        )
}

/// "7.50 ± 1.20".
fn percent(value: &tuning::Normal) -> String {
    let [_, high] = value.band_95();
    format!("{:.2} ± {:.2}", 100.0 * value.mean, 100.0 * (high - value.mean))
}

fn text(tuned: &Tuned) -> String {
    let mut table = TextTable::new(
        [Column::words("made last"), Column::words("optimum then")],
        vec![Column::number("runs"), Column::number("expected %"), Column::number("gain there %")],
    );
    for step in &tuned.found.steps {
        let words = |point: &Vec<f64>| tuned.file.words(point);
        let made = match step.proposal.round {
            0 => "first design".to_owned(),
            _ => step.proposal.points.iter().map(words).collect::<Vec<_>>().join("; "),
        };
        let expected = step.proposal.expected_gain.map(|gain| format!("{:.3}", 100.0 * gain));
        table.row(vec![
            made,
            words(&step.optimum.point),
            step.n_evaluations.to_string(),
            expected.unwrap_or("–".to_owned()),
            percent(&step.optimum.value),
        ]);
    }
    let optimum = &tuned.found.optimum;
    let mut text = table.fitted(columns());
    text += &format!(
        "optimum: {}; the array gains {} % with 95 %\n",
        tuned.file.words(&optimum.point),
        percent(&optimum.value)
    );
    for (name, value) in tuned.turbines.iter().zip(&optimum.outputs) {
        text += &format!("of it {name}: {} % of the array's power\n", percent(value));
    }
    for (variable, [low, high]) in tuned.file.variables.iter().zip(&optimum.place_95) {
        text += &format!("{}: with 95 % between {low:.3} and {high:.3}\n", variable.name);
    }
    for set in tuned.file.overrides(&optimum.point) {
        text += &format!("--set {}\n", stop::shell_word(&set));
    }
    text
}
