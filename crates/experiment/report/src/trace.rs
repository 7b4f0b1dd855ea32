//! Signals made ready to be drawn: smoothed, thinned.

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
}
