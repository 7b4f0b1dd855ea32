//! A lidar takes no memory from the system while it measures.

use basis::Vector3;
use basis::keys::Values;
use flow::WindField;
use sensing::{Mount, SENSORS, Scene, Sensing};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::Arc;
use turbine::definition::{BladeStructure, Mode, Tower, TowerSection};
use turbine::{Definition, Induction, Turbine, TurbineSettings, sample};

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, with a count by thread.
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

/// The same wind everywhere.
struct Even;

impl WindField for Even {
    fn sample(&self, _: &[Vector3], velocities: &mut [Vector3]) {
        velocities.fill(Vector3::X * 9.0);
    }
}

/// The sample turbine on a tower that bends.
fn definition() -> Definition {
    let base = sample::definition();
    let section = |height: f64| TowerSection {
        height,
        mass: 4e3,
        fore_aft_stiffness: 5e11,
        side_to_side_stiffness: 5e11,
    };
    let first = Mode { coefficients: [1.0, 0.0, 0.0, 0.0, 0.0], damping_ratio: 0.01 };
    let second = Mode { coefficients: [-3.0, 4.0, 0.0, 0.0, 0.0], ..first };
    let tower = Tower {
        sections: vec![section(0.0), section(88.0)],
        fore_aft_modes: [first, second],
        side_to_side_modes: [first, second],
        ..base.tower
    };
    let blade_structure = BladeStructure { flap_modes: [first, second], ..base.blade_structure };
    Definition { tower, blade_structure, ..base }
}

#[test]
fn a_reading_takes_no_memory() {
    let definition = Arc::new(definition());
    let induction =
        Induction::ByFlow { smearing_length: 8.0, sample_spacing: 0.0, dynamic_stall: false };
    let settings = TurbineSettings {
        induction,
        flexible: true,
        air_density: 1.225,
        yaw: 0.1,
        rotor_speed: 1.0,
        azimuth: 0.0,
        pitch: 0.0,
    };
    let turbine = Turbine::new(Arc::clone(&definition), Vector3::ZERO, settings).expect("sound");
    let kind = SENSORS.find("lidar").expect("it is one of the kinds");
    for order in ["at-once", "in-turn"] {
        let mut values = Values::defaults(kind.table().keys);
        values.set("order", order);
        values.set("probe", "lorentzian");
        values.set("probe_length", 9.0);
        values.set("noise", 0.2);
        values.set("ranges_diameters", vec![1.0, 1.5]);
        let mount = Mount { definition: &definition, foot: Vector3::ZERO, interval: 0.1, seed: 1 };
        let mut sensing = Sensing::perfect().with_sensor("Eye", kind.build(&values, &mount));
        let before = COUNT.with(Cell::get);
        for step in 0..50 {
            let truth = turbine.truth(0.1 * f64::from(step), 0.1);
            let scene = Scene { truth: &truth, turbine: &turbine, wind: &Even };
            assert!(sensing.read(&scene).scan("Eye").is_some());
        }
        assert_eq!(COUNT.with(Cell::get), before, "{order}");
    }
}
