//! Discs with drag in an even wind: what they leave behind.

use super::wakes::{self, HUB, settings};
use crate::inflow::{MeanProfile, PrescribedWind};
use crate::vortex::{BodyWakes, Cores, FreeWake, WakeSettings};
use crate::{FlowSolver, WindField};
use basis::{PointForce, Vector3};
use std::f64::consts::PI;
use std::sync::Arc;

const RADIUS: f64 = 2.0;
const WIND: f64 = 10.0;
const DENSITY: f64 = 1.25;

/// The wake of a disc with a drag of `coefficient` (–) after `n` steps of `interval` (s).
fn behind_disc(coefficient: f64, interval: f64, n: usize, cores: Cores) -> FreeWake {
    let settings = WakeSettings {
        interval,
        cores,
        bodies: BodyWakes { length: 80.0 * RADIUS, n_bodies: 1, most_rings: 400 },
        air_density: DENSITY,
        ground: false,
        ..settings()
    };
    let profile = MeanProfile::Uniform { speed: WIND };
    let wind = PrescribedWind::everywhere(Arc::new(profile));
    let mut wake = FreeWake::new(settings, wind).expect("sound settings");
    for _ in 0..n {
        wake.advance(interval, &[drag(coefficient)]).expect("it stays finite");
    }
    wake
}

fn drag(coefficient: f64) -> PointForce {
    let force = -0.5 * DENSITY * WIND * WIND * PI * RADIUS * RADIUS * coefficient;
    PointForce {
        disc_radius: Some(RADIUS),
        ..PointForce::of_body(Vector3::ZERO, Vector3::X * force, 0.0)
    }
}

/// Cores that stay as they were born.
fn cores() -> Cores {
    Cores { kinematic_viscosity: 0.0, eddy_constant: 0.0, strain: false, ..settings().cores }
}

fn impulse(wake: &FreeWake) -> Vector3 {
    let of = |segment: &crate::vortex::Segment| {
        let middle = 0.5 * (segment.from + segment.to);
        middle.cross(segment.to - segment.from) * (0.5 * segment.circulation)
    };
    wake.segments().iter().map(of).sum()
}

#[test]
fn what_a_disc_sheds_in_a_time_has_the_impulse_of_its_drag() {
    let (interval, coefficient) = (0.08, 0.5);
    let of_drag = drag(coefficient).force * (interval / DENSITY);
    // In the first step the ring is the disc's edge itself; later the vortices' own motion keeps the sum of
    // their impulse, as far as sides and steps let it.
    let first = behind_disc(coefficient, interval, 1, cores());
    let error = (impulse(&first) - of_drag).length() / of_drag.length();
    assert!(error < 0.02, "{error}");
    for n in [30, 100] {
        let wake = behind_disc(coefficient, interval, n, cores());
        let whole = of_drag * n as f64;
        let error = (impulse(&wake) - whole).length() / whole.length();
        assert!(error < 0.02, "{n} {error}");
    }
}

#[test]
fn behind_a_disc_the_wind_is_near_that_of_momentum_theory() {
    let wind = |wake: &FreeWake, x: f64| {
        let mut velocity = [Vector3::ZERO];
        wake.sample(&[Vector3::X * x], &mut velocity);
        velocity[0].x / WIND
    };
    for coefficient in [0.2, 0.5] {
        // The tube of rings is as long as thirty radii: 0.3 % is missing of it. Twelve sides and rings half a
        // radius apart each take an order of a hundredth.
        let wake = behind_disc(coefficient, 0.08, 120, cores());
        let far = f64::sqrt(1.0 - coefficient);
        let found = wind(&wake, 10.0 * RADIUS);
        let deficit = (1.0 - found) / (1.0 - far);
        assert!((deficit - 1.0).abs() < 0.02, "{coefficient} {found} {far}");
        // Nothing is left far beside.
        let mut beside = [Vector3::ZERO];
        wake.sample(&[Vector3::new(10.0, 40.0, 0.0) * RADIUS], &mut beside);
        assert!((beside[0].x / WIND - 1.0).abs() < 1e-3, "{beside:?}");
    }
}

#[test]
fn a_body_leaves_nothing_where_it_is_not_followed() {
    let settings = WakeSettings { bodies: BodyWakes::NONE, ..settings() };
    let profile = MeanProfile::Uniform { speed: WIND };
    let wind = PrescribedWind::everywhere(Arc::new(profile));
    let mut wake = FreeWake::new(settings.clone(), wind).expect("sound settings");
    for _ in 0..5 {
        wake.advance(settings.interval, &[drag(0.8)]).expect("it stays finite");
    }
    assert!(wake.segments().is_empty());
}

#[test]
fn the_wake_of_a_body_comes_to_its_end() {
    let wake = behind_disc(0.3, 0.2, 200, cores());
    let far = wake.segments().iter().map(|segment| segment.from.x).fold(0.0, f64::max);
    assert!((75.0..84.0).contains(&(far / RADIUS)), "{far}");
    let n_rings = wake.segments().len() / crate::vortex::body::N_SIDES;
    // One every half of a radius, and closer where the wake is slow.
    assert!((80..200).contains(&n_rings), "{n_rings}");
}

#[test]
fn a_nacelle_is_told_of_its_own_wake() {
    let mut wake = wakes::wake(settings());
    wakes::advanced(&mut wake, 0..30);
    let n = wake.bodies[0].n_rings() * crate::vortex::body::N_SIDES;
    // Bodies' rings come last.
    let rings = &wake.segments()[wake.segments().len() - n..];
    let own: Vector3 = rings.iter().map(|segment| segment.velocity(HUB)).sum();
    let told = wake.answer(0).expect("it has met the rotor").at_nacelle;
    assert!((told - own).length() < 1e-12 && told.x < -0.1, "{told} {own}");
}
