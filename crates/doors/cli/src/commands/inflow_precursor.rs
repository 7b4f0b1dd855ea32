//! `wakemix inflow precursor`: an atmosphere spun up, told of, and recorded as wind.

use super::output::{columns, print, refuse, say, tell, warn};
use super::stop::{self, shell_word};
use super::{BAD_INPUT, DIVERGED, INTERRUPTED, manner};
use clap::Args;
use indicatif::{HumanBytes, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};
use miette::IntoDiagnostic;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;
use wakemix::formats::records::{Drift, PrecursorFolder, PrecursorResult};
use wakemix::postprocessing;
use wakemix::report::text_table::{Column, TextTable, wrapped};
use wakemix::study::precursor::{
    self, PrecursorError, PrecursorEstimate, PrecursorObserver, PrecursorOptions, PrecursorOutcome,
    PrecursorProgress,
};

/// Longest time left that is shown (s): a year.
const LONGEST: f64 = 3.2e7;
/// Most levels in the table (–).
const MOST_ROWS: usize = 16;
/// Tenths at which progress is printed where no bar can be drawn (–).
const TENTHS: u64 = 10;

/// Arguments of `wakemix inflow precursor`.
#[derive(Args)]
pub(crate) struct PrecursorArguments {
    /// File of the precursor (TOML), or the name of one that `wakemix cases` lists
    case: PathBuf,
    /// Folder for planes, statistics and checkpoint; `runs/NAME` when left out
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Override a key of the file, as in `--set atmosphere.geostrophic_wind=8` (may be repeated)
    #[arg(long = "set", value_name = "KEY=VALUE")]
    overrides: Vec<String>,
    /// Go on with an interrupted or killed one, or with a complete one after `time.spin_up` or `time.record`
    /// is raised; the result has the same bits
    #[arg(long)]
    resume: bool,
    /// Replace what an earlier one left
    #[arg(long, conflicts_with = "resume")]
    overwrite: bool,
    /// Print what it would cost, and stop: the machine is timed for a moment
    #[arg(long)]
    dry_run: bool,
    /// Print the result as JSON on stdout instead of the table
    #[arg(long)]
    json: bool,
}

/// Makes the precursor; exit code 0 done, 2 bad input, 3 diverged, 130 interrupted.
pub(crate) fn run(arguments: &PrecursorArguments) -> ExitCode {
    let stop = stop::on_interrupt();
    let options = PrecursorOptions {
        case: arguments.case.clone(),
        output: arguments.output.clone(),
        overrides: arguments.overrides.clone(),
        resume: arguments.resume,
        overwrite: arguments.overwrite,
        dry_run: arguments.dry_run,
    };
    let mut screen = Screen::new();
    let outcome = precursor::precursor(&options, &stop, &mut screen);
    screen.bar.finish_and_clear();
    match outcome {
        Ok(PrecursorOutcome::Done { result, folder }) => {
            match done(&result, &folder, arguments.json) {
                Ok(()) => ExitCode::SUCCESS,
                Err(report) => refuse(&report),
            }
        }
        Ok(PrecursorOutcome::Estimated) => ExitCode::SUCCESS,
        Ok(PrecursorOutcome::Interrupted { folder }) => {
            say(&interrupted(arguments, &folder));
            ExitCode::from(INTERRUPTED)
        }
        Err(error) => {
            let diverged = matches!(error, PrecursorError::Diverged { .. });
            refuse(&miette::Report::new(error));
            ExitCode::from(if diverged { DIVERGED } else { BAD_INPUT })
        }
    }
}

/// Prints what came of the precursor.
fn done(result: &PrecursorResult, folder: &PrecursorFolder, as_json: bool) -> miette::Result<()> {
    tell(&format!("statistics: {}", folder.statistics_path().display()));
    tell(&format!("planes: {}", folder.planes_path().display()));
    // Statistics and planes stand without it.
    match postprocessing::report_of_precursor(folder.path()) {
        Ok(page) => tell(&format!("report: {}", page.display())),
        Err(error) => warn(&format!("no report: {error}")),
    }
    if as_json {
        return print(&(serde_json::to_string_pretty(result).into_diagnostic()? + "\n"));
    }
    print(&text(result, columns()))
}

/// `result` for people, in `width` columns.
fn text(result: &PrecursorResult, width: usize) -> String {
    let planes = &result.planes;
    let number = Column::number;
    let heading = [
        number("speed m/s"),
        number("turned °"),
        number("TI %"),
        number("stress m²/s²"),
        number("temperature K"),
        number("heat flux mK m/s"),
    ];
    let mut table = TextTable::new([Column::number("height m")], heading);
    let stride = result.profile.len().div_ceil(MOST_ROWS).max(1);
    for row in result.profile.iter().step_by(stride) {
        let turned = (row.direction_deg - planes.direction_deg + 180.0).rem_euclid(360.0) - 180.0;
        table.row([
            format!("{:.0}", row.height),
            format!("{:.2}", row.speed),
            format!("{turned:+.1}"),
            format!("{:.1}", 100.0 * row.turbulence_intensity),
            format!("{:.4}", row.stress),
            format!("{:.2}", row.temperature),
            format!("{:.2}", 1000.0 * row.heat_flux),
        ]);
    }
    let below = format!(
        "means over level and record; turned: clockwise from the file's x axis, where the wind comes from {:.1}°; TI: √(2k/3) over speed\n\
         hub {:.0} m: {:.2} m/s, TI of u {:.1} %, turned {:+.2}° from x; friction velocity {:.3} m/s, layer {:.0} m\n{}{}",
        planes.direction_deg,
        planes.hub_height,
        planes.hub_speed,
        100.0 * planes.turbulence_intensity,
        planes.turned_deg,
        result.friction_velocity,
        result.boundary_layer_height,
        result.spin_up.map_or_else(String::new, |drift| drift_text("spin-up", &drift)),
        result.record.map_or_else(String::new, |drift| drift_text("record", &drift)),
    );
    table.fitted(width) + &wrapped(&below, width)
}

/// What changed between the last two blocks of `what`, as a line.
fn drift_text(what: &str, drift: &Drift) -> String {
    let steady = if drift.is_steady() { "steady" } else { "not steady" };
    format!(
        "{what}, last two blocks of {:.0} s: speed at the hub {:+.1} %, direction {:+.1}°, friction velocity {:+.1} %: {steady}\n",
        drift.block,
        100.0 * drift.of_speed(),
        drift.of_direction(),
        100.0 * drift.of_friction(),
    )
}

/// What there is to do after a precursor that was stopped.
fn interrupted(arguments: &PrecursorArguments, folder: &PrecursorFolder) -> String {
    let overrides = arguments.overrides.iter().map(|text| format!(" --set {}", shell_word(text)));
    format!(
        "interrupted; resume with: wakemix inflow precursor {} -o {}{} --resume",
        shell_word(&arguments.case.display().to_string()),
        shell_word(&folder.path().display().to_string()),
        overrides.collect::<String>(),
    )
}

/// Progress and remarks on stderr.
struct Screen {
    bar: ProgressBar,
    /// Whether somebody sees the bar; a file gets a line now and then instead.
    drawn: bool,
    /// Tenth that was printed last where it is not drawn.
    printed: u64,
}

impl Screen {
    fn new() -> Self {
        let bar = ProgressBar::new(1);
        if !manner::says_remarks() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{prefix:>8} [{bar:32}] {percent:>3} %  {msg}")
        {
            bar.set_style(style.progress_chars("=> "));
        }
        Self { bar, drawn: std::io::stderr().is_terminal(), printed: 0 }
    }

    fn say(&self, line: &str) {
        self.bar.suspend(|| tell(line));
    }
}

fn duration(seconds: f64) -> HumanDuration {
    HumanDuration(Duration::from_secs_f64(seconds.clamp(1.0, LONGEST)))
}

impl PrecursorObserver for Screen {
    fn estimated(&mut self, estimate: &PrecursorEstimate) {
        let plan = &estimate.plan;
        let [n_x, n_y, n_z] = plan.n_cells;
        self.say(&format!(
            "box: {n_x} × {n_y} × {n_z} = {:.2} million cells of {:.1} m, {} steps of {:.4} s, {} of them before the record; memory {}",
            plan.cells() as f64 / 1e6,
            plan.spacing,
            plan.n_steps,
            plan.interval,
            plan.first_plane,
            HumanBytes(estimate.memory),
        ));
        self.say(&format!(
            "planes: {} of {} × {} points, one every {:.2} s; {} of wind, disk up to {} in all",
            plan.grid.n_steps,
            plan.grid.n_y,
            plan.grid.n_z,
            plan.grid.interval,
            HumanBytes(estimate.planes),
            HumanBytes(estimate.disk),
        ));
        self.say(&format!(
            "cost: about {} at {:.0} million cell updates a second",
            duration(estimate.wall_time()),
            estimate.updates_per_second / 1e6
        ));
    }

    fn advanced(&mut self, progress: &PrecursorProgress) {
        let stage = if progress.records { "record" } else { "spin-up" };
        let message = format!(
            "{:.0} s simulated, hub {:.2} m/s, u* {:.3} m/s, {:.0} Mups, {} left",
            progress.time,
            progress.hub_speed,
            progress.friction_velocity,
            progress.updates_per_second / 1e6,
            duration(progress.time_left),
        );
        self.bar.set_prefix(stage);
        self.bar.set_length(progress.n_steps);
        self.bar.set_position(progress.step);
        let tenth = TENTHS * progress.step / progress.n_steps.max(1);
        if !self.drawn && tenth > self.printed {
            self.printed = tenth;
            tell(&format!("{stage}: {} %, {message}", 100 / TENTHS * tenth));
        }
        self.bar.set_message(message);
    }

    fn spun_up(&mut self, drift: Option<&Drift>, direction: f64) {
        if let Some(drift) = drift {
            self.say(drift_text("spin-up", drift).trim_end());
        }
        self.say(&format!(
            "planes stand across the wind at hub height, which comes from {direction:.1}°"
        ));
    }

    fn warned(&mut self, warning: &str) {
        self.bar.suspend(|| warn(warning));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wakemix::formats::records::{PRECURSOR_VERSION, ProfileRow, RecordedPlanes};

    #[test]
    fn what_came_of_it_fits_the_screen() {
        let drift = Drift {
            block: 3600.0,
            hub_speed: [9.0, 9.3],
            direction_deg: [250.0, 250.5],
            friction_velocity: [0.3, 0.3],
        };
        let row = |index: usize| ProfileRow {
            height: 10.0 + 20.0 * index as f64,
            speed: 9.0,
            direction_deg: 251.0,
            turbulence_intensity: 0.05,
            stress: 0.09,
            temperature: 288.15,
            heat_flux: -0.001,
        };
        let result = PrecursorResult {
            warnings: Vec::new(),
            geostrophic_speed: 10.0,
            geostrophic_direction_deg: 250.0,
            schema_version: PRECURSOR_VERSION,
            version: "0.1.0".to_owned(),
            name: "small".to_owned(),
            case_text: String::new(),
            backend: String::new(),
            finished: String::new(),
            planes: RecordedPlanes {
                sha256: String::new(),
                n_planes: 100,
                n_points: [40, 10],
                spacing: 20.0,
                interval: 1.0,
                hub_height: 90.0,
                hub_speed: 9.1,
                turbulence_intensity: 0.06,
                direction_deg: 250.0,
                turned_deg: 0.2,
            },
            spin_up: Some(drift),
            record: None,
            profile: (0..64).map(row).collect(),
            friction_velocity: 0.3,
            boundary_layer_height: 640.0,
            n_cells: 1000,
            n_steps: 1000,
            wall_time: 10.0,
        };
        for width in [100, 60] {
            let text = text(&result, width);
            let widest = text.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(widest <= width, "{widest}: {text}");
            let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains("speed at the hub +3.3 %"), "{text}");
            assert!(words.contains("friction velocity +0.0 %: not steady"), "{text}");
        }
        let lines = text(&result, 100);
        assert!(lines.lines().filter(|line| line.contains("288.15")).count() <= MOST_ROWS);
    }
}
