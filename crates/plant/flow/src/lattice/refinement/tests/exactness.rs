//! What must hold to rounding.

use super::*;
use crate::lattice::Link;
use crate::lattice::refinement::paths::{Arrival, Paths};
use std::collections::BTreeSet;

/// Places of a box in a grid of 9 × 8 × 7 cells: wholly inside, on the ground, in a corner of walls, and
/// through a periodic axis.
fn places() -> Vec<(LatticeSettings, Refinement)> {
    let with = |sides, ground| LatticeSettings { sides, ground, ..periodic_box([9, 8, 7], 1e-3) };
    vec![
        (with(Sides::Periodic, Ground::Periodic), cells([2, 2, 2], [3, 2, 3])),
        (with(Sides::Periodic, Ground::Periodic), cells([3, 3, 3], [1, 1, 1])),
        (with(Sides::Periodic, Ground::Slip), cells([2, 2, 0], [4, 3, 2])),
        (with(Sides::Slip, Ground::Slip), cells([2, 5, 0], [4, 3, 3])),
        (with(Sides::Slip, Ground::NoSlip), cells([2, 0, 4], [4, 8, 3])),
        (with(Sides::Periodic, Ground::Periodic), cells([2, 0, 2], [4, 8, 3])),
        (with(Sides::Periodic, Ground::Periodic), cells([0, 0, 2], [9, 8, 3])),
    ]
}

#[test]
fn every_way_is_walked_once() {
    for directions in [&D3Q19::DIRECTIONS[..], &D3Q27::DIRECTIONS[..]] {
        for (settings, place) in places() {
            let paths = Paths::new(place.covered(), [9, 8, 7], &beyond(&settings), directions);
            // As many enter in a step as leave, through as many gates.
            let once = |links: &[Link]| links.iter().collect::<BTreeSet<_>>().len();
            let n = paths.leaving.len();
            let [(first, first_parts), (second, second_parts)] = &paths.entering;
            let (returning, numbers) = &paths.returning;
            let second: Vec<Link> = second.iter().chain(returning).copied().collect();
            assert_eq!((once(&paths.leaving), once(first), once(&second)), (n, n, n), "{place:?}");
            assert_eq!(first.len(), first_parts.len());
            assert_eq!(second.len(), second_parts.len() + numbers.len());
            // What is divided is what enters or passes, eight parts each.
            let n_parts = first_parts.len() + second_parts.len() + paths.passing.len();
            assert_eq!(8 * paths.sources.len(), n_parts);
            let mut sums = vec![[0.0; 4]; paths.sources.len()];
            for part in first_parts.iter().chain(second_parts).chain(&paths.passing) {
                let sum = &mut sums[part.source as usize];
                sum[3] += 1.0;
                sum.iter_mut().zip(part.offset).for_each(|(sum, value)| *sum += value);
            }
            assert!(sums.iter().all(|sum| *sum == [0.0, 0.0, 0.0, 8.0]), "{place:?}");
            // What leaves and passes arrives or returns, each once.
            let mut arrived = [vec![0; n], vec![0; n], vec![0; paths.passing.len()]];
            for arrival in paths.arriving.1.as_flattened() {
                let (which, number) = match arrival {
                    Arrival::First(number) => (0, number),
                    Arrival::Second(number) => (1, number),
                    Arrival::Passing(number) => (2, number),
                };
                arrived[which][*number as usize] += 1;
            }
            numbers.iter().for_each(|number| arrived[0][*number as usize] += 1);
            assert!(arrived.as_slice().concat().iter().all(|count| *count == 1), "{place:?}");
        }
    }
}

#[test]
fn a_uniform_wind_crosses_unchanged() {
    let wind = Vector3::new(0.06, -0.03, 0.02);
    for stencil in [Stencil::D3Q19, Stencil::D3Q27] {
        let mut settings = periodic_box([14, 12, 12], 1e-4);
        (settings.stencil, settings.subgrid) = (stencil, Subgrid::smagorinsky(DEFAULT_SMAGORINSKY));
        let mut place = cells([3, 3, 3], [7, 6, 5]);
        place.within.push(cells([4, 3, 3], [5, 6, 4]));
        let mut air = refined(settings, &[place], move |_, _| wind);
        air.advance(100.0, &[]).expect("no divergence");
        for (centre, velocity, _) in all_cells(&air) {
            assert!((velocity - wind).length() < 2e-6 * wind.length(), "{centre}: {velocity}");
        }
    }
}

/// Air in disorder, boxes within boxes in it.
fn disorder(stencil: Stencil) -> Refined {
    let mut settings = periodic_box([20, 16, 14], 1e-5);
    (settings.stencil, settings.subgrid) = (stencil, Subgrid::smagorinsky(DEFAULT_SMAGORINSKY));
    let mut one = cells([3, 3, 3], [8, 8, 7]);
    one.within.push(cells([4, 5, 3], [8, 7, 6]));
    let other = cells([14, 5, 4], [3, 4, 6]);
    refined(settings, &[one, other], |_, x| {
        let swirl = |a: f64, b: f64| (2.1 * a + 0.9 * b).sin() * (1.3 * b - 0.4 * a).cos();
        Vector3::new(0.03, 0.01, -0.02)
            + 0.04 * Vector3::new(swirl(x.y, x.z), swirl(x.z, x.x), swirl(x.x, x.y))
    })
}

#[test]
fn mass_and_momentum_are_kept() {
    for stencil in [Stencil::D3Q19, Stencil::D3Q27] {
        let mut air = disorder(stencil);
        let (mass, momentum) = (air.mass(), air.momentum());
        air.advance(500.0, &[]).expect("no divergence");
        let lost = air.mass() / mass - 1.0;
        let change = (air.momentum() - momentum).length() / momentum.length();
        println!("{stencil:?}: mass {lost:e}, momentum {change:e}");
        assert!(lost.abs() < 1e-7, "mass changed by {lost:e}");
        assert!(change < 2e-6, "momentum changed by {change:e}");
    }
}

/// The state of `air`, as it is written.
fn state(air: &mut Refined) -> Vec<u8> {
    let mut bytes = Vec::new();
    air.write_state(&mut bytes).expect("a sound state");
    bytes
}

/// A force in each of the grids of [`disorder`].
fn pushes() -> Vec<PointForce> {
    let places = [[12.5, 1.0, 12.0], [4.0, 4.0, 4.0], [7.0, 7.0, 6.0], [15.0, 7.0, 7.0]];
    let push = |place| {
        PointForce::of_body(Vector3::from_array(place), Vector3::new(-2e-3, 1e-3, 0.0), 0.7)
    };
    places.map(push).to_vec()
}

#[test]
fn the_finest_steps_one_by_one_make_the_same_bits() {
    let [mut whole, mut parts] = [0; 2].map(|_| disorder(Stencil::D3Q19));
    assert_eq!(parts.interval(), 0.25);
    whole.advance(6.0, &pushes()).expect("no divergence");
    for step in 0..24 {
        // What is told of a force between two steps of a grid does not change the one under way.
        let forces = pushes();
        parts.advance(0.25, &forces).expect("no divergence");
        assert_eq!(parts.time(), 0.25 * f64::from(step + 1));
    }
    assert!(state(&mut whole) == state(&mut parts));
}

#[test]
fn a_state_between_two_steps_of_the_base_goes_on_to_the_same_bits() {
    for n_steps in 4..8 {
        let mut air = disorder(Stencil::D3Q19);
        air.advance(0.25 * f64::from(n_steps), &pushes()).expect("no divergence");
        let bytes = state(&mut air);
        let mut other = disorder(Stencil::D3Q19);
        other.read_state(&mut bytes.as_slice()).expect("what was written");
        assert_eq!(other.time(), air.time());
        for air in [&mut air, &mut other] {
            air.advance(2.5, &pushes()).expect("no divergence");
        }
        assert!(state(&mut air) == state(&mut other), "{n_steps}");
        assert!(other.read_state(&mut &bytes[..bytes.len() - 4]).is_err());
    }
}

#[test]
fn nobody_sees_air_from_beneath_a_box() {
    // A body in the box holds the air back; beneath the box it goes on as it came.
    let mut settings = periodic_box([30, 12, 12], 1e-5);
    (settings.ends, settings.subgrid) =
        (Ends::InletOutlet, Subgrid::smagorinsky(DEFAULT_SMAGORINSKY));
    let mut air = refined(settings, &[cells([8, 2, 2], [8, 8, 8])], |_, _| Vector3::X * 0.1);
    let force = Vector3::X * -0.04;
    let body = PointForce::of_body(Vector3::new(12.0, 6.0, 6.0), force, 1.5);
    air.advance(200.0, &[body]).expect("no divergence");
    let behind: Vec<Vector3> =
        (0..8).map(|n| Vector3::new(16.0 + 0.5 * f64::from(n), 6.0, 6.0)).collect();
    let winds = [0.0, 0.5, 0.5].map(|duration| {
        air.advance(duration, &[body]).expect("no divergence");
        let mut winds = vec![Vector3::ZERO; behind.len()];
        air.sample(&behind, &mut winds);
        winds
    });
    let [before, between, after] = winds;
    assert!(before[0].x < 0.07, "no wake: {}", before[0]);
    for (between, others) in between.iter().zip(before.iter().zip(&after)) {
        // The wake still grows a little in a step; what is seen on the way lies no further off.
        let of_a_step = (*others.1 - *others.0).length();
        let change = (*between - *others.0).length().max((*between - *others.1).length());
        assert!(of_a_step < 2e-3 * others.0.x, "no steady wake: {} {}", others.0, others.1);
        assert!(change < of_a_step + 1e-4 * others.0.x, "{} {between} {}", others.0, others.1);
    }
}

#[test]
fn a_box_on_a_slippery_ground_keeps_what_can_be_kept() {
    let mut settings = periodic_box([16, 12, 10], 1e-4);
    (settings.ground, settings.subgrid) = (Ground::Slip, Subgrid::smagorinsky(DEFAULT_SMAGORINSKY));
    let mut place = cells([4, 3, 0], [7, 6, 4]);
    place.within.push(cells([4, 3, 0], [5, 6, 3]));
    let mut air = refined(settings, &[place], |_, x| {
        Vector3::new(0.05 + 0.03 * (1.1 * x.z).sin(), 0.03 * (0.7 * x.x).cos(), 0.02 * x.y.sin())
    });
    let (mass, momentum) = (air.mass(), air.momentum());
    air.advance(500.0, &[]).expect("no divergence");
    let lost = air.mass() / mass - 1.0;
    let change = air.momentum() - momentum;
    println!(
        "ground: mass {lost:e}, momentum {:e} {:e}",
        change.x / momentum.x,
        change.y / momentum.x
    );
    assert!(lost.abs() < 1e-7, "mass changed by {lost:e}");
    assert!(change.truncate().length() < 2e-6 * momentum.x, "momentum changed by {change}");
}

#[test]
fn boxes_are_checked_with_what_would_do() {
    let settings = LatticeSettings {
        ends: Ends::InletOutlet,
        sides: Sides::Slip,
        ground: Ground::Slip,
        ..periodic_box([16, 12, 10], 1e-4)
    };
    let refusal = |boxes: &[Refinement]| match Refined::new(
        settings.clone(),
        boxes,
        Arc::new(Wind(|_, _| Vector3::ZERO)),
    ) {
        Ok(_) => panic!("accepted"),
        Err(error) => error.to_string(),
    };
    assert!(refusal(&[cells([0, 3, 3], [4, 3, 3])]).contains("along x comes too close"));
    assert!(refusal(&[cells([3, 1, 3], [4, 3, 3])]).contains("from cell 1 to cell 3 along y"));
    assert!(refusal(&[cells([3, 3, 3], [4, 3, 20])]).contains("the 10 cells around it"));
    assert!(refusal(&[cells([3, 3, 3], [4, 0, 3])]).contains("no cells along y"));
    let apart = [cells([3, 3, 3], [4, 3, 3]), cells([8, 3, 3], [4, 3, 3])];
    assert!(refusal(&apart).contains("number 0 and 1 are less than 2 cells apart"));
    let mut held = settings.clone();
    held.ground = Ground::NoSlip;
    let on_ground = cells([3, 3, 0], [4, 4, 4]);
    assert!(on_ground.check(held.n_cells, &beyond(&held), false).is_err());
    assert_eq!(on_ground.check(settings.n_cells, &beyond(&settings), false), Ok(()));
    let mut place = on_ground;
    place.within.push(cells([2, 2, 1], [2, 2, 2]));
    assert!(refusal(&[place]).contains("along z comes too close"));
}

#[test]
fn a_box_is_found_by_its_corners() {
    let settings = LatticeSettings::new(Vector3::new(-100.0, -50.0, 0.0), 10.0, [30; 3], 0.1, 10.0);
    let (low, high) = (Vector3::new(-42.0, -9.0, -3.0), Vector3::new(21.0, 33.0, 96.0));
    assert_eq!(Refinement::between(&settings, low, high), cells([6, 4, 0], [6, 4, 10]));
}
