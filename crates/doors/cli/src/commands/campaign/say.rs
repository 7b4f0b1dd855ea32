//! What a person sees of a campaign.

use crate::commands::manner;
use crate::commands::output::{clean, columns, detail, tell, warn};
use campaign::{Cost, Counts, Observer, Plan, Progress, Status};
use indicatif::{HumanBytes, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde_json::{Value, json};
use std::io::IsTerminal;
use std::time::Duration;
use wakemix::report::text_table::{Column, TextTable};

/// Levels that are listed one by one (–).
const LISTED: usize = 8;
/// Failures that are listed (–).
const FAILURES: usize = 20;
/// Shares of a campaign at which progress is printed where no bar can be drawn (–).
const TENTHS: i64 = 10;

/// A time (s) in words.
fn time(seconds: f64) -> String {
    if seconds < 1.0 {
        return format!("{seconds:.2} s");
    }
    Duration::try_from_secs_f64(seconds)
        .map_or("unknown".to_owned(), |time| HumanDuration(time).to_string())
}

/// `plan` in words.
pub(super) fn planned(plan: &Plan) -> String {
    let mut table = TextTable::new(
        [Column::words("factor")],
        [Column::number("levels"), Column::words("values")],
    );
    for factor in &plan.factors {
        let n_levels = factor.levels.len();
        let values = match &factor.levels[..] {
            levels if n_levels <= LISTED => levels.join(", "),
            [first, second, .., last] => format!("{first}, {second}, …, {last}"),
            levels => levels.join(", "),
        };
        table.row([factor.name.clone(), n_levels.to_string(), values]);
    }
    let excluded = match plan.n_excluded {
        0 => String::new(),
        n => format!(", {n} combinations excluded"),
    };
    let undrawn = match plan.n_undrawn {
        0 => String::new(),
        n => format!(", {n} others not drawn"),
    };
    let there = if plan.was_there { "; the plan was there before" } else { "" };
    format!(
        "{}{}: {} tasks{excluded}{undrawn}, in {}{there}\n{}",
        table.fitted(columns()),
        plan.name,
        plan.n_tasks,
        plan.folder.display(),
        cost(&plan.cost)
    )
}

/// A time (s) in words, where it is known.
fn known(seconds: Option<f64>) -> String {
    seconds.map_or("an unknown time".to_owned(), time)
}

fn cost(cost: &Cost) -> String {
    format!(
        "about {} of CPU time; {} on this machine, {} at a time on {} thread{} each, by {} that were {}\nmemory {}; disk {} in the end and up to {} for tasks under way\n",
        known(cost.cpu_time),
        known(cost.wall_time),
        cost.n_workers,
        cost.threads,
        if cost.threads == 1 { "" } else { "s" },
        cost.n_sampled,
        if cost.made_whole { "made to be timed" } else { "timed for a moment" },
        HumanBytes(cost.memory),
        HumanBytes(cost.disk),
        HumanBytes(cost.passing),
    )
}

/// `status` in words.
pub(super) fn stands(status: &Status) -> String {
    let Counts { pending, running, done, failed } = status.counts;
    let mut text = format!(
        "{}: {} tasks, {done} done, {running} running, {pending} pending, {failed} failed\n",
        status.name,
        status.counts.all()
    );
    if status.n_left_behind > 0 {
        text += &format!(
            "{} of those that are running were left by processes that have ended; they come back with the next `wakemix campaign run`\n",
            status.n_left_behind
        );
    }
    if let Some(seconds) = status.task_time {
        text += &format!("a task took {} in the mean", time(seconds));
        if let (Some(rate), Some(left)) = (status.rate, status.time_left) {
            text += &format!(", {rate:.0} tasks an hour, about {} left", time(left));
        }
        text += "\n";
    }
    for failure in status.failures.iter().take(FAILURES) {
        text +=
            &format!("task {} failed ({}): {}\n", failure.task, failure.settings, failure.message);
    }
    if status.failures.len() > FAILURES {
        text += &format!("and {} more; --json lists all\n", status.failures.len() - FAILURES);
    }
    text
}

/// `status` for programs.
pub(super) fn json(status: &Status) -> Value {
    let failures = status.failures.iter().map(|failure| {
        json!({ "task": failure.task, "settings": failure.settings, "message": failure.message })
    });
    json!({
        "name": status.name,
        "n_tasks": status.counts.all(),
        "pending": status.counts.pending,
        "running": status.counts.running,
        "done": status.counts.done,
        "failed": status.counts.failed,
        "left_behind": status.n_left_behind,
        "task_time_s": status.task_time,
        "tasks_an_hour": status.rate,
        "time_left_s": status.time_left,
        "failures": failures.collect::<Vec<_>>(),
    })
}

/// Progress on stderr.
pub(super) struct Screen {
    bar: ProgressBar,
    /// Whether somebody sees the bar; a file gets a line now and then instead.
    drawn: bool,
    told: i64,
}

impl Screen {
    pub(super) fn new() -> Self {
        let bar = ProgressBar::new(1);
        if !manner::says_remarks() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{prefix:>12} [{bar:32}] {pos}/{len}  {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        bar.set_prefix("tasks");
        Self { bar, drawn: std::io::stderr().is_terminal(), told: 0 }
    }

    pub(super) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Screen {
    fn beginning(&mut self, counts: &Counts, n_workers: usize) {
        self.bar.set_length(u64::try_from(counts.all()).unwrap_or(0));
        self.bar.set_position(u64::try_from(counts.done + counts.failed).unwrap_or(0));
        tell(&format!(
            "{} of {} tasks to be made, {n_workers} at a time",
            counts.pending,
            counts.all()
        ));
    }

    fn ended(&mut self, progress: &Progress) {
        let Progress { task, settings, counts, .. } = progress;
        let left = match progress.n_left {
            0 => "none left here".to_owned(),
            n => format!("{n} left here, about {}", time(progress.time_left)),
        };
        self.bar.set_position(u64::try_from(counts.done + counts.failed).unwrap_or(0));
        self.bar.set_message(left.clone());
        match &progress.failure {
            Some(why) => self
                .bar
                .suspend(|| warn(&clean(&format!("task {task} failed ({settings}): {why}")))),
            None => self.bar.suspend(|| detail(&clean(&format!("task {task} done ({settings})")))),
        }
        let made = counts.done + counts.failed;
        let tenth = TENTHS * made / counts.all().max(1);
        if !self.drawn && tenth > self.told {
            self.told = tenth;
            tell(&format!("{made} of {} tasks, {left}", counts.all()));
        }
    }
}
