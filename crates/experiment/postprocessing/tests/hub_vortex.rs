//! The hub vortex in kept scans: found where it was drawn, as a controller found it, and asked for in vain.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use basis::keys::Values;
use basis::records::Series;
use basis::scan::{Scan, ScanBlocks, ScanLayout};
use basis::{HelixFrame, Matrix3, Sense, Vector3};
use formats::records::{RunFolder, ScanInstant, ScanSetting, ScanWriter, read_scans, read_series};
use miette::Diagnostic;
use postprocessing::analyses::Request;
use postprocessing::{
    ANALYSES, HubVortexQuestion, HubVortexTrack, PostprocessingError, VortexFilter, hub_vortex,
};
use small::{NREL_5MW, done, options, written};
use std::fs;
use std::path::Path;

/// An NREL 5 MW turbine with a lidar that measures at every control instant.
const WITH_LIDAR: &str =
    "model = \"nrel-5mw\"\nsensors.lidar = { kind = \"lidar\", rate_hz = 5.0 }";
const RADIUS: f64 = 63.0;
/// Control interval of the small cases (s).
const INTERVAL: f64 = 0.2;
/// The circle that is drawn: radius (m), middle to the left and up (m), phase at time zero (rad).
const CIRCLE: f64 = 12.0;
const MIDDLE: [f64; 2] = [4.0, -5.0];
const PHASE: f64 = 0.7;

/// A run with a helix, one without, and what of it is kept.
fn case(machine: &str, duration: f64) -> String {
    let runs = "[[run]]\nname = \"baseline\"\n".to_owned() + &small::behind_helix("helix", &[]);
    small::case("scanned", "", [60.0, duration], &[machine], &runs)
}

/// Where the jet is at `time` (s): left and up (m).
fn jet(frame: &HelixFrame, time: f64) -> [f64; 2] {
    let [tilt, yaw] = frame.to_fixed(time, frame.open_helix(CIRCLE, PHASE));
    [MIDDLE[0] - yaw, MIDDLE[1] + tilt]
}

/// Places of a scan's points, left and up (m): a square grid over the rotor's disc.
fn grid() -> Vec<[f64; 2]> {
    let row = || (-5..5).map(|index| 12.5 * (f64::from(index) + 0.5));
    let places = row().flat_map(|y| row().map(move |z| [y, z]));
    places.filter(|[y, z]| y.hypot(*z) < RADIUS).collect()
}

/// Draws the wake of a rotor with a jet that turns with `frame` in it for `duration` (s), in the place of the
/// scans of the run in `folder`; gives the share of points that were lost. With a `depth` of 0 it is even
/// wind, with 1 the wake.
fn draw(folder: &RunFolder, frame: HelixFrame, duration: f64, depth: f64) -> f64 {
    let places = grid();
    let direction =
        |place: &[f64; 2]| Vector3::new(2.0 * RADIUS, place[0], place[1]).normalize().to_array();
    let setting = ScanSetting {
        case: "scanned".into(),
        run: folder.run(),
        turbine: "T1".into(),
        sensor: "lidar".into(),
        values: Values::none(),
        layout: ScanLayout {
            directions: places.iter().map(direction).collect(),
            ranges: places.iter().map(|[y, z]| y.hypot(*z).hypot(2.0 * RADIUS)).collect(),
            n_ranges: 1,
            rate: 1.0 / INTERVAL,
        },
        hub: [0.0, 0.0, 90.0],
        rotor_diameter: 2.0 * RADIUS,
        helix: Some(frame),
        wind_speed: 9.0,
    };
    let mut writer =
        ScanWriter::create(&folder.scans_path("T1", "lidar"), &setting).expect("a file");
    let mut reading = vec![0.0; Scan::n_values(places.len())];
    let (mut random, mut n_lost, mut n) = (7_u64, 0, 0);
    for step in 0..(duration / INTERVAL).round() as u64 {
        let time = step as f64 * INTERVAL;
        let jet = jet(&frame, time);
        let blocks = ScanBlocks::of(&mut reading).expect("a scan");
        for (point, [y, z]) in places.iter().enumerate() {
            let (x, r) = (2.0 * RADIUS, y.hypot(*z));
            let wake = 2.5 * (-0.5 * ((y - jet[0]).hypot(z - jet[1]) / 12.0).powi(2)).exp()
                - 4.5 * (-0.5 * (r / (0.8 * RADIUS)).powi(2)).exp();
            let wind = 10.0 + depth * wake;
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let is_lost = random >> 33 < (1 << 31) / 10;
            blocks.speeds[point] = if is_lost { f64::NAN } else { wind * x / x.hypot(r) };
            blocks.places[0][point] = x;
            blocks.places[1][point] = *y;
            blocks.places[2][point] = *z;
            blocks.times[point] = time;
            n_lost += u64::from(is_lost);
            n += 1;
        }
        let scan = Scan::of(&reading).expect("a scan");
        let (origin, axes) = (Vector3::new(0.0, 0.0, 90.0), Matrix3::IDENTITY);
        writer
            .write(&ScanInstant { time, azimuth: 0.0, origin, axes, scan })
            .expect("it is written");
    }
    writer.finish().expect("a file");
    n_lost as f64 / n as f64
}

/// How far a mean tilt and yaw (m) is from where it should be, turned by `late` (rad).
fn off(track: &HubVortexTrack, frame: &HelixFrame, late: f64) -> f64 {
    let expected = frame.open_helix(CIRCLE, PHASE);
    let turned = HelixFrame { rate: 1.0, ..*frame }.of_fixed(late, expected);
    let [tilt, yaw] = track.numbers.helix;
    (tilt - turned[0]).hypot(yaw - turned[1])
}

#[test]
fn a_jet_of_known_place_is_found_again_drawn_and_told() {
    let folder = written(&case(WITH_LIDAR, 62.0));
    let output = done(&options(folder.path()));
    let run = RunFolder::new(&output, "helix");
    let frame = read_scans(&run.scans_path("T1", "lidar")).expect("scans").helix.expect("a helix");
    assert_eq!(frame.sense, Sense::CounterClockwise);
    let lost = draw(&run, frame, 300.0, 1.0);
    assert!(lost > 0.05);

    let question = HubVortexQuestion { run: run.path().to_owned(), ..Default::default() };
    let answer = hub_vortex(&question).expect("an answer");
    // What was lost has stayed lost.
    assert!((answer.missing - lost).abs() < 1e-12, "{} {lost}", answer.missing);
    assert!((answer.interval - INTERVAL).abs() < 1e-9 && answer.times.len() == 1500);
    let [published, robust, centroid] = &answer.tracks[..] else { panic!("three filters") };
    // The robust filter is within a few per cent of the circle, with its delay made good.
    let [left, up] = robust.numbers.centre;
    assert!((left - MIDDLE[0]).hypot(up - MIDDLE[1]) < 0.05 * CIRCLE, "{:?}", robust.numbers);
    assert!((robust.numbers.radius[0] / CIRCLE - 1.0).abs() < 0.05, "{:?}", robust.numbers);
    assert!(off(robust, &frame, 0.0) < 0.05 * CIRCLE, "{:?}", robust.numbers);
    assert!(robust.numbers.blind == 0.0 && robust.numbers.confidence > 0.5);
    // The published one moves in steps: a fifth, as `FastRegion` says; late by half of its 50 samples.
    let late = frame.rate * 25.0 * INTERVAL;
    assert!((published.numbers.radius[0] / CIRCLE - 1.0).abs() < 0.2, "{:?}", published.numbers);
    assert!(off(published, &frame, late) < 0.2 * CIRCLE, "{:?}", published.numbers);
    // The centroid turns as the jet does, on a circle of its own: compare the directions.
    let [tilt, yaw] = frame.open_helix(CIRCLE, PHASE);
    let [own_tilt, own_yaw] = centroid.numbers.helix;
    let turn = own_yaw.atan2(own_tilt) - yaw.atan2(tilt);
    assert!(basis::angle::wrap_to_half_turn(turn).abs() < 0.05, "{:?}", centroid.numbers);

    // In the other sense nothing stands still.
    let sense = Some(Sense::Clockwise);
    let wrong = hub_vortex(&HubVortexQuestion { sense, ..question.clone() }).expect("an answer");
    assert!(wrong.tracks[1].numbers.helix_deviation[0] > 5.0, "{:?}", wrong.tracks[1].numbers);

    let analysis = ANALYSES.iter().find(|analysis| analysis.name == "hub-vortex").expect("it");
    let csv = folder.path().join("vortex.csv");
    let request = Request::of(run.path())
        .with("filter", "robust")
        .with("csv", &csv.display().to_string())
        .with("figures", &folder.path().display().to_string());
    let told = (analysis.run)(&request).expect("an answer");
    assert!(told.text.contains("\nrobust ") && !told.text.contains("\npublished"), "{}", told.text);
    assert_eq!(told.json["filters"][0]["filtered_left_m"].as_array().expect("it").len(), 1500);
    let table = read_series(&csv, |_| true).expect("a table");
    let column = table.column("robust.HubVortexLeft").expect("a channel");
    assert_eq!(column[1499], robust.vortices[1499].filtered[0]);
    for name in ["hub-vortex-T1-lidar", "hub-vortex-path-T1-lidar"] {
        let path = folder.path().join("figures").join(format!("{name}.png"));
        assert!(fs::metadata(path).is_ok_and(|found| found.len() > 1000), "{name}");
    }

    // Beside each other: the first run, and further ones.
    let mut both = Request::of(run.path())
        .with("filter", "robust")
        .with("figures", &folder.path().display().to_string());
    both.folders.push(run.path().to_owned());
    let told = (analysis.run)(&both).expect("an answer");
    let beside = told.json["beside"].as_array().expect("the other run");
    assert_eq!(beside[0]["filters"][0]["radius_m"], told.json["filters"][0]["radius_m"]);
    assert_eq!(told.text.matches("\nrobust ").count(), 2, "{}", told.text);
    for name in ["hub-vortex-paths-T1-lidar", "hub-vortices-T1-lidar"] {
        let path = folder.path().join("figures").join(format!("{name}.png"));
        assert!(fs::metadata(path).is_ok_and(|found| found.len() > 1000), "{name}");
    }

    let page = fs::read_to_string(postprocessing::report(&output).expect("a report").page);
    assert!(page.expect("the page").contains("What the lidar of T1 saw"));
    for name in ["scan-pattern-T1-lidar", "scans-T1-lidar-helix", "scans-T1-lidar-baseline"] {
        let path = output.join("figures").join(format!("{name}.svg"));
        assert!(fs::metadata(path).is_ok_and(|found| found.len() > 1000), "{name}");
    }
    refused_without_a_frame(&output);
}

/// A run without a helix has no frame, unless one is given.
fn refused_without_a_frame(output: &Path) {
    let run = output.join("baseline");
    let question = HubVortexQuestion { run, ..Default::default() };
    let error = hub_vortex(&question).expect_err("no helix");
    assert!(error.to_string().contains("whose turbine pitched no helix"), "{error}");
    assert!(error.help().expect("a fix").to_string().contains("--frequency"));
    let turbine = Some("T7".to_owned());
    let error = hub_vortex(&HubVortexQuestion { turbine, ..question }).expect_err("no T7");
    assert!(error.help().expect("a fix").to_string().contains("it has scans-T1.lidar.nc"));
}

/// Where nothing stands out no jet is found, and the centroid still is.
#[test]
fn filters_that_find_nothing_are_told_beside_those_that_do() {
    let folder = written(&case(WITH_LIDAR, 62.0));
    let run = RunFolder::new(&done(&options(folder.path())), "helix");
    let frame = read_scans(&run.scans_path("T1", "lidar")).expect("scans").helix.expect("a helix");
    draw(&run, frame, 300.0, 0.0);
    let question = HubVortexQuestion { run: run.path().to_owned(), ..Default::default() };
    let answer = hub_vortex(&question).expect("an answer");
    let settled: Vec<VortexFilter> = answer.tracks.iter().map(|track| track.filter).collect();
    assert!(settled.contains(&VortexFilter::Centroid), "{settled:?}");
    assert!(!answer.unsettled.is_empty() && settled.len() + answer.unsettled.len() == 3);
    let analysis = ANALYSES.iter().find(|analysis| analysis.name == "hub-vortex").expect("it");
    let mut request = Request::of(run.path());
    let text = (analysis.run)(&request).expect("an answer").text;
    let told = format!("\n{:<10} has not settled", answer.unsettled[0].name());
    assert!(text.contains(&told) && text.contains("\ncentroid "), "{text}");
    // Alone it is no answer.
    let filters = vec![answer.unsettled[0]];
    let error = hub_vortex(&HubVortexQuestion { filters, ..question }).expect_err("nothing");
    assert!(error.to_string().contains("too short"), "{error}");
    // Beside another run what settles in both is left.
    request.folders.push(run.path().to_owned());
    let both = (analysis.run)(&request).expect("an answer");
    let names = |found: &serde_json::Value| {
        let filters = found["filters"].as_array().expect("filters").iter();
        filters.map(|found| found["filter"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(names(&both.json), names(&both.json["beside"][0]));
}

#[test]
fn a_run_without_scans_names_the_key_to_add() {
    for (more, key) in [
        ("", "sensors.lidar = { kind = \"lidar\" }"),
        ("[output]\nscans = \"none\"\n", "output.scans = \"none\""),
    ] {
        let folder = written(&(case(NREL_5MW, 62.0) + more));
        let run = done(&options(folder.path())).join("helix");
        let error = hub_vortex(&HubVortexQuestion { run, ..Default::default() });
        let error = error.expect_err("no scans");
        assert!(matches!(error, PostprocessingError::Scans { .. }));
        assert!(error.to_string().ends_with("holds no scans of a lidar of a turbine"), "{error}");
        let fix = error.help().expect("a fix").to_string();
        assert!(fix.contains(key) && fix.contains("--run helix --overwrite"), "{fix}");
    }
    // A report of such a study has no such part.
    let folder = written(&case(NREL_5MW, 62.0));
    let output = done(&options(folder.path()));
    let page = fs::read_to_string(postprocessing::report(&output).expect("a report").page);
    assert!(!page.expect("the page").contains("What the lidar"));
}

/// A disk of fast air that circles is seen by the probing turbine's own filter at every sample; the same
/// filter finds the same in the scans that were kept, to their single precision.
#[test]
fn it_is_what_the_controller_saw() {
    let disk = "event = { kind = \"rotating-disk\", speed = 13.0, strouhal = 0.25, strouhal_last = 0.25, radius_diameters = 0.1, edge_diameters = 0.1, sense = \"ccw\" }\n";
    let control = "[[run]]\nname = \"probing\"\ncontrol.T1 = { kind = \"probing\", sense = \"ccw\", amplitude_deg = 1.0, strouhal = 0.25, vortex_interval = 0.4, vortex_centre = [1.0, 2.0] }\n";
    let folder = written(&small::case("seen", disk, [60.0, 120.0], &[WITH_LIDAR], control));
    let run = done(&options(folder.path())).join("probing");
    let series = read_series(&run.join("series.csv"), |_| true).expect("a series");
    let filters = vec![VortexFilter::Robust];
    let question = HubVortexQuestion { run, filters, ..Default::default() };
    let answer = hub_vortex(&question).expect("an answer");
    assert_eq!((answer.interval, answer.given_centre), (0.4, Some([1.0, 2.0])));
    assert_eq!(answer.times.len(), 300);
    let shown = |series: &Series, name: &str, row: usize| {
        series.column(&format!("T1.HubVortex{name}")).expect("a channel")[row]
    };
    let mut furthest = 0.0_f64;
    for (sample, vortex) in answer.tracks[0].vortices.iter().enumerate().filter(|v| v.1.settled) {
        for (name, value) in [
            ("Left", vortex.filtered[0]),
            ("Up", vortex.filtered[1]),
            ("Tilt", vortex.helix[0]),
            ("Yaw", vortex.helix[1]),
        ] {
            let shown = shown(&series, name, 2 * sample);
            furthest = furthest.max(value.abs());
            assert!((value - shown).abs() < 1e-3, "{name} at {sample}: {value} {shown}");
        }
    }
    assert!(furthest > 5.0, "{furthest}: it has seen something");
    let page = postprocessing::report(folder.path().join("out").as_path()).expect("a report").page;
    let page = fs::read_to_string(page).expect("the page");
    assert!(page.contains("T1 in the frame of its helix") && page.contains("mean magnitude of"));
    for name in ["helix-frame-pitch-T1", "helix-frame-vortex-T1"] {
        let path = folder.path().join("out/figures").join(format!("{name}.svg"));
        assert!(fs::metadata(path).is_ok_and(|found| found.len() > 1000), "{name}");
    }
}
