//! Another engine under the lattice: plain memory of its own, one cell after the other, the same bits.

use super::*;
use crate::lattice::collision::{Relaxation, SUBGRID_FACTOR, collide, relaxation_rate};
use crate::lattice::spreading::Spreader;
use crate::lattice::stencil::{D3Q19, Moments, Stencil as _};
use crate::simd::{MAXIMUM_LANES, Portable, Simd};
use crate::{FlowSolver, WindField};
use basis::PointForce;
use basis::records::PlaneAxes;
use std::io::{Read, Result, Write};

/// A box on all sides periodic; populations that have arrived, cell after cell.
struct Plain {
    n_cells: [usize; 3],
    populations: Vec<[f32; 19]>,
    spreader: Spreader,
    scaling: Scaling,
    relaxation: Relaxation<Portable>,
    n_steps: u64,
}

fn first_lane(value: Portable) -> f32 {
    let mut lanes = [0.0; MAXIMUM_LANES];
    // SAFETY: room for the widest vector.
    unsafe { value.store(lanes.as_mut_ptr()) };
    lanes[0]
}

fn moments_of(populations: &[f32; 19]) -> Moments<Portable> {
    D3Q19::moments(&populations.map(Portable::splat))
}

impl Plain {
    fn new(settings: &LatticeSettings) -> Self {
        let scaling = settings.scaling();
        let viscosity = scaling.to_lattice_viscosity(settings.kinematic_viscosity);
        let subgrid = (SUBGRID_FACTOR * settings.subgrid.constant.powi(2)) as f32;
        Self {
            n_cells: settings.n_cells,
            populations: vec![[0.0; 19]; settings.cells()],
            spreader: Spreader::new(settings.scaling(), settings.n_cells),
            relaxation: Relaxation {
                time: Portable::splat((0.5 + 3.0 * viscosity) as f32),
                subgrid: Portable::splat(subgrid),
            },
            scaling,
            n_steps: 0,
        }
    }

    fn place(&self, index: usize) -> [usize; 3] {
        let [n_x, n_y, _] = self.n_cells;
        [index % n_x, index / n_x % n_y, index / n_x / n_y]
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.n_cells[1] + y) * self.n_cells[0] + x
    }

    /// Density less one and velocity of cell number `index`.
    fn state(&self, index: usize) -> [f32; 4] {
        let Moments { density_excess, velocity: [u, v, w], .. } =
            moments_of(&self.populations[index]);
        [density_excess, u, v, w].map(first_lane)
    }
}

impl Engine for Plain {
    fn start(&mut self, inflow: &dyn Inflow) {
        for index in 0..self.populations.len() {
            let cell = Vector3::from_array(self.place(index).map(|n| n as f64));
            let mut wind = [Vector3::ZERO];
            inflow.sample(0.0, &[self.scaling.to_si_position(cell)], &mut wind);
            let velocity = self.scaling.to_lattice_velocity(wind[0]).as_vec3().to_array();
            let zero = Portable::splat(0.0);
            let moments = Moments::new(zero, velocity.map(Portable::splat), [zero; 6]);
            self.populations[index] = D3Q19::populations(&moments).map(first_lane);
        }
        self.n_steps = 0;
    }

    fn set_forces(&mut self, forces: &[PointForce]) {
        self.spreader.spread(forces);
    }

    fn step(&mut self, _: &dyn Inflow) {
        let mut next = self.populations.clone();
        for (index, populations) in self.populations.iter().enumerate() {
            let [x, y, z] = self.place(index);
            let force = self.spreader.blocks().iter().find_map(|block| block.at(x, y, z));
            let before = moments_of(populations);
            let rate = relaxation_rate(&before, &self.relaxation);
            let after = collide(&before, rate, force.map(|force| force.map(Portable::splat)));
            for (q, value) in D3Q19::populations(&after).into_iter().enumerate() {
                let there: [usize; 3] = std::array::from_fn(|axis| {
                    let step = isize::from(D3Q19::DIRECTIONS[q][axis]);
                    ([x, y, z][axis] as isize + step).rem_euclid(self.n_cells[axis] as isize)
                        as usize
                });
                next[self.index(there)][q] = first_lane(value);
            }
        }
        self.populations = next;
        self.n_steps += 1;
    }

    fn n_steps(&self) -> u64 {
        self.n_steps
    }

    fn read_row(&self, row: usize, state: &mut RowState) {
        for x in 0..self.n_cells[0] {
            let [excess, velocity @ ..] = self.state(row * self.n_cells[0] + x);
            state.density_excess[x] = excess;
            for (column, value) in state.velocity.iter_mut().zip(velocity) {
                column[x] = value;
            }
        }
    }

    fn read_cells(&self, cells: &[[usize; 3]; 8]) -> [[f32; 8]; 4] {
        let states = cells.map(|cell| self.state(self.index(cell)));
        std::array::from_fn(|component| states.map(|state| state[component]))
    }

    fn see_forces(&self, _: usize, see: &mut dyn FnMut(&[ForceBlock])) {
        see(self.spreader.blocks());
    }

    fn look(&mut self, _: usize, _: usize) -> Option<([usize; 3], f32)> {
        let bad = |index: &usize| self.state(*index).iter().any(|value| !value.is_finite());
        (0..self.populations.len()).find(bad).map(|index| (self.place(index), f32::NAN))
    }

    fn write_state(&self, writer: &mut dyn Write) -> Result<()> {
        self.populations.as_flattened().iter().try_for_each(|v| writer.write_all(&v.to_le_bytes()))
    }

    fn read_state(&mut self, n_steps: u64, reader: &mut dyn Read) -> Result<()> {
        for value in self.populations.as_flattened_mut() {
            let mut bytes = [0; 4];
            reader.read_exact(&mut bytes)?;
            *value = f32::from_le_bytes(bytes);
        }
        self.n_steps = n_steps;
        Ok(())
    }

    fn backend(&self) -> &'static str {
        "plain"
    }

    fn n_threads(&self) -> usize {
        1
    }

    fn memory(&self) -> u64 {
        size_of_val(&*self.populations) as u64
    }
}

/// Air that swirls, on the processor's engine and on the plain one.
fn both() -> [Lattice; 2] {
    let mut settings = periodic_box([20, 9, 7], 1e-3);
    settings.subgrid = Subgrid::smagorinsky(0.12);
    settings.backend = Some(Backend::Portable);
    let swirl = || {
        Arc::new(Wind(|_: f64, x: Vector3| {
            let [a, b] = [x.y, x.z].map(|place| 0.7 * place);
            Vector3::new(0.05 + 0.02 * a.sin(), 0.03 * b.cos(), 0.02 * (0.3 * x.x).sin())
        }))
    };
    let plain = Box::new(Plain::new(&settings));
    [
        Lattice::new(settings.clone(), swirl()).expect("sound settings"),
        Lattice::on(plain, settings, swirl()).expect("sound settings"),
    ]
}

fn pull() -> [PointForce; 2] {
    [4.2, 11.7].map(|x| {
        let force = Vector3::new(-0.02, 0.004, 0.001);
        PointForce::of_body(Vector3::new(x, 4.3, 3.6), force, 1.5)
    })
}

/// What others see of the air, as bits.
fn seen(air: &Lattice) -> Vec<u64> {
    let positions: Vec<Vector3> = (0..200)
        .map(|k| Vector3::new(0.17, 0.29, 0.41) * f64::from(k) + Vector3::new(-1.0, 0.2, 0.3))
        .collect();
    let mut wind = vec![Vector3::ZERO; positions.len()];
    air.sample(&positions, &mut wind);
    let mut values: Vec<f64> = wind.iter().flat_map(Vector3::to_array).collect();
    let pressure = air.pressure(Vector3::new(5.5, 4.0, 3.0));
    values.extend([air.time(), air.mass(), pressure].into_iter().chain(air.momentum().to_array()));
    for axes in [PlaneAxes::Horizontal, PlaneAxes::Streamwise, PlaneAxes::Crosswind] {
        let plane = air.plane("here", axes, 3.3);
        values.extend(plane.velocity.iter().flatten().map(|value| f64::from(*value)));
    }
    values.extend(air.volume(2).velocity.iter().flatten().map(|value| f64::from(*value)));
    values.into_iter().map(f64::to_bits).collect()
}

#[test]
fn an_engine_with_memory_of_its_own_gives_the_same_bits() {
    let [mut cpu, mut plain] = both();
    assert_eq!(seen(&cpu), seen(&plain));
    // An odd number of steps, then an even one: the processor's engine keeps its populations differently
    // after either.
    for n_steps in [1.0, 32.0, 8.0] {
        for air in [&mut cpu, &mut plain] {
            air.advance(n_steps, &pull()).expect("no divergence");
        }
        assert_eq!(cpu.n_steps(), plain.n_steps());
        assert_eq!(seen(&cpu), seen(&plain), "after {} steps", cpu.n_steps());
    }
}

#[test]
fn an_engine_keeps_its_own_state() {
    let [_, mut air] = both();
    air.advance(5.0, &pull()).expect("no divergence");
    let mut bytes = Vec::new();
    air.write_state(&mut bytes).expect("a sound state");
    let [_, mut other] = both();
    other.read_state(&mut bytes.as_slice()).expect("what was written");
    assert_eq!(seen(&other), seen(&air));
    for air in [&mut air, &mut other] {
        air.advance(4.0, &[]).expect("no divergence");
    }
    assert_eq!(seen(&other), seen(&air));
}
