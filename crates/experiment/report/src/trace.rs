//! Signals made ready to be drawn: smoothed, thinned, as a spectrum.

use std::f64::consts::TAU;

/// Centred moving mean of `samples` over `window` samples; shorter at the ends.
pub(crate) fn moving_mean(samples: &[f64], window: usize) -> Vec<f64> {
    let half = window / 2;
    let mut sums = Vec::with_capacity(samples.len() + 1);
    sums.push(0.0);
    let mut sum = 0.0;
    for sample in samples {
        sum += sample;
        sums.push(sum);
    }
    (0..samples.len())
        .map(|index| {
            let first = index.saturating_sub(half);
            let last = (index + half + 1).min(samples.len());
            (sums[last] - sums[first]) / (last - first) as f64
        })
        .collect()
}

/// Points of the line through `times` and `values`, thinned to at most two in each of `n_buckets`
/// equal stretches, smallest and largest, so that no peak is lost.
pub(crate) fn envelope(times: &[f64], values: &[f64], n_buckets: usize) -> Vec<[f64; 2]> {
    let n_samples = times.len().min(values.len());
    if n_samples <= 2 * n_buckets {
        return times.iter().zip(values).map(|(&time, &value)| [time, value]).collect();
    }
    let mut points = Vec::with_capacity(2 * n_buckets);
    for bucket in 0..n_buckets {
        let first = bucket * n_samples / n_buckets;
        let last = (bucket + 1) * n_samples / n_buckets;
        let (mut lowest, mut highest) = (first, first);
        for index in first..last {
            if values[index] < values[lowest] {
                lowest = index;
            }
            if values[index] > values[highest] {
                highest = index;
            }
        }
        let (early, late) = (lowest.min(highest), lowest.max(highest));
        points.push([times[early], values[early]]);
        if late != early {
            points.push([times[late], values[late]]);
        }
    }
    points
}

/// Every so many samples of a line, so that about `n_points` remain, the last one among them.
pub(crate) fn thinned(times: &[f64], values: &[f64], n_points: usize) -> Vec<[f64; 2]> {
    let n_samples = times.len().min(values.len());
    let stride = n_samples.div_ceil(n_points.max(1)).max(1);
    let mut points: Vec<[f64; 2]> =
        (0..n_samples).step_by(stride).map(|index| [times[index], values[index]]).collect();
    if n_samples > 0 && !(n_samples - 1).is_multiple_of(stride) {
        points.push([times[n_samples - 1], values[n_samples - 1]]);
    }
    points
}

/// Amplitudes of the lines of a signal: pairs of frequency (Hz) and amplitude (unit of `samples`).
///
/// `samples` are `interval` (s) apart; frequencies reach up to `highest_frequency` (Hz), spaced by
/// a quarter of the record's resolution. A Hann window keeps lines from leaking into each other; a
/// sinusoid of amplitude a shows a peak of a (at worst 1 % less, halfway between two bins).
/// Empty for records shorter than four samples.
pub(crate) fn amplitude_spectrum(
    samples: &[f64],
    interval: f64,
    highest_frequency: f64,
) -> Vec<[f64; 2]> {
    // Block means lower the sampling rate to at least eight times the highest frequency.
    let stride = (1.0 / (8.0 * highest_frequency * interval)).floor().max(1.0) as usize;
    let blocks: Vec<f64> = samples
        .chunks_exact(stride)
        .map(|block| block.iter().sum::<f64>() / stride as f64)
        .collect();
    let n_blocks = blocks.len();
    if n_blocks < 4 || !(highest_frequency > 0.0 && interval > 0.0) {
        return Vec::new();
    }
    let block_interval = interval * stride as f64;
    let window = |index: usize| 0.5 * (1.0 - (TAU * index as f64 / n_blocks as f64).cos());
    // Weighted like this, the mean leaves nothing at zero frequency to leak from.
    let weighted: f64 = (0..n_blocks).map(|index| window(index) * blocks[index]).sum();
    let mean = weighted / (0.5 * n_blocks as f64);
    let windowed: Vec<f64> =
        (0..n_blocks).map(|index| window(index) * (blocks[index] - mean)).collect();
    let spacing = 0.25 / (n_blocks as f64 * block_interval);
    let n_frequencies = ((highest_frequency / spacing) as usize).min(2 * n_blocks);
    (1..=n_frequencies)
        .map(|index| {
            let frequency = index as f64 * spacing;
            let (step_sine, step_cosine) = (TAU * frequency * block_interval).sin_cos();
            let (mut cosine, mut sine) = (1.0, 0.0);
            let (mut real, mut imaginary) = (0.0, 0.0);
            for value in &windowed {
                real += value * cosine;
                imaginary += value * sine;
                (cosine, sine) = (
                    cosine * step_cosine - sine * step_sine,
                    sine * step_cosine + cosine * step_sine,
                );
            }
            // The window's mean is one half, a line has two sides; the blocks' mean damps as sinc.
            let angle = 0.5 * TAU * frequency * interval;
            let damping = (angle * stride as f64).sin() / (angle.sin() * stride as f64);
            [frequency, 4.0 * real.hypot(imaginary) / (n_blocks as f64 * damping)]
        })
        .collect()
}

/// The largest line of each of `n_buckets` stretches of a spectrum, so that no line is lost.
pub(crate) fn peaks(spectrum: &[[f64; 2]], n_buckets: usize) -> Vec<[f64; 2]> {
    let length = spectrum.len().div_ceil(n_buckets.max(1)).max(1);
    spectrum
        .chunks(length)
        .filter_map(|stretch| stretch.iter().max_by(|a, b| a[1].total_cmp(&b[1])).copied())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moving_mean_keeps_constants_and_slopes() {
        let slope: Vec<f64> = (0..100).map(|index| 2.0 * f64::from(index)).collect();
        let smooth = moving_mean(&slope, 11);
        assert!((5..95).all(|index| (smooth[index] - slope[index]).abs() < 1e-12));
        assert!(moving_mean(&[3.0; 7], 4).iter().all(|value| (value - 3.0).abs() < 1e-15));
        assert!(moving_mean(&[], 4).is_empty());
    }

    #[test]
    fn an_envelope_keeps_the_peaks_and_the_order() {
        let times: Vec<f64> = (0..1000).map(f64::from).collect();
        let mut values = vec![0.0; 1000];
        values[333] = 9.0;
        values[777] = -4.0;
        let points = envelope(&times, &values, 20);
        assert!(points.len() <= 40);
        assert!(points.contains(&[333.0, 9.0]) && points.contains(&[777.0, -4.0]));
        assert!(points.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        assert_eq!(thinned(&times, &values, 10).last(), Some(&[999.0, 0.0]));
    }

    #[test]
    fn the_spectrum_of_a_sinusoid_is_its_amplitude_at_its_frequency() {
        let (interval, frequency, amplitude) = (0.1, 0.137, 4.0);
        for duration in [600.0, 1234.5] {
            let n_samples = (duration / interval) as usize;
            let samples: Vec<f64> = (0..n_samples)
                .map(|index| 7.0 + amplitude * (TAU * frequency * interval * index as f64).sin())
                .collect();
            let spectrum = amplitude_spectrum(&samples, interval, 0.4);
            let peak = spectrum.iter().max_by(|a, b| a[1].total_cmp(&b[1])).expect("bins");
            assert!((peak[0] - frequency).abs() < 0.5 / duration, "{peak:?}");
            assert!((peak[1] - amplitude).abs() < 0.02 * amplitude, "{peak:?}");
            let far = spectrum.iter().filter(|line| (line[0] - frequency).abs() > 0.05);
            assert!(far.map(|line| line[1]).fold(0.0, f64::max) < 2e-3 * amplitude);
        }
        assert!(amplitude_spectrum(&[1.0, 2.0], 0.1, 0.4).is_empty());
    }
}
