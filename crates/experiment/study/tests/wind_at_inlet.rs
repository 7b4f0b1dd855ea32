//! Wind of a file that enters resolved flow: the inlet has the file's wind, and what does not fit is refused.

mod small;

use basis::Vector3;
use basis::records::PlaneAxes;
use flow::inflow::PlaneGrid;
use flow::inflow::mann::{self, MannSettings};
use formats::records::{RunFolder, read_manifest};
use formats::turbulence_box::{self, Carried, StoredBox, WindRecorder};
use small::{HALFWAY, STOP, written};
use std::fs;
use std::path::Path;
use study::{Outcome, Outputs, Prepared, Silent, StudyError, StudyOptions};
use tempfile::TempDir;

const CASE: &str = r#"
name = "file"
[wind]
speed = 9.0
turbulence_intensity = 0.08
planes = "w.bts"
[flow]
cells_per_diameter = 8
upstream_diameters = 2.0
downstream_diameters = 3.0
width_diameters = 4.0
height_diameters = 3.0
[time]
spin_up = 20.0
duration = 60.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
[output]
crosswind_diameters = [1.0]
"#;
const SPEED: f64 = 9.0;
const SPACING: f64 = 15.0;

/// Turbulence after Mann on `n_points`, as `wakemix inflow generate` makes it.
fn mann_box(n_points: [usize; 3]) -> StoredBox {
    let settings = MannSettings {
        n_points,
        spacing: [SPACING; 3],
        length_scale: 60.0,
        anisotropy: 3.9,
        standard_deviation: 0.08 * SPEED,
        seed: 7,
        threads: Some(1),
    };
    StoredBox {
        turbulence: mann::generate(&settings, |_| ()).expect("a box"),
        hub_speed: SPEED,
        hub_height: 90.0,
        lowest_height: 0.5 * SPACING,
        mean_speeds: (0..n_points[2]).map(|z| 8.0 + 0.08 * z as f64).collect(),
        description: "a trial".to_owned(),
    }
}

/// The case in the wind of a box on `n_points` in the file `name`, `more` under `[wind]`.
fn study(name: &str, n_points: [usize; 3], more: &str) -> TempDir {
    let folder =
        written(&CASE.replace("planes = \"w.bts\"", &format!("planes = \"{name}\"\n{more}")));
    turbulence_box::write(&folder.path().join(name), &mann_box(n_points)).expect("a file");
    folder
}

fn prepared(folder: &Path) -> Result<Prepared, StudyError> {
    Prepared::read(&folder.join("case.toml"), &[])
}

#[track_caller]
fn refused(folder: &Path) -> String {
    match prepared(folder) {
        Err(StudyError::Case(error)) => error.to_lines(),
        Err(error) => panic!("{error:?}"),
        Ok(_) => panic!("it is taken"),
    }
}

/// The domain is 504 m wide and 378 m high.
const WIDE: [usize; 3] = [64, 36, 26];

#[test]
fn the_inlet_has_the_wind_of_the_file() {
    let folder = study("w.bts", WIDE, "");
    let setup = prepared(folder.path()).expect("a sound case");
    assert!(setup.recorded.is_some_and(|recorded| recorded.memory == 64 * 36 * 26 * 12));
    let ready = setup.ready().expect("it can begin");
    let plan = &ready.prepared.plan;
    let inlet = plan.origin.x - 0.5 * plan.spacing;
    let mut planes = turbulence_box::open(&folder.path().join("w.bts")).expect("a file");
    let grid = planes.grid();
    let mut read = vec![[0.0; 3]; grid.n_y * grid.n_z];
    let mut wind = [Vector3::ZERO];
    for step in [0, 17, 63] {
        planes.read(step, &mut read).expect("a plane");
        // When the plane passes the inlet, having passed the first turbine at its own time.
        let time = (step as f64 + 64.0) * grid.interval + inlet / grid.speed;
        for (y, z) in [(3, 1), (20, 9), (31, 24)] {
            let place = [grid.first[0] + y as f64 * SPACING, grid.first[1] + z as f64 * SPACING];
            ready.inflow.sample(time, &[Vector3::new(inlet, place[0], place[1])], &mut wind);
            let [u, v, w] = read[z * grid.n_y + y].map(f64::from);
            let found = wind[0];
            assert!((found - Vector3::new(u, v, w)).length() < 1e-3, "{found}, {u} {v} {w}");
        }
    }
    // The air behind the inlet is what came in: nearer to the file than to its mean.
    let run = ready.prepared.case.runs[0].clone();
    let mut park = ready.farm(&run).expect("a farm");
    let n_steps = (20.0 / plan.interval) as usize;
    (0..n_steps).for_each(|_| park.advance(&mut farm::Unrecorded).expect("a step"));
    let fields = park.flow().fields().expect("resolved flow");
    let x = plan.origin.x + 0.5 * plan.spacing;
    let plane = fields.plane("inlet", PlaneAxes::Crosswind, x);
    let (mut far, mut from_mean, mut n) = (0.0, 0.0, 0.0);
    for point in 0..plane.velocity[0].len() {
        let (column, row) = (point % plane.n_points[0], point / plane.n_points[0]);
        let y = plane.origin[1] + column as f64 * plane.spacing[0];
        let z = plane.origin[2] + row as f64 * plane.spacing[1];
        ready.inflow.sample(plane.time, &[Vector3::new(x, y, z)], &mut wind);
        let found = f64::from(plane.velocity[0][point]);
        far += (found - wind[0].x).powi(2);
        let place = (z - grid.first[1]) / SPACING;
        from_mean += (found - 8.0 - 0.08 * place).powi(2);
        n += 1.0;
    }
    let [far, from_mean] = [far, from_mean].map(|squares: f64| (squares / n).sqrt());
    assert!(
        far < 0.4 * from_mean && from_mean > 0.4,
        "{far} m/s from the file, {from_mean} from its mean"
    );
}

/// What a run of the case left in its series and planes.
fn left(run: &Path) -> Vec<Vec<u8>> {
    ["series.csv", "planes/hub-height-mean.nc", "planes/1D-last.nc"]
        .map(|name| fs::read(run.join(name)).expect(name))
        .to_vec()
}

#[test]
fn a_stopped_run_goes_on_in_the_same_wind_on_any_threads() {
    // Narrower and lower than the domain.
    let folder = study("w.bts", [64, 20, 16], "beyond_planes = \"mean\"\n");
    let on = |threads: usize, output: &str| StudyOptions {
        output: Some(folder.path().join(output)),
        overrides: vec![format!("flow.threads={threads}")],
        ..small::options(folder.path())
    };
    small::done(&on(1, "whole"));
    let outputs = Outputs::standard().with(&HALFWAY);
    let mut again = on(2, "stopped");
    let outcome = study::run_with(&again, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    again.resume = true;
    small::done(&again);
    let [whole, stopped] = ["whole", "stopped"].map(|name| folder.path().join(name));
    assert!(left(&whole.join("baseline")) == left(&stopped.join("baseline")), "other bits");
    let manifest = read_manifest(&RunFolder::new(&stopped, "baseline")).expect("a manifest");
    assert_eq!(manifest.wind_sha256.keys().collect::<Vec<_>>(), ["w.bts"]);
}

#[test]
fn a_grid_smaller_than_the_domain_is_refused_unless_the_case_says_what_blows_there() {
    let narrow = [64, 20, 26];
    let lines = refused(study("w.bts", narrow, "").path());
    assert!(
        lines.contains("w.bts: the file covers y -142.5 to 142.5 m and z up to 382.5 m, the domain needs y -243.9 to 243.9 m"),
        "{lines}"
    );
    assert!(lines.contains("beyond_planes = \"repeat\""), "{lines}");
    let folder = study("w.bts", narrow, "beyond_planes = \"hold\"\n");
    assert!(prepared(folder.path()).is_ok());
    // A HAWC2 box is repeated, and says so.
    let folder = study("w.toml", narrow, "");
    let setup = prepared(folder.path()).expect("a box that repeats");
    let told = |setup: &Prepared| {
        setup.warnings.iter().any(|warning| warning.message.contains("which is repeated"))
    };
    assert!(told(&setup), "{:?}", setup.warnings);
    let chosen = study("w.toml", narrow, "beyond_planes = \"repeat\"\n");
    assert!(!told(&prepared(chosen.path()).expect("a sound case")));
}

/// Puts a record that does not repeat, of `n_steps` planes of 1 s and of `speed`, in the place of the file.
fn record(folder: &Path, n_steps: usize, speed: f32) {
    let grid = PlaneGrid {
        n_y: 35,
        n_z: 26,
        spacing: [SPACING; 2],
        first: [-17.0 * SPACING, 0.5 * SPACING],
        interval: 1.0,
        speed: f64::from(speed),
        n_steps,
        repeats: false,
    };
    let path = folder.join("w.bts");
    let mut recorder = WindRecorder::create(&path, 35 * 26).expect("a file");
    (0..n_steps).for_each(|_| recorder.write(&[[speed, 0.0, 0.0]; 35 * 26]).expect("a plane"));
    recorder.finish(&grid, 97.5, Carried::Middle, "a trial").expect("a record");
}

#[test]
fn a_record_that_ends_too_early_or_blows_too_fast_is_refused() {
    let folder = study("w.bts", WIDE, "");
    // 60 s, and 28.9 s from half the grid's width (255 m) to the inlet (260 m) on the way.
    record(folder.path(), 100, 9.0);
    let lines = refused(folder.path());
    assert!(
        lines.contains("record of 99.0 s does not repeat, and the run needs 117.2 s"),
        "{lines}"
    );
    record(folder.path(), 119, 9.0);
    let setup = prepared(folder.path()).expect("long enough");
    assert!(!setup.warnings.iter().any(|w| w.message.contains("wind.planes")));
    record(folder.path(), 119, 10.5);
    let setup = prepared(folder.path()).expect("long enough");
    let told = |w: &study::SetupWarning| w.message.contains("wind.planes blows with 10.50 m/s");
    assert!(setup.warnings.iter().any(told), "{:?}", setup.warnings);
    record(folder.path(), 119, 24.0);
    let lines = refused(folder.path());
    assert!(lines.contains("write wind.speed = 24.00"), "{lines}");
}

#[test]
fn air_of_the_first_plane_that_is_there_after_the_spin_up_is_warned_of() {
    let folder = study("w.bts", WIDE, "");
    let told = |spin_up: &str| {
        let overrides = [format!("time.spin_up={spin_up}")];
        let setup = Prepared::read(&folder.path().join("case.toml"), &overrides);
        let warnings = setup.expect("a sound case").warnings;
        let told = warnings.into_iter().map(|warning| warning.message);
        told.filter(|message| message.contains("first plane")).collect::<Vec<_>>()
    };
    // A box comes round, so that planes came before the first one.
    assert_eq!(told("0"), [""; 0]);
    // From half the width of the grid (255 m) to the plane behind the outlet (386 m) at 9 m/s.
    record(folder.path(), 119, 9.0);
    assert_eq!(told("15"), [""; 0]);
    let [warning] = &told("14")[..] else { panic!("{:?}", told("14")) };
    for expected in ["the last 131 m of the domain, from x = 255 m on", "time.spin_up", "to 15 s"] {
        assert!(warning.contains(expected), "{warning}, expected {expected}");
    }
}

#[test]
fn turbulence_that_has_divergence_is_warned_of_where_the_file_tells_its_maker() {
    let folder = study("w.bts", WIDE, "");
    let told = |description: &str| {
        let stored = StoredBox { description: description.to_owned(), ..mann_box(WIDE) };
        turbulence_box::write(&folder.path().join("w.bts"), &stored).expect("a file");
        let warnings = prepared(folder.path()).expect("a sound case").warnings;
        warnings
            .into_iter()
            .any(|warning| warning.message.contains("TurbSim's, which has divergence"))
    };
    assert!(told("This full-field file was generated by TurbSim (v2.00.07, 2016) on 01-Jan-2020."));
    assert!(!told("Generated by TurbSimFile on 01-Jan-2020."));
    assert!(!told("wakemix 0.1.0: Mann, L 60.0 m, Gamma 3.9"));
}
