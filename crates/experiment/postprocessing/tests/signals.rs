//! Winds, spectra, moments and meandering in the records of small studies: numbers, figures, report.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use basis::angle::wrap_to_half_turn;
use postprocessing::analyses::Request;
use postprocessing::{
    ANALYSES, MomentsQuestion, PhaseQuestion, PostprocessingError, meandering, moments, phase,
    spectra, wind_numbers,
};
use small::{ABSENT, DISK, MONITORING, NREL_5MW, behind_helix, done, options, written};
use std::fs;
use std::path::Path;

/// Both turbines stand in the path of one disk of slow air, whose waves T2 takes for a helix.
fn row() -> String {
    let alone = "[[run]]\nname = \"calm\"\ncontrol.T2 = { kind = \"absent\" }\n";
    let runs = [behind_helix("joined", &[MONITORING]), behind_helix("alone", &[ABSENT])];
    let kept = "[output]\ninterval = 0.2\nlines_at = [\"T2\"]\n";
    small::case("row", DISK, [100.0, 600.0], &[NREL_5MW; 2], &(runs.concat() + alone + kept))
}

/// What the analysis called `name` answers of `records`, with its figures in `figures`.
fn answered(name: &str, records: &Path, figures: &Path) -> (String, serde_json::Value) {
    let analysis = ANALYSES.iter().find(|analysis| analysis.name == name).expect("an analysis");
    let request = Request::of(records).with("figures", &figures.display().to_string());
    let answer = (analysis.run)(&request).expect("sound records");
    (answer.text, answer.json)
}

fn assert_drawn(figures: &Path, name: &str) {
    for form in ["svg", "png"] {
        let path = figures.join("figures").join(format!("{name}.{form}"));
        assert!(fs::metadata(&path).is_ok_and(|found| found.len() > 1000), "{}", path.display());
    }
}

#[test]
fn winds_and_spectra_of_a_row_stand_in_numbers_figures_and_report() {
    let folder = written(&row());
    let output = done(&options(folder.path()));
    let report = postprocessing::report(&output).expect("a report").page;
    let figures = folder.path().join("drawn");

    let question = PhaseQuestion { run: output.join("joined"), ..PhaseQuestion::default() };
    let found = phase(&question).expect("sound records");
    let [average, tilt, yaw] = wind_numbers(&found);
    // The disk's waves are far larger than what the estimator cannot see. Their amplitude is another: loads
    // weigh the outer blade, which the disk's edge sweeps over, more than lines do.
    for axis in [tilt, yaw] {
        assert!(axis.correlation > 0.9, "{axis:?}");
    }
    assert!(average.rmse < 1.5 && average.within.is_some(), "{average:?}");
    let (text, json) = answered("winds", &output.join("joined"), &figures);
    assert!(text.contains("\ntilt ") && text.contains("within σ"), "{text}");
    let times = json[0]["times_s"].as_array().expect("times").len();
    for of in ["estimated_m_s", "true_m_s", "deviation_m_s"] {
        assert_eq!(json[0]["winds"]["yaw"][of].as_array().expect("values").len(), times, "{of}");
    }
    assert_drawn(&figures, "winds-joined-T2");

    let found = spectra(&output).expect("sound records");
    let [answer] = found.as_slice() else { panic!("{} places", found.len()) };
    let number = |run: &str, of: &str| {
        let lines = &answer.lines;
        lines.iter().find(|line| line.run == run && line.of == of).expect("a line")
    };
    // Prescribed wind is the same with and without a helix.
    for of in ["average", "tilt", "yaw"] {
        assert_eq!(number("alone", of).peak, number("calm", of).peak);
    }
    assert!(number("alone", "tilt").has_helix && !number("calm", "tilt").has_helix);
    let moment = number("joined", "tilt moment");
    assert!(moment.stands_out > 3.0 && moment.noise.is_some(), "{moment:?}");
    // The baseline is the first line, and so has the colour of what others compare with.
    let winds = answer.winds.as_ref().expect("a figure");
    assert_eq!(winds.rows[0].lines[0].name, "calm");
    answered("spectra", &output, &figures);
    assert_drawn(&figures, "wind-spectra-T2");
    assert_drawn(&figures, "tilt-moment-density-T2");

    let page = fs::read_to_string(&report).expect("a report");
    for id in ["phases-joined", "wind-spectra-T2", "tilt-moment-density-T2"] {
        assert!(page.contains(&format!("<figure id=\"{id}\">")), "{id}");
    }
}

/// A turbine alone pitches a helix in a steady wind: models are given what it measures.
#[test]
fn models_have_the_moments_of_a_turbine_in_a_steady_wind() {
    let run = "[[run]]\nname = \"helix\"\ncontrol.T1 = { kind = \"helix\", sense = \"ccw\", amplitude_deg = 3.0, strouhal = 0.25 }\n[output]\ninterval = 0.2\n";
    let folder = written(&small::case("steady", "", [120.0, 420.0], &[NREL_5MW], run));
    let output = done(&options(folder.path()));
    let question = MomentsQuestion {
        run: output.join("helix"),
        azimuth_offset: Some(0.3),
        ..MomentsQuestion::default()
    };
    let found = moments(&question).expect("sound records");
    let line =
        |name: &str| found.lines.iter().find(|line| line.name.starts_with(name)).expect("a line");
    let (measured, robust) = (line("measured"), line("robust"));
    // Momentum theory on either side, the blades stiff in the one and flexible in the other.
    let wind = robust.wind.expect("a wind");
    assert!((wind / 9.0 - 1.0).abs() < 0.1, "{wind} m/s");
    let [tilt, own] = [robust, measured].map(|line| line.amplitudes[0]);
    assert!((tilt / own - 1.0).abs() < 0.25, "{tilt} {own}");
    // An azimuth offset delays what the pitch does by as much.
    let delayed = line("dynamic, no").leads[0] - line("dynamic, azimuth").leads[0];
    assert!((wrap_to_half_turn(delayed) - 0.3).abs() < 0.02, "{delayed} rad");
    assert_eq!(measured.leads, [0.0; 2]);
    answered("moments", &output.join("helix"), folder.path());
    assert_drawn(folder.path(), "blade-moments-helix-T1");
    let turbine = Some("T9".to_owned());
    let refused = moments(&MomentsQuestion { turbine, ..question }).expect_err("no such turbine");
    assert!(matches!(refused, PostprocessingError::NoSignals { .. }), "{refused}");
}

#[test]
fn meandering_is_followed_at_the_rate_of_the_disk() {
    let runs = ["baseline", "less"].map(|name| {
        let [factor, amplitude] = if name == "less" { [0.7, 3.0] } else { [1.0, 0.0] };
        format!(
            "[[run]]\nname = \"{name}\"\ncontrol.T1 = {{ kind = \"meandering\", factor = {factor:?}, amplitude_deg = {amplitude:?}, start = 300.0, azimuth_offset_deg = 0.0, delay = 0.0, moment_per_degree_mnm = 0.9 }}\n"
        )
    });
    let wind = "event = { kind = \"rotating-disk\", speed = 6.0, strouhal = 0.2, strouhal_last = 0.22, sweep = 600.0, edge_diameters = 0.1 }\n";
    let case = small::case(
        "disk",
        wind,
        [350.0, 700.0],
        &[NREL_5MW],
        &(runs.concat() + "[output]\ninterval = 0.4\n"),
    );
    let folder = written(&case);
    let output = done(&options(folder.path()));
    let (numbers, signals) = meandering(&output).expect("sound records");
    let named: Vec<&str> = numbers.iter().map(|found| found.run.as_str()).collect();
    assert_eq!(named, ["baseline", "less"]);
    assert_eq!((numbers[0].factor, numbers[1].factor), (None, Some(0.7)));
    // 0.21 · 9/126 Hz about the middle of the sweep; a loop follows a ramp without a lasting error.
    for found in &numbers {
        let [mean, _] = found.frequency;
        assert!((mean / 0.0154 - 1.0).abs() < 0.05, "{mean} Hz");
        assert!(found.frequency_error.expect("a disk") < 0.05, "{found:?}");
        assert!(found.axes.iter().all(|axis| axis.target > 0.0), "{found:?}");
    }
    // The run that only monitors has no error of a target.
    let tracking = &signals[0].tracks[1];
    let [errors, frequency] = [&tracking.rows[0], &tracking.rows[4]];
    assert_eq!(errors.lines.iter().map(|line| line.name.as_str()).collect::<Vec<_>>(), ["less"]);
    assert_eq!(frequency.lines.last().expect("lines").name, "the disk's");
    answered("meandering", &output, folder.path());
    for name in ["meandering-loads-T1", "meandering-tracking-T1", "meandering-spectra-T1"] {
        assert_drawn(folder.path(), name);
    }
    let refused = spectra(&output).expect_err("no lines, no helix");
    assert!(refused.to_string().contains("kept the wind"), "{refused}");
}

/// Rows too far apart for the loads that a loop follows take nothing else from the report.
#[test]
fn rows_far_apart_still_have_their_report() {
    let run = "[[run]]\nname = \"baseline\"\ncontrol.T1 = { kind = \"meandering\", factor = 1.0, amplitude_deg = 0.0 }\n[output]\ninterval = 20.0\n";
    let folder = written(&small::case("coarse", "", [40.0, 200.0], &[NREL_5MW], run));
    let output = done(&options(folder.path()));
    let report = postprocessing::report(&output).expect("a report").page;
    let page = fs::read_to_string(report).expect("a page");
    assert!(page.contains("<figure id=\"power\">") && !page.contains("meandering-loads"), "{page}");
    // Who asks for them is told.
    assert!(matches!(meandering(&output), Err(PostprocessingError::Analysis { .. })));
}
