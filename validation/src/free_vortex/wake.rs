//! The wake of a free rotor beside that of a fine lattice, and its outer vortices beside axisymmetric
//! flow.

use super::held::{Steady, Trial, blockage, difference, flat, over_disc, turn};
use super::rotor::{USUAL, duct, turned};
use crate::Row;
use crate::axisymmetric::{self, Outer, Swirl};
use crate::row::Tolerance::{self, AtMost, Within};
use basis::Vector3;
use farm::assemble::TurbineModel;
use flow::inflow::MeanProfile;
use flow::lattice::{Ground, Lattice, LatticeSettings};
use flow::vortex::Segment;
use report::{Along, ReportError, Synchronisation, TrackFigure, TrackLine, TrackRow};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use turbine::Induction;
use turbine::blockage::equivalent_speed_ratio;

const NAME: &str = "nrel-5mw";
const WIND_SPEED: f64 = 8.0;
const DISTANCES: [f64; 3] = [1.0, 2.0, 3.0];
const LATTICE: &str = "the lattice on 32 cells a diameter";
const RINGS: &str = "blade elements in axisymmetric flow with swirl";
/// Accepted distance of power and thrust, and of the wind over the disc (free streams), from the lattice's;
/// most of the root of the mean square difference of the profiles (free streams).
const POWER: f64 = 0.03;
const WIND: f64 = 0.02;
const SHAPE: f64 = 0.05;
/// Accepted distance of the outer vortices' radius and pitch from the axisymmetric flow's (–).
const RADIUS: f64 = 0.03;
const PITCH: f64 = 0.05;
/// The lattice's box (diameters), cells per diameter, and cells that the tip moves in a step.
const BOX: [f64; 3] = [3.5, 4.5, 8.0];
const CELLS: f64 = 32.0;
const TIP_CELLS: f64 = 0.5;
/// Smearing length over the edge of a cell (–), as studies have it.
const SMEARING: f64 = farm::domain::SMEARING_CELLS;
/// Wind's time for a diameter until the lattice's wake stands to 3 D (–).
const SETTLING: f64 = 9.0;
/// Part of the wake behind the rotor in which outer vortices are measured (radii), and the least radius of
/// what counts over that of the wake's edge (–).
const MEASURED: [f64; 2] = [3.0, 5.0];
const OUTER: f64 = 0.75;

/// The rotor in free vortices, those vortices, and the rotor in the lattice.
struct Both {
    free: Steady,
    vortices: Vec<Segment>,
    lattice: Steady,
}

/// Made once, for rows and pictures.
static BOTH: LazyLock<Both> = LazyLock::new(|| {
    let model = flat(NAME);
    let (free, wake) = turned(&model, WIND_SPEED, USUAL, &DISTANCES);
    Both { free, vortices: wake.segments().to_vec(), lattice: on_a_lattice(&model) }
});

/// Profiles and loading beside the lattice's, radius and pitch of outer vortices beside axisymmetric flow.
pub(super) fn rows() -> Vec<Row> {
    let Both { free, vortices, lattice } = &*BOTH;
    let mut rows = beside_the_lattice(free, lattice);
    rows.extend(of_tip_vortices(&flat(NAME), vortices));
    rows
}

/// The figures of [`rows`], drawn into `folder`/figures; gives their names.
///
/// # Errors
/// Those of [`report::write_synchronisation`].
pub(super) fn pictures(folder: &Path) -> Result<Vec<String>, ReportError> {
    let Both { free, lattice, .. } = &*BOTH;
    let tracks = vec![loading(free, lattice), profiles(free, lattice)];
    report::write_synchronisation(&Synchronisation { tracks, ..Synchronisation::default() }, folder)
}

/// The same rotor in the lattice.
fn on_a_lattice(model: &TurbineModel) -> Steady {
    let definition = &model.definition;
    let diameter = definition.rotor_diameter();
    let spacing = diameter / CELLS;
    let tip_speed = model.rotor_speed(WIND_SPEED) * definition.rotor_radius();
    let [upstream, downstream, width] = BOX;
    let n_across = (width * CELLS) as usize;
    let half = 0.5 * n_across as f64 * spacing;
    let hub = definition.rotor.hub_height;
    let origin = Vector3::new(-upstream * diameter, -half, hub - half);
    let n_cells = [((upstream + downstream) * CELLS) as usize, n_across, n_across];
    let interval = TIP_CELLS * spacing / tip_speed;
    let mut settings = LatticeSettings::new(origin, spacing, n_cells, interval, WIND_SPEED);
    settings.air_density = super::held::AIR_DENSITY;
    settings.ground = Ground::Periodic;
    let wind = Arc::new(MeanProfile::Uniform { speed: WIND_SPEED });
    let mut air = Lattice::new(settings, wind).expect("such a box can be");
    let induction = Induction::ByFlow {
        smearing_length: SMEARING * spacing,
        sample_spacing: spacing,
        dynamic_stall: false,
    };
    let settling = SETTLING * diameter / WIND_SPEED;
    let trial = Trial { wind_speed: WIND_SPEED, interval, settling, distances: &DISTANCES };
    turn(model, &mut air, induction, &trial)
}

fn row(
    what: String,
    measured: f64,
    expected: f64,
    tolerance: Tolerance,
    source: &'static str,
) -> Row {
    let what = format!("{NAME} flat, {WIND_SPEED} m/s, best tip-speed ratio: {what}");
    Row { what, measured, expected, tolerance, unit: "–", source }
}

/// Power, thrust and wakes of `free` beside the lattice's.
fn beside_the_lattice(free: &Steady, lattice: &Steady) -> Vec<Row> {
    // What the walls of the box speed the wind up by at the rotor.
    let share = blockage(1.0, BOX[2]);
    let ratio = equivalent_speed_ratio(lattice.coefficients.thrust, share);
    let power = lattice.coefficients.power / ratio.powi(3);
    let thrust = lattice.coefficients.thrust / ratio.powi(2);
    tell!("lattice: power {power:.4}, thrust {thrust:.4}; walls: wind as of {ratio:.4}");
    let mut rows = vec![
        row(
            "power over that on the lattice, walls taken off".to_owned(),
            free.coefficients.power / power,
            1.0,
            Within(POWER),
            LATTICE,
        ),
        row(
            "thrust over that on the lattice, walls taken off".to_owned(),
            free.coefficients.thrust / thrust,
            1.0,
            Within(POWER),
            LATTICE,
        ),
    ];
    for (distance, (ours, theirs)) in DISTANCES.iter().zip(free.wakes.iter().zip(&lattice.wakes)) {
        // Walls speed up what passes beside the rotor too.
        let theirs: Vec<[f64; 2]> =
            theirs.iter().map(|[radius, wind]| [*radius, wind / ratio]).collect();
        let (disc, shape) = (over_disc(ours) - over_disc(&theirs), difference(ours, &theirs));
        tell!(
            "{distance} D: over the disc {:.4}, lattice {:.4}; profiles differ by {shape:.4}",
            over_disc(ours),
            over_disc(&theirs)
        );
        rows.push(row(
            format!(
                "mean wind over the disc {distance} D behind, less the lattice's, over free stream"
            ),
            disc,
            0.0,
            Within(WIND),
            LATTICE,
        ));
        rows.push(row(
            format!(
                "wind over the radius {distance} D behind: root of the mean square difference from the lattice's, over free stream"
            ),
            shape,
            SHAPE,
            AtMost,
            LATTICE,
        ));
    }
    rows
}

/// Radius and pitch of what left the outer part of the blades, beside the same of the axisymmetric flow.
fn of_tip_vortices(model: &TurbineModel, vortices: &[Segment]) -> Vec<Row> {
    let definition = &model.definition;
    let rotor_speed = model.rotor_speed(WIND_SPEED);
    let radius = definition.rotor_radius();
    let ratio = rotor_speed * radius / WIND_SPEED;
    let pitch = model.constants.fine_pitch;
    let rings = axisymmetric::loaded(definition, ratio, pitch, duct(), Swirl::Felt);
    let expected = rings.outer_vortices(OUTER, MEASURED);
    let hub = Vector3::Z * definition.rotor.hub_height;
    let found = helix(vortices, hub, radius, OUTER * expected.edge);
    let free_pitch = TAU * WIND_SPEED / rotor_speed;
    tell!(
        "outer vortices: radius {:.4} R, pitch {:.4} of the free stream's; axisymmetric {:.4}, {:.4}",
        found[0] / radius,
        found[1] / free_pitch,
        expected.radius,
        expected.pitch
    );
    let Outer { radius: expected_radius, pitch: expected_pitch, .. } = expected;
    let [from, to] = MEASURED.map(|radii| 0.5 * radii);
    let part = format!("{from} to {to} D behind, beyond {OUTER} of the wake's radius");
    let radius = found[0] / radius / expected_radius;
    let pitch = found[1] / free_pitch / expected_pitch;
    let radius = (format!("mean radius of vortices {part}"), radius, RADIUS);
    let pitch = (format!("pitch of vortices {part}"), pitch, PITCH);
    let over = |(what, measured, tolerance): (String, f64, f64)| {
        let what = format!("{what}, over the axisymmetric flow's");
        row(what, measured, 1.0, Within(tolerance), RINGS)
    };
    vec![over(radius), over(pitch)]
}

/// Mean radius (m) and pitch (m) of the vortices further out than `least` of `rotor_radius` (m) about the
/// axis through `hub`, each weighted with circulation and length along the axis.
fn helix(vortices: &[Segment], hub: Vector3, rotor_radius: f64, least: f64) -> [f64; 2] {
    let (mut weight, mut radii, mut around) = (0.0, 0.0, 0.0);
    for vortex in vortices {
        let [from, to] = [vortex.from - hub, vortex.to - hub];
        let middle = 0.5 * (from + to);
        let distance = middle.y.hypot(middle.z);
        let place = middle.x / rotor_radius;
        if distance < least * rotor_radius || !(MEASURED[0]..MEASURED[1]).contains(&place) {
            continue;
        }
        let step = to - from;
        let turned = from.y.atan2(from.z) - to.y.atan2(to.z);
        let turned = turned - TAU * (turned / TAU).round();
        // Spanwise vortices lie across the helix: with what trails alone both signs are the same.
        let share = vortex.circulation * step.x;
        weight += share;
        radii += share * distance;
        around += vortex.circulation * turned;
    }
    [radii / weight, (TAU * weight / around).abs()]
}

/// Forces on a blade over its radius.
fn loading(free: &Steady, lattice: &Steady) -> TrackFigure {
    let row = |label: &str, axis: usize| TrackRow {
        label: label.to_owned(),
        is_angle: false,
        lines: both(free, lattice, |steady| {
            let points = steady.loading.iter();
            points.map(|station| [station[0], 1e-3 * station[axis]]).collect()
        }),
    };
    TrackFigure {
        along: RADII,
        name: "loading".to_owned(),
        title: format!("Force on a blade of {NAME}, {WIND_SPEED} m/s"),
        caption: "Mean force on a blade over a turn, along the wind and around the shaft, at the best tip-speed ratio.".to_owned(),
        rows: vec![row("along (kN/m)", 1), row("around (kN/m)", 2)],
        mark: None,
    }
}

/// Wind over the radius at every distance.
fn profiles(free: &Steady, lattice: &Steady) -> TrackFigure {
    let rows = DISTANCES.iter().enumerate().map(|(index, distance)| TrackRow {
        label: format!("u/U, {distance} D"),
        is_angle: false,
        lines: both(free, lattice, |steady| steady.wakes[index].clone()),
    });
    TrackFigure {
        along: RADII,
        name: "wake-profiles".to_owned(),
        title: format!("Wind behind {NAME}, {WIND_SPEED} m/s"),
        caption: "Mean streamwise wind over the free stream, averaged around the axis and over a turn. The lattice stands \
                  in a box of 8 by 8 diameters, whose walls speed it up by less than half a percent."
            .to_owned(),
        rows: rows.collect(),
        mark: Some(1.0),
    }
}

/// Radius over the rotor's.
const RADII: Along = Along { label: "radius over the rotor's", unit: "R" };

fn both(free: &Steady, lattice: &Steady, of: impl Fn(&Steady) -> Vec<[f64; 2]>) -> Vec<TrackLine> {
    let line = |name: &str, colour: usize, points: Vec<[f64; 2]>| TrackLine {
        name: name.to_owned(),
        colour,
        times: points.iter().map(|point| point[0]).collect(),
        values: points.iter().map(|point| point[1]).collect(),
        band: Vec::new(),
    };
    vec![line("lattice, 32 cells", 0, of(lattice)), line("free wake", 1, of(free))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn radius_and_pitch_of_a_helix_are_found() {
        const RADIUS: f64 = 70.0;
        const RISE: f64 = 40.0;
        let place = |k: usize| {
            let angle = -TAU / 40.0 * k as f64;
            let around = Vector3::new(0.0, angle.sin(), angle.cos());
            Vector3::X * (RISE * k as f64 / 40.0) + RADIUS * around
        };
        // Two of them, a weaker one further out, and a vortex near the axis that does not count.
        let mut vortices = Vec::new();
        for k in 0..800 {
            let of = |scale: f64, circulation: f64| Segment {
                from: place(k) * Vector3::new(1.0, scale, scale),
                to: place(k + 1) * Vector3::new(1.0, scale, scale),
                circulation,
                core_squared: 0.0,
            };
            vortices.extend([of(1.0, 30.0), of(1.2, 10.0), of(0.1, -40.0)]);
        }
        let [radius, pitch] = helix(&vortices, Vector3::ZERO, 60.0, 0.6);
        // Middles of chords lie within the circle.
        assert!((radius / (RADIUS * 1.05) - (TAU / 80.0).cos()).abs() < 1e-6, "{radius}");
        assert!((pitch / RISE - 1.0).abs() < 1e-9, "{pitch}");
    }
}
