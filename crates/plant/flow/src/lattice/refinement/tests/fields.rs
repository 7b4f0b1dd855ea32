//! Refined air as others see it.

use super::*;
use crate::fields::FieldSource;
use basis::records::PlaneAxes;

/// An open box of air with gusts, two boxes in it that stand on its rough ground, one in the other.
fn gusty(threads: usize) -> (Refined, [PointForce; 3]) {
    let mut settings =
        LatticeSettings::new(Vector3::new(-40.0, -60.0, 0.0), 10.0, [22, 12, 10], 0.1, 10.0);
    settings.threads = Some(threads);
    settings.ground = Ground::WallStress { roughness_length: 0.05 };
    let mut place = cells([5, 3, 0], [10, 6, 6]);
    place.within.push(cells([4, 3, 0], [9, 6, 7]));
    let air = refined(settings, &[place], |time, x| {
        let phase = 0.05 * (x.x - 10.0 * time);
        let gust = 0.3 * (phase + 0.2 * x.y).sin();
        Vector3::new(10.0 + 0.02 * x.z + phase.sin(), 0.5 * (phase + 0.1 * x.z).cos(), gust)
    });
    let force =
        |x, y| PointForce::of_body(Vector3::new(x, y, 25.0), Vector3::new(-3e4, 2e3, 1e3), 8.0);
    (air, [force(45.0, 0.0), force(90.0, 10.0), force(150.0, -20.0)])
}

/// What others see of the air, as bits.
fn seen(air: &Refined) -> Vec<u64> {
    let positions: Vec<Vector3> = (0..300)
        .map(|k| Vector3::new(0.71, 0.37, 0.3) * f64::from(k) + Vector3::new(-45.0, -55.0, 1.0))
        .collect();
    let mut wind = vec![Vector3::ZERO; positions.len()];
    air.sample(&positions, &mut wind);
    let mut values: Vec<f64> = wind.iter().flat_map(Vector3::to_array).collect();
    values.extend([air.time(), air.mass()].into_iter().chain(air.momentum().to_array()));
    let plane = air.plane("here", PlaneAxes::Streamwise, 3.3);
    let volume = air.volume(2);
    let shown = plane.velocity.iter().chain(&volume.velocity).flatten();
    values.extend(shown.map(|value| f64::from(*value)));
    values.into_iter().map(f64::to_bits).collect()
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let run = |threads| {
        let (mut air, forces) = gusty(threads);
        air.advance(2.3, &forces).expect("no divergence");
        air.advance(1.4, &forces[..1]).expect("no divergence");
        seen(&air)
    };
    let one = run(1);
    for threads in [2, 5] {
        assert!(run(threads) == one, "on {threads} threads");
    }
}

#[test]
fn a_state_read_back_goes_on_with_the_same_bits() {
    for n_steps in [7.0, 12.0] {
        let (mut air, forces) = gusty(2);
        air.advance(0.1 * n_steps, &forces).expect("no divergence");
        let mut bytes = Vec::new();
        air.write_state(&mut bytes).expect("memory takes it");
        let (mut other, _) = gusty(1);
        other.read_state(&mut bytes.as_slice()).expect("a state");
        assert!(seen(&other) == seen(&air), "on reading");
        for air in [&mut air, &mut other] {
            air.advance(0.7, &forces[1..]).expect("no divergence");
        }
        assert!(seen(&other) == seen(&air), "later on");
        let mut base = Vec::new();
        air.grid.lattice.write_state(&mut base).expect("memory takes it");
        base.extend_from_slice(&bytes[bytes.len() / 2..]);
        assert!(other.read_state(&mut base.as_slice()).is_err());
    }
}

#[test]
fn a_state_out_of_step_is_refused() {
    let settings = periodic_box([8, 8, 8], 1e-3);
    let still = || refined(settings.clone(), &[cells([2; 3], [3; 3])], |_, _| Vector3::ZERO);
    let (mut air, mut later) = (still(), still());
    later.advance(1.0, &[]).expect("no divergence");
    let mut bytes = Vec::new();
    later.write_state(&mut bytes).expect("memory takes it");
    bytes[..8].fill(0);
    let error = air.read_state(&mut bytes.as_slice()).expect_err("grids of two times");
    assert!(error.to_string().contains("out of step"), "{error}");
}

#[test]
fn forces_become_momentum_in_every_grid() {
    let mut place = cells([6, 4, 4], [12, 10, 10]);
    place.within.push(cells([5, 5, 5], [12, 10, 10]));
    let settings = periodic_box([32, 18, 18], 1e-3);
    let mut air = refined(settings, &[place], |_, _| Vector3::new(0.05, 0.0, 0.0));
    let force = |x, y, smearing_length| {
        let force = Vector3::new(-0.02, 0.01, 0.005);
        PointForce::of_body(Vector3::new(x, y, 9.1), force, smearing_length)
    };
    // In the inner box, in the outer one and reaching beyond it, and in neither.
    let forces = [force(11.3, 9.2, 0.8), force(5.9, 6.0, 0.3), force(25.2, 8.3, 1.5)];
    let before = air.momentum();
    air.advance(100.0, &forces).expect("no divergence");
    let gained = air.momentum() - before;
    let applied = forces.iter().map(|force| force.force * 100.0).sum::<Vector3>();
    println!("gained {gained}, applied {applied}");
    assert!((gained - applied).length() < 1e-4 * applied.length(), "{gained} for {applied}");
    let held = [1, 1, 1];
    assert_eq!(air.lattices().iter().map(|one| one.forces.len()).collect::<Vec<_>>(), held);
}

#[test]
fn a_linear_wind_is_seen_as_it_is() {
    let wind = |x: Vector3| Vector3::new(0.03 + 1e-3 * x.y, 2e-3 * x.z, 1e-3 * (x.x - x.y));
    let mut place = cells([4, 4, 3], [9, 7, 6]);
    place.within.push(cells([5, 4, 3], [8, 7, 6]));
    let air = refined(periodic_box([20, 16, 14], 1e-3), &[place], move |_, x| wind(x));
    let positions: Vec<Vector3> = (0..400)
        .map(|k| {
            let turn = f64::from(k);
            Vector3::new(
                2.0 + 0.0413 * turn,
                1.5 + (0.37 * turn) % 12.0,
                1.0 + (0.29 * turn) % 11.0,
            )
        })
        .collect();
    let mut seen = vec![Vector3::ZERO; positions.len()];
    air.sample(&positions, &mut seen);
    for (position, seen) in positions.iter().zip(&seen) {
        assert!((*seen - wind(*position)).length() < 1e-7, "{position}: {seen}");
    }
    for (axes, place) in
        [(PlaneAxes::Horizontal, 2.6), (PlaneAxes::Streamwise, 6.2), (PlaneAxes::Crosswind, 12.7)]
    {
        let plane = air.plane("p", axes, place);
        let along = match axes {
            PlaneAxes::Horizontal => [Vector3::X, Vector3::Y],
            PlaneAxes::Streamwise => [Vector3::X, Vector3::Z],
            PlaneAxes::Crosswind => [Vector3::Y, Vector3::Z],
        };
        for index in 0..plane.velocity[0].len() {
            let [a, b] = [index % plane.n_points[0], index / plane.n_points[0]];
            let position =
                Vector3::from_array(plane.origin) + along[0] * a as f64 + along[1] * b as f64;
            let shown = Vector3::from_array(plane.velocity.each_ref().map(|c| f64::from(c[index])));
            assert!((shown - wind(position)).length() < 1e-7, "{axes:?}, {position}: {shown}");
        }
    }
    let volume = air.volume(3);
    let index = 2 + volume.n_points[0] * (2 + volume.n_points[1] * 2);
    let shown = Vector3::from_array(volume.velocity.each_ref().map(|c| f64::from(c[index])));
    assert!((shown - wind(Vector3::splat(6.0))).length() < 1e-7, "{shown}");
}

#[test]
fn a_blow_up_is_noticed_in_its_box() {
    let (mut air, mut forces) = gusty(2);
    forces[1].force *= 1e4;
    let error = air.advance(20.0, &forces).expect_err("no air withstands that");
    assert!(matches!(error, FlowError::Diverged { .. }), "{error}");
}
