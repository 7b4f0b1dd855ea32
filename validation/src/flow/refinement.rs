//! Boxes of finer cells in the lattice beside closed forms and uniform grids.

use super::{SOURCE, Wind, periodic_box};
use crate::Row;
use crate::folds::worst;
use crate::row::Tolerance::{self, AtMost, Within};
use basis::Vector3;
use flow::FlowSolver;
use flow::lattice::refinement::{Refined, Refinement};
use flow::lattice::{DEFAULT_SMAGORINSKY, Lattice, LatticeSettings, Stencil};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Where limits come from that are neither closed forms nor other grids.
const LIMIT: &str = "limit of one per cent, set beforehand";
/// Where figures of uniform cells come from.
const UNIFORM: &str = "uniform grids, the fine one of half the spacing and half the step";

const STENCILS: [Stencil; 2] = [Stencil::D3Q19, Stencil::D3Q27];

/// What must be kept, a decaying vortex across a box, one carried through it, sound at its boundary.
pub fn refinement() -> Vec<Row> {
    [uniform_wind(), conservation(), taylor_green(), carried_vortex(), sound()].concat()
}

fn row(
    what: String,
    measured: f64,
    expected: f64,
    tolerance: Tolerance,
    source: &'static str,
) -> Row {
    Row { what, measured, expected, tolerance, unit: "-", source }
}

/// The cells that a flow is computed on.
#[derive(Clone, Copy)]
enum Grid<'a> {
    Coarse,
    /// Coarse ones, and boxes in them.
    Boxed(&'a [Refinement]),
    /// Of half the size, moved by steps of half the length.
    Fine,
}

/// Air that begins as `wind` on the cells `on`, of which the coarse ones are those of `coarse`.
fn air(
    coarse: &LatticeSettings,
    on: Grid,
    wind: impl Fn(Vector3) -> Vector3 + Send + Sync + 'static,
) -> Refined {
    let mut settings = coarse.clone();
    // So few cells that threads would only wait for each other.
    settings.threads = Some(1);
    let boxes = match on {
        Grid::Boxed(boxes) => boxes,
        Grid::Coarse | Grid::Fine => &[],
    };
    if let Grid::Fine = on {
        settings.spacing *= 0.5;
        settings.interval *= 0.5;
        settings.n_cells = settings.n_cells.map(|n| 2 * n);
    }
    Refined::new(settings, boxes, Arc::new(Wind(move |_, position| wind(position))))
        .expect("settings of a validation are sound")
}

fn advance(air: &mut Refined, duration: f64) {
    air.advance(duration, &[]).expect("flows of a validation stay finite");
}

/// A box of `n_cells` cells from `first_cell` on.
fn cells(first_cell: [usize; 3], n_cells: [usize; 3]) -> Refinement {
    Refinement { first_cell, n_cells, within: Vec::new() }
}

/// A cell that no box covers.
struct Cell {
    /// Its centre (m).
    centre: Vector3,
    /// Its wind (m/s).
    velocity: Vector3,
    /// Its volume (m³).
    volume: f64,
}

/// All cells that no box covers, of all grids.
fn seen_cells(air: &Refined) -> Vec<Cell> {
    let lattices = air.lattices();
    let mut all = Vec::new();
    for (number, lattice) in lattices.iter().enumerate() {
        let field = lattice.volume(1);
        let [n_x, n_y, _] = field.n_points;
        for index in 0..field.velocity[0].len() {
            let place = [index % n_x, index / n_x % n_y, index / n_x / n_y];
            let centre =
                field.origin + Vector3::from_array(place.map(|n| n as f64)) * field.spacing;
            // Of the grids behind it in the list some lie in it, the others apart from it.
            if !lattices[number + 1..].iter().any(|other| holds(other, centre)) {
                let velocity = field.velocity.each_ref().map(|values| f64::from(values[index]));
                let velocity = Vector3::from_array(velocity);
                all.push(Cell { centre, velocity, volume: field.spacing.powi(3) });
            }
        }
    }
    all
}

/// Whether `position` (m) lies in a cell of `lattice`.
fn holds(lattice: &Lattice, position: Vector3) -> bool {
    let place = lattice.scaling().to_lattice_position(position).to_array();
    place.iter().zip(lattice.n_cells()).all(|(place, n)| (-0.5..n as f64 - 0.5).contains(place))
}

/// Largest departure of a uniform wind from itself in a box within a box.
fn uniform_wind() -> Vec<Row> {
    let wind = Vector3::new(0.06, -0.03, 0.02);
    STENCILS
        .iter()
        .map(|stencil| {
            let mut settings = periodic_box([24, 20, 20], 1e-4, DEFAULT_SMAGORINSKY);
            settings.stencil = *stencil;
            let mut place = cells([5, 4, 4], [12, 11, 10]);
            place.within.push(cells([6, 5, 4], [10, 12, 8]));
            let mut air = air(&settings, Grid::Boxed(&[place]), move |_| wind);
            advance(&mut air, 200.0);
            let departures = seen_cells(&air);
            let departures =
                departures.iter().map(|cell| (cell.velocity - wind).length() / wind.length());
            let what = format!("uniform wind through a box in a box, {stencil:?}: largest departure from one, 200 steps");
            row(what, worst(departures), 1e-5, AtMost, SOURCE)
        })
        .collect()
}

/// Change of mass and momentum of air in disorder, with a box in a box and one beside them.
fn conservation() -> Vec<Row> {
    let mut rows = Vec::new();
    for stencil in STENCILS {
        let mut settings = periodic_box([20, 16, 14], 1e-5, DEFAULT_SMAGORINSKY);
        settings.stencil = stencil;
        let mut one = cells([3, 3, 3], [8, 8, 7]);
        one.within.push(cells([4, 5, 3], [8, 7, 6]));
        let mut air = air(&settings, Grid::Boxed(&[one, cells([14, 5, 4], [3, 4, 6])]), |x| {
            let swirl = |a: f64, b: f64| (2.1 * a + 0.9 * b).sin() * (1.3 * b - 0.4 * a).cos();
            Vector3::new(0.03, 0.01, -0.02)
                + 0.04 * Vector3::new(swirl(x.y, x.z), swirl(x.z, x.x), swirl(x.x, x.y))
        });
        let (mass, momentum) = (air.mass(), air.momentum());
        advance(&mut air, 500.0);
        let changes = [
            ("mass", air.mass() / mass - 1.0, Within(1e-6)),
            ("momentum", (air.momentum() - momentum).length() / momentum.length(), Within(1e-6)),
        ];
        rows.extend(changes.map(|(name, measured, tolerance)| {
            let what = format!("air in disorder, boxes in it, {stencil:?}: relative change of {name} over 500 steps");
            row(what, measured, 0.0, tolerance, SOURCE)
        }));
    }
    rows
}

/// Order of convergence of a Taylor-Green vortex with a quarter of it in a box, and its error beside that on
/// uniform cells, after a decay time.
///
/// The vortex and the wind are slower on smaller cells (as many cells² a step), so that what compressing the
/// air does is of second order, too.
fn taylor_green() -> Vec<Row> {
    let mut rows = Vec::new();
    for (name, wind) in
        [("in still air", Vector3::ZERO), ("carried by the wind", Vector3::new(0.05, 0.02, 0.0))]
    {
        let of = format!("Taylor-Green across a box, {name}");
        let sizes = [16, 32, 64];
        let errors = sizes.map(|n| {
            let place = [cells([n / 4, n / 4, 0], [n / 2, n / 2, 1])];
            taylor_green_on(n, Grid::Boxed(&place), wind)
        });
        for pair in 0..sizes.len() - 1 {
            let order = (errors[pair] / errors[pair + 1]).log2();
            let what =
                format!("{of}: order of convergence, {} to {} cells", sizes[pair], sizes[pair + 1]);
            rows.push(row(what, order, 2.0, Within(0.3), SOURCE));
        }
        for (n, error) in sizes.into_iter().zip(errors) {
            let [coarse, fine] = [Grid::Coarse, Grid::Fine].map(|on| taylor_green_on(n, on, wind));
            tell!(
                "{of}, {n} cells: error {coarse:.5} coarse, {error:.5} with the box, {fine:.5} fine"
            );
            let what = format!("{of}, {n} cells: error over that of coarse cells alone");
            rows.push(row(what, error / coarse, 1.0, AtMost, UNIFORM));
            // A boundary without error of its own would leave each part of the air that of its cells.
            let parts = (0.75 * coarse * coarse + 0.25 * fine * fine).sqrt();
            let what = format!(
                "{of}, {n} cells: error over those of coarse and of fine cells, each on its part"
            );
            rows.push(row(what, error / parts, 1.1, AtMost, UNIFORM));
        }
    }
    rows
}

/// Relative error of the vortex after a decay time, `n` coarse cells a side; `wind` is that on 16.
fn taylor_green_on(n: usize, on: Grid, wind: Vector3) -> f64 {
    let k = TAU / n as f64;
    let viscosity = 0.02;
    let slower = 16.0 / n as f64;
    let (speed, wind) = (0.04 * slower, wind * slower);
    let vortex = move |position: Vector3| {
        let (x, y) = (k * position.x, k * position.y);
        Vector3::new(x.cos() * y.sin(), -x.sin() * y.cos(), 0.0) * speed
    };
    let coarse = periodic_box([n, n, 1], viscosity, 0.0);
    let mut air = air(&coarse, on, move |position| wind + vortex(position));
    let rate = 2.0 * viscosity * k * k;
    let duration = (1.0 / rate).round();
    advance(&mut air, duration);
    let (mut error, mut norm) = (0.0, 0.0);
    for Cell { centre, velocity, volume } in seen_cells(&air) {
        let exact = vortex(centre - wind * duration) * (-rate * duration).exp();
        error += volume * (velocity - wind - exact).length_squared();
        norm += volume * exact.length_squared();
    }
    (error / norm).sqrt()
}

/// Fastest wind of the vortex that is carried (m/s).
const VORTEX_SPEED: f64 = 0.02;
/// Coarse cells along the wind and across it.
const CARRIED_OVER: [usize; 2] = [112, 48];

/// A vortex that the wind carries through a box, and through a box in a box, beside the same on uniform
/// cells: how far it is off from the fine ones', and what it leaves behind.
fn carried_vortex() -> Vec<Row> {
    let one = cells([40, 10, 0], [32, 28, 1]);
    let mut nested = one.clone();
    nested.within.push(cells([16, 8, 0], [32, 40, 2]));
    let length = |values: &[Vector3]| values.iter().map(|v| v.length_squared()).sum::<f64>().sqrt();
    let mut rows = Vec::new();
    for radius in [3.0, 5.0] {
        let fine = carried(radius, Grid::Fine);
        let compare = |on: Grid| {
            let other = carried(radius, on);
            let off: Vec<_> = other.iter().zip(&fine).map(|(other, fine)| *other - *fine).collect();
            let behind = off.iter().enumerate().filter(|(index, _)| index % CARRIED_OVER[0] < 64);
            let left = worst(behind.map(|(_, off)| off.length())) / VORTEX_SPEED;
            (length(&off) / length(&fine), left)
        };
        let (coarse, coarse_left) = compare(Grid::Coarse);
        tell!(
            "vortex of radius {radius}, coarse cells alone: off by {coarse:.4}, {coarse_left:.5} left behind"
        );
        for (name, place) in [("a box", &one), ("a box in a box", &nested)] {
            let (off, left) = compare(Grid::Boxed(std::slice::from_ref(place)));
            tell!("in {name}: off by {off:.4}, {left:.5} left behind");
            let of = format!("vortex of radius {radius} cells carried through {name}");
            let what = format!("{of}: difference from fine cells, over that of coarse cells alone");
            rows.push(row(what, off / coarse, 1.0, AtMost, UNIFORM));
            let what = format!("{of}: most that is left behind, over its wind");
            rows.push(row(what, left, 0.01, AtMost, LIMIT));
        }
    }
    rows
}

/// The wind of a vortex of `radius` cells beside that which has carried it 64 cells: on each coarse cell the
/// mean over it.
fn carried(radius: f64, on: Grid) -> Vec<Vector3> {
    let [n_x, n_y] = CARRIED_OVER;
    let coarse = periodic_box([n_x, n_y, 1], 1e-5, DEFAULT_SMAGORINSKY);
    let wind = Vector3::new(0.1, 0.0, 0.0);
    let mut air = air(&coarse, on, move |position| {
        let d = (position - Vector3::new(20.0, 24.0, 0.0)) / radius;
        let swirl = VORTEX_SPEED * (0.5 - 0.5 * (d.x * d.x + d.y * d.y)).exp();
        wind + Vector3::new(-swirl * d.y, swirl * d.x, 0.0)
    });
    advance(&mut air, 640.0);
    let mut means = vec![Vector3::ZERO; coarse.cells()];
    for Cell { centre, velocity, volume } in seen_cells(&air) {
        let [x, y, _] = coarse.scaling().to_lattice_position(centre).round().to_array();
        means[y as usize * n_x + x as usize] += (velocity - wind) * volume;
    }
    means
}

/// What of a pulse of sound comes back from the boundary of a box, over what goes on as far on cells like
/// those that it began on, without a box: the most in still air and in wind, of a box from side to side and
/// of one half as wide.
fn sound() -> Vec<Row> {
    let winds = [Vector3::ZERO, Vector3::new(0.05, 0.03, 0.0)];
    // With the cells across.
    let boxes = [(1, [cells([80, 0, 0], [80, 1, 1])]), (20, [cells([80, 5, 0], [80, 10, 1])])];
    let mut rows = Vec::new();
    for stencil in STENCILS {
        for (way, start, alike) in [("into", 40.0, Grid::Coarse), ("out of", 120.0, Grid::Fine)] {
            let mut shares = Vec::new();
            for wind in winds {
                for (n_y, place) in &boxes {
                    let air = |on| pulse(stencil, *n_y, on, start, wind);
                    let ([echo, _], [silent, free]) = (air(Grid::Boxed(place)), air(alike));
                    tell!(
                        "sound {way} a box, {stencil:?}, {n_y} cells across, wind {wind}: {echo:.5} back"
                    );
                    tell!("without a box {silent:.5} there, and {free:.5} goes on");
                    shares.push(echo / free);
                }
            }
            let what = format!("pulse of sound {way} a box, {stencil:?}: share that comes back");
            rows.push(row(what, worst(shares), 0.01, AtMost, LIMIT));
        }
    }
    rows
}

/// Strongest sound where an echo is on its way back, and where sound goes on, over what came (–).
///
/// A pulse ten cells long, which the lattice damps with its bulk viscosity, begins at cell `start` and
/// splits. 110 steps later the half that goes downstream has passed the boundary, 40 cells on.
fn pulse(stencil: Stencil, n_y: usize, on: Grid, start: f64, wind: Vector3) -> [f64; 2] {
    let strength = 1e-3;
    let mut coarse = periodic_box([240, n_y, 1], 1e-3, 0.0);
    coarse.stencil = stencil;
    let mut air = air(&coarse, on, move |position| {
        let bump = (-((position.x - start) / 5.0).powi(2)).exp();
        wind + Vector3::X * (2.0 * strength * bump)
    });
    advance(&mut air, 110.0);
    let all = seen_cells(&air);
    // Sound has gone 63 cells, and up to six with the wind.
    [2.0..=33.0, 50.0..=80.0].map(|range| {
        let there = all.iter().filter(|cell| range.contains(&(cell.centre.x - start)));
        worst(there.map(|cell| (cell.velocity - wind).length())) / strength
    })
}
