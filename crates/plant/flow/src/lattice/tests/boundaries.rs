//! What comes in arrives, what goes out is gone.

use super::*;
use crate::{FlowSolver, WindField};

const SPEED: f64 = 0.1;

/// A duct of `n` cells between inlet and outlet, lattice units, wind `wind`.
fn duct(
    n_cells: [usize; 3],
    wind: impl Fn(f64, Vector3) -> Vector3 + Send + Sync + 'static,
) -> Lattice {
    let mut settings = periodic_box(n_cells, 1e-6);
    settings.ends = Ends::InletOutlet;
    settings.subgrid = Subgrid::smagorinsky(DEFAULT_SMAGORINSKY);
    lattice(settings, wind)
}

/// Largest departure of u from the wind along the middle line of `air`, cells `from` to `to`.
fn departure(air: &Lattice, from: usize, to: usize, wind: f64) -> f64 {
    let [_, n_y, n_z] = air.n_cells();
    let positions: Vec<Vector3> =
        (from..to).map(|x| Vector3::new(x as f64, (n_y / 2) as f64, (n_z / 2) as f64)).collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    air.sample(&positions, &mut velocities);
    velocities.iter().map(|v| (v.x - wind).abs()).fold(0.0, f64::max)
}

#[test]
fn a_sound_pulse_leaves() {
    // A velocity pulse at constant pressure splits in two halves, one up-, one downstream. At rest density
    // the one that goes downstream arrives at the outlet at u + c; what comes back must be small.
    let n = 160;
    let pulse = move |_: f64, x: Vector3| {
        let bump = (-((x.x - 80.0) / 6.0).powi(2)).exp();
        Vector3::new(SPEED + 0.004 * bump, 0.0, 0.0)
    };
    let mut air = duct([n, 1, 1], pulse);
    // Half of it has passed x = 110 and not yet come back.
    air.advance(50.0, &[]).expect("no divergence");
    let out = departure(&air, 100, 130, SPEED);
    // The reflection of the outlet would be on its way back at u - c through the middle.
    air.advance(130.0, &[]).expect("no divergence");
    let back = departure(&air, 90, 130, SPEED);
    println!("sound {out:e} {back:e}");
    assert!(out > 1.5e-3);
    assert!(back < 0.05 * out, "{back} of {out} came back");
}

#[test]
fn a_vortex_leaves() {
    let n = [120, 48, 1];
    let vortex = move |_: f64, x: Vector3| {
        let (dx, dy) = (x.x - 70.0, x.y - 23.5);
        let swirl = 0.01 * (-(dx * dx + dy * dy) / 36.0).exp();
        Vector3::new(SPEED - swirl * dy / 6.0, swirl * dx / 6.0, 0.0)
    };
    let mut air = duct(n, vortex);
    air.advance(10.0, &[]).expect("no divergence");
    let disturbance = |air: &Lattice| {
        let plane = air.plane("p", basis::records::PlaneAxes::Horizontal, 0.0);
        let mut sum = 0.0;
        for index in 0..plane.velocity[0].len() {
            let u = f64::from(plane.velocity[0][index]) - SPEED;
            sum += u * u + f64::from(plane.velocity[1][index]).powi(2);
        }
        sum
    };
    let before = disturbance(&air);
    air.advance(900.0, &[]).expect("no divergence");
    let after = disturbance(&air);
    println!("vortex {before:e} {after:e}");
    assert!(after < 1e-3 * before, "{after} of {before} is left");
}

#[test]
fn gusts_pass_as_prescribed() {
    // A transverse gust is carried by the wind unchanged: at x it is what entered x/U before.
    let gust = |time: f64, x: f64| 0.005 * (0.02 * (x - SPEED * time)).sin();
    let mut air = duct([100, 1, 1], move |time, x| Vector3::new(SPEED, gust(time, x.x), 0.0));
    air.advance(1500.0, &[]).expect("no divergence");
    let time = air.time();
    let mut worst: f64 = 0.0;
    for x in 0..80 {
        let mut velocity = [Vector3::ZERO];
        air.sample(&[Vector3::new(f64::from(x), 0.0, 0.0)], &mut velocity);
        worst = worst.max((velocity[0].y - gust(time, f64::from(x))).abs());
    }
    println!("gust {worst:e}");
    assert!(worst < 0.02 * 0.005, "gust off by {worst}");
}

#[test]
fn the_wind_that_enters_has_its_profile() {
    let profile = |z: f64| 0.06 + 0.04 * (z / 20.0).powf(0.2);
    let mut settings = periodic_box([48, 8, 20], 1e-6);
    (settings.ends, settings.ground) = (Ends::InletOutlet, Ground::Slip);
    settings.subgrid = Subgrid::smagorinsky(DEFAULT_SMAGORINSKY);
    let mut air = lattice(settings, move |_, x| Vector3::new(profile(x.z + 0.5), 0.0, 0.0));
    air.advance(2000.0, &[]).expect("no divergence");
    for x in [0.0, 10.0, 30.0] {
        for z in 0..20 {
            let mut velocity = [Vector3::ZERO];
            air.sample(&[Vector3::new(x, 4.0, f64::from(z))], &mut velocity);
            let expected = profile(f64::from(z) + 0.5);
            let error = velocity[0].x / expected - 1.0;
            assert!(error.abs() < 0.03, "x {x} z {z}: {} for {expected}", velocity[0].x);
        }
    }
}

/// Layers of air that slide over each other, each along its own direction, are a steady flow without
/// friction.
#[test]
fn a_wind_that_veers_keeps_its_directions() {
    let wind = |z: f64| {
        let (sine, cosine) = (-0.03 * (z - 9.5)).sin_cos();
        0.08 * Vector3::new(cosine, sine, 0.0)
    };
    let mut settings = periodic_box([48, 8, 20], 1e-6);
    (settings.ends, settings.ground) = (Ends::InletOutlet, Ground::Slip);
    settings.subgrid = Subgrid::smagorinsky(DEFAULT_SMAGORINSKY);
    let mut air = lattice(settings, move |_, x| wind(x.z));
    air.advance(2000.0, &[]).expect("no divergence");
    for x in [0.0, 10.0, 30.0] {
        for z in 0..20 {
            let mut velocity = [Vector3::ZERO];
            air.sample(&[Vector3::new(x, 4.0, f64::from(z))], &mut velocity);
            let error = velocity[0] - wind(f64::from(z));
            assert!(error.length() < 0.03 * 0.08, "x {x} z {z}: off by {error}");
        }
    }
}
