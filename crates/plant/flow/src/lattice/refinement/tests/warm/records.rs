//! The same bits on any threads and after a state was read back; memory; what is refused.

use super::*;
use crate::lattice::Backend;

/// An atmosphere with gusts over a rough ground that cools, boxes in it: two in one another on the ground,
/// and one aloft.
fn gusty(threads: usize) -> (Refined, [PointForce; 3]) {
    let mut settings =
        LatticeSettings::new(Vector3::new(-40.0, -70.0, 0.0), 10.0, [28, 14, 14], 0.1, 10.0);
    settings.threads = Some(threads);
    settings.ground = Ground::WallStress { roughness_length: 0.05 };
    settings.atmosphere = Some(Atmosphere {
        coriolis: 1e-4,
        driving: Driving::Geostrophic([10.0, -1.0]),
        temperature: vec![[0.0, 288.0], [70.0, 288.0], [100.0, 290.0], [140.0, 290.2]],
        heating: Heating::Ground { temperature: 286.0, rate: -1e-4 },
        damping: Some(Damping { from: 100.0, rate: 0.01 }),
        perturbation: Some(Perturbation { below: 60.0, amplitude: 0.3, seed: 2 }),
        ..Atmosphere::new(288.0)
    });
    let mut place = cells([5, 3, 0], [10, 8, 9]);
    place.within.push(cells([4, 3, 0], [11, 9, 12]));
    let aloft = cells([20, 4, 5], [4, 5, 6]);
    let air = refined(settings, &[place, aloft], |time, x| {
        let phase = 0.05 * (x.x - 10.0 * time);
        let gust = 0.3 * (phase + 0.2 * x.y).sin();
        Vector3::new(10.0 + 0.02 * x.z + phase.sin(), 0.5 * (phase + 0.1 * x.z).cos(), gust)
    });
    let force =
        |x, y| PointForce::of_body(Vector3::new(x, y, 35.0), Vector3::new(-3e4, 2e3, 1e3), 8.0);
    (air, [force(45.0, 0.0), force(90.0, 10.0), force(190.0, -20.0)])
}

/// Wind and temperature of every cell, and what is sampled, as bits.
fn seen(air: &Refined) -> Vec<u64> {
    let positions: Vec<Vector3> = (0..200)
        .map(|k| Vector3::new(1.21, 0.53, 0.6) * f64::from(k) + Vector3::new(-45.0, -65.0, 1.0))
        .collect();
    let (mut wind, mut warmth) = (vec![Vector3::ZERO; 200], vec![0.0; 200]);
    air.sample(&positions, &mut wind);
    assert!(air.sample_temperature(&positions, &mut warmth));
    let cells = warm_cells(air).into_iter().flat_map(|cell| [cell.temperature, cell.density]);
    let wind = wind.iter().flat_map(Vector3::to_array);
    cells.chain(wind).chain(warmth).map(f64::to_bits).collect()
}

#[test]
fn the_number_of_threads_changes_no_bit_of_warm_boxes() {
    let run = |threads| {
        let (mut air, forces) = gusty(threads);
        air.advance(3.3, &forces).expect("no divergence");
        air.advance(1.4, &forces[..1]).expect("no divergence");
        seen(&air)
    };
    let one = run(1);
    for threads in [2, 5] {
        assert!(run(threads) == one, "on {threads} threads");
    }
}

#[test]
fn warm_boxes_read_back_go_on_with_the_same_bits() {
    // Between steps of the coarse cells, and of those in the outer box, as well.
    for n_steps in [32.0, 33.0, 34.0, 35.0] {
        let (mut air, forces) = gusty(2);
        air.advance(0.025 * n_steps, &forces).expect("no divergence");
        let mut bytes = Vec::new();
        air.write_state(&mut bytes).expect("memory takes it");
        let (mut other, _) = gusty(3);
        other.read_state(&mut bytes.as_slice()).expect("a state");
        assert!(seen(&other) == seen(&air), "on reading, after {n_steps} steps");
        for air in [&mut air, &mut other] {
            air.advance(0.725, &forces[1..]).expect("no divergence");
        }
        assert!(seen(&other) == seen(&air), "later on, after {n_steps} steps");
        assert!(other.read_state(&mut &bytes[..bytes.len() - 1]).is_err());
        let mut short = bytes.clone();
        short[8] ^= 1;
        assert!(other.read_state(&mut short.as_slice()).is_err());
    }
}

#[test]
fn back_ends_agree_on_warm_boxes() {
    let run = |backend| {
        let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [21, 15, 12], 0.1, 8.0);
        (settings.ends, settings.backend) = (Ends::Periodic, Some(backend));
        settings.atmosphere = Some(Atmosphere {
            temperature: vec![[0.0, 290.0], [60.0, 290.0], [120.0, 292.0]],
            ..Atmosphere::new(290.0)
        });
        let mut air = refined(settings, &[cells([4, 4, 0], [9, 7, 6])], |_, x| {
            Vector3::new(6.0 + (0.05 * x.y).sin(), 2.0 * (0.04 * x.x).cos(), (0.06 * x.y).cos())
        });
        air.advance(10.0, &[]).expect("no divergence");
        warm_cells(&air)
    };
    let portable = run(Backend::Portable);
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        for (cell, expected) in run(backend).iter().zip(&portable) {
            let off = cell.temperature - expected.temperature;
            assert!(off.abs() < 1e-4, "{backend:?}, {}: {off} K", cell.centre);
        }
    }
}

#[test]
fn temperature_is_seen_as_it_is() {
    // Linear upwards, so that it is the same on cells of any size.
    let mut settings = periodic_box([20, 16, 16], 1e-4);
    settings.ground = Ground::Slip;
    settings.atmosphere = Some(Atmosphere {
        temperature: vec![[0.0, 290.0], [16.0, 292.0]],
        ..Atmosphere::new(290.0)
    });
    let mut place = cells([4, 4, 3], [9, 8, 9]);
    place.within.push(cells([5, 5, 4], [8, 7, 9]));
    let air = refined(settings.clone(), &[place.clone()], |_, _| Vector3::ZERO);
    let positions: Vec<Vector3> = (0..300)
        .map(|k| Vector3::new(2.0, 2.0, 0.5) + Vector3::new(0.043, 0.031, 0.047) * f64::from(k))
        .collect();
    let mut found = vec![0.0; positions.len()];
    assert!(air.sample_temperature(&positions, &mut found));
    for (position, found) in positions.iter().zip(found) {
        let expected = 290.0 + 0.125 * (position.z + 0.5);
        assert!((found - expected).abs() < 1e-5, "{position}: {found} for {expected}");
    }
    settings.atmosphere = None;
    let dry = refined(settings, &[place], |_, _| Vector3::ZERO);
    assert!(!dry.sample_temperature(&positions, &mut [7.0; 300]));
}

#[test]
fn temperature_between_steps_is_that_of_the_boxes() {
    // After an odd number of their steps, when the cells around are ahead of them.
    let (mut air, forces) = gusty(2);
    air.advance(0.025 * 101.0, &forces).expect("no divergence");
    let grids = air.lattices();
    let told = |grid: &Lattice, place: Vector3| {
        let mut found = [0.0];
        assert!(grid.sample_temperature(&[place], &mut found));
        found[0]
    };
    let mut most: f64 = 0.0;
    for y in [-30.0, 0.0] {
        // The upper side of the outer box, 90 m up: half-way from the last cell under it to the first above.
        let at = |z: f64| Vector3::new(25.0, y + 5.0, z);
        let mut found = [0.0];
        assert!(air.sample_temperature(&[at(90.0)], &mut found));
        // Between the middles of eight cells lies their mean.
        let expected = 0.5 * (told(grids[1], at(85.0)) + told(grids[0], at(95.0)));
        assert!((found[0] - expected).abs() < 1e-5, "{} K for {expected} K", found[0]);
        most = most.max((told(grids[1], at(85.0)) - told(grids[0], at(85.0))).abs());
    }
    println!("the cells around are up to {most:e} K ahead under the box");
    // Half of that is what was wrong.
    assert!(most > 1e-4, "{most} K tells nothing");
}

#[test]
fn statistics_of_a_box_are_those_of_its_own_cells() {
    let linear = |x: Vector3| 290.0 + 0.05 * x.z;
    let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [18, 14, 16], 0.1, 8.0);
    (settings.ends, settings.sides) = (Ends::Periodic, Sides::Periodic);
    settings.atmosphere = Some(Atmosphere {
        temperature: vec![[0.0, 290.0], [160.0, 298.0]],
        ..Atmosphere::new(290.0)
    });
    let begun = || {
        refined(settings.clone(), &[cells([4, 3, 4], [10, 8, 6])], |_, x| Vector3::X * 0.01 * x.z)
    };
    let mut air = begun();
    let levels = |air: &Refined| air.lattices()[1].level_statistics();
    for _ in 0..3 {
        let levels = levels(&air);
        for level in &levels {
            let expected = linear(Vector3::Z * level.height);
            assert!((level.temperature - expected).abs() < 1e-3, "{level:?} for {expected} K");
            // The slope, and with it the heat that goes up unresolved, is the same at the first level and at
            // the last as between them.
            let between = levels[5].subgrid_heat_flux;
            let off = level.subgrid_heat_flux / between - 1.0;
            assert!(between < 0.0 && off.abs() < 0.02, "{level:?} for {between} K m/s");
        }
        air.advance(0.1, &[]).expect("no divergence");
    }
    assert_eq!(levels(&air)[0].height, 42.5);
    // They hang on nothing but the state.
    let mut bytes = Vec::new();
    air.write_state(&mut bytes).expect("memory takes it");
    let mut other = begun();
    other.read_state(&mut bytes.as_slice()).expect("a state");
    assert_eq!(levels(&other), levels(&air));
}

#[test]
fn memory_of_a_warm_box_is_told() {
    for stencil in [Stencil::D3Q19, Stencil::D3Q27] {
        let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [44, 28, 24], 0.1, 8.0);
        (settings.stencil, settings.threads) = (stencil, Some(1));
        settings.ground = Ground::WallStress { roughness_length: 0.05 };
        let held = |settings: &LatticeSettings, boxes: &[Refinement]| {
            refined(settings.clone(), boxes, |_, _| Vector3::X).memory() as f64
        };
        let place = [cells([6, 6, 0], [32, 16, 16])];
        let dry = held(&settings, &place) - held(&settings, &[]);
        let neutral = place[0].exchange_memory(stencil, false) as f64;
        settings.atmosphere = Some(Atmosphere::new(290.0));
        let warm = held(&settings, &place) - held(&settings, &[]);
        let told = place[0].exchange_memory(stencil, true) as f64;
        // Temperature of the cells: seven fields, rows of 64 and a line.
        let more = warm - dry - 28.0 * 80.0 * 32.0 * 32.0;
        println!("{stencil:?}: {more} more, told {}", told - neutral);
        assert!((0.7..1.4).contains(&((told - neutral) / more)), "{told} {neutral} {more}");
    }
}

#[test]
fn warm_boxes_are_checked_with_what_would_do() {
    let settings = LatticeSettings {
        ends: Ends::InletOutlet,
        ground: Ground::Slip,
        atmosphere: Some(Atmosphere::new(300.0)),
        ..periodic_box([18, 14, 12], 1e-4)
    };
    let refusal = |place| match check(&settings, &[place]) {
        Ok(()) => panic!("accepted"),
        Err(error) => error.to_string(),
    };
    assert_eq!(check(&settings, &[cells([3, 3, 0], [5, 5, 5])]), Ok(()));
    let close = refusal(cells([2, 3, 3], [5, 5, 5]));
    assert!(close.contains("along x comes too close") && close.contains("end 3 cells"), "{close}");
    let thin = refusal(cells([4, 4, 0], [5, 5, 2]));
    assert!(thin.contains("covers 2 cells along z, and needs 3"), "{thin}");
    let mut nested = cells([4, 4, 3], [6, 6, 6]);
    nested.within.push(cells([2, 3, 3], [4, 4, 4]));
    assert!(refusal(nested).contains("along x comes too close"));
    let near = [cells([3, 3, 3], [4, 4, 4]), cells([9, 3, 3], [4, 4, 4])];
    let near = check(&settings, &near).expect_err("too near").to_string();
    assert!(near.contains("less than 3 cells apart"), "{near}");
}
