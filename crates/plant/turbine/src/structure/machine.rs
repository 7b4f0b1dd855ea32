//! The turbine as a multibody system: two kinds of beam, three rigid bodies and a shaft; parameters only.

use super::beam::Beam;
use super::coordinates::{Coordinates, GENERATOR, N_MODES, N_TOWER, TORSION};
use super::error::StructureError;
use super::frame::MovingFrame;
use super::shapes::{Place, PrincipalMode, Section, Shapes};
use crate::definition::{Definition, Mode};
use basis::blades::MAXIMUM_BLADES;
use basis::{Matrix3, PerBlade, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Equal parts of a blade, two mass points in each; span moments are output at their inner borders (–).
pub(super) const N_BLADE_PARTS: usize = 8;
/// Equal parts of the tower, two mass points in each.
const N_TOWER_PARTS: usize = 6;
/// Largest difference from one of the sum of a mode's coefficients (–); files round them to six or seven
/// digits.
const SHAPE_TOLERANCE: f64 = 1e-3;

/// How a blade is pitched, prescribed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pitch {
    /// Angle, positive to feather (rad).
    pub angle: f64,
    /// Rate (rad/s).
    pub rate: f64,
    /// Acceleration (rad/s²).
    pub acceleration: f64,
}

/// How the nacelle is turned on the tower, prescribed; counter-clockwise seen from above.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Yaw {
    /// Angle from facing −x (rad).
    pub angle: f64,
    /// Rate (rad/s).
    pub rate: f64,
    /// Acceleration (rad/s²).
    pub acceleration: f64,
}

/// Parameters of the structure, constant in time but for the nacelle's turn.
#[derive(Clone, Debug)]
pub(super) struct Machine {
    pub(super) n_blades: usize,
    pub(super) gravity: Vector3,
    /// Foot of the flexible tower, farm frame (m).
    pub(super) base: Vector3,
    pub(super) tower: Beam<N_TOWER>,
    pub(super) blade: Beam<N_MODES>,
    pub(super) tower_top: Place<N_TOWER>,
    pub(super) blade_tip: Place<N_MODES>,
    pub(super) hub_radius: f64,
    /// Twist of the principal axes at the inner borders of the blade's parts (rad).
    pub(super) gauge_twist: Vec<f64>,
    pub(super) yaw_bearing_mass: f64,
    pub(super) nacelle_mass: f64,
    /// Centre of mass of the nacelle from the tower top, in the nacelle (m).
    pub(super) nacelle_centre: Vector3,
    /// Inertia of the nacelle about the vertical through its centre of mass (kg m²).
    pub(super) nacelle_inertia: f64,
    /// Rotor apex from the tower top, in the nacelle (m).
    pub(super) apex: Vector3,
    pub(super) hub_mass: f64,
    pub(super) hub_inertia: f64,
    pub(super) gear_ratio: f64,
    pub(super) generator_inertia: f64,
    pub(super) shaft_stiffness: f64,
    pub(super) shaft_damping: f64,
    yaw: Yaw,
    top_from_nacelle: Matrix3,
    nacelle_from_shaft: Matrix3,
    /// Axes of each blade, coned but not pitched, in the hub at azimuth zero.
    hub_from_cone: PerBlade<Matrix3>,
}

/// Tabulated mode shapes of tower and blade.
pub(super) struct ModeTables {
    pub(super) tower: Shapes<N_TOWER>,
    pub(super) blade: Shapes<N_MODES>,
}

/// Where all bodies are and how they move.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// Tower top, turned with it.
    pub(super) top: MovingFrame,
    /// Nacelle at its centre of mass.
    pub(super) nacelle: MovingFrame,
    /// Nacelle at the rotor apex, axes of the shaft: downwind along it, left, up.
    pub(super) shaft: MovingFrame,
    /// Hub at the rotor apex, axes of the shaft turned by the azimuth.
    pub(super) hub: MovingFrame,
    /// Blades at the rotor apex, axes coned and pitched: downwind, towards the trailing edge, along the pitch
    /// axis.
    pub(super) blades: [MovingFrame; MAXIMUM_BLADES],
}

impl Machine {
    /// The turbine of `definition` with its foot's ground or sea level at `position` (m), nacelle turned by
    /// `yaw` (rad, about z).
    pub(super) fn new(
        definition: &Definition,
        position: Vector3,
        yaw: f64,
        gravity: f64,
    ) -> Result<(Self, ModeTables), StructureError> {
        let n_blades = definition.n_blades;
        if n_blades == 0 || n_blades > MAXIMUM_BLADES {
            return Err(StructureError::Blades { n_blades, maximum: MAXIMUM_BLADES });
        }
        let (blade, blade_table) = blade_beam(definition)?;
        let (tower, tower_table) = tower_beam(definition)?;
        let (geometry, nacelle) = (&definition.rotor, &definition.nacelle);
        let centre = nacelle.center_of_mass;
        let nacelle_from_shaft = Matrix3::from_rotation_y(geometry.shaft_tilt);
        let cone = Matrix3::from_rotation_y(-geometry.precone);
        let twist = |part: usize| {
            let span = definition.blade_length() * part as f64 / N_BLADE_PARTS as f64;
            super::shapes::section_at(&blade_sections(definition), span).twist
        };
        let last = |beam: &[Place<N_MODES>]| beam[beam.len() - 1];
        let machine = Self {
            n_blades,
            gravity: -Vector3::Z * gravity,
            base: position + Vector3::Z * definition.tower.base_height,
            tower_top: tower.borders[tower.borders.len() - 1],
            blade_tip: last(&blade.borders),
            tower,
            blade,
            hub_radius: geometry.hub_radius,
            gauge_twist: (1..N_BLADE_PARTS).map(twist).collect(),
            yaw_bearing_mass: nacelle.yaw_bearing_mass,
            nacelle_mass: nacelle.mass,
            nacelle_centre: centre,
            nacelle_inertia: (nacelle.yaw_inertia
                - nacelle.mass * (centre.x * centre.x + centre.y * centre.y))
                .max(0.0),
            apex: Vector3::Z * definition.tower.top_to_shaft
                - nacelle_from_shaft.x_axis * geometry.overhang,
            hub_mass: definition.hub.mass,
            hub_inertia: definition.hub.inertia,
            gear_ratio: definition.drive_train.gear_ratio,
            generator_inertia: definition.drive_train.generator_inertia,
            shaft_stiffness: definition.drive_train.stiffness,
            shaft_damping: definition.drive_train.damping,
            yaw: Yaw { angle: yaw, ..Yaw::default() },
            top_from_nacelle: Matrix3::from_rotation_z(yaw),
            nacelle_from_shaft,
            hub_from_cone: PerBlade::from_fn(n_blades, |blade| {
                Matrix3::from_rotation_x(TAU * blade as f64 / n_blades as f64) * cone
            }),
        };
        Ok((machine, ModeTables { tower: tower_table, blade: blade_table }))
    }

    /// From now on the nacelle is turned as `yaw` says.
    pub(super) fn turn(&mut self, yaw: Yaw) {
        if yaw.angle != self.yaw.angle {
            self.top_from_nacelle = Matrix3::from_rotation_z(yaw.angle);
        }
        self.yaw = yaw;
    }

    /// How the nacelle is turned.
    pub(super) fn yaw(&self) -> Yaw {
        self.yaw
    }

    /// The nacelle at the tower top, which is at `top`: turned about the axis of the yaw bearing.
    fn nacelle(&self, top: &MovingFrame) -> MovingFrame {
        let Yaw { rate, acceleration, .. } = self.yaw;
        if rate == 0.0 && acceleration == 0.0 {
            return top.with_axes(&self.top_from_nacelle);
        }
        top.turning(top.axes.z_axis, rate, acceleration, &[]).with_axes(&self.top_from_nacelle)
    }

    /// Where everything is at the coordinates `q` with rates `v`, blades pitched by `pitch`.
    pub(super) fn motion(&self, q: &Coordinates, v: &Coordinates, pitch: &[Pitch]) -> Motion {
        let top = self.top(&q.tower(), &v.tower());
        let body = self.nacelle(&top);
        let shaft = body.at(self.apex).with_axes(&self.nacelle_from_shaft);
        let speed = v.shared[GENERATOR] + v.shared[TORSION];
        let azimuth = q.shared[GENERATOR] + q.shared[TORSION];
        let hub = shaft
            .turning(shaft.axes.x_axis, speed, 0.0, &[GENERATOR, TORSION])
            .with_axes(&Matrix3::from_rotation_x(azimuth));
        let mut blades = [hub; MAXIMUM_BLADES];
        for ((frame, cone), pitch) in blades.iter_mut().zip(self.hub_from_cone.iter()).zip(pitch) {
            let axes = hub.axes * *cone * Matrix3::from_rotation_z(-pitch.angle);
            *frame = hub.turning(axes.z_axis, -pitch.rate, -pitch.acceleration, &[]);
            frame.axes = axes;
        }
        Motion { top, nacelle: body.at(self.nacelle_centre), shaft, hub, blades }
    }

    /// Axes of `blade`, coned but not pitched, farm frame.
    pub(super) fn cone_axes(&self, blade: usize, motion: &Motion) -> Matrix3 {
        motion.hub.axes * self.hub_from_cone[blade]
    }

    /// The tower top: displaced by the tower's modes and turned by their slopes, fore-aft first.
    fn top(&self, q: &[f64; N_TOWER], v: &[f64; N_TOWER]) -> MovingFrame {
        let (place, partials) = self.tower_top.at(q);
        let (turn, rate) = (self.tower_top.turn(q), self.tower_top.turn(v));
        let fore_aft = Matrix3::from_rotation_y(turn.y);
        let (about_y, about_x) = (Vector3::Y, fore_aft.x_axis);
        let mut top = MovingFrame::fixed(self.base + place);
        top.axes = fore_aft * Matrix3::from_rotation_x(turn.x);
        top.spin = about_y * rate.y + about_x * rate.x;
        top.angular_rest = about_y.cross(about_x) * (rate.y * rate.x);
        top.acceleration_rest = Vector3::Z * self.tower_top.own_acceleration(v);
        for mode in 0..N_TOWER {
            let turn = self.tower_top.turn[mode];
            top.linear[mode] = partials[mode];
            top.angular[mode] = about_y * turn.y + about_x * turn.x;
            top.velocity += partials[mode] * v[mode];
        }
        top
    }
}

fn blade_sections(definition: &Definition) -> Vec<Section> {
    let section = |section: &crate::definition::BladeSection| Section {
        position: section.span,
        twist: section.twist,
        mass: section.mass,
        stiffness: [section.flap_stiffness, section.edge_stiffness],
    };
    definition.blade_structure.sections.iter().map(section).collect()
}

fn blade_beam(definition: &Definition) -> Result<(Beam<N_MODES>, Shapes<N_MODES>), StructureError> {
    let blade = &definition.blade_structure;
    let length = definition.blade_length();
    let sections = checked("blade", length, blade_sections(definition))?;
    let [flap_1, flap_2] = blade.flap_modes;
    let modes = [
        (flap_1, 0, "flapwise mode 1"),
        (flap_2, 0, "flapwise mode 2"),
        (blade.edge_mode, 1, "edgewise mode 1"),
    ];
    let modes = normalised("blade", modes)?;
    Ok(Beam::new(definition.rotor.hub_radius, length, N_BLADE_PARTS, &sections, &modes))
}

fn tower_beam(definition: &Definition) -> Result<(Beam<N_TOWER>, Shapes<N_TOWER>), StructureError> {
    let tower = &definition.tower;
    let length = tower.top_height - tower.base_height;
    let section = |section: &crate::definition::TowerSection| Section {
        position: section.height - tower.base_height,
        twist: 0.0,
        mass: section.mass,
        stiffness: [section.fore_aft_stiffness, section.side_to_side_stiffness],
    };
    let sections = checked("tower", length, tower.sections.iter().map(section).collect())?;
    let ([fore_1, fore_2], [side_1, side_2]) = (tower.fore_aft_modes, tower.side_to_side_modes);
    let modes = [
        (fore_1, 0, "fore-aft mode 1"),
        (fore_2, 0, "fore-aft mode 2"),
        (side_1, 1, "side-to-side mode 1"),
        (side_2, 1, "side-to-side mode 2"),
    ];
    let modes = normalised("tower", modes)?;
    Ok(Beam::new(0.0, length, N_TOWER_PARTS, &sections, &modes))
}

/// `sections` if they rise from 0 to `length` (m, to a thousandth) with positive mass and stiffness.
fn checked(
    member: &'static str,
    length: f64,
    sections: Vec<Section>,
) -> Result<Vec<Section>, StructureError> {
    let slack = 1e-3 * length;
    let spans = sections.len() >= 2
        && sections.windows(2).all(|pair| pair[1].position > pair[0].position)
        && sections[0].position.abs() <= slack
        && (sections[sections.len() - 1].position - length).abs() <= slack;
    if !spans {
        return Err(StructureError::Sections { member, n_sections: sections.len(), length });
    }
    let sound = |value: f64| value.is_finite() && value > 0.0;
    let bad = sections
        .iter()
        .find(|s| !(sound(s.mass) && s.stiffness.iter().all(|&stiffness| sound(stiffness))));
    match bad {
        Some(section) => Err(StructureError::Section { member, position: section.position }),
        None => Ok(sections),
    }
}

/// Modes as shapes in principal axes, if each is one at the free end.
fn normalised<const N: usize>(
    member: &'static str,
    modes: [(Mode, usize, &'static str); N],
) -> Result<[PrincipalMode; N], StructureError> {
    for (mode, _, name) in &modes {
        let sum: f64 = mode.coefficients.iter().sum();
        if sum.is_nan() || (sum - 1.0).abs() > SHAPE_TOLERANCE {
            return Err(StructureError::Shape { member, mode: name, sum });
        }
    }
    Ok(modes.map(|(mode, axis, _)| PrincipalMode { axis, mode }))
}
