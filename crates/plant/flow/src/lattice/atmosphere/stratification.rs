//! Temperature and what comes with it in the machine's memory, beside the populations of the air.

use super::beside::Beside;
use super::coefficients::{Coefficients, Level, levels};
use super::law::{Law, Slope, Stratified};
use super::settings::{Atmosphere, Heating, Perturbation, Reference};
use super::surface::{Surface, SurfaceMemory};
use super::transport::{Ghosts, Transport, close_row, upstream};
use crate::lattice::fields::{Field, Fields, KEPT};
use crate::lattice::joint::{Faces, Joint};
use crate::lattice::layout::{Edge, LINE, Layout};
use crate::lattice::settings::{Ends, LatticeSettings};
use crate::lattice::sides::OpenSides;
use crate::lattice::values::{read_values, write_values};
use crate::simd::Simd;
use std::io::{Read, Result, Write};
use std::ops::Range;

/// The state of an atmosphere that is not in the populations of the air.
pub(crate) struct Stratification {
    pub(super) fields: Fields,
    /// Temperatures beyond open sides.
    beside: Option<Beside>,
    coefficients: Coefficients,
    pub(in crate::lattice) levels: Vec<Level>,
    plates: Option<[f32; 2]>,
    periodic: bool,
    pub(crate) surface: Option<Surface>,
    /// Values from a row at the ground to the next in what threads know of them.
    pub(crate) ground_stride: usize,
    reference: Reference,
    perturbation: Option<Perturbation>,
    reference_temperature: f64,
    spacing: f64,
    /// Height of its lower side above the ground (m).
    floor: f64,
    /// Sum of the temperatures of every row after the last step.
    pub(in crate::lattice) sums: Vec<f32>,
}

/// The temperature that the pass over unresolved eddies finds.
pub(crate) struct Warmth<'a> {
    /// Where it lies.
    pub(in crate::lattice) temperature: Field,
    pub(crate) coefficients: &'a Coefficients,
    /// Levels, from the ground up.
    pub(crate) levels: &'a [Level],
}

/// What one thread owns of it.
pub(crate) struct HeatShare {
    pub(crate) surface: SurfaceMemory,
    /// Sum of the temperatures of each row after the last step (K above the reference).
    pub(crate) sums: Vec<f32>,
    /// Temperatures beyond the ground and the top of the row under way.
    pub(super) beyond: Ghosts,
    /// No heat from the ground, padded to whole vectors.
    pub(super) none: Vec<f32>,
}

impl HeatShare {
    /// What a thread owns with the rows `rows`.
    pub(crate) fn new(layout: &Layout, rows: &Range<usize>) -> Self {
        let n_y = layout.n_cells[1];
        let n_at_ground = rows.end.min(n_y) - rows.start.min(n_y);
        Self {
            surface: SurfaceMemory::new(n_at_ground * layout.row_stride),
            sums: vec![0.0; rows.len()],
            beyond: Ghosts::new(layout.n_cells[0]),
            none: vec![0.0; layout.n_cells[0].next_multiple_of(LINE)],
        }
    }
}

impl Stratification {
    /// That of `atmosphere` in the box of `settings` and `layout`, which lies as `joint` says, with `sides`
    /// beyond y and `beyond` below and above; none when the system refuses the memory.
    pub(crate) fn new(
        atmosphere: &Atmosphere,
        settings: &LatticeSettings,
        joint: &Joint,
        layout: &Layout,
        sides: Edge,
        beyond: [Edge; 2],
    ) -> Option<Self> {
        let scaling = settings.scaling();
        let eddies = settings.subgrid.model.needs_neighbours();
        let plates = match atmosphere.heating {
            Heating::Plates { ground, top } => {
                Some([ground, top].map(|plate| (plate - atmosphere.reference_temperature) as f32))
            }
            _ => None,
        };
        Some(Self {
            fields: Fields::warm(layout, sides, beyond, joint.faces, eddies)?,
            beside: Beside::new(layout.n_cells, sides)?,
            coefficients: Coefficients::new(atmosphere, settings, &scaling),
            levels: levels(atmosphere, settings, joint),
            plates,
            periodic: settings.ends == Ends::Periodic,
            surface: Surface::new(atmosphere, settings, &scaling),
            ground_stride: layout.row_stride,
            reference: atmosphere.reference,
            perturbation: atmosphere.perturbation,
            reference_temperature: atmosphere.reference_temperature,
            spacing: settings.spacing,
            floor: joint.floor,
            sums: vec![0.0; layout.n_rows()],
        })
    }

    /// Cells along x, y, z.
    pub(crate) fn n_cells(&self) -> [usize; 3] {
        self.fields.n_cells
    }

    /// The geostrophic wind is `wind` (cells a step) from now on.
    pub(crate) fn drive(&mut self, wind: [f32; 2]) {
        self.coefficients.geostrophic = wind;
    }

    /// What step number `n_steps` finds.
    pub(crate) fn air(&self, n_steps: u64) -> Stratified<'_> {
        Stratified {
            fields: &self.fields,
            temperature: Fields::temperature(n_steps),
            coefficients: &self.coefficients,
            levels: &self.levels,
            periodic: self.periodic,
        }
    }

    /// How temperature is carried over step number `n_steps`.
    pub(crate) fn transport(&self, n_steps: u64) -> Transport<'_> {
        Transport {
            fields: &self.fields,
            n_steps,
            beside: self.beside.as_ref(),
            levels: &self.levels,
            plates: self.plates,
            periodic: self.periodic,
            ground_stride: self.ground_stride,
        }
    }

    /// Its fields.
    pub(in crate::lattice) fn fields(&self) -> &Fields {
        &self.fields
    }

    /// Its fields, to be changed.
    pub(crate) fn fields_mut(&mut self) -> &mut Fields {
        &mut self.fields
    }

    /// What eddies of step number `n_steps` find.
    pub(crate) fn warmth(&self, n_steps: u64) -> (&Fields, Warmth<'_>) {
        let warmth = Warmth {
            temperature: Fields::temperature(n_steps),
            coefficients: &self.coefficients,
            levels: &self.levels,
        };
        (&self.fields, warmth)
    }

    /// What acts on the cells of row (`y`, `z`), under Smagorinsky's factor `subgrid`, and the slope of their
    /// temperature after `n_steps` steps, as the box's own cells tell it.
    pub(super) fn law<S: Simd>(
        &self,
        n_steps: u64,
        [y, z]: [usize; 2],
        subgrid: f32,
    ) -> (Law<S>, Slope) {
        let slope = Slope::within(&self.fields, Fields::temperature(n_steps), [y, z]);
        (Law::new(&self.coefficients, self.levels[z], subgrid), slope)
    }

    /// Gives row number `row` its first temperatures, `given` (K) or those of its height, and sums them up in
    /// `sum`.
    pub(crate) fn fill(&self, row: usize, given: Option<&[f64]>, sum: &mut f32) {
        let [n, n_y, _] = self.fields.n_cells;
        let [y, z] = [row % n_y, row / n_y];
        let height = self.floor + (z as f64 + 0.5) * self.spacing;
        let place = self.fields.row(Fields::temperature(0), y, z);
        *sum = 0.0;
        for x in 0..n {
            let mut departure = match given {
                Some(given) => (given[x] - self.reference_temperature) as f32,
                None => self.levels[z].target,
            };
            if let Some(Perturbation { below, amplitude, seed }) = self.perturbation
                && height < below
            {
                departure += amplitude as f32 * noise(seed, (row * n + x) as u64);
            }
            *sum += departure;
            // SAFETY: a cell of this thread's rows.
            unsafe {
                *place.add(x) = departure;
                *self.fields.row(Field::Change, y, z).add(x) = 0.0;
            }
        }
        self.close(Fields::temperature(0), y, z);
    }

    /// Gives what lies upstream of the rows from number `first` on the temperatures `entering` (K above the
    /// reference) for step number `n_steps`.
    pub(crate) fn enter(&self, n_steps: u64, first: usize, entering: impl Iterator<Item = f32>) {
        let n_y = self.fields.n_cells[1];
        for (row, entering) in (first..).zip(entering) {
            let row = self.fields.row(Fields::temperature(n_steps), row % n_y, row / n_y);
            // SAFETY: the padding of a row of this thread, which others do not read.
            unsafe { upstream(row, entering) };
        }
    }

    /// Gives what lies beyond the `sides` its temperatures for step number `n_steps`: those that the inflow
    /// tells, or the level's, where it enters, and those of the cells inside where air leaves; and the wind
    /// that blows through them.
    pub(crate) fn enter_sides(&self, n_steps: u64, sides: &OpenSides) {
        let Some(beside) = &self.beside else { return };
        for ([y, z], [entered, across], mut told) in sides.temperatures() {
            let inside = self.fields.cells(Fields::temperature(n_steps), y, z);
            let side = usize::from(y > 0);
            let (row, wind) = (beside.row(side, z), beside.wind(side, z));
            for (x, inside) in inside.iter().enumerate() {
                let entering = told.as_mut().and_then(Iterator::next);
                let entering = entering.unwrap_or(self.levels[z].target);
                // SAFETY: rows that only this thread writes, and nobody reads meanwhile.
                unsafe {
                    *row.add(x) = inside + entered[x] * (entering - inside);
                    *wind.add(x) = across[x];
                }
            }
        }
    }

    /// Temperatures of row number `row` after `n_steps` steps (K above the reference).
    pub(crate) fn temperature(&self, n_steps: u64, row: usize) -> &[f32] {
        let n_y = self.fields.n_cells[1];
        self.fields.cells(Fields::temperature(n_steps), row % n_y, row / n_y)
    }

    /// Takes in the sums of the rows from number `first` on.
    pub(crate) fn gather(&mut self, first: usize, sums: &[f32]) {
        self.sums[first..first + sums.len()].copy_from_slice(sums);
    }

    /// Closes row number `row`, whose temperatures after `n_steps` steps others have changed; gives their
    /// sum.
    pub(in crate::lattice) fn settle(&self, n_steps: u64, row: usize) -> f32 {
        let n_y = self.fields.n_cells[1];
        let [y, z] = [row % n_y, row / n_y];
        self.close(Fields::temperature(n_steps), y, z);
        self.temperature(n_steps, row).iter().sum()
    }

    /// The levels whose numbers are in `levels` follow their means, once all sums are in, where buoyancy
    /// refers to them. Those of a box in the air of another grid follow that one's.
    pub(crate) fn follow(&mut self, levels: Range<usize>) {
        if self.reference == Reference::Start || self.fields.joined != Faces::default() {
            return;
        }
        let [n_x, n_y, _] = self.fields.n_cells;
        let share = 1.0 / (n_x * n_y) as f64;
        let sums = self.sums.chunks(n_y).skip(levels.start);
        for (level, sums) in self.levels[levels].iter_mut().zip(sums) {
            let sum: f64 = sums.iter().copied().map(f64::from).sum();
            level.refer((sum * share) as f32);
        }
    }

    /// Writes all that time has changed but what the ground remembers.
    pub(crate) fn write(&self, writer: &mut dyn Write, bytes: &mut Vec<u8>) -> Result<()> {
        let means: Vec<f32> = self.levels.iter().map(|level| level.mean).collect();
        write_values(writer, bytes, &means)?;
        self.kept().try_for_each(|field| self.fields.write(field, writer, bytes))
    }

    /// Goes on from what [`write`](Self::write) wrote.
    pub(crate) fn read_state(&mut self, reader: &mut dyn Read, bytes: &mut Vec<u8>) -> Result<()> {
        let mut means = vec![0.0; self.levels.len()];
        read_values(reader, bytes, &mut means)?;
        for (level, mean) in self.levels.iter_mut().zip(means) {
            level.refer(mean);
        }
        let [_, n_y, n_z] = self.fields.n_cells;
        for field in self.kept() {
            self.fields.read(field, reader, bytes)?;
            for row in 0..n_y * n_z {
                self.close(field, row % n_y, row / n_y);
            }
        }
        Ok(())
    }

    /// Fields that outlast a step.
    fn kept(&self) -> impl Iterator<Item = Field> + use<> {
        let eddies = self.fields.hold(Field::Viscosity);
        let of_eddies = eddies.then_some([Field::Viscosity, Field::Diffusivity]);
        KEPT.into_iter().chain(of_eddies.into_iter().flatten())
    }

    /// Gives what lies beyond the ends of row (`y`, `z`) of `field` its values, where it is not given.
    fn close(&self, field: Field, y: usize, z: usize) {
        if self.fields.joined[0] != [false; 2] {
            return;
        }
        let row = self.fields.row(field, y, z);
        // SAFETY: the padding of a row that nobody else writes.
        unsafe { close_row(row, self.fields.n_cells[0], self.periodic, self.levels[z].target) };
    }

    /// Memory that it holds (bytes).
    pub(crate) fn bytes(&self) -> usize {
        let [_, n_y, _] = self.fields.n_cells;
        let at_ground = match self.surface {
            Some(_) => 7 * n_y * self.ground_stride,
            None => 0,
        };
        let beside = self.beside.as_ref().map_or(0, Beside::bytes);
        self.fields.bytes() + beside + size_of::<f32>() * (at_ground + self.sums.len())
    }
}

/// A number from −1 to 1 that belongs to `cell` (the finaliser of splitmix64: Steele, Lea, Flood 2014).
fn noise(seed: u64, cell: u64) -> f32 {
    let mut z = (seed << 40 ^ cell).wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 40) as f32 / (1_u32 << 23) as f32 - 1.0
}
