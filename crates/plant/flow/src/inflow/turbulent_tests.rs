//! Tests of turbulence carried past.

use super::*;
use crate::inflow::{DeterministicWind, mann};
use proptest::prelude::*;

const SPACING: f64 = 10.0;

fn turbulence() -> Arc<TurbulenceBox> {
    let settings = mann::MannSettings {
        n_points: [48, 16, 12],
        spacing: [SPACING; 3],
        length_scale: 60.0,
        anisotropy: 3.9,
        standard_deviation: 0.6,
        seed: 5,
        threads: Some(1),
    };
    Arc::new(mann::generate(&settings, |_| {}).unwrap())
}

fn profile() -> MeanProfile {
    MeanProfile::PowerLaw { hub_height: 60.0, speed: 8.0, exponent: 0.2 }
}

fn inflow() -> TurbulentInflow {
    TurbulentInflow::aligned(turbulence(), profile(), Vector3::new(-100.0, -80.0, 0.0)).unwrap()
}

fn wind(inflow: &TurbulentInflow, time: f64, position: Vector3) -> Vector3 {
    let mut velocity = [Vector3::ZERO];
    inflow.sample(time, &[position], &mut velocity);
    velocity[0]
}

/// Place of a point of the box at time zero (m, farm frame).
fn place_of(point: [usize; 3]) -> Vector3 {
    let [x, y, z] = point.map(|index| (index as f64 + 0.5) * SPACING);
    Vector3::new(x - 100.0, y - 80.0, z)
}

#[test]
fn points_of_the_box_are_met_exactly() {
    let inflow = inflow();
    for point in [[0, 0, 0], [7, 3, 2], [47, 15, 11], [20, 15, 0]] {
        let place = place_of(point);
        let velocity = wind(&inflow, 0.0, place);
        let [u, v, w] =
            [0, 1, 2].map(|component| f64::from(inflow.turbulence().at(component, point)));
        assert!((velocity - Vector3::new(profile().speed(place.z) + u, v, w)).length() < 1e-6);
    }
}

/// The mean turns over height as the closed form has it, the fluctuations stay what they are.
#[test]
fn the_mean_veers_like_the_wind_without_turbulence() {
    let veer = 2e-3;
    let mean = DeterministicWind { veer, ..DeterministicWind::steady(profile(), 60.0) };
    let (straight, veering) = (inflow(), inflow().veering(veer, 60.0));
    for place in
        [place_of([7, 3, 2]), Vector3::new(3.0, -17.0, 60.0), Vector3::new(90.0, 4.0, 113.0)]
    {
        let turned = mean.wind(0.0, place) - Vector3::X * profile().speed(place.z);
        let found = wind(&veering, 21.0, place) - wind(&straight, 21.0, place);
        assert!((found - turned).length() < 1e-12, "{place}: {found} for {turned}");
    }
}

/// Time runs against x: what stands upwind by U t arrives at time t.
#[test]
fn what_is_upwind_arrives_later() {
    let inflow = inflow();
    let place = place_of([20, 4, 5]);
    let upwind = place_of([12, 4, 5]);
    let time = 8.0 * SPACING / profile().hub_speed();
    let (later, before) = (wind(&inflow, time, place), wind(&inflow, 0.0, upwind));
    assert!((later - before).length() < 1e-4);
}

#[test]
fn is_continuous_between_points() {
    let inflow = inflow();
    let mut previous = wind(&inflow, 0.0, place_of([3, 3, 3]));
    for step in 1..=4000 {
        let share = f64::from(step) / 4000.0;
        let place = place_of([3, 3, 3]) + Vector3::new(70.0, 55.0, 31.0) * share;
        let next = wind(&inflow, 3.0 * share, place);
        assert!((next - previous).length() < 0.02);
        previous = next;
    }
}

/// A wave of eight points keeps 99 % of its variance between points in x.
#[test]
fn interpolation_in_time_keeps_the_variance() {
    let n_points = [32, 2, 2];
    let wave: Vec<f32> = (0..128)
        .map(|index| (std::f64::consts::TAU * f64::from(index / 4) / 8.0).sin() as f32)
        .collect();
    let velocity = [wave.clone(), wave.clone(), wave];
    let turbulence = Arc::new(TurbulenceBox::new(n_points, [1.0; 3], velocity).unwrap());
    let mean = MeanProfile::Uniform { speed: 1.0 };
    let inflow = TurbulentInflow::new(turbulence, mean, Vector3::ZERO).unwrap();
    let n = 3200;
    let square = |step: i32| (wind(&inflow, 0.01 * f64::from(step), Vector3::ZERO).x - 1.0).powi(2);
    let variance = (0..n).map(square).sum::<f64>() / f64::from(n);
    assert!((variance / 0.5 - 0.9911).abs() < 1e-3, "{variance}");
}

/// Vertical air comes to rest at the ground, the other components do not, and high up nothing changes.
#[test]
fn the_ground_blocks_vertical_air_only() {
    let (free, blocked) = (inflow(), inflow().blocked(20.0));
    let mut low_shares = Vec::new();
    for time in 0..40 {
        let time = f64::from(time) * 1.3;
        for height in [0.5, 5.0, 115.0] {
            let place = Vector3::new(3.0, 7.0, height);
            let (without, with) = (wind(&free, time, place), wind(&blocked, time, place));
            assert_eq!((without.x, without.y), (with.x, with.y));
            let share = with.z / without.z;
            match height {
                0.5 => low_shares.push(share),
                115.0 => assert!(share > 0.99),
                _ => {}
            }
        }
        assert_eq!(wind(&blocked, time, Vector3::new(3.0, 7.0, 0.0)).z, 0.0);
    }
    assert!(low_shares.iter().all(|share| (share - 0.025_f64.powf(1.0 / 3.0)).abs() < 1e-3));
}

#[test]
fn calm_profiles_cannot_carry_turbulence() {
    let calm = MeanProfile::Uniform { speed: 0.0 };
    assert!(TurbulentInflow::new(turbulence(), calm, Vector3::ZERO).is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// The box repeats along x (in time too), y and z.
    #[test]
    fn repeats_after_its_lengths(
        x in -900.0..900.0_f64, y in -900.0..900.0_f64, z in 1.0..300.0_f64, time in 0.0..100.0_f64,
    ) {
        let inflow = inflow();
        let lengths = inflow.turbulence().lengths();
        let mean = |z: f64| Vector3::new(profile().speed(z), 0.0, 0.0);
        let here = wind(&inflow, time, Vector3::new(x, y, z)) - mean(z);
        let again = [
            (time, Vector3::new(x + lengths[0], y, z)),
            (time + lengths[0] / 8.0, Vector3::new(x, y, z)),
            (time, Vector3::new(x, y - lengths[1], z)),
            (time, Vector3::new(x, y, z + lengths[2])),
        ];
        for (time, place) in again {
            prop_assert!((wind(&inflow, time, place) - mean(place.z) - here).length() < 1e-4);
        }
    }

    /// Many points at once are the points one by one, in any order.
    #[test]
    fn a_batch_is_its_points(
        places in prop::collection::vec((0_usize..3, -200.0..200.0_f64, 0_usize..3), 1..30),
        time in 0.0..50.0_f64,
    ) {
        let inflow = inflow().blocked(30.0);
        let positions: Vec<_> = places
            .iter()
            .map(|&(x, y, z)| Vector3::new(x as f64 * 33.0, y, z as f64 * 40.0 + 3.0))
            .collect();
        let mut velocities = vec![Vector3::ZERO; positions.len()];
        inflow.sample(time, &positions, &mut velocities);
        for (position, velocity) in positions.iter().zip(velocities) {
            prop_assert_eq!(velocity, wind(&inflow, time, *position));
        }
    }
}
