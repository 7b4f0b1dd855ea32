//! Averages by phase of a run: its instants sorted by hand, and the same bits after a break.

mod small;

use analysis::phases::helix_azimuth;
use basis::mbc::to_fixed_frame;
use basis::records::{PhaseAverages, Plane};
use basis::{FixedFrame, PerBlade};
use formats::netcdf::read_planes;
use formats::records::{StoredPhaseAverages, read_series};
use small::{HALFWAY, STOP, written};
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;
use std::sync::atomic::Ordering;
use study::{Outcome, Outputs, Silent, StudyOptions};

/// Step of the lattice (s), and so the time between instants.
const STEP: f64 = 0.1;

/// A turbine with a helix on few cells; its plane at hub height is kept at every step, and averaged by phase.
fn case() -> String {
    let further = "further.wake = { kind = \"phase-averages\", height_diameters = [0.0], \
        x_diameters = [0.5, 1.5], y_diameters = [-0.7, 0.7], helix_cycles = 2, helix_width_deg = 90, interval = 0.1 }\n\
        further.rotor = { kind = \"phase-averages\", volume_stride = 2, helix_cycles = 0, azimuth_bins = 6 }\n";
    format!(
        "name = \"phases\"\n[wind]\nspeed = 9.0\nturbulence_intensity = 0.0\n[flow]\ncells_per_diameter = 8\n\
         upstream_diameters = 1.5\ndownstream_diameters = 2\nwidth_diameters = 3\nheight_diameters = 2\nstep = {STEP}\n\
         [time]\nspin_up = 10.0\nduration = 60.0\n\
         [[turbine]]\nname = \"T1\"\nmodel = \"nrel-5mw\"\nposition_diameters = [0.0, 0.0]\nstructure = \"rigid\"\n\
         [[run]]\nname = \"helix\"\n\
         control.T1 = {{ kind = \"helix\", sense = \"ccw\", amplitude_deg = 3.0, strouhal = 0.7 }}\n\
         [output]\nplane_interval = {STEP}\n{further}"
    )
}

fn options(folder: &Path, output: &str) -> StudyOptions {
    StudyOptions { output: Some(folder.join(output)), ..small::options(folder) }
}

fn run(options: &StudyOptions, outputs: &Outputs) -> Outcome {
    STOP.store(false, Ordering::Relaxed);
    study::run_with(options, outputs, &STOP, &mut Silent).expect("a study")
}

/// Rotor and helix azimuth (rad) at the end of each step, from the series in `run`.
fn azimuths(run: &Path) -> Vec<(f64, f64, f64)> {
    let series = read_series(&run.join("series.csv"), |_| true).expect("a series");
    let column = |name: &str| series.column(name).expect(name);
    let (time, azimuth) = (column("Time"), column("T1.Azimuth"));
    let pitch = [1, 2, 3].map(|blade| column(&format!("T1.BldPitch{blade}")));
    let one = |row: usize| {
        let blades = PerBlade::from_fn(3, |blade| pitch[blade][row]);
        let FixedFrame { tilt, yaw, .. } = to_fixed_frame(azimuth[row], &blades);
        (time[row], azimuth[row], helix_azimuth(tilt, yaw))
    };
    (0..time.len()).map(one).collect()
}

/// The helix azimuth `middle` of a bin, and one of an instant, no more than half of `width` apart (rad).
fn is_near(helix: f64, middle: f64, width: f64) -> bool {
    let away = (helix - middle + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
    away.abs() < 0.5 * width
}

/// Total pressure upstream of the rotor is that of the wind; the pressure alone rises towards it.
fn check_heads_upstream(volume: &PhaseAverages) {
    const DIAMETER: f64 = 125.88;
    let pressure = volume.pressure.as_ref().expect("the lattice knows its pressure");
    let at = |x: f64| {
        let step = |axis: usize, place: f64| {
            ((place - volume.grid.origin[axis]) / volume.grid.spacing[axis]).round() as usize
        };
        let index = volume.grid.index([step(0, x), step(1, 0.0), step(2, 90.0)]);
        let squares = |[u, v, w]: [f32; 3]| 0.5 * f64::from(u * u + v * v + w * w);
        let speed = volume.all.mean.each_ref().map(|values| values[index]);
        (f64::from(pressure[index]), squares(speed))
    };
    let [far, near] = [-1.2, -0.4].map(|x| at(x * DIAMETER));
    assert!(near.0 > far.0 + 1.0 && near.0 > 0.0, "{far:?} {near:?}");
    let heads = [far, near].map(|(pressure, half_square)| pressure + half_square);
    assert!((heads[1] / heads[0] - 1.0).abs() < 0.02, "{heads:?}");
}

#[test]
fn instants_sorted_by_hand_have_the_same_means_and_a_break_changes_no_bit() {
    let folder = written(&case());
    let outputs = Outputs::standard();
    assert!(matches!(run(&options(folder.path(), "whole"), &outputs), Outcome::Done { .. }));
    let whole = folder.path().join("whole/helix");

    let file = "averages-wake-0D-above.nc";
    let stored = StoredPhaseAverages::open(&whole.join(file)).expect("averages");
    let averages = stored.averages().expect("all bins");
    let planes = read_planes(&whole.join("planes/hub-height.nc")).expect("planes");
    let azimuths = azimuths(&whole);
    let n_taken: u64 = averages.all.n_samples.iter().map(|n| u64::from(*n)).max().unwrap_or(0);
    assert_eq!(n_taken, planes.len() as u64);
    let point = averages.grid.len() / 2;
    let position = averages.grid.position(averages.grid.place(point));
    let value = |plane: &Plane| {
        let step = |axis: usize| {
            ((position[axis] - plane.origin[axis]) / plane.spacing[axis]).round() as usize
        };
        f64::from(plane.velocity[0][step(0) + plane.n_points[0] * step(1)])
    };
    let mut n_compared = 0;
    for (bin, moments) in averages.bins.iter().zip(&averages.each) {
        let middle = bin.helix.expect("a helix");
        let of_bin = planes.iter().filter(|plane| {
            // A row of the series is of the begin of a step, a plane of its end.
            let row = azimuths.iter().find(|row| (row.0 - plane.time).abs() < 0.5 * STEP);
            row.is_some_and(|&(_, rotor, helix)| {
                let away = (rotor - bin.rotor + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
                away.abs() < 0.5 * averages.rotor_width
                    && is_near(helix, middle, averages.helix_width.expect("a width"))
            })
        });
        let values: Vec<f64> = of_bin.map(value).collect();
        if values.len() < 2 || values.len() as u64 != bin.n_instants {
            continue;
        }
        n_compared += 1;
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        assert!((f64::from(moments.mean[0][point]) - mean).abs() < 1e-4 * mean, "{bin:?}");
        let variance =
            values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
        let found = f64::from(moments.stress[0][point]);
        assert!((found - variance).abs() < 1e-3 * variance + 1e-7, "{found} {variance}");
    }
    // But for the last instant, of which no row tells, and azimuths that lie on an edge.
    assert!(n_compared > averages.bins.len() * 8 / 10, "{n_compared} of {}", averages.bins.len());
    let volume = StoredPhaseAverages::open(&whole.join("averages-rotor-volume.nc")).expect("it");
    let n: u64 = volume.head.bins.iter().map(|bin| bin.n_instants).sum();
    assert_eq!((volume.head.bins.len(), n), (6, u64::from(volume.head.all.n_samples[0])));
    assert!(averages.pressure.is_none(), "budgets are of volumes");
    check_heads_upstream(&volume.head);

    let mut stopped = options(folder.path(), "stopped");
    let outcome = run(&stopped, &outputs.clone().with(&HALFWAY));
    assert!(matches!(outcome, Outcome::Interrupted { .. }), "{outcome:?}");
    stopped.resume = true;
    assert!(matches!(run(&stopped, &outputs), Outcome::Done { .. }));
    for file in [file, "averages-rotor-volume.nc"] {
        let other = fs::read(folder.path().join("stopped/helix").join(file)).expect(file);
        assert!(fs::read(whole.join(file)).expect(file) == other, "{file} has other bits");
    }
}

/// What `formats`' own tests ask of every case whose outputs they know.
#[test]
fn shipped_cases_that_ask_for_averages_read_and_read_back() {
    study::outputs::announce();
    let mut n_read = 0;
    for shipped in formats::shipped::CASES {
        if !shipped.text().contains("kind = \"phase-averages\"") {
            continue;
        }
        for case in shipped.cases().expect("a case") {
            let again = formats::case::parse("again", &formats::case::write(&case), &[]);
            assert_eq!(again.expect("what was written"), case, "{}", shipped.name);
            assert!(case.description.is_some_and(|words| words.len() > 20), "{}", shipped.name);
            n_read += 1;
        }
    }
    assert!(n_read > 0);
}
