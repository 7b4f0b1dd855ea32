//! A database of loads in recorded wakes, and surrogates of it: what they leave of what was kept aside,
//! beside a published table, and what the database costs beside what was foretold.

mod scatter;

use crate::Row;
use crate::row::Tolerance::{self, AtMost, Within};
use crate::studies::{Carried, Lines, failure, folder_of, summaries, words};
use campaign::{CampaignError, Ended, Plan, RunOptions};
use design::SurrogateTrend;
use design::regression::{KernelText, TrainQuestion, Trained, ValidateQuestion, train, validate};
use flow::inflow::SECTOR_NAMES;
use formats::atomic;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

const SOURCE: &str = "van der Hoek, Dammann, van Wingerden (2026), table 4, test set";
const OWN: &str = "this program's claim";

/// The campaign: a tenth of the database.
const CAMPAIGN: &str = include_str!("../../examples/campaign/database.toml");
/// How it draws winds, and how many are drawn to be timed.
const DRAW: &str = "draw = 100";
const DRAW_TO_TIME: &str = "draw = 2";
/// Records of wind that it is in: cases that come with the program.
const RECORDS: [&str; 2] = ["wake-slices", "wake-slices-array"];
/// The factor whose levels are other winds.
const BLOCK: &str = "wind.cut.block";

/// Tasks of the published database (–), and cores that it is to be made on.
const PUBLISHED_TASKS: f64 = 62_460.0;
const CORES: f64 = 2.0;

/// What surrogates know of the wind, on each of the quarters of the rotor, and of the turbine.
const OF_SECTOR: [&str; 2] = ["wind_speed", "turbulence_intensity"];
const AMPLITUDE: &str = "control.T1.amplitude_deg";
/// The nacelle: its turn from the mean wind over the rotor, which steered wakes blow across, and, as in the
/// source, from the axis.
const MISALIGNMENT: &str = "T1.yaw_misalignment_deg";
const YAW: &str = "turbine.T1.yaw_deg";

/// What is predicted: number of the summary, its name in the source, and the error there or the claim (%).
const OUTPUTS: [(&str, &str, f64, &str); 13] = [
    ("T1.power.mean", "power", 0.5, OWN),
    ("T1.RootMxb1.del_m10", "RootMedg", 0.14, SOURCE),
    ("T1.RootMyb1.del_m10", "RootMflp", 2.0, OWN),
    ("T1.TwrBsMxt.del_m4", "TwrBsMxt", 8.69, SOURCE),
    ("T1.TwrBsMyt.del_m4", "TwrBsMyt", 3.5, OWN),
    ("T1.TwrBsMzt.del_m4", "TwrBsMzt", 2.47, SOURCE),
    ("T1.YawBrMxp.del_m4", "YawBrMxp", 4.68, SOURCE),
    ("T1.YawBrMyp.del_m4", "YawBrMyp", 1.90, SOURCE),
    ("T1.YawBrMzp.del_m4", "YawBrMzp", 2.47, SOURCE),
    ("T1.RotTorq.del_m4", "LSSGagMxs", 3.18, SOURCE),
    ("T1.LSSTipMys.del_m4", "LSSGagMys", 2.0, OWN),
    ("T1.LSSTipMzs.del_m4", "LSSGagMzs", 1.66, SOURCE),
    ("T1.pitch_duty.worst_bearing_load", "PitchBr", 1.5, OWN),
];
/// Records that a second set of surrogates is not trained on: a helix between two others, and behind three.
/// A third is not trained on three of ten winds.
const ASIDE: [&str; 2] = ["wake-slices/helix-3/", "wake-slices-array/helix-4/"];
/// Kernels that are tried on each output: that of the source, and two that let the curve bend at once. The
/// one with the greatest likelihood of what is trained on is taken: what is kept aside has no say in it.
const KERNELS: [&str; 3] = ["se", "matern32", "matern52"];
/// That of the source.
const KERNEL_OF_SOURCE: &str = KERNELS[0];
/// What a 95 % band of what was kept aside is to hold (%).
const COVERED: (f64, f64) = (94.0, 4.0);
/// Share that is trained on (–), seed of the split, starts of each search (–): as the source, and the
/// program's own.
const SPLIT: f64 = 0.7;
const SEED: u64 = 1;
const STARTS: usize = 16;

/// Records wakes, makes a tenth of the database in them, trains a surrogate of each load on 70 % of it, and
/// gives errors and coverage of the rest as rows, then the time of a task beside what was foretold.
pub fn load_database() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    for case in RECORDS {
        summaries(Carried::Shipped(case), case, Vec::new())?;
    }
    let (folder, _lock) = folder_of("load-database")?;
    let planned = plan(&folder, "campaign", DRAW)?;
    run(&planned)?;
    let table = folder.join("loads.csv");
    let collected = campaign::collect(&planned.folder, &table, &[BLOCK.to_owned()]);
    let collected = collected.map_err(|error| words(&error))?;
    tell!("{} rows, {} tasks are missing", collected.n_rows, collected.n_missing);
    let each = folder.join("blocks.csv");
    campaign::collect(&planned.folder, &each, &[]).map_err(|error| words(&error))?;
    scatter::tell_all(&each)?;
    let (mut rows, kernels) = surrogates(&table)?;
    for (output, name, ..) in OUTPUTS.iter().filter(|(.., source)| *source == OWN) {
        let as_there = trained(&table, output, KERNEL_OF_SOURCE, SPLIT, YAW)?.on_test;
        tell!(
            "{name}: with its kernel and yaw from the axis, as in the source, {:.2} % of what was kept aside",
            as_there.map_or(f64::NAN, |aside| aside.root_mean_square_percentage)
        );
    }
    let is_aside = |line: &str| ASIDE.iter().any(|record| line.contains(record));
    apart(&folder, &table, kernels, &ASIDE.join(" and "), is_aside)?;
    let mut winds = BTreeMap::new();
    apart(&folder, &table, kernels, "three of ten winds", |line| {
        // Record and shift stand behind the number of the task and that of its blocks.
        let wind = line.splitn(5, ',').skip(2).take(2).collect::<Vec<_>>().join(",");
        let next = winds.len();
        *winds.entry(wind).or_insert(next) % 10 < 3
    })?;
    rows.extend(costs(&folder)?);
    Ok(rows)
}

/// Plans the campaign with another `draw` in the folder called `name` of `folder`.
fn plan(folder: &Path, name: &str, draw: &str) -> Result<Plan, String> {
    let text =
        CAMPAIGN.replace(DRAW, draw).replace("runs/wake-slices", "runs/validate-wake-slices");
    let path = folder.join(format!("{name}.toml"));
    atomic::write(&path, "the campaign's file", text.as_bytes()).map_err(|error| words(&error))?;
    let planned = campaign::plan(&path, Some(&folder.join(name)));
    let planned = planned.map_err(|error| words(&error))?;
    tell!("{}: {} tasks", planned.folder.display(), planned.n_tasks);
    Ok(planned)
}

/// Makes all tasks of what is `planned`.
fn run(planned: &Plan) -> Result<Ended, String> {
    let (options, stop) = (RunOptions::default(), AtomicBool::new(false));
    let ended = campaign::run(&planned.folder, &options, &stop, &mut Lines::default());
    let ended = ended.map_err(|error: CampaignError| words(&error))?;
    match ended.counts.done == ended.counts.all() {
        true => Ok(ended),
        false => Err(format!("{}: not all tasks are done: {ended:?}", planned.folder.display())),
    }
}

/// Surrogates of all outputs of the table at `path`: rows, and the kernel of each.
fn surrogates(path: &Path) -> Result<(Vec<Row>, [&'static str; OUTPUTS.len()]), String> {
    let mut rows = Vec::new();
    let mut coverages = Vec::new();
    let mut kernels = [KERNEL_OF_SOURCE; OUTPUTS.len()];
    for ((output, name, most, source), taken) in OUTPUTS.into_iter().zip(&mut kernels) {
        let (kernel, found) = likeliest(path, output, name)?;
        *taken = kernel;
        found.warnings.iter().for_each(|warning| tell!("{name}: {warning}"));
        let [n_rows, n_training, n_test] = found.n;
        let (Some(own), Some(aside)) = (found.on_training, found.on_test) else {
            return Err(format!("nothing of {n_rows} rows was kept aside"));
        };
        let covered = aside.covered_95.map_or(f64::NAN, |coverage| coverage.share);
        tell!(
            "{name}: {kernel}, root mean square error {:.2} % of {n_training} rows trained on, {:.2} % of {n_test} kept aside, {covered:.1} % of these in their bands",
            own.root_mean_square_percentage,
            aside.root_mean_square_percentage
        );
        let what = format!("{name}: root mean square error of what was kept aside");
        rows.push(row(&what, aside.root_mean_square_percentage, most, AtMost, source));
        let what = format!("{name}: share of what was kept aside inside its 95 % band");
        coverages.push(row(&what, covered, COVERED.0, Within(COVERED.1), OWN));
    }
    rows.extend(coverages);
    Ok((rows, kernels))
}

/// The kernel under which what is trained on of `output`, called `name`, is likeliest, and its surrogate.
fn likeliest(path: &Path, output: &str, name: &str) -> Result<(&'static str, Trained), String> {
    let mut best: Option<(&'static str, Trained)> = None;
    for kernel in KERNELS {
        let found = trained(path, output, kernel, SPLIT, MISALIGNMENT)?;
        let likelihood = found.model.log_marginal_likelihood;
        tell!(
            "{name}: {kernel}, log likelihood {likelihood:.1}, {:.2} % of what was kept aside",
            found.on_test.map_or(f64::NAN, |aside| aside.root_mean_square_percentage)
        );
        if best.as_ref().is_none_or(|(_, best)| likelihood > best.model.log_marginal_likelihood) {
            best = Some((kernel, found));
        }
    }
    best.ok_or_else(|| "no kernel was tried".to_owned())
}

/// Prints what surrogates with these `kernels` say of the rows of the table at `path` that are set apart,
/// called `what`, and are not trained on: rows that are kept aside by chance share records and winds with
/// rows that are.
fn apart(
    folder: &Path,
    path: &Path,
    kernels: [&str; OUTPUTS.len()],
    what: &str,
    mut is_aside: impl FnMut(&str) -> bool,
) -> Result<(), String> {
    let text = atomic::read_text(path, "the table").map_err(|error| words(&error))?;
    let mut lines = text.lines();
    let heading = lines.next().unwrap_or_default();
    let (aside, known): (Vec<&str>, Vec<&str>) = lines.partition(|line| is_aside(line));
    let write = |name: &str, lines: &[&str]| {
        let path = folder.join(name);
        let text = [&[heading], lines].concat().join("\n") + "\n";
        atomic::write(&path, "a table", text.as_bytes()).map_err(|error| words(&error))?;
        Ok::<_, String>(path)
    };
    let (known, other) = (write("known.csv", &known)?, write("aside.csv", &aside)?);
    let model = folder.join("known.json");
    for ((output, name, ..), kernel) in OUTPUTS.into_iter().zip(kernels) {
        let found = trained(&known, output, kernel, 1.0, MISALIGNMENT)?;
        found.model.write(&model).map_err(|error| words(&error))?;
        let question = ValidateQuestion {
            model: model.clone(),
            file: other.clone(),
            deviation: None,
            group: None,
        };
        let held = validate(&question).map_err(|error| words(&error))?;
        let Some(on) = held.on_table else { return Err("no row is aside".to_owned()) };
        tell!(
            "{name}: trained without {what}: root mean square error {:.2} % of their {} rows, {:.1} % in their bands",
            on.root_mean_square_percentage,
            on.n,
            on.covered_95.map_or(f64::NAN, |coverage| coverage.share)
        );
    }
    Ok(())
}

/// What surrogates that know the nacelle by `nacelle` are told.
fn inputs(nacelle: &str) -> Vec<String> {
    let of_wind = OF_SECTOR.into_iter().flat_map(|quantity| {
        SECTOR_NAMES.into_iter().map(move |sector| format!("T1.sector_{sector}.{quantity}"))
    });
    of_wind.chain([nacelle, AMPLITUDE].map(str::to_owned)).collect()
}

fn trained(
    path: &Path,
    output: &str,
    kernel: &str,
    split: f64,
    nacelle: &str,
) -> Result<Trained, String> {
    let question = TrainQuestion {
        file: path.to_owned(),
        inputs: inputs(nacelle),
        output: output.to_owned(),
        kernel: KernelText::new(kernel)?,
        trend: SurrogateTrend::Constant,
        deviation: None,
        group: None,
        estimates_noise: true,
        split,
        seed: SEED,
        n_starts: STARTS,
        n_inducing: None,
    };
    train(&question).map_err(|error| words(&error))
}

/// What tasks cost, beside what the plan of a few of them foretold.
fn costs(folder: &Path) -> Result<Vec<Row>, String> {
    let name = "timed";
    let there = folder.join(name);
    if there.exists() {
        fs::remove_dir_all(&there).map_err(|error| format!("{}: {error}", there.display()))?;
    }
    let planned = plan(folder, name, DRAW_TO_TIME)?;
    let began = Instant::now();
    let ended = run(&planned)?;
    let taken = began.elapsed().as_secs_f64();
    let Some(foretold) = planned.cost.wall_time else {
        return Err("the plan tells no time".to_owned());
    };
    let of_one = taken * planned.cost.n_workers as f64 / ended.n_done as f64;
    tell!(
        "{} tasks, {} at a time, took {taken:.1} s, {foretold:.1} s were foretold from {} that were made",
        ended.n_done,
        planned.cost.n_workers,
        planned.cost.n_sampled
    );
    let whole = PUBLISHED_TASKS * of_one / CORES / 3600.0;
    let each = "time of a core for a task of 630 s, loads included, all cores at work, mean of 132";
    let in_all = "132 tasks: time that they take beyond the time foretold";
    let beyond = 100.0 * (taken / foretold - 1.0);
    Ok(vec![
        Row { unit: "s", ..row(each, of_one, 1.0, AtMost, OWN) },
        Row {
            unit: "h",
            ..row("time of 62 460 such tasks on two cores", whole, 12.0, AtMost, OWN)
        },
        row(in_all, beyond, 0.0, Within(20.0), OWN),
    ])
}

fn row(
    what: &str,
    measured: f64,
    expected: f64,
    tolerance: Tolerance,
    source: &'static str,
) -> Row {
    Row {
        what: format!("iea-22mw in ten recorded wakes, 8 m/s, {what}"),
        measured,
        expected,
        tolerance,
        unit: "%",
        source,
    }
}
