//! The state written out and read back, bit for bit.
//!
//! Little-endian: magic, version, clock of the wind; then for each rotor its turbine, blades, elements of
//! each, their circulations and places, for each blade its two strips: rows, ages, nodes, velocities, rings,
//! lengths; and for each body whose wake is followed its turbine, radius, place and rings. Segments, boxes
//! and how the wind answers follow from these.

use super::body::{Body, N_SIDES};
use super::rotor::Rotor;
use super::sheet::Sheet;
use super::strain::Life;
use super::strip::Strip;
use super::wake::FreeWake;
use crate::inflow::prescribed::Clock;
use basis::Vector3;
use std::io::{Error, ErrorKind, Read, Result, Write};

const MAGIC: [u8; 8] = *b"wmvortex";
const VERSION: u64 = 3;
/// More of anything than this is a sign of a damaged file.
const MOST: u64 = 1 << 24;

impl FreeWake {
    /// Writes the state; a wake of the same settings in the same wind that [reads](Self::read_state) it goes
    /// on with the same bits.
    ///
    /// # Errors
    /// Those of `writer`.
    pub fn write_state(&self, writer: &mut dyn Write) -> Result<()> {
        writer.write_all(&MAGIC)?;
        write_count(writer, VERSION)?;
        writer.write_all(&self.wind.state().to_bytes())?;
        write_count(writer, self.rotors.len() as u64)?;
        for rotor in &self.rotors {
            write_count(writer, rotor.turbine() as u64)?;
            write_count(writer, rotor.blades().count() as u64)?;
            for n in rotor.blades() {
                write_count(writer, n as u64)?;
            }
            write_values(writer, &rotor.circulations)?;
            write_vectors(writer, &rotor.stations)?;
            write_vectors(writer, &rotor.nodes)?;
        }
        for strip in self.sheets.iter().flat_map(|sheet| [&sheet.near, &sheet.far]) {
            write_count(writer, strip.n_rows() as u64)?;
            write_values(writer, &strip.ages)?;
            write_vectors(writer, &strip.positions)?;
            write_vectors(writer, &strip.velocities)?;
            write_values(writer, &strip.circulations)?;
            write_lives(writer, &strip.trailing)?;
            write_lives(writer, &strip.spanwise)?;
        }
        write_count(writer, self.bodies.len() as u64)?;
        self.bodies.iter().try_for_each(|body| write_body(writer, body))
    }

    /// Reads a state that [`write_state`](Self::write_state) wrote from a wake of the same settings.
    ///
    /// # Errors
    /// Those of `reader`, and [`ErrorKind::InvalidData`] when it is no state of such a wake; nothing is
    /// changed then but the wind's clock.
    pub fn read_state(&mut self, reader: &mut dyn Read) -> Result<()> {
        let mut magic = [0; 8];
        reader.read_exact(&mut magic)?;
        if magic != MAGIC {
            return Err(invalid("this is no state of a free wake".to_owned()));
        }
        let version = read_count(reader)?;
        if version != VERSION {
            return Err(invalid(format!(
                "the state has version {version}, this program {VERSION}"
            )));
        }
        let mut clock = [0; 24];
        reader.read_exact(&mut clock)?;
        let mut rotors = Vec::new();
        let mut sheets = Vec::new();
        for index in 0..read_count(reader)? as usize {
            let rotor = read_rotor(reader)?;
            for (blade, n) in rotor.blades().enumerate() {
                sheets.push(Sheet::new([index, blade], n, self.settings.resolution));
            }
            rotors.push(rotor);
        }
        if sheets.len() > self.settings.n_blades {
            let (found, expected) = (sheets.len(), self.settings.n_blades);
            return Err(invalid(format!(
                "the state has {found} blades, this wake at most {expected}"
            )));
        }
        for strip in sheets.iter_mut().flat_map(|sheet| [&mut sheet.near, &mut sheet.far]) {
            read_strip(reader, strip)?;
        }
        let n_bodies = read_count(reader)?;
        let bodies = (0..n_bodies).map(|_| self.read_body(reader)).collect::<Result<Vec<_>>>()?;
        let clock = Clock::from_bytes(clock);
        self.wind.restore(clock).map_err(|error| Error::new(ErrorKind::InvalidData, error))?;
        (self.rotors, self.sheets, self.bodies) = (rotors, sheets, bodies);
        self.gather(true);
        self.tell_rotors();
        Ok(())
    }

    fn read_body(&self, reader: &mut dyn Read) -> Result<Body> {
        let turbine = read_count(reader)? as usize;
        let mut radius = [0.0];
        read_values(reader, &mut radius)?;
        let mut body = Body::new(turbine, radius[0], self.settings.bodies);
        let mut places = [Vector3::ZERO; 2];
        read_vectors(reader, &mut places)?;
        [body.position, body.way] = places;
        let n = read_count(reader)? as usize;
        if n > self.settings.bodies.most_rings {
            let most = self.settings.bodies.most_rings;
            return Err(invalid(format!(
                "the state has {n} rings of a body, this wake at most {most}"
            )));
        }
        body.ages.resize(n, 0.0);
        read_values(reader, &mut body.ages)?;
        body.circulations.resize(n, 0.0);
        read_values(reader, &mut body.circulations)?;
        body.lives.resize(n, Life::default());
        read_lives(reader, &mut body.lives)?;
        body.positions.resize(n * N_SIDES, Vector3::ZERO);
        read_vectors(reader, &mut body.positions)?;
        body.velocities.resize(n * N_SIDES, Vector3::ZERO);
        read_vectors(reader, &mut body.velocities)?;
        Ok(body)
    }
}

fn write_body(writer: &mut dyn Write, body: &Body) -> Result<()> {
    write_count(writer, body.turbine as u64)?;
    write_values(writer, &[body.radius])?;
    write_vectors(writer, &[body.position, body.way])?;
    write_count(writer, body.n_rings() as u64)?;
    write_values(writer, &body.ages)?;
    write_values(writer, &body.circulations)?;
    write_lives(writer, &body.lives)?;
    write_vectors(writer, &body.positions)?;
    write_vectors(writer, &body.velocities)
}

fn read_rotor(reader: &mut dyn Read) -> Result<Rotor> {
    let turbine = read_count(reader)? as usize;
    let n_blades = read_count(reader)?;
    let n_elements =
        (0..n_blades).map(|_| Ok(read_count(reader)? as usize)).collect::<Result<Vec<_>>>()?;
    if n_elements.is_empty() || n_elements.contains(&0) {
        return Err(invalid("the state has a turbine without blades".to_owned()));
    }
    let mut rotor = Rotor::of(turbine, n_elements);
    read_values(reader, &mut rotor.circulations)?;
    read_vectors(reader, &mut rotor.stations)?;
    read_vectors(reader, &mut rotor.nodes)?;
    Ok(rotor)
}

fn read_strip(reader: &mut dyn Read, strip: &mut Strip) -> Result<()> {
    let (n_rows, n_nodes) = (read_count(reader)? as usize, strip.n_nodes());
    strip.ages.resize(n_rows, 0.0);
    read_values(reader, &mut strip.ages)?;
    strip.positions.resize(n_rows * n_nodes, Vector3::ZERO);
    read_vectors(reader, &mut strip.positions)?;
    strip.velocities.resize(n_rows * n_nodes, Vector3::ZERO);
    read_vectors(reader, &mut strip.velocities)?;
    strip.circulations.resize(n_rows * (n_nodes - 1), 0.0);
    read_values(reader, &mut strip.circulations)?;
    strip.trailing.resize(n_rows * n_nodes, Life::default());
    read_lives(reader, &mut strip.trailing)?;
    strip.spanwise.resize(n_rows * (n_nodes - 1), Life::default());
    read_lives(reader, &mut strip.spanwise)
}

fn invalid(message: String) -> Error {
    Error::new(ErrorKind::InvalidData, message)
}

fn write_count(writer: &mut dyn Write, count: u64) -> Result<()> {
    writer.write_all(&count.to_le_bytes())
}

fn write_values(writer: &mut dyn Write, values: &[f64]) -> Result<()> {
    values.iter().try_for_each(|value| writer.write_all(&value.to_le_bytes()))
}

fn write_vectors(writer: &mut dyn Write, vectors: &[Vector3]) -> Result<()> {
    vectors.iter().try_for_each(|vector| write_values(writer, &vector.to_array()))
}

fn write_lives(writer: &mut dyn Write, lives: &[Life]) -> Result<()> {
    lives.iter().try_for_each(|life| write_values(writer, &[life.at_birth, life.swept]))
}

fn read_lives(reader: &mut dyn Read, lives: &mut [Life]) -> Result<()> {
    for life in lives {
        let mut values = [0.0; 2];
        read_values(reader, &mut values)?;
        [life.at_birth, life.swept] = values;
    }
    Ok(())
}

fn read_count(reader: &mut dyn Read) -> Result<u64> {
    let mut bytes = [0; 8];
    reader.read_exact(&mut bytes)?;
    let count = u64::from_le_bytes(bytes);
    if count > MOST {
        return Err(invalid(format!("the state claims {count} of something")));
    }
    Ok(count)
}

fn read_values(reader: &mut dyn Read, values: &mut [f64]) -> Result<()> {
    let mut bytes = [0; 8];
    for value in values {
        reader.read_exact(&mut bytes)?;
        *value = f64::from_le_bytes(bytes);
        if !value.is_finite() {
            return Err(invalid("the state holds a number that is not finite".to_owned()));
        }
    }
    Ok(())
}

fn read_vectors(reader: &mut dyn Read, vectors: &mut [Vector3]) -> Result<()> {
    for vector in vectors {
        let mut values = [0.0; 3];
        read_values(reader, &mut values)?;
        *vector = Vector3::from_array(values);
    }
    Ok(())
}
