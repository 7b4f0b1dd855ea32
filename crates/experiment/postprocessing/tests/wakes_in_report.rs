//! Wakes taken apart in the report of a study: what runs kept is there, runs beside each other; what they did
//! not keep is not; what cannot be read is told.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use analysis::phases::{Bins, PhaseAverager};
use basis::Sense;
use basis::records::{FieldSetting, Grid, Plane, PlaneAxes};
use formats::records::{InstantWriter, PlacedTurbine, PlaneSetting, write_phase_averages};
use miette::Diagnostic;
use postprocessing::analyses::{ANALYSES, Request};
use small::{NREL_5MW, behind_helix, case, done, options, written};
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const DIAMETER: f64 = 126.0;
const WIND: f64 = 9.0;
const HUB: [f64; 3] = [0.0, 0.0, 90.0];
const ROTOR_HZ: f64 = 0.18;
/// Revolutions a cycle of the helix.
const RATIO: f64 = 5.0;
/// Where the flux turns (rotor diameters).
const TURN: f64 = 2.0;

/// A study of a baseline and a helix that kept nothing of their wakes, and its folder.
fn study() -> (TempDir, PathBuf) {
    let runs = "[[run]]\nname = \"baseline\"\n".to_owned() + &behind_helix("helix", &[]);
    let folder = written(&case("wakes", "", [10.0, 40.0], &[NREL_5MW], &runs));
    let output = done(&options(folder.path()));
    (folder, output)
}

/// The page of the study in `output`, slashes as they are seen.
fn page(output: &Path) -> String {
    let path = postprocessing::report(output).expect("a report").page;
    fs::read_to_string(path).expect("the page").replace("&#x2f;", "/")
}

/// u and w at `place` (m) and `time` (s): waves of the helix that carry energy out of the wake up to
/// [`TURN`], and into it from there.
fn wake([x, _, z]: [f64; 3], time: f64) -> [f32; 3] {
    let wave = (TAU * ROTOR_HZ / RATIO * time - 2.0 * x / DIAMETER).cos();
    let above = z - HUB[2];
    let slow = 3.0 * (-(above / (0.5 * DIAMETER)).powi(4)).exp();
    let up = -0.5 * (x / DIAMETER - TURN) * wave * above.signum();
    [(WIND - slow + 0.4 * wave) as f32, 0.0, up as f32]
}

/// Averages of [`wake`] on `grid` as `run` would have kept them under `field`, by rotor alone or with a
/// helix; no instant falls into the first bin of rotor azimuth of those by rotor alone.
fn keep(output: &Path, run: &str, field: &str, grid: Grid) -> PathBuf {
    let has_helix = run == "helix";
    let bins = match has_helix {
        true => Bins::of_helix(12, RATIO, 1, Sense::CounterClockwise, 40_f64.to_radians()),
        false => Bins::of_rotor(12),
    };
    let mut averager = PhaseAverager::new(grid, bins.expect("bins"));
    for step in 0..600 {
        let time = 10.0 + 0.37 * f64::from(step);
        let rotor = TAU * (ROTOR_HZ * time).fract();
        let helix = has_helix.then(|| TAU * (ROTOR_HZ / RATIO * time).fract());
        if !has_helix && rotor < TAU / 12.0 {
            continue;
        }
        let values: Vec<[f32; 3]> =
            (0..grid.len()).map(|point| wake(grid.position(grid.place(point)), time)).collect();
        let velocity: [Vec<f32>; 3] =
            std::array::from_fn(|axis| values.iter().map(|value| value[axis]).collect());
        averager.add(time, rotor, helix, velocity.each_ref().map(Vec::as_slice)).expect("it");
    }
    let setting = FieldSetting {
        name: format!("wakes, {run}"),
        wind_speed: WIND,
        turbulence_intensity: Some(0.05),
        diameter: DIAMETER,
        hub: HUB,
    };
    let path = output.join(run).join(format!("averages-{field}.nc"));
    write_phase_averages(&path, &setting, &averager.head(), |index| averager.bin(index)).unwrap();
    path
}

/// A plane along the wind through the hub.
fn along() -> Grid {
    let spacing = [0.1 * DIAMETER; 3];
    Grid { origin: [0.5 * DIAMETER, 0.0, HUB[2] - DIAMETER], spacing, n_points: [31, 1, 21] }
}

/// A plane across the wind at `x` (rotor diameters).
fn across(x: f64) -> Grid {
    let spacing = [0.1 * DIAMETER; 3];
    let origin = [x * DIAMETER, -0.6 * DIAMETER, HUB[2] - 0.6 * DIAMETER];
    Grid { origin, spacing, n_points: [1, 13, 13] }
}

/// The figure called `name` on `page`.
fn figure<'p>(page: &'p str, name: &str) -> &'p str {
    let start = page.find(&format!("<figure id=\"{name}\">"));
    let start = start.unwrap_or_else(|| panic!("no figure {name}"));
    let end = page[start..].find("</figure>").expect("its end");
    &page[start..start + end]
}

#[test]
fn averages_by_phase_are_on_the_page_with_their_samples_runs_beside_each_other() {
    let (_folder, output) = study();
    let bare = page(&output);
    for absent in ["The wake by phase", "Energy that enters", "Modes of", "Budget of"] {
        assert!(!bare.contains(absent), "{absent}");
    }
    for run in ["baseline", "helix"] {
        keep(&output, run, "wake-0D-beside", along());
        for x in [1.0, 2.0] {
            keep(&output, run, &format!("discs-{x}D"), across(x));
        }
    }
    let page = page(&output);
    let samples = figure(&page, "phases-samples-discs-wake");
    assert!(samples.contains("1 of 12 bins are empty and count in no average: 0"), "{samples}");
    assert!(samples.contains("60 bins of ") && samples.contains("no bin is empty"), "{samples}");
    for run in ["baseline", "helix"] {
        for name in ["phases-velocity", "entrainment-flux"] {
            let map = figure(&page, &format!("{name}-wake-0D-beside-{run}"));
            let conditions =
                format!("wakes, {run}: 9.00 m/s, turbulence intensity 5.0 %, rotor of 126.00 m");
            assert!(map.contains(&conditions) && map.contains(" instants, "), "{name} of {run}");
        }
    }
    // Before the place the periodic flux leaves, and behind it it enters; by rotor alone nothing is periodic.
    let flux = figure(&page, "entrainment-flux-over-distance-wake-0D-beside");
    let turns =
        "upper: baseline at 2.00 D, helix at 2.00 D; lower: baseline at 2.00 D, helix at 2.00 D";
    assert!(flux.contains(turns), "{flux}");
    let power = figure(&page, "available-power-over-distance-discs");
    for run in ["baseline", "helix"] {
        assert!(power.contains(&format!(">{run}<")) && flux.contains(&format!(">{run}<")));
        assert!(power.contains(&format!("wakes, {run}: 9.00 m/s")));
    }
    assert!(output.join("figures/phases-velocity-wake-0D-beside-helix.png").is_file());
}

#[test]
fn surfaces_of_volumes_are_on_the_page() {
    let (_folder, output) = study();
    let spacing = [0.15 * DIAMETER; 3];
    let origin = [0.5 * DIAMETER, -0.45 * DIAMETER, HUB[2] - 0.9 * DIAMETER];
    let grid = Grid { origin, spacing, n_points: [15, 7, 13] };
    keep(&output, "helix", "box-volume", grid);
    let page = page(&output);
    let surfaces = figure(&page, "vortices-surfaces-box-volume-helix");
    let title = "Where turning outweighs straining: helix, box-volume";
    assert!(surfaces.contains(title) && surfaces.contains("Isosurfaces of Q"), "{surfaces}");

    let run = output.join("helix");
    let files = output.join("surfaces");
    let ask = |field: &str, level: &str| {
        let analysis = ANALYSES.iter().find(|one| one.name == "vortices").expect("it is listed");
        let request = Request::of(&run).with("field", field).with("level", level);
        (analysis.run)(&request.with("surfaces", &files.display().to_string()))
    };
    let told = |field: &str, level: &str| {
        let error = ask(field, level).expect_err("nothing is there");
        format!("{error}; {}", error.help().expect("a fix"))
    };
    // Names that would do are told; no files without triangles are written.
    let refusal = told("box", "0.1");
    assert!(refusal.contains("keeps nothing called `box`"), "{refusal}");
    assert!(refusal.ends_with("with --field: box-volume"), "{refusal}");
    let refusal = told("box-volume", "1e6");
    assert!(refusal.contains("no place where Q is more than 1000000 (U/D)²"), "{refusal}");
    assert!(refusal.contains("the greatest is ") && !files.exists(), "{refusal}");
    ask("box-volume", "0.1").expect("surfaces");
    assert!(files.join("q-000.vtp").is_file());
}

#[test]
fn files_that_are_damaged_or_foreign_are_told_and_withhold_nothing_else() {
    let (_folder, output) = study();
    let short = keep(&output, "helix", "wake-0D-beside", along());
    let bytes = fs::read(&short).expect("a file");
    fs::write(&short, &bytes[..bytes.len() / 2]).expect("half of it");
    keep(&output, "baseline", "wake-0D-beside", along());
    fs::write(output.join("helix/averages-notes.nc"), "not a field at all").expect("a file");
    let page = page(&output);
    for file in ["helix/averages-wake-0D-beside.nc", "helix/averages-notes.nc"] {
        assert!(page.contains(&format!("<li>{file} ")), "{file}");
    }
    figure(&page, "phases-velocity-wake-0D-beside-baseline");
    figure(&page, "entrainment-flux-over-distance-wake-0D-beside");
}

/// `n` instants of [`wake`] in the plane along the wind that `run` would have kept, every so many points.
fn keep_instants(output: &Path, run: &str, n: u32, stride: usize) {
    let turbine =
        PlacedTurbine { name: "T1".into(), hub: HUB, rotor_diameter: DIAMETER, is_there: true };
    let setting = PlaneSetting {
        case: "wakes".into(),
        run: run.into(),
        wind_speed: WIND,
        wind_direction_deg: 270.0,
        turbulence_intensity: 0.05,
        air_density: 1.2,
        turbines: vec![turbine],
    };
    let mut grid = along();
    grid.spacing = grid.spacing.map(|spacing| spacing * stride as f64);
    grid.n_points = [grid.n_points[0].div_ceil(stride), 1, grid.n_points[2].div_ceil(stride)];
    let plane = |time: f64| {
        let values: Vec<[f32; 3]> =
            (0..grid.len()).map(|point| wake(grid.position(grid.place(point)), time)).collect();
        Plane {
            name: "streamwise".into(),
            axes: PlaneAxes::Streamwise,
            origin: grid.origin,
            spacing: [grid.spacing[0], grid.spacing[2]],
            n_points: [grid.n_points[0], grid.n_points[2]],
            time,
            averaged: 0.0,
            velocity: std::array::from_fn(|axis| values.iter().map(|v| v[axis]).collect()),
        }
    };
    let path = output.join(run).join("planes/streamwise.nc");
    let first = 10.0;
    let interval = 30.0 / f64::from(n);
    let mut writer = InstantWriter::create(&path, &setting, &plane(first)).expect("a file");
    for step in 0..n {
        writer.write(&plane(first + interval * f64::from(step))).expect("room");
    }
    writer.finish().expect("an end");
}

#[test]
fn planes_at_instants_have_modes_and_too_many_the_command_that_finds_them() {
    let (_folder, output) = study();
    keep_instants(&output, "helix", 120, 2);
    keep_instants(&output, "baseline", 1000, 15);
    let page = page(&output);
    for name in ["modes-energy-helix", "modes-shapes-helix", "modes-pod-helix"] {
        let figure = figure(&page, name);
        assert!(figure.contains("120 instants from 10") && figure.contains("9.00 m/s"), "{name}");
    }
    assert!(figure(&page, "modes-energy-helix").contains("f_e"));
    let told = "wakemix analyse modes baseline --field streamwise --figures pictures";
    assert!(page.contains(told) && !page.contains("modes-energy-baseline"));
}

/// u and w at `place` (m) at the azimuth `rotor` (rad): a row of vortices above the hub, shed by one blade
/// after the other, that go with the wind.
fn tip_vortices([x, _, z]: [f64; 3], rotor: f64) -> [f32; 3] {
    let apart = WIND / ROTOR_HZ / 3.0;
    let (core, circulation) = (0.04 * DIAMETER, 0.05 * WIND * DIAMETER);
    let (mut u, mut w) = (WIND, 0.0);
    for number in 0..12 {
        let away =
            [x - apart * (3.0 * rotor / TAU + f64::from(number)), z - HUB[2] - 0.5 * DIAMETER];
        let square = away[0].powi(2) + away[1].powi(2);
        let turn = circulation / TAU * -(-square / core.powi(2)).exp_m1() / square.max(1e-9);
        u += turn * away[1];
        w -= turn * away[0];
    }
    [u as f32, 0.0, w as f32]
}

#[test]
fn vortices_that_were_followed_have_their_strength_on_the_page() {
    let (_folder, output) = study();
    let spacing = [0.015 * DIAMETER; 3];
    let origin = [0.1 * DIAMETER, 0.0, HUB[2] + 0.2 * DIAMETER];
    let grid = Grid { origin, spacing, n_points: [100, 1, 40] };
    let mut averager = PhaseAverager::new(grid, Bins::of_rotor(12).expect("bins"));
    for step in 0..24_u32 {
        let rotor = TAU * f64::from(step % 12) / 12.0;
        let values: Vec<[f32; 3]> = (0..grid.len())
            .map(|point| tip_vortices(grid.position(grid.place(point)), rotor))
            .collect();
        let velocity: [Vec<f32>; 3] =
            std::array::from_fn(|axis| values.iter().map(|value| value[axis]).collect());
        let time = 10.0 + f64::from(step);
        averager.add(time, rotor, None, velocity.each_ref().map(Vec::as_slice)).expect("it");
    }
    let setting = FieldSetting {
        name: "wakes, baseline".into(),
        wind_speed: WIND,
        turbulence_intensity: None,
        diameter: DIAMETER,
        hub: HUB,
    };
    let path = output.join("baseline/averages-wake-0D-beside.nc");
    write_phase_averages(&path, &setting, &averager.head(), |index| averager.bin(index)).unwrap();
    let page = page(&output);
    let strength = figure(&page, "vortices-strength-over-distance-wake-0D-beside-baseline");
    for expected in ["How strong vortices are: baseline", "blade 1 in turn", "blade 3 in turn"] {
        assert!(strength.contains(expected), "{expected}: {strength}");
    }
    // In a row none passes another.
    assert!(!page.contains("leapfrogging-over-helix-azimuth"));
}
