//! A step of a flexible turbine under control takes no memory from the system once it has run warm.
//!
//! The farm's own promise; it stands here because the published turbine comes from a file.

mod small;

use basis::scan::{Scan, ScanBlocks};
use basis::{Commands, Measurements, Reading, Truth};
use control::{Controller, LinearLaw, LinearLaws};
use farm::assemble;
use farm::{Air, Farm, Recorder};
use lti::Recursion;
use small::{laid_out, uniform_air};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;

const CASE: &str = r#"
name = "allocation"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.05
[time]
spin_up = 1.0
duration = 120.0
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

/// Steps until all that is made once is made, and the helix, which fades in over a period of 107 s, is whole
/// (–).
const N_WARM: usize = 2200;
/// Steps that are monitored (–).
const N_WATCHED: usize = 100;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, with a count by thread.
struct Counting;

fn count() {
    COUNT.with(|count| count.set(count.get() + 1));
}

// SAFETY: every call goes to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promises are passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promises are passed on.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller's promises are passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Keeps the pitch of blade 1 alone.
struct Last(f64);

impl Recorder for Last {
    fn record(&mut self, _turbine: usize, _truth: &Truth, commands: &Commands) {
        self.0 = commands.pitch[0];
    }
}

/// The flexible turbine of run number `run`, alone in wind that is the same everywhere, on the thread that
/// asks.
fn farm_of(run: usize) -> Farm<Air> {
    let (case, plan, model) = laid_out(CASE, &[], "iea-15mw");
    let air = uniform_air(&case);
    assemble::farm(&case, &case.runs[run], &plan, &[model], air).expect("such a farm can be")
}

/// Allocations of the monitored steps of run number `run` (–), and how far the pitch of blade 1 moved
/// meanwhile (rad).
fn allocations(run: usize) -> (usize, f64) {
    let mut farm = farm_of(run);
    let mut last = Last(0.0);
    for _ in 0..N_WARM {
        farm.advance(&mut last).expect("prescribed wind blows on");
    }
    let (before, mut travel, mut pitch) = (COUNT.with(Cell::get), 0.0, last.0);
    for _ in 0..N_WATCHED {
        farm.advance(&mut last).expect("prescribed wind blows on");
        travel += (last.0 - pitch).abs();
        pitch = last.0;
    }
    (COUNT.with(Cell::get) - before, travel)
}

#[test]
fn the_count_sees_what_is_allocated() {
    let before = COUNT.with(Cell::get);
    let mut list = std::hint::black_box(vec![0_u8; 64]);
    list.reserve(1000);
    // Once to have it, once for more.
    assert_eq!(COUNT.with(Cell::get) - before, 2, "{} bytes", list.capacity());
}

#[test]
fn a_step_under_the_baseline_allocates_nothing() {
    assert_eq!(allocations(0).0, 0);
}

#[test]
fn a_step_under_the_helix_allocates_nothing() {
    let (n_allocations, travel) = allocations(1);
    assert_eq!(n_allocations, 0);
    // Half a turn of the rotor in five seconds: the helix is at work.
    assert!(travel > 1f64.to_radians(), "{travel} rad");
}

/// Controllers that see through lidars.
const LIDARS: &str = r#"
name = "lidars"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
step = 0.1
[time]
spin_up = 1.0
duration = 300.0
[[turbine]]
name = "T1"
model = "iea-15mw"
position_diameters = [0.0, 0.0]
sensors.anemometer = { kind = "anemometer" }
sensors.lidar = { kind = "lidar" }
sensors.eye = { kind = "lidar", looks = "upwind", downwind = 5.0, above = 5.0, focal_distance_diameters = 2.5 }
[[run]]
name = "loop"
control.T1 = { kind = "lidar-loop", sense = "ccw", amplitude_deg = 3.0, strouhal = 0.3, reference_tilt = 2.0, reference_yaw = 13.0, least_trust = 0.0, controller = [{ wind_speed = 8.0, file = "a.json" }, { wind_speed = 10.0, file = "b.json" }] }
[[run]]
name = "preview"
control.T1 = { kind = "phase-sync", sense = "ccw", strouhal = 0.3, offset_deg = 0.0, amplitude_deg = 0.0, preview = "eye" }
"#;

/// What runs on the turbine in run number `run` of [`LIDARS`].
fn seeing(run: usize) -> Box<dyn Controller> {
    let (case, plan, model) = laid_out(LIDARS, &[], "iea-15mw");
    let diagonal = |value: f64| vec![vec![value, 0.0], vec![0.0, value]];
    let law = |gain: f64| LinearLaw {
        file: String::new(),
        recursion: Recursion::new(&diagonal(1.0), &diagonal(gain), &diagonal(1.0), &diagonal(0.0))
            .with_back_calculation(&diagonal(1.0)),
    };
    let mut control = case.runs[run].control[0].clone();
    let laws = vec![law(1e-3), law(2e-3)];
    control.linear_laws = Some(Arc::new(LinearLaws { laws, interval: 0.2, reference: None }));
    assemble::controller(&control, &model, &case, &plan).expect("such a controller can be")
}

/// On return `reading` is the scan of a jet that turns, a diameter downwind where `along` is 1, or two and a
/// half upwind; some beams are lost.
fn scan(step: usize, along: f64, reading: &mut [f64]) {
    let mut blocks = ScanBlocks::of(reading).expect("81 points");
    let time = 0.1 * step as f64;
    let angle = std::f64::consts::TAU * 0.3 * 9.0 / 240.0 * time;
    blocks.head[0] = step as f64;
    for point in 0..81 {
        let place = |index: usize| 26.0 * (index as f64 - 4.0);
        let (left, up) = (place(point % 9), place(point / 9));
        let from_jet = (left - 20.0 * angle.sin()).hypot(up - 20.0 * angle.cos());
        let speed = 6.0 + 2.0 * (-0.5 * (from_jet / 30.0).powi(2)).exp();
        let is_lost = (point + step).is_multiple_of(7);
        blocks.speeds[point] = if is_lost { f64::NAN } else { along.signum() * speed };
        for (block, place) in blocks.places.iter_mut().zip([240.0 * along, left, up]) {
            block[point] = place;
        }
        blocks.times[point] = time;
    }
}

/// Allocations of updates of `controller` (–), blind at first and then with sight, after which its `signal`
/// is 1; some of the instants are its last ones.
fn allocations_of(controller: &mut dyn Controller, signal: &str) -> usize {
    let signals = controller.signals();
    let index = signals.iter().position(|channel| channel.name == signal).expect("it tells it");
    let mut shown = vec![0.0; signals.len()];
    let mut n_allocations = 0;
    let reading = |sensor: &str, values: Vec<f64>| Reading { sensor: sensor.to_owned(), values };
    let blank = || vec![f64::NAN; Scan::n_values(81)];
    let mut readings = vec![
        reading("anemometer", vec![9.0, 0.0]),
        reading("lidar", blank()),
        reading("eye", blank()),
    ];
    for step in 0..2500 {
        if step > 200 {
            scan(step, 1.0, &mut readings[1].values);
            scan(step, -2.5, &mut readings[2].values);
        }
        readings[0].values[0] = 8.0 + 1e-3 * step as f64;
        let (time, interval) = (0.1 * step as f64, 0.1);
        let measured = Measurements {
            time,
            interval,
            rotor_speed: 0.7,
            azimuth: (0.7 * time).rem_euclid(std::f64::consts::TAU),
            readings: &readings,
            ..Measurements::at_rest(3)
        };
        let before = COUNT.with(Cell::get);
        controller.update(&measured);
        controller.write_signals(&mut shown);
        let taken = COUNT.with(Cell::get) - before;
        n_allocations += if step > 100 { taken } else { 0 };
    }
    assert_eq!(shown[index], 1.0, "{signal}");
    n_allocations
}

#[test]
fn a_lidar_loop_with_a_family_of_laws_allocates_nothing_open_or_closed() {
    assert_eq!(allocations_of(&mut *seeing(0), "LoopShare"), 0);
}

#[test]
fn a_preview_allocates_nothing_blind_or_with_sight() {
    assert_eq!(allocations_of(&mut *seeing(1), "PreviewShare"), 0);
}
