//! A record of inputs and outputs from any table.

use crate::DesignError;
use formats::linear_model::Port;
use formats::table::{Column, TableReader};
use identification::{Channel, IdentificationError, Record};
use std::path::{Path, PathBuf};

/// Unevenness of rows that is borne (–): that of times written with few digits.
const UNEVEN: f64 = 0.02;

/// Which part of which table.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// OpenFAST output, CSV with a column of time, or the folder of a run.
    pub file: PathBuf,
    /// Channels that act; a unit at the end of a name may be left out.
    pub inputs: Vec<String>,
    /// Channels that answer.
    pub outputs: Vec<String>,
    /// First and last time that is taken (s).
    pub span: [f64; 2],
}

/// What was read: the record in the units of its file, with names and units of inputs and outputs.
pub(crate) struct Data {
    pub(crate) record: Record,
    pub(crate) ports: [Vec<Port>; 2],
    pub(crate) path: PathBuf,
}

impl Data {
    /// Reads `source`.
    ///
    /// # Errors
    /// [`DesignError::File`], [`DesignError::UnevenTimes`], and [`DesignError::Identification`] for channels
    /// that do not move.
    pub(crate) fn read(source: &Source) -> Result<Self, DesignError> {
        let mut table = TableReader::open(&source.file)?;
        let names: Vec<&str> =
            source.inputs.iter().chain(&source.outputs).map(|name| name.trim()).collect();
        table.select(&names)?;
        let path = table.path().to_owned();
        let mut row = vec![0.0; names.len() + 1];
        let (mut times, mut columns) = (Vec::new(), vec![Vec::new(); names.len()]);
        while table.read(&mut row)? {
            if (source.span[0]..=source.span[1]).contains(&row[0]) {
                times.push(row[0]);
                columns.iter_mut().zip(&row[1..]).for_each(|(column, value)| column.push(*value));
            }
        }
        let interval = even(&times, &path)?;
        let ports: Vec<Port> = table.selected().map(port).collect();
        let channels = ports.iter().zip(columns);
        let mut channels: Vec<Channel> =
            channels.map(|(port, samples)| Channel::new(port.name.as_str(), samples)).collect();
        let outputs = channels.split_off(source.inputs.len());
        let record = Record::new(channels, outputs, interval)
            .map_err(|source| DesignError::Identification { path: path.clone(), source })?;
        let (inputs, outputs) = ports.split_at(source.inputs.len());
        Ok(Self { record, ports: [inputs.to_vec(), outputs.to_vec()], path })
    }

    /// An error of identification, with the record's name.
    pub(crate) fn failed(&self, source: IdentificationError) -> DesignError {
        DesignError::Identification { path: self.path.clone(), source }
    }
}

/// Name and unit of `column`; that of a run's series has its unit behind its name.
fn port(column: &Column) -> Port {
    match basis::Channel::of_column(&column.name) {
        Some(channel) if column.unit.is_empty() => {
            Port { name: channel.name.into_owned(), unit: channel.unit.symbol().to_owned() }
        }
        _ => Port { name: column.name.clone(), unit: column.unit.clone() },
    }
}

/// The interval (s) of `times`, which are the same distance apart.
fn even(times: &[f64], path: &Path) -> Result<f64, DesignError> {
    if times.len() < 2 {
        let source = IdentificationError::TooFewSamples {
            found: times.len(),
            needed: 2,
            purpose: "a record",
        };
        return Err(DesignError::Identification { path: path.to_owned(), source });
    }
    let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    for pair in times.windows(2) {
        let other = pair[1] - pair[0];
        if (other - interval).abs() > UNEVEN * interval {
            let (path, first) = (path.to_owned(), interval);
            return Err(DesignError::UnevenTimes { path, first, other, time: pair[0] });
        }
    }
    Ok(interval)
}
