//! The state written out and read back, bit for bit.
//!
//! Little-endian: magic, version, cells along x, y, z, populations a cell, steps made; forces of the last step
//! (position, force, smearing length each); outlet halo row by row; filtered wind at the ground; all populations.
//! Everything else follows from settings and inflow.

use super::ends::RowEnds;
use super::solver::{Lattice, own};
use basis::{PointForce, Vector3};
use std::io::{Error, ErrorKind, Read, Result, Write};

const MAGIC: [u8; 8] = *b"wmlattic";
const VERSION: u64 = 1;
/// Values that are converted at a time.
const CHUNK: usize = 16 * 1024;
/// More forces than this are a sign of a damaged file.
const MOST_FORCES: u64 = 1 << 24;

impl Lattice {
    /// Writes the state; a lattice of the same settings that [reads](Self::read_state) it goes on with the same bits.
    ///
    /// # Errors
    /// Those of `writer`, and [`ErrorKind::InvalidData`] when the field has diverged: such a state is no use to anyone.
    pub fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        self.check().map_err(|error| Error::new(ErrorKind::InvalidData, error))?;
        writer.write_all(&MAGIC)?;
        for value in self.header() {
            writer.write_all(&value.to_le_bytes())?;
        }
        writer.write_all(&self.n_steps.to_le_bytes())?;
        writer.write_all(&(self.forces.len() as u64).to_le_bytes())?;
        for force in &self.forces {
            let [x, y, z] = force.position.to_array();
            let [fx, fy, fz] = force.force.to_array();
            for value in [x, y, z, fx, fy, fz, force.smearing_length] {
                writer.write_all(&value.to_le_bytes())?;
            }
        }
        let mut bytes = Vec::with_capacity(CHUNK * size_of::<f32>());
        for worker in &self.workers {
            let worker = own(worker);
            if let RowEnds::Open { outlet, .. } = &worker.share.ends {
                for row in 0..worker.share.rows.len() {
                    write_values(writer, &mut bytes, &outlet.each_ref().map(|column| column[row]))?;
                }
            }
        }
        for component in 0..2 {
            for worker in &self.workers {
                write_values(writer, &mut bytes, &own(worker).wall.filtered[component])?;
            }
        }
        write_values(writer, &mut bytes, self.memory.values())
    }

    /// Reads a state that [`write_state`](Self::write_state) wrote from a lattice of the same settings.
    ///
    /// # Errors
    /// Those of `reader`, and [`ErrorKind::InvalidData`] when it is no state or one of another grid. The field is
    /// undefined after an error and must be read or built again.
    pub fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let mut magic = [0; 8];
        reader.read_exact(&mut magic)?;
        if magic != MAGIC {
            return Err(invalid("this is no state of a lattice".to_owned()));
        }
        for (what, expected) in
            ["version", "cells along x", "cells along y", "cells along z", "populations"]
                .iter()
                .zip(self.header())
        {
            let found = read_u64(reader)?;
            if found != expected {
                return Err(invalid(format!(
                    "the state has {what} {found}, this lattice {expected}"
                )));
            }
        }
        let n_steps = read_u64(reader)?;
        let n_forces = read_u64(reader)?;
        if n_forces > MOST_FORCES {
            return Err(invalid(format!("the state claims {n_forces} forces")));
        }
        self.forces.clear();
        for _ in 0..n_forces {
            let mut values = [0.0; 7];
            for value in &mut values {
                *value = f64::from_bits(read_u64(reader)?);
            }
            let [x, y, z, fx, fy, fz, smearing_length] = values;
            let (position, force) = (Vector3::new(x, y, z), Vector3::new(fx, fy, fz));
            // The lattice feels nothing but these.
            self.forces.push(PointForce::of_body(position, force, smearing_length));
        }
        self.spread();
        let mut bytes = Vec::with_capacity(CHUNK * size_of::<f32>());
        for worker in &self.workers {
            let mut worker = own(worker);
            let n_rows = worker.share.rows.len();
            if let RowEnds::Open { outlet, .. } = &mut worker.share.ends {
                for row in 0..n_rows {
                    let mut values = [0.0; 4];
                    read_values(reader, &mut bytes, &mut values)?;
                    for (column, value) in outlet.iter_mut().zip(values) {
                        column[row] = value;
                    }
                }
            }
        }
        for component in 0..2 {
            for worker in &self.workers {
                read_values(reader, &mut bytes, &mut own(worker).wall.filtered[component])?;
            }
        }
        read_values(reader, &mut bytes, self.memory.values_mut())?;
        self.n_steps = n_steps;
        Ok(())
    }

    fn header(&self) -> [u64; 5] {
        let [x, y, z] = self.layout.n_cells.map(|n| n as u64);
        [VERSION, x, y, z, self.kernel.directions.len() as u64]
    }
}

fn invalid(message: String) -> Error {
    Error::new(ErrorKind::InvalidData, message)
}

fn read_u64(reader: &mut dyn Read) -> Result<u64> {
    let mut bytes = [0; 8];
    reader.read_exact(&mut bytes)?;
    Ok(u64::from_le_bytes(bytes))
}

fn write_values(writer: &mut dyn Write, bytes: &mut Vec<u8>, values: &[f32]) -> Result<()> {
    for chunk in values.chunks(CHUNK) {
        bytes.clear();
        for value in chunk {
            bytes.extend_from_slice(&value.to_le_bytes());
        }
        writer.write_all(bytes)?;
    }
    Ok(())
}

fn read_values(reader: &mut dyn Read, bytes: &mut Vec<u8>, values: &mut [f32]) -> Result<()> {
    for chunk in values.chunks_mut(CHUNK) {
        bytes.resize(size_of_val(chunk), 0);
        reader.read_exact(bytes)?;
        let (words, _) = bytes.as_chunks::<4>();
        for (value, word) in chunk.iter_mut().zip(words) {
            *value = f32::from_le_bytes(*word);
        }
    }
    Ok(())
}
