//! Observing a study: what it will cost, how far it is, what it found.

use crate::prepared::Prepared;
use basis::records::{PitchResponse, Summary};
use farm::plan::GridOfPlan;
use farm::self_check::SelfCheck;
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a study will cost, known before it starts.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Runs still to be made, in all studies (–).
    pub n_runs: usize,
    /// Studies that a sweep makes; 1 without one (–). Grid, steps and wind are those of the first.
    pub n_studies: usize,
    /// Runs that are made at a time (–).
    pub n_jobs: usize,
    /// Cell updates of all runs together; where there are no cells, steps with wakes of full length (–).
    pub work: f64,
    /// Steps of all runs together (–).
    pub n_steps_in_all: u64,
    /// Pitch-response identifications before them (–).
    pub n_identifications: usize,
    /// Steps of all identifications together (–).
    pub n_identification_steps: u64,
    /// Cell updates of all identifications together, or what takes as long (–); steps where there are no
    /// cells.
    pub identification_work: f64,
    /// Cells of the domain along x, y, z, those beneath boxes of finer ones included (–).
    pub n_cells: [usize; 3],
    /// Edge of such a cell (m).
    pub spacing: f64,
    /// The grid of the domain, and those of all boxes of finer cells.
    pub grids: Vec<GridOfPlan>,
    /// Cell updates of one run; where there are no cells, steps with wakes of full length (–).
    pub updates: f64,
    /// Flow step, of the finest cells (s).
    pub interval: f64,
    /// Steps of one run (–).
    pub n_steps: u64,
    /// Memory of flow field and turbulence, of all runs that are made at a time (bytes).
    pub memory: u64,
    /// Disk that one run takes at most at any time, checkpoint included (bytes).
    pub disk: u64,
    /// Rows in the series of a run (–).
    pub n_rows: u64,
    /// Disk that a row of the series with most channels takes, in `series.csv` and in the `.outb` of all
    /// turbines (bytes).
    pub row: u64,
    /// The same as `disk` of all runs still to be made, one after the other, and of the report (bytes).
    pub disk_in_all: u64,
    /// How much of it are checkpoints that stay, so that runs can go on for longer (bytes).
    pub kept_checkpoints: u64,
    /// Most that a run under way has of checkpoints beside what it keeps (bytes).
    pub passing_checkpoint: u64,
    /// Cell updates a second, or steps with wakes of full length where there are no cells, measured on this
    /// machine in the self-check; absent before it (1/s).
    pub updates_per_second: Option<f64>,
    /// Share of the domain's cross-section that a rotor takes (–).
    pub blockage: f64,
    /// Rise of a rotor's power below rated by the domain's walls, in every run alike (–).
    pub wall_gain: f64,
    /// Free-stream speed in cells per step (–).
    pub lattice_speed: f64,
}

impl Estimate {
    /// Wall time of identifications and runs together (s), once the machine's speed is known.
    pub fn wall_time(&self) -> Option<f64> {
        let all = self.work + self.identification_work;
        self.updates_per_second.map(|speed| all / speed)
    }

    /// Work of the identifications over that of one run (–).
    pub fn identification_share(&self) -> f64 {
        self.identification_work / self.updates
    }
}

/// How far the identifications before the runs are.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentificationProgress<'a> {
    /// Turbine whose pitch response is identified.
    pub turbine: &'a str,
    /// Place of the identification among those to be made, from 0.
    pub index: usize,
    /// Identifications to be made (–).
    pub n_identifications: usize,
    /// Share of this one that is done (–).
    pub share: f64,
    /// Wall time left for all identifications (s).
    pub time_left: f64,
}

/// How far a run is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress<'a> {
    /// Name of the run.
    pub run: &'a str,
    /// Its place among the runs to be made, from 0.
    pub run_index: usize,
    /// Runs to be made (–).
    pub n_runs: usize,
    /// Steps made (–).
    pub step: u64,
    /// Steps of the run (–).
    pub n_steps: u64,
    /// Cell updates a second since this process took the run up (1/s).
    pub updates_per_second: f64,
    /// Wall time left for all runs to be made (s).
    pub time_left: f64,
    /// Steps of it that an earlier process made (–).
    pub first_step: u64,
    /// Runs that are made at a time (–).
    pub n_at_a_time: usize,
    /// Share of all runs to be made that is done (–).
    pub share_of_all: f64,
}

/// Observes a study; every method may be left out.
pub trait Observer {
    /// The case is read and checked, its turbines are loaded and its domain is laid out.
    fn prepared(&mut self, _prepared: &Prepared) {}
    /// What comes next is about the study of a sweep in this folder in that of the sweep; never called
    /// without a sweep of studies.
    fn in_study(&mut self, _folder: &str) {}
    /// The cost, before the first step.
    fn estimated(&mut self, _estimate: &Estimate) {}
    /// All checks are passed, and the runs are about to be made: into `directory`, the folder of the study,
    /// or of the sweep.
    fn beginning(&mut self, _directory: &Path) {}
    /// Something is being prepared: `share` (–) of it is done.
    fn preparing(&mut self, _what: &str, _share: f64) {}
    /// A rotor was checked against blade-element momentum.
    fn checked(&mut self, _check: &SelfCheck) {}
    /// An identification moved on.
    fn identifying(&mut self, _progress: &IdentificationProgress) {}
    /// It was found how the pitch of the turbine called `turbine`, and of those alike, acts; `again`: by an
    /// earlier call.
    fn identified(&mut self, _turbine: &str, _response: &PitchResponse, _again: bool) {}
    /// A run moved on.
    fn advanced(&mut self, _progress: &Progress) {}
    /// A run is complete, and so are its records.
    fn finished(&mut self, _summary: &Summary) {}
    /// Something that a reader of the numbers must know.
    fn warned(&mut self, _warning: &str) {}
}

/// Takes the share (–) of the turbulence made to `observer`; gives a break when `stop` asks for an end.
pub(crate) fn making_turbulence<'a, 'o>(
    stop: &'a AtomicBool,
    observer: &'a RefCell<&'o mut dyn Observer>,
) -> impl Fn(f64) -> ControlFlow<()> + use<'a, 'o> {
    move |share| {
        observer.borrow_mut().preparing("turbulence", share);
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

/// Ignores every event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Silent;

impl Observer for Silent {}
