//! Power, thrust and torque of a rigid rotor in a steady uniform wind, by blade-element momentum.

use crate::aero::SectionCoefficients;
use crate::aero::blade_element::{self, Annulus, Inflow, Theory};
use crate::{Definition, Polar};
use std::f64::consts::TAU;

/// Elements of a blade (–); eight times as many change power by less than 0.1 %.
const N_ELEMENTS: usize = 80;
/// Positions in a turn over which a tilted rotor is averaged.
const N_AZIMUTHS: usize = 8;

/// Coefficients of a rotor; all refer to the free-stream speed U and the disc that the blade tips sweep
/// (radius R, area A of [`Definition::rotor_radius`]).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coefficients {
    /// Aerodynamic power over ½ρU³A (–).
    pub power: f64,
    /// Thrust along the shaft over ½ρU²A (–).
    pub thrust: f64,
    /// Torque about the shaft over ½ρU²AR (–): power coefficient over tip-speed ratio.
    pub torque: f64,
}

/// Inflow and force at one place of a blade, averaged over the turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpanwisePoint {
    /// Distance from the apex along the pitch axis (m).
    pub radius: f64,
    /// Chord (m).
    pub chord: f64,
    /// Inflow; speeds are over the free-stream speed (–).
    pub inflow: Inflow,
    /// Force per metre of blade across the plane of rotation, downwind, over ½ρU² (m).
    pub normal_force: f64,
    /// Force per metre of blade along the rotation over ½ρU² (m).
    pub tangential_force: f64,
}

/// A rotor divided into rings, ready for many operating points; evaluating it allocates nothing.
///
/// The blade is rigid. Wind and force at a section are those across the local, coned and prebent blade
/// line; the ring's radius is the distance from the shaft, so that cone and prebend reduce swept area and
/// mass flow alike. Tilt enters through the wind's components at each of eight azimuths; there is no further
/// correction for a skewed wake. Sweep moves no section and blade pitch does not turn the prebend.
#[derive(Clone, Debug)]
pub struct SteadyRotor<'a> {
    polars: &'a [Polar],
    theory: Theory,
    n_blades: usize,
    hub_radius: f64,
    tip_radius: f64,
    rotor_area: f64,
    shaft_tilt: f64,
    along_shaft: bool,
    elements: Vec<Element>,
}

/// A length of blade with constant section.
#[derive(Clone, Copy, Debug)]
struct Element {
    /// Distance from the apex along the pitch axis (m).
    radius: f64,
    /// Distance from the shaft (m).
    distance: f64,
    /// Length of its part of the blade line (m).
    length: f64,
    /// Local cone angle: of the blade line out of the plane across the shaft, tip upwind (rad).
    cone_angle: f64,
    chord: f64,
    twist: f64,
    section: Section,
}

/// Two polars and the share of the second (–).
#[derive(Clone, Copy, Debug)]
struct Section {
    polars: [usize; 2],
    share: f64,
}

/// Power, thrust and torque coefficient at `tip_speed_ratio` (–, ωR/U) and `pitch` (rad).
///
/// For many operating points of one rotor make a [`SteadyRotor`] once.
pub fn steady(definition: &Definition, tip_speed_ratio: f64, pitch: f64) -> Coefficients {
    SteadyRotor::new(definition, Theory::default()).coefficients(tip_speed_ratio, pitch)
}

impl<'a> SteadyRotor<'a> {
    /// Divides the blades of `definition` into equal lengths; sections are interpolated linearly between its
    /// stations.
    pub fn new(definition: &'a Definition, theory: Theory) -> Self {
        let length = definition.blade_length();
        let edge = |k: usize| length * k as f64 / N_ELEMENTS as f64;
        let elements = (0..N_ELEMENTS).map(|k| element(definition, edge(k), edge(k + 1))).collect();
        Self::with_elements(definition, theory, elements)
    }

    /// Takes the stations of `definition` as nodes and integrates their loads by the trapezoidal rule, with
    /// no load at root and tip: coarser near the tip than [`SteadyRotor::new`], but the method behind
    /// published tables.
    pub fn at_stations(definition: &'a Definition, theory: Theory) -> Self {
        let blade = &definition.blade;
        let nodes = blade.windows(3).map(|stations| {
            let [before, here, after] = [stations[0].span, stations[1].span, stations[2].span];
            // Its half of either neighbouring length, with the section of the station itself.
            let reach = 0.25 * (after - before);
            element(definition, here - reach, here + reach)
        });
        Self::with_elements(definition, theory, nodes.collect())
    }

    fn with_elements(definition: &'a Definition, theory: Theory, elements: Vec<Element>) -> Self {
        Self {
            polars: &definition.polars,
            theory,
            n_blades: definition.n_blades,
            hub_radius: definition.distance_from_shaft(definition.rotor.hub_radius, 0.0),
            tip_radius: definition.rotor_radius(),
            rotor_area: definition.rotor_area(),
            shaft_tilt: definition.rotor.shaft_tilt,
            along_shaft: false,
            elements,
        }
    }

    /// The same rotor with momentum balanced along the shaft instead of normal to the coned blades, as in a
    /// resolved flow. With cone and prebend this gives a few percent more power than the programs behind
    /// published tables.
    pub fn along_shaft(self) -> Self {
        Self { along_shaft: true, ..self }
    }

    /// Stations along the blade in [`SteadyRotor::distribution`] (–).
    pub fn n_elements(&self) -> usize {
        self.elements.len()
    }

    /// Power, thrust and torque coefficient at `tip_speed_ratio` (–) and `pitch` (rad).
    pub fn coefficients(&self, tip_speed_ratio: f64, pitch: f64) -> Coefficients {
        let mut thrust = 0.0;
        let mut torque = 0.0;
        for element in &self.elements {
            let point = self.point(element, tip_speed_ratio, pitch);
            thrust += point.normal_force * element.cone_angle.cos() * element.length;
            torque += point.tangential_force * element.distance * element.length;
        }
        let scale = self.n_blades as f64 / self.rotor_area;
        let torque = scale * torque / self.tip_radius;
        Coefficients { power: torque * tip_speed_ratio, thrust: scale * thrust, torque }
    }

    /// State along the blade, root to tip, at `tip_speed_ratio` (–) and `pitch` (rad), written to `points`
    /// (`n_elements` long).
    pub fn distribution(&self, tip_speed_ratio: f64, pitch: f64, points: &mut [SpanwisePoint]) {
        for (element, point) in self.elements.iter().zip(points) {
            *point = self.point(element, tip_speed_ratio, pitch);
        }
    }

    /// One place of the blade, averaged over the turn, in a wind of 1 m/s.
    fn point(&self, element: &Element, tip_speed_ratio: f64, pitch: f64) -> SpanwisePoint {
        let annulus = Annulus {
            n_blades: self.n_blades,
            radius: element.distance,
            hub_radius: self.hub_radius,
            tip_radius: self.tip_radius,
            chord: element.chord,
            section_pitch: element.twist + pitch,
            cone_angle: if self.along_shaft { element.cone_angle } else { 0.0 },
        };
        let rotation = tip_speed_ratio * element.distance / self.tip_radius;
        let (tilt_sine, tilt_cosine) = self.shaft_tilt.sin_cos();
        let (cone_sine, cone_cosine) = element.cone_angle.sin_cos();
        let n_azimuths = if tilt_sine == 0.0 { 1 } else { N_AZIMUTHS };
        let mut point =
            SpanwisePoint { radius: element.radius, chord: element.chord, ..Default::default() };
        let share = 1.0 / n_azimuths as f64;
        for index in 0..n_azimuths {
            let (sine, cosine) = (TAU * index as f64 * share).sin_cos();
            let axial = tilt_cosine * cone_cosine + tilt_sine * cosine * cone_sine;
            let tangential = rotation + tilt_sine * sine;
            let inflow = blade_element::solve(
                &annulus,
                axial,
                tangential,
                |angle| self.section(element.section, angle),
                self.theory,
            );
            let pressure_chord = inflow.relative_speed * inflow.relative_speed * element.chord;
            point.normal_force += share * pressure_chord * inflow.normal_coefficient;
            point.tangential_force += share * pressure_chord * inflow.tangential_coefficient;
            add(&mut point.inflow, &inflow, share);
        }
        point
    }

    fn section(&self, section: Section, angle_of_attack: f64) -> SectionCoefficients {
        let first = self.polars[section.polars[0]].at(angle_of_attack);
        if section.polars[0] == section.polars[1] {
            return first;
        }
        let second = self.polars[section.polars[1]].at(angle_of_attack);
        let blend = |from: f64, to: f64| from + section.share * (to - from);
        SectionCoefficients {
            lift: blend(first.lift, second.lift),
            drag: blend(first.drag, second.drag),
            moment: blend(first.moment, second.moment),
        }
    }
}

/// Section of the blade between two places of its span (m).
fn element(definition: &Definition, from: f64, to: f64) -> Element {
    let blade = &definition.blade;
    let middle = 0.5 * (from + to);
    let high = blade.partition_point(|station| station.span < middle).clamp(1, blade.len() - 1);
    let (low, high) = (&blade[high - 1], &blade[high]);
    let share = ((middle - low.span) / (high.span - low.span)).clamp(0.0, 1.0);
    let blend = |a: f64, b: f64| a + share * (b - a);
    let slope = (high.prebend - low.prebend) / (high.span - low.span);
    let radius = definition.rotor.hub_radius + middle;
    Element {
        radius,
        distance: definition.distance_from_shaft(radius, blend(low.prebend, high.prebend)),
        length: (to - from) * slope.hypot(1.0),
        cone_angle: definition.rotor.precone + slope.atan(),
        chord: blend(low.chord, high.chord),
        twist: blend(low.twist, high.twist),
        section: Section { polars: [low.polar, high.polar], share },
    }
}

/// On return `sum` has grown by `share` of every field of `inflow`.
fn add(sum: &mut Inflow, inflow: &Inflow, share: f64) {
    sum.inflow_angle += share * inflow.inflow_angle;
    sum.angle_of_attack += share * inflow.angle_of_attack;
    sum.axial_induction += share * inflow.axial_induction;
    sum.tangential_induction += share * inflow.tangential_induction;
    sum.loss_factor += share * inflow.loss_factor;
    sum.relative_speed += share * inflow.relative_speed;
    sum.section.lift += share * inflow.section.lift;
    sum.section.drag += share * inflow.section.drag;
    sum.section.moment += share * inflow.section.moment;
    sum.normal_coefficient += share * inflow.normal_coefficient;
    sum.tangential_coefficient += share * inflow.tangential_coefficient;
}

#[cfg(test)]
mod tests;
