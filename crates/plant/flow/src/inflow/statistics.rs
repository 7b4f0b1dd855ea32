//! A box in a few numbers.

use super::TurbulenceBox;
use super::spectra::{OnePointSpectra, divergence_residual, one_point};
use serde::{Deserialize, Serialize};

/// What is to be known of a box before it is used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoxStatistics {
    /// Means of u, v, w (m/s).
    pub means: [f64; 3],
    /// Standard deviations of u, v, w over the box (m/s).
    pub standard_deviations: [f64; 3],
    /// Mean product of u and w (m²/s²).
    pub shear_stress: f64,
    /// Integral length scales of u, v, w along x (m); see [`integral_scale`].
    pub integral_scales: [f64; 3],
    /// Divergence in Fourier space (–); see [`divergence_residual`].
    pub divergence_residual: f64,
}

/// The statistics of `turbulence`.
pub fn statistics(turbulence: &TurbulenceBox) -> BoxStatistics {
    let spectra = one_point(turbulence);
    BoxStatistics {
        means: turbulence.means(),
        standard_deviations: turbulence.standard_deviations(),
        shear_stress: turbulence.shear_stress(),
        integral_scales: [0, 1, 2].map(|component| integral_scale(&spectra, component)),
        divergence_residual: divergence_residual(turbulence),
    }
}

/// Standard deviations of u, v, w (m/s) along the line of points with indices `y`, `z`: those of the wind
/// that a fixed place meets.
pub fn line_deviations(turbulence: &TurbulenceBox, y: usize, z: usize) -> [f64; 3] {
    let n_x = turbulence.n_points()[0];
    [0, 1, 2].map(|component| {
        let value = |x: usize| f64::from(turbulence.at(component, [x, y, z]));
        let mean = (0..n_x).map(value).sum::<f64>() / n_x as f64;
        ((0..n_x).map(|x| (value(x) - mean).powi(2)).sum::<f64>() / n_x as f64).sqrt()
    })
}

/// Integral length scale along x of component 0 to 2 (m): ∫ of the correlation coefficient up to its first
/// zero.
///
/// The correlation is that of the box less the mean of each line, which is what spectra at k₁ > 0 hold; zero
/// for a component that is still.
pub fn integral_scale(spectra: &OnePointSpectra, component: usize) -> f64 {
    let power = &spectra.power[component];
    let correlation = |distance: f64| -> f64 {
        power.iter().zip(&spectra.wave_numbers).map(|(power, k)| power * (k * distance).cos()).sum()
    };
    let variance = correlation(0.0);
    let (Some(first), Some(last)) = (spectra.wave_numbers.first(), spectra.wave_numbers.last())
    else {
        return 0.0;
    };
    if variance <= 0.0 {
        return 0.0;
    }
    // Trapezes of half a grid spacing; half a box is the farthest that a periodic box knows.
    let step = 0.5 * std::f64::consts::PI / last;
    let n_steps = (std::f64::consts::PI / first / step) as usize;
    let (mut sum, mut previous) = (0.0, 1.0);
    for index in 1..=n_steps {
        let next = correlation(index as f64 * step) / variance;
        if next <= 0.0 {
            // The part of the last trapeze above zero.
            return sum + 0.5 * step * previous * previous / (previous - next);
        }
        sum += 0.5 * step * (previous + next);
        previous = next;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line spectrum: the correlation is a cosine, whose integral to its zero is 1/k.
    #[test]
    fn of_a_single_wave_is_known() {
        let n = 400;
        let wave_numbers: Vec<f64> = (1..n).map(|index| 0.001 * f64::from(index)).collect();
        let mut power = vec![0.0; wave_numbers.len()];
        power[19] = 3.0;
        let spectra = OnePointSpectra {
            wave_numbers,
            shear: Vec::new(),
            power: [power.clone(), power.clone(), vec![0.0; 399]],
        };
        assert!((integral_scale(&spectra, 0) * 0.02 - 1.0).abs() < 1e-3);
        assert_eq!(integral_scale(&spectra, 2), 0.0);
    }

    /// F = 1/(1 + (k l)²) has the correlation exp(−r/l) and the integral scale l.
    #[test]
    fn of_an_exponential_correlation_is_its_length() {
        let wave_numbers: Vec<f64> = (1..20_000).map(|index| 2e-5 * f64::from(index)).collect();
        let length: f64 = 80.0;
        let power: Vec<f64> =
            wave_numbers.iter().map(|k| 1.0 / (1.0 + (k * length).powi(2))).collect();
        let spectra = OnePointSpectra {
            wave_numbers,
            shear: Vec::new(),
            power: std::array::from_fn(|_| power.clone()),
        };
        // The lines leave out k₁ = 0, and the record of waves ends at a finite number.
        assert!((integral_scale(&spectra, 1) / length - 1.0).abs() < 0.05);
    }
}
