//! Budgets of a rotor and its free wake: what the blades do to the air, and what the air has of it.
//!
//! Vortices that nobody holds keep their impulse and their angular impulse, so that both grow by the forces
//! of the blades alone (Saffman, Vortex Dynamics, 1992, §§ 3.2 and 3.5). They are held against all that the
//! blades have given since they began to turn: from one turn to the next the impulse of a tangled wake grows
//! by a tenth more or less than it should, with every way of summing alike.
//!
//! Behind a rotor that turns evenly the flow is steady for who turns with it; where there are no vortices
//! its total pressure is then short of the wind's by ρ Ω r |w|, w the swirl, and the fluxes of momentum and
//! of angular momentum through a plane are thrust and torque. The blades' profile drag is left out on both
//! sides: it leaves no vortices.
//!
//! Energy: with that pressure p + ½ ρ |u|² is ρ Ω r w short of the wind's, point by point (w against the
//! rotor's sense), so that the mechanical energy that a plane behind the rotor lacks is Ω times the flux of
//! angular momentum, as the power is Ω times the torque. In this frame the budget of energy is that of
//! angular momentum and no second one; ahead of the rotor there is no mean swirl, and nothing is lacking.
//! The kinetic energy of the vortices makes none either: it falls as their cores grow and where they are
//! joined.

use super::held::{AIR_DENSITY, at_held_speed, flat};
use super::rotor::{Fineness, USUAL, wake};
use crate::Row;
use crate::row::Tolerance::Within;
use basis::{PointForce, Vector3};
use flow::vortex::{FreeWake, Segment};
use flow::{FlowSolver, WindField};
use std::f64::consts::TAU;
use turbine::Induction;

const CLOSE: f64 = 0.01;
const WIND: f64 = 8.0;
const NAME: &str = "nrel-5mw";
/// Places of the planes behind the rotor and radius of the circle whose circulation is taken (rotor radii).
const PLANE: f64 = 1.0;
const CIRCLE: [f64; 2] = [0.1, 0.6];
/// Parts of the plane: how far out they reach (rotor radii), and how many rings of points they have. Within
/// the first are the vortices, and rings are no further apart than their cores.
const PARTS: [(f64, usize); 2] = [(1.5, 300), (4.0, 100)];
/// Points of a ring. With 72 steps a turn they stand at 2664 angles of the frame that turns with the rotor,
/// an eighth of a degree apart, and so at all distances from the corners of the wake, which stand at
/// multiples of a step.
const N_AROUND: usize = 37;

/// The wake keeps all of its vortices: its end never comes. It keeps every element to beyond the plane, and
/// its chords are of five degrees: joined before and of ten, it has 3 and 4 % less momentum and angular
/// momentum there.
const WHOLE: Fineness =
    Fineness { length: 10.0, settling: 6.0, near: 0.75, steps_per_turn: 72.0, ..USUAL };

/// Mean over a turn of what the blades do (lift alone), and of what the plane and the circle behind them see;
/// what the blades have given since the start, and what the wake has.
#[derive(Default)]
struct Budget {
    thrust: f64,
    torque: f64,
    circulation: f64,
    momentum_flux: f64,
    angular_flux: f64,
    circulation_behind: f64,
    /// Impulse and angular impulse (N s, N m s).
    given: [f64; 2],
    held: [f64; 2],
}

pub(super) fn rows() -> Vec<Row> {
    let Budget {
        thrust,
        torque,
        circulation,
        momentum_flux,
        angular_flux,
        circulation_behind,
        given,
        held,
    } = budget();
    tell!("thrust {:.2} kN, torque {:.1} kN m, lift alone", 1e-3 * thrust, 1e-3 * torque);
    let row = |what: &str, measured: f64, expected: f64, source: &'static str| Row {
        what: format!(
            "{NAME} flat, {WIND} m/s, best tip-speed ratio, 72 steps a turn, near wake of 0.75 D: {what}"
        ),
        measured: measured / expected,
        expected: 1.0,
        tolerance: Within(CLOSE),
        unit: "–",
        source,
    };
    let [impulse, plane, stokes] = [
        "Saffman, Vortex Dynamics, §§ 3.2, 3.5: impulse and angular impulse grow by the forces alone",
        "momentum and Bernoulli's law in the frame that turns with the rotor",
        "Stokes' theorem: what is bound has left as swirl behind",
    ];
    vec![
        row(
            "impulse of the wake over what the blades' thrust has given since the start",
            held[0],
            given[0],
            impulse,
        ),
        row(
            "angular impulse of the wake over what the blades' torque has given since the start",
            held[1],
            given[1],
            impulse,
        ),
        row(
            "flux of momentum and pressure through a plane half a diameter behind over the blades' thrust",
            momentum_flux,
            thrust,
            plane,
        ),
        row(
            "flux of angular momentum through a plane half a diameter behind over the blades' torque",
            angular_flux,
            torque,
            plane,
        ),
        row(
            "circulation around the wake at 0.6 of the radius over that bound to the blades there",
            circulation_behind,
            circulation,
            stokes,
        ),
    ]
}

fn budget() -> Budget {
    let model = flat(NAME);
    let (definition, rotor_speed) = (&model.definition, model.rotor_speed(WIND));
    let radius = definition.rotor_radius();
    let interval = TAU / rotor_speed / WHOLE.steps_per_turn;
    let mut wake = wake(&model, WIND, interval, WHOLE);
    let induction = Induction::ByBoundVortices { dynamic_stall: false, tower: None };
    let foot = Vector3::Z * -definition.rotor.hub_height;
    let (mut rotor, commands) = at_held_speed(&model, WIND, foot, induction);
    let hub = rotor.frame().hub;
    let turn = WHOLE.steps_per_turn as usize;
    let n_steps = (WHOLE.settling * 2.0 * radius / WIND / interval).ceil() as usize;
    let mut winds = vec![Vector3::ZERO; rotor.stations().len()];
    let mut budget = Budget::default();
    let share = 1.0 / turn as f64;
    let mut before = [0.0; 2];
    for step in 0..n_steps {
        wake.sample(rotor.stations(), &mut winds);
        rotor.advance_answered(interval, &winds, wake.answer(0), &commands);
        let lift = lift(&wake, rotor.forces(), &winds, rotor_speed, hub);
        wake.advance(interval, rotor.forces()).expect("a wake in steady wind stays finite");
        (0..2).for_each(|k| budget.given[k] += lift[k] * interval);
        if step % turn == turn - 1 {
            let now = impulses(wake.segments(), hub);
            let rates = [0, 1].map(|k| (now[k] - before[k]) / (turn as f64 * interval * lift[k]));
            let turn = step / turn + 1;
            tell!(
                "turn {turn}: impulse grew by {:.3} of what it should, angular {:.3}",
                rates[0],
                rates[1]
            );
            before = now;
        }
        if step + turn >= n_steps {
            budget.thrust += share * lift[0];
            budget.torque += share * lift[1];
            budget.circulation += share * bound(rotor.forces(), CIRCLE[1] * radius, hub);
            let fluxes = fluxes(&wake, hub, radius, rotor_speed);
            budget.momentum_flux += share * fluxes[0];
            budget.angular_flux += share * fluxes[1];
            budget.circulation_behind += share * swirl(&wake, hub, radius);
        }
    }
    budget.held = impulses(wake.segments(), hub);
    budget
}

/// Thrust (N) and torque (N m) of the lift of all elements: ρ V × Γ on the blade, V the wind relative to it
/// with what answers to this step's circulation.
fn lift(
    wake: &FreeWake,
    forces: &[PointForce],
    winds: &[Vector3],
    rotor_speed: f64,
    hub: Vector3,
) -> [f64; 2] {
    let bound: Vec<_> =
        forces.iter().filter_map(|force| Some((force.position, force.bound?))).collect();
    let n = bound.len();
    let mut sum = [0.0; 2];
    for (index, (position, element)) in bound.iter().enumerate() {
        let mut wind = winds[index];
        if let Some(answer) = wake.answer(0) {
            let row = &answer.influence[index * n..(index + 1) * n];
            for ((influence, (_, other)), then) in row.iter().zip(&bound).zip(answer.circulations) {
                wind += *influence * (other.circulation - then);
            }
        }
        let arm = *position - hub;
        let relative = wind - (Vector3::X * rotor_speed).cross(arm);
        let force = AIR_DENSITY * relative.cross(element.circulation * element.along);
        sum[0] += force.x;
        sum[1] += arm.cross(force).x;
    }
    sum
}

/// Impulse and angular impulse along the axis through `hub` (N s, N m s), as the blades give them:
/// −½ ρ ∮ Γ x × dl and ½ ρ ∮ Γ r² dl.
fn impulses(segments: &[Segment], hub: Vector3) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for Segment { from, to, circulation, .. } in segments {
        let (a, b) = (*from - hub, *to - hub);
        let along = b - a;
        sum[0] += 0.5 * circulation * (0.5 * (a + b)).cross(along).x;
        // The mean of r² along a straight line.
        let dot = |u: Vector3, v: Vector3| u.y * v.y + u.z * v.z;
        let square = (dot(a, a) + dot(a, b) + dot(b, b)) / 3.0;
        sum[1] -= 0.5 * circulation * square * along.x;
    }
    sum.map(|value| -AIR_DENSITY * value)
}

/// Sum over the blades of the circulation that is bound at `radius` (m) from the axis through `hub` (m²/s).
fn bound(forces: &[PointForce], radius: f64, hub: Vector3) -> f64 {
    let elements: Vec<(f64, f64)> = forces
        .iter()
        .filter_map(|force| Some(((force.position - hub).length(), force.bound?.circulation)))
        .collect();
    let across = |pair: &[(f64, f64)]| {
        let [(r0, g0), (r1, g1)] = [pair[0], pair[1]];
        (r0 <= radius && radius < r1).then(|| g0 + (g1 - g0) * (radius - r0) / (r1 - r0))
    };
    elements.windows(2).filter_map(across).sum()
}

/// Wind along the axis, outwards and around it at `radius` from the axis and `behind` the rotor (m), at
/// angle number `k` of the points around.
fn at(wake: &impl WindField, hub: Vector3, behind: f64, radius: f64, k: usize) -> [f64; 3] {
    let (sine, cosine) = (TAU * k as f64 / N_AROUND as f64).sin_cos();
    let outwards = Vector3::new(0.0, cosine, sine);
    let mut wind = [Vector3::ZERO];
    wake.sample(&[hub + Vector3::X * behind + outwards * radius], &mut wind);
    [wind[0].x, wind[0].dot(outwards), wind[0].dot(Vector3::X.cross(outwards))]
}

/// Circulation around the wake on the circle (m²/s), against the rotor's sense.
fn swirl(wake: &impl WindField, hub: Vector3, radius: f64) -> f64 {
    let [behind, r] = CIRCLE.map(|share| share * radius);
    let around = |k: usize| at(wake, hub, behind, r, k)[2];
    -TAU * r * (0..N_AROUND).map(around).sum::<f64>() / N_AROUND as f64
}

/// Radii of the rings of points on a plane, and their widths (rotor radii).
fn rings() -> impl Iterator<Item = [f64; 2]> {
    let mut inner = 0.0;
    PARTS.into_iter().flat_map(move |(outer, n)| {
        let (first, width) = (inner, (outer - inner) / n as f64);
        inner = outer;
        (0..n).map(move |ring| [first + (ring as f64 + 0.5) * width, width])
    })
}

/// Thrust (N) and torque (N m) by what passes the plane: ∫ ρ u (U − u) + p₀ − p and −∫ ρ u w r, with
/// p₀ − p = ½ ρ (|u|² − U²) − ρ Ω r w for the swirl w.
fn fluxes(wake: &impl WindField, hub: Vector3, radius: f64, rotor_speed: f64) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for [r, width] in rings() {
        let (r, width) = (r * radius, width * radius);
        let weight = AIR_DENSITY * TAU * r * width / N_AROUND as f64;
        for k in 0..N_AROUND {
            let [u, v, w] = at(wake, hub, PLANE * radius, r, k);
            let head = 0.5 * (u * u + v * v + w * w - WIND * WIND) - rotor_speed * r * w;
            sum[0] += weight * (u * (WIND - u) + head);
            sum[1] -= weight * u * w * r;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS: f64 = 10.0;
    const DEFICIT: f64 = 2.0;
    const SWIRL: f64 = 0.5;
    /// Steps of a turn, and corners of the wake around (–).
    const N_STEPS: u32 = 36;
    const N_CORNERS: f64 = 18.0;

    /// A wake of one radius that turns as a solid body and wavers from corner to corner, all of which turns
    /// with the rotor: at this angle now (rad).
    struct Wavering(f64);

    impl WindField for Wavering {
        fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
            for (position, velocity) in positions.iter().zip(velocities) {
                let (r, angle) = (position.y.hypot(position.z), position.z.atan2(position.y));
                let wave = 1.0 + (N_CORNERS * (angle - self.0)).cos();
                let inside = if r < RADIUS { wave } else { 0.0 };
                let around = Vector3::new(0.0, -position.z, position.y) / RADIUS;
                *velocity = Vector3::X * (WIND - DEFICIT * inside) - SWIRL * inside * around;
            }
        }
    }

    #[test]
    fn fluxes_are_those_of_a_wake_that_wavers_from_corner_to_corner() {
        let rotor_speed = 1.2;
        let mut found = [0.0; 2];
        for step in 0..N_STEPS {
            let angle = TAU * f64::from(step) / f64::from(N_STEPS);
            let of_step = fluxes(&Wavering(angle), Vector3::ZERO, RADIUS, rotor_speed);
            (0..2).for_each(|k| found[k] += of_step[k] / f64::from(N_STEPS));
        }
        // By hand, with ⟨q⟩ = 1 and ⟨q²⟩ = 3/2 of q = 1 + cos 18 θ, and w = −S q r/R:
        let (area, ratio) = (0.5 * TAU * RADIUS * RADIUS, 1.5);
        // ∫ u (U − u) + ½ (u² + w² − U²) − Ω r w, and ∫ u S q r²/R.
        let along = -0.5 * DEFICIT * DEFICIT * ratio;
        let around = 0.25 * SWIRL * SWIRL * ratio + 0.5 * rotor_speed * SWIRL * RADIUS;
        let thrust = AIR_DENSITY * area * (along + around);
        let torque = AIR_DENSITY * area * 0.5 * SWIRL * RADIUS * (WIND - DEFICIT * ratio);
        assert!((found[0] / thrust - 1.0).abs() < 1e-3, "{} {thrust}", found[0]);
        assert!((found[1] / torque - 1.0).abs() < 1e-3, "{} {torque}", found[1]);
    }

    #[test]
    fn rings_cover_the_plane() {
        let area: f64 = rings().map(|[r, width]| TAU * r * width).sum();
        assert!((area / (0.5 * TAU * 16.0) - 1.0).abs() < 1e-12, "{area}");
        assert_eq!(rings().count(), 400);
    }
}
