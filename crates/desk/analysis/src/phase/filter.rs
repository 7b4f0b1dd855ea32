//! One narrow band of a record: its wave, amplitude and angle at every instant, without delay.

use crate::{AnalysisError, statistics::mean};
use realfft::RealFftPlanner;
use realfft::num_complex::Complex64;

/// Band that a filter lets through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Lower half-amplitude frequency (Hz).
    pub low: f64,
    /// Upper half-amplitude frequency (Hz).
    pub high: f64,
}

impl Band {
    /// Ratio of edge to centre in [`Band::around`] unless another is given (–).
    pub const RATIO: f64 = 1.5;

    /// From `frequency` / `ratio` to `frequency` · `ratio` (Hz; `ratio` > 1): passes `frequency` itself
    /// unchanged.
    pub fn around(frequency: f64, ratio: f64) -> Self {
        Self { low: frequency / ratio, high: frequency * ratio }
    }

    /// Upper edge of the band of van Vondelen et al. (2025), Algorithm 2 (Hz); their lower edge is not told.
    pub const PUBLISHED_HIGH: f64 = 0.15;

    /// The published band about `frequency` (Hz): up to [`Band::PUBLISHED_HIGH`], from where
    /// [`Band::around`] with [`Band::RATIO`] begins. None where that holds no `frequency`.
    pub fn published(frequency: f64) -> Option<Self> {
        let low = frequency / Self::RATIO;
        (frequency < Self::PUBLISHED_HIGH).then_some(Self { low, high: Self::PUBLISHED_HIGH })
    }

    /// Time (s) over which the filter remembers an end of the record: this far inside, what an end does to
    /// the phase of a lone wave is below a twentieth of a radian, and falls about tenfold over each further
    /// stretch of this length.
    pub fn memory(&self) -> f64 {
        1.5 / (self.high - self.low)
    }

    /// Share of the amplitude at `frequency` (Hz) that passes (–).
    fn response(&self, frequency: f64) -> f64 {
        if frequency <= 0.0 {
            return 0.0;
        }
        let offset =
            (frequency * frequency - self.low * self.high) / (frequency * (self.high - self.low));
        1.0 / (1.0 + offset.powi(4))
    }
}

/// A band of a record, a (t) cos θ (t) at every sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Narrowband {
    /// The filtered record (unit of the record).
    pub wave: Vec<f64>,
    /// Amplitude a (unit of the record).
    pub amplitude: Vec<f64>,
    /// Angle θ (rad, [−π, π]).
    pub angle: Vec<f64>,
}

/// What `samples` (any unit, every `interval` s) do within `band`.
///
/// The band-pass has the amplitude response 1/(1 + q⁴), q = (f² − f₁f₂)/(f (f₂ − f₁)), and no phase: a
/// second-order Butterworth band-pass run forwards and backwards, without the warping of a recursive filter.
/// Amplitude and angle are those of the analytic signal, the wave plus i times its Hilbert transform. Beyond
/// its ends the record is continued by its reflection through the end point, which fades out over four times
/// [`Band::memory`]; what lies closer to an end than that memory owes more to the continuation than to the
/// record.
///
/// Source: Oppenheim and Schafer, "Discrete-Time Signal Processing", 3rd ed., 2010, §12.4 (Hilbert
/// transform).
///
/// # Errors
/// [`AnalysisError::NotPositive`] for the interval; [`AnalysisError::Band`] unless 0 < low < high;
/// [`AnalysisError::AboveNyquist`] when its upper end cannot be sampled; [`AnalysisError::TooShort`] for a
/// record shorter than twice the filter's memory; [`AnalysisError::NotFinite`] for a gap.
pub fn narrowband(samples: &[f64], interval: f64, band: Band) -> Result<Narrowband, AnalysisError> {
    check(samples, interval, band)?;
    let n_samples = samples.len();
    let mean = mean(samples);
    let fade = (4.0 * band.memory() / interval).ceil() as usize;
    let n_beyond = fade.min(n_samples - 1);
    let n_all = (n_samples + 2 * n_beyond).next_multiple_of(64);
    let (first, last) = (samples[0] - mean, samples[n_samples - 1] - mean);
    let mut planner = RealFftPlanner::<f64>::new();
    let (forward, inverse) = (planner.plan_fft_forward(n_all), planner.plan_fft_inverse(n_all));
    let mut record = forward.make_input_vec();
    for (place, sample) in record[n_beyond..].iter_mut().zip(samples) {
        *place = sample - mean;
    }
    for distance in 1..=n_beyond {
        let turn = std::f64::consts::PI * distance as f64 / (n_beyond + 1) as f64;
        let weight = 0.5 + 0.5 * turn.cos();
        record[n_beyond - distance] = weight * (2.0 * first - (samples[distance] - mean));
        record[n_beyond + n_samples - 1 + distance] =
            weight * (2.0 * last - (samples[n_samples - 1 - distance] - mean));
    }
    let mut spectrum = forward.make_output_vec();
    let lengths = "input and output have the lengths that the plan asks for";
    forward.process(&mut record, &mut spectrum).expect(lengths);
    let step = 1.0 / (n_all as f64 * interval);
    for (index, value) in spectrum.iter_mut().enumerate() {
        *value *= band.response(index as f64 * step) / n_all as f64;
    }
    // Neither zero nor the highest frequency has a quadrature part; the inverse transform insists on it.
    *spectrum.last_mut().expect("a spectrum has values") = Complex64::default();
    let mut quadrature: Vec<Complex64> =
        spectrum.iter().map(|value| Complex64::new(value.im, -value.re)).collect();
    let mut hilbert = inverse.make_output_vec();
    inverse.process(&mut quadrature, &mut hilbert).expect(lengths);
    inverse.process(&mut spectrum, &mut record).expect(lengths);
    let kept = n_beyond..n_beyond + n_samples;
    let pairs = || record[kept.clone()].iter().zip(&hilbert[kept.clone()]);
    Ok(Narrowband {
        wave: record[kept.clone()].to_vec(),
        amplitude: pairs().map(|(x, y)| x.hypot(*y)).collect(),
        angle: pairs().map(|(x, y)| y.atan2(*x)).collect(),
    })
}

fn check(samples: &[f64], interval: f64, band: Band) -> Result<(), AnalysisError> {
    if interval.is_nan() || interval <= 0.0 {
        let quantity = "the sampling interval";
        return Err(AnalysisError::NotPositive { quantity, value: interval });
    }
    if !(band.low > 0.0 && band.high > band.low) {
        return Err(AnalysisError::Band { low: band.low, high: band.high });
    }
    let nyquist = 0.5 / interval;
    if band.high >= nyquist {
        return Err(AnalysisError::AboveNyquist { frequency: band.high, nyquist });
    }
    let needed = (2.0 * band.memory() / interval).ceil() as usize;
    if samples.len() < needed.max(2) {
        return Err(AnalysisError::TooShort { n_samples: samples.len(), needed: needed.max(2) });
    }
    match samples.iter().position(|sample| !sample.is_finite()) {
        Some(index) => Err(AnalysisError::NotFinite { index }),
        None => Ok(()),
    }
}
