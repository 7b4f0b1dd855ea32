//! Particles by phase: bins of rotor and helix azimuth, each with cells of its own.

use super::{MOST_MEMORY, mask};
use crate::PostprocessingError;
use crate::analyses::Request;
use crate::wake_fields::settings::{self, AZIMUTHS, WIDTH};
use crate::wake_fields::{Angles, averages_bins, refused};
use analysis::particles::{BinSettings, Binned, Binner, Particle, Screened};
use analysis::phases::Bins;
use basis::records::{FieldSetting, Moments, PhaseAverages, PhaseBin};
use formats::FileError;
use formats::records::write_phase_averages;
use formats::tracks::{Seen, each_particle};
use serde_json::json;
use std::cell::RefCell;
use std::f64::consts::TAU;
use std::ops::Range;
use std::path::Path;

/// Most instants that particles may have (–).
const MOST_INSTANTS: usize = 1 << 24;

/// The phases of particles.
pub(super) struct Phases {
    /// None where azimuths are not told: all particles are in one bin.
    by_angle: Option<(Angles, Bins)>,
    bins: Vec<PhaseBin>,
    span: [f64; 2],
}

/// How particles are put into cells, once more.
pub(super) struct By<'a> {
    pub(super) request: &'a Request,
    pub(super) bins: BinSettings,
    pub(super) screened: &'a Screened,
    /// Fluctuation that is no fault (m/s).
    pub(super) noise: f64,
}

impl Phases {
    /// Those that `request` asks for of particles that were `seen`.
    ///
    /// # Errors
    /// [`PostprocessingError`] for azimuths that cannot be read or do not span the particles, and particles
    /// that tell no time.
    pub(super) fn of(request: &Request, seen: &Seen) -> Result<Self, PostprocessingError> {
        let span = seen.span.unwrap_or_default();
        let Some(table) = request.text(AZIMUTHS.name) else {
            let bins = vec![PhaseBin { rotor: 0.0, helix: None, n_instants: 0, n_visits: 1 }];
            return Ok(Self { by_angle: None, bins, span });
        };
        let path = request.run();
        if seen.span.is_none() || seen.n_times_missing > 0 {
            let problem = "does not tell the times of all particles, by which azimuths are found";
            return Err(refused(
                path,
                problem,
                "add a column `time`, or SOLUTIONTIME to each zone",
            ));
        }
        let angles = Angles::of_table(Path::new(table))?;
        let width_deg = settings::positive(request, &WIDTH, Bins::WIDTH.to_degrees())?;
        let (bins, _, _) = averages_bins(request, path, Some(&angles), span, width_deg)?;
        let mut n = vec![(0_u64, 0_u64); bins.len()];
        let mut inside = vec![false; bins.len()];
        for time in instants(request)? {
            let (rotor, helix) = angles.at(time).ok_or_else(|| beyond(path, time))?;
            let mut is_in = vec![false; bins.len()];
            bins.of_instant(rotor, helix.unwrap_or(0.0)).for_each(|index| is_in[index] = true);
            for ((n, inside), is_in) in n.iter_mut().zip(&mut inside).zip(is_in) {
                n.0 += u64::from(is_in);
                n.1 += u64::from(is_in && !*inside);
                *inside = is_in;
            }
        }
        let bin = |(index, (n_instants, n_visits)): (usize, (u64, u64))| {
            let (rotor, helix) = bins.middle(index);
            PhaseBin { rotor, helix, n_instants, n_visits }
        };
        let all = n.into_iter().enumerate().map(bin).collect();
        Ok(Self { by_angle: Some((angles, bins)), bins: all, span })
    }

    /// How many instants the bins have, in words; nothing where there are none.
    pub(super) fn in_words(&self) -> String {
        if self.by_angle.is_none() {
            return String::new();
        }
        let counts = || self.bins.iter().map(|bin| bin.n_instants);
        format!(
            "{} bins of phase with {} to {} instants, of which {} are empty\n",
            self.bins.len(),
            counts().min().unwrap_or(0),
            counts().max().unwrap_or(0),
            counts().filter(|n| *n == 0).count()
        )
    }

    pub(super) fn json(&self) -> serde_json::Value {
        let bin = |bin: &PhaseBin| {
            json!({
                "rotor_azimuth_deg": bin.rotor.to_degrees(),
                "helix_azimuth_deg": bin.helix.map(f64::to_degrees),
                "n_instants": bin.n_instants,
                "n_visits": bin.n_visits,
            })
        };
        match self.by_angle {
            Some(_) => self.bins.iter().map(bin).collect(),
            None => serde_json::Value::Null,
        }
    }
}

fn beyond(path: &Path, time: f64) -> PostprocessingError {
    let problem = format!("has particles at {time} s, beyond the azimuths");
    refused(path, problem, "give azimuths over the time of all particles")
}

/// The instants at which there are particles (s), each once, ascending.
fn instants(request: &Request) -> Result<Vec<f64>, PostprocessingError> {
    let mut times: Vec<f64> = Vec::new();
    let mut is_too_many = false;
    each_particle(request.run(), settings::lengths(request), |one| {
        if let Some(time) = one.time
            && times.last() != Some(&time)
            && !is_too_many
        {
            times.push(time);
            // Tracks one after another tell the same instants again and again.
            if times.len() > MOST_INSTANTS {
                sort(&mut times);
                is_too_many = times.len() > MOST_INSTANTS / 2;
            }
        }
    })?;
    if is_too_many {
        let problem = format!("has particles at more than {} instants", MOST_INSTANTS / 2);
        return Err(refused(request.run(), problem, "round the times, or give a part of the file"));
    }
    sort(&mut times);
    Ok(times)
}

fn sort(times: &mut Vec<f64>) {
    times.sort_unstable_by(f64::total_cmp);
    times.dedup();
}

/// Writes what is in the cells to `path`, in `setting`: `all` particles, and those of each bin of `phases`,
/// for which the file is read as often as their cells fill the memory. Gives what must be said.
pub(super) fn write(
    path: &Path,
    setting: &FieldSetting,
    all: &Binned,
    phases: &Phases,
    by: &By,
) -> Result<Vec<String>, PostprocessingError> {
    let moments = counted(all);
    let mut bins = phases.bins.clone();
    let mut head = PhaseAverages {
        grid: all.grid,
        rotor_width: TAU,
        helix_width: None,
        span: phases.span,
        bins: Vec::new(),
        all: moments.clone(),
        pressure: None,
        each: Vec::new(),
    };
    let Some((angles, of_phase)) = &phases.by_angle else {
        bins[0].n_instants = u64::from(moments.n_samples.iter().copied().max().unwrap_or(0));
        head.bins = bins;
        write_phase_averages(path, setting, &head, |_| moments.clone())?;
        return Ok(Vec::new());
    };
    head.rotor_width = of_phase.rotor_width();
    head.helix_width = of_phase.helix_width();
    head.bins = bins;
    let n_each = ((MOST_MEMORY / by.bins.memory().max(1)) as usize).clamp(1, of_phase.len());
    let group = RefCell::new(Group { range: 0..0, binned: Vec::new(), n_odd: 0, failed: None });
    write_phase_averages(path, setting, &head, |index| {
        let mut group = group.borrow_mut();
        if !group.range.contains(&index) {
            let range = index..of_phase.len().min(index + n_each);
            group.fill(range, angles, of_phase, by);
        }
        let place = index - group.range.start;
        group.binned.get(place).map_or_else(|| empty(&moments), Clone::clone)
    })?;
    let group = group.into_inner();
    if let Some(error) = group.failed {
        let problem = format!("holds a part of the bins of phase alone: {error}");
        return Err(refused(path, problem, "remove it, and make it again"));
    }
    let n_passes = of_phase.len().div_ceil(n_each);
    Ok(vec![format!(
        "by phase the file was read {n_passes} times, {:.1} MB of cells at a time; {} cells of all bins are outliers by the universal median",
        (n_each as u64 * by.bins.memory()) as f64 / 1e6,
        group.n_odd
    )])
}

/// Bins of phase whose cells are in memory together.
struct Group {
    range: Range<usize>,
    binned: Vec<Moments>,
    n_odd: usize,
    failed: Option<FileError>,
}

impl Group {
    /// On return it holds the bins in `range`; nothing where the file cannot be read.
    fn fill(&mut self, range: Range<usize>, angles: &Angles, of_phase: &Bins, by: &By) {
        let mut binners: Vec<Binner> = range.clone().map(|_| Binner::new(by.bins)).collect();
        let request = by.request;
        let read = each_particle(request.run(), settings::lengths(request), |one| {
            let particle = Particle { position: one.position, velocity: one.velocity };
            let at = one.time.and_then(|time| angles.at(time));
            let Some((rotor, helix)) = at.filter(|_| !by.screened.is_outlier(&particle)) else {
                return;
            };
            for index in of_phase.of_instant(rotor, helix.unwrap_or(0.0)) {
                if range.contains(&index) {
                    binners[index - range.start].add(&particle);
                }
            }
        });
        self.binned.clear();
        if let Err(error) = read {
            self.failed = Some(error);
        }
        for binner in binners {
            let mut binned = binner.binned();
            self.n_odd += mask(&mut binned, by.noise);
            self.binned.push(counted(&binned));
        }
        self.range = range;
    }
}

/// Moments in which cells without a velocity have no samples.
fn counted(binned: &Binned) -> Moments {
    let mut moments = binned.moments.clone();
    for (n, order) in moments.n_samples.iter_mut().zip(&binned.order) {
        *n = if order.is_some() { *n } else { 0 };
    }
    moments
}

/// Moments of the points of `like` without a sample.
fn empty(like: &Moments) -> Moments {
    let nothing = || vec![f32::NAN; like.n_samples.len()];
    Moments {
        n_samples: vec![0; like.n_samples.len()],
        mean: std::array::from_fn(|_| nothing()),
        stress: std::array::from_fn(|_| nothing()),
    }
}
