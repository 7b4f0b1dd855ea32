//! Tests of prescribed wind: planes against the record they come from.

use super::*;
use crate::inflow::deterministic::{Change, Event};
use crate::inflow::planes::BoxPlanes;
use crate::inflow::{DeterministicWind, MeanProfile, TurbulenceBox};
use proptest::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

const SPEED: f64 = 8.0;
const SPACING: [f64; 3] = [4.0, 10.0, 12.0];

/// A box in which every value is another one.
fn turbulence(n_points: [usize; 3]) -> Arc<TurbulenceBox> {
    let n: usize = n_points.iter().product();
    let values =
        |component: usize| (0..n).map(|n| ((37 * n + 11 * component) as f32 * 0.7).sin()).collect();
    Arc::new(TurbulenceBox::new(n_points, SPACING, std::array::from_fn(values)).unwrap())
}

fn profile() -> MeanProfile {
    MeanProfile::PowerLaw { hub_height: 40.0, speed: SPEED, exponent: 0.2 }
}

fn planes(repeats: bool) -> BoxPlanesOf {
    let inner = BoxPlanes::new(turbulence([32, 5, 6]), &profile(), 10.0).unwrap();
    BoxPlanesOf { inner, repeats, n_read: Arc::default() }
}

/// Planes that count how often they are read.
struct BoxPlanesOf {
    inner: BoxPlanes,
    repeats: bool,
    n_read: Arc<AtomicUsize>,
}

impl Planes for BoxPlanesOf {
    fn grid(&self) -> PlaneGrid {
        PlaneGrid { repeats: self.repeats, ..self.inner.grid() }
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        self.n_read.fetch_add(1, Ordering::Relaxed);
        self.inner.read(step, values)
    }
}

fn placement(extent: [f64; 2]) -> Placement {
    Placement { origin_x: 0.0, shift_y: 0.0, extent }
}

fn wind_at(wind: &PrescribedWind, position: Vector3) -> Vector3 {
    let mut velocity = [Vector3::ZERO];
    wind.sample(&[position], &mut velocity);
    velocity[0]
}

fn wind(extent: [f64; 2]) -> PrescribedWind {
    PrescribedWind::over_planes(Box::new(planes(true)), placement(extent)).unwrap()
}

/// The mean turns over height as the closed form has it, the fluctuations stay what they are.
#[test]
fn planes_veer_like_the_wind_without_turbulence() {
    let veer = 2e-3;
    let mean = DeterministicWind { veer, ..DeterministicWind::steady(profile(), 40.0) };
    let [mut straight, mut veering] =
        [(); 2].map(|()| BoxPlanes::new(turbulence([32, 5, 6]), &profile(), 10.0).unwrap());
    veering = veering.veering(veer, 40.0);
    let mut values = [[[0.0; 3]; 30]; 2];
    straight.read(7, &mut values[0]).unwrap();
    veering.read(7, &mut values[1]).unwrap();
    for (point, (before, after)) in values[0].iter().zip(&values[1]).enumerate() {
        let place = Vector3::new(0.0, 0.0, 10.0 + (point / 5) as f64 * 12.0);
        let turned = mean.wind(0.0, place) - Vector3::X * profile().speed(place.z);
        for (axis, turned) in turned.to_array().into_iter().enumerate() {
            assert!((f64::from(after[axis] - before[axis]) - turned).abs() < 2e-6);
        }
    }
}

/// Time runs against x: at time t plane (n − t/Δt) mod n of the box stands at x = 0, on top of the profile.
#[test]
fn points_of_the_box_are_met_in_order_of_arrival() {
    let turbulence = turbulence([32, 5, 6]);
    let mut wind = wind([-8.0, 8.0]);
    for step in 0..80 {
        let x = (64 + 32 - step % 32) % 32;
        for (y, z) in [(0, 0), (4, 5), (2, 3)] {
            let place = Vector3::new(0.0, (y as f64 - 2.0) * 10.0, 10.0 + z as f64 * 12.0);
            let [u, v, w] = [0, 1, 2].map(|c| f64::from(turbulence.at(c, [x, y, z])));
            let expected = Vector3::new(profile().speed(place.z) + u, v, w);
            assert!((wind_at(&wind, place) - expected).length() < 2e-6, "{step} {y} {z}");
        }
        wind.advance(0.5, &[]).unwrap();
    }
}

/// What is upwind by U t arrives at time t, and half-way between two points is their mean.
#[test]
fn travels_with_the_hub_speed_and_is_linear_between_points() {
    let mut wind = wind([-16.0, 16.0]);
    let upwind = wind_at(&wind, Vector3::new(-8.0, 3.0, 33.0));
    let ends = [-4.0, 0.0].map(|x| wind_at(&wind, Vector3::new(x, 0.0, 34.0)));
    let middle = wind_at(&wind, Vector3::new(-2.0, 0.0, 34.0));
    assert!((middle - 0.5 * (ends[0] + ends[1])).length() < 1e-6);
    for _ in 0..10 {
        wind.advance(0.1, &[]).unwrap();
    }
    assert!((wind_at(&wind, Vector3::new(0.0, 3.0, 33.0)) - upwind).length() < 1e-5);
    assert!(!wind.resolves_induction());
}

#[test]
fn reads_each_plane_once_and_holds_few() {
    let planes = planes(true);
    let n_read = planes.n_read.clone();
    let mut wind = PrescribedWind::over_planes(Box::new(planes), placement([-4.0, 4.0])).unwrap();
    let at_start = n_read.load(Ordering::Relaxed);
    assert!(at_start <= 8, "{at_start}");
    for _ in 0..1000 {
        wind.advance(0.05, &[]).unwrap();
    }
    // 50 s of planes half a second apart.
    assert_eq!(n_read.load(Ordering::Relaxed) - at_start, 100);
}

#[test]
fn goes_on_from_a_state_with_the_same_bits() {
    let mut one = wind([-20.0, 30.0]);
    for _ in 0..333 {
        one.advance(0.03, &[]).unwrap();
    }
    let mut two = wind([-20.0, 30.0]);
    two.restore(one.state()).unwrap();
    for _ in 0..50 {
        one.advance(0.03, &[]).unwrap();
        two.advance(0.03, &[]).unwrap();
        let place = Vector3::new(7.0, -13.0, 41.0);
        assert_eq!(wind_at(&one, place), wind_at(&two, place));
    }
    assert_eq!(one.time(), 383.0 * 0.03);
}

#[test]
fn a_record_that_does_not_repeat_ends_with_an_error() {
    let mut wind =
        PrescribedWind::over_planes(Box::new(planes(false)), placement([0.0, 0.0])).unwrap();
    // 32 planes half a second apart reach 15.5 s.
    let rotor = [Vector3::new(0.0, -15.0, 10.0), Vector3::new(0.0, 15.0, 60.0)];
    assert_eq!(wind.covers(rotor[0], rotor[1], 15.5), Ok(()));
    let error = wind.covers(rotor[0], rotor[1], 16.0).unwrap_err();
    assert_eq!(error, InflowError::Ended { length: 15.5, time: 16.0 });
    for _ in 0..31 {
        wind.advance(0.5, &[]).unwrap();
    }
    let error = wind.advance(0.5, &[]).unwrap_err();
    assert!(error.to_string().contains("does not repeat"), "{error}");
    // Nothing has moved.
    assert_eq!(wind.time(), 15.5);
}

#[test]
fn places_outside_the_grid_are_named_beforehand() {
    let wind = wind([0.0, 0.0]);
    let low = Vector3::new(0.0, -20.0, 0.0);
    assert_eq!(wind.covers(low, Vector3::new(0.0, 20.0, 70.0), 1e6), Ok(()));
    let error = wind.covers(low, Vector3::new(0.0, 20.0, 95.0), 1e6).unwrap_err();
    assert!(error.to_string().contains("z 95.0 m, outside its grid"), "{error}");
    assert!(wind.covers(Vector3::new(0.0, -21.0, 0.0), low, 0.0).is_err());
    // In the run the edge's wind stands in.
    let (edge, beyond) = (Vector3::new(0.0, 20.0, 70.0), Vector3::new(0.0, 300.0, 900.0));
    assert_eq!(wind_at(&wind, edge), wind_at(&wind, beyond));
    let moved = Placement { shift_y: 100.0, ..placement([0.0, 0.0]) };
    let moved = PrescribedWind::over_planes(Box::new(planes(true)), moved).unwrap();
    let (here, there) = (Vector3::new(0.0, 3.0, 40.0), Vector3::new(0.0, 103.0, 40.0));
    assert!((wind_at(&wind, here) - wind_at(&moved, there)).length() < 1e-6);
}

#[test]
fn a_wind_known_everywhere_moves_on_in_time() {
    let event = Event::Everywhere(Change::Step { start: 1.0, speed: 12.0 });
    let step = DeterministicWind { event, ..DeterministicWind::steady(profile(), 40.0) };
    let mut wind = PrescribedWind::everywhere(Arc::new(step));
    let hub = Vector3::new(0.0, 0.0, 40.0);
    assert_eq!(wind_at(&wind, hub).x, SPEED);
    for _ in 0..10 {
        wind.advance(0.1, &[]).unwrap();
    }
    assert!((wind_at(&wind, hub).x - 12.0).abs() < 1e-12);
    assert_eq!(wind.covers(hub, hub, 1e9), Ok(()));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    /// However time is cut into steps, and whatever is held, the wind is that of a window opened afresh.
    #[test]
    fn does_not_depend_on_the_way_there(
        steps in prop::collection::vec(0.001..3.0_f64, 1..40), x in -30.0..60.0_f64, y in -20.0..20.0_f64,
        z in 10.0..70.0_f64,
    ) {
        let mut walked = wind([-30.0, 60.0]);
        for step in steps {
            walked.advance(step, &[]).unwrap();
        }
        let mut fresh = wind([-30.0, 60.0]);
        fresh.restore(walked.state()).unwrap();
        let place = Vector3::new(x, y, z);
        prop_assert_eq!(wind_at(&walked, place), wind_at(&fresh, place));
        prop_assert!(wind_at(&walked, place).is_finite());
    }
}
