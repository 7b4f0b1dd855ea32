//! The budget of a wake on the lattice: behind a disc of uniform thrust in wind with eddies.

use crate::Row;
use crate::folds::worst;
use crate::random::Random;
use crate::row::Tolerance::AtMost;
use analysis::entrainment::{Budget, MeanFlow, Region, budget};
use analysis::grids::slopes;
use basis::records::{Grid, STRESSES};
use basis::{PointForce, Vector3};
use flow::lattice::{Ground, Lattice, LatticeSettings};
use flow::{FlowSolver, Inflow, WindField};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const DIAMETER: f64 = 100.0;
const SPEED: f64 = 10.0;
const THRUST_COEFFICIENT: f64 = 0.75;
/// Deviation of the eddies' speed over the wind's (–).
const TURBULENCE: f64 = 0.06;
const N_EDDIES: usize = 24;
/// Cells a diameter: those of the budgets, and finer ones that tell what they owe to their spacing.
const CELLS_PER_DIAMETER: [usize; 2] = [16, 24];
/// Cells that the wind passes in a step (–).
const LATTICE_SPEED: f64 = 0.1;
/// Diameters of wind that pass before averages begin, and in them.
const SETTLING: usize = 12;
const AVERAGED: usize = 60;
/// Instants in a diameter of wind that averages are made of.
const INSTANTS: usize = 10;
/// Ends of the boxes behind the disc (diameters).
const ENDS: [usize; 4] = [1, 2, 3, 4];

/// Even wind with eddies that it carries: waves that are free of divergence, half a diameter to two long.
struct Eddies(Vec<Wave>);

struct Wave {
    wavenumber: Vector3,
    amplitude: Vector3,
    phase: f64,
}

impl Eddies {
    fn new(random: &mut Random) -> Self {
        let direction = |random: &mut Random| {
            Vector3::new(random.normal(), random.normal(), random.normal()).normalize()
        };
        // All waves together have the deviation in each of three components.
        let size = TURBULENCE * SPEED * (6.0 / N_EDDIES as f64).sqrt();
        let wave = |_| {
            let length = 0.5 * DIAMETER * 4.0_f64.powf(random.uniform());
            let along = direction(random);
            let amplitude = size * along.cross(direction(random)).normalize();
            Wave { wavenumber: TAU / length * along, amplitude, phase: TAU * random.uniform() }
        };
        Self((0..N_EDDIES).map(wave).collect())
    }
}

impl Inflow for Eddies {
    fn sample(&self, time: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            let carried = *position - Vector3::new(SPEED * time, 0.0, 0.0);
            *velocity = Vector3::new(SPEED, 0.0, 0.0);
            for wave in &self.0 {
                *velocity += wave.amplitude * (wave.wavenumber.dot(carried) + wave.phase).cos();
            }
        }
    }
}

/// What a budget is made of.
#[derive(Clone, Copy, PartialEq)]
enum Known {
    /// Velocity alone, as planes and instants of a run keep it.
    Velocity,
    /// Pressure too, as averages of a volume keep it.
    Pressure,
    /// The work of subgrid stresses too.
    All,
}

/// Sums over instants, point by point.
struct Sums {
    grid: Grid,
    positions: Vec<Vector3>,
    n_instants: f64,
    velocity: [Vec<f64>; 3],
    products: [Vec<f64>; 6],
    /// Of the model's eddies below the cells (m²/s²).
    subgrid: [Vec<f64>; 6],
    /// Over density (m²/s²).
    pressure: Vec<f64>,
}

impl Sums {
    fn new(grid: Grid) -> Self {
        let zeros = || vec![0.0; grid.len()];
        let position = |index| Vector3::from_array(grid.position(grid.place(index)));
        Self {
            grid,
            positions: (0..grid.len()).map(position).collect(),
            n_instants: 0.0,
            velocity: [zeros(), zeros(), zeros()],
            products: std::array::from_fn(|_| zeros()),
            subgrid: std::array::from_fn(|_| zeros()),
            pressure: zeros(),
        }
    }

    fn add(&mut self, air: &Lattice) {
        let mut sampled = vec![Vector3::ZERO; self.positions.len()];
        air.sample(&self.positions, &mut sampled);
        let velocity: [Vec<f64>; 3] =
            std::array::from_fn(|c| sampled.iter().map(|v| v.to_array()[c]).collect());
        let gradient: [[Vec<f64>; 3]; 3] = std::array::from_fn(|component| {
            std::array::from_fn(|axis| slopes(&self.grid, &velocity[component], axis))
        });
        let settings = air.settings();
        let length = settings.subgrid.constant * settings.spacing;
        for index in 0..self.positions.len() {
            let strain = |i: usize, j: usize| 0.5 * (gradient[i][j][index] + gradient[j][i][index]);
            let squares: f64 =
                (0..9).map(|place| strain(place / 3, place % 3).powi(2)).sum::<f64>();
            let viscosity = settings.kinematic_viscosity + length * length * (2.0 * squares).sqrt();
            for (component, sum) in self.velocity.iter_mut().enumerate() {
                sum[index] += velocity[component][index];
            }
            for (part, [i, j]) in STRESSES.iter().enumerate() {
                self.products[part][index] += velocity[*i][index] * velocity[*j][index];
                self.subgrid[part][index] -= 2.0 * viscosity * strain(*i, *j);
            }
            self.pressure[index] += air.pressure(self.positions[index]) / settings.air_density;
        }
        self.n_instants += 1.0;
    }

    /// Budgets of the boxes, of what is `known`.
    fn budgets(&self, known: Known) -> Vec<Budget> {
        let n = self.n_instants;
        let over = |values: &Vec<f64>| -> Vec<f64> { values.iter().map(|sum| sum / n).collect() };
        let mean = self.velocity.each_ref().map(over);
        let stress: [Vec<f64>; 6] = std::array::from_fn(|part| {
            let [i, j] = STRESSES[part];
            let of = |index: usize| {
                let resolved = self.products[part][index] / n - mean[i][index] * mean[j][index];
                resolved + if known == Known::All { self.subgrid[part][index] / n } else { 0.0 }
            };
            (0..self.grid.len()).map(of).collect()
        });
        let pressure = over(&self.pressure);
        let flow = MeanFlow {
            grid: &self.grid,
            mean: &mean,
            stress: &stress,
            pressure: (known != Known::Velocity).then_some(&pressure[..]),
        };
        let step = |axis: usize, place: f64| {
            ((place - self.grid.origin[axis]) / self.grid.spacing[axis]).round() as usize
        };
        let of = |ends: &[usize]| {
            let sides = [1, 2].map(|axis| [-0.5, 0.5].map(|side| step(axis, side * DIAMETER)));
            let along = [ends[0], ends[1]].map(|end| step(0, end as f64 * DIAMETER));
            budget(&flow, &Region { steps: [along, sides[0], sides[1]] })
        };
        ENDS.windows(2).filter_map(of).collect()
    }
}

/// Points of a disc twice as dense as the cells, their thrust smeared over a cell.
fn disc(spacing: f64, air_density: f64) -> Vec<PointForce> {
    let n = (2.0 * DIAMETER / spacing).round() as usize;
    let place = |step: usize| ((step as f64 + 0.5) / n as f64 - 0.5) * DIAMETER;
    let points: Vec<Vector3> = (0..n * n)
        .map(|index| Vector3::new(0.0, place(index % n), place(index / n)))
        .filter(|point| point.length() <= 0.5 * DIAMETER)
        .collect();
    let head = 0.5 * air_density * SPEED * SPEED;
    let thrust = head * THRUST_COEFFICIENT * PI / 4.0 * DIAMETER * DIAMETER / points.len() as f64;
    let force = Vector3::new(-thrust, 0.0, 0.0);
    points.into_iter().map(|point| PointForce::of_body(point, force, spacing)).collect()
}

/// Averages of the wake on `n` cells a diameter.
fn averages(n: usize, wind: &Arc<Eddies>) -> Sums {
    let spacing = DIAMETER / n as f64;
    // Cells' centres lie on the axis and at whole diameters.
    let corner = |diameters: usize| -(diameters as f64) * DIAMETER - 0.5 * spacing;
    let origin = Vector3::new(corner(2), corner(2), corner(2));
    let n_cells = [15 * n / 2, 4 * n, 4 * n];
    let interval = LATTICE_SPEED * spacing / SPEED;
    let mut settings = LatticeSettings::new(origin, spacing, n_cells, interval, SPEED);
    settings.ground = Ground::Periodic;
    let forces = disc(spacing, settings.air_density);
    let mut air = Lattice::new(settings, wind.clone()).expect("settings of a validation are sound");
    let advance = |air: &mut Lattice, n_steps: usize| {
        air.advance(n_steps as f64 * interval, &forces).expect("the wake stays finite");
    };
    let of_a_diameter = (n as f64 / LATTICE_SPEED).round() as usize;
    advance(&mut air, SETTLING * of_a_diameter);
    let mut sums = Sums::new(Grid {
        origin: [0.75 * DIAMETER, -0.75 * DIAMETER, -0.75 * DIAMETER],
        spacing: [spacing; 3],
        n_points: [7 * n / 2 + 1, 3 * n / 2 + 1, 3 * n / 2 + 1],
    });
    let stride = of_a_diameter / INSTANTS;
    for _ in 0..AVERAGED * INSTANTS {
        advance(&mut air, stride);
        sums.add(&air);
    }
    sums
}

pub(super) fn rows(random: &mut Random) -> Vec<Row> {
    let wind = Arc::new(Eddies::new(random));
    let [coarse, fine] = CELLS_PER_DIAMETER.map(|n| averages(n, &wind));
    let over = |budgets: &[Budget], measure: fn(&Budget) -> f64| {
        let shares = budgets.iter().map(|one| 100.0 * (one.residual() / measure(one)).abs());
        if budgets.len() + 1 == ENDS.len() { worst(shares) } else { f64::NAN }
    };
    let all = |one: &Budget| one.scale;
    let sides = |one: &Budget| one.through_sides;
    let row = |text: &str, measured: f64| Row {
        what: format!("wake of a disc on the lattice, boxes of 1 D from 1 to 4 D: {text}"),
        measured,
        expected: 3.0,
        tolerance: AtMost,
        unit: "%",
        source: "conservation of mean kinetic energy",
    };
    vec![
        row(
            "largest residual over the flux through all faces",
            over(&coarse.budgets(Known::All), all),
        ),
        row(
            "the same without the work of subgrid stresses, as runs keep averages of volumes",
            over(&coarse.budgets(Known::Pressure), all),
        ),
        row(
            "the same without the work of pressure either, as runs keep instants",
            over(&coarse.budgets(Known::Velocity), all),
        ),
        row(
            "largest residual over the flux by stresses through the sides, 16 cells a diameter",
            over(&coarse.budgets(Known::All), sides),
        ),
        row("the same on 24 cells a diameter", over(&fine.budgets(Known::All), sides)),
    ]
}
