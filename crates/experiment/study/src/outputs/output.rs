//! What an output is: the descriptor of its kind, and what writes it in one run.

use super::schedule::Schedule;
use super::section::{Section, Stored};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::{Objection, Table, Values};
use basis::records::Warning;
use basis::registry::Named;
use basis::{Commands, Truth};
use farm::case::{Case, Run};
use farm::outputs::OutputKeys;
use farm::{Air, Farm};
use formats::records::RunFolder;
use std::path::PathBuf;

/// All that a study must know of one kind of output.
pub struct OutputKind {
    /// Its name, one of its own; its section of the checkpoint bears it, and a case that asks for it by name.
    pub name: &'static str,
    /// How a case asks for it.
    pub keys: Keys,
    /// The flows that it can be made of.
    pub fed_by: FedBy,
    /// How much one run puts on the disk at most at any time (bytes), what it adds to two checkpoints
    /// included: from the bytes that it writes, never below them. The values are those of its own keys.
    pub disk: fn(&Prepared, &Run, &Values) -> u64,
    /// Begins it in a run, or takes it up from the checkpoint; none where the case does not ask for it.
    ///
    /// It begins anew whatever an earlier run of this name has left of it in the folder.
    pub begin: Begin,
}

/// Begins an output at the start of a run, or with what a checkpoint holds of it.
pub type Begin = fn(&Scene, Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError>;

/// How a case asks for an output.
#[derive(Clone, Copy, Debug)]
pub enum Keys {
    /// By these keys of `[output]`, which only this kind follows; by nothing where there are none.
    OfOutput(&'static [&'static str]),
    /// By a name: `output.further.NAME = { kind = "…", … }`, with the keys of its own table beside `kind`.
    Own(&'static OwnKeys),
}

/// Keys of a kind's own.
#[derive(Debug)]
pub struct OwnKeys {
    /// The keys.
    pub table: Table,
    /// What about their values cannot be, beyond what the keys say one by one.
    pub check: fn(&Values) -> Vec<Objection>,
}

impl OutputKind {
    /// Whether a case asks for it by a name.
    pub(super) fn is_named(&self) -> bool {
        matches!(self.keys, Keys::Own(_))
    }
}

impl Named for OutputKind {
    fn name(&self) -> &'static str {
        self.name
    }
}

/// Of a kind that has no keys of its own.
static NO_KEYS: Table =
    Table { heading: "output.further.NAME = { kind = … }", about: "It has no keys.", keys: &[] };

impl OutputKeys for OutputKind {
    fn table(&self) -> &'static Table {
        match self.keys {
            Keys::OfOutput(_) => &NO_KEYS,
            Keys::Own(own) => &own.table,
        }
    }

    fn check(&self, values: &Values) -> Vec<Objection> {
        match self.keys {
            Keys::OfOutput(_) => Vec::new(),
            Keys::Own(own) => (own.check)(values),
        }
    }

    fn takes(&self, resolves_induction: bool) -> bool {
        self.fed_by.takes(resolves_induction)
    }
}

/// The flows that an output can be made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FedBy {
    /// Any.
    AnyFlow,
    /// Resolved flow: planes and volumes need its cells.
    ResolvedFlow,
    /// Prescribed wind.
    PrescribedWind,
}

impl FedBy {
    /// Whether the flow of `case` is one of them.
    pub fn admits(self, case: &Case) -> bool {
        self.takes(case.flow.solver.resolves_induction)
    }

    fn takes(self, resolves_induction: bool) -> bool {
        match self {
            Self::AnyFlow => true,
            Self::ResolvedFlow => resolves_induction,
            Self::PrescribedWind => !resolves_induction,
        }
    }
}

/// What an output may look at: the study, the run and the farm as it stands, and what the case says of it.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// What all runs of the study share.
    pub setup: &'a Prepared,
    /// The run.
    pub run: &'a Run,
    /// Folder of the run.
    pub folder: &'a RunFolder,
    /// Turbines, controllers and air.
    pub farm: &'a Farm<Air>,
    /// Name of the output: that by which the case asks for it, or else that of its kind.
    pub name: &'a str,
    /// What its own keys hold.
    pub values: &'a Values,
}

/// One output of a run under way.
///
/// In every step that its schedule names, [`before_step`](Self::before_step) comes first, then the farm moves
/// on and [`record`](Self::record) is called for each turbine, then comes [`write`](Self::write). These three
/// allocate nothing that they can hold ready. The last call is [`finish`](Self::finish).
pub trait Output {
    /// When it is due; the same throughout the run.
    fn schedule(&self) -> Schedule;

    /// Takes in what it needs of the farm before a step that is due.
    fn before_step(&mut self, _scene: &Scene) {}

    /// Takes in the state of turbine number `turbine` when a step that is due began, the truth whatever its
    /// instruments showed, and what its controller commanded.
    fn record(&mut self, _turbine: usize, _truth: &Truth, _commands: &Commands) {}

    /// Takes in or writes what the farm shows at the end of a step that is due.
    ///
    /// # Errors
    /// [`StudyError`]; the run ends with it.
    fn write(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        Ok(())
    }

    /// Puts on the disk what was written so far, and leaves in `section` what [`OutputKind::begin`] needs to
    /// go on from here.
    ///
    /// # Errors
    /// [`StudyError`]; the run ends with it, the checkpoint before stands.
    fn checkpoint(&mut self, _section: Section) -> Result<(), StudyError> {
        Ok(())
    }

    /// Puts on the disk what was written so far of a run whose flow has broken down; gives the file, where it
    /// is of use.
    fn salvage(&mut self) -> Option<PathBuf> {
        None
    }

    /// What a reader of the run's numbers must know of what it took in; asked for before it finishes.
    fn warnings(&self, _scene: &Scene) -> Vec<Warning> {
        Vec::new()
    }

    /// Completes its files after the last step of the run. Outputs finish in the order of their list.
    ///
    /// # Errors
    /// [`StudyError`]; the run ends with it, the checkpoint before stands.
    fn finish(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        Ok(())
    }
}
