//! The state written out and read back, bit for bit.
//!
//! Little-endian: magic, version, cells along x, y, z, populations a cell, steps made; forces of the last
//! step (position, force, smearing length each); then what the engine writes, which on the processor is the
//! outlet halo row by row, what the inflow told last row by row, where sides are open the density of the halo
//! beyond them, how far the inflow entered, the wind through them and what the inflow told there, the
//! filtered wind at the ground, all populations; in an atmosphere also what the ground remembers, the mean
//! temperatures of the levels, temperature now and a step before, and its last change; where a pass of its
//! own finds the viscosity of eddies, that, and their diffusivity in an atmosphere.
//! Everything else follows from settings and inflow.

use super::fields::N_KEPT;
use super::settings::Sides;
use super::solver::Lattice;
use super::subgrid::SubgridModel;
use basis::{PointForce, Vector3};
use std::io::{Error, ErrorKind, Read, Result, Write};

const MAGIC: [u8; 8] = *b"wmlattic";
const VERSION: u64 = 3;
/// The same with what lies beyond open sides.
const VERSION_OPEN: u64 = 5;
/// More forces than this are a sign of a damaged file.
const MOST_FORCES: u64 = 1 << 24;

impl Lattice {
    /// Writes the state; a lattice of the same settings that [reads](Self::read_state) it goes on with the
    /// same bits.
    ///
    /// # Errors
    /// Those of `writer`, and [`ErrorKind::InvalidData`] when the field has diverged: such a state is no use
    /// to anyone.
    pub fn write_state(&mut self, writer: &mut dyn Write) -> Result<()> {
        self.check().map_err(|error| Error::new(ErrorKind::InvalidData, error))?;
        writer.write_all(&MAGIC)?;
        for value in self.header() {
            writer.write_all(&value.to_le_bytes())?;
        }
        writer.write_all(&self.n_steps().to_le_bytes())?;
        writer.write_all(&(self.forces.len() as u64).to_le_bytes())?;
        for force in &self.forces {
            let [x, y, z] = force.position.to_array();
            let [fx, fy, fz] = force.force.to_array();
            for value in [x, y, z, fx, fy, fz, force.smearing_length] {
                writer.write_all(&value.to_le_bytes())?;
            }
        }
        self.engine.write_state(writer)
    }

    /// Reads a state that [`write_state`](Self::write_state) wrote from a lattice of the same settings.
    ///
    /// # Errors
    /// Those of `reader`, and [`ErrorKind::InvalidData`] when it is no state or one of another grid. The
    /// field is undefined after an error and must be read or built again.
    pub fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let mut magic = [0; 8];
        reader.read_exact(&mut magic)?;
        if magic != MAGIC {
            return Err(invalid("this is no state of a lattice".to_owned()));
        }
        for (what, expected) in [
            "version",
            "cells along x",
            "cells along y",
            "cells along z",
            "populations",
            "model of eddies number",
        ]
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
        self.engine.set_forces(&self.forces);
        self.engine.read_state(n_steps, reader)
    }

    fn header(&self) -> [u64; 6] {
        let [x, y, z] = self.n_cells().map(|n| n as u64);
        let heat = self.settings().atmosphere.as_ref().map_or(0, |_| N_KEPT as u64);
        let model = self.settings().subgrid.model;
        let eddies = match SubgridModel::ALL.iter().position(|known| *known == model) {
            Some(place) => place as u64,
            None => u64::MAX,
        };
        let version = match self.settings().sides {
            Sides::Open => VERSION_OPEN,
            Sides::Periodic | Sides::Slip => VERSION,
        };
        [version, x, y, z, self.settings().stencil.n_directions() + heat, eddies]
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
