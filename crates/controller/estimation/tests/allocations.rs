//! An update asks the system for no memory.

mod machine;

use basis::Sense;
use estimation::Estimator;
use estimation::helix::{HelixEstimator, Options};
use machine::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, with a count.
struct Counting;

// SAFETY: every call goes to the system's allocator as it is.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.with(|count| count.set(count.get() + 1));
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

#[test]
fn an_update_allocates_nothing() {
    let definition = definition();
    for options in [Options::default(), Options::published()] {
        let mut model = model(&definition, Sense::Clockwise, &options);
        let (world, mut noise) = (World::new(Sense::Clockwise, 1.0), Dice(1));
        let record: Vec<_> = (0..50).map(|step| world.read(step, &mut model, &mut noise)).collect();
        let mut estimator =
            HelixEstimator::new(&definition, &setting(Sense::Clockwise), options).unwrap();
        let before = COUNT.with(Cell::get);
        for measurements in &record {
            estimator.update(measurements);
        }
        assert_eq!(COUNT.with(Cell::get), before);
    }
}
