//! What must hold to rounding.

use super::*;
use crate::{FlowSolver, WindField};
use basis::PointForce;

/// A sheared, gusty wind in a small open box with a rough ground, and a force in it.
fn gusty(threads: usize, backend: Backend) -> (Lattice, [PointForce; 2]) {
    gusty_on(Stencil::D3Q19, threads, backend)
}

fn gusty_on(stencil: Stencil, threads: usize, backend: Backend) -> (Lattice, [PointForce; 2]) {
    let mut settings =
        LatticeSettings::new(Vector3::new(-40.0, -60.0, 0.0), 10.0, [37, 12, 9], 0.1, 10.0);
    settings.threads = Some(threads);
    settings.backend = Some(backend);
    settings.stencil = stencil;
    settings.ground = Ground::WallStress { roughness_length: 0.05 };
    let air = lattice(settings, |time, x| {
        let phase = 0.05 * (x.x - 10.0 * time);
        Vector3::new(
            10.0 + 0.02 * x.z + phase.sin(),
            0.5 * (phase + 0.1 * x.z).cos(),
            0.3 * (phase + 0.2 * x.y).sin(),
        )
    });
    let force =
        |y| PointForce::of_body(Vector3::new(60.0, y, 45.0), Vector3::new(-3e4, 2e3, 1e3), 20.0);
    (air, [force(-20.0), force(20.0)])
}

/// The wind at many points, as bits.
fn fingerprint(air: &Lattice) -> Vec<[u64; 3]> {
    let positions: Vec<Vector3> = (0..300)
        .map(|i| {
            Vector3::new(
                -40.0 + f64::from(i),
                -60.0 + f64::from(i * 7 % 120),
                f64::from(i * 13 % 90),
            )
        })
        .collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    air.sample(&positions, &mut velocities);
    velocities.iter().map(|v| v.to_array().map(f64::to_bits)).collect()
}

#[test]
fn a_free_stream_stays_one() {
    for (ends, sides) in [(Ends::InletOutlet, Sides::Slip), (Ends::InletOutlet, Sides::Periodic)] {
        let mut settings = LatticeSettings::new(Vector3::ZERO, 10.0, [37, 12, 9], 0.1, 10.0);
        settings.threads = Some(2);
        (settings.ends, settings.sides) = (ends, sides);
        let wind = Vector3::new(10.0, 0.0, 0.0);
        let mut air = lattice(settings, move |_, _| wind);
        air.advance(200.0, &[]).expect("no divergence");
        let positions = [
            Vector3::new(5.0, 60.0, 40.0),
            Vector3::new(200.0, 5.0, 5.0),
            Vector3::new(365.0, 115.0, 85.0),
        ];
        let mut velocities = [Vector3::ZERO; 3];
        air.sample(&positions, &mut velocities);
        for velocity in velocities {
            assert!((velocity - wind).length() < 1e-5 * wind.length(), "{velocity}");
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        for stencil in [Stencil::D3Q19, Stencil::D3Q27] {
            let run = |threads| {
                let (mut air, forces) = gusty_on(stencil, threads, backend);
                air.advance(2.3, &forces).expect("no divergence");
                air.advance(1.4, &forces[..1]).expect("no divergence");
                fingerprint(&air)
            };
            let one = run(1);
            for threads in [2, 3, 7] {
                assert!(run(threads) == one, "{stencil:?} {backend:?} on {threads} threads");
            }
        }
    }
}

#[test]
fn back_ends_agree_to_rounding() {
    for stencil in [Stencil::D3Q19, Stencil::D3Q27] {
        let run = |backend| {
            let (mut air, forces) = gusty_on(stencil, 2, backend);
            air.advance(5.0, &forces).expect("no divergence");
            fingerprint(&air)
        };
        let portable = run(Backend::Portable);
        for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
            for (value, expected) in run(backend).as_flattened().iter().zip(portable.as_flattened())
            {
                let difference = f64::from_bits(*value) - f64::from_bits(*expected);
                // Single precision carries 10 m/s in steps of 1e-6; fifty steps of a gusty wind double it a
                // few times.
                assert!(difference.abs() < 1e-4, "{backend:?} is {difference} m/s off");
            }
        }
    }
}

#[test]
fn mass_stays() {
    let mut settings = periodic_box([16, 16, 16], 1e-8);
    settings.subgrid = Subgrid::smagorinsky(DEFAULT_SMAGORINSKY);
    let k = std::f64::consts::TAU / 16.0;
    let mut air = lattice(settings, move |_, x| {
        Vector3::new(0.05 + 0.04 * (k * x.y).sin(), 0.04 * (k * x.z).sin(), 0.04 * (k * x.x).sin())
    });
    let before = air.mass();
    air.advance(10_000.0, &[]).expect("no divergence");
    let drift = air.mass() / before - 1.0;
    println!("{drift:e}");
    assert!(drift.abs() < 1e-6, "mass drifted by {drift:e}");
}

#[test]
fn forces_become_momentum() {
    let mut air = lattice(periodic_box([24, 20, 18], 1e-3), |_, _| Vector3::new(0.05, 0.0, 0.0));
    let before = air.momentum();
    let position = Vector3::new(10.3, 9.7, 8.1);
    let force = PointForce::of_body(position, Vector3::new(-0.02, 0.01, 0.005), 2.0);
    air.advance(200.0, &[force]).expect("no divergence");
    let gained = air.momentum() - before;
    let applied = force.force * 200.0;
    println!("{gained} {applied}");
    assert!(
        (gained - applied).length() < 1e-4 * applied.length(),
        "gained {gained}, applied {applied}"
    );
}

#[test]
fn steps_are_whole() {
    let (mut air, _) = gusty(1, Backend::Portable);
    assert!(matches!(air.advance(0.15, &[]), Err(crate::FlowError::FractionalStep { .. })));
    assert!(matches!(air.advance(f64::NAN, &[]), Err(crate::FlowError::FractionalStep { .. })));
    assert!(air.advance(0.3, &[]).is_ok());
    assert_eq!(air.n_steps(), 3);
}

#[test]
fn a_blow_up_is_noticed_with_its_place() {
    let (mut air, mut forces) = gusty(2, Backend::detect());
    forces[0].force *= 1e4;
    let error = air.advance(60.0, &forces).expect_err("no air withstands that");
    let crate::FlowError::Diverged { time, position, .. } = error else { panic!("{error}") };
    assert!(time > 0.0 && time < 60.0);
    assert!(position.x > -40.0 && position.x < 330.0 && position.z > 0.0 && position.z < 90.0);
}

#[test]
fn a_state_read_back_goes_on_with_the_same_bits() {
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        for steps in [17.0, 22.0] {
            let (mut air, forces) = gusty(2, backend);
            air.advance(0.1 * steps, &forces).expect("no divergence");
            let mut bytes = Vec::new();
            air.write_state(&mut bytes).expect("memory takes it");
            let (mut other, _) = gusty(3, backend);
            other.advance(0.4, &[]).expect("no divergence");
            other.read_state(&mut bytes.as_slice()).expect("a state");
            assert_eq!(other.n_steps(), air.n_steps());
            assert!(fingerprint(&other) == fingerprint(&air), "{backend:?}: on reading");
            for (forces, duration) in [(&forces[1..], 0.7), (&forces[..], 0.8)] {
                air.advance(duration, forces).expect("no divergence");
                other.advance(duration, forces).expect("no divergence");
            }
            assert!(fingerprint(&other) == fingerprint(&air), "{backend:?}: later on");
        }
    }
}

#[test]
fn a_foreign_state_is_refused() {
    let (mut air, _) = gusty(1, Backend::Portable);
    assert!(air.read_state(&mut &b"not a state at all"[..]).is_err());
    let mut bytes = Vec::new();
    lattice(periodic_box([8, 8, 8], 0.01), |_, _| Vector3::ZERO)
        .write_state(&mut bytes)
        .expect("memory takes it");
    let error = air.read_state(&mut bytes.as_slice()).expect_err("another grid");
    assert!(error.to_string().contains("cells along x 8"), "{error}");
    let mut whole = Vec::new();
    air.write_state(&mut whole).expect("memory takes it");
    assert!(air.read_state(&mut &whole[..whole.len() - 1]).is_err());
}

#[test]
fn planes_and_volumes_show_what_sampling_gives() {
    use basis::records::PlaneAxes;
    let (mut air, forces) = gusty(2, Backend::detect());
    for duration in [2.0, 0.1] {
        air.advance(duration, &forces).expect("no divergence");
        for (axes, position) in [
            (PlaneAxes::Horizontal, 41.0),
            (PlaneAxes::Streamwise, -7.0),
            (PlaneAxes::Crosswind, 66.0),
        ] {
            let plane = air.plane("p", axes, position);
            let mut average = PlaneAverage::new(&air, "p", axes, position);
            average.add(&air);
            assert_eq!(average.mean().velocity, plane.velocity);
            for index in 0..plane.velocity[0].len() {
                let [a, b] = [index % plane.n_points[0], index / plane.n_points[0]]
                    .iter()
                    .zip(plane.spacing)
                    .map(|(count, spacing)| *count as f64 * spacing)
                    .collect::<Vec<_>>()[..]
                else {
                    unreachable!()
                };
                let offset = match axes {
                    PlaneAxes::Horizontal => Vector3::new(a, b, 0.0),
                    PlaneAxes::Streamwise => Vector3::new(a, 0.0, b),
                    PlaneAxes::Crosswind => Vector3::new(0.0, a, b),
                };
                let mut velocity = [Vector3::ZERO];
                air.sample(&[Vector3::from_array(plane.origin) + offset], &mut velocity);
                let shown =
                    Vector3::from_array(plane.velocity.each_ref().map(|c| f64::from(c[index])));
                assert!(
                    (shown - velocity[0]).length() < 1e-4,
                    "{axes:?} {index}: {shown} {}",
                    velocity[0]
                );
            }
        }
        let volume = air.volume(3);
        assert_eq!(volume.n_points, [13, 4, 3]);
        let mut velocity = [Vector3::ZERO];
        air.sample(&[volume.origin + volume.spacing * Vector3::new(5.0, 2.0, 1.0)], &mut velocity);
        let index = 5 + 13 * (2 + 4);
        let shown = Vector3::from_array(volume.velocity.each_ref().map(|c| f64::from(c[index])));
        assert!((shown - velocity[0]).length() < 1e-4);
    }
}

#[test]
fn assumptions_are_checked_with_what_would_do() {
    let sound = LatticeSettings::new(Vector3::ZERO, 10.0, [16, 16, 16], 0.1, 10.0);
    assert_eq!(sound.check(), Ok(()));
    let refusal = |change: fn(&mut LatticeSettings)| {
        let mut settings = sound.clone();
        change(&mut settings);
        match Lattice::new(settings, Arc::new(Wind(|_, _| Vector3::ZERO))) {
            Ok(_) => panic!("accepted"),
            Err(error) => error.to_string(),
        }
    };
    assert!(refusal(|s| s.interval = 0.2).contains("at most 0.1500 s"));
    assert!(refusal(|s| s.spacing = -1.0).contains("spacing"));
    assert!(refusal(|s| s.n_cells[0] = 3).contains("along x"));
    assert!(refusal(|s| s.kinematic_viscosity = 600.0).contains("viscosity"));
    assert!(refusal(|s| s.ground = Ground::WallStress { roughness_length: 4.0 }).contains("1.839"));
    assert!(refusal(|s| s.threads = Some(0)).contains("thread"));
    assert!(refusal(|s| s.n_cells = [100_000; 3]).contains("memory"));
}
