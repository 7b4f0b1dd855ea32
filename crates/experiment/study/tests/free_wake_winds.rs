//! Free vortices in the wind of files and of Mann's model: it reaches the rotor, carries wakes, and what they
//! leave of it for a rotor behind is recorded.

mod small;

use flow::inflow::TurbulenceBox;
use formats::records::{RunFolder, read_series};
use formats::turbulence_box::{self, StoredBox};
use small::{options, written};
use std::fs;
use std::path::{Path, PathBuf};

/// A turbine and a place behind it where the wind over a rotor is recorded: with the turbine, and without it,
/// when another stands far behind; WIND is to be named.
const CASE: &str = r#"
name = "small"
[wind]
speed = 9.0
turbulence_intensity = 0.1
shear_exponent = 0.0
WIND
[flow]
solver = "vortex"
step = 0.2
near_wake_diameters = 0.1
far_wake_filaments = 4
points_per_diameter = 4
[time]
spin_up = 40.0
duration = 70.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
stall = "steady"
[[turbine]]
name = "T2"
model = "nrel-5mw"
position_diameters = [1.0, 0.0]
structure = "rigid"
stall = "steady"
[[turbine]]
name = "T3"
model = "nrel-5mw"
position_diameters = [4.0, 0.0]
structure = "rigid"
stall = "steady"
[[run]]
name = "free"
control.T1 = { kind = "absent" }
control.T2 = { kind = "absent" }
[[run]]
name = "behind"
control.T2 = { kind = "absent" }
control.T3 = { kind = "absent" }
[output]
inflow_at = ["T2"]
"#;

/// Makes the runs in `wind`, in `folder`.
fn made(folder: &Path, wind: &str) -> PathBuf {
    fs::write(folder.join("case.toml"), CASE.replace("WIND", wind)).expect("a case");
    small::done(&options(folder))
}

/// The wind over T2's rotor in `run`, as it was recorded.
fn recorded(out: &Path, run: &str) -> PathBuf {
    out.join(run).join("inflow-T2.bts")
}

/// Means over time and over the points of a rotor's inner half, and their deviation in time (m/s).
fn middle(path: &Path) -> [f64; 2] {
    let stored = turbulence_box::read(path).expect("a sound box");
    let [n_steps, n_y, n_z] = stored.turbulence.n_points();
    let inner = |n: usize| n / 2 - n / 6..n / 2 + n / 6;
    let mean_at = |step: usize| {
        let mut sum = 0.0;
        for row in inner(n_z) {
            for column in inner(n_y) {
                let point = [step, column, row];
                sum += stored.mean_speeds[row] + f64::from(stored.turbulence.at(0, point));
            }
        }
        sum / (inner(n_y).len() * inner(n_z).len()) as f64
    };
    let means: Vec<f64> = (0..n_steps).map(mean_at).collect();
    [analysis::statistics::mean(&means), analysis::statistics::standard_deviation(&means)]
}

/// Writes a box of wind, gusts of 45 m that swing by 1 m/s about 9 m/s, all across alike.
fn blow(path: &Path) {
    let n_points = [600, 13, 13];
    let across = n_points[1] * n_points[2];
    let gust = |plane: usize| (std::f32::consts::TAU * plane as f32 / 10.0).sin();
    let n = n_points.iter().product::<usize>();
    let along = (0..n).map(|point| gust(point / across)).collect();
    let velocity = [along, vec![0.0; n], vec![0.0; n]];
    let turbulence =
        TurbulenceBox::new(n_points, [4.5, 14.0, 14.0], velocity).expect("a sound box");
    let stored = StoredBox {
        turbulence,
        hub_speed: 9.0,
        hub_height: 90.0,
        lowest_height: 6.0,
        mean_speeds: vec![9.0; 13],
        description: "a trial".to_owned(),
    };
    turbulence_box::write(path, &stored).expect("a file");
}

/// Power of T1 over time (kW).
fn power(out: &Path) -> Vec<f64> {
    let path = RunFolder::new(out, "behind").series_path();
    let series = read_series(&path, |name| name == "T1.GenPwr").expect("a series");
    series.columns[0].clone()
}

#[test]
fn files_of_wind_of_each_format_blow_alike() {
    let made = ["w.bts", "w.wnd", "w.toml"].map(|name| {
        let folder = written("");
        blow(&folder.path().join(name));
        let out = made(folder.path(), &format!("planes = \"{name}\""));
        let [of_file, behind] = ["free", "behind"].map(|run| middle(&recorded(&out, run)));
        // Three diameters before a rotor the wind is half a percent slower than the file's.
        assert!((of_file[0] - 9.0).abs() < 0.1 && (of_file[1] - 0.707).abs() < 0.1, "{of_file:?}");
        // The wake of a rotor at its best takes about half of the wind; gusts go on through it.
        assert!((3.0..7.0).contains(&behind[0]) && behind[1] > 0.3, "{name}: {behind:?}");
        power(&out)
    });
    let [full_field, others @ ..] = made;
    let mean = analysis::statistics::mean(&full_field);
    assert!(analysis::statistics::standard_deviation(&full_field) > 0.05 * mean);
    for other in others {
        // Two of the formats round to sixteen bits, and free vortices take two winds that differ by a
        // rounding ever further apart: instants are held together for the first half, the mean for all.
        for (one, other) in full_field.iter().zip(&other).take(full_field.len() / 2) {
            assert!((one - other).abs() < 2e-3 * mean, "{one} and {other} kW");
        }
        let other = analysis::statistics::mean(&other);
        assert!((other - mean).abs() < 2e-3 * mean, "{other} and {mean} kW on average");
    }
}

#[test]
fn turbulence_of_manns_model_reaches_rotor_and_wake() {
    let found = [1, 2].map(|seed| {
        let folder = written("");
        let out = made(folder.path(), &format!("seed = {seed}"));
        let [of_wind, behind] = ["free", "behind"].map(|run| middle(&recorded(&out, run)));
        assert!((of_wind[0] - 9.0).abs() < 2.0 && of_wind[1] > 0.1, "{of_wind:?}");
        assert!(behind[0] < 0.8 * of_wind[0], "{behind:?} in {of_wind:?}");
        power(&out)
    });
    let [one, other] = found;
    let means = [&one, &other].map(|power| analysis::statistics::mean(power));
    // Another seed is another wind.
    assert!(one.iter().zip(&other).any(|(a, b)| (a - b).abs() > 0.05 * means[0]), "{means:?}");
}
