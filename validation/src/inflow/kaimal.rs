//! IEC turbulence against the standard's own spectra and coherence, and against a record of TurbSim.

use super::{frozen, mean_of};
use crate::Row;
use crate::row::Tolerance::{AtMost, Within};
use flow::inflow::iec::Kaimal;
use flow::inflow::kaimal::{KaimalSettings, Scaling, clipped_share, generate};
use flow::inflow::statistics::line_deviations;
use flow::inflow::{TurbulenceBox, spectra};
use std::f64::consts::TAU;

/// Where the expected values come from.
const IEC: &str = "IEC 61400-1, edition 3";
const TURBSIM: &str = "TurbSim 2, one record";

/// Seeds over which figures are averaged.
const SEEDS: u64 = 10;
/// Bands of frequency over which spectra and coherence are averaged (Hz).
const BANDS: [[f64; 2]; 4] = [[0.003, 0.01], [0.01, 0.03], [0.03, 0.1], [0.1, 0.3]];
/// Points apart along y and z at which coherence is compared; one spacing is 9.667 m.
const APART: [[usize; 2]; 5] = [[1, 0], [3, 0], [10, 0], [0, 3], [0, 10]];

/// What TurbSim 2 (OpenFAST 5.0.0, commit 2895884) made of the same settings: IECKAI, NTM, 6 %, 9 m/s at 150
/// m, grid 31 × 31 of 290 m, 6600 steps of 0.1 s, power law 0.14, no scaling, seed 20260101. By band,
/// coherence of u at the distances of `APART`.
const TURBSIM_COHERENCE: [[f64; 5]; 4] = [
    [0.9097, 0.7479, 0.3345, 0.7518, 0.2914],
    [0.7903, 0.5022, 0.1387, 0.4987, 0.1322],
    [0.5168, 0.1629, -0.0040, 0.1658, 0.0029],
    [0.1376, 0.0072, -0.0021, 0.0064, 0.0036],
];
/// Of the same record: spectrum of u over all points, by band (m²/s² per Hz).
const TURBSIM_SPECTRUM: [f64; 4] = [9.8600, 2.8725, 0.56149, 0.090499];
/// Of the same record: standard deviations of u, v, w, mean over all points, and of u at the hub (m/s).
const TURBSIM_DEVIATIONS: [f64; 3] = [0.50223, 0.41972, 0.26207];
const TURBSIM_AT_HUB: f64 = 0.41633;

/// TurbSim's target, for our own `seed`.
pub(crate) fn settings(seed: u64) -> KaimalSettings {
    let spacing = 290.0 / 30.0;
    KaimalSettings {
        n_points: [6600, 31, 31],
        spacing: [0.9, spacing, spacing],
        hub_speed: 9.0,
        hub_height: 150.0,
        lowest_height: 5.0,
        standard_deviation: 0.06 * 9.0,
        scaling: Scaling::None,
        seed,
        threads: None,
    }
}

/// All comparisons.
///
/// # Panics
/// When a box cannot be made, which only a lack of memory (110 MB) causes.
pub fn kaimal() -> Vec<Row> {
    let model = match settings(0).model() {
        Ok(model) => model,
        Err(error) => panic!("the model of the validation cannot be made: {error}"),
    };
    let samples: Vec<Sample> = (1..=SEEDS).map(|seed| Sample::of(&made(&settings(seed)))).collect();
    let mut rows = Vec::new();
    let step = 1.0 / 660.0;
    for (component, name) in ["u", "v", "w"].into_iter().enumerate() {
        let waves = 1..3300;
        let variance: f64 =
            waves.map(|wave| model.spectrum(component, f64::from(wave) * step) * step).sum();
        rows.extend(against_model(
            format!("standard deviation of {name} over all points"),
            samples.iter().map(|sample| sample.deviations[component]),
            variance.sqrt(),
            "m/s",
        ));
        for (index, band) in BANDS.iter().enumerate() {
            rows.extend(against_model(
                format!("spectrum of {name}, {} to {} Hz", band[0], band[1]),
                samples.iter().map(|sample| sample.spectra[component][index]),
                band_mean(*band, |frequency| model.spectrum(component, frequency)),
                "m2/s",
            ));
        }
    }
    rows.extend(coherence(&model, &samples));
    rows.extend(turbsim(&samples));
    rows.push(Row {
        what: "largest share of the variance of u at a frequency that is clipped".into(),
        measured: clipped_share(&settings(1)).unwrap_or(f64::NAN),
        expected: 1e-3,
        tolerance: AtMost,
        unit: "-",
        source: IEC,
    });
    rows.extend(scaled());
    rows
}

/// Coherence of u and of v over the seeds beside the model's.
fn coherence(model: &Kaimal, samples: &[Sample]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (index, band) in BANDS.iter().enumerate() {
        for (place, apart) in APART.into_iter().enumerate() {
            let distance = (apart[0] as f64).hypot(apart[1] as f64) * settings(0).spacing[1];
            let power = band_mean(*band, |frequency| model.spectrum(0, frequency));
            let expected = band_mean(*band, |frequency| {
                model.spectrum(0, frequency) * model.coherence(frequency, distance)
            }) / power;
            let (y, z) = (apart[0], apart[1]);
            let what = |name: &str| {
                format!("coherence of {name} {y} × {z} points apart, {} to {} Hz", band[0], band[1])
            };
            rows.extend(against_model(
                what("u"),
                samples.iter().map(|sample| sample.coherence[index][place]),
                expected,
                "-",
            ));
            if place == 0 {
                let lateral = samples.iter().map(|sample| sample.lateral[index]);
                rows.extend(against_model(what("v"), lateral, 0.0, "-"));
            }
        }
    }
    rows
}

/// One record of TurbSim beside the ten.
fn turbsim(samples: &[Sample]) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut row = |what: String, values: Vec<f64>, turbsim: f64, unit: &'static str| {
        let (mean, _) = mean_of(values.iter().copied());
        let what = format!("TurbSim: {what}");
        rows.extend(frozen::claim(frozen::KAIMAL, what, [mean, turbsim], unit, TURBSIM));
    };
    for (component, name) in ["u", "v", "w"].into_iter().enumerate() {
        row(
            format!("standard deviation of {name}, mean over all points"),
            samples.iter().map(|sample| sample.mean_deviations[component]).collect(),
            TURBSIM_DEVIATIONS[component],
            "m/s",
        );
    }
    row(
        "standard deviation of u at the hub".into(),
        samples.iter().map(|sample| sample.at_hub).collect(),
        TURBSIM_AT_HUB,
        "m/s",
    );
    for (index, band) in BANDS.iter().enumerate() {
        let of = |sample: &Sample| sample.spectra[0][index];
        row(
            format!("spectrum of u, {} to {} Hz", band[0], band[1]),
            samples.iter().map(of).collect(),
            TURBSIM_SPECTRUM[index],
            "m2/s",
        );
        for (place, [y, z]) in APART.into_iter().enumerate() {
            row(
                format!("coherence of u {y} × {z} points apart, {} to {} Hz", band[0], band[1]),
                samples.iter().map(|sample| sample.coherence[index][place]).collect(),
                TURBSIM_COHERENCE[index][place],
                "-",
            );
        }
    }
    rows
}

/// With scaling, the realised deviation is the target.
fn scaled() -> Vec<Row> {
    let at = |scaling, y, z| {
        let turbulence = made(&KaimalSettings { scaling, ..settings(1) });
        line_deviations(&turbulence, y, z)[0]
    };
    [
        ("at the hub, scaled there", at(Scaling::Hub, 15, 15)),
        ("in a corner, scaled at each point", at(Scaling::EachPoint, 0, 30)),
    ]
    .into_iter()
    .map(|(what, measured)| Row {
        what: format!("standard deviation of u {what}"),
        measured,
        expected: 0.54,
        tolerance: Within(1e-6),
        unit: "m/s",
        source: IEC,
    })
    .collect()
}

/// The box of `settings`, which only a lack of memory (110 MB) denies.
pub(crate) fn made(settings: &KaimalSettings) -> TurbulenceBox {
    match generate(settings, |_| {}) {
        Ok(turbulence) => turbulence,
        Err(error) => panic!("the box of the validation cannot be made: {error}"),
    }
}

/// The mean of `values` beside the model's.
fn against_model(
    what: String,
    values: impl Iterator<Item = f64> + Clone,
    expected: f64,
    unit: &'static str,
) -> Option<Row> {
    let (mean, _) = mean_of(values);
    frozen::claim(frozen::KAIMAL, what, [mean, expected], unit, IEC)
}

/// Frequencies of the record within `band` (Hz), as indices from 1.
fn waves(band: [f64; 2]) -> std::ops::RangeInclusive<usize> {
    let n = 660.0;
    (band[0] * n).ceil() as usize..=(band[1] * n).floor() as usize
}

/// Mean of `of`(frequency in Hz) over the record's frequencies within `band`.
fn band_mean(band: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let n = waves(band).count() as f64;
    waves(band).map(|wave| of(wave as f64 / 660.0)).sum::<f64>() / n
}

/// What is measured of one box.
struct Sample {
    /// Of u, v, w over all points (m/s).
    deviations: [f64; 3],
    /// Of u, v, w at a point, mean over the points (m/s).
    mean_deviations: [f64; 3],
    /// Of u at the hub (m/s).
    at_hub: f64,
    /// Of u, v, w by band, one-sided (m²/s² per Hz).
    spectra: [[f64; 4]; 3],
    /// Of u by band and distance (–).
    coherence: [[f64; 5]; 4],
    /// Of v at the first distance by band (–).
    lateral: [f64; 4],
}

impl Sample {
    fn of(turbulence: &TurbulenceBox) -> Self {
        let one_point = spectra::one_point(turbulence);
        // Two-sided per rad/m to one-sided per Hz: k = 2π f / U.
        let per_frequency = 2.0 * TAU / 9.0;
        let mean = |band: [f64; 2], of: &dyn Fn(usize) -> f64| {
            waves(band).map(|wave| of(wave - 1)).sum::<f64>() / waves(band).count() as f64
        };
        let spectra = [0, 1, 2].map(|component| {
            BANDS.map(|band| per_frequency * mean(band, &|index| one_point.power[component][index]))
        });
        let mut mean_deviations = [0.0; 3];
        for point in 0..961 {
            let deviations = line_deviations(turbulence, point % 31, point / 31);
            for (sum, deviation) in mean_deviations.iter_mut().zip(deviations) {
                *sum += deviation / 961.0;
            }
        }
        let mut coherence = [[0.0; 5]; 4];
        for (place, apart) in APART.into_iter().enumerate() {
            for (band, value) in coherent(turbulence, 0, apart).into_iter().enumerate() {
                coherence[band][place] = value;
            }
        }
        Self {
            deviations: turbulence.standard_deviations(),
            mean_deviations,
            at_hub: line_deviations(turbulence, 15, 15)[0],
            spectra,
            coherence,
            lateral: coherent(turbulence, 1, APART[0]),
        }
    }
}

/// In-phase coherence (–) by band of `component` at all pairs of points `apart` that do not reach across the
/// edge.
fn coherent(turbulence: &TurbulenceBox, component: usize, apart: [usize; 2]) -> [f64; 4] {
    let transforms = spectra::lines(turbulence, component);
    let [_, n_y, n_z] = turbulence.n_points();
    BANDS.map(|band| {
        let (mut product, mut here_power, mut there_power) = (0.0, 0.0, 0.0);
        for z in 0..n_z - apart[1] {
            for y in 0..n_y - apart[0] {
                let here = &transforms[z * n_y + y];
                let there = &transforms[(z + apart[1]) * n_y + y + apart[0]];
                for wave in waves(band) {
                    let (here, there) = (here[wave - 1], there[wave - 1]);
                    product += (here.conj() * there).re;
                    here_power += here.norm_sqr();
                    there_power += there.norm_sqr();
                }
            }
        }
        product / (here_power * there_power).sqrt()
    })
}
