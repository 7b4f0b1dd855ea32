//! A precursor in a folder: a small box is spun up, stopped, resumed to the same bits, lengthened, and read
//! as wind.

use formats::case::parse_precursor;
use formats::records::{Drift, PrecursorFolder, PrecursorResult};
use formats::turbulence_box;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use study::Silent;
use study::precursor::{
    PrecursorError, PrecursorEstimate, PrecursorObserver, PrecursorOptions, PrecursorOutcome,
    PrecursorProgress, precursor,
};

/// A layer of 100 m in 32 × 32 × 16 cells, two minutes and half a minute long.
const CASE: &str = "name = \"small\"\n\
    [box]\nlength = 400\nwidth = 400\nheight = 200\ncell = 12.5\n\
    [atmosphere]\nlatitude_deg = 52.6\nroughness_length = 0.01\ngeostrophic_wind = 8.0\n\
    geostrophic_direction_deg = 240\ninversion_height = 100\ninversion_strength = 2\ninversion_depth = 25\n\
    [time]\nspin_up = 120\nrecord = 30\nstatistics_interval = 10\n\
    [planes]\nhub_height = 70\n";

fn options(folder: &Path, name: &str, overrides: &[&str]) -> PrecursorOptions {
    let case = folder.join("small.toml");
    fs::write(&case, CASE).unwrap();
    PrecursorOptions {
        case,
        output: Some(folder.join(name)),
        overrides: overrides.iter().map(|&text| text.to_owned()).collect(),
        ..PrecursorOptions::default()
    }
}

fn done(options: &PrecursorOptions) -> (PrecursorResult, PrecursorFolder) {
    match precursor(options, &AtomicBool::new(false), &mut Silent).unwrap() {
        PrecursorOutcome::Done { result, folder } => (*result, folder),
        other => panic!("{other:?}"),
    }
}

fn refused(options: &PrecursorOptions) -> PrecursorError {
    precursor(options, &AtomicBool::new(false), &mut Silent).expect_err("it cannot be made")
}

/// Stops the precursor at its first step, or where its record begins.
struct Stopping<'a> {
    stop: &'a AtomicBool,
    at_first_step: bool,
    n_cells: usize,
    direction: Option<f64>,
}

impl PrecursorObserver for Stopping<'_> {
    fn estimated(&mut self, estimate: &PrecursorEstimate) {
        self.n_cells = estimate.plan.cells();
        assert!(estimate.wall_time() > 0.0 && estimate.disk > estimate.planes);
    }

    fn advanced(&mut self, progress: &PrecursorProgress) {
        assert!(progress.step <= progress.n_steps && progress.hub_speed > 0.0);
        if self.at_first_step {
            self.stop.store(true, Ordering::Relaxed);
        }
    }

    fn spun_up(&mut self, drift: Option<&Drift>, direction: f64) {
        assert_eq!(drift.map(|drift| drift.block), Some(30.0));
        self.direction = Some(direction);
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// Makes a part of the precursor; gives where its wind came from, where its record had begun.
fn part(options: &PrecursorOptions, at_first_step: bool) -> Option<f64> {
    let stop = AtomicBool::new(false);
    let mut observer = Stopping { stop: &stop, at_first_step, n_cells: 0, direction: None };
    let outcome = precursor(options, &stop, &mut observer).unwrap();
    assert!(matches!(outcome, PrecursorOutcome::Interrupted { .. }), "{outcome:?}");
    assert_eq!(observer.n_cells, 32 * 32 * 16);
    observer.direction
}

fn bytes(folder: &PrecursorFolder) -> [Vec<u8>; 2] {
    [folder.planes_path(), folder.statistics_path()].map(|path: PathBuf| fs::read(path).unwrap())
}

#[test]
fn what_is_stopped_and_resumed_has_the_same_bits_and_is_wind() {
    let folder = tempfile::tempdir().unwrap();
    let (result, at_once) = done(&options(folder.path(), "at-once", &[]));
    let mut stopped = options(folder.path(), "stopped", &["box.threads=1"]);
    assert_eq!(part(&stopped, true), None);
    stopped.resume = true;
    let direction = part(&stopped, false).expect("a record that has begun");
    let (resumed, in_parts) = done(&stopped);
    assert!(bytes(&in_parts) == bytes(&at_once), "not the same bits");
    assert_eq!((&resumed.planes, &resumed.profile), (&result.planes, &result.profile));

    // The wind is that of the layer: after two minutes still about the geostrophic one at this height.
    let planes = &result.planes;
    assert!((planes.direction_deg - direction).abs() < 1e-9);
    assert!((planes.direction_deg - 240.0).abs() < 15.0, "{planes:?}");
    assert!((7.0..8.5).contains(&planes.hub_speed), "{planes:?}");
    assert!((0.0..0.3).contains(&planes.turbulence_intensity), "{planes:?}");
    assert!(planes.turned_deg.abs() < 2.0, "{planes:?}");
    assert_eq!((planes.n_planes, planes.n_points), (39, [32, 8]));
    assert_eq!(result.profile.len(), 16);
    let hub = result.profile.iter().find(|row| row.height > 65.0).unwrap();
    assert!((hub.speed / planes.hub_speed - 1.0).abs() < 0.05, "{hub:?} {planes:?}");
    let mut read = turbulence_box::open(&at_once.planes_path()).unwrap();
    let grid = read.grid();
    assert!((grid.speed - planes.hub_speed).abs() < 1e-3);
    assert_eq!((grid.n_y, grid.n_z, grid.n_steps, grid.repeats), (32, 8, 39, false));
    let mut plane = vec![[0.0; 3]; 32 * 8];
    read.read(38, &mut plane).unwrap();
    let mean = |axis: usize| plane.iter().map(|wind| f64::from(wind[axis])).sum::<f64>() / 256.0;
    assert!((5.0..8.0).contains(&mean(0)) && mean(1).abs() < 1.0 && mean(2).abs() < 0.2);
}

#[test]
fn a_longer_one_goes_on_and_says_where_it_cannot() {
    let folder = tempfile::tempdir().unwrap();
    let set = |overrides: &[&str], resume: bool| PrecursorOptions {
        resume,
        ..options(folder.path(), "grown", overrides)
    };
    done(&set(&[], false));
    assert!(matches!(refused(&set(&[], false)), PrecursorError::OutputExists { .. }));
    let other = refused(&set(&["atmosphere.geostrophic_wind=7"], true));
    assert!(matches!(other, PrecursorError::OtherCase { .. }), "{other}");
    let passed = refused(&set(&["time.spin_up=140"], true)).to_string();
    assert!(passed.contains("stands at 149.7 s and has recorded from 120.0 s on"), "{passed}");
    assert!(matches!(refused(&set(&["time.record=20"], true)), PrecursorError::Passed { .. }));
    // What is complete is read.
    let (_, grown) = done(&set(&[], true));
    let before = bytes(&grown);
    let (longer, _) = done(&set(&["time.record=40"], true));
    assert_eq!(longer.planes.n_planes, 52);
    let (_, at_once) = done(&options(folder.path(), "long", &["time.record=40"]));
    assert!(bytes(&grown) == bytes(&at_once) && bytes(&grown) != before);
    let later = ["time.spin_up=165", "time.record=20"];
    done(&set(&later, true));
    let (_, at_once) = done(&options(folder.path(), "late", &later));
    assert!(bytes(&grown) == bytes(&at_once), "not the same bits after a longer spin-up");
}

#[test]
fn a_wind_that_is_held_moves_what_drives_it_and_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let text = CASE.replace("geostrophic_wind = 8.0", "hub_wind = 7.5");
    let case = text.replace("geostrophic_direction_deg", "hub_direction_deg");
    let asked = |name: &str| {
        let options = options(folder.path(), name, &[]);
        fs::write(&options.case, &case).unwrap();
        options
    };
    let (result, at_once) = done(&asked("at-once"));
    let mut stopped = asked("stopped");
    part(&stopped, true);
    stopped.resume = true;
    let direction = part(&stopped, false).expect("a record that has begun");
    let (resumed, in_parts) = done(&stopped);
    assert!(bytes(&in_parts) == bytes(&at_once), "not the same bits");
    assert_eq!(resumed.geostrophic_speed, result.geostrophic_speed);
    // It starts with that wind, into which faster air from above is mixed; hours would bring it back.
    assert!((direction - 240.0).abs() < 3.0, "{direction}");
    let record = result.record.expect("two blocks");
    assert!(record.hub_speed.iter().all(|speed| (speed / 7.5 - 1.0).abs() < 0.05), "{record:?}");
    let precursor = parse_precursor(Path::new("held"), &case, &[]).unwrap().precursor;
    let moved = result.geostrophic_speed / precursor.geostrophic_speed() - 1.0;
    assert!(moved.abs() > 1e-4 && moved.abs() < 0.1, "{moved}");
}

#[test]
fn what_cannot_begin_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut asked = options(folder.path(), "none", &[]);
    asked.resume = true;
    assert!(matches!(refused(&asked), PrecursorError::NothingToResume { .. }));
    asked.resume = false;
    asked.dry_run = true;
    let outcome = precursor(&asked, &AtomicBool::new(false), &mut Silent).unwrap();
    assert_eq!(outcome, PrecursorOutcome::Estimated);
    asked.overrides = vec!["box.length=200".to_owned()];
    assert!(refused(&asked).to_string().contains("cannot be run"));
    assert!(!folder.path().join("none").exists());
}
