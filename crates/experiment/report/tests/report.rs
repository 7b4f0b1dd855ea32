//! The page of a study in closed form: what it says, that it stands alone, that it always stands.

#[path = "report/layouts.rs"]
mod layouts;
mod synthetic;
#[path = "report/tables.rs"]
mod tables;

use basis::Sense;
use basis::records::{ControlSummary, PitchExcitation, Series, examples};
use report::{
    Along, PhaseNumbers, PhaseRow, ReportError, Signals, StudyRecords, Synchronisation,
    TrackFigure, TrackLine, TrackRow,
};
use std::fs;
use std::path::Path;

fn page(study: &StudyRecords) -> String {
    report::page(study).expect("a page").replace('\u{a0}', " ")
}

fn read(folder: &Path) -> String {
    fs::read_to_string(folder.join("report.html")).expect("a page").replace('\u{a0}', " ")
}

#[test]
fn the_page_says_what_the_numbers_say_and_under_which_conditions() {
    let page = page(&synthetic::two_runs());
    for expected in [
        "<h1>quickstart</h1>",
        "A counter-clockwise helix of 4.0° on T1 cost T1 2.1 % of its power and gave T2 14.2 % more: \
         +5.3 % ± 1.2 % for the two together.",
        "TI 5.0 % target, 4.6 % realised",
        "spacing 5.0 D",
        "ccw helix on T1, 4.0° target, 3.9° delivered, St 0.25",
        "2100 s analysed in 3 ten-minute blocks",
        "16 cells per diameter",
        "compared with “baseline” in the same inflow",
        "Power of T1 differs from blade-element momentum by 6.1 % (limit 5 %)",
        "<td class=\"n\">8.91</td><td class=\"pm\">± 0.18</td>",
        "1 258 291",
        "<td class=\"n\">120 MB</td><td class=\"n\">–</td></tr>",
        "<td class=\"n\">120 MB</td><td class=\"n\">298 MB</td></tr>",
        "<td class=\"n\">−2.793 MN m&#x2f;°</td><td class=\"n\">14.3</td><td class=\"n\">3.50</td>",
        "wakemix 0.1.0",
    ] {
        assert!(page.contains(expected), "`{expected}` is missing");
    }
}

#[test]
fn the_page_opens_with_the_runs_that_are_still_to_come() {
    let mut study = synthetic::two_runs();
    assert!(!page(&study).contains("class=\"incomplete\""));
    study.runs.truncate(1);
    study.incomplete = vec!["helix-ccw".into(), "helix-cw".into()];
    let told = page(&study);
    let notice = "<p class=\"incomplete\">Of 3 runs 1 is complete, and on this page; not yet complete: helix-ccw and helix-cw.</p>";
    let place = told.find(notice).expect("a notice");
    assert!(place < told.find("class=\"headline\"").expect("a headline"));
    study.incomplete = (1..=9).map(|number| format!("run-{number}")).collect();
    assert!(page(&study).contains("run-1, run-2, run-3, run-4, run-5 and 4 more."));
}

#[test]
fn a_page_can_be_written_without_its_figures() {
    let (whole, alone) =
        (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let study = synthetic::two_runs();
    report::write(&study, whole.path()).expect("a report");
    report::write_page(&study, alone.path()).expect("a page");
    assert_eq!(read(whole.path()), read(alone.path()));
    assert!(!alone.path().join("figures").exists());
}

#[test]
fn a_synchronised_turbine_is_named_and_what_both_runs_do_is_left_out() {
    let mut study = synthetic::two_runs();
    let helix = study.runs[1].summary.turbines[0].clone();
    study.runs[0].summary.turbines[0].control = helix.control;
    study.runs[0].summary.turbines[0].delivered_pitch = helix.delivered_pitch;
    let summary = &mut study.runs[1].summary;
    summary.turbines[0].power_gain.as_mut().expect("a gain").mean = 0.0002;
    let joining = examples::helix(Sense::CounterClockwise, 4.0).excitation;
    summary.turbines[1].control = ControlSummary {
        excitation: joining.map(|set| PitchExcitation { phase_offset_deg: Some(90.2), ..set }),
        ..ControlSummary::plain("phase-sync", "in words that nobody reads")
    };
    summary.turbines[1].delivered_pitch = helix.delivered_pitch;
    let page = page(&study);
    for expected in [
        "A synchronised helix of 4.0° at 90° on T2 gave T2 14.2 % more: +5.3 % ± 1.2 % for the two together.",
        "ccw helix synchronised at 90° on T2, 4.0° target, 3.9° delivered",
    ] {
        assert!(page.contains(expected), "`{expected}` is missing");
    }
}

#[test]
fn the_page_stands_alone_and_its_elements_close() {
    let page = page(&synthetic::two_runs());
    for attribute in ["src=", "href="] {
        for (at, _) in page.match_indices(attribute) {
            let value = &page[at + attribute.len()..];
            let stays = ["\"data:", "\"#"].iter().any(|start| value.starts_with(start));
            assert!(stays, "{}", &value[..60]);
        }
    }
    for outside in ["@import", "http://", "https://", "fetch(", "<link", "<iframe"] {
        // Names of namespaces, which nobody fetches.
        let allowed = page.matches("http://www.w3.org/").count();
        let n_found = page.matches(outside).count();
        let n_allowed = if outside == "http://" { allowed } else { 0 };
        assert_eq!(n_found, n_allowed, "{outside}");
    }
    // What a case file says is shown, not obeyed.
    assert!(page.contains("&lt;script&gt;alert(1)"));
    assert_eq!(page.matches("<script").count(), 1);
    assert_well_formed(&page);
}

/// Walks through the tags and checks that each closes the one that was opened last.
fn assert_well_formed(page: &str) {
    let is_void = |name: &str| matches!(name, "meta" | "br" | "link" | "!doctype");
    let mut open: Vec<&str> = Vec::new();
    let mut ids = Vec::new();
    let mut rest = page;
    while let Some(start) = rest.find('<') {
        rest = &rest[start + 1..];
        let end = rest.find('>').expect("a tag ends");
        let tag = &rest[..end];
        let name =
            tag.trim_start_matches('/').split(|c: char| c.is_whitespace() || c == '/').next();
        let name = name.expect("a tag has a name");
        if let Some(id) = tag.split(" id=\"").nth(1).and_then(|value| value.split('"').next()) {
            assert!(!ids.contains(&id), "two elements are called {id}");
            ids.push(id);
        }
        rest = &rest[end + 1..];
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "<{tag}> closes nothing");
        } else if !tag.ends_with('/') && !is_void(name) {
            open.push(name);
            if name == "script" || name == "style" {
                let close = rest.find("</").expect("it ends");
                rest = &rest[close..];
            }
        }
    }
    assert!(open.is_empty(), "{open:?} stay open");
}

#[test]
fn figures_lie_beside_the_page_in_both_forms_and_nothing_else_does() {
    let folder = tempfile::tempdir().expect("a folder");
    report::write(&synthetic::two_runs(), folder.path()).expect("a report");
    let mut names: Vec<String> = fs::read_dir(folder.path().join("figures"))
        .expect("figures")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    for name in ["power", "gains", "mean-hub-height", "mean-crosswind", "pitch", "recovery"] {
        assert!(names.contains(&format!("{name}.svg")) && names.contains(&format!("{name}.png")));
    }
    assert!(names.iter().all(|name| name.ends_with(".svg") || name.ends_with(".png")), "{names:?}");
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 2);
    let png = fs::read(folder.path().join("figures/power.png")).expect("a picture");
    let header = png::Decoder::new(std::io::Cursor::new(png));
    assert_eq!(header.read_info().expect("a picture").info().width, 2000);
}

#[test]
fn the_same_records_give_the_same_bytes_and_a_second_report_replaces_the_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut study = synthetic::two_runs();
    study.runs.truncate(1);
    study.runs[0].instant_planes.clear();
    let bytes = |study: &StudyRecords| {
        report::write(study, folder.path()).expect("a report");
        let picture = fs::read(folder.path().join("figures/power.png")).expect("a picture");
        (read(folder.path()), picture)
    };
    assert_eq!(bytes(&study), bytes(&study));
    study.case_name = "renamed".into();
    assert!(bytes(&study).0.contains("<h1>renamed</h1>"));
}

#[test]
fn what_is_missing_is_left_out() {
    let mut study = synthetic::two_runs();
    study.runs.truncate(1);
    study.description = None;
    study.case_text = "not a case file".into();
    let only = &mut study.runs[0];
    only.series = Default::default();
    only.mean_planes.clear();
    only.instant_planes.clear();
    only.summary.array_power.half_width_95 = None;
    let page = page(&study);
    assert!(page.contains("T1 and T2 made 13.4 MW together in the run “baseline”."));
    for absent in ["<figure", "Gain (%)", "spacing", "NaN", ">inf", "None", "undefined"] {
        let text = page.split("<script").next().expect("a body").split("</style>").nth(1);
        assert!(!text.expect("a body").contains(absent), "`{absent}` is on the page");
    }
    assert_well_formed(&page);
}

#[test]
fn a_gain_without_certainty_says_so() {
    let mut study = synthetic::two_runs();
    let gain = study.runs[1].summary.array_power_gain.as_mut().expect("a gain");
    gain.half_width_95 = Some(0.09);
    assert!(page(&study).contains("The interval includes zero"));
    study.runs[1].summary.array_power_gain.as_mut().expect("a gain").half_width_95 = None;
    assert!(page(&study).contains("There is no interval"));
}

#[test]
fn the_channels_that_are_drawn_are_all_that_a_report_needs() {
    let mut study = synthetic::two_runs();
    let whole = page(&study);
    for run in &mut study.runs {
        let Series { names, columns } = std::mem::take(&mut run.series);
        let n_all = names.len();
        let drawn = names.into_iter().zip(columns);
        let drawn = drawn.filter(|(name, _)| report::draws(&run.summary, name));
        let (names, columns): (Vec<String>, Vec<Vec<f64>>) = drawn.unzip();
        assert!(names.len() < n_all);
        run.series = Series { names, columns };
    }
    assert!(page(&study) == whole, "another page without what is not drawn");
    // Of a turbine that is not excited no pitch is drawn.
    let [baseline, helix] = [0, 1].map(|run| &study.runs[run].series.names);
    let pitch = "T1.BldPitch1".to_owned();
    assert!(helix.contains(&pitch) && !baseline.contains(&pitch));
}

#[test]
fn broken_records_still_make_a_page() {
    let mut study = synthetic::two_runs();
    for run in &mut study.runs {
        run.summary.turbines[0].power.mean = f64::NAN;
        run.summary.conditions.target_wind_speed = 0.0;
        run.series.columns[1].truncate(3);
        run.mean_planes[0].velocity[0].pop();
        for value in &mut run.mean_planes[1].velocity[0] {
            *value = f32::NAN;
        }
    }
    assert_well_formed(&page(&study));
}

#[test]
fn many_runs_make_a_curve_over_amplitude_and_keep_their_colours() {
    let page = page(&synthetic::nine_runs());
    assert!(page.contains("id=\"gain-over-amplitude\""));
    assert!(page.contains("A counter-clockwise helix of 5.0° on T1"));
    assert_well_formed(&page);
}

#[test]
fn a_turbine_that_is_absent_in_one_run_is_shown_in_the_others() {
    let mut study = synthetic::two_runs();
    study.runs[0].summary.turbines.remove(1);
    study.runs[1].summary.turbines[1].power_gain = None;
    study.runs[1].summary.array_power_gain = None;
    let page = page(&study);
    assert!(page.contains("T1 made 13.4 ± 0.3 MW in the run “baseline”."));
    assert!(page.contains("<td>T2</td>"));
    assert_well_formed(&page);
}

/// How well the run `helix-ccw` found its phases, in yaw in too short a record for the helix's frequency.
fn phases() -> PhaseRow {
    let numbers = |phase_error: Option<[f64; 2]>| PhaseNumbers {
        rmse: 0.3,
        bias: 0.1,
        spread: 0.2,
        locking: 0.95,
        coherence: phase_error.map(|_| 0.87),
        phase_error: phase_error.map(|angles| angles.map(f64::to_radians)),
        amplitude: 1.23,
        true_amplitude: 1.5,
    };
    PhaseRow {
        run: "helix-ccw".into(),
        offset: Some(1.0),
        tilt: numbers(Some([-12.34, 4.56])),
        yaw: numbers(None),
        trust: 0.5,
    }
}

/// A turbine's phase synchronisation with one line of phases and one figure.
fn joined(name: &str) -> Synchronisation {
    let times: Vec<f64> = (0..200).map(f64::from).collect();
    let values = times.iter().map(|time| (0.07 * time).sin()).collect();
    let line = TrackLine { name: "true".into(), colour: 0, times, values, band: Vec::new() };
    let row = TrackRow { label: "tilt (m/s)".into(), is_angle: false, lines: vec![line] };
    let track = TrackFigure {
        along: Along::TIME,
        name: "phases-helix-ccw".into(),
        title: format!("Phase of the helix at {name}"),
        caption: "True phases.".into(),
        rows: vec![row],
        mark: None,
    };
    Synchronisation {
        name: name.into(),
        phases: vec![phases()],
        tracks: vec![track],
        ..Synchronisation::default()
    }
}

#[test]
fn every_turbine_that_joins_a_helix_has_its_part_its_rows_and_its_files() {
    let mut study = synthetic::two_runs();
    study.synchronisation = vec![joined("T2"), joined("T3")];
    let folder = tempfile::tempdir().expect("a folder");
    report::write(&study, folder.path()).expect("a report");
    let both = read(folder.path());
    for turbine in ["T2", "T3"] {
        for expected in [
            format!("<h2>Phase synchronisation of {turbine}</h2>"),
            format!("<figure id=\"phases-helix-ccw-{turbine}\">"),
            format!("<h3>Phase of the helix at {turbine}</h3>"),
        ] {
            assert_eq!(both.matches(&expected).count(), 1, "`{expected}`");
        }
        let row = format!("<td>helix-ccw</td><td>{turbine}</td><td class=\"n\">57</td>");
        assert_eq!(both.matches(&row).count(), 2, "`{row}`, tilt and yaw");
        let file = folder.path().join(format!("figures/phases-helix-ccw-{turbine}.svg"));
        assert!(file.exists(), "{}", file.display());
    }
    assert_well_formed(&both);
    // One alone needs no telling apart.
    study.synchronisation.pop();
    let alone = page(&study);
    assert!(alone.contains("<h2>Phase synchronisation</h2>"));
    assert!(alone.contains("<figure id=\"phases-helix-ccw\">"));
}

#[test]
fn what_must_be_said_of_signals_stands_below_them_and_alone_where_nothing_is_drawn() {
    let mut study = synthetic::two_runs();
    let bare = page(&study);
    study.signals = vec![Signals {
        title: "The wake by phase".to_owned(),
        notes: vec!["a <file> is damaged".to_owned()],
        ..Signals::default()
    }];
    let told = page(&study);
    assert!(told.contains("<h2>The wake by phase</h2>"));
    assert!(told.contains("<li>a &lt;file&gt; is damaged</li>"));
    assert_well_formed(&told);
    // Without anything to show or to say there is no such part.
    study.signals = vec![Signals { title: "Nothing".to_owned(), ..Signals::default() }];
    assert_eq!(page(&study), bare);
}

#[test]
fn the_phase_error_at_the_helix_frequency_stands_beside_its_coherence() {
    let mut study = synthetic::two_runs();
    study.synchronisation =
        vec![Synchronisation { phases: vec![phases()], ..Synchronisation::default() }];
    let page = page(&study);
    for expected in [
        "<th class=\"n\" colspan=\"2\">phase error (°)</th>",
        "<td class=\"n\">0.87</td><td class=\"n\">−12.3</td><td class=\"pm\">± 4.6</td><td class=\"n\">1.23</td>",
        "<td class=\"n\">–</td><td class=\"n\">–</td><td class=\"pm\"></td><td class=\"n\">1.23</td>",
    ] {
        assert!(page.contains(expected), "`{expected}` is missing");
    }
    assert_well_formed(&page);
}

#[test]
fn a_study_without_runs_and_a_folder_that_is_a_file_are_refused() {
    let mut study = synthetic::two_runs();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    fs::write(&file, "").expect("a file");
    assert!(matches!(report::write(&study, &file), Err(ReportError::Write { .. })));
    study.runs.clear();
    let refusal = report::write(&study, folder.path()).expect_err("nothing to report");
    assert!(matches!(refusal, ReportError::NoRuns { .. }));
    assert!(!folder.path().join("report.html").exists());
}
