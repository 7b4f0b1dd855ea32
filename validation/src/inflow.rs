//! Mann's turbulence against its own tensor, integrated numerically, and against closed forms.

mod frozen;
pub mod kaimal;
mod theory;

use crate::Row;
use crate::row::Tolerance::Within;
use basis::Vector3;
use flow::Inflow;
use flow::inflow::spectra::{self, OnePointSpectra};
use flow::inflow::statistics::integral_scale;
use flow::inflow::{MeanProfile, TurbulenceBox, TurbulentInflow, mann};
use std::sync::Arc;
use theory::Theory;

/// Where the expected values come from.
const SOURCE: &str =
    "Mann's tensor (1994, 1998), integrated; von Karman's closed forms; IEC 61400-1, annex B";

/// Seeds over which figures are averaged.
const SEEDS: u64 = 10;
/// Length scale L (m).
const LENGTH_SCALE: f64 = 40.0;
/// Anisotropy Γ after IEC 61400-1 (–).
const ANISOTROPY: f64 = 3.9;
/// Mean speed (m/s).
const SPEED: f64 = 9.0;
/// Turbulence intensity (–).
const INTENSITY: f64 = 0.06;
/// Bands of k₁ L over which spectra are averaged (–).
const BANDS: [[f64; 2]; 5] = [[0.1, 0.2], [0.2, 0.5], [0.5, 1.0], [1.0, 2.0], [2.0, 4.0]];
/// Points apart along y and z at which coherence is compared.
const APART: [[usize; 2]; 4] = [[1, 0], [3, 0], [0, 1], [0, 3]];

fn settings(anisotropy: f64, seed: u64) -> mann::MannSettings {
    mann::MannSettings {
        n_points: [512, 64, 64],
        spacing: [12.0; 3],
        length_scale: LENGTH_SCALE,
        anisotropy,
        standard_deviation: INTENSITY * SPEED,
        seed,
        threads: None,
    }
}

/// All comparisons.
///
/// # Panics
/// When a box cannot be made, which only a lack of memory (100 MB) causes.
pub fn inflow() -> Vec<Row> {
    let mut rows = closed_forms();
    rows.extend(boxes("isotropic", 0.0));
    rows.extend(boxes("sheared", ANISOTROPY));
    rows
}

/// The tensor itself: von Karman's spectra without shear, the standard's ratio with it.
fn closed_forms() -> Vec<Row> {
    let mut rows = Vec::new();
    let theory = Theory::unbounded(LENGTH_SCALE, 0.0);
    for scaled in [0.1, 0.5, 1.0, 3.0, 10.0] {
        let tensor = theory.one_point(scaled / LENGTH_SCALE);
        // [Pope, Turbulent Flows, 2000, §6.5.4] or by integration of Mann's eq. 9; αε^(2/3) = 1, two-sided.
        let scale = LENGTH_SCALE.powf(5.0 / 3.0);
        let base = 1.0 + scaled * scaled;
        let along = 9.0 / 55.0 * scale * base.powf(-5.0 / 6.0);
        let across = 3.0 / 110.0 * scale * (3.0 + 8.0 * scaled * scaled) * base.powf(-11.0 / 6.0);
        for (name, measured, expected) in [
            ("F11", tensor.power[0], along),
            ("F22", tensor.power[1], across),
            ("F33", tensor.power[2], across),
        ] {
            rows.push(Row {
                what: format!(
                    "tensor, isotropic, {name} at k1 L = {scaled}, over von Karman's closed form"
                ),
                measured: measured / expected,
                expected: 1.0,
                tolerance: Within(0.005),
                unit: "-",
                source: SOURCE,
            });
        }
    }
    let variance = |anisotropy: f64| Theory::unbounded(LENGTH_SCALE, anisotropy).variances()[0];
    rows.push(Row {
        what:
            "tensor, isotropic over sheared deviation of u at Γ = 3.9 (IEC 61400-1, annex B: 0.55)"
                .into(),
        measured: (variance(0.0) / variance(ANISOTROPY)).sqrt(),
        expected: 0.55,
        tolerance: Within(0.01),
        unit: "-",
        source: SOURCE,
    });
    rows
}

/// Boxes of `SEEDS` seeds against the tensor integrated over the wave numbers that they resolve.
fn boxes(name: &str, anisotropy: f64) -> Vec<Row> {
    let theory = Theory::resolved(&settings(anisotropy, 0));
    let mut samples: Vec<Vec<f64>> = Vec::new();
    let mut expected = None;
    for seed in 1..=SEEDS {
        let turbulence = match mann::generate(&settings(anisotropy, seed), |_| {}) {
            Ok(turbulence) => Arc::new(turbulence),
            Err(error) => panic!("the box of the validation cannot be made: {error}"),
        };
        let spectra = spectra::one_point(&turbulence);
        let expected = expected.get_or_insert_with(|| Expected::new(&theory, &spectra));
        samples.push(expected.measure(&turbulence, &spectra));
    }
    let Some(expected) = expected else { return Vec::new() };
    expected
        .figures
        .iter()
        .enumerate()
        .filter_map(|(index, figure)| {
            let (mean, _) = mean_of(samples.iter().map(|sample| sample[index]));
            let what = format!("{name} box, {}", figure.what);
            frozen::claim(frozen::MANN, what, [mean, figure.expected], figure.unit, SOURCE)
        })
        .collect()
}

/// Mean of `values` with its standard error.
pub(crate) fn mean_of(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// One figure of a box and what the tensor says of it.
struct Figure {
    what: String,
    expected: f64,
    unit: &'static str,
}

/// What the tensor expects of a box.
struct Expected {
    figures: Vec<Figure>,
    /// Wave indices of each band.
    bands: Vec<Vec<usize>>,
}

impl Expected {
    /// For boxes whose spectra have the wave numbers of `grid`.
    fn new(theory: &Theory, grid: &OnePointSpectra) -> Self {
        let sigma = INTENSITY * SPEED;
        let variances = theory.variances();
        let scale = sigma * sigma / variances[0];
        let spectra: Vec<_> = grid.wave_numbers.iter().map(|k| theory.one_point(*k)).collect();
        let bands: Vec<Vec<usize>> = BANDS
            .iter()
            .map(|[low, high]| {
                let inside = |k: f64| (*low..*high).contains(&(k * LENGTH_SCALE));
                (0..grid.wave_numbers.len())
                    .filter(|index| inside(grid.wave_numbers[*index]))
                    .collect()
            })
            .collect();
        let mut figures = Vec::new();
        let mut figure = |what: String, expected: f64, unit: &'static str| {
            figures.push(Figure { what, expected, unit });
        };
        figure("turbulence intensity over the box".into(), INTENSITY, "-");
        figure(
            "intensity met at 64 fixed points, every half spacing in time".into(),
            INTENSITY,
            "-",
        );
        for (component, name) in [(1, "v"), (2, "w")] {
            let expected = sigma * (variances[component] / variances[0]).sqrt();
            figure(format!("deviation of {name}"), expected, "m/s");
        }
        let ideal = OnePointSpectra {
            wave_numbers: grid.wave_numbers.clone(),
            power: [0, 1, 2]
                .map(|component| spectra.iter().map(|at| at.power[component]).collect()),
            shear: Vec::new(),
        };
        for (component, name) in ["u", "v", "w"].into_iter().enumerate() {
            let expected = integral_scale(&ideal, component);
            figure(format!("integral length scale of {name} along x"), expected, "m");
        }
        figure("divergence in Fourier space".into(), 0.0, "-");
        let mean = |band: &[usize], of: &dyn Fn(usize) -> f64| {
            scale * band.iter().map(|index| of(*index)).sum::<f64>() / band.len() as f64
        };
        for (band, [low, high]) in bands.iter().zip(BANDS) {
            for (component, name) in ["F11", "F22", "F33"].into_iter().enumerate() {
                let expected = mean(band, &|index| spectra[index].power[component]);
                figure(format!("{name}, k1 L {low} to {high}"), expected, "m³/s²");
            }
            let expected = mean(band, &|index| spectra[index].shear);
            figure(format!("F13, k1 L {low} to {high}"), expected, "m³/s²");
        }
        for [y, z] in APART {
            let places = [12.0 * y as f64, 12.0 * z as f64];
            for (band, [low, high]) in bands.iter().zip(BANDS).take(3) {
                let power = mean(band, &|index| spectra[index].power[0]);
                let cross = |part: usize| {
                    mean(band, &|index| theory.cross(grid.wave_numbers[index], places)[part])
                        / power
                };
                let what = |part: &str| {
                    format!(
                        "{part} coherence of u, {} m left, {} m up, k1 L {low} to {high}",
                        places[0], places[1]
                    )
                };
                figure(what("in-phase"), cross(0), "-");
                figure(what("quadrature"), cross(1), "-");
            }
        }
        Self { figures, bands }
    }

    /// The figures of one box, in the order of `figures`.
    fn measure(&self, turbulence: &Arc<TurbulenceBox>, spectra: &OnePointSpectra) -> Vec<f64> {
        let deviations = turbulence.standard_deviations();
        let mut values =
            vec![deviations[0] / SPEED, met_intensity(turbulence), deviations[1], deviations[2]];
        values.extend([0, 1, 2].map(|component| integral_scale(spectra, component)));
        values.push(spectra::divergence_residual(turbulence));
        let mean = |band: &[usize], values: &dyn Fn(usize) -> f64| {
            band.iter().map(|index| values(*index)).sum::<f64>() / band.len() as f64
        };
        for band in &self.bands {
            for power in &spectra.power {
                values.push(mean(band, &|index| power[index]));
            }
            values.push(mean(band, &|index| spectra.shear[index]));
        }
        for apart in APART {
            let cross = spectra::cross(turbulence, 0, apart);
            for band in self.bands.iter().take(3) {
                let power = mean(band, &|index| spectra.power[0][index]);
                values.push(mean(band, &|index| cross[index].re) / power);
                values.push(mean(band, &|index| cross[index].im) / power);
            }
        }
        values
    }
}

/// Intensity of the wind that passes 64 points of the inlet plane in the time that the box takes.
fn met_intensity(turbulence: &Arc<TurbulenceBox>) -> f64 {
    let profile = MeanProfile::Uniform { speed: SPEED };
    let Ok(inflow) = TurbulentInflow::new(Arc::clone(turbulence), profile, Vector3::ZERO) else {
        return f64::NAN;
    };
    let [spacing, across, up] = turbulence.spacing();
    let positions: Vec<_> = (0..64)
        .map(|point| {
            Vector3::new(0.0, f64::from(point % 8 * 8) * across, f64::from(point / 8 * 8) * up)
        })
        .collect();
    let mut velocities = vec![Vector3::ZERO; positions.len()];
    let n_steps = 2 * turbulence.n_points()[0];
    let mut sum = 0.0;
    for step in 0..n_steps {
        inflow.sample(0.5 * spacing * step as f64 / SPEED, &positions, &mut velocities);
        sum += velocities.iter().map(|velocity| (velocity.x - SPEED).powi(2)).sum::<f64>();
    }
    (sum / (n_steps * positions.len()) as f64).sqrt() / SPEED
}
