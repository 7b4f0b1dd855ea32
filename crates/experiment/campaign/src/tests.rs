//! Campaigns of short runs in prescribed wind: planned, killed, gone on with, collected.

use super::*;
use crate::column::Values;
use basis::records::{Cost as Spent, Summary};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use study::{Outcome, StudyOptions};
use tempfile::TempDir;

mod claims;
mod cost;
mod draw;

/// A stiff turbine in wind that is the same everywhere, for 20 s: a baseline and a helix.
const CASE: &str = r#"
name = "short"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.2
[time]
spin_up = 5.0
duration = 20.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

const CAMPAIGN: &str = r#"
case = "case.toml"
runs = ["helix"]
[factors]
"wind.speed" = [8, 9.5]
"control.T1.amplitude_deg" = { from = 1.0, to = 3.0, step = 1.0 }
"#;

/// A folder with the case and the campaign of `text`.
fn written(text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), CASE).unwrap();
    fs::write(folder.path().join("campaign.toml"), text).unwrap();
    folder
}

fn planned(folder: &Path) -> Result<Plan, CampaignError> {
    plan(&folder.join("campaign.toml"), Some(&folder.join("out")))
}

/// The campaign of `text`, planned, with its folder.
fn begun(text: &str) -> (TempDir, PathBuf) {
    let folder = written(text);
    planned(folder.path()).unwrap();
    let out = folder.path().join("out");
    (folder, out)
}

fn made(out: &Path, options: &RunOptions) -> Ended {
    run(out, options, &AtomicBool::new(false), &mut Silent).unwrap()
}

fn said(error: &CampaignError) -> String {
    use miette::Diagnostic;
    let deeper = error.diagnostic_source().map(|source| source.to_string());
    let help = error.help().map(|help| help.to_string());
    format!("{error} {} {}", deeper.unwrap_or_default(), help.unwrap_or_default())
}

/// The numbers column called `name`.
fn column(out: &Path, name: &str) -> Vec<Option<f64>> {
    let (columns, _) = collect::columns(&table::Table::open(out).unwrap(), out).unwrap();
    let found = columns.into_iter().find(|column| column.name == name);
    match found.unwrap_or_else(|| panic!("no column {name}")).values {
        Values::Number(values) => values,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_plan_has_every_combination_and_a_cost() {
    let folder = written(CAMPAIGN);
    let first = planned(folder.path()).unwrap();
    assert_eq!((first.n_tasks, first.was_there, first.name.as_str()), (6, false, "campaign"));
    assert_eq!(first.factors[1].levels, ["1", "2", "3"]);
    let Cost { cpu_time, wall_time, threads, disk, made_whole, n_sampled, .. } = first.cost;
    assert!(made_whole && n_sampled > 0, "{n_sampled}");
    assert!(cpu_time.unwrap() > 0.0 && wall_time.unwrap() > 0.0, "{cpu_time:?} {wall_time:?}");
    assert_eq!((threads, disk), (1, 6 * (8 << 10)));
    assert!(planned(folder.path()).unwrap().was_there);
}

#[test]
fn a_turbine_file_that_is_edited_meanwhile_is_seen() {
    let folder = written(CAMPAIGN);
    let (own, case) = (folder.path().join("own.toml"), folder.path().join("case.toml"));
    let turbine = formats::library::text("nrel-5mw").unwrap();
    fs::write(&own, turbine).unwrap();
    fs::write(&case, CASE.replace("nrel-5mw", "own.toml")).unwrap();
    let file = formats::shipped::read(&case, &[]).unwrap();
    let mut inputs = study::Inputs::default();
    let before = inputs.of(&file).unwrap();
    assert_eq!(inputs.of(&file).unwrap(), before);
    fs::write(&own, format!("{turbine}\n# another\n")).unwrap();
    assert_ne!(inputs.of(&file).unwrap(), before);
}

#[test]
fn two_numbers_of_a_task_with_one_name_are_noticed() {
    let mut gathered = collect::Gathered::default();
    let mut add = |row, name: &str| {
        gathered.add(row, name.to_owned(), "W".to_owned(), Some(1.0));
        gathered.twice.clone()
    };
    assert_eq!([add(0, "a.b"), add(0, "a.c"), add(1, "a.b")], [None, None, None]);
    assert_eq!(add(1, "a.b"), Some((1, "a.b".to_owned())));
}

#[test]
fn tasks_are_made_once_and_collected_as_their_runs_are() {
    let (folder, out) = begun(CAMPAIGN);
    let ended = made(&out, &RunOptions { limit: Some(2), jobs: Some(1), ..RunOptions::default() });
    assert_eq!((ended.n_done, ended.counts.done, ended.counts.pending), (2, 2, 4));
    assert_eq!(made(&out, &RunOptions::default()).n_done, 4);
    assert_eq!(made(&out, &RunOptions::default()).n_done, 0);
    // Nothing but the table is left.
    assert_eq!(fs::read_dir(out.join("tasks")).unwrap().count(), 0);
    // The last task, as `wakemix run --set` makes it.
    let overrides = ["wind.speed=9.5", "run.helix.control.T1.amplitude_deg=3.0"];
    let options = StudyOptions {
        case: folder.path().join("case.toml"),
        output: Some(folder.path().join("alone")),
        runs: vec!["helix".to_owned()],
        overrides: overrides.map(str::to_owned).to_vec(),
        ..StudyOptions::default()
    };
    let alone = study::run(&options, &AtomicBool::new(false), &mut study::Silent).unwrap();
    let Outcome::Done { summaries, .. } = alone else { panic!("{alone:?}") };
    let own = numbers(&summaries[0]);
    assert!(own.len() > 20, "{own:?}");
    for number in own {
        let collected = column(&out, &number.name)[5];
        assert_eq!(collected.map(f64::to_bits), number.value.map(f64::to_bits), "{}", number.name);
    }
    let csv = folder.path().join("results.csv");
    let collected = collect(&out, &csv, &[]).unwrap();
    assert_eq!((collected.n_rows, collected.n_missing), (6, 0));
    let text = fs::read_to_string(&csv).unwrap();
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    assert!(head.starts_with("task,wind.speed,control.T1.amplitude_deg,wall_time [s],"), "{head}");
    assert!(head.contains(",T1.power.mean [W],"), "{head}");
    assert!(lines.next().unwrap().starts_with("1,8.0,1.0,"), "{text}");
    let other = collect(&out, &folder.path().join("results.xls"), &[]).unwrap_err();
    assert!(said(&other).contains("results.xls ends neither"), "{other}");
}

#[test]
fn several_at_a_time_make_each_task_once_with_the_same_numbers() {
    let means = [1, 4].map(|jobs| {
        let (_folder, out) = begun(CAMPAIGN);
        let ended = made(&out, &RunOptions { jobs: Some(jobs), ..RunOptions::default() });
        assert_eq!(ended.n_done, 6);
        column(&out, "T1.power.mean")
    });
    assert_eq!(means[0], means[1]);
    assert!(means[0].iter().all(Option::is_some));
}

#[test]
fn a_stop_leaves_what_is_done_and_gives_the_rest_back() {
    let (_folder, out) = begun(CAMPAIGN);
    let ended = run(&out, &RunOptions::default(), &AtomicBool::new(true), &mut Silent).unwrap();
    assert_eq!((ended.is_interrupted, ended.counts.pending), (true, 6));
}

#[test]
fn a_range_makes_its_tasks_alone() {
    let (_folder, out) = begun(CAMPAIGN);
    let only = |first, last| RunOptions { only: Some((first, last)), ..RunOptions::default() };
    assert_eq!(made(&out, &only(5, 9)).n_done, 2);
    assert_eq!(made(&out, &only(2, 2)).n_done, 1);
    let beyond = run(&out, &only(7, 7), &AtomicBool::new(false), &mut Silent).unwrap_err();
    assert!(said(&beyond).contains("no task 7: the campaign has 1 to 6"), "{beyond}");
}

#[test]
fn what_is_kept_is_what_the_campaign_says() {
    for (keep, names) in [
        ("series", vec!["manifest.json", "series.csv", "summary.json"]),
        ("all", vec!["T1.outb", "checkpoint", "manifest.json", "series.csv", "summary.json"]),
    ] {
        let text = CAMPAIGN.replace("runs", &format!("keep = \"{keep}\"\nruns"));
        let (_folder, out) = begun(&text);
        made(&out, &RunOptions { limit: Some(1), ..RunOptions::default() });
        let files = fs::read_dir(out.join("tasks/000001/helix")).unwrap();
        let mut found: Vec<String> =
            files.map(|file| file.unwrap().file_name().to_string_lossy().into_owned()).collect();
        found.sort();
        let missing = names.iter().find(|name| !found.iter().any(|own| own == *name));
        assert!(missing.is_none(), "{keep}: {found:?}");
        assert!(keep == "all" || found == names, "{keep}: {found:?}");
    }
}

#[test]
fn a_folder_of_another_plan_is_refused_by_name() {
    let (folder, out) = begun(CAMPAIGN);
    let change = |file: &str, from: &str, to: &str| {
        let path = folder.path().join(file);
        let text = fs::read_to_string(&path).unwrap().replace(from, to);
        fs::write(&path, text).unwrap();
    };
    change("campaign.toml", "[8, 9.5]", "[8, 9]");
    let error = said(&planned(folder.path()).unwrap_err());
    assert!(error.contains("holds the campaign `campaign`, and this is another plan"), "{error}");
    change("campaign.toml", "[8, 9]", "[8, 9.5]");
    assert!(planned(folder.path()).unwrap().was_there);
    // What decides no result may change.
    change("campaign.toml", "runs", "keep = \"series\"\nruns");
    change("case.toml", "name = \"short\"", "name = \"short\"\ndescription = \"other words\"");
    assert!(planned(folder.path()).unwrap().was_there);
    // The case may not: neither for a new plan nor for a task of the old one.
    change("case.toml", "spin_up = 5.0", "spin_up = 6.0");
    let error = said(&planned(folder.path()).unwrap_err());
    assert!(error.contains("its levels, its draw, its case or a file"), "{error}");
    let changed = run(&out, &RunOptions::default(), &AtomicBool::new(false), &mut Silent);
    let changed = said(&changed.unwrap_err());
    assert!(changed.contains("is not what was planned"), "{changed}");
    assert_eq!(status(&out).unwrap().counts.pending, 6);
}

#[test]
fn what_cannot_be_planned_is_told_with_factor_and_level() {
    let planned = |text: &str| {
        let folder = written(&format!("case = \"case.toml\"\n{text}"));
        said(&planned(folder.path()).unwrap_err())
    };
    let error = planned("[factors]\n\"wind.speed\" = [8, \"fast\"]");
    assert!(error.contains("the case cannot be run with wind.speed = fast"), "{error}");
    let error = planned("[factors]\n\"wind.sped\" = [8]");
    assert!(error.contains("wind.sped = 8"), "{error}");
    let error = planned(
        "[[linked]]\nname = \"wind\"\nlevels = [{ name = \"a\", \"wind.speed\" = 8 }, { name = \"b\", \"wind.speed\" = 8.0 }]",
    );
    assert!(
        error.contains("two tasks are the same case: wind = a, wind.speed = 8; and wind = b"),
        "{error}"
    );
    let error = planned("[factors]\n\"wind.speed\" = [8]\n[[exclude]]\n\"wind.speed\" = 8");
    assert!(error.contains("makes no task: all are excluded"), "{error}");
    let empty = tempfile::tempdir().unwrap();
    assert!(said(&status(empty.path()).unwrap_err()).contains("holds no campaign"));
}

#[test]
fn a_task_that_cannot_be_made_is_failed_and_the_others_are_made() {
    // No NREL 5 MW runs in 40 m/s: what only the turbine tells, not the case reader.
    let (_folder, out) = begun(&CAMPAIGN.replace("[8, 9.5]", "[8, 9, 40, 9.5]"));
    let ended = made(&out, &RunOptions::default());
    let failures = status(&out).unwrap().failures;
    let found = (ended.n_failed, ended.counts.done, ended.counts.failed);
    assert_eq!(found, (3, 9, 3), "{failures:?}");
    assert_eq!(failures[0].settings, "wind.speed = 40, control.T1.amplitude_deg = 1");
    assert!(failures[0].message.contains("40"), "{failures:?}");
    assert_eq!(made(&out, &RunOptions::default()).n_failed, 0);
    let again = made(&out, &RunOptions { retry_failed: true, ..RunOptions::default() });
    assert_eq!((again.n_failed, again.counts.failed), (3, 3));
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_holds_what_was_collected() {
    use ::parquet::file::reader::{FileReader, SerializedFileReader};
    use ::parquet::record::Field;
    let column = |name: &str, unit: &str, values| column::Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    };
    let columns = [
        column("task", "", Values::Whole(vec![Some(1), Some(2)])),
        column("strategy", "", Values::Text(vec![Some("yaw, -10°".to_owned()), None])),
        column("T1.power.mean", "W", Values::Number(vec![None, Some(0.1 + 0.2)])),
    ];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.parquet");
    fs::write(&path, crate::parquet::bytes(&columns).unwrap()).unwrap();
    let file = SerializedFileReader::new(fs::File::open(&path).unwrap()).unwrap();
    let metadata = file.metadata().file_metadata().key_value_metadata().unwrap();
    assert_eq!(metadata[0].value.as_deref(), Some(r#"{"T1.power.mean":"W"}"#));
    let rows: Vec<Vec<(String, Field)>> =
        file.get_row_iter(None).unwrap().map(|row| row.unwrap().into_columns()).collect();
    let name = |index: usize| columns[index].name.clone();
    let first = [
        (name(0), Field::Long(1)),
        (name(1), Field::Str("yaw, -10°".to_owned())),
        (name(2), Field::Null),
    ];
    assert_eq!(rows[0], first);
    assert_eq!(rows[1][1..], [(name(1), Field::Null), (name(2), Field::Double(0.1 + 0.2))]);
}

#[cfg(feature = "parquet")]
#[test]
fn surrogates_read_the_parquet_that_is_collected() {
    use formats::table::Samples;
    announce_parquet();
    // More rows than are read at a time.
    let n = 20_000;
    let number = |row: usize| 0.1 * row as f64;
    let column = |name: &str, unit: &str, values| column::Column {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    };
    let columns = |broken: Option<usize>| {
        let loads = (0..n).map(|row| (Some(row) != broken).then(|| number(row)));
        [
            column("task", "", Values::Whole((0..n).map(|row| Some(row as i64)).collect())),
            column("strategy", "", Values::Text(vec![Some("greedy".to_owned()); n])),
            column("T1.RootMyb1.del_m10", "kN m", Values::Number(loads.collect())),
        ]
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.parquet");
    let read = |broken, names: &[&str]| {
        fs::write(&path, crate::parquet::bytes(&columns(broken)).unwrap()).unwrap();
        Samples::read(&path, names)
    };
    let found = read(None, &["T1.RootMyb1.del_m10", "task"]).unwrap();
    assert_eq!((found.lines.len(), found.columns[0].unit.as_str()), (n, "kN m"));
    assert!((0..n).all(|row| found.row(row) == [number(row), row as f64]));
    for (broken, name, words) in [
        (Some(17_000), "T1.RootMyb1.del_m10", "row 17001: T1.RootMyb1.del_m10 is NaN"),
        (None, "strategy", "column strategy holds no plain numbers"),
        (None, "T1.RootMyb2.del_m10", "no column \"T1.RootMyb2.del_m10\""),
    ] {
        let error = read(broken, &[name]).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    fs::write(&path, "no Parquet").unwrap();
    assert!(Samples::read(&path, &["task"]).is_err());
}

#[test]
fn scripts_name_every_task_once() {
    let (_folder, out) = begun(CAMPAIGN);
    let script = |format, chunk| {
        export(&out, &Script { format, program: "wake mix".to_owned(), chunk }).unwrap()
    };
    let slurm = script(Format::Slurm, 4);
    assert!(slurm.contains("#SBATCH --array=1-2\n") && slurm.contains("'wake mix' campaign exec"));
    assert!(script(Format::HyperQueue, 1).contains("--array=1-6 --cpus=1 -- bash -c"));
    assert!(script(Format::Parallel, 3).contains("seq 1 3 6 | parallel"));
}

#[test]
fn a_star_stands_for_any_part() {
    for (name, pattern, is) in [
        ("T1.power.mean", "T1.*", true),
        ("T1.power.mean", "*.power.mean", true),
        ("T1.power.mean", "*power*", true),
        ("T1.power.mean", "T1.power", false),
        ("T2.power.mean", "T1.*", false),
        ("T1.RootMyb1.del_m10", "*.RootMyb1.del*", true),
    ] {
        assert_eq!(numbers::is_like(name, pattern), is, "{name} {pattern}");
    }
}

#[test]
fn every_number_of_a_full_summary_has_a_name_of_its_own_and_a_unit() {
    let summary = Summary { cost: Spent::default(), ..basis::records::examples::full() };
    let found = numbers(&summary);
    let mut names: Vec<&str> = found.iter().map(|number| number.name.as_str()).collect();
    names.sort();
    assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "{names:?}");
    assert!(found.iter().all(|number| !number.unit.is_empty()));
}
