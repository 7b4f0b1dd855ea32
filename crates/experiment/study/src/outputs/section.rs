//! The section of a checkpoint that one output has for itself.

use crate::error::StudyError;
use formats::checkpoint::{CheckpointReader, CheckpointWriter};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Name of the section of the output `name`.
fn section_of(name: &str) -> String {
    format!("output {name}")
}

/// Where an output leaves what it must know to go on.
pub struct Section<'a> {
    writer: &'a mut CheckpointWriter,
    name: String,
}

impl<'a> Section<'a> {
    /// The section of the output `name` in the checkpoint of `writer`.
    pub(super) fn new(writer: &'a mut CheckpointWriter, name: &str) -> Self {
        Self { writer, name: section_of(name) }
    }

    /// Keeps `state`, every bit of it.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub fn keep(self, state: &impl Serialize) -> Result<(), StudyError> {
        Ok(self.writer.state(&self.name, state)?)
    }
}

/// What a checkpoint holds of an output.
pub struct Stored<'a> {
    reader: &'a mut CheckpointReader,
    name: String,
}

impl<'a> Stored<'a> {
    /// What `reader` holds of the output `name`.
    pub(super) fn new(reader: &'a mut CheckpointReader, name: &str) -> Self {
        Self { reader, name: section_of(name) }
    }

    /// The state that [`Section::keep`] was given.
    ///
    /// # Errors
    /// [`StudyError::File`] when the section is damaged, holds something else or is not there: the run was
    /// then begun without this output.
    pub fn state<T: DeserializeOwned>(self) -> Result<T, StudyError> {
        Ok(self.reader.state(&self.name)?)
    }
}
