//! Spectra of a box along the wind, and how free of divergence it is.

use super::TurbulenceBox;
use basis::Vector3;
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::{Complex32, Complex64};
use std::f64::consts::TAU;

/// One-point spectra of a box along x, two-sided: ∫ over all k₁ is the variance.
#[derive(Clone, Debug, PartialEq)]
pub struct OnePointSpectra {
    /// Wave numbers k₁ > 0 (rad/m), Nyquist excluded.
    pub wave_numbers: Vec<f64>,
    /// F₁₁, F₂₂, F₃₃ (m³/s²) at each wave number.
    pub power: [Vec<f64>; 3],
    /// Real part of F₁₃ (m³/s²) at each wave number.
    pub shear: Vec<f64>,
}

/// One-point spectra of `turbulence`, averaged over all lines along x.
pub fn one_point(turbulence: &TurbulenceBox) -> OnePointSpectra {
    let mut spectra = OnePointSpectra {
        wave_numbers: wave_numbers(turbulence),
        power: Default::default(),
        shear: vec![0.0; turbulence.n_points()[0].div_ceil(2) - 1],
    };
    for power in &mut spectra.power {
        power.resize(spectra.shear.len(), 0.0);
    }
    let [_, n_y, n_z] = turbulence.n_points();
    let scale = turbulence.lengths()[0] / TAU / (n_y * n_z) as f64;
    let mut lines = Lines::new(turbulence);
    let mut transforms: [Vec<Complex64>; 3] = Default::default();
    for z in 0..n_z {
        for y in 0..n_y {
            for (component, transform) in transforms.iter_mut().enumerate() {
                lines.transform(component, y, z, transform);
                for (sum, value) in spectra.power[component].iter_mut().zip(transform.iter()) {
                    *sum += scale * value.norm_sqr();
                }
            }
            for ((sum, u), w) in spectra.shear.iter_mut().zip(&transforms[0]).zip(&transforms[2]) {
                *sum += scale * (u * w.conj()).re;
            }
        }
    }
    spectra
}

/// Cross-spectrum of component `component` with itself at points `apart` (points along y, z), two-sided
/// (m³/s²), at the wave numbers of [`one_point`], averaged over the box. Positive lags lead to the left and
/// up.
pub fn cross(turbulence: &TurbulenceBox, component: usize, apart: [usize; 2]) -> Vec<Complex64> {
    let [n_x, n_y, n_z] = turbulence.n_points();
    let n_waves = n_x.div_ceil(2) - 1;
    let transforms = lines(turbulence, component);
    let scale = turbulence.lengths()[0] / TAU / (n_y * n_z) as f64;
    let mut spectrum = vec![Complex64::default(); n_waves];
    for z in 0..n_z {
        for y in 0..n_y {
            let here = &transforms[z * n_y + y];
            let there = &transforms[(z + apart[1]) % n_z * n_y + (y + apart[0]) % n_y];
            for ((sum, here), there) in spectrum.iter_mut().zip(here).zip(there) {
                *sum += scale * here.conj() * there;
            }
        }
    }
    spectrum
}

/// Fourier coefficients (m/s) of component `component` along x at the wave numbers of [`one_point`], for
/// every line: n_z × n_y, y fastest.
pub fn lines(turbulence: &TurbulenceBox, component: usize) -> Vec<Vec<Complex64>> {
    let [_, n_y, n_z] = turbulence.n_points();
    let mut lines = Lines::new(turbulence);
    let mut transforms = vec![Vec::new(); n_y * n_z];
    for (line, transform) in transforms.iter_mut().enumerate() {
        lines.transform(component, line % n_y, line / n_y, transform);
    }
    transforms
}

fn wave_numbers(turbulence: &TurbulenceBox) -> Vec<f64> {
    let step = TAU / turbulence.lengths()[0];
    (1..turbulence.n_points()[0].div_ceil(2)).map(|index| index as f64 * step).collect()
}

/// Fourier coefficients of lines along x, for k₁ > 0.
struct Lines<'a> {
    turbulence: &'a TurbulenceBox,
    transform: std::sync::Arc<dyn realfft::RealToComplex<f64>>,
    line: Vec<f64>,
    waves: Vec<Complex64>,
}

impl<'a> Lines<'a> {
    fn new(turbulence: &'a TurbulenceBox) -> Self {
        let n_x = turbulence.n_points()[0];
        let transform = RealFftPlanner::new().plan_fft_forward(n_x);
        let waves = transform.make_output_vec();
        Self { turbulence, transform, line: vec![0.0; n_x], waves }
    }

    /// On return `coefficients` holds (1/n) Σ u exp(−i k₁ x) for k₁ > 0 below the Nyquist number.
    fn transform(
        &mut self,
        component: usize,
        y: usize,
        z: usize,
        coefficients: &mut Vec<Complex64>,
    ) {
        let n_x = self.line.len();
        for (x, value) in self.line.iter_mut().enumerate() {
            *value = f64::from(self.turbulence.at(component, [x, y, z]));
        }
        if self.transform.process(&mut self.line, &mut self.waves).is_err() {
            unreachable!("lengths are the transform's own");
        }
        coefficients.clear();
        let scale = 1.0 / n_x as f64;
        coefficients.extend(self.waves[1..n_x.div_ceil(2)].iter().map(|wave| wave * scale));
    }
}

/// Divergence of a box in Fourier space: (Σ |k·û|² / Σ |k|² |û|²)^(1/2) (–), 0 for none, 1/√3 for noise.
///
/// Waves at Nyquist numbers, whose sense is ambiguous, are left out. Needs three times the box's memory.
pub fn divergence_residual(turbulence: &TurbulenceBox) -> f64 {
    let [n_x, n_y, n_z] = turbulence.n_points();
    let spectra = [0, 1, 2].map(|component| transform(turbulence, component));
    let lengths = turbulence.lengths();
    let wave = |index: usize, n: usize, length: f64| {
        let signed = if 2 * index > n { index as f64 - n as f64 } else { index as f64 };
        (2 * index != n).then_some(TAU * signed / length)
    };
    let (mut along, mut all) = (0.0, 0.0);
    for x in 0..n_x {
        let Some(k1) = wave(x, n_x, lengths[0]) else { continue };
        for z in 0..n_z {
            let Some(k3) = wave(z, n_z, lengths[2]) else { continue };
            for y in 0..n_y {
                let Some(k2) = wave(y, n_y, lengths[1]) else { continue };
                let place = (x * n_z + z) * n_y + y;
                let k = Vector3::new(k1, k2, k3);
                let part = |of: fn(&Complex32) -> f32| {
                    Vector3::from_array(
                        [0, 1, 2].map(|axis: usize| f64::from(of(&spectra[axis][place]))),
                    )
                };
                let (re, im) = (part(|value| value.re), part(|value| value.im));
                along += k.dot(re).powi(2) + k.dot(im).powi(2);
                all += k.length_squared() * (re.length_squared() + im.length_squared());
            }
        }
    }
    if all > 0.0 { (along / all).sqrt() } else { 0.0 }
}

/// Fourier transform of one component over all three directions, n_x × n_z × n_y.
fn transform(turbulence: &TurbulenceBox, component: usize) -> Vec<Complex32> {
    let [n_x, n_y, n_z] = turbulence.n_points();
    let mut planner = FftPlanner::new();
    let mut values: Vec<Complex32> =
        turbulence.component(component).iter().map(|value| Complex32::new(*value, 0.0)).collect();
    planner.plan_fft_forward(n_y).process(&mut values);
    strided(&mut values, n_y, n_z, planner.plan_fft_forward(n_z).as_ref());
    strided(&mut values, n_y * n_z, n_x, planner.plan_fft_forward(n_x).as_ref());
    values
}

/// Transforms `values` along the axis of `n` points whose neighbours lie `stride` apart.
fn strided(values: &mut [Complex32], stride: usize, n: usize, transform: &dyn rustfft::Fft<f32>) {
    /// Columns gathered at a time.
    const BLOCK: usize = 32;
    let mut gathered = vec![Complex32::default(); BLOCK.min(stride) * n];
    let mut scratch = vec![Complex32::default(); transform.get_inplace_scratch_len()];
    for slab in values.chunks_mut(stride * n) {
        for start in (0..stride).step_by(BLOCK) {
            let block = BLOCK.min(stride - start);
            for index in 0..n {
                for column in 0..block {
                    gathered[column * n + index] = slab[index * stride + start + column];
                }
            }
            transform.process_with_scratch(&mut gathered[..block * n], &mut scratch);
            for index in 0..n {
                for column in 0..block {
                    slab[index * stride + start + column] = gathered[column * n + index];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u = sin(k x + l y), v = −(k/l) sin(k x + l y) has no divergence; w adds none of its own.
    fn wave(divergent: bool) -> TurbulenceBox {
        let n_points = [16, 8, 6];
        let [k, l] = [TAU * 2.0 / 32.0, TAU / 24.0];
        let mut velocity: [Vec<f32>; 3] = Default::default();
        for x in 0..16 {
            for _ in 0..6 {
                for y in 0..8 {
                    let value = (k * 2.0 * f64::from(x) + l * 3.0 * f64::from(y)).sin();
                    velocity[0].push(value as f32);
                    velocity[1].push((-(k / l) * value) as f32);
                    velocity[2].push(if divergent { 0.0 } else { value as f32 });
                }
            }
        }
        if divergent {
            velocity[1].fill(0.0);
        }
        TurbulenceBox::new(n_points, [2.0, 3.0, 4.0], velocity).unwrap()
    }

    #[test]
    fn divergence_is_found_and_its_absence_too() {
        assert!(divergence_residual(&wave(false)) < 1e-6);
        // Along x alone, of a wave at this angle: k / √(k² + l²).
        let [k, l] = [TAU * 2.0 / 32.0, TAU / 24.0];
        assert!((divergence_residual(&wave(true)) - k / k.hypot(l)).abs() < 1e-6);
    }

    #[test]
    fn a_wave_has_its_variance_in_one_line() {
        let spectra = one_point(&wave(false));
        let step = spectra.wave_numbers[0];
        assert!((2.0 * spectra.power[0][1] * step - 0.5).abs() < 1e-6);
        assert!(spectra.power[0].iter().sum::<f64>() - spectra.power[0][1] < 1e-10);
        assert!((spectra.shear[1] - spectra.power[0][1]).abs() < 1e-6);
    }

    /// Neighbours three metres to the left are ahead in phase by l · 3 m.
    #[test]
    fn the_cross_spectrum_carries_the_phase() {
        let spectrum = cross(&wave(false), 0, [1, 0]);
        assert!((spectrum[1].arg() - TAU * 3.0 / 24.0).abs() < 1e-5);
    }
}
