//! A step of a free wake takes no memory from the system once the wake has its length, nor does one of a
//! lattice.

use basis::{BoundVortex, PointForce, Vector3};
use flow::inflow::{MeanProfile, PrescribedWind};
use flow::lattice::atmosphere::Atmosphere;
use flow::lattice::refinement::{Refined, Refinement};
use flow::lattice::{Ground, Lattice, LatticeSettings, Sides, Subgrid, SubgridModel};
use flow::vortex::{
    Accuracy, BodyWakes, Cores, FreeWake, MeanShear, Points, Resolution, WakeSettings,
};
use flow::{FlowSolver, Inflow, WindField};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::f64::consts::TAU;
use std::sync::Arc;

const INTERVAL: f64 = 0.2;
const N_ELEMENTS: usize = 6;
const HUB: Vector3 = Vector3::new(0.0, 0.0, 80.0);
/// Steps until the wake has its length (–): 150 m at about 7 m/s.
const N_WARM: usize = 130;
/// Steps that are monitored (–).
const N_WATCHED: usize = 30;

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

/// Two blades of 40 m and a nacelle in step number `step`.
fn forces(step: usize) -> Vec<PointForce> {
    let place = |step: usize, blade: usize, station: usize| {
        let angle = TAU * blade as f64 / 2.0 + 0.15 * step as f64;
        let radial = Vector3::new(0.0, -angle.sin(), angle.cos());
        (HUB + radial * (4.0 + 6.0 * (station as f64 + 0.5)), radial * 6.0)
    };
    let all = (0..2).flat_map(|blade| (0..N_ELEMENTS).map(move |station| (blade, station)));
    let elements = all.map(|(blade, station)| {
        let (position, along) = place(step, blade, station);
        let (position_after, along_after) = place(step + 1, blade, station);
        let bound = Some(BoundVortex {
            blade,
            station,
            circulation: 25.0 + 0.5 * (step % 7) as f64,
            along,
            inner_share: 0.5,
            position_after,
            along_after,
        });
        PointForce { bound, ..PointForce::of_body(position, Vector3::ZERO, 0.0) }
    });
    let nacelle =
        PointForce { disc_radius: Some(2.0), ..PointForce::of_body(HUB, Vector3::X * -300.0, 0.0) };
    elements.chain([nacelle]).collect()
}

fn wake() -> FreeWake {
    let profile = MeanProfile::PowerLaw { hub_height: HUB.z, speed: 8.0, exponent: 0.1 };
    let settings = WakeSettings {
        interval: INTERVAL,
        resolution: Resolution {
            near_rows: 10,
            far_stride: 2,
            far_filaments: 4,
            length: 150.0,
            end: f64::INFINITY,
            far_rows: 60,
        },
        cores: Cores {
            initial_widths: 0.3,
            kinematic_viscosity: 1.5e-5,
            eddy_constant: 1e-4,
            strain: true,
        },
        bodies: BodyWakes { length: 100.0, n_bodies: 1, most_rings: 200 },
        air_density: 1.2,
        accuracy: Accuracy { degree: 3, opening: 0.5 },
        shear: MeanShear::LeftOut { profile, hub_height: HUB.z, veer: 0.0 },
        ground: true,
        shown: Points::NONE,
        n_blades: 2,
        far_rows_in_all: 120,
        n_elements: N_ELEMENTS,
        threads: Some(1),
    };
    FreeWake::new(settings, PrescribedWind::everywhere(Arc::new(profile))).expect("sound settings")
}

#[test]
fn a_step_of_a_free_wake_allocates_nothing() {
    let mut wake = wake();
    let all: Vec<Vec<PointForce>> = (0..N_WARM + N_WATCHED).map(forces).collect();
    let places: Vec<Vector3> = all[0].iter().map(|force| force.position).collect();
    let mut winds = vec![Vector3::ZERO; places.len()];
    let mut watched = (0, 0);
    for (step, forces) in all.iter().enumerate() {
        if step == N_WARM {
            watched = (COUNT.with(Cell::get), wake.segments().len());
        }
        wake.sample(&places, &mut winds);
        wake.advance(INTERVAL, forces).expect("it stays finite");
    }
    assert_eq!(COUNT.with(Cell::get) - watched.0, 0);
    // Rows have been made coarser, and have come to their end.
    assert!(watched.1 > 500, "{watched:?}");
    let before = COUNT.with(Cell::get);
    std::hint::black_box(vec![0_u8; 64]);
    assert_eq!(COUNT.with(Cell::get) - before, 1, "the count sees what is allocated");
}

/// Wind that veers with height and is warmer above.
struct Veering;

impl Inflow for Veering {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            let across = 0.01 * (position.z - 45.0) + 0.1 * (0.5 * time).sin();
            *velocity = Vector3::new(8.0, across, 0.0);
        }
    }

    fn sample_temperature(&self, _: f64, positions: &[Vector3], temperatures: &mut [f64]) -> bool {
        for (position, temperature) in positions.iter().zip(temperatures) {
            *temperature = 300.0 + 0.003 * position.z;
        }
        true
    }
}

#[test]
fn a_step_of_a_lattice_with_open_sides_allocates_nothing() {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [24, 10, 9], 0.1, 8.0);
    (settings.sides, settings.threads) = (Sides::Open, Some(1));
    settings.ground = Ground::WallStress { roughness_length: 0.05 };
    settings.subgrid = Subgrid::new(SubgridModel::MinimumDissipation);
    settings.atmosphere = Some(Atmosphere::new(300.0));
    let mut air = Lattice::new(settings, Arc::new(Veering)).expect("sound settings");
    let force = PointForce::of_body(Vector3::new(90.0, 50.0, 45.0), Vector3::X * -1e3, 15.0);
    // The forces take their room at first.
    air.advance(2.0, &[force]).expect("no divergence");
    let before = COUNT.with(Cell::get);
    air.advance(4.0, &[force]).expect("no divergence");
    assert_eq!(COUNT.with(Cell::get) - before, 0);
}

#[test]
fn a_step_of_boxes_in_an_atmosphere_allocates_nothing() {
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [24, 14, 12], 0.1, 8.0);
    (settings.sides, settings.threads) = (Sides::Open, Some(1));
    settings.ground = Ground::WallStress { roughness_length: 0.05 };
    settings.atmosphere = Some(Atmosphere::new(300.0));
    let within =
        vec![Refinement { first_cell: [4, 4, 0], n_cells: [12, 8, 9], within: Vec::new() }];
    let place = Refinement { first_cell: [4, 3, 0], n_cells: [10, 8, 7], within };
    let mut air = Refined::new(settings, &[place], Arc::new(Veering)).expect("sound settings");
    let force = PointForce::of_body(Vector3::new(90.0, 70.0, 35.0), Vector3::X * -1e3, 10.0);
    air.advance(2.0, &[force]).expect("no divergence");
    let before = COUNT.with(Cell::get);
    air.advance(4.0, &[force]).expect("no divergence");
    assert_eq!(COUNT.with(Cell::get) - before, 0);
}
