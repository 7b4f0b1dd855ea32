//! Damage-equivalent loads of one channel.

use super::{Cycle, Damage, REFERENCE_FREQUENCY, Rainflow};
use crate::AnalysisError;

/// The equivalent load for one slope.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EquivalentLoad {
    /// Wöhler's exponent m (–).
    pub slope: f64,
    /// Range, peak to peak, in the unit of the load.
    pub load: f64,
}

/// Fatigue loads of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Fatigue {
    /// From the first sample to the last (s).
    pub duration: f64,
    /// Cycles, an open range counting one half (–).
    pub n_cycles: f64,
    /// Largest range, peak to peak, in the unit of the load.
    pub largest_range: f64,
    /// 1-Hz damage-equivalent loads, one per slope, in the order of the slopes given.
    pub loads: Vec<EquivalentLoad>,
}

/// Accumulates the damage of one channel, sample by sample.
///
/// Memory does not grow with the record; see [`Rainflow`] for how cycles are counted and [the module](super)
/// for the convention.
#[derive(Clone, Debug)]
pub struct LoadCounter {
    rainflow: Rainflow,
    tally: Tally,
}

#[derive(Clone, Debug)]
struct Tally {
    damages: Vec<Damage>,
    n_cycles: f64,
    largest_range: f64,
}

impl Tally {
    #[inline]
    fn add(&mut self, cycle: Cycle) {
        self.n_cycles += cycle.count;
        self.largest_range = self.largest_range.max(cycle.range);
        for damage in &mut self.damages {
            damage.add(cycle.range, cycle.count);
        }
    }
}

impl LoadCounter {
    /// A counter before the first sample, for the slopes `slopes` (–).
    ///
    /// # Errors
    /// [`AnalysisError::Slope`].
    pub fn new(slopes: &[f64]) -> Result<Self, AnalysisError> {
        let damages = slopes.iter().map(|slope| Damage::new(*slope)).collect::<Result<_, _>>()?;
        let tally = Tally { damages, n_cycles: 0.0, largest_range: 0.0 };
        Ok(Self { rainflow: Rainflow::new(), tally })
    }

    /// Takes one sample (any unit).
    ///
    /// # Errors
    /// [`AnalysisError::NotFinite`] with the sample's index; the counter is as before.
    #[inline]
    pub fn push(&mut self, sample: f64) -> Result<(), AnalysisError> {
        self.extend(&[sample])
    }

    /// Takes the samples of `load` (any unit) in turn.
    ///
    /// # Errors
    /// [`AnalysisError::NotFinite`] with the sample's index, counted from the first sample ever.
    pub fn extend(&mut self, load: &[f64]) -> Result<(), AnalysisError> {
        let tally = &mut self.tally;
        self.rainflow.extend(load, |cycle| tally.add(cycle))
    }

    /// Samples taken so far (–).
    pub fn n_samples(&self) -> usize {
        self.rainflow.n_samples()
    }

    /// Ends the count of a record that took `duration` (s) from its first sample to its last.
    ///
    /// # Errors
    /// [`AnalysisError::TooShort`] for fewer than two samples, [`AnalysisError::NotPositive`] for the
    /// duration.
    pub fn finish(self, duration: f64) -> Result<Fatigue, AnalysisError> {
        let n_samples = self.n_samples();
        if n_samples < 2 {
            return Err(AnalysisError::TooShort { n_samples, needed: 2 });
        }
        check_duration(duration)?;
        let mut tally = self.tally;
        self.rainflow.finish(|cycle| tally.add(cycle));
        let n_equivalent = REFERENCE_FREQUENCY * duration;
        let equivalent = |damage: &Damage| EquivalentLoad {
            slope: damage.slope(),
            load: damage.equivalent_load(n_equivalent),
        };
        let loads = tally.damages.iter().map(equivalent).collect();
        let Tally { n_cycles, largest_range, .. } = tally;
        Ok(Fatigue { duration, n_cycles, largest_range, loads })
    }
}

/// Refuses a duration (s) that is not positive.
pub(super) fn check_duration(duration: f64) -> Result<(), AnalysisError> {
    if !duration.is_finite() || duration <= 0.0 {
        return Err(AnalysisError::NotPositive { quantity: "the duration", value: duration });
    }
    Ok(())
}

/// Damage-equivalent load of one signal.
///
/// `load` (any unit) is sampled every `interval` (s); `slope` (–) is Wöhler's exponent m. Gives the range,
/// peak to peak in the unit of `load`, that does the same damage when it repeats at `reference_frequency`
/// (Hz) over the record. Convention: see [the module](super).
///
/// Source: ASTM E1049-85 (2017), §5.4.4, for the count; van der Hoek et al., Eq. 8 (see [the module](super)),
/// for the load.
///
/// # Errors
/// [`AnalysisError::TooShort`] for fewer than two samples, [`AnalysisError::NotPositive`] for the interval or
/// frequency, [`AnalysisError::Slope`], [`AnalysisError::NotFinite`].
///
/// ```
/// # use analysis::fatigue::damage_equivalent_load;
/// // A wave of amplitude 1 is its own equivalent load, range 2.
/// let wave: Vec<f64> = (0..=6000).map(|i| (std::f64::consts::TAU * 0.01 * f64::from(i)).cos()).collect();
/// let load = damage_equivalent_load(&wave, 0.1, 10.0, 0.1)?;
/// assert!((load - 2.0).abs() < 1e-12);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
pub fn damage_equivalent_load(
    load: &[f64],
    interval: f64,
    slope: f64,
    reference_frequency: f64,
) -> Result<f64, AnalysisError> {
    let mut counter = LoadCounter::new(&[slope])?;
    counter.extend(load)?;
    let duration = load.len().saturating_sub(1) as f64 * interval;
    check_duration(reference_frequency)?;
    let at_one_hertz = counter.finish(duration)?.loads[0].load;
    Ok(at_one_hertz * (REFERENCE_FREQUENCY / reference_frequency).powf(1.0 / slope))
}
