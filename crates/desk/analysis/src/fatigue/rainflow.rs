//! Rainflow counting, sample by sample.

use crate::AnalysisError;

/// Open reversals that are kept without allocating; a load leaves a few dozen open at most.
const RESERVE: usize = 1024;

/// One counted cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycle {
    /// Range, peak to peak, in the unit of the load.
    pub range: f64,
    /// Mean of peak and valley, in the unit of the load.
    pub mean: f64,
    /// 1 for a closed cycle, 1/2 for a range that stayed open (–).
    pub count: f64,
}

/// Counts cycles sample by sample.
///
/// ASTM E1049-85 (2017), §5.4.4: the first sample, every change of direction and the last sample are
/// reversals; with X the latest range and Y the one before, Y is counted once X is no smaller, as one cycle,
/// or as one half when it holds the starting point; what is left at the end counts one half each. Equal
/// samples in a row are one.
///
/// Limits: counting allocates only once more than 1024 reversals are open together, which takes a load that
/// narrows 1024 times in a row.
///
/// ```
/// # use analysis::fatigue::Rainflow;
/// let mut ranges = Vec::new();
/// let mut rainflow = Rainflow::new();
/// for sample in [0.0, 3.0, 1.0, 2.0, -1.0] {
///     rainflow.push(sample, |cycle| ranges.push((cycle.range, cycle.count)))?;
/// }
/// rainflow.finish(|cycle| ranges.push((cycle.range, cycle.count)));
/// assert_eq!(ranges, [(1.0, 1.0), (3.0, 0.5), (4.0, 0.5)]);
/// # Ok::<(), analysis::AnalysisError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Rainflow {
    /// Reversals whose ranges are open, oldest first: each range is smaller than the one before.
    open: Vec<f64>,
    /// Latest sample, a reversal if the load turns round after it.
    latest: f64,
    /// Whether the latest sample was reached from below; none until two samples differ.
    rising: Option<bool>,
    n_samples: usize,
}

impl Default for Rainflow {
    fn default() -> Self {
        Self::new()
    }
}

impl Rainflow {
    /// A counter before the first sample.
    pub fn new() -> Self {
        Self { open: Vec::with_capacity(RESERVE), latest: 0.0, rising: None, n_samples: 0 }
    }

    /// Samples taken so far (–).
    pub fn n_samples(&self) -> usize {
        self.n_samples
    }

    /// Takes one sample; `counted` is given each cycle that closes with it.
    ///
    /// # Errors
    /// [`AnalysisError::NotFinite`] with the sample's index; the counter is as before.
    #[inline]
    pub fn push(&mut self, sample: f64, counted: impl FnMut(Cycle)) -> Result<(), AnalysisError> {
        self.extend(&[sample], counted)
    }

    /// Takes the samples of `load` in turn; `counted` is given each cycle that closes with them.
    ///
    /// # Errors
    /// [`AnalysisError::NotFinite`] with the sample's index, counted from the first sample ever; on return
    /// the counter has taken the samples before it.
    #[inline]
    pub fn extend(
        &mut self,
        load: &[f64],
        mut counted: impl FnMut(Cycle),
    ) -> Result<(), AnalysisError> {
        let n_before = self.n_samples;
        let mut samples = load.iter();
        while self.rising.is_none() {
            let Some(&sample) = samples.next() else { return Ok(()) };
            if !sample.is_finite() {
                return Err(AnalysisError::NotFinite { index: self.n_samples });
            }
            if self.n_samples == 0 {
                self.open.push(sample);
            } else if sample != self.latest {
                self.rising = Some(sample > self.latest);
            }
            self.latest = sample;
            self.n_samples += 1;
        }
        let (mut latest, mut rising) = (self.latest, self.rising == Some(true));
        let mut not_finite = None;
        for (index, &sample) in samples.as_slice().iter().enumerate() {
            if !sample.is_finite() {
                not_finite = Some(self.n_samples + index);
                break;
            }
            if if rising { sample < latest } else { sample > latest } {
                close(&mut self.open, latest, &mut counted);
                rising = !rising;
            }
            latest = sample;
        }
        (self.latest, self.rising) = (latest, Some(rising));
        self.n_samples = not_finite.unwrap_or(n_before + load.len());
        not_finite.map_or(Ok(()), |index| Err(AnalysisError::NotFinite { index }))
    }

    /// Ends the count: the latest sample is a reversal, and `counted` is given what closes with it, then
    /// every range that is still open, oldest first, as one half.
    pub fn finish(mut self, mut counted: impl FnMut(Cycle)) {
        if self.rising.is_some() {
            close(&mut self.open, self.latest, &mut counted);
        }
        for pair in self.open.windows(2) {
            counted(Cycle::between(pair[0], pair[1], 0.5));
        }
    }
}

impl Cycle {
    fn between(one: f64, other: f64, count: f64) -> Self {
        Self { range: (one - other).abs(), mean: 0.5 * (one + other), count }
    }
}

/// Adds `reversal` to the `open` ones, after counting the ranges that close with it.
#[inline]
fn close(open: &mut Vec<f64>, reversal: f64, counted: &mut impl FnMut(Cycle)) {
    while let [.., before, last] = open[..] {
        if (reversal - last).abs() < (last - before).abs() {
            break;
        }
        if open.len() == 2 {
            counted(Cycle::between(before, last, 0.5));
            open[0] = last;
            open.truncate(1);
        } else {
            counted(Cycle::between(before, last, 1.0));
            open.truncate(open.len() - 2);
        }
    }
    open.push(reversal);
}

/// All cycles of `load` (any unit), in the order in which they close.
///
/// # Errors
/// [`AnalysisError::NotFinite`] with the sample's index.
pub fn cycles(load: &[f64]) -> Result<Vec<Cycle>, AnalysisError> {
    let mut cycles = Vec::new();
    let mut rainflow = Rainflow::new();
    rainflow.extend(load, |cycle| cycles.push(cycle))?;
    rainflow.finish(|cycle| cycles.push(cycle));
    Ok(cycles)
}
