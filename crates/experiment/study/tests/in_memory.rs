//! A case as a value, run in memory, comes to the numbers that the same case comes to in a folder.

mod small;

use basis::records::{Cost, Summary};
use farm::case::Position;
use serde_json::Value;
use small::{NREL_5MW, behind_helix, options, written};
use study::{Outcome, Prepared, StudyError};

fn text() -> String {
    let runs = "[[run]]\nname = \"baseline\"\n".to_owned()
        + &behind_helix("helix", &[])
        + "[output]\ninterval = 0.4\n";
    small::case("memory", "shear_exponent = 0.1\n", [20.0, 80.0], &[NREL_5MW; 2], &runs)
}

/// Without what tells of the machine and the hour.
fn numbers(summary: &Summary) -> Value {
    let summary = Summary { cost: Cost::default(), ..summary.clone() };
    serde_json::to_value(summary).expect("an object")
}

/// Whether the values are equal but for the last bits of numbers, which the units of the file cost.
fn is_close(one: &Value, other: &Value) -> bool {
    match (one, other) {
        (Value::Number(one), Value::Number(other)) => {
            let [one, other] = [one, other].map(|number| number.as_f64().expect("a number"));
            (one - other).abs() <= 1e-9 * one.abs().max(other.abs()) + 1e-12
        }
        (Value::Array(one), Value::Array(other)) => {
            one.len() == other.len()
                && one.iter().zip(other).all(|(one, other)| is_close(one, other))
        }
        (Value::Object(one), Value::Object(other)) => {
            let same = |((key, one), (name, other)): ((&String, &Value), (&String, &Value))| {
                key == name && is_close(one, other)
            };
            one.len() == other.len() && one.iter().zip(other).all(same)
        }
        (one, other) => one == other,
    }
}

#[test]
fn a_case_without_files_comes_to_the_same_numbers() {
    let folder = written(&text());
    let outcome = small::run(&options(folder.path()));
    let Ok(Outcome::Done { summaries, directory }) = outcome else { panic!("{outcome:?}") };

    let case = formats::case::parse("case", &text(), &[]).expect("a sound case");
    let ready = Prepared::of(case).and_then(Prepared::ready).expect("a sound case");
    let results = ready.run_all().expect("runs");
    assert_eq!(results.len(), 2);
    for (result, summary) in results.iter().zip(&summaries) {
        let (own, of_files) = (numbers(&result.summary), numbers(summary));
        assert!(is_close(&own, &of_files), "{own:#} {of_files:#}");
        let run = formats::records::RunFolder::new(&directory, &summary.run);
        let series = formats::records::read_series(&run.series_path(), |_| true);
        let series = series.expect("a series");
        assert_eq!(result.series.names, series.names);
        for (name, (own, read)) in
            series.names.iter().zip(result.series.columns.iter().zip(&series.columns))
        {
            let is_close = |(own, read): (&f64, &f64)| (own - read).abs() <= 1e-15 * own.abs();
            assert!(own.len() == read.len() && own.iter().zip(read).all(is_close), "{name}");
        }
        assert!(result.last_planes.is_empty());
    }
    assert!(results[1].summary.array_power_gain.is_some());
    assert!(matches!(ready.run("pulse"), Err(StudyError::UnknownRun { .. })));
}

#[test]
fn a_value_that_no_file_could_hold_is_refused_as_a_file_would_be() {
    let case = formats::case::parse("case", &text(), &[]).expect("a sound case");
    let refused = |change: &dyn Fn(&mut farm::case::Case), said: &str| {
        let mut case = case.clone();
        change(&mut case);
        let Err(StudyError::Case(error)) = Prepared::of(case).map(|_| ()) else { panic!("{said}") };
        let problem = error.problems()[0].to_string();
        assert!(problem.contains(said), "{problem}");
    };
    refused(&|case| case.wind.speed = -1.0, "speed");
    refused(&|case| case.output.lines_at = vec![7], "turbine number 7");
    refused(&|case| drop(case.runs[1].control.pop()), "1 controls for 2 turbines");
    refused(&|case| case.turbines[1].position = Position::Diameters([0.1, 0.0]), "T2");
}
