//! Wakes of rotors that turn at will: what must hold whatever they do.

use crate::fields::FieldSource;
use crate::inflow::{ColumnLevel, MeanColumn, MeanProfile, PrescribedWind};
use crate::vortex::{
    Accuracy, BodyWakes, Cores, FreeWake, MeanShear, Points, Resolution, WakeSettings,
};
use crate::{FlowError, FlowSolver, WindField};
use basis::records::PlaneAxes;
use basis::{BoundVortex, PointForce, Vector3};
use std::f64::consts::TAU;
use std::sync::Arc;

pub(super) const INTERVAL: f64 = 0.2;
const DENSITY: f64 = 1.2;
const N_ELEMENTS: usize = 6;
const WIND: f64 = 8.0;
pub(super) const HUB: Vector3 = Vector3::new(0.0, 0.0, 80.0);

pub(super) fn settings() -> WakeSettings {
    WakeSettings {
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
        air_density: DENSITY,
        accuracy: Accuracy { degree: 3, opening: 0.5 },
        shear: MeanShear::Carries,
        ground: true,
        shown: Points { first: Vector3::new(-45.0, -55.0, 5.0), spacing: 10.0, n: [24, 12, 15] },
        n_blades: 2,
        far_rows_in_all: 120,
        n_elements: N_ELEMENTS,
        threads: Some(1),
    }
}

pub(super) fn wake(settings: WakeSettings) -> FreeWake {
    let profile = MeanProfile::PowerLaw { hub_height: HUB.z, speed: WIND, exponent: 0.1 };
    FreeWake::new(settings, PrescribedWind::everywhere(Arc::new(profile))).expect("sound settings")
}

/// Two blades of 40 m in step number `step`, each element with a circulation of its own.
pub(super) fn forces(step: usize, circulation: f64) -> Vec<PointForce> {
    let middle = |step: usize, blade: usize, station: usize| {
        let angle = TAU * blade as f64 / 2.0 + 0.15 * step as f64;
        let radial = Vector3::new(0.0, -angle.sin(), angle.cos());
        (HUB + radial * (4.0 + 6.0 * (station as f64 + 0.5)), radial * 6.0)
    };
    let nacelle =
        PointForce { disc_radius: Some(2.0), ..PointForce::of_body(HUB, Vector3::X * -300.0, 0.0) };
    let all = (0..2).flat_map(|blade| (0..N_ELEMENTS).map(move |station| (blade, station)));
    all.map(|(blade, station)| {
        let (position, along) = middle(step, blade, station);
        let (position_after, along_after) = middle(step + 1, blade, station);
        let circulation = circulation * (1.0 + 0.1 * station as f64 + 0.02 * (step % 7) as f64);
        let bound = Some(BoundVortex {
            blade,
            station,
            circulation,
            along,
            inner_share: 0.5,
            position_after,
            along_after,
        });
        PointForce { bound, ..PointForce::of_body(position, Vector3::ZERO, 0.0) }
    })
    .chain([nacelle])
    .collect()
}

pub(super) fn advanced(wake: &mut FreeWake, steps: std::ops::Range<usize>) {
    for step in steps {
        wake.advance(INTERVAL, &forces(step, 25.0)).expect("it stays finite");
    }
}

fn samples(wake: &FreeWake) -> Vec<Vector3> {
    let positions: Vec<Vector3> = (0..40)
        .map(|k| HUB + Vector3::new(5.0 * k as f64 - 20.0, 3.0 * (k % 7) as f64, -k as f64))
        .collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    wake.sample(&positions, &mut velocities);
    velocities
}

/// Without circulation the wind alone carries a wake.
#[test]
fn shear_that_is_left_out_does_not_lean_a_wake() {
    let lean = |shear: MeanShear| {
        let mut wake = wake(WakeSettings { bodies: BodyWakes::NONE, shear, ..settings() });
        for step in 0..50 {
            wake.advance(INTERVAL, &forces(step, 0.0)).expect("nothing moves but the wind");
        }
        let spread = |xs: &[f64]| {
            let [least, most] = [f64::min, f64::max].map(|of| xs.iter().copied().reduce(of));
            most.zip(least).map_or(0.0, |(most, least)| most - least)
        };
        // The oldest row of each blade's wake, which was a straight line across the wind.
        wake.sheets
            .iter()
            .map(|sheet| {
                let row = &sheet.far.positions[..sheet.far.n_nodes()];
                let xs: Vec<f64> = row.iter().map(|node| node.x).collect();
                assert!((xs[0] / (WIND * INTERVAL * 50.0) - 1.0).abs() < 0.1, "{xs:?}");
                spread(&xs)
            })
            .fold(0.0, f64::max)
    };
    let profile = MeanProfile::PowerLaw { hub_height: HUB.z, speed: WIND, exponent: 0.1 };
    let left_out = MeanShear::LeftOut { profile, hub_height: HUB.z, veer: 0.0 };
    // 8 m/s over ten seconds; at 120 m the wind is 4 % faster than at the hub.
    assert!(lean(MeanShear::Carries) > 1.0);
    assert!(lean(left_out.clone()) < 1e-9, "{}", lean(left_out));
    // The same mean, taken of a record: linear between heights ten metres apart.
    let level = |k: u32| {
        let height = 10.0 * f64::from(k);
        ColumnLevel { height, wind: [profile.speed(height), 0.0], temperature: 0.0 }
    };
    let column = MeanColumn::new((1..20).map(level).collect()).expect("heights that rise");
    let of_record = lean(MeanShear::LeftOutOf(Arc::new(column)));
    assert!(of_record < 0.05, "{of_record}");
}

#[test]
fn vortices_are_closed() {
    let mut wake = wake(settings());
    for step in 0..120 {
        advanced(&mut wake, step..step + 1);
        let (mut sum, mut whole) = (Vector3::ZERO, 0.0);
        for segment in wake.segments() {
            let strength = segment.circulation * (segment.to - segment.from);
            sum += strength;
            whole += strength.length();
        }
        assert!(sum.length() < 1e-12 * whole, "{step} {sum} of {whole}");
    }
    // The wake has come to its end, and the blades have long passed on what they began with.
    let far = wake.segments().iter().map(|segment| segment.from.x).fold(0.0, f64::max);
    assert!((150.0..170.0).contains(&far), "{far}");
    let of_nacelle = wake.bodies[0].n_rings() * crate::vortex::body::N_SIDES;
    let of_blades = wake.segments().len() - of_nacelle;
    assert!(of_blades < 1500, "{of_blades}");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let mut one = wake(settings());
    let mut three = wake(WakeSettings { threads: Some(3), ..settings() });
    for wake in [&mut one, &mut three] {
        advanced(wake, 0..60);
    }
    assert_eq!(one.segments(), three.segments());
    assert_eq!(samples(&one), samples(&three));
    assert_eq!(one.answer(0), three.answer(0));
}

#[test]
fn a_wake_goes_on_from_what_it_wrote() {
    for n in [0, 1, 7, 60] {
        let mut whole = wake(settings());
        advanced(&mut whole, 0..n);
        let mut bytes = Vec::new();
        whole.write_state(&mut bytes).expect("a sound state");
        let mut other = wake(settings());
        other.read_state(&mut bytes.as_slice()).expect("what was written");
        assert_eq!(samples(&other), samples(&whole));
        assert_eq!(other.answer(0), whole.answer(0));
        for wake in [&mut whole, &mut other] {
            advanced(wake, n..n + 15);
        }
        assert_eq!(other.segments(), whole.segments());
        let mut again = [Vec::new(), Vec::new()];
        whole.write_state(&mut again[0]).expect("a sound state");
        other.write_state(&mut again[1]).expect("a sound state");
        assert!(again[0] == again[1] && again[0] != bytes);
        assert!(other.read_state(&mut &bytes[..bytes.len() - 1]).is_err());
        bytes[0] = b'x';
        let error = other.read_state(&mut bytes.as_slice()).expect_err("no state");
        assert_eq!(error.to_string(), "this is no state of a free wake");
    }
}

#[test]
fn the_wind_answers_as_it_is_said_to() {
    // Images answer too, too little to be told of: the ground is as far away as the blades are long.
    for ground in [false, true] {
        answers_as_it_is_said_to(wake(WakeSettings { ground, ..settings() }));
    }
}

fn answers_as_it_is_said_to(mut wake: FreeWake) {
    advanced(&mut wake, 0..30);
    let answer = wake.answer(0).expect("it has met the rotor");
    let n = 2 * N_ELEMENTS;
    let change: Vec<f64> = (0..n).map(|k| 3.0 - 0.7 * k as f64).collect();
    let expected: Vec<Vector3> = (0..n)
        .map(|i| {
            let row = &answer.influence[i * n..(i + 1) * n];
            row.iter().zip(&change).map(|(velocity, change)| *velocity * *change).sum()
        })
        .collect();
    let circulations: Vec<f64> =
        answer.circulations.iter().zip(&change).map(|(now, change)| now + change).collect();
    let stations: Vec<Vector3> = forces(30, 1.0).iter().map(|force| force.position).collect();
    let sampled = |wake: &FreeWake| {
        let mut velocities = vec![Vector3::ZERO; n];
        wake.sample(&stations, &mut velocities);
        velocities
    };
    let before = sampled(&wake);
    for (blade, sheet) in wake.sheets.iter_mut().enumerate() {
        sheet.release(&circulations[blade * N_ELEMENTS..(blade + 1) * N_ELEMENTS]);
    }
    wake.gather(false);
    for ((before, after), expected) in before.iter().zip(sampled(&wake)).zip(expected) {
        let answered = after - *before;
        // Cores grow with circulation, of which the answer knows that of before; the rest is rounding.
        assert!(
            (answered - expected).length() < 2e-3 * (1.0 + expected.length()),
            "{answered} {expected}"
        );
    }
}

#[test]
fn the_air_does_not_pass_the_ground() {
    let mut over_ground = wake(settings());
    advanced(&mut over_ground, 0..40);
    let positions: Vec<Vector3> =
        (0..20).map(|k| Vector3::new(5.0 * k as f64, 4.0 * k as f64 - 30.0, 0.0)).collect();
    let mut velocities = vec![Vector3::ZERO; 20];
    over_ground.sample(&positions, &mut velocities);
    assert!(velocities.iter().all(|velocity| velocity.z.abs() < 1e-12));
    let mut free = wake(WakeSettings { ground: false, ..settings() });
    advanced(&mut free, 0..40);
    free.sample(&positions, &mut velocities);
    assert!(velocities.iter().any(|velocity| velocity.z.abs() > 1e-3));
}

#[test]
fn a_rotor_that_holds_the_wind_back_makes_a_wake() {
    let mut wake = wake(settings());
    advanced(&mut wake, 0..80);
    let mut velocities = [Vector3::ZERO; 2];
    let at = |y: f64| HUB + Vector3::new(40.0, y, 0.0);
    wake.sample(&[at(20.0), at(80.0)], &mut velocities);
    assert!(velocities[0].x < 0.9 * WIND && velocities[1].x > 0.98 * WIND, "{velocities:?}");
}

#[test]
fn planes_and_volumes_show_the_wind_at_their_points() {
    // Every vortex one by one: which boxes are far depends on the places that are asked for together.
    let accuracy = Accuracy { opening: 0.0, ..settings().accuracy };
    let mut wake = wake(WakeSettings { accuracy, ..settings() });
    advanced(&mut wake, 0..30);
    let wind = |position: Vector3| {
        let mut velocity = [Vector3::ZERO];
        wake.sample(&[position], &mut velocity);
        velocity[0]
    };
    // But for what rounding to single precision makes of a place in another group.
    let is_at = |found: [f32; 3], place: Vector3| {
        let found = Vector3::from_array(found.map(f64::from));
        assert!((found - wind(place)).length() < 1e-5 * WIND, "{found} at {place}");
    };
    for (axes, position, index, place) in [
        (PlaneAxes::Horizontal, 80.0, 5 * 24 + 7, Vector3::new(25.0, -5.0, 80.0)),
        (PlaneAxes::Streamwise, 3.0, 9 * 24 + 7, Vector3::new(25.0, 3.0, 95.0)),
        (PlaneAxes::Crosswind, 40.0, 9 * 12 + 5, Vector3::new(40.0, -5.0, 95.0)),
    ] {
        let plane = wake.plane("here", axes, position);
        assert_eq!((plane.spacing, plane.time), ([10.0; 2], wake.time()));
        is_at([0, 1, 2].map(|c| plane.velocity[c][index]), place);
    }
    let volume = wake.volume(2);
    assert_eq!(volume.n_points, [12, 6, 8]);
    let index = (3 * 6 + 2) * 12 + 4;
    let place = volume.origin + 20.0 * Vector3::new(4.0, 2.0, 3.0);
    is_at([0, 1, 2].map(|c| volume.velocity[c][index]), place);
}

#[test]
fn a_wake_that_blows_up_says_when_and_where() {
    let mut wake = wake(settings());
    let error = (0..50).find_map(|step| wake.advance(INTERVAL, &forces(step, 1e6)).err());
    let Some(FlowError::Diverged { time, position, speed }) = error else { panic!("{error:?}") };
    assert!(time < 10.0 && speed > 340.0 && position.is_finite());
    // No step but its own.
    let error = wake.advance(0.3, &[]).expect_err("another step");
    assert_eq!(error, FlowError::FractionalStep { duration: 0.3, step: INTERVAL });
}

#[test]
fn a_rotor_that_turns_too_far_in_a_step_ends_the_run() {
    // As `forces` have it, a step is 0.15 rad: blades of step 0 that end where those of step `n` stand.
    let turning = |n: usize| {
        let (mut now, then) = (forces(0, 25.0), forces(n, 25.0));
        for (force, after) in now.iter_mut().zip(then) {
            let (Some(bound), Some(after_bound)) = (&mut force.bound, after.bound) else {
                continue;
            };
            (bound.position_after, bound.along_after) = (after.position, after_bound.along);
        }
        now
    };
    // Refused at once, it has no wake whose cost could be told.
    let mut none = wake(settings());
    none.advance(INTERVAL, &turning(6)).expect_err("52°");
    none.reach_full_length();
    let mut free = wake(settings());
    assert_eq!(free.advance(INTERVAL, &turning(5)), Ok(()));
    let error = free.advance(INTERVAL, &turning(6)).expect_err("0.9 rad are 52°");
    let FlowError::TurnedTooFar { time, position, turn, most } = error else { panic!("{error}") };
    assert!((time - 2.0 * INTERVAL).abs() < 1e-12 && (turn - 0.9).abs() < 1e-9 && turn > most);
    assert!((position - HUB).length() < 1e-9, "{position}");
    assert!(error.to_string().contains("turned by 52° in the step up to 0.40 s"), "{error}");
}

#[test]
fn settings_that_cannot_be_are_named() {
    let sound = settings();
    let refused = |settings: WakeSettings| settings.check().expect_err("refused").to_string();
    let error = refused(WakeSettings { interval: 0.0, ..sound.clone() });
    assert_eq!(error, "a free wake cannot have step (s) = 0; expected a positive number");
    let accuracy = Accuracy { degree: 3, opening: 1.0 };
    assert!(refused(WakeSettings { accuracy, ..sound.clone() }).contains("less than 1"));
    let resolution = Resolution { far_filaments: 1, ..sound.resolution };
    assert!(refused(WakeSettings { resolution, ..sound.clone() }).contains("two at least"));
    let resolution = Resolution { end: f64::NAN, ..sound.resolution };
    assert!(
        refused(WakeSettings { resolution, ..sound.clone() }).contains("end along x (m) = NaN")
    );
    let cores = Cores { initial_widths: f64::NAN, ..sound.cores };
    assert!(
        refused(WakeSettings { cores, ..sound.clone() })
            .contains("core at birth over widths = NaN")
    );
}
