//! Blade elements in the axisymmetric flow that their own load makes.

use super::Flow;
use std::f64::consts::PI;
use std::sync::Arc;
use turbine::Definition;
use turbine::actuator_line::{ActuatorLine, Load, Onset, QuasiSteady};
use turbine::aero::blade_element::{Annulus, Theory, loss_factor};
use turbine::steady::{Coefficients, SteadyRotor};

/// Elements of a blade.
const N_ELEMENTS: usize = 60;
/// Share of a new load or speed that a round takes (–).
const RELAXATION: f64 = 0.1;
/// Rounds in which the flow finds itself under the loads of blade-element momentum, and most rounds in all.
const N_PREPARING: usize = 100;
const N_ROUNDS: usize = 2000;
/// Change of the power in a round at which it counts as found, over itself (–).
const TOLERANCE: f64 = 1e-7;

/// Head lost by the air inside a stream surface, linear between the points given.
#[derive(Default)]
pub(super) struct Table {
    points: Vec<[f64; 2]>,
}

impl Table {
    /// Adds a point, further out than the ones before.
    pub(super) fn push(&mut self, psi: f64, head: f64) {
        self.points.push([psi, head]);
    }

    /// Head lost at `psi`; beyond the last point none.
    pub(super) fn at(&self, psi: f64) -> f64 {
        let next = self.points.partition_point(|point| point[0] < psi);
        match (next.checked_sub(1).map(|i| self.points[i]), self.points.get(next)) {
            (Some([a, from]), Some([b, to])) => from + (psi - a) / (b - a) * (to - from),
            (None, Some([_, head])) => *head,
            (_, None) => 0.0,
        }
    }
}

/// What becomes of the angular momentum that the rotor gives the air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Swirl {
    /// Its pressure moves the air that passes the disc.
    Felt,
    /// Blades meet it, the flow does not feel it: as in momentum theory ring by ring.
    LeftOut,
}

/// A rotor in the flow that it makes.
pub(crate) struct Loaded {
    pub(crate) coefficients: Coefficients,
    flow: Flow,
    /// Head lost, and half the square of the angular momentum won, by stream surface.
    head: Table,
    swirl: Table,
    /// Stream surface that passes the tips, and the blades' speed there (–).
    outermost: f64,
    rotor_speed: f64,
}

/// Vortices that leave the outer part of a blade, between two places behind it.
pub(crate) struct Outer {
    /// Radius of the surface that passed the tips (radii).
    pub(crate) edge: f64,
    /// Mean radius of the vortices (radii), and their pitch over that of a helix in the free stream (–).
    pub(crate) radius: f64,
    pub(crate) pitch: f64,
}

impl Loaded {
    /// The vortices further out than `share` of the wake's edge, from `part[0]` to `part[1]` radii behind the
    /// disc; each weighted with its circulation, which goes as the head lost by what lies inside of it.
    pub(crate) fn outer_vortices(&self, share: f64, part: [f64; 2]) -> Outer {
        const N: usize = 200;
        let [mut edges, mut radii, mut weights, mut turns] = [0.0; 4];
        let planes = (0..N).map(|k| part[0] + (part[1] - part[0]) * (k as f64 + 0.5) / N as f64);
        for place in planes {
            let edge = self.flow.surface(place, self.outermost)[0];
            edges += edge / N as f64;
            for k in 0..N {
                let [inside, outside] = [k, k + 1].map(|k| self.outermost * k as f64 / N as f64);
                let middle = 0.5 * (inside + outside);
                let [radius, speed] = self.flow.surface(place, middle);
                if radius < share * edge {
                    continue;
                }
                let weight = self.head.at(inside) - self.head.at(outside);
                let turning =
                    self.rotor_speed + (2.0 * self.swirl.at(middle)).sqrt() / (radius * radius);
                weights += weight;
                radii += weight * radius;
                turns += weight * turning / (speed * self.rotor_speed);
            }
        }
        Outer { edge: edges, radius: radii / weights, pitch: weights / turns }
    }
}

/// Power and thrust coefficient of `definition` without its tilt, at `tip_speed_ratio` (–) and `pitch` (rad),
/// in the duct `flow`.
///
/// The number of blades enters as in blade-element momentum: a blade feels the mean induction of its ring
/// over Prandtl's factor, and swirl is that of momentum theory. Not numbers where flow and loads do not
/// converge. The local cone angle enters by two cosines: of the blade force along the shaft, and of the
/// induced velocity normal to the blade.
pub(crate) fn coefficients(
    definition: &Definition,
    tip_speed_ratio: f64,
    pitch: f64,
    flow: Flow,
    kind: Swirl,
) -> Coefficients {
    loaded(definition, tip_speed_ratio, pitch, flow, kind).coefficients
}

/// The same with the flow that it is found in.
pub(crate) fn loaded(
    definition: &Definition,
    tip_speed_ratio: f64,
    pitch: f64,
    mut flow: Flow,
    kind: Swirl,
) -> Loaded {
    let mut definition = definition.clone();
    definition.rotor.shaft_tilt = 0.0;
    let definition = Arc::new(definition);
    let radius = definition.rotor_radius();
    let n_blades = definition.n_blades as f64;
    let rotor_speed = tip_speed_ratio / radius;
    let hub_radius = definition.distance_from_shaft(definition.rotor.hub_radius, 0.0);
    // Nothing is smeared here: the line serves for its sections only.
    let line = ActuatorLine::new(Arc::clone(&definition), N_ELEMENTS, 1.0, 0.1 * radius, 0.0);
    let elements = line.elements();

    let momentum = SteadyRotor::new(&definition, Theory::default()).along_shaft();
    let mut points = vec![Default::default(); momentum.n_elements()];
    momentum.distribution(tip_speed_ratio, pitch, &mut points);
    let mut states: Vec<Ring> = elements
        .iter()
        .map(|element| {
            let near = points.partition_point(|point| point.radius < element.span);
            let point = &points[near.min(points.len() - 1)];
            Ring {
                felt: 1.0 - point.inflow.axial_induction,
                swirl: point.inflow.tangential_induction,
                loss: point.inflow.loss_factor,
                head: 0.5 * n_blades * point.normal_force / (2.0 * PI * element.radius),
                momentum: 0.0,
            }
        })
        .collect();

    let mut onsets = vec![Onset::default(); elements.len()];
    let mut loads = vec![Load::default(); elements.len()];
    let pitches = vec![pitch; elements.len()];
    let unsmeared = vec![[0.0; 2]; elements.len()];
    let mut found = Coefficients::default();
    for round in 0..N_ROUNDS {
        if round >= N_PREPARING {
            for ((onset, ring), element) in onsets.iter_mut().zip(&states).zip(elements) {
                onset.normal = ring.felt * element.cone_angle.cos();
                onset.tangential = rotor_speed * element.radius * (1.0 + ring.swirl);
            }
            line.loads_under(&onsets, &pitches, &mut QuasiSteady(&line), &unsmeared, &mut loads);
            for (index, (ring, element)) in states.iter_mut().zip(elements).enumerate() {
                let (onset, load) = (&onsets[index], &loads[index]);
                let annulus = Annulus {
                    n_blades: definition.n_blades,
                    radius: element.radius,
                    hub_radius,
                    tip_radius: radius,
                    chord: element.chord,
                    section_pitch: element.twist + pitch,
                    cone_angle: element.cone_angle,
                };
                let sine = onset.normal / onset.normal.hypot(onset.tangential);
                let loss = loss_factor(&annulus, Theory::default(), sine.abs());
                let around = 2.0 * PI * element.radius;
                let swirl = n_blades * load.tangential / (2.0 * around * onset.normal * ring.loss);
                ring.loss += RELAXATION * (loss - ring.loss);
                ring.swirl += RELAXATION * (swirl / (rotor_speed * element.radius) - ring.swirl);
                let through = flow.at_disc(element.radius / radius)[1];
                if kind == Swirl::Felt {
                    let won = n_blades * load.tangential * element.radius / (around * through);
                    ring.momentum += RELAXATION * (won / radius - ring.momentum);
                }
                let kinetic = 0.5 * (ring.momentum * radius / element.radius).powi(2);
                let head = n_blades * load.normal / around - kinetic;
                ring.head += RELAXATION * (head - ring.head);
                ring.felt += RELAXATION * (1.0 - (1.0 - through) / ring.loss - ring.felt);
            }
        }
        let (mut head, mut swirl) = (Table::default(), Table::default());
        let ends = [hub_radius / radius, 1.0].map(|end| flow.at_disc(end)[0]);
        [&mut head, &mut swirl].into_iter().for_each(|table| table.push(ends[0], 0.0));
        for (ring, element) in states.iter().zip(elements) {
            let surface = flow.at_disc(element.radius / radius)[0];
            head.push(surface, ring.head);
            swirl.push(surface, 0.5 * ring.momentum * ring.momentum);
        }
        [&mut head, &mut swirl].into_iter().for_each(|table| table.push(ends[1], 0.0));
        flow.relax(|psi| head.at(psi), |psi| swirl.at(psi));

        let last = found.power;
        let area = 0.5 * definition.rotor_area() / n_blades;
        let sum = |part: &dyn Fn(usize) -> f64| (0..elements.len()).map(part).sum::<f64>() / area;
        found.thrust = sum(&|i| loads[i].normal * elements[i].cone_angle.cos() * elements[i].width);
        found.torque =
            sum(&|i| loads[i].tangential * elements[i].radius * elements[i].width) / radius;
        found.power = found.torque * tip_speed_ratio;
        if round > N_PREPARING && (found.power - last).abs() < TOLERANCE * last.abs() {
            let outermost = ends[1];
            let rotor_speed = tip_speed_ratio;
            return Loaded { coefficients: found, flow, head, swirl, outermost, rotor_speed };
        }
    }
    let coefficients = Coefficients { power: f64::NAN, thrust: f64::NAN, torque: f64::NAN };
    let [head, swirl] = [Table::default(), Table::default()];
    Loaded { coefficients, flow, head, swirl, outermost: f64::NAN, rotor_speed: f64::NAN }
}

/// Air and load of one element's ring.
struct Ring {
    /// Axial wind that the blade feels over the free stream's (–).
    felt: f64,
    /// Tangential induction factor that it feels (–).
    swirl: f64,
    /// Prandtl's factor (–).
    loss: f64,
    /// Head lost: load over the air's density, less the swirl's kinetic energy (over the wind squared).
    head: f64,
    /// Angular momentum C won (over radius and wind).
    momentum: f64,
}
