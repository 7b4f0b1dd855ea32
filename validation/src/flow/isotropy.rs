//! D3Q19 against D3Q27: does the smaller set see the grid's axes in round and rotating wakes?

use super::{advance, lattice};
use crate::Row;
use crate::folds::larger;
use crate::row::Tolerance::{AtMost, Within};
use basis::records::PlaneAxes;
use basis::{PointForce, Vector3};
use flow::WindField;
use flow::lattice::{Ends, Ground, Lattice, LatticeSettings, PlaneAverage, Stencil};
use std::f64::consts::{PI, TAU};

/// Where the expected values come from.
const SOURCE: &str = "rotational symmetry, or the other set of directions";

const DIAMETER: f64 = 240.0;
const RADIUS: f64 = 0.5 * DIAMETER;
const SPEED: f64 = 9.0;
const WIDTH: f64 = 4.0;
const STENCILS: [Stencil; 2] = [Stencil::D3Q19, Stencil::D3Q27];

/// Round columns, deflected wakes along an axis and along a diagonal, a wake stirred as by a helix.
pub fn isotropy() -> Vec<Row> {
    [columns(), deflected_wakes(), helical_wake()].concat()
}

fn settings(stencil: Stencil, cells_per_diameter: f64, length: f64) -> LatticeSettings {
    let spacing = DIAMETER / cells_per_diameter;
    let cells = |diameters: f64| (diameters * cells_per_diameter).round() as usize;
    let corner = -0.5 * WIDTH * DIAMETER;
    let n_cells = [cells(length), cells(WIDTH), cells(WIDTH)];
    let origin = Vector3::new(-2.0 * DIAMETER, corner, corner);
    let mut settings = LatticeSettings::new(origin, spacing, n_cells, 0.1 * spacing / SPEED, SPEED);
    settings.ground = Ground::Periodic;
    settings.stencil = stencil;
    settings
}

/// A round wake, still or turning, endless along x: it must stay round, and no flow may cross it.
fn columns() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, swirl) in [("round wake", 0.0), ("rotating wake", 0.2)] {
        for cells_per_diameter in [16.0, 24.0] {
            for stencil in STENCILS {
                let [fourfold, radial] = column(stencil, cells_per_diameter, swirl);
                for (what, measured) in [("fourfold part of u", fourfold), ("radial wind", radial)]
                {
                    rows.push(Row {
                        what: format!("{name}, {stencil:?}, {cells_per_diameter} cells a diameter: {what} over free stream"),
                        measured,
                        expected: 0.01,
                        tolerance: AtMost,
                        unit: "-", source: SOURCE });
                }
            }
        }
    }
    rows
}

/// Largest fourfold part of u and largest radial wind on circles around the axis, over the free stream, after
/// ten diameters.
fn column(stencil: Stencil, cells_per_diameter: f64, swirl: f64) -> [f64; 2] {
    let mut settings = settings(stencil, cells_per_diameter, 8.0 / cells_per_diameter);
    settings.ends = Ends::Periodic;
    let mut air = lattice(settings, move |_, p| {
        let radius = p.y.hypot(p.z) / RADIUS;
        let deficit = 0.5 * (1.0 - ((radius - 1.0) / 0.25).tanh());
        let turn = swirl * SPEED / RADIUS * (0.5 * (1.0 - radius * radius)).exp();
        Vector3::new(SPEED * (1.0 - 0.6 * deficit), -turn * p.z, turn * p.y)
    });
    advance(&mut air, 10.0 * cells_per_diameter / 0.1, &[]);
    let n = 64;
    let (mut fourfold, mut radial): (f64, f64) = (0.0, 0.0);
    for ring in 1..=6 {
        let radius = 0.25 * f64::from(ring) * RADIUS;
        let angles: Vec<f64> = (0..n).map(|i| TAU * f64::from(i) / f64::from(n)).collect();
        let x = air.settings().origin.x + 4.0 * air.settings().spacing;
        let positions: Vec<Vector3> = angles
            .iter()
            .map(|angle| Vector3::new(x, radius * angle.cos(), radius * angle.sin()))
            .collect();
        let mut velocities = vec![Vector3::ZERO; positions.len()];
        air.sample(&positions, &mut velocities);
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (angle, velocity) in angles.iter().zip(&velocities) {
            cosine += 2.0 * velocity.x * (4.0 * angle).cos() / f64::from(n);
            sine += 2.0 * velocity.x * (4.0 * angle).sin() / f64::from(n);
            let outwards = velocity.y * angle.cos() + velocity.z * angle.sin();
            radial = larger(radial, outwards.abs());
        }
        fourfold = larger(fourfold, cosine.hypot(sine));
    }
    [fourfold / SPEED, radial / SPEED]
}

/// A disc loaded more on one side, the heavy side along y or along the diagonal: the wake must not tell
/// which.
fn deflected_wakes() -> Vec<Row> {
    let mut rows = Vec::new();
    for stencil in STENCILS {
        let [along, diagonal] =
            [0.0, 0.25 * PI].map(|heavy| wake(stencil, 500.0, 100.0, move |_| heavy));
        for (what, index) in
            [("disc-mean wind at 3 D over free stream", 0), ("deflection at 3 D over diameter", 2)]
        {
            rows.push(Row {
                what: format!("deflected wake, {stencil:?}: {what}, diagonal less axis"),
                measured: diagonal[index] - along[index],
                expected: 0.0,
                tolerance: Within(0.01),
                unit: "-",
                source: SOURCE,
            });
        }
    }
    rows
}

/// A disc whose heavy side goes round at Strouhal number 0.25: D3Q19 against D3Q27.
fn helical_wake() -> Vec<Row> {
    let rate = TAU * 0.25 * SPEED / DIAMETER;
    let [small, large] =
        STENCILS.map(|stencil| wake(stencil, 720.0, 320.0, move |time| rate * time));
    [("mean wind at 3 D", 0), ("mean cubed wind at 3 D", 1)]
        .into_iter()
        .map(|(what, index)| Row {
            what: format!("helical wake, disc-{what} over free stream: D3Q19 less D3Q27"),
            measured: small[index] - large[index],
            expected: 0.0,
            tolerance: Within(0.02),
            unit: "-",
            source: SOURCE,
        })
        .collect()
}

/// Disc means of u and u³ over the free stream and distance of the wake's centre from the axis over the
/// diameter, three diameters behind a disc of thrust coefficient 0.8 whose load grows by 0.8 r/R towards
/// `heavy` (rad, from y to z).
fn wake(stencil: Stencil, duration: f64, averaging: f64, heavy: impl Fn(f64) -> f64) -> [f64; 3] {
    let cells_per_diameter = 16.0;
    let settings = settings(stencil, cells_per_diameter, 7.0);
    let (spacing, interval, air_density) =
        (settings.spacing, settings.interval, settings.air_density);
    let mut air = lattice(settings, |_, _| Vector3::new(SPEED, 0.0, 0.0));
    let n = 32;
    let points: Vec<[f64; 2]> = (0..n * n)
        .map(|i| [i % n, i / n].map(|j| (f64::from(j) + 0.5) / f64::from(n) - 0.5))
        .map(|place| place.map(|p| p * DIAMETER))
        .filter(|[y, z]| y.hypot(*z) <= RADIUS)
        .collect();
    let thrust =
        0.5 * air_density * SPEED * SPEED * 0.8 * PI * RADIUS * RADIUS / points.len() as f64;
    let mut forces = Vec::new();
    let mut mean = PlaneAverage::new(&air, "3D", PlaneAxes::Crosswind, 3.0 * DIAMETER);
    let n_steps = (duration / interval).round() as u32;
    let start = ((duration - averaging) / interval).round() as u32;
    let (mut cubes, mut n_instants) = (0.0, 0.0);
    for step in 0..n_steps {
        let angle = heavy(air.time());
        forces.clear();
        forces.extend(points.iter().map(|[y, z]| {
            let side = (y * angle.cos() + z * angle.sin()) / RADIUS;
            let force = Vector3::new(-thrust * (1.0 + 0.8 * side), 0.0, 0.0);
            PointForce::of_body(Vector3::new(0.0, *y, *z), force, 2.0 * spacing)
        }));
        advance(&mut air, 1.0, &forces);
        if step >= start && step.is_multiple_of(8) {
            mean.add(&air);
            cubes += disc_mean(&air, |u| u.powi(3));
            n_instants += 1.0;
        }
    }
    let plane = mean.mean();
    let (mut deficit, mut moment, mut sum, mut count) = (0.0, [0.0; 2], 0.0, 0.0);
    for (index, u) in plane.velocity[0].iter().enumerate() {
        let y = plane.origin[1] + plane.spacing[0] * (index % plane.n_points[0]) as f64;
        let z = plane.origin[2] + plane.spacing[1] * (index / plane.n_points[0]) as f64;
        let u = f64::from(*u) / SPEED;
        let lost = larger(1.0 - u, 0.0);
        deficit += lost;
        moment[0] += lost * y;
        moment[1] += lost * z;
        if y.hypot(z) <= RADIUS {
            sum += u;
            count += 1.0;
        }
    }
    let distance = moment[0].hypot(moment[1]) / deficit / DIAMETER;
    [sum / count, cubes / n_instants, distance]
}

/// Mean of `of`(u over free stream) on the disc three diameters downstream, now.
fn disc_mean(air: &Lattice, of: impl Fn(f64) -> f64) -> f64 {
    let n = 24;
    let positions: Vec<Vector3> = (0..n * n)
        .map(|i| [i % n, i / n].map(|j| ((f64::from(j) + 0.5) / f64::from(n) - 0.5) * DIAMETER))
        .filter(|[y, z]| y.hypot(*z) <= RADIUS)
        .map(|[y, z]| Vector3::new(3.0 * DIAMETER, y, z))
        .collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    air.sample(&positions, &mut velocities);
    velocities.iter().map(|v| of(v.x / SPEED)).sum::<f64>() / velocities.len() as f64
}
