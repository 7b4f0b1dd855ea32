//! A study in the atmosphere of its precursor: planes with temperature come in, the air is stratified and on
//! a rotating earth, and what does not fit is refused.

mod small;

use basis::Vector3;
use farm::assemble::lattice_settings;
use farm::wind::Site;
use flow::inflow::PlaneGrid;
use flow::lattice::Lattice;
use flow::{FlowSolver, Inflow};
use formats::netcdf::TemperatureReader;
use formats::records::{PrecursorFolder, RunFolder, read_manifest};
use formats::turbulence_box;
use small::{HALFWAY, STOP, written};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, OnceLock};
use study::precursor::{PrecursorOptions, PrecursorOutcome, precursor};
use study::{Outcome, Outputs, Prepared, Silent, StudyError, StudyOptions};
use tempfile::TempDir;

/// A layer of 150 m under an inversion, in 40 × 40 × 20 cells.
const PRECURSOR: &str = "name = \"layer\"\n\
    [box]\nlength = 600\nwidth = 600\nheight = 300\ncell = 15\n\
    [atmosphere]\nlatitude_deg = 52.6\nroughness_length = 0.01\ngeostrophic_wind = 9.0\n\
    geostrophic_direction_deg = 240\ninversion_height = 150\ninversion_strength = 2\ninversion_depth = 25\n\
    lapse_rate = 0.003\n\
    [time]\nspin_up = 90\nrecord = 60\nstatistics_interval = 10\n\
    [planes]\nhub_height = 90\nwidth = 255\n";

const CASE: &str = r#"
name = "in-layer"
[wind]
speed = 8.2
turbulence_intensity = 0.05
precursor = "layer"
[flow]
cells_per_diameter = 8
upstream_diameters = 1.0
downstream_diameters = 2.0
width_diameters = 2.0
height_diameters = 2.0
ground = { roughness_length = 0.01 }
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
[output]
crosswind_diameters = [1.0]
"#;

/// Files of a folder, by their places in it.
type Files = Vec<(PathBuf, Vec<u8>)>;

/// The case beside the folder of its precursor, which is made once.
fn study() -> TempDir {
    static MADE: OnceLock<Files> = OnceLock::new();
    let files = MADE.get_or_init(|| {
        let folder = written(CASE);
        let case = folder.path().join("layer.toml");
        fs::write(&case, PRECURSOR).expect("a file");
        let output = Some(folder.path().join("layer"));
        let options = PrecursorOptions { case, output, ..PrecursorOptions::default() };
        let outcome = precursor(&options, &AtomicBool::new(false), &mut Silent);
        assert!(matches!(outcome, Ok(PrecursorOutcome::Done { .. })), "{outcome:?}");
        let mut files = Vec::new();
        collect(folder.path(), Path::new(""), &mut files);
        files
    });
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (place, bytes) in files {
        let path = folder.path().join(place);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, bytes).expect("a file");
    }
    folder
}

/// Adds all files of `folder`, whose place is `place`, to `files`.
fn collect(folder: &Path, place: &Path, files: &mut Files) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let place = place.join(path.file_name().expect("a name"));
        match path.is_dir() {
            true => collect(&path, &place, files),
            false => files.push((place, fs::read(&path).expect("a file"))),
        }
    }
}

fn prepared(folder: &Path, overrides: &[&str]) -> Result<Prepared, StudyError> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    Prepared::read(&folder.join("case.toml"), &overrides)
}

#[track_caller]
fn refused(folder: &Path, overrides: &[&str]) -> String {
    match prepared(folder, overrides) {
        Err(StudyError::Case(error)) => error.to_lines(),
        Err(error) => panic!("{error:?}"),
        Ok(_) => panic!("it is taken"),
    }
}

/// Temperatures of plane number `step` of the precursor in `folder`, whose wind lies on `grid`.
fn recorded(folder: &Path, grid: &PlaneGrid, step: usize) -> Vec<f32> {
    let path = PrecursorFolder::new(&folder.join("layer")).temperature_path();
    let mut values = vec![0.0; grid.n_y * grid.n_z];
    TemperatureReader::open(&path, grid).expect("a file").read(step, &mut values).expect("a plane");
    values
}

#[test]
fn the_air_has_the_temperature_and_the_turning_of_the_precursor() {
    let folder = study();
    let setup = prepared(folder.path(), &[]).expect("a sound case");
    assert_eq!(setup.recorded.expect("planes").memory % 16, 0);
    let ready = setup.ready().expect("it can begin");
    let setup = &ready.prepared;
    let planes = PrecursorFolder::new(&folder.path().join("layer")).planes_path();
    let grid = turbulence_box::open(&planes).expect("a file").grid();
    let plan = &setup.plan;
    let inlet = plan.origin.x - 0.5 * plan.spacing;

    // At the inlet, when a plane passes it on its way from half its width upstream.
    let origin_x = 0.5 * (grid.across()[1] - grid.across()[0]);
    for step in [21, 30] {
        let time = step as f64 * grid.interval + (inlet - origin_x) / grid.speed;
        let expected = recorded(folder.path(), &grid, step);
        for (y, z) in [(3, 1), (9, 8)] {
            let place = [grid.first[0] + 15.0 * y as f64, grid.first[1] + 15.0 * z as f64];
            let (place, mut found) = ([Vector3::new(inlet, place[0], place[1])], [0.0]);
            assert!(ready.inflow.sample_temperature(time, &place, &mut found));
            let expected = f64::from(expected[z * grid.n_y + y]);
            assert!((found[0] - expected).abs() < 1e-2, "{} {expected}", found[0]);
        }
    }
    // Above the planes, which end under the inversion, it is warmer as the layer's own mean is.
    let air = setup.surroundings.as_ref().expect("an atmosphere");
    let (place, mut found) = ([Vector3::new(inlet, 0.0, 200.0)], [0.0]);
    assert!(ready.inflow.sample_temperature(10.0, &place, &mut found));
    assert!((found[0] - air.column().at(200.0).temperature).abs() < 0.1, "{}", found[0]);

    let (case, models) = (&setup.case, setup.models.as_slice());
    let settings = lattice_settings(&Site { case, plan, models, surroundings: Some(air) });
    let atmosphere = settings.atmosphere.as_ref().expect("an atmosphere");
    assert!((atmosphere.coriolis - 1.1586e-4).abs() < 1e-7);
    let flow::lattice::atmosphere::Driving::Geostrophic(wind) = atmosphere.driving;
    assert!((wind[0].hypot(wind[1]) - 9.0).abs() < 1e-6 && wind[0] > 8.8, "{wind:?}");

    // The wind far above is geostrophic, and stays so.
    let mut lattice = Lattice::new(settings, Arc::clone(&ready.inflow) as Arc<dyn Inflow>)
        .expect("such air can be");
    let n_steps = (15.0 / plan.interval).round();
    lattice.advance(n_steps * plan.interval, &[]).expect("it stays finite");
    let mut levels = lattice.level_statistics();
    let top = levels.pop().expect("levels").velocity;
    assert!((top[0] - wind[0]).abs() < 0.1 && (top[1] - wind[1]).abs() < 0.1, "{top:?} {wind:?}");
}

#[test]
fn the_memory_of_its_temperature_is_told() {
    let folder = study();
    // Rows of 135 cells: the ends of shorter ones weigh more.
    let fine = prepared(folder.path(), &["flow.cells_per_diameter=45"]).expect("a sound case");
    let (case, plan, models) = (&fine.case, &fine.plan, fine.models.as_slice());
    let site = Site { case, plan, models, surroundings: fine.surroundings.as_ref() };
    let air = Lattice::new(lattice_settings(&site), Arc::clone(&fine.mean_inflow));
    let told = (case.flow.solver.memory)(case, plan) as f64;
    let share = told / air.expect("such air can be").memory() as f64;
    assert!((0.9..1.1).contains(&share), "{share} of the memory is told");
}

/// What a run left in its series and planes.
fn left(run: &Path) -> Vec<Vec<u8>> {
    ["series.csv", "planes/hub-height-mean.nc", "planes/1D-last.nc"]
        .map(|name| fs::read(run.join(name)).expect(name))
        .to_vec()
}

/// Stops a study with `keys` half-way and resumes it on other threads, and compares with one at once; gives
/// the files of wind in its manifest.
fn stopped_and_resumed(folder: &Path, keys: &[&str]) -> Vec<String> {
    // One at a time may be stopped.
    static STOPPING: Mutex<()> = Mutex::new(());
    let _alone = STOPPING.lock();
    let on = |threads: usize, output: &str| StudyOptions {
        output: Some(folder.join(output)),
        overrides: keys
            .iter()
            .map(|&key| key.to_owned())
            .chain([format!("flow.threads={threads}")])
            .collect(),
        ..small::options(folder)
    };
    STOP.store(false, std::sync::atomic::Ordering::Relaxed);
    small::done(&on(1, "whole"));
    let outputs = Outputs::standard().with(&HALFWAY);
    let mut again = on(2, "stopped");
    let outcome = study::run_with(&again, &outputs, &STOP, &mut Silent);
    assert!(matches!(outcome, Ok(Outcome::Interrupted { .. })), "{outcome:?}");
    again.resume = true;
    small::done(&again);
    let [whole, stopped] = ["whole", "stopped"].map(|name| folder.join(name));
    assert!(left(&whole.join("baseline")) == left(&stopped.join("baseline")), "other bits");
    let manifest = read_manifest(&RunFolder::new(&stopped, "baseline")).expect("a manifest");
    let path = whole.join("baseline/planes/1D-last.nc");
    let plane = formats::netcdf::read_plane(&path).expect("a plane");
    let mean = plane.velocity[0].iter().map(|u| f64::from(*u)).sum::<f64>();
    assert!((4.0..9.0).contains(&(mean / plane.velocity[0].len() as f64)));
    manifest.wind_sha256.into_keys().collect()
}

#[test]
fn a_stopped_run_goes_on_in_the_same_air_on_any_threads() {
    let folder = study();
    let files = stopped_and_resumed(folder.path(), &["flow.sides=\"open\""]);
    let read = ["case.toml", "planes.bts", "precursor.json", "statistics.nc", "temperature.nc"];
    assert_eq!(files, read.map(|name| format!("layer/{name}")));
    // Beside a precursor that goes on.
    let beside = ["wind.precursor_wind=\"beside\"", "flow.sides=\"open\""];
    let folder = study();
    let files = stopped_and_resumed(folder.path(), &beside);
    assert_eq!(files, ["layer/case.toml", "layer/checkpoint", "layer/precursor.json"]);
}

#[test]
fn a_box_of_finer_cells_stands_in_the_atmosphere_and_goes_on_in_it() {
    let folder = study();
    // Cells as the precursor's and half of them around the rotor, from the ground to the top; planes, and
    // what goes on beside.
    let finer = "flow.refinement=[{ upstream_diameters = 1.25, downstream_diameters = 1.25, \
        width_diameters = 2.5, height_diameters = 2.25 }]";
    let wide = [
        "flow.cells_per_diameter=8",
        "flow.upstream_diameters=2.25",
        "flow.downstream_diameters=2.5",
        "flow.width_diameters=4",
        "flow.height_diameters=2.25",
        "time.duration=10",
    ];
    let setup = prepared(folder.path(), &[&[finer][..], &wide].concat()).expect("a sound case");
    assert_eq!((setup.plan.boxes.len(), setup.plan.levels.as_slice()), (1, &[1][..]));
    let keys = [&[finer, "flow.sides=\"open\""][..], &wide].concat();
    stopped_and_resumed(folder.path(), &keys);
    let folder = study();
    stopped_and_resumed(folder.path(), &[&keys[..], &["wind.precursor_wind=\"beside\""]].concat());
}

#[test]
fn what_goes_on_beside_a_study_is_the_precursor_itself() {
    let folder = study();
    let setup = prepared(folder.path(), &["wind.precursor_wind=\"beside\"", "time.duration=200"]);
    // No record ends, and the box is told of.
    let setup = setup.expect("a sound case");
    assert!(setup.recorded.is_none() && setup.memory_beside > 40 * 40 * 20 * 100);
    let ready = setup.ready().expect("it can begin");
    let run = ready.prepared.case.runs[0].clone();
    let mut park = ready.farm(&run).expect("a farm");
    let plan = &ready.prepared.plan;
    // Just behind the inlet, beside the rotor.
    let place = Vector3::new(plan.origin.x + 0.5 * plan.spacing, 0.0, 97.5);
    let wind = |park: &farm::Farm<farm::Air>| {
        let mut wind = [Vector3::ZERO];
        flow::WindField::sample(park.flow(), &[place], &mut wind);
        wind[0]
    };
    let n_steps = (30.0 / plan.interval).round();
    (0..n_steps as usize).for_each(|_| park.advance(&mut farm::Unrecorded).expect("a step"));
    // The precursor went on to the same time: its planes, recorded for longer, tell the same wind a little
    // later, for they stand in its middle.
    let longer = PrecursorOptions {
        case: folder.path().join("layer.toml"),
        output: Some(folder.path().join("layer")),
        overrides: vec!["time.record=120".to_owned()],
        resume: true,
        ..PrecursorOptions::default()
    };
    let outcome = precursor(&longer, &AtomicBool::new(false), &mut Silent);
    assert!(matches!(outcome, Ok(PrecursorOutcome::Done { .. })), "{outcome:?}");
    let planes = PrecursorFolder::new(&folder.path().join("layer")).planes_path();
    let mut planes = turbulence_box::open(&planes).expect("a file");
    let grid = planes.grid();
    let time = 60.0 + n_steps * plan.interval - place.x / grid.speed;
    let mut plane = vec![[0.0; 3]; grid.n_y * grid.n_z];
    planes.read((time / grid.interval).round() as usize, &mut plane).expect("a plane");
    let column = (-grid.first[0] / grid.spacing[0]).round() as usize;
    let row = ((place.z - grid.first[1]) / grid.spacing[1]).round() as usize;
    let [u, v, _] = plane[row * grid.n_y + column].map(f64::from);
    let found = wind(&park);
    assert!((found.x - u).abs() < 0.3 && (found.y - v).abs() < 0.3, "{found} {u} {v}");
}

#[test]
fn what_does_not_fit_is_refused_with_key_and_fix() {
    let folder = study();
    let at = |overrides: &[&str]| refused(folder.path(), overrides);
    for (overrides, expected) in [
        (&["flow.ground=\"slip\""][..], "write flow.ground = { roughness_length = 0.01 }"),
        (
            &["flow.height_diameters=4"],
            "the domain is 504 m high and the precursor's box 300 m: lower flow.height_diameters to 2.38",
        ),
        (&["wind.precursor=\"nowhere\""], "there is none"),
        (&["wind.planes=\"layer/planes.bts\""], "the planes are those of wind.precursor"),
        (&["wind.veer_deg_per_m=0.05"], "the atmosphere of wind.precursor brings its own veer"),
        (
            &["flow.solver=\"vortex\""],
            "flow.solver = \"vortex\" has neither temperature nor the earth's turning",
        ),
        (&["time.duration=60"], "does not repeat, and the run needs"),
        (
            &["flow.refinement=[{ height_diameters = 1.9, downstream_diameters = 0.5 }]"],
            "3 cells before its sides",
        ),
    ] {
        let lines = at(overrides);
        assert!(lines.contains(expected), "{overrides:?}: {lines}");
    }
    let layer = PrecursorFolder::new(&folder.path().join("layer"));
    let whole = fs::read(layer.temperature_path()).expect("a file");
    fs::write(layer.temperature_path(), &whole[..whole.len() / 2]).expect("a file");
    assert!(at(&[]).contains("temperature"), "{}", at(&[]));
    fs::remove_file(layer.temperature_path()).expect("a file");
    assert!(at(&[]).contains("temperature.nc"), "{}", at(&[]));
    let beside = ["wind.precursor_wind=\"beside\""];
    assert!(prepared(folder.path(), &beside).is_ok());
    fs::remove_file(layer.checkpoint_path()).expect("a file");
    assert!(at(&beside).contains("which is gone"), "{}", at(&beside));
    fs::remove_file(layer.result_path()).expect("a file");
    assert!(at(&[]).contains("it is not complete"), "{}", at(&[]));
}
