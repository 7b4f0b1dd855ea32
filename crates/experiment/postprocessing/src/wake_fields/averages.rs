//! Averages by phase: those that were kept, or made of instants.

use super::compared::Compared;
use super::making::{Making, Rates, Wanted, in_fields};
use super::settings::{FIELD, TURBINE};
use super::shown::shown;
use super::source::Instants;
use super::strips::{Strip, each_strip};
use super::{Angles, Fields, refused};
use crate::PostprocessingError;
use crate::phase::query::folder_of;
use crate::request::{Request, Told};
use analysis::phases::{Decomposer, Decomposition};
use basis::records::{FieldSetting, Grid, Moments, PhaseAverages};
use formats::records::{PhaseAveragesWriter, StoredPhaseAverages};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::PathBuf;

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
    /// Blades of the turbine that they are of (–), where a run tells them.
    pub(crate) n_blades: Option<usize>,
    /// Averages at some points in windows of other widths, where they were made now and asked for.
    pub(crate) compared: Vec<PhaseAverages>,
    moments: Made,
}

enum Made {
    Stored(Box<StoredPhaseAverages>),
    /// Taken apart, and the bins that were kept, by their numbers.
    Now(Box<Decomposition>, BTreeMap<usize, Moments>),
}

impl Averaged {
    /// Those that `request` is about, with what is `wanted` of them: kept ones, or made of instants now.
    ///
    /// # Errors
    /// [`PostprocessingError`].
    pub(crate) fn of(request: &Request, wanted: Wanted) -> Result<Self, PostprocessingError> {
        match (Fields::open(request, true)?, wanted) {
            (Fields::Averages(_, file), Wanted::Parts { out: Some(_), .. }) => {
                Err(refused(&file, "holds averages already", "copy the file"))
            }
            (Fields::Averages(stored, file), _) => Self::kept(request, *stored, file),
            (Fields::Instants(instants), _) => Self::made(request, *instants, wanted),
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
        let (mut rates, mut n_blades) = (None, None);
        if is_of_run {
            match Angles::of_run(&folder_of(request.run()), request.text(TURBINE.name)) {
                Ok(angles) => {
                    (rates, n_blades) = (angles.rates(stored.head.span), angles.n_blades());
                }
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
            n_blades,
            compared: Vec::new(),
            moments: Made::Stored(Box::new(stored)),
        })
    }

    fn made(
        request: &Request,
        mut instants: Instants,
        wanted: Wanted,
    ) -> Result<Self, PostprocessingError> {
        let path = instants.file.path().to_owned();
        let making = Making::of(request, &instants, wanted)?;
        let mut remarks = making.remarks.clone();
        let grid = *instants.file.grid();
        let mut head = PhaseAverages { grid, ..making.counts.head() };
        let mut writer = match wanted {
            Wanted::Parts { out: Some(out), .. } => {
                Some(PhaseAveragesWriter::create(out, &instants.setting, &head)?)
            }
            _ => None,
        };
        let all: Vec<usize> = (0..head.bins.len()).collect();
        let kept = match wanted {
            Wanted::Bins => all.clone(),
            Wanted::Parts { is_drawn: true, .. } if grid.spanned().len() == 2 => shown(&head),
            Wanted::Parts { .. } => Vec::new(),
        };
        let mut compared = Compared::new(grid.len(), making.sets);
        let mut whole = Strip::default();
        let (plan, batches) = (&making.plan, &making.batches);
        let fields = (&mut instants.file, instants.places.start);
        let done = each_strip(
            fields,
            (plan, batches),
            if writer.is_some() { &all } else { &kept },
            |read| Ok(compared.look(read)?),
            |points, mut strip| {
                request.watch.tell(&Told::Share(points.end as f64 / grid.len() as f64));
                if let Some(writer) = &mut writer {
                    let mut each = std::mem::take(&mut strip.each);
                    strip.each = kept.iter().map(|index| each[*index].clone()).collect();
                    writer.write(points, &strip.all, |index| std::mem::take(&mut each[index]))?;
                }
                whole.append(strip);
                Ok(())
            },
        );
        done.map_err(|trouble| in_fields(&path, trouble))?;
        if let Some(writer) = writer {
            writer.commit()?;
        }
        head.all = whole.all;
        let n_samples = (grid.len() * instants.places.len()) as f64;
        remarks.extend(holes(whole.n_holes, n_samples));
        remarks.extend(zeros(instants.file.n_zeros(), n_samples));
        remarks.extend(empty_bins(&head));
        let (setting, rates, compared) = (instants.setting, making.rates, compared.finish());
        let moments = Made::Now(Box::new(whole.parts), kept.into_iter().zip(whole.each).collect());
        let n_blades = instants.angles.as_ref().and_then(Angles::n_blades);
        Ok(Self { path, setting, head, remarks, rates, n_blades, compared, moments })
    }

    /// The points.
    pub(crate) fn grid(&self) -> &Grid {
        &self.head.grid
    }

    /// Mean and moments of bin number `index`.
    ///
    /// # Errors
    /// [`PostprocessingError::File`].
    ///
    /// # Panics
    /// Where that bin was not wanted.
    pub(crate) fn bin(&self, index: usize) -> Result<Moments, PostprocessingError> {
        match &self.moments {
            Made::Stored(stored) => Ok(stored.bin(index)?),
            Made::Now(_, each) => Ok(each[&index].clone()),
        }
    }

    /// Whether there is bin number `index`.
    pub(crate) fn has_bin(&self, index: usize) -> bool {
        match &self.moments {
            Made::Stored(_) => true,
            Made::Now(_, each) => each.contains_key(&index),
        }
    }

    /// Mean, periodic and random parts.
    ///
    /// # Errors
    /// [`PostprocessingError::File`].
    pub(crate) fn decomposition(&self) -> Result<Cow<'_, Decomposition>, PostprocessingError> {
        let stored = match &self.moments {
            Made::Now(parts, _) => return Ok(Cow::Borrowed(parts)),
            Made::Stored(stored) => stored,
        };
        let mut decomposer = Decomposer::new(&self.head.all);
        for index in 0..self.head.bins.len() {
            decomposer.add(&stored.bin(index)?);
        }
        Ok(Cow::Owned(decomposer.finish()))
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

/// How many of `n_samples` were missing, in words; none where none was.
fn holes(n_holes: u64, n_samples: f64) -> Option<String> {
    (n_holes > 0).then(|| {
        format!(
            "{n_holes} of {n_samples} samples are holes ({:.2} %): they count in no average",
            100.0 * n_holes as f64 / n_samples
        )
    })
}

/// How many of `n_samples` were zero, in words; none where none was.
fn zeros(n_zeros: u64, n_samples: f64) -> Option<String> {
    (n_zeros > 0).then(|| {
        format!(
            "{n_zeros} of {n_samples} velocities are exactly zero ({:.2} %): taken as --zeros says, for air that stands still when left out",
            100.0 * n_zeros as f64 / n_samples
        )
    })
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
