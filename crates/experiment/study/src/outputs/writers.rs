//! The outputs of one run under way, each at work in the steps in which it is due.

use super::output::{Output, OutputKind, Scene};
use super::section::{Section, Stored};
use crate::error::StudyError;
use basis::{Commands, Truth};
use farm::Recorder;
use formats::checkpoint::{CheckpointReader, CheckpointWriter};
use std::path::PathBuf;

/// The outputs of one run under way, in the order in which they finish.
pub(crate) struct Writers(Vec<Writer>);

struct Writer {
    name: &'static str,
    output: Box<dyn Output>,
    /// Whether it is due in the present step.
    is_due: bool,
}

impl Writers {
    /// Begins those of `kinds` that the case asks for and its flow can feed, or takes them up from the
    /// checkpoint `stored`.
    ///
    /// # Errors
    /// [`StudyError`] of an output that cannot be begun, or not go on from the checkpoint.
    pub(crate) fn begin(
        kinds: &[&'static OutputKind],
        scene: &Scene,
        mut stored: Option<&mut CheckpointReader>,
    ) -> Result<Self, StudyError> {
        let mut list = Vec::new();
        for kind in kinds.iter().filter(|kind| kind.fed_by.admits(&scene.setup.case)) {
            let stored = stored.as_deref_mut().map(|reader| Stored::new(reader, kind.name));
            if let Some(output) = (kind.begin)(scene, stored)? {
                list.push(Writer { name: kind.name, output, is_due: false });
            }
        }
        Ok(Self(list))
    }

    /// Finds out which outputs are due in the step that now begins, and lets them look at the farm before it.
    pub(crate) fn before_step(&mut self, scene: &Scene) {
        let step = scene.farm.step() + 1;
        for writer in &mut self.0 {
            writer.is_due = writer.output.schedule().is_due(step);
        }
        self.due().for_each(|output| output.before_step(scene));
    }

    /// Lets the outputs that are due write at the end of the step.
    ///
    /// # Errors
    /// [`StudyError`] of the first that cannot.
    pub(crate) fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        self.due().try_for_each(|output| output.write(scene))
    }

    /// Lets each leave its state in a section of its own.
    ///
    /// # Errors
    /// [`StudyError`] of the first that cannot.
    pub(crate) fn checkpoint(
        &mut self,
        checkpoint: &mut CheckpointWriter,
    ) -> Result<(), StudyError> {
        self.0
            .iter_mut()
            .try_for_each(|writer| writer.output.checkpoint(Section::new(checkpoint, writer.name)))
    }

    /// Puts on the disk what is of use of a run that has broken down; gives the first such file.
    pub(crate) fn salvage(&mut self) -> Option<PathBuf> {
        self.0.iter_mut().filter_map(|writer| writer.output.salvage()).reduce(|first, _| first)
    }

    /// Lets each complete its files.
    ///
    /// # Errors
    /// [`StudyError`] of the first that cannot.
    pub(crate) fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        self.0.iter_mut().try_for_each(|writer| writer.output.finish(scene))
    }

    fn due(&mut self) -> impl Iterator<Item = &mut Box<dyn Output>> {
        self.0.iter_mut().filter(|writer| writer.is_due).map(|writer| &mut writer.output)
    }
}

impl Recorder for Writers {
    fn record(&mut self, turbine: usize, truth: &Truth, commands: &Commands) {
        self.due().for_each(|output| output.record(turbine, truth, commands));
    }
}
