//! What a box and the grid around it hand each other in a step.

use super::paths::{Arrival, Part, Paths, Source};
use crate::lattice::links::{Exchange, Way};
use crate::lattice::values::{read_values, write_values};
use std::io::{Read, Result, Write};

/// Populations between a box and the grid around it.
pub(super) struct Coupling {
    sources: Vec<Source>,
    parts: Parts,
    /// Where what is asked for lies, after an even and after an odd number of steps of the grid around.
    asked: [Vec<usize>; 2],
    /// Where what leaves the box lies, after its first and after its second step.
    leaving: [Vec<usize>; 2],
    /// Where what enters the box is put, after its first and after its second step.
    entering: [Vec<usize>; 2],
    returning: Vec<usize>,
    /// Where what arrives around the box is put, as for `asked`.
    arriving: [Vec<usize>; 2],
    /// Indices among `carried` of the eight parts of what arrives.
    arrivals: Vec<[u32; 8]>,
    /// Numbers of what returns among what leaves.
    returned: Vec<u32>,
    /// What was asked for.
    known: Vec<f32>,
    /// Each source and its slopes.
    divided: Vec<[f32; 4]>,
    /// What left in the first step, in the second, and what passes the box by.
    carried: Vec<f32>,
    /// What arrived around the box before the present step there.
    arrived: Vec<f32>,
}

/// Parts of sources by what becomes of them.
struct Parts {
    entering: [Vec<Part>; 2],
    passing: Vec<Part>,
}

impl Coupling {
    /// The exchange over `paths` between the grid `around` and the box `inside`, before their first steps.
    pub(super) fn new(paths: Paths, around: &dyn Exchange, inside: &dyn Exchange) -> Self {
        let n_leaving = paths.leaving.len();
        let [(first, first_parts), (second, second_parts)] = paths.entering;
        let (returning, returned) = paths.returning;
        let (arriving, arrivals) = paths.arriving;
        let index = |arrival| match arrival {
            Arrival::First(number) => number,
            Arrival::Second(number) => n_leaving as u32 + number,
            Arrival::Passing(number) => 2 * n_leaving as u32 + number,
        };
        Self {
            known: vec![0.0; paths.asked.len()],
            divided: vec![[0.0; 4]; paths.sources.len()],
            carried: vec![0.0; 2 * n_leaving + paths.passing.len()],
            arrived: vec![0.0; arriving.len()],
            asked: [0, 1].map(|n| around.places(Way::Leaving, &paths.asked, n)),
            leaving: [1, 2].map(|n| inside.places(Way::Leaving, &paths.leaving, n)),
            entering: [
                inside.places(Way::Arriving, &first, 1),
                inside.places(Way::Arriving, &second, 2),
            ],
            returning: inside.places(Way::Arriving, &returning, 2),
            arriving: [0, 1].map(|n| around.places(Way::Arriving, &arriving, n)),
            arrivals: arrivals.into_iter().map(|parts| parts.map(index)).collect(),
            returned,
            sources: paths.sources,
            parts: Parts { entering: [first_parts, second_parts], passing: paths.passing },
        }
    }

    /// Keeps what arrives in the grid `around`, which has made `n_steps` steps, for [`lend`](Self::lend).
    pub(super) fn keep(&mut self, around: &mut dyn Exchange, n_steps: u64) {
        around.read(&self.arriving[(n_steps % 2) as usize], &mut self.arrived);
    }

    /// Lends the grid `around`, which has made `n_steps` steps, what arrived there before the last of them:
    /// who looks at it before the box has made its steps sees no air from beneath the box.
    pub(super) fn lend(&self, around: &mut dyn Exchange, n_steps: u64) {
        around.write(&self.arriving[(n_steps % 2) as usize], &|first, values| {
            let n = values.len();
            values.copy_from_slice(&self.arrived[first..first + n]);
        });
    }

    /// Takes up what leaves the grid `around`, which has made `n_steps` steps.
    pub(super) fn take(&mut self, around: &mut dyn Exchange, n_steps: u64) {
        around.read(&self.asked[(n_steps % 2) as usize], &mut self.known);
        for (divided, source) in self.divided.iter_mut().zip(&self.sources) {
            divided[0] = self.known[source.here as usize];
            for axis in 0..3 {
                let [before, after] = source.around[axis].map(|index| self.known[index as usize]);
                divided[axis + 1] = (after - before) * source.per_distance[axis];
            }
        }
    }

    /// Exchanges after the first (0) or second (1) `step` of the box `inside`.
    pub(super) fn cross(&mut self, inside: &mut dyn Exchange, step: usize) {
        let n_leaving = self.leaving[step].len();
        inside.read(&self.leaving[step], &mut self.carried[step * n_leaving..][..n_leaving]);
        let parts = &self.parts.entering[step];
        inside.write(&self.entering[step], &|first, values| {
            divide(&self.divided, &parts[first..], values);
        });
        if step == 1 {
            inside.write(&self.returning, &|first, values| {
                for (value, number) in values.iter_mut().zip(&self.returned[first..]) {
                    *value = self.carried[*number as usize];
                }
            });
        }
    }

    /// Hands the grid `around`, which has made `n_steps` steps, what has come to it from the box and past it.
    pub(super) fn give(&mut self, around: &mut dyn Exchange, n_steps: u64) {
        let n_leaving = self.leaving[0].len();
        divide(&self.divided, &self.parts.passing, &mut self.carried[2 * n_leaving..]);
        around.write(&self.arriving[(n_steps % 2) as usize], &|first, values| {
            for (value, parts) in values.iter_mut().zip(&self.arrivals[first..]) {
                let [a, b, c, d, e, f, g, h] = parts.map(|index| self.carried[index as usize]);
                *value = 0.125 * (((a + b) + (c + d)) + ((e + f) + (g + h)));
            }
        });
    }

    /// Writes what is on its way between two steps of the box.
    pub(super) fn write_state(&self, writer: &mut dyn Write) -> Result<()> {
        let mut bytes = Vec::new();
        write_values(writer, &mut bytes, self.divided.as_flattened())?;
        write_values(writer, &mut bytes, &self.carried[..self.leaving[0].len()])
    }

    /// Reads what [`write_state`](Self::write_state) wrote.
    pub(super) fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let mut bytes = Vec::new();
        read_values(reader, &mut bytes, self.divided.as_flattened_mut())?;
        let n_leaving = self.leaving[0].len();
        read_values(reader, &mut bytes, &mut self.carried[..n_leaving])
    }

    /// Memory that it holds (bytes).
    pub(super) fn memory(&self) -> u64 {
        let places = [&self.asked, &self.leaving, &self.entering, &self.arriving];
        let n_places: usize = places.into_iter().flatten().map(Vec::len).sum();
        let n_parts =
            self.parts.entering.iter().map(Vec::len).sum::<usize>() + self.parts.passing.len();
        let n_values = self.known.len() + self.carried.len() + self.arrived.len();
        (size_of::<usize>() * (n_places + self.returning.len())
            + size_of::<Part>() * n_parts
            + size_of::<Source>() * self.sources.len()
            + size_of::<[f32; 4]>() * self.divided.len()
            + size_of::<[u32; 8]>() * self.arrivals.len()
            + size_of::<f32>() * (n_values + self.returned.len())) as u64
    }
}

/// On return `values` begins with the populations of `parts`.
fn divide(divided: &[[f32; 4]], parts: &[Part], values: &mut [f32]) {
    for (value, part) in values.iter_mut().zip(parts) {
        let [mean, slopes @ ..] = divided[part.source as usize];
        let [a, b, c] = part.offset;
        *value = mean + (slopes[0] * a + slopes[1] * b + slopes[2] * c);
    }
}
