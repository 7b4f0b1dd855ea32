//! What a person sees of a study under way: cost, progress, remarks.

use super::pace::{self, Pace};
use super::so_far::SoFar;
use super::stages::{Stages, say_prepared};
use crate::commands::manner;
use crate::commands::output::{clean, detail, tell, warn};
use indicatif::{HumanBytes, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::collections::BTreeMap;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use wakemix::basis::records::{PitchResponse, Summary};
use wakemix::farm::plan::GridOfPlan;
use wakemix::farm::self_check::{SelfCheck, TOLERANCE};
use wakemix::study::{Estimate, IdentificationProgress, Observer, Prepared, Progress};

/// Longest time left that is shown (s): a year.
const LONGEST: f64 = 3.2e7;

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
    let kept = match estimate.kept_checkpoints {
        0 => String::new(),
        kept => {
            format!(", {} of it to go on for longer (output.last_checkpoint)", HumanBytes(kept))
        }
    };
    let rows = format!("; {} rows of {}", estimate.n_rows, HumanBytes(estimate.row));
    match estimate.n_runs {
        0 | 1 => format!("disk up to {run}{kept}{rows}"),
        _ => format!("disk up to {run} a run, {all} in all{kept}{rows}"),
    }
}

/// What the memory must hold where the air has no cells, in words; nothing where that is nothing to speak of.
fn memory(estimate: &Estimate) -> String {
    match estimate.memory {
        0 => String::new(),
        memory => format!("memory {}, ", HumanBytes(memory)),
    }
}

/// The cells of `estimate`, in words: "96 × 48 × 32 = 0.15 million cells of 10.0 m", and those of boxes.
fn cells(estimate: &Estimate) -> String {
    let of_grid = |grid: &GridOfPlan| {
        let [n_x, n_y, n_z] = grid.n_cells;
        let millions = grid.cells() as f64 / 1e6;
        // A tunnel's cells are centimetres wide.
        let digits = if grid.spacing < 1.0 { 3 } else { 1 };
        let spacing = grid.spacing;
        format!("{n_x} × {n_y} × {n_z} = {millions:.2} million cells of {spacing:.digits$} m")
    };
    let Some((domain, boxes)) = estimate.grids.split_first() else { return String::new() };
    let boxes: Vec<String> = boxes.iter().map(of_grid).collect();
    let place = if boxes.is_empty() { "" } else { ", in boxes " };
    of_grid(domain) + place + &boxes.join(", ")
}

/// The runs of `estimate`, in words: "12 runs in 3 studies, 2 at a time".
fn runs(estimate: &Estimate) -> String {
    let s = |n: usize| if n == 1 { "" } else { "s" };
    let Estimate { n_runs, n_studies, n_jobs, .. } = *estimate;
    let mut words = format!("{n_runs} run{}", s(n_runs));
    if n_studies > 1 {
        words += &format!(" in {n_studies} studies");
    }
    if n_jobs > 1 {
        words += &format!(", {n_jobs} at a time,");
    }
    words
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
pub(super) struct Screen {
    pub(super) bar: ProgressBar,
    last: Option<String>,
    /// Whether somebody sees the bar; a file gets a line now and then instead.
    drawn: bool,
    /// What was printed last where it is not drawn: of what, and which tenth of it.
    printed: BTreeMap<String, u64>,
    /// Folder of the study that is told of, in that of a sweep, with a slash behind it.
    study: String,
    stages: Stages,
    case: PathBuf,
    pace: Pace,
    so_far: SoFar,
    /// What moves the air where no cells do.
    air: String,
}

impl Screen {
    /// What is shown of the study or sweep of the case at `case`.
    pub(super) fn new(case: &Path) -> Self {
        let bar = ProgressBar::new(1);
        if !manner::says_remarks() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{prefix:>24} [{bar:32}] {percent:>3} %  {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        Self {
            bar,
            last: None,
            drawn: std::io::stderr().is_terminal(),
            printed: BTreeMap::new(),
            study: String::new(),
            stages: Stages::new(),
            case: case.to_owned(),
            pace: Pace::default(),
            so_far: SoFar::default(),
            air: "prescribed wind".to_owned(),
        }
    }

    /// Makes the report of the runs so far where it is worth its time.
    fn report_so_far(&mut self) {
        if !self.so_far.is_due(Instant::now()) {
            return;
        }
        self.enter("report so far");
        match self.so_far.make(&self.study) {
            Ok(Some(page)) => self.say(&format!("report so far: {}", page.display())),
            Ok(None) => {}
            // The one at the end tells what is wrong.
            Err(error) => self.bar.suspend(|| detail(&format!("no report so far: {error}"))),
        }
    }

    /// Where the bar cannot be drawn, a line at every tenth of `what`, of which `done` of `all` are done.
    fn tell(&mut self, what: &str, done: u64, all: u64, left: &str) {
        if self.drawn || all == 0 {
            return;
        }
        let tenth = TENTHS * done / all;
        if self.printed.get(what) != Some(&tenth) {
            self.printed.insert(what.to_owned(), tenth);
            if tenth > 0 {
                tell(&format!("{what}: {} %, {left}", 100 / TENTHS * tenth));
            }
        }
    }

    fn say(&self, line: &str) {
        self.bar.suspend(|| tell(line));
    }

    /// The stage called `name` begins, or goes on.
    pub(super) fn enter(&mut self, name: &str) {
        if let Some(before) = self.stages.enter(name) {
            self.bar.suspend(|| detail(&before));
        }
    }
}

impl Observer for Screen {
    fn prepared(&mut self, prepared: &Prepared) {
        self.enter("checking files and machine");
        let solver = prepared.case.flow.solver;
        if solver.resolves_induction {
            self.air = format!("flow solver {}", solver.name);
        }
        say_prepared(&self.case, prepared);
    }

    fn estimated(&mut self, estimate: &Estimate) {
        self.pace.take(estimate);
        self.so_far.take(estimate);
        match (estimate.updates_per_second, estimate.wall_time()) {
            (Some(speed), Some(wall_time)) => self.say(&format!(
                "cost: about {} for {}{} at {}",
                HumanDuration(Duration::from_secs_f64(wall_time.max(1.0))),
                runs(estimate),
                identifications(estimate),
                pace::words(speed, estimate.n_cells[0] > 0)
            )),
            _ if estimate.n_cells[0] == 0 => self.say(&format!(
                "{}: {} of {} steps of {:.4} s, {} steps in all; {}{}{}",
                self.air,
                runs(estimate),
                estimate.n_steps,
                estimate.interval,
                estimate.n_steps_in_all,
                memory(estimate),
                disk(estimate),
                identifications(estimate),
            )),
            _ => self.say(&format!(
                "{}grid: {}, {} steps of {:.4} s a run; \
                 memory {}, {}; blockage {:.1} % raises power by {:.1} % in every run; wind {:.3} cells a step",
                if estimate.n_studies > 1 { format!("{}; the first: ", runs(estimate)) } else { String::new() },
                cells(estimate),
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

    fn in_study(&mut self, folder: &str) {
        self.study = if folder.is_empty() { String::new() } else { format!("{folder}/") };
    }

    fn beginning(&mut self, directory: &Path) {
        directory.clone_into(&mut self.so_far.directory);
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
        if let Some(words) = self.pace.set_right(progress, Instant::now()) {
            self.say(&words);
        }
        let Progress { run_index, n_runs, n_at_a_time, .. } = *progress;
        let what = format!("{}{} ({}/{n_runs})", self.study, progress.run, run_index + 1);
        if n_at_a_time == 1 {
            self.enter(&what);
            self.bar.set_prefix(clean(&what).into_owned());
            self.bar.set_length(progress.n_steps);
            self.bar.set_position(progress.step);
        } else {
            // Runs side by side would take the bar from each other.
            self.enter("runs side by side");
            self.bar.set_prefix(format!("{run_index} of {n_runs} runs done"));
            self.bar.set_length(1000);
            self.bar.set_position((1000.0 * progress.share_of_all) as u64);
        }
        let left = HumanDuration(Duration::from_secs_f64(progress.time_left.clamp(0.0, LONGEST)));
        let message = match progress.updates_per_second / 1e6 {
            0.0 => format!("{left} left in all"),
            updates => format!("{updates:.0} Mups, {left} left in all"),
        };
        if n_at_a_time == 1 {
            self.tell(&what, progress.step, progress.n_steps, &message);
        } else {
            let done = (1000.0 * progress.share_of_all) as u64;
            self.tell(&format!("{n_runs} runs, {n_at_a_time} at a time"), done, 1000, &message);
        }
        self.bar.set_message(message);
    }

    fn finished(&mut self, summary: &Summary) {
        let memory = summary.cost.peak_memory.map_or_else(String::new, |peak_memory| {
            format!(", {} of memory at most", HumanBytes(peak_memory))
        });
        self.say(&format!(
            "done: {}{} in {}{memory}",
            self.study,
            summary.run,
            HumanDuration(Duration::from_secs_f64(summary.cost.wall_time.max(1.0)))
        ));
        self.so_far.one_less(summary.cost.wall_time);
        self.report_so_far();
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
