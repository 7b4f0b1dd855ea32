//! Eddies whose viscosity follows from the wind of neighbours: formulas, boundaries, the same bits.

use super::*;
use crate::FlowSolver;
use crate::lattice::atmosphere::Atmosphere;
use crate::lattice::refinement::{Refined, Refinement, RefinementError};
use basis::PointForce;
use std::f64::consts::TAU;

const N_CELLS: [usize; 3] = [19, 6, 7];
const MODELS: [SubgridModel; 3] =
    [SubgridModel::Wale, SubgridModel::Vreman, SubgridModel::MinimumDissipation];

type Gradient = [[f64; 3]; 3];

/// Wind without any symmetry, periodic over [`N_CELLS`].
fn wind(position: Vector3) -> Vector3 {
    let [x, y, z]: [f64; 3] =
        std::array::from_fn(|axis| TAU * (position.to_array()[axis] + 0.5) / N_CELLS[axis] as f64);
    Vector3::new(
        0.03 + 0.02 * (y + 0.3).sin() * (z - x).cos(),
        0.01 * (x + 2.0 * z).sin() + 0.015 * (y + 0.4).cos(),
        0.02 * (x - 1.0).cos() * (y + z).sin(),
    )
}

/// Wind of cell `cell` of a box with `sides` and `ground`, beyond which it is mirrored, turned back or comes
/// again; along x it comes again.
fn beyond(settings: &LatticeSettings, cell: [i64; 3]) -> [f64; 3] {
    let mut sign = [1.0; 3];
    let mut place = cell;
    let turns = [false, settings.sides == Sides::Slip, settings.ground != Ground::Periodic];
    for axis in 0..3 {
        let n = N_CELLS[axis] as i64;
        if turns[axis] && !(0..n).contains(&place[axis]) {
            let holds = axis == 2
                && match settings.ground {
                    Ground::Plates => true,
                    Ground::NoSlip => place[axis] < 0,
                    _ => false,
                };
            for (component, sign) in sign.iter_mut().enumerate() {
                if holds || component == axis {
                    *sign = -*sign;
                }
            }
            place[axis] = if place[axis] < 0 { 0 } else { n - 1 };
        }
        place[axis] = place[axis].rem_euclid(n);
    }
    let [u, v, w] = wind(Vector3::from_array(place.map(|index| index as f64))).to_array();
    [sign[0] * u, sign[1] * v, sign[2] * w]
}

/// Central differences at a cell; over a rough ground the lowest level looks up alone.
fn gradient(settings: &LatticeSettings, cell: [usize; 3]) -> Gradient {
    let cell = cell.map(|index| index as i64);
    let mut gradient = [[0.0; 3]; 3];
    for axis in 0..3 {
        let at = |offset: i64| {
            let mut cell = cell;
            cell[axis] += offset;
            beyond(settings, cell)
        };
        let (before, here, behind) = (at(-1), at(0), at(1));
        let rough = matches!(settings.ground, Ground::WallStress { .. });
        for component in 0..3 {
            gradient[component][axis] = match axis == 2 && cell[2] == 0 && rough && component != 2 {
                true => behind[component] - here[component],
                false => 0.5 * (behind[component] - before[component]),
            };
        }
    }
    gradient
}

/// The models as their papers have them, in double precision; `lift` is the energy that buoyancy gives.
fn viscosity(model: SubgridModel, g: &Gradient, lift: f64) -> f64 {
    let sum = |f: &dyn Fn(usize, usize) -> f64| -> f64 {
        (0..3).flat_map(|i| (0..3).map(move |j| (i, j))).map(|(i, j)| f(i, j)).sum()
    };
    let strain = |i: usize, j: usize| 0.5 * (g[i][j] + g[j][i]);
    let product = |i: usize, j: usize| -> f64 { (0..3).map(|k| g[i][k] * g[j][k]).sum() };
    let square = |i: usize, j: usize| -> f64 { (0..3).map(|k| g[i][k] * g[k][j]).sum() };
    let all = sum(&|i, j| g[i][j] * g[i][j]);
    // Constants of the papers, written once more.
    let constant: f64 = match model {
        SubgridModel::Wale => 0.5,
        SubgridModel::Vreman => 0.07,
        _ => 0.3,
    };
    match model {
        SubgridModel::Smagorinsky => unreachable!("found in the collision"),
        SubgridModel::Wale => {
            let trace: f64 = (0..3).map(|i| square(i, i)).sum();
            let d = |i: usize, j: usize| {
                let isotropic = if i == j { trace / 3.0 } else { 0.0 };
                0.5 * (square(i, j) + square(j, i)) - isotropic
            };
            let (dd, ss) = (sum(&|i, j| d(i, j).powi(2)), sum(&|i, j| strain(i, j).powi(2)));
            constant.powi(2) * dd.powf(1.5) / (ss.powf(2.5) + dd.powf(1.25))
        }
        SubgridModel::Vreman => {
            let minor =
                |i: usize, j: usize| product(i, i) * product(j, j) - product(i, j) * product(i, j);
            constant * ((minor(0, 1) + minor(0, 2) + minor(1, 2)) / all).sqrt()
        }
        SubgridModel::MinimumDissipation => {
            constant * (lift - sum(&|i, j| product(i, j) * strain(i, j))).max(0.0) / all
        }
    }
}

fn settings(model: SubgridModel, backend: Backend) -> LatticeSettings {
    let mut settings = periodic_box(N_CELLS, 1e-3);
    settings.subgrid = Subgrid::new(model);
    settings.backend = Some(backend);
    settings
}

fn available() -> impl Iterator<Item = Backend> {
    Backend::ALL.into_iter().filter(|backend| backend.is_available())
}

#[test]
fn the_viscosity_is_that_of_the_papers_whatever_the_sides() {
    let grounds = [
        Ground::Periodic,
        Ground::Slip,
        Ground::WallStress { roughness_length: 0.01 },
        Ground::NoSlip,
        Ground::Plates,
    ];
    for (backend, model) in available().flat_map(|backend| MODELS.map(|model| (backend, model))) {
        for (number, ground) in grounds.into_iter().enumerate() {
            let mut settings = settings(model, backend);
            settings.ground = ground;
            settings.sides = if number % 2 == 1 { Sides::Slip } else { Sides::Periodic };
            let mut air = lattice(settings.clone(), |_, x| wind(x));
            air.advance(1.0, &[]).unwrap();
            let found = air.eddy_viscosity().unwrap();
            let [n_x, n_y, n_z] = N_CELLS;
            let mut greatest: f64 = 0.0;
            for (index, found) in found.iter().enumerate() {
                let cell = [index % n_x, index / n_x % n_y, index / n_x / n_y];
                let expected = viscosity(model, &gradient(&settings, cell), 0.0);
                greatest = greatest.max(expected);
                // Single precision of the wind, a hundredth of which the slopes are.
                let error = (found - expected).abs();
                assert!(error < 2e-6, "{backend:?} {model:?} {ground:?} {cell:?}: {error}");
            }
            assert_eq!(found.len(), n_x * n_y * n_z);
            assert!(greatest > 1e-4, "{model:?} {ground:?}: eddies of {greatest}");
        }
    }
}

/// Air with [`wind`] and [`warmth`].
struct Warm;

impl Inflow for Warm {
    fn sample(&self, _: f64, positions: &[Vector3], velocities: &mut [Vector3]) {
        for (position, velocity) in positions.iter().zip(velocities) {
            *velocity = wind(*position);
        }
    }

    fn sample_temperature(&self, _: f64, positions: &[Vector3], temperatures: &mut [f64]) -> bool {
        for (position, temperature) in positions.iter().zip(temperatures) {
            *temperature = warmth(*position);
        }
        true
    }
}

/// Temperature without symmetry (K), periodic along x and y.
fn warmth(position: Vector3) -> f64 {
    let [x, y, _]: [f64; 3] =
        std::array::from_fn(|axis| TAU * (position.to_array()[axis] + 0.5) / N_CELLS[axis] as f64);
    let z = position.z;
    300.0 + 0.3 * z + 0.02 * z * z + (0.5 + 0.1 * z) * ((x + 0.2).sin() + (y - 0.7).cos())
}

/// Slopes of [`warmth`] at a cell, and that upwards of what departs from the mean of each level: sides
/// mirror, the lowest and the highest level look to one side.
fn warm_slopes(settings: &LatticeSettings, cell: [usize; 3]) -> ([f64; 3], f64) {
    let [n_x, n_y, n_z] = N_CELLS.map(|n| n as i64);
    let at = |x: i64, y: i64, z: i64| {
        let y = match settings.sides {
            Sides::Slip | Sides::Open => y.clamp(0, n_y - 1),
            Sides::Periodic => y.rem_euclid(n_y),
        };
        warmth(Vector3::new(x.rem_euclid(n_x) as f64, y as f64, z as f64))
    };
    let [x, y, z] = cell.map(|index| index as i64);
    let (below, above) = ((z - 1).max(0), (z + 1).min(n_z - 1));
    let rise = 1.0 / (above - below) as f64;
    let level = |z: i64| -> f64 {
        let sum: f64 = (0..n_x * n_y).map(|index| at(index % n_x, index / n_x, z)).sum();
        sum / (n_x * n_y) as f64
    };
    let upwards = rise * (at(x, y, above) - at(x, y, below));
    let slopes = [
        0.5 * (at(x + 1, y, z) - at(x - 1, y, z)),
        0.5 * (at(x, y + 1, z) - at(x, y - 1, z)),
        upwards,
    ];
    (slopes, upwards - rise * (level(above) - level(below)))
}

#[test]
fn in_an_atmosphere_the_slope_of_temperature_holds_eddies_back_or_drives_them() {
    // Lattice units: an acceleration of g/θ₀ per kelvin that makes N² as large as the wind's slopes squared.
    for (gravity, ground) in [
        (0.03, Ground::WallStress { roughness_length: 0.01 }),
        (0.03, Ground::Plates),
        (0.1, Ground::Slip),
    ] {
        for (backend, model) in available().flat_map(|backend| MODELS.map(|model| (backend, model)))
        {
            let mut settings = settings(model, backend);
            settings.ground = ground;
            settings.sides = if ground == Ground::Plates { Sides::Slip } else { Sides::Periodic };
            settings.atmosphere = Some(Atmosphere { gravity, ..Atmosphere::new(300.0) });
            let buoyancy = gravity / 300.0;
            let mut air = Lattice::new(settings.clone(), Arc::new(Warm)).unwrap();
            air.advance(1.0, &[]).unwrap();
            let found = air.eddy_viscosity().unwrap();
            let [n_x, n_y, _] = N_CELLS;
            let mut moved: f64 = 0.0;
            for (index, found) in found.iter().enumerate() {
                let cell = [index % n_x, index / n_x % n_y, index / n_x / n_y];
                let g = gradient(&settings, cell);
                let ([tx, ty, tz], departing) = warm_slopes(&settings, cell);
                let neutral = viscosity(model, &g, 0.0);
                let all: f64 = g.iter().flatten().map(|slope| slope * slope).sum();
                let expected = match model {
                    SubgridModel::MinimumDissipation => {
                        let [wx, wy, wz] = g[2];
                        viscosity(model, &g, buoyancy * (wx * tx + wy * ty + wz * departing))
                    }
                    _ => {
                        // Pr = 1/3.
                        neutral * (1.0 - 3.0 * buoyancy * tz / all).max(0.0).sqrt()
                    }
                };
                moved = moved.max((expected - neutral).abs());
                // Of squares, for a root near nought magnifies what rounding left. The wind that the
                // pass finds has what buoyancy and ground did in half of the first step, some percent.
                let error = (found * found - expected * expected).abs();
                let size = neutral.max(expected).max(3e-4);
                assert!(
                    error < 0.25 * size * size,
                    "{backend:?} {model:?} {ground:?} {cell:?}: {found}, {expected}"
                );
            }
            assert!(moved > 1e-4, "{model:?} {ground:?}: temperature moves {moved}");
        }
    }
}

#[test]
fn pure_shear_makes_no_eddies() {
    for (backend, model) in available().flat_map(|backend| MODELS.map(|model| (backend, model))) {
        for axis in [1, 2] {
            let k = TAU / N_CELLS[axis] as f64;
            let mut air = lattice(settings(model, backend), move |_, x| {
                Vector3::new(0.05 * (k * x.to_array()[axis]).sin(), 0.0, 0.0)
            });
            // The first step's wind is what was given; later the lattice has air of its own across the shear,
            // by compression, a thousandth of it.
            air.advance(1.0, &[]).unwrap();
            let most = air.eddy_viscosity().unwrap().into_iter().fold(0.0, f64::max);
            // Rounding of other components, 1e-9 of a cell a step, times the slope's share.
            assert!(most < 1e-7, "{backend:?} {model:?} along {axis}: {most}");
        }
    }
}

#[test]
fn eddies_still_the_air_and_keep_its_momentum() {
    for model in MODELS {
        let energy = |subgrid: Subgrid| {
            let mut settings = settings(model, Backend::detect());
            settings.kinematic_viscosity = 1e-5;
            settings.subgrid = subgrid;
            let mut air = lattice(settings, |_, x| wind(x));
            air.advance(60.0, &[]).unwrap();
            let volume = air.volume(1);
            let squares = volume.velocity.iter().flatten().map(|u| f64::from(*u).powi(2));
            let sum: f64 = volume.velocity[0].iter().copied().map(f64::from).sum();
            (squares.sum::<f64>(), sum)
        };
        let (with, momentum) = energy(Subgrid::new(model));
        let (without, other) = energy(Subgrid::none());
        assert!(with < 0.999 * without, "{model:?}: {with} of {without}");
        assert!((momentum / other - 1.0).abs() < 1e-5, "{model:?}: {momentum} and {other}");
    }
}

#[test]
fn threads_and_resuming_change_no_bit() {
    for (model, ends) in
        MODELS.into_iter().zip([Ends::Periodic, Ends::InletOutlet, Ends::InletOutlet])
    {
        let begin = |threads| {
            let mut settings = settings(model, Backend::detect());
            settings.threads = Some(threads);
            settings.ends = ends;
            settings.ground = Ground::WallStress { roughness_length: 0.01 };
            lattice(settings, |_, x| wind(x))
        };
        let bits = |air: &Lattice| {
            let wind = air.volume(1).velocity.concat();
            let wind: Vec<u32> = wind.into_iter().map(f32::to_bits).collect();
            (wind, air.eddy_viscosity())
        };
        let push = |x| {
            let (position, force) = (Vector3::new(x, 3.0, 3.0), Vector3::new(-1e-3, 0.0, 0.0));
            [PointForce::of_body(position, force, 2.0)]
        };
        let [mut one, mut three] = [1, 3].map(begin);
        one.advance(7.0, &push(6.0)).unwrap();
        three.advance(7.0, &push(6.0)).unwrap();
        let mut kept = Vec::new();
        one.write_state(&mut kept).unwrap();
        assert!(bits(&one) == bits(&three), "{model:?}: threads");
        one.advance(6.0, &push(12.0)).unwrap();
        let mut resumed = begin(2);
        resumed.read_state(&mut kept.as_slice()).unwrap();
        assert!(bits(&resumed) == bits(&three), "{model:?}: read back");
        resumed.advance(6.0, &push(12.0)).unwrap();
        assert!(bits(&one) == bits(&resumed), "{model:?}: resumed");
    }
}

#[test]
fn a_state_of_another_model_is_refused() {
    let mut plain = lattice(settings(SubgridModel::Smagorinsky, Backend::detect()), |_, x| wind(x));
    let mut bytes = Vec::new();
    plain.write_state(&mut bytes).unwrap();
    let mut air = lattice(settings(SubgridModel::Wale, Backend::detect()), |_, x| wind(x));
    let error = air.read_state(&mut bytes.as_slice()).unwrap_err().to_string();
    assert!(error.contains("has model of eddies number 0, this lattice 1"), "{error}");
    let mut other = lattice(settings(SubgridModel::Vreman, Backend::detect()), |_, x| wind(x));
    let mut bytes = Vec::new();
    other.write_state(&mut bytes).unwrap();
    let error = air.read_state(&mut bytes.as_slice()).unwrap_err().to_string();
    assert!(error.contains("has model of eddies number 2, this lattice 1"), "{error}");
    assert!(plain.eddy_viscosity().is_none());
}

#[test]
fn boxes_of_finer_cells_are_refused_with_the_fix() {
    let settings = settings(SubgridModel::Vreman, Backend::detect());
    let boxes = [Refinement { first_cell: [4, 0, 0], n_cells: [6, 6, 7], within: Vec::new() }];
    let error = Refined::new(settings.clone(), &boxes, Arc::new(Wind(|_, x| wind(x)))).err();
    assert_eq!(error, Some(RefinementError::Subgrid(SubgridModel::Vreman)));
    let text = RefinementError::Subgrid(SubgridModel::Vreman).to_string();
    assert!(text.contains("vreman") && text.contains("take smagorinsky"), "{text}");
    assert!(Refined::new(settings, &[], Arc::new(Wind(|_, x| wind(x)))).is_ok());
}
