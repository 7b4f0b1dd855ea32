//! Forces and moments inside against the momentum of everything outboard, differenced from positions alone.

use super::samples::*;
use crate::definition::Definition;
use crate::structure::{
    AppliedLoads, DegreeOfFreedom, ElementLoad, Pitch, Structure, StructureSettings, Wrench, Yaw,
};
use basis::Vector3;

const STEP: f64 = 2e-3;

/// Mass (kg) and position (m) of every mass point: first those of each blade, then hub and nacelle, then the
/// rest.
fn points(structure: &Structure, pitch: &[Pitch]) -> Vec<(f64, Vector3)> {
    let machine = &structure.machine;
    let (q, v) = (&structure.state().coordinates, &structure.state().velocities);
    let motion = machine.motion(q, v, pitch);
    let mut points = Vec::new();
    for blade in 0..machine.n_blades {
        let frame = &motion.blades[blade];
        points.extend(machine.blade.points.iter().map(|point| {
            (point.mass, frame.origin + frame.axes * point.place.at(&q.blades[blade]).0)
        }));
    }
    points.push((machine.hub_mass, motion.hub.origin));
    points.push((machine.nacelle_mass, motion.nacelle.origin));
    points.push((machine.yaw_bearing_mass, motion.top.origin));
    points.extend(
        machine
            .tower
            .points
            .iter()
            .map(|point| (point.mass, machine.base + point.place.at(&q.tower()).0)),
    );
    points
}

/// What gravity and inertia of `range` of the points do about `centre`, from their positions at three
/// instants.
fn wrench(
    history: &[Vec<(f64, Vector3)>],
    range: std::ops::Range<usize>,
    centre: Vector3,
) -> Wrench {
    let mut sum = Wrench::default();
    for index in range {
        let [before, now, after] = [0, 1, 2].map(|instant: usize| history[instant][index].1);
        let acceleration = (after - 2.0 * now + before) / (STEP * STEP);
        let force = (Vector3::Z * -crate::structure::GRAVITY - acceleration) * history[1][index].0;
        sum.add(Wrench { force, moment: (now - centre).cross(force) });
    }
    sum
}

/// Point masses only: bodies without inertia of their own.
fn of_points(mut definition: Definition) -> Definition {
    let nacelle = &mut definition.nacelle;
    nacelle.yaw_inertia = nacelle.mass * nacelle.center_of_mass.truncate().length_squared();
    definition.hub.inertia = 0.0;
    definition.drive_train.generator_inertia = 0.0;
    definition
}

/// A nacelle that turns at a rate that grows: its turn at `time` (s).
fn turning(time: f64) -> Yaw {
    let (rate, acceleration) = (0.03, 0.01);
    let growth = 0.5 * acceleration * time;
    Yaw { angle: 0.2 + (rate + growth) * time, rate: rate + 2.0 * growth, acceleration }
}

/// What turns the nacelle shows in the loads of all that it carries, gyroscopic moments of the rotor
/// included: tower base and yaw bearing against the momentum of everything above.
#[test]
fn loads_of_a_turning_nacelle_are_the_rate_of_momentum_too() {
    for text in [NREL_5, IEA_15] {
        let definition = of_points(published(text));
        let settings = StructureSettings {
            rotor_speed: definition.rated_rotor_speed,
            yaw: 0.2,
            azimuth: 0.5,
            ..StructureSettings::AT_REST
        };
        let mut structure = structure(&definition, &settings);
        structure.hold(&[DegreeOfFreedom::DriveTrain]);
        let pitch = [Pitch { angle: 0.05, ..Pitch::default() }; 3];
        let n_steps = 1000;
        let push = Vector3::new(1e6, 1e5, 0.0);
        let applied = AppliedLoads { nacelle: push, ..AppliedLoads::NONE };
        let (mut history, mut loads, mut axes) = (Vec::new(), Vec::new(), Vec::new());
        for step in 0..n_steps {
            let time = f64::from(step) * STEP;
            structure.turn(turning(time + 0.5 * STEP));
            structure.advance(STEP, &applied, &pitch);
            structure.turn(turning(time + STEP));
            if step >= n_steps - 3 {
                let (machine, state) = (&structure.machine, structure.state());
                let motion = machine.motion(&state.coordinates, &state.velocities, &pitch);
                axes.push(motion.top.axes);
                history.push(points(&structure, &pitch));
                loads.push(*structure.loads());
            }
        }
        // Middles of the last two steps, on either side of the instant in the middle of the history.
        let mean = |of: fn(&crate::structure::Loads) -> Wrench| {
            let [a, b] = [of(&loads[1]), of(&loads[2])];
            Wrench { force: 0.5 * (a.force + b.force), moment: 0.5 * (a.moment + b.moment) }
        };
        // What is pushed is the nacelle at the rotor apex, where the hub is.
        let n_rotor = 3 * structure.machine.blade.points.len() + 1;
        let [hub, top] = [n_rotor - 1, n_rotor + 1].map(|point| history[1][point].1);
        let expected = |n_points: usize, centre: Vector3| {
            let mut sum = wrench(&history, 0..n_points, centre);
            sum.add(Wrench { force: push, moment: (hub - centre).cross(push) });
            sum
        };
        let near = |found: Wrench, expected: Wrench, what: &str| {
            let force = (found.force - expected.force).length() / expected.force.length();
            let moment = (found.moment - expected.moment).length() / expected.moment.length();
            assert!(force < 2e-4 && moment < 5e-4, "{what}: {force} {moment}");
        };
        let base = structure.machine.base;
        near(mean(|l| l.tower_base), expected(history[0].len(), base), "tower base");
        let above = expected(n_rotor + 1, top).turned(&axes[1].transpose());
        near(mean(|l| l.yaw_bearing), above, "yaw bearing");
        // With nothing that bends, what turns with the nacelle is a gyroscope.
        let all = DegreeOfFreedom::ALL.into_iter();
        let modes: Vec<_> = all.filter(|degree| *degree != DegreeOfFreedom::Generator).collect();
        structure.hold(&modes);
        let angle = turning(f64::from(n_steps) * STEP).angle;
        let moment = |rate: f64| {
            let mut structure = structure.clone();
            structure.turn(Yaw { angle, rate, acceleration: 0.0 });
            structure.advance(STEP, &applied, &pitch);
            structure.loads().yaw_bearing.moment
        };
        let rate = 0.05;
        let spin = definition.rotor_inertia() * structure.rotor_speed();
        let expected = -2.0 * rate * spin * definition.rotor.shaft_tilt.cos();
        let lateral = Vector3::new(-angle.sin(), angle.cos(), 0.0);
        let found = (moment(rate) - moment(-rate)).dot(lateral);
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }
}

#[test]
fn loads_are_the_rate_of_momentum_outboard() {
    for text in [NREL_5, IEA_15] {
        let definition = of_points(published(text));
        let spans: Vec<f64> =
            [0.3, 0.6, 0.9].iter().map(|share| share * definition.rotor.tip_radius).collect();
        let settings = StructureSettings {
            rotor_speed: definition.rated_rotor_speed,
            yaw: 0.2,
            spans: &spans,
            position: Vector3::new(30.0, -20.0, 0.0),
            azimuth: 0.5,
            ..StructureSettings::AT_REST
        };
        let mut structure = structure(&definition, &settings);
        // With no generator to turn against, the shaft has no torsion.
        structure.hold(&[DegreeOfFreedom::DriveTrain]);
        let loads: Vec<ElementLoad> = (0..9)
            .map(|k| ElementLoad {
                force: Vector3::new(4e4, 5e3 * f64::from(k % 4), -2e3 * f64::from(k)),
                moment: Vector3::ZERO,
            })
            .collect();
        let applied = AppliedLoads { elements: &loads, ..AppliedLoads::NONE };
        let pitch = [0.05, 0.1, 0.0].map(|angle| Pitch { angle, ..Pitch::default() });
        (0..1500).for_each(|_| structure.advance(STEP, &applied, &pitch));
        let mut history = vec![points(&structure, &pitch)];
        structure.advance(STEP, &applied, &pitch);
        let first = *structure.loads();
        history.push(points(&structure, &pitch));
        let machine = structure.machine.clone();
        let state = structure.state();
        let motion = machine.motion(&state.coordinates, &state.velocities, &pitch);
        let mut elements = vec![
            crate::motion::ElementMotion {
                position: Vector3::ZERO,
                velocity: Vector3::ZERO,
                axes: crate::rotor::Frame::new(Vector3::ZERO, 0.0).blade(0.0, 0.0),
                pitch: 0.0,
            };
            9
        ];
        structure.observe(0.0, &pitch, &mut elements);
        let base = machine.base;
        let blade_points = machine.blade.points.len();
        let n = history[0].len();
        let n_outboard = 3 * blade_points;
        structure.advance(STEP, &applied, &pitch);
        let second = *structure.loads();
        history.push(points(&structure, &pitch));
        let air = |range: std::ops::Range<usize>, centre: Vector3| {
            let mut sum = Wrench::default();
            for k in range {
                let force = loads[k].force;
                sum.add(Wrench { force, moment: (elements[k].position - centre).cross(force) });
            }
            sum
        };
        let check = |found: [Wrench; 2], expected: Wrench, what: &str| {
            let force = 0.5 * (found[0].force + found[1].force);
            let moment = 0.5 * (found[0].moment + found[1].moment);
            let (force_gap, moment_gap) =
                ((force - expected.force).length(), (moment - expected.moment).length());
            assert!(
                force_gap < 2e-4 * expected.force.length(),
                "{what}: {force} {}",
                expected.force
            );
            assert!(
                moment_gap < 2e-4 * expected.moment.length(),
                "{what}: {moment} {}",
                expected.moment
            );
        };
        let foot = {
            let mut sum = wrench(&history, 0..n, base);
            sum.add(air(0..9, base));
            sum
        };
        check([first.tower_base, second.tower_base], foot, "tower base");
        let top = motion.top.origin;
        let mut above = wrench(&history, 0..n_outboard + 2, top);
        above.add(air(0..9, top));
        check(
            [first.yaw_bearing, second.yaw_bearing],
            above.turned(&motion.top.axes.transpose()),
            "yaw bearing",
        );
        let apex = motion.hub.origin;
        let mut rotor = wrench(&history, 0..n_outboard + 1, apex);
        rotor.add(air(0..9, apex));
        check([first.shaft, second.shaft], rotor.turned(&motion.shaft.axes.transpose()), "shaft");
        for blade in 0..3 {
            let frame = &motion.blades[blade];
            let root = frame.origin + frame.axes.z_axis * machine.hub_radius;
            let mut own = wrench(&history, blade * blade_points..(blade + 1) * blade_points, root);
            own.add(air(3 * blade..3 * blade + 3, root));
            check(
                [first.blades[blade].pitched_root, second.blades[blade].pitched_root],
                own.turned(&frame.axes.transpose()),
                "blade root",
            );
        }
    }
}
