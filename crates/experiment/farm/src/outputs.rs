//! Outputs that a case asks for by a name: what the reader of case files knows of their kinds. What writes
//! them stands above, where files are written.

use basis::keys::{Objection, Table, Values};
use basis::registry::{Named, Registry};
use std::any::Any;
use std::fmt;

/// A kind of output, as far as a case file speaks of it.
pub trait OutputKeys: Named + Any + Sync {
    /// Its keys in the case file, beside `kind`.
    fn table(&self) -> &'static Table;

    /// What about `values` cannot be, beyond what the keys say one by one.
    fn check(&self, _values: &Values) -> Vec<Objection> {
        Vec::new()
    }

    /// Whether it can be made of a flow that resolves the rotors' induction, or of one that does not.
    fn takes(&self, _resolves_induction: bool) -> bool {
        true
    }
}

/// The kinds of outputs that a case can ask for by a name. Those of the program are added by who writes them,
/// a study; programs built on it add their own.
pub static OUTPUTS: Registry<dyn OutputKeys> = Registry::new(&[]);

/// An output that a case asks for.
#[derive(Clone)]
pub struct Requested {
    /// Its name, which may name files.
    pub name: String,
    /// What it is.
    pub kind: &'static dyn OutputKeys,
    /// What its keys hold.
    pub values: Values,
}

impl fmt::Debug for Requested {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, kind, values } = self;
        write!(formatter, "{name}: {} {values:?}", kind.name())
    }
}

impl PartialEq for Requested {
    fn eq(&self, other: &Self) -> bool {
        let same_kind = self.kind.name() == other.kind.name();
        self.name == other.name && same_kind && self.values == other.values
    }
}
