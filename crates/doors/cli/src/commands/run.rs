//! `wakemix run`: one study from case file to report.

mod again;
mod stages;

use super::output::{clean, columns, detail, print, refuse, say, tell, warn};
use super::{BAD_INPUT, DIVERGED, INTERRUPTED, manner};
use crate::commands::table;
use again::interrupted;
use clap::Args;
use indicatif::{HumanBytes, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use miette::IntoDiagnostic;
use stages::{Stages, say_prepared};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use wakemix::basis::records::{PitchResponse, Summary};
use wakemix::farm::pitch_response::CalibrationError;
use wakemix::farm::self_check::{SelfCheck, SelfCheckError, TOLERANCE};
use wakemix::postprocessing;
use wakemix::study::{
    self, Estimate, IdentificationProgress, Observer, Outcome, Prepared, Progress, StudyError,
    StudyOptions,
};

/// Longest time left that is shown (s): a year.
const LONGEST: f64 = 3.2e7;

/// Arguments of `wakemix run`.
#[derive(Args)]
pub(crate) struct RunArguments {
    /// Case file (TOML), or the name of a case that `wakemix cases` lists
    case: PathBuf,
    /// Folder for the results; `runs/NAME-OF-THE-CASE` when left out
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Only this run of the case (may be repeated)
    #[arg(long = "run", value_name = "NAME")]
    runs: Vec<String>,
    /// Override a key of the case, as in `--set wind.speed=8` (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Resume an interrupted or killed run; the result has the same bits
    #[arg(long)]
    resume: bool,
    /// Replace old results
    #[arg(long, conflicts_with = "resume")]
    overwrite: bool,
    /// Print what the study would cost, and stop: every file that the case names is read, and the machine is
    /// timed for a moment
    #[arg(long)]
    dry_run: bool,
    /// With --dry-run: check the rotors against blade-element momentum as well, as a run does before it
    /// begins
    #[arg(long, requires = "dry_run")]
    check: bool,
    /// Print the summaries as JSON on stdout instead of the table
    #[arg(long)]
    json: bool,
}

/// Runs the study; exit code 0 done, 2 bad input, 3 diverged, 130 interrupted.
pub(crate) fn run(arguments: &RunArguments) -> ExitCode {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let installed = ctrlc::set_handler(move || {
        // A second Ctrl-C means now; the last checkpoint stands.
        if flag.swap(true, Ordering::SeqCst) {
            std::process::exit(i32::from(INTERRUPTED));
        }
        say("\nstopping after this step; press Ctrl-C again to stop now");
    });
    if let Err(error) = installed {
        warn(&format!("Ctrl-C will not write a checkpoint: {error}"));
    }
    let options = StudyOptions {
        case: arguments.case.clone(),
        output: arguments.output.clone(),
        runs: arguments.runs.clone(),
        overrides: arguments.overrides.clone(),
        resume: arguments.resume,
        overwrite: arguments.overwrite,
        dry_run: arguments.dry_run,
        check: arguments.check,
    };
    let mut screen = Screen::new(&arguments.case);
    let outcome = study::run(&options, &stop, &mut screen);
    screen.bar.finish_and_clear();
    screen.enter("");
    match outcome {
        Ok(Outcome::Done { directory, .. }) => done(&directory, arguments.json),
        Ok(Outcome::Estimated) => ExitCode::SUCCESS,
        Ok(Outcome::Interrupted { directory }) => {
            say(&interrupted(arguments, &directory));
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            let code = match &error {
                StudyError::Diverged { .. }
                | StudyError::SelfCheck(SelfCheckError::Flow(_))
                | StudyError::Calibration(CalibrationError::Flow(_)) => DIVERGED,
                _ => BAD_INPUT,
            };
            refuse(&miette::Report::new(error));
            ExitCode::from(code)
        }
    }
}

/// Makes the report of the complete study in `directory`, and prints its summaries.
fn done(directory: &Path, as_json: bool) -> ExitCode {
    let began = Instant::now();
    let (summaries, page) = match postprocessing::report(directory) {
        Ok(made) => made,
        Err(error) => return refuse(&miette::Report::new(error)),
    };
    detail(&format!("time: {:.2} s report", began.elapsed().as_secs_f64()));
    tell(&format!("report: {}", page.display()));
    let text = if as_json {
        serde_json::to_string_pretty(&summaries).map(|text| text + "\n").into_diagnostic()
    } else {
        Ok(table::render(&summaries, columns()))
    };
    match text.and_then(|text| print(&text)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(report) => refuse(&report),
    }
}

/// What goes before the runs, in words: " and 1 pitch-response identification before them (19 % of a run)".
fn identifications(estimate: &Estimate) -> String {
    match estimate.n_identifications {
        0 => String::new(),
        n => format!(
            " and {n} pitch-response identification{} before them ({} steps, {:.0} % of a run)",
            if n == 1 { "" } else { "s" },
            estimate.n_identification_steps,
            100.0 * estimate.identification_share()
        ),
    }
}

/// What the disk must hold, in words.
fn disk(estimate: &Estimate) -> String {
    let [run, all] = [estimate.disk, estimate.disk_in_all].map(HumanBytes);
    match estimate.n_runs {
        0 | 1 => format!("disk up to {run}"),
        _ => format!("disk up to {run} a run, {all} in all"),
    }
}

/// How the pitch of `turbine` acts, in words.
fn words_of(turbine: &str, response: &PitchResponse) -> String {
    let turned = |offset: f64| {
        format!("{turbine} pitches with an azimuth offset of {:+.1}°", offset.to_degrees())
    };
    match *response {
        PitchResponse::Estimator { gain, azimuth_offset, before, after, transformation_offset } => {
            let pitches = transformation_offset.map(|offset| turned(offset) + "; ");
            format!(
                "{}{turbine}'s estimator scales the effect of its own pitch by {gain:.3} and turns it by {:+.1}°; helix found without one: {before:.2} m/s before, {after:.2} m/s after",
                pitches.unwrap_or_default(),
                azimuth_offset.to_degrees(),
            )
        }
        PitchResponse::Transformation { azimuth_offset } => turned(azimuth_offset),
        PitchResponse::IndividualPitch { azimuth_offset } => format!(
            "{turbine}'s individual pitch control uses an azimuth offset of {:+.1}°",
            azimuth_offset.to_degrees(),
        ),
        PitchResponse::Loads { azimuth_offset, delay, gain } => format!(
            "a degree of cyclic pitch lowers the moments of {turbine} by {:.2} MN m, with an azimuth offset of {:+.1}° and a delay of {delay:.2} s",
            1e-6 * gain * 1f64.to_radians(),
            azimuth_offset.to_degrees(),
        ),
    }
}

/// Tenths of a run at which progress is printed where no bar can be drawn (–).
const TENTHS: u64 = 10;

/// Progress and remarks on stderr.
struct Screen {
    bar: ProgressBar,
    last: Option<String>,
    /// Whether somebody sees the bar; a file gets a line now and then instead.
    drawn: bool,
    /// What was printed last where it is not drawn: of what, and which tenth of it.
    printed: Option<(String, u64)>,
    stages: Stages,
    case: PathBuf,
}

impl Screen {
    /// What is shown of the study of the case at `case`.
    fn new(case: &Path) -> Self {
        let bar = ProgressBar::new(1);
        if !manner::says_remarks() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{prefix:>24} [{bar:32}] {percent:>3} %  {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        let drawn = std::io::stderr().is_terminal();
        let (stages, case) = (Stages::new(), case.to_owned());
        Self { bar, last: None, drawn, printed: None, stages, case }
    }

    /// Where the bar cannot be drawn, a line at every tenth of `what`, of which `done` of `all` are done.
    fn tell(&mut self, what: &str, done: u64, all: u64, left: &str) {
        if self.drawn || all == 0 {
            return;
        }
        let tenth = TENTHS * done / all;
        if self.printed.as_ref().is_none_or(|(last, printed)| last != what || *printed != tenth) {
            self.printed = Some((what.to_owned(), tenth));
            if tenth > 0 {
                tell(&format!("{what}: {} %, {left}", 100 / TENTHS * tenth));
            }
        }
    }

    fn say(&self, line: &str) {
        self.bar.suspend(|| tell(line));
    }

    /// The stage called `name` begins, or goes on.
    fn enter(&mut self, name: &str) {
        if let Some(before) = self.stages.enter(name) {
            self.bar.suspend(|| detail(&before));
        }
    }
}

impl Observer for Screen {
    fn prepared(&mut self, prepared: &Prepared) {
        self.enter("checking files and machine");
        say_prepared(&self.case, prepared);
    }

    fn estimated(&mut self, estimate: &Estimate) {
        let [n_x, n_y, n_z] = estimate.n_cells;
        match (estimate.updates_per_second, estimate.wall_time()) {
            (Some(speed), Some(wall_time)) => self.say(&format!(
                "cost: about {} for {} run{}{} at {:.0} million cell updates a second",
                HumanDuration(Duration::from_secs_f64(wall_time.max(1.0))),
                estimate.n_runs,
                if estimate.n_runs == 1 { "" } else { "s" },
                identifications(estimate),
                speed / 1e6
            )),
            _ if n_x == 0 => self.say(&format!(
                "prescribed wind: {} steps of {:.4} s a run, {}{}",
                estimate.n_steps,
                estimate.interval,
                disk(estimate),
                identifications(estimate),
            )),
            _ => self.say(&format!(
                "grid: {n_x} × {n_y} × {n_z} = {:.2} million cells of {:.1} m, {} steps of {:.4} s a run; \
                 memory {}, {}; blockage {:.1} % raises power by {:.1} % in every run; wind {:.3} cells a step",
                (n_x * n_y * n_z) as f64 / 1e6,
                estimate.spacing,
                estimate.n_steps,
                estimate.interval,
                HumanBytes(estimate.memory),
                disk(estimate),
                100.0 * estimate.blockage,
                100.0 * estimate.wall_gain,
                estimate.lattice_speed,
            )),
        }
    }

    fn preparing(&mut self, what: &str, share: f64) {
        self.enter(what);
        if self.last.as_deref() != Some(what) {
            self.last = Some(what.to_owned());
            self.bar.set_prefix(clean(what).into_owned());
            self.bar.set_message("");
        }
        self.bar.set_length(1000);
        self.bar.set_position((1000.0 * share) as u64);
    }

    fn checked(&mut self, check: &SelfCheck) {
        self.say(&format!(
            "check: {} in steady {:.1} m/s: power {:+.1} %, thrust {:+.1} % of blade-element momentum{}",
            check.model,
            check.wind_speed,
            100.0 * check.power_error(),
            100.0 * check.thrust_error(),
            if check.passes() { String::new() } else { format!("  (beyond {:.0} %)", 100.0 * TOLERANCE) },
        ));
    }

    fn identifying(&mut self, progress: &IdentificationProgress) {
        self.last = None;
        let IdentificationProgress { turbine, index, n_identifications, share, time_left } =
            *progress;
        let what =
            format!("identifying pitch response of {turbine} ({}/{n_identifications})", index + 1);
        self.enter(&what);
        self.bar.set_prefix(clean(&what).into_owned());
        self.bar.set_length(1000);
        self.bar.set_position((1000.0 * share) as u64);
        let left = HumanDuration(Duration::from_secs_f64(time_left.clamp(0.0, LONGEST)));
        let message = format!("{left} left before the runs");
        self.tell(&what, (1000.0 * share) as u64, 1000, &message);
        self.bar.set_message(message);
    }

    fn identified(&mut self, turbine: &str, response: &PitchResponse, again: bool) {
        let found = if again { "pitch response known" } else { "pitch response identified" };
        self.say(&format!("{found}: {}", words_of(turbine, response)));
    }

    fn advanced(&mut self, progress: &Progress) {
        self.last = None;
        let what = format!("{} ({}/{})", progress.run, progress.run_index + 1, progress.n_runs);
        self.enter(&what);
        self.bar.set_prefix(clean(&what).into_owned());
        self.bar.set_length(progress.n_steps);
        self.bar.set_position(progress.step);
        let left = HumanDuration(Duration::from_secs_f64(progress.time_left.clamp(0.0, LONGEST)));
        let message = match progress.updates_per_second / 1e6 {
            0.0 => format!("{left} left in all"),
            updates => format!("{updates:.0} Mups, {left} left in all"),
        };
        self.tell(&what, progress.step, progress.n_steps, &message);
        self.bar.set_message(message);
    }

    fn finished(&mut self, summary: &Summary) {
        let memory = summary.cost.peak_memory.map_or_else(String::new, |peak_memory| {
            format!(", {} of memory at most", HumanBytes(peak_memory))
        });
        self.say(&format!(
            "done: {} in {}{memory}",
            summary.run,
            HumanDuration(Duration::from_secs_f64(summary.cost.wall_time.max(1.0)))
        ));
    }

    fn warned(&mut self, warning: &str) {
        self.bar.suspend(|| warn(warning));
    }
}

#[cfg(test)]
mod tests {
    use super::{PitchResponse, words_of};

    #[test]
    fn the_offset_of_the_pitch_and_that_of_the_estimator_are_kept_apart() {
        let of = |transformation_offset| PitchResponse::Estimator {
            gain: 1.04,
            azimuth_offset: (-0.5f64).to_radians(),
            before: 0.12,
            after: 0.0,
            transformation_offset,
        };
        let words = words_of("T2", &of(Some(35.2f64.to_radians())));
        let estimator =
            "T2's estimator scales the effect of its own pitch by 1.040 and turns it by -0.5°; ";
        let pitches = "T2 pitches with an azimuth offset of +35.2°";
        assert!(words.starts_with(&format!("{pitches}; {estimator}")), "{words}");
        // Records of before do not tell.
        assert!(words_of("T2", &of(None)).starts_with(estimator));
        let alone = PitchResponse::Transformation { azimuth_offset: 35.2f64.to_radians() };
        assert_eq!(words_of("T2", &alone), pitches);
        let control = PitchResponse::IndividualPitch { azimuth_offset: 0.5f64.to_radians() };
        let words = "T2's individual pitch control uses an azimuth offset of +0.5°";
        assert_eq!(words_of("T2", &control), words);
    }
}
