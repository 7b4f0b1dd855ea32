//! Tests of deterministic winds: what the standard says of them at chosen times.

use super::*;
use crate::inflow::iec;
use proptest::prelude::*;
use std::f64::consts::PI;

const HUB: f64 = 90.0;

fn wind(event: Event) -> DeterministicWind {
    let profile = MeanProfile::PowerLaw { hub_height: HUB, speed: 12.0, exponent: 0.2 };
    DeterministicWind { profile, hub_height: HUB, veer: 0.0, event }
}

fn at_hub(wind: &DeterministicWind, time: f64) -> Vector3 {
    wind.wind(time, Vector3::new(0.0, 0.0, HUB))
}

#[test]
fn veer_turns_right_with_height_and_keeps_the_speed() {
    let wind = DeterministicWind { veer: 0.1_f64.to_radians(), ..wind(Event::Steady) };
    let high = wind.wind(5.0, Vector3::new(3.0, 4.0, HUB + 100.0));
    assert!(high.y < 0.0 && high.z == 0.0);
    assert!((high.y.atan2(high.x) + 10_f64.to_radians()).abs() < 1e-12);
    assert!((high.length() - wind.profile.speed(HUB + 100.0)).abs() < 1e-12);
    assert_eq!(at_hub(&wind, 0.0), Vector3::new(12.0, 0.0, 0.0));
}

#[test]
fn steps_ramps_and_stairs_scale_the_profile() {
    let step = wind(Event::Everywhere(Change::Step { start: 10.0, speed: 18.0 }));
    assert_eq!(at_hub(&step, 9.999).x, 12.0);
    assert!((at_hub(&step, 10.0).x - 18.0).abs() < 1e-12);
    let low = Vector3::new(0.0, 0.0, 30.0);
    assert!((step.wind(11.0, low).x / step.wind(0.0, low).x - 1.5).abs() < 1e-12);
    let ramp = wind(Event::Everywhere(Change::Ramp { start: 10.0, duration: 4.0, speed: 6.0 }));
    for (time, speed) in [(0.0, 12.0), (11.0, 10.5), (14.0, 6.0), (99.0, 6.0)] {
        assert!((at_hub(&ramp, time).x - speed).abs() < 1e-12);
    }
    let stairs =
        wind(Event::Everywhere(Change::Staircase { start: 5.0, hold: 2.0, rise: 1.0, n_steps: 3 }));
    for (time, speed) in [(4.9, 12.0), (5.0, 13.0), (7.5, 14.0), (9.0, 15.0), (50.0, 15.0)] {
        assert!((at_hub(&stairs, time).x - speed).abs() < 1e-12, "{time}");
    }
}

/// The gust's extremes: at mid-time 1 − cos is 2 and sin(3π/2) −1, so that the peak is 0.74 V_gust.
#[test]
fn the_operating_gust_peaks_at_mid_time() {
    let gust = iec::operating_gust(1.8, 12.0, HUB, 126.0, 50.0);
    assert!((gust - 3.3 * 1.8 / (1.0 + 0.1 * 126.0 / 42.0)).abs() < 1e-12);
    let wind = wind(Event::Everywhere(Change::OperatingGust {
        start: 20.0,
        duration: OPERATING_GUST_DURATION,
        gust,
    }));
    assert_eq!(at_hub(&wind, 19.9).x, 12.0);
    assert!((at_hub(&wind, 25.25).x - 12.0 - 0.74 * gust).abs() < 1e-9);
    assert!(at_hub(&wind, 22.6).x < 12.0 - 0.2 * gust);
    assert!((at_hub(&wind, 30.5).x - 12.0).abs() < 1e-9);
}

#[test]
fn directions_change_by_half_at_mid_time_and_stay() {
    let change = -iec::direction_change(1.8, 12.0, HUB, 126.0);
    let turn =
        wind(Event::Everywhere(Change::DirectionChange { start: 0.0, duration: 6.0, change }));
    let angle = |wind: &DeterministicWind, time| {
        let velocity = at_hub(wind, time);
        velocity.y.atan2(velocity.x)
    };
    assert!((angle(&turn, 3.0) - 0.5 * change).abs() < 1e-12);
    assert!((angle(&turn, 600.0) - change).abs() < 1e-12);
    let change = iec::coherent_direction_change(12.0);
    let gust = wind(Event::Everywhere(Change::CoherentGust {
        start: 0.0,
        duration: 10.0,
        rise: iec::COHERENT_GUST,
        change,
    }));
    assert!((at_hub(&gust, 5.0).length() - 19.5).abs() < 1e-12);
    assert!((at_hub(&gust, 60.0).length() - 27.0).abs() < 1e-12);
    assert!((angle(&gust, 5.0) - 30_f64.to_radians()).abs() < 1e-12);
}

#[test]
fn extreme_shear_is_whole_one_radius_off_the_hub() {
    let vertical = iec::extreme_shear(1.8, HUB, 126.0);
    let shear = wind(Event::ExtremeShear {
        start: 0.0,
        duration: EXTREME_SHEAR_DURATION,
        diameter: 126.0,
        hub_y: 0.0,
        vertical,
        horizontal: -2.0,
    });
    let added = |y: f64, z: f64| {
        let place = Vector3::new(0.0, y, z);
        shear.wind(6.0, place).x - shear.wind(-1.0, place).x
    };
    assert!((added(0.0, HUB + 63.0) - vertical).abs() < 1e-9);
    assert!((added(0.0, HUB - 63.0) + vertical).abs() < 1e-9);
    assert!((added(63.0, HUB) + 2.0).abs() < 1e-9);
    assert_eq!(
        shear.wind(12.5, Vector3::new(0.0, 9.0, 9.0)),
        shear.wind(-1.0, Vector3::new(0.0, 9.0, 9.0))
    );
}

fn disk(clockwise: bool) -> RotatingDisk {
    RotatingDisk::of_wake(240.0, 150.0, 16.0, clockwise)
}

#[test]
fn the_disk_circles_as_its_source_says() {
    let disk = disk(true);
    assert_eq!(disk.centre(0.0), [0.0, 174.0]);
    assert!((disk.frequency(0.0) - 0.012).abs() < 1e-12);
    assert!((disk.frequency(1500.0) - 0.22 * 16.0 / 240.0).abs() < 1e-12);
    // A quarter turn on: clockwise looking downwind is to the right, where y is negative.
    let quarter = (0..200_000)
        .map(|n| 0.001 * f64::from(n))
        .find(|time| disk.phase(*time) >= 0.5 * PI)
        .unwrap();
    let [y, z] = disk.centre(quarter);
    assert!((y + 48.0).abs() < 1e-6 && (z - 150.0).abs() < 0.01);
    let other = self::disk(false).centre(quarter);
    assert!((other[0] - 48.0).abs() < 1e-6);
    let wind = DeterministicWind {
        profile: MeanProfile::Uniform { speed: 16.0 },
        hub_height: 150.0,
        veer: 0.0,
        event: Event::RotatingDisk(disk),
    };
    assert_eq!(wind.wind(0.0, Vector3::new(0.0, 0.0, 174.0 + 119.9)).x, 8.0);
    assert_eq!(wind.wind(0.0, Vector3::new(0.0, 0.0, 174.0 + 120.1)).x, 16.0);
    // The hub is always inside.
    assert!((0..1500).all(|time| at(&wind, f64::from(time)) == 8.0));
    fn at(wind: &DeterministicWind, time: f64) -> f64 {
        wind.wind(time, Vector3::new(0.0, 0.0, 150.0)).x
    }
}

#[test]
fn what_cannot_be_used_is_named() {
    for (event, name) in [
        (Event::Everywhere(Change::Step { start: f64::NAN, speed: 3.0 }), "start of the step"),
        (
            Event::Everywhere(Change::Ramp { start: 0.0, duration: 0.0, speed: 3.0 }),
            "duration of the ramp",
        ),
        (
            Event::Everywhere(Change::Staircase { start: 0.0, hold: 9.0, rise: -5.0, n_steps: 3 }),
            "last step",
        ),
        (Event::RotatingDisk(RotatingDisk { radius: -1.0, ..disk(true) }), "radius"),
    ] {
        let error = wind(event).check().unwrap_err();
        assert!(error.to_string().contains(name), "{error}");
    }
    let profile = MeanProfile::LogLaw { hub_height: HUB, speed: 9.0, roughness_length: 200.0 };
    let error = DeterministicWind::steady(profile, HUB).check().unwrap_err();
    assert!(error.to_string().contains("roughness"), "{error}");
    assert!(wind(Event::Steady).check().is_ok());
}

proptest! {
    /// The phase is the integral of the frequency, before, in and after the sweep.
    #[test]
    fn phase_is_the_integral_of_frequency(time in -500.0..3000.0_f64) {
        let disk = disk(true);
        let slope = (disk.phase(time + 0.01) - disk.phase(time - 0.01)) / 0.02;
        prop_assert!((slope - TAU * disk.frequency(time)).abs() < 1e-6);
    }

    /// Many points at once are the points one by one.
    #[test]
    fn a_batch_is_its_points(
        places in prop::collection::vec((-200.0..200.0_f64, -200.0..200.0_f64, 0.0..300.0_f64), 1..20),
        time in -5.0..40.0_f64,
    ) {
        let gust = Change::CoherentGust { start: 3.0, duration: 10.0, rise: 15.0, change: 0.7 };
        let event = Event::Everywhere(gust);
        let wind = DeterministicWind { veer: 1e-3, ..wind(event) };
        let positions: Vec<_> = places.iter().map(|&(x, y, z)| Vector3::new(x, y, z)).collect();
        let mut velocities = vec![Vector3::ZERO; positions.len()];
        wind.sample(time, &positions, &mut velocities);
        for (position, velocity) in positions.iter().zip(velocities) {
            prop_assert_eq!(velocity, wind.wind(time, *position));
        }
    }
}
