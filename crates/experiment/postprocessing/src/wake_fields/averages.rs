//! Averages by phase: those that were kept, or made of instants.

use super::settings::{self, BINS, CYCLES, FIELD, TURBINE, WIDTH};
use super::source::Instants;
use super::{Angles, Fields, refused};
use crate::PostprocessingError;
use crate::phase::query::folder_of;
use crate::request::Request;
use analysis::phases::{Bins, Decomposer, Decomposition, PhaseAverager, PhaseError};
use basis::Sense;
use basis::records::{FieldSetting, Grid, Moments, PhaseAverages};
use formats::records::{StoredPhaseAverages, write_phase_averages};
use std::path::{Path, PathBuf};

/// Most memory that averages may take (bytes).
const MOST_MEMORY: u64 = 16 << 30;

/// Averages by phase.
pub(crate) struct Averaged {
    /// Where they come from.
    pub(crate) path: PathBuf,
    /// What they were taken of.
    pub(crate) setting: FieldSetting,
    /// All but the bins' moments.
    pub(crate) head: PhaseAverages,
    /// What must be said of them.
    pub(crate) remarks: Vec<String>,
    /// Rotor and excitation frequency (Hz), where they are known.
    pub(crate) rates: Rates,
    moments: Made,
}

enum Made {
    Stored(Box<StoredPhaseAverages>),
    Now(Box<PhaseAverager>),
}

impl Averaged {
    /// Those that `request` is about: kept ones, or made of instants now.
    ///
    /// # Errors
    /// [`PostprocessingError`].
    pub(crate) fn of(request: &Request) -> Result<Self, PostprocessingError> {
        match Fields::open(request, true)? {
            Fields::Averages(stored, file) => Self::kept(request, *stored, file),
            Fields::Instants(instants) => Self::made(request, *instants),
        }
    }

    /// Those that lie in `file`; a run's series tells how fast rotor and helix turned.
    fn kept(
        request: &Request,
        stored: StoredPhaseAverages,
        file: PathBuf,
    ) -> Result<Self, PostprocessingError> {
        let is_of_run = file != request.run();
        let mut remarks = empty_bins(&stored.head);
        let mut rates = None;
        if is_of_run {
            match Angles::of_run(&folder_of(request.run()), request.text(TURBINE.name)) {
                Ok(angles) => rates = angles.rates(stored.head.span),
                // Of averages that are made the azimuths are known; how fast they grow need not be.
                Err(error @ PostprocessingError::Fields { .. }) => {
                    remarks.push(format!("how fast rotor and helix turned is not known: {error}"));
                }
                Err(error) => return Err(error),
            }
        }
        if is_of_run && request.text(FIELD.name).is_none() {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            remarks.push(format!("averages of {name}; --field names other planes of the run"));
        }
        let (setting, head) = (stored.setting.clone(), stored.head.clone());
        Ok(Self {
            path: file,
            setting,
            head,
            remarks,
            rates,
            moments: Made::Stored(Box::new(stored)),
        })
    }

    fn made(request: &Request, mut instants: Instants) -> Result<Self, PostprocessingError> {
        let path = instants.file.path().to_owned();
        let width_deg = settings::positive(request, &WIDTH, Bins::WIDTH.to_degrees())?;
        let (angles, span) = (instants.angles.as_ref(), instants.span());
        let (bins, rates, mut remarks) = bins(request, &path, angles, span, width_deg)?;
        let grid = *instants.file.grid();
        let memory = PhaseAverager::memory(grid.len() as u64, &bins);
        if memory > MOST_MEMORY {
            let problem = format!(
                "has {} points, which take {:.1} GiB in {} bins",
                grid.len(),
                memory as f64 / 2_f64.powi(30),
                bins.len()
            );
            let fix = "ask for fewer bins (--bins, --cycles), or give a part of the field";
            return Err(refused(&path, problem, fix));
        }
        remarks.push(format!(
            "averages of {} points in {} bins take {:.1} MB",
            grid.len(),
            bins.len(),
            memory as f64 / 1e6
        ));
        let mut averager = PhaseAverager::new(grid, bins);
        let in_fields = |error: PhaseError| {
            refused(&path, error.to_string(), "correct the times or azimuths of the fields")
        };
        instants.each(|field, (rotor, helix)| {
            let velocity = field.velocity.each_ref().map(Vec::as_slice);
            averager.add(field.time, rotor, helix, velocity).map_err(in_fields)?;
            Ok(())
        })?;
        let head = averager.head();
        let n_samples = (grid.len() * instants.places.len()) as f64;
        if averager.n_holes() > 0 {
            remarks.push(format!(
                "{} of {} samples are holes ({:.2} %): they count in no average",
                averager.n_holes(),
                n_samples,
                100.0 * averager.n_holes() as f64 / n_samples
            ));
        }
        let n_zeros = instants.file.n_zeros();
        if n_zeros > 0 {
            remarks.push(format!(
                "{n_zeros} of {n_samples} velocities are exactly zero ({:.2} %): taken as --zeros says, for air that stands still when left out",
                100.0 * n_zeros as f64 / n_samples
            ));
        }
        remarks.extend(empty_bins(&head));
        let setting = instants.setting;
        Ok(Self { path, setting, head, remarks, rates, moments: Made::Now(Box::new(averager)) })
    }

    /// Whether they were made of instants now.
    pub(crate) fn is_made_now(&self) -> bool {
        matches!(self.moments, Made::Now(_))
    }

    /// The points.
    pub(crate) fn grid(&self) -> &Grid {
        &self.head.grid
    }

    /// Mean and moments of bin number `index`.
    ///
    /// # Errors
    /// [`PostprocessingError::File`].
    pub(crate) fn bin(&self, index: usize) -> Result<Moments, PostprocessingError> {
        match &self.moments {
            Made::Stored(stored) => Ok(stored.bin(index)?),
            Made::Now(averager) => Ok(averager.bin(index)),
        }
    }

    /// Mean, periodic and random parts.
    ///
    /// # Errors
    /// [`PostprocessingError::File`].
    pub(crate) fn decomposition(&self) -> Result<Decomposition, PostprocessingError> {
        let mut decomposer = Decomposer::new(&self.head.all);
        for index in 0..self.head.bins.len() {
            decomposer.add(&self.bin(index)?);
        }
        Ok(decomposer.finish())
    }

    /// Writes them to `path`, where they were made now.
    ///
    /// # Errors
    /// [`PostprocessingError::File`].
    pub(crate) fn write(&self, path: &Path) -> Result<(), PostprocessingError> {
        match &self.moments {
            Made::Now(averager) => {
                let bin = |index: usize| averager.bin(index);
                Ok(write_phase_averages(path, &self.setting, &self.head, bin)?)
            }
            Made::Stored(_) => Err(refused(&self.path, "holds averages already", "copy the file")),
        }
    }

    /// Bin number `index` in words: its azimuths.
    pub(crate) fn name_of_bin(&self, index: usize) -> String {
        let bin = &self.head.bins[index];
        if self.head.bins.len() == 1 {
            return "all instants".to_owned();
        }
        let rotor = format!("rotor {:.0}°", bin.rotor.to_degrees());
        match bin.helix {
            Some(helix) => format!("{rotor}, helix {:.0}°", helix.to_degrees()),
            None => rotor,
        }
    }

    /// Samples behind them in words.
    pub(crate) fn samples(&self) -> String {
        let counts = || self.head.bins.iter().map(|bin| bin.n_instants);
        let n_bins = self.head.bins.len();
        if n_bins == 1 {
            let [from, to] = self.head.span;
            let n: u64 = counts().sum();
            return format!("{n} instants, {from:.1} to {to:.1} s");
        }
        format!(
            "{} bins of {} to {} instants, {:.0} on the average, {:.1} to {:.1} s",
            n_bins,
            counts().min().unwrap_or(0),
            counts().max().unwrap_or(0),
            counts().sum::<u64>() as f64 / n_bins.max(1) as f64,
            self.head.span[0],
            self.head.span[1]
        )
    }

    /// Samples behind them in words, with the bin that has fewest and those that are empty.
    pub(crate) fn counts(&self) -> String {
        let bins = &self.head.bins;
        let fewest = (0..bins.len()).min_by_key(|index| bins[*index].n_instants);
        let mut text = self.samples();
        if let (Some(index), true) = (fewest, bins.len() > 1) {
            text += &format!(", fewest in bin {index} ({})", self.name_of_bin(index));
        }
        match empty_bins(&self.head).first() {
            Some(empty) => format!("{text}; {empty}"),
            None => format!("{text}; no bin is empty"),
        }
    }
}

/// Which bins are empty, in words.
fn empty_bins(head: &PhaseAverages) -> Vec<String> {
    let empty: Vec<String> = (0..head.bins.len())
        .filter(|index| head.bins[*index].n_instants == 0)
        .map(|index| index.to_string())
        .collect();
    if empty.is_empty() {
        return Vec::new();
    }
    vec![format!(
        "{} of {} bins are empty and count in no average: {}",
        empty.len(),
        head.bins.len(),
        empty.join(", ")
    )]
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
