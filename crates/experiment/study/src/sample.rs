//! What one case of many costs: a sample, timed for a moment.

use crate::StudyError;
use crate::air;
use crate::outputs::{Outputs, announce};
use crate::prepared::Prepared;
use crate::self_check::MOST_TIMED;
use formats::case::CaseFile;
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::time::Instant;

/// What a case costs that was looked at and timed for a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Wall time of its runs one after the other (s); absent where its speed could not be told.
    pub wall_time: Option<f64>,
    /// Memory of flow field and turbulence (bytes).
    pub memory: u64,
    /// Disk that its runs take at most at any time (bytes).
    pub disk: u64,
    /// Disk that their series take in the end (bytes).
    pub series: u64,
}

impl Sample {
    /// The cost of the runs called `runs`, of all where none is named, of the case of `file`, on so many
    /// `threads`, all cores when absent. Its turbulence is made and its steps are timed; the check of rotors
    /// before a study in resolved flow is not counted.
    ///
    /// # Errors
    /// [`StudyError`] for a case that cannot be run.
    pub fn of(
        file: &CaseFile,
        runs: &[String],
        threads: Option<usize>,
    ) -> Result<Self, StudyError> {
        announce();
        let began = Instant::now();
        let mut prepared = Prepared::of_file(file)?;
        if threads.is_some() {
            prepared.case.flow.threads = threads;
        }
        let all = prepared.case.runs.iter().enumerate();
        let wanted = all.filter(|(_, run)| runs.is_empty() || runs.contains(&run.name));
        let open: Vec<usize> = wanted.map(|(index, _)| index).collect();
        let Some(&first) = open.first() else {
            let known = prepared.case.runs.iter().map(|run| run.name.clone()).collect();
            let name = runs.first().cloned().unwrap_or_default();
            return Err(StudyError::UnknownRun { name, known });
        };
        let costs = prepared.identifications(&open, Vec::new()).costs(&mut BTreeSet::new());
        let estimate = prepared.estimate(&open, &costs, &Outputs::standard());
        let is_small = prepared.plan.cells() <= MOST_TIMED;
        prepared.make_air(is_small)?;
        let setup = began.elapsed().as_secs_f64();
        let run = &prepared.case.runs[first];
        let speed = match is_small {
            true => prepared.timed_in_place(run, 1)?,
            false => prepared.timed(run, 1)?.updates_per_second,
        };
        let work = estimate.work + estimate.identification_work;
        Ok(Self {
            wall_time: speed.map(|speed| setup + work / speed),
            memory: estimate.memory,
            disk: estimate.disk_in_all,
            series: estimate.n_rows * estimate.row * open.len() as u64,
        })
    }
}

impl Prepared {
    /// Makes the turbulence that enters, and the air of a run where that is small, as each study does.
    fn make_air(&self, is_small: bool) -> Result<(), StudyError> {
        let go_on = |_: f64| ControlFlow::Continue(());
        let is_read = farm::wind::enters_from_file(&self.case);
        let planes = if is_read { Some(air::planes(self)?) } else { None };
        let entering = farm::wind::entering(&self.site(), planes, &go_on)?;
        if is_small {
            let inflow = entering.unwrap_or_else(|| Arc::clone(&self.mean_inflow));
            air::begin(self, &inflow, &go_on)?;
        }
        Ok(())
    }
}
