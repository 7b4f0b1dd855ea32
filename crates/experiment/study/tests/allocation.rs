//! A step of a flexible turbine under control takes no memory from the system once it has run warm.
//!
//! The farm's own promise; it stands here because the published turbine comes from a file.

mod small;

use basis::{Commands, Truth};
use farm::assemble;
use farm::{Air, Farm, Recorder};
use small::{laid_out, uniform_air};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

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
