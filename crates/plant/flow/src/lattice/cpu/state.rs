//! The state of the engine on the processor, written out and read back.

use super::Cpu;
use super::worker::own;
use crate::lattice::atmosphere::surface::N_COLUMNS;
use crate::lattice::ends::RowEnds;
use crate::lattice::values::{read_values, write_values};
use std::io::{Read, Result, Write};

impl Cpu {
    /// Writes all that time has changed but the steps made and the forces.
    pub(super) fn write(&self, writer: &mut dyn Write) -> Result<()> {
        let mut bytes = Vec::new();
        for worker in &self.workers {
            let worker = own(worker);
            if let RowEnds::Open { outlet, .. } = &worker.share.ends {
                for row in 0..worker.share.rows.len() {
                    write_values(writer, &mut bytes, &outlet.each_ref().map(|column| column[row]))?;
                }
            }
        }
        for worker in &self.workers {
            let worker = own(worker);
            if let RowEnds::Open { .. } = worker.share.ends {
                worker.inlet.write(writer, &mut bytes)?;
            }
        }
        for worker in &self.workers {
            if let Some(sides) = &own(worker).share.sides {
                sides.write(writer, &mut bytes)?;
            }
        }
        for component in 0..2 {
            for worker in &self.workers {
                write_values(writer, &mut bytes, &own(worker).wall.filtered[component])?;
            }
        }
        write_values(writer, &mut bytes, self.memory.values())?;
        if let Some(air) = &self.stratification {
            for column in 0..N_COLUMNS {
                for worker in &self.workers {
                    if let Some(heat) = &own(worker).heat {
                        heat.surface.write(column, writer, &mut bytes)?;
                    }
                }
            }
            air.write(writer, &mut bytes)?;
        }
        self.eddies.as_ref().map_or(Ok(()), |eddies| eddies.write(writer, &mut bytes))
    }

    /// Goes on after `n_steps` steps from what [`write`](Self::write) wrote.
    pub(super) fn read(&mut self, n_steps: u64, reader: &mut dyn Read) -> Result<()> {
        let mut bytes = Vec::new();
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
        for worker in &self.workers {
            let mut worker = own(worker);
            if let RowEnds::Open { .. } = worker.share.ends {
                worker.inlet.read(n_steps, reader, &mut bytes)?;
            }
        }
        for worker in &self.workers {
            if let Some(sides) = &mut own(worker).share.sides {
                sides.read(n_steps, reader, &mut bytes)?;
            }
        }
        for component in 0..2 {
            for worker in &self.workers {
                read_values(reader, &mut bytes, &mut own(worker).wall.filtered[component])?;
            }
        }
        read_values(reader, &mut bytes, self.memory.values_mut())?;
        if let Some(air) = &mut self.stratification {
            for column in 0..N_COLUMNS {
                for worker in &self.workers {
                    if let Some(heat) = &mut own(worker).heat {
                        heat.surface.read(column, reader, &mut bytes)?;
                    }
                }
            }
            air.read_state(reader, &mut bytes)?;
        }
        if let Some(eddies) = &mut self.eddies {
            eddies.read(reader, &mut bytes)?;
        }
        self.n_steps = n_steps;
        Ok(())
    }
}
