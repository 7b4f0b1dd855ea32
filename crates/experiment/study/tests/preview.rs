//! A turbine that sees the helix ahead through its own lidar: a shear that turns, carried by the wind towards
//! it, in a study from case file to series.

mod small;

use basis::PointForce;
use basis::Vector3;
use basis::angle::wrap_to_half_turn;
use farm::FarmFlow;
use farm::solvers::{PRESCRIBED, SOLVERS, SolverKind, Start};
use flow::{FlowError, FlowSolver, WindField};
use small::{case, done, options, written};
use std::f64::consts::TAU;
use std::fs;
use std::io::{Read, Result, Write};
use std::path::Path;
use std::sync::LazyLock;

const SPEED: f64 = 9.0;
/// Radius of the NREL 5 MW's swept disc (m), which precone makes a little less than its name says.
static RADIUS: LazyLock<f64> = LazyLock::new(|| {
    let library = formats::library::load("nrel-5mw").expect("a turbine of the library");
    library.definition.rotor_radius()
});

/// St 0.25 (rad/s).
fn rate() -> f64 {
    TAU * 0.25 * SPEED / (2.0 * *RADIUS)
}

/// Period of the helix (s).
fn period() -> f64 {
    TAU / rate()
}

/// Tilt and yaw (m/s) at half the radius.
const AMPLITUDE: f64 = 0.8;

/// Phase of the wave (rad) that is at the rotor at `time` (s): it swings within four periods.
fn phase(time: f64) -> f64 {
    1.0 + 0.5 * (TAU * time / (4.0 * period())).sin()
}

/// The wind's slopes, frozen and carried along.
static CARRIED: SolverKind = SolverKind {
    name: "carried",
    about: "a shear that turns, carried by the wind",
    begin: |start: Start| {
        let foot = start.site.plan.positions[0];
        let rotor = &start.site.models[0].definition.rotor;
        // The rotor's centre stands before the tower.
        let ahead = rotor.overhang * rotor.shaft_tilt.cos();
        let hub = foot + Vector3::new(-ahead, 0.0, rotor.hub_height);
        Ok(Box::new(Carried { hub, time: 0.0 }))
    },
    ..PRESCRIBED
};

struct Carried {
    hub: Vector3,
    time: f64,
}

impl WindField for Carried {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            let from = *position - self.hub;
            let arrival = self.time - from.x / SPEED;
            let angle = rate() * arrival + phase(arrival);
            // Counter-clockwise: yaw leads tilt by a quarter.
            let [tilt, yaw] = [angle.sin(), angle.cos()];
            let slopes = 2.0 * AMPLITUDE / *RADIUS * (tilt * from.z - yaw * from.y);
            *velocity = Vector3::X * (SPEED + slopes);
        }
    }
}

impl FlowSolver for Carried {
    fn advance(&mut self, duration: f64, _: &[PointForce]) -> std::result::Result<(), FlowError> {
        self.time += duration;
        Ok(())
    }

    fn resolves_induction(&self) -> bool {
        false
    }
}

impl FarmFlow for Carried {
    fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        writer.write_all(&self.time.to_le_bytes())
    }

    fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let mut bytes = [0; 8];
        reader.read_exact(&mut bytes)?;
        self.time = f64::from_le_bytes(bytes);
        Ok(())
    }
}

/// Columns of the series of a run in `out`.
fn columns<const N: usize>(out: &Path, run: &str, names: [&str; N]) -> [Vec<f64>; N] {
    let text = fs::read_to_string(out.join(run).join("series.csv")).expect("a series");
    let mut rows = text.lines();
    let heading: Vec<&str> = rows.next().expect("a heading").split(',').collect();
    let places = names.map(|name| {
        heading.iter().position(|found| *found == name).unwrap_or_else(|| panic!("{name}"))
    });
    let rows: Vec<Vec<f64>> = rows
        .map(|row| row.split(',').map(|value| value.parse().expect("a number")).collect())
        .collect();
    places.map(|place| rows.iter().map(|row| row[place]).collect())
}

/// Root mean square (deg), mean (deg) and lag (s) of the phase errors of tilt and yaw in `run`, of the time
/// after `from` (s).
fn errors(out: &Path, run: &str, from: f64) -> [[f64; 3]; 2] {
    let names = ["Time_s", "T1.EstWindTiltPhase_deg", "T1.EstWindYawPhase_deg"];
    let [times, tilt, yaw] = columns(out, run, names);
    [tilt, yaw].map(|found| {
        let (mut n, mut sum, mut squares, mut along, mut slopes) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (time, found) in times.iter().zip(found).filter(|(time, _)| **time > from) {
            let error = wrap_to_half_turn(found.to_radians() - phase(*time));
            let slope = (phase(time + 0.1) - phase(time - 0.1)) / 0.2;
            n += 1.0;
            sum += error;
            squares += error * error;
            along -= error * slope;
            slopes += slope * slope;
        }
        [(squares / n).sqrt().to_degrees(), (sum / n).to_degrees(), along / slopes]
    })
}

#[test]
fn a_preview_has_the_phase_of_the_wind_and_of_the_loads() {
    SOLVERS.add(&CARRIED).expect("no kind is called so yet");
    let machine = "model = \"nrel-5mw\"
sensors.Eye = { kind = \"lidar\", looks = \"upwind\", downwind = 5.0, above = 4.0, focal_distance_diameters = 2.5, rate_hz = 5, n_points = 32, noise = 0.3, dropout = 0.1 }";
    let control = |more: &str| {
        format!(
            "control.T1 = {{ kind = \"phase-sync\", sense = \"ccw\", strouhal = 0.25, offset_deg = 0, amplitude_deg = 0.0{more} }}\n"
        )
    };
    let runs = format!(
        "[[run]]\nname = \"loads\"\n{}[[run]]\nname = \"ahead\"\n{}",
        control(""),
        control(", preview = \"Eye\"")
    );
    let times = [5.0 * period(), 13.0 * period()];
    let text = case("preview", "", times, &[machine], &runs).replace("\"uniform\"", "\"carried\"");
    let folder = written(&text);
    done(&options(folder.path()));
    let out = folder.path().join("out");
    let [loads, ahead] = ["loads", "ahead"].map(|run| errors(&out, run, times[0]));
    for axis in 0..2 {
        let ([rms_of_loads, bias_of_loads, _], [rms, bias, lag]) = (loads[axis], ahead[axis]);
        // Both mean the same phase: another convention would be off by a quarter turn or more, half of which
        // tells the two apart. The loads follow the swing late, which the preview is there to mend.
        assert!(bias_of_loads.abs() < 45.0, "axis {axis}: {loads:?}");
        assert!(rms < rms_of_loads, "axis {axis}: {ahead:?} {loads:?}");
        // A slot of the window is what the preview can be off by.
        assert!(lag.abs() < period() / 48.0, "axis {axis}: {ahead:?}");
        assert!(bias.abs() < 2.0 && rms < 5.0, "axis {axis}: {ahead:?}");
    }
    let [times_of, share, seen, late] = columns(
        &out,
        "ahead",
        ["Time_s", "T1.PreviewShare_-", "T1.PreviewTime_s", "T1.PreviewLag_s"],
    );
    let distance = 2.5 * 2.0 * *RADIUS - 5.0;
    for row in (0..times_of.len()).filter(|row| times_of[*row] > times[0]) {
        assert_eq!((share[row], late[row]), (1.0, 0.0));
        // 2.5 D but 5 m, and what shear and noise turn the mean by.
        assert!((seen[row] - distance / SPEED).abs() < 0.5, "{} s", seen[row]);
    }
    let summary = fs::read_to_string(out.join("ahead/summary.json")).expect("a summary");
    assert!(summary.contains("\"preview-share\"") && summary.contains("\"preview-time\""));
}
