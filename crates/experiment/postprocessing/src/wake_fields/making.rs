//! How averages by phase are to be made: bins, batches, strips, and what that costs.

use super::plan::{MOMENTS, Plan};
use super::settings::{self, BINS, CYCLES, MEMORY, WIDTH};
use super::source::Instants;
use super::strips::{Trouble, line};
use super::{Angles, refused};
use crate::PostprocessingError;
use crate::request::{Request, Told};
use analysis::phases::{Bins, PhaseAverager, PhaseBatch, PhaseError};
use basis::Sense;
use std::ops::Range;
use std::path::Path;

/// Most memory that bins may take that are kept (bytes).
const MOST_MEMORY: u64 = 16 << 30;
/// Bytes of a point in what is told of all points: their moments, and what they are taken apart into.
const TOLD_BYTES: u64 = 224;

/// What is wanted of averages beside what is told of all points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wanted<'a> {
    /// The bins: they must fit into memory.
    Bins,
    /// Nothing else, so that they may be of any number; written to a file, windows of other widths (by these
    /// factors) compared at some points, and of planes that are drawn those bins kept that figures show.
    Parts { out: Option<&'a Path>, factors: &'a [f64], is_drawn: bool },
}

impl Wanted<'_> {
    /// No more than the parts.
    pub(crate) const PARTS: Self = Self::Parts { out: None, factors: &[], is_drawn: false };
}

/// How averages are to be made.
pub(super) struct Making {
    pub(super) plan: Plan,
    pub(super) batches: Vec<PhaseBatch>,
    /// Instants and visits of the bins, without a point.
    pub(super) counts: PhaseAverager,
    /// Bins to compare with, and their batches.
    pub(super) sets: Vec<(Bins, Vec<PhaseBatch>)>,
    pub(super) rates: Rates,
    pub(super) remarks: Vec<String>,
}

impl Making {
    /// How those that `request` is about are made of `instants`; its cost is told.
    pub(super) fn of(
        request: &Request,
        instants: &Instants,
        wanted: Wanted,
    ) -> Result<Self, PostprocessingError> {
        let path = instants.file.path();
        let width_deg = settings::positive(request, &WIDTH, Bins::WIDTH.to_degrees())?;
        let (angles, span) = (instants.angles.as_ref(), instants.span());
        let (bins, rates, mut remarks) = bins(request, path, angles, span, width_deg)?;
        let grid = instants.file.grid();
        if wanted == Wanted::Bins {
            check_bins(path, grid.len(), &bins)?;
        }
        let memory = (settings::whole(request, &MEMORY, 1, 256)? as u64) << 20;
        let keeps_bins = !matches!(wanted, Wanted::Parts { out: None, .. });
        let n_threads = std::thread::available_parallelism().map_or(1, usize::from);
        let of = (grid, instants.places.len());
        let plan = Plan::of(of, &bins, memory, (n_threads, keeps_bins)).map_err(|least| {
            let problem = format!(
                "has rows of {} points, one of which takes more than --memory in {} bins at {} instants",
                grid.n_points.into_iter().find(|n| *n > 1).unwrap_or(1),
                bins.len(),
                of.1
            );
            refused(path, problem, format!("ask for --memory {}", least.div_ceil(1 << 20)))
        })?;
        let phases = instants.phases()?;
        let sorted = |bins: Bins| -> Result<Vec<PhaseBatch>, PostprocessingError> {
            let batch = |span: Range<usize>| PhaseBatch::new(bins, &phases[span]);
            let batches: Result<_, _> = plan.batches().map(batch).collect();
            batches.map_err(|error| in_fields(path, error.into()))
        };
        let batches = sorted(bins)?;
        let mut counts = PhaseAverager::new(line(0), bins);
        for batch in &batches {
            let added = counts.add_batch(batch, [&[]; 3]);
            added.map_err(|error| in_fields(path, error.into()))?;
        }
        let factors = match wanted {
            Wanted::Parts { factors, .. } if bins.helix_width().is_some() => factors,
            _ => &[],
        };
        let mut sets = Vec::new();
        for factor in factors {
            let width_deg = (factor * width_deg).min(360.0);
            let bins = self::bins(request, path, angles, span, width_deg)?.0;
            sets.push((bins, sorted(bins)?));
        }
        let cost = cost(instants, &plan, &bins);
        if plan.strips().len() > 1 {
            request.watch.tell(&Told::Cost(&cost));
        }
        remarks.push(cost);
        Ok(Self { plan, batches, counts, sets, rates, remarks })
    }
}

/// That `bins` of `n_points` of the file at `path` fit into memory.
fn check_bins(path: &Path, n_points: usize, bins: &Bins) -> Result<(), PostprocessingError> {
    let memory = MOMENTS * n_points as u64 * bins.len() as u64;
    if memory <= MOST_MEMORY {
        return Ok(());
    }
    let problem = format!(
        "has {n_points} points, which take {:.1} GiB in {} bins",
        memory as f64 / 2_f64.powi(30),
        bins.len()
    );
    let fix = "average it first, strip by strip, with `wakemix analyse phases --out FILE`, and analyse that file; or ask for fewer bins (--bins, --cycles)";
    Err(refused(path, problem, fix))
}

/// What averages cost, in words.
fn cost(instants: &Instants, plan: &Plan, bins: &Bins) -> String {
    let (n_points, n_instants) = (instants.file.grid().len(), instants.places.len());
    let n_strips = plan.strips().len();
    let mut text = format!(
        "averages of {n_points} points in {} bins from {n_instants} instants, {:.3} GB in single precision: {n_strips} strips of at most {:.0} MB, and {:.0} MB for what is told of all points",
        bins.len(),
        (12 * n_points * n_instants) as f64 / 1e9,
        plan.memory as f64 / 2_f64.powi(20),
        (TOLD_BYTES * n_points as u64) as f64 / 2_f64.powi(20),
    );
    if n_strips > 1 && !instants.file.reads_in_places() {
        text += &format!(
            "; text is read whole for each strip, {n_strips} times: with more --memory there are fewer"
        );
    }
    text
}

/// What is wrong with the fields at `path`.
pub(super) fn in_fields(path: &Path, trouble: Trouble) -> PostprocessingError {
    match trouble {
        Trouble::File(error) => error.into(),
        Trouble::Phases(error) => {
            refused(path, error.to_string(), "correct the times or azimuths of the fields")
        }
    }
}

/// Frequencies of rotor and, with its sense, helix (Hz).
pub(crate) type Rates = Option<(f64, Option<(f64, Sense)>)>;

/// The bins that `request` asks for with windows of `width_deg`, at the `angles` of the file at `path`
/// between `span` (s); the frequencies; and what must be said.
pub(crate) fn bins(
    request: &Request,
    path: &Path,
    angles: Option<&Angles>,
    span: [f64; 2],
    width_deg: f64,
) -> Result<(Bins, Rates, Vec<String>), PostprocessingError> {
    let wrong = |error: PhaseError| {
        let fix = "ask for other --bins, --cycles or --width";
        refused(path, error.to_string(), fix)
    };
    let n_bins = settings::whole(request, &BINS, 1, Bins::N_AZIMUTHS)?;
    let Some(angles) = angles else {
        let remark = "no azimuths are told (--azimuths): all instants are in one bin, and periodic parts are not told from random ones";
        return Ok((Bins::of_rotor(1).map_err(wrong)?, None, vec![remark.to_owned()]));
    };
    let rates = angles.rates(span);
    let n_cycles = settings::whole(request, &CYCLES, 0, Bins::N_CYCLES)?;
    let bins = match rates {
        Some((rotor, Some((helix, sense)))) if n_cycles > 0 => {
            Bins::of_helix(n_bins, rotor / helix, n_cycles, sense, width_deg.to_radians())
        }
        _ => Bins::of_rotor(n_bins),
    };
    Ok((bins.map_err(wrong)?, rates, Vec::new()))
}
