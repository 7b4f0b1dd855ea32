//! The outputs of one run under way, each at work in the steps in which it is due.

use super::output::{Output, OutputKind, Scene};
use super::section::{Section, Stored};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use basis::records::Warning;
use basis::{Commands, Truth};
use farm::case::{Case, Requested, Run};
use farm::{Air, Farm, Recorder};
use formats::checkpoint::{CheckpointReader, CheckpointWriter};
use formats::records::RunFolder;
use std::any::Any;
use std::path::PathBuf;

/// What a run under way shows to all its outputs.
#[derive(Clone, Copy)]
pub(crate) struct Stage<'a> {
    /// What all runs of the study share.
    pub(crate) setup: &'a Prepared,
    /// The run.
    pub(crate) run: &'a Run,
    /// Folder of the run.
    pub(crate) folder: &'a RunFolder,
    /// Turbines, controllers and air.
    pub(crate) farm: &'a Farm<Air>,
}

impl<'a> Stage<'a> {
    /// The same, as the output `name` with `values` under its own keys sees it.
    fn seen_by(&self, name: &'a str, values: &'a Values) -> Scene<'a> {
        let Stage { setup, run, folder, farm } = *self;
        Scene { setup, run, folder, farm, name, values }
    }
}

/// The outputs of one run under way, in the order in which they finish.
pub(crate) struct Writers<'a>(Vec<Writer<'a>>);

struct Writer<'a> {
    name: &'a str,
    values: &'a Values,
    /// Name of its section of the checkpoint.
    section: String,
    output: Box<dyn Output>,
    /// Whether it is due in the present step.
    is_due: bool,
}

/// What outputs without keys of their own hold under them.
static NOTHING: Values = Values::none();

impl<'a> Writers<'a> {
    /// Begins those of `kinds` that `case` asks for and its flow can feed, and those that it asks for by
    /// name, or takes them up from the checkpoint `stored`.
    ///
    /// # Errors
    /// [`StudyError`] of an output that cannot be begun, or not go on from the checkpoint.
    pub(crate) fn begin(
        kinds: &[&'static OutputKind],
        case: &'a Case,
        stage: &Stage,
        mut stored: Option<&mut CheckpointReader>,
    ) -> Result<Self, StudyError> {
        let mut list = Vec::new();
        let mut begin = |kind: &OutputKind, name: &'a str, values: &'a Values, section: String| {
            let stored = stored.as_deref_mut().map(|reader| Stored::new(reader, &section));
            if let Some(output) = (kind.begin)(&stage.seen_by(name, values), stored)? {
                list.push(Writer { name, values, section, output, is_due: false });
            }
            Ok::<(), StudyError>(())
        };
        for kind in kinds.iter().filter(|kind| !kind.is_named() && kind.fed_by.admits(case)) {
            begin(kind, kind.name, &NOTHING, kind.name.to_owned())?;
        }
        for requested in &case.output.further {
            let Requested { name, values, .. } = requested;
            // No kind has such a name, for it has a point in it.
            begin(kind_of(requested)?, name, values, format!("further.{name}"))?;
        }
        Ok(Self(list))
    }

    /// Finds out which outputs are due in the step that now begins, and lets them look at the farm before it.
    pub(crate) fn before_step(&mut self, stage: &Stage) {
        let step = stage.farm.step() + 1;
        for writer in &mut self.0 {
            writer.is_due = writer.output.schedule().is_due(step);
        }
        for writer in self.due() {
            writer.output.before_step(&stage.seen_by(writer.name, writer.values));
        }
    }

    /// Lets the outputs that are due write at the end of the step.
    ///
    /// # Errors
    /// [`StudyError`] of the first that cannot.
    pub(crate) fn write(&mut self, stage: &Stage) -> Result<(), StudyError> {
        self.due()
            .try_for_each(|writer| writer.output.write(&stage.seen_by(writer.name, writer.values)))
    }

    /// Lets each leave its state in a section of its own.
    ///
    /// # Errors
    /// [`StudyError`] of the first that cannot.
    pub(crate) fn checkpoint(
        &mut self,
        checkpoint: &mut CheckpointWriter,
    ) -> Result<(), StudyError> {
        self.0.iter_mut().try_for_each(|writer| {
            writer.output.checkpoint(Section::new(checkpoint, &writer.section))
        })
    }

    /// Puts on the disk what is of use of a run that has broken down; gives the first such file.
    pub(crate) fn salvage(&mut self) -> Option<PathBuf> {
        self.0.iter_mut().filter_map(|writer| writer.output.salvage()).reduce(|first, _| first)
    }

    /// What a reader of the run's numbers must know of what they took in.
    pub(crate) fn warnings(&self, stage: &Stage) -> Vec<Warning> {
        let of =
            |writer: &Writer| writer.output.warnings(&stage.seen_by(writer.name, writer.values));
        self.0.iter().flat_map(of).collect()
    }

    /// Lets each complete its files.
    ///
    /// # Errors
    /// [`StudyError`] of the first that cannot.
    pub(crate) fn finish(&mut self, stage: &Stage) -> Result<(), StudyError> {
        self.0
            .iter_mut()
            .try_for_each(|writer| writer.output.finish(&stage.seen_by(writer.name, writer.values)))
    }

    fn due(&mut self) -> impl Iterator<Item = &mut Writer<'a>> {
        self.0.iter_mut().filter(|writer| writer.is_due)
    }
}

/// The kind of what a case asks for by name.
///
/// # Errors
/// [`StudyError::NotWritten`].
pub(super) fn kind_of(requested: &Requested) -> Result<&'static OutputKind, StudyError> {
    let kind: &'static dyn Any = requested.kind;
    kind.downcast_ref().ok_or_else(|| StudyError::NotWritten {
        name: requested.name.clone(),
        kind: requested.kind.name(),
    })
}

impl Recorder for Writers<'_> {
    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands) {
        self.due().for_each(|writer| writer.output.record(turbine, truth, commands));
    }
}
