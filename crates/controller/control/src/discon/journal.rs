//! What was exchanged with a library, from which it is brought back to where it was.
//!
//! A library keeps its state to itself. But it is made of what the library was sent: another instance that is
//! sent the same comes to the same state, and shows on the way whether it does by asking for the same.
//! OpenFAST's own protocol (status −8 writes a file, −9 reads it) is not used: its calls move a library's
//! filters on by a step that the run does not have, so that a resumed run would have other bits.

use super::swap::{Returned, Sent};
use serde::{Deserialize, Serialize};

/// All calls since the run began.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Journal {
    calls: Vec<Call>,
}

/// One call.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Call {
    pub(super) sent: Sent,
    pub(super) returned: Returned,
}

impl Journal {
    /// One with room for `n_calls`, so that a run of so many never allocates.
    pub(super) fn with_room(n_calls: usize) -> Self {
        Self { calls: Vec::with_capacity(n_calls) }
    }

    pub(super) fn add(&mut self, sent: Sent, returned: Returned) {
        self.calls.push(Call { sent, returned });
    }

    /// Whether there was a call.
    pub(super) fn is_begun(&self) -> bool {
        !self.calls.is_empty()
    }

    /// The last call.
    pub(super) fn last(&self) -> Option<&Call> {
        self.calls.last()
    }

    /// All calls, in order.
    pub(super) fn into_calls(self) -> Vec<Call> {
        self.calls
    }
}

impl Call {
    /// Whether `returned` is, bit for bit, what came back.
    pub(super) fn repeats(&self, returned: &Returned) -> bool {
        let bits = |values: &Returned| values.map(f32::to_bits);
        bits(&self.returned) == bits(returned)
    }
}
