//! H-infinity controllers beside SLICOT's, and beside what no controller can do better.

use crate::Row;
use crate::folds::{larger, worst};
use crate::row::Tolerance::{AtMost, Within};
use faer::Mat;
use lti::matrices::{StateSpace, TransferFunction};
use serde::Deserialize;
use synthesis::{
    GeneralisedPlant, HInfinity, HInfinityOptions, SensitivityWeights, control_weight, h_infinity,
    mixed_sensitivity, performance_weight,
};

const SLYCOT: &str = "slycot 0.7.1 (SLICOT SB10AD)";
const CLOSED_LOOP: &str = "slycot 0.7.1 (SLICOT AB13DD) on SLICOT's own loop";
const INTERPOLATION: &str =
    "|W_P(z)| |z + p|/|z − p|, Skogestad and Postlethwaite 2005, Eqs. 5.57 and 5.60";

/// The plants of `validation/scripts/hinf_beside_slycot.py` with what slycot found.
const PLANTS: &str = include_str!("../data/synthesis/hinf_plants.json");

#[derive(Deserialize)]
struct Plants {
    plants: Vec<Plant>,
}

#[derive(Deserialize)]
struct Plant {
    name: String,
    n_controls: usize,
    n_measurements: usize,
    #[serde(rename = "A")]
    a: Vec<Vec<f64>>,
    #[serde(rename = "B")]
    b: Vec<Vec<f64>>,
    #[serde(rename = "C")]
    c: Vec<Vec<f64>>,
    #[serde(rename = "D")]
    d: Vec<Vec<f64>>,
    gamma: f64,
    norm: f64,
}

/// Ten plants beside slycot, and plants with a zero in the right half plane beside their least norm.
///
/// # Panics
/// When the stored plants cannot be read, or one has no controller.
pub fn synthesis() -> Vec<Row> {
    let Plants { plants } = serde_json::from_str(PLANTS).expect("stored plants");
    let solved: Vec<(Plant, GeneralisedPlant, HInfinity)> = plants
        .into_iter()
        .map(|plant| {
            let system = matrices(&plant);
            let problem = GeneralisedPlant::new(system, plant.n_measurements, plant.n_controls)
                .expect("stored sizes");
            let found = h_infinity(&problem, &HInfinityOptions::default()).expect("a controller");
            (plant, problem, found)
        })
        .collect();
    let mut rows: Vec<Row> = solved.iter().map(|(plant, _, found)| beside(plant, found)).collect();
    let row = |what: &str, measured, expected, unit, source| Row {
        what: what.to_owned(),
        measured,
        expected,
        tolerance: AtMost,
        unit,
        source,
    };
    let unstable = solved.iter().filter(|(_, problem, found)| {
        !problem.closed(&found.controller).and_then(|loop_| Ok(loop_.is_stable()?)).unwrap_or(false)
    });
    rows.push(row(
        "ten plants: closed loops that are not stable",
        unstable.count() as f64,
        0.0,
        "–",
        "poles",
    ));
    rows.push(row(
        "ten plants: largest relative residual of a Riccati equation",
        worst(
            solved
                .iter()
                .map(|(.., found)| larger(found.riccati_residuals[0], found.riccati_residuals[1])),
        ),
        1e-10,
        "–",
        "the equation itself",
    ));
    rows.push(row(
        "ten plants: norm reached over that of slycot's loop, less one",
        worst(solved.iter().map(|(plant, _, found)| found.achieved.gain / plant.norm - 1.0)),
        1e-3,
        "–",
        CLOSED_LOOP,
    ));
    rows.extend(ZEROS.iter().map(right_half_plane_zero));
    rows
}

/// A matrix of its rows.
fn matrix(rows: &[Vec<f64>]) -> Mat<f64> {
    Mat::from_fn(rows.len(), rows.first().map_or(0, Vec::len), |i, j| rows[i][j])
}

fn matrices(plant: &Plant) -> StateSpace {
    let [a, b, c, d] = [&plant.a, &plant.b, &plant.c, &plant.d].map(|rows| matrix(rows));
    StateSpace::new(a, b, c, d, None)
}

/// The least bound beside slycot's.
fn beside(plant: &Plant, found: &HInfinity) -> Row {
    Row {
        what: format!("{}, order {}: least norm bound", plant.name, plant.a.len()),
        measured: found.bound,
        expected: plant.gamma,
        tolerance: Within(1e-3 * plant.gamma),
        unit: "–",
        source: SLYCOT,
    }
}

/// A plant with a zero z and perhaps a pole p in the right half plane, and the weight of its sensitivity.
struct NonMinimumPhase {
    /// z (rad/s).
    zero: f64,
    /// p (rad/s).
    pole: Option<f64>,
    /// Bandwidth of the weight over z (–), its peak and its attenuation (–).
    weight: [f64; 3],
}

const ZEROS: [NonMinimumPhase; 3] = [
    NonMinimumPhase { zero: 0.05, pole: None, weight: [0.4, 2.0, 0.01] },
    NonMinimumPhase { zero: 0.3, pole: None, weight: [1.5, 10.0, 0.625] },
    NonMinimumPhase { zero: 2.0, pole: Some(0.5), weight: [0.2, 3.0, 0.1] },
];

/// No controller brings W_P S below |W_P(z)| |z + p|/|z − p|, and one whose control costs nothing comes
/// arbitrarily close.
fn right_half_plane_zero(case: &NonMinimumPhase) -> Row {
    let NonMinimumPhase { zero, pole, weight: [bandwidth, peak, attenuation] } = *case;
    let (slow, fast) = (pole.map_or(zero, |pole| -pole), zero);
    let plant = TransferFunction {
        numerator: vec![-1.0, zero],
        denominator: vec![1.0, slow + fast, slow * fast],
        interval: None,
    };
    let corner = bandwidth * zero;
    let weight = performance_weight(corner, peak, attenuation).expect("sound numbers");
    let of_pole = pole.map_or(1.0, |pole| (zero + pole) / (zero - pole));
    let least = of_pole * (zero / peak + corner) / (zero + attenuation * corner);
    let weights = SensitivityWeights {
        performance: Some(weight),
        complementary: None,
        control: Some(control_weight(zero, 10.0, 1e-6).expect("sound numbers")),
    };
    let problem = mixed_sensitivity(&plant.state_space().expect("proper"), &weights);
    let found = h_infinity(&problem.expect("a problem"), &HInfinityOptions::default());
    Row {
        what: match pole {
            None => format!("zero at {zero} rad/s, peak {peak}: least weighted sensitivity"),
            Some(pole) => format!(
                "zero at {zero} and pole at {pole} rad/s in the right half plane, peak {peak}: least weighted sensitivity"
            ),
        },
        measured: found.map_or(f64::NAN, |found| found.bound),
        expected: least,
        tolerance: Within(2e-3 * least),
        unit: "–",
        source: INTERPOLATION,
    }
}
