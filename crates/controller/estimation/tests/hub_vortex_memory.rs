//! Following a hub vortex takes no memory from the system once it has begun.

use basis::scan::{Scan, ScanBlocks};
use basis::{HelixFrame, Sense};
use estimation::hub_vortex::{HubVortexFilter, HubVortexSettings};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

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
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// On return `reading` is a scan of 9 × 9 points with a jet that moves on with `step`.
fn scan(step: usize, reading: &mut [f64]) {
    let blocks = ScanBlocks::of(reading).expect("81 points");
    let angle = 0.1 * step as f64;
    for point in 0..81 {
        let place = |index: usize| 12.0 * (index as f64 - 4.0);
        let (y, z) = (place(point % 9), place(point / 9));
        let from_jet = (y - 10.0 * angle.sin()).hypot(z - 10.0 * angle.cos());
        let is_lost = (point + step).is_multiple_of(7);
        let speed = 6.0 + 2.0 * (-0.5 * (from_jet / 12.0).powi(2)).exp();
        blocks.speeds[point] = if is_lost { f64::NAN } else { speed };
        for (block, place) in [126.0, y, z].into_iter().enumerate() {
            blocks.places[block][point] = place;
        }
        blocks.times[point] = 0.1 * step as f64;
    }
}

#[test]
fn an_instant_takes_no_memory() {
    let frame = HelixFrame { sense: Sense::CounterClockwise, rate: 0.15 };
    for settings in [
        HubVortexSettings::of_source(frame, 63.0, 0.1),
        HubVortexSettings::robust(frame, 63.0, 0.1),
        HubVortexSettings::centroid(frame, 63.0, 0.1),
    ] {
        let mut filter = HubVortexFilter::new(settings, 81).expect("such a filter can be");
        let mut reading = vec![0.0; Scan::n_values(81)];
        let mut n_found = 0;
        let before = COUNT.with(Cell::get);
        for step in 0..100 {
            scan(step, &mut reading);
            let scan = Scan::of(&reading).expect("a scan");
            n_found += usize::from(!filter.update(0.1 * step as f64, &scan).held);
        }
        assert_eq!(COUNT.with(Cell::get), before);
        assert_eq!(n_found, 100);
    }
}
