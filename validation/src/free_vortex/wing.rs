//! A wing of elliptic plan whose lift a free wake holds back, beside Prandtl's closed form.

use crate::Row;
use crate::row::Tolerance::Within;
use basis::{BoundVortex, PointForce, Vector3};
use flow::inflow::{MeanProfile, PrescribedWind};
use flow::vortex::{
    Accuracy, BodyWakes, Cores, FreeWake, MeanShear, Points, Resolution, WakeSettings,
};
use flow::{FlowSolver, WindField};
use std::f64::consts::PI;
use std::sync::Arc;

/// Span and chord in the middle (m), angle of attack (rad), wind (m/s). Source of span, chord and angle: van
/// Garrel, ECN-C--03-079, § 4.
const SPAN: f64 = 5.0;
const CHORD: f64 = 1.0;
const ANGLE: f64 = 5.7106 * PI / 180.0;
const WIND: f64 = 1.0;
/// Accepted distance of lift and drag from their closed forms (–).
const TOLERANCE: f64 = 0.005;
const SOURCE: &str = "Prandtl's lifting line, closed form of the elliptic wing";

/// Lift and induced drag of the wing on 20, 40 and 80 elements.
pub(super) fn rows() -> Vec<Row> {
    let ratio = SPAN / (0.25 * PI * CHORD);
    let lift = 2.0 * PI * ANGLE / (1.0 + 2.0 / ratio);
    let drag = lift * lift / (PI * ratio);
    let row = |n: usize, what: &str, measured: f64, expected: f64| Row {
        what: format!("elliptic wing, aspect ratio 6.366, angle 5.7106°, {n} elements: {what}"),
        measured,
        expected,
        tolerance: Within(TOLERANCE * expected),
        unit: "–",
        source: SOURCE,
    };
    let mut rows = Vec::new();
    for n in [20, 40, 80] {
        let [found_lift, found_drag] = coefficients(n);
        tell!("wing of {n} elements: lift {found_lift:.5}, induced drag {found_drag:.6}");
        rows.push(row(n, "lift coefficient", found_lift, lift));
        rows.push(row(n, "induced drag coefficient", found_drag, drag));
    }
    rows
}

/// Coefficients of lift and induced drag of the wing in `n` elements, when its wake is 50 spans long. It
/// leaves the wing straight for five of them, as Prandtl's does for ever.
fn coefficients(n: usize) -> [f64; 2] {
    let interval = 5.0 * SPAN / WIND;
    let mut wake = FreeWake::new(settings(n, interval), wind()).expect("such a wake can be");
    // Elements of equal angles: narrow at the ends, their middles in the middle of their angle.
    let y = |share: f64| -0.5 * SPAN * (PI * share).cos();
    let places: Vec<[f64; 3]> = (0..n)
        .map(|k| [k as f64, k as f64 + 0.5, k as f64 + 1.0].map(|share| y(share / n as f64)))
        .collect();
    let stations: Vec<Vector3> = places.iter().map(|[_, middle, _]| Vector3::Y * *middle).collect();
    let mut circulations = vec![0.0; n];
    let mut winds = vec![Vector3::ZERO; n];
    for _ in 0..10 {
        wake.sample(&stations, &mut winds);
        solve(&wake, &places, &winds, &mut circulations);
        let forces: Vec<PointForce> = places
            .iter()
            .zip(&circulations)
            .enumerate()
            .map(|(station, ([low, middle, high], circulation))| {
                let position = Vector3::Y * *middle;
                let along = Vector3::Y * (high - low);
                let bound = BoundVortex {
                    blade: 0,
                    station,
                    circulation: *circulation,
                    along,
                    inner_share: (middle - low) / (high - low),
                    position_after: position,
                    along_after: along,
                };
                let bound = Some(bound);
                PointForce { bound, ..PointForce::of_body(position, Vector3::ZERO, 0.0) }
            })
            .collect();
        wake.advance(interval, &forces).expect("a wake in steady wind stays finite");
    }
    wake.sample(&stations, &mut winds);
    let area = 0.25 * PI * SPAN * CHORD;
    let (mut lift, mut drag) = (0.0, 0.0);
    for (([low, _, high], circulation), wind) in places.iter().zip(&circulations).zip(&winds) {
        lift += circulation * (high - low);
        drag -= circulation * wind.z * (high - low);
    }
    [2.0 * lift / (WIND * area), 2.0 * drag / (WIND * WIND * area)]
}

/// On return `circulations` are those of thin sections in `winds` and what these answer.
fn solve(wake: &FreeWake, places: &[[f64; 3]], winds: &[Vector3], circulations: &mut [f64]) {
    let n = places.len();
    let of_section = |[_, y, _]: &[f64; 3], upwash: f64| {
        let chord = CHORD * (1.0 - (2.0 * y / SPAN).powi(2)).sqrt();
        (PI * chord * (WIND * ANGLE + upwash), PI * chord)
    };
    let Some(answer) = wake.answer(0) else {
        for (k, place) in places.iter().enumerate() {
            circulations[k] = of_section(place, winds[k].z).0;
        }
        return;
    };
    for _ in 0..200 {
        for (k, place) in places.iter().enumerate() {
            let row = &answer.influence[k * n..(k + 1) * n];
            let changes = circulations.iter().zip(answer.circulations);
            let answered: f64 = row
                .iter()
                .zip(changes)
                .map(|(velocity, (now, then))| velocity.z * (now - then))
                .sum();
            let (found, slope) = of_section(place, winds[k].z + answered);
            let step = (found - circulations[k]) / (1.0 - (slope * row[k].z).min(0.0));
            circulations[k] += step;
        }
    }
}

fn wind() -> PrescribedWind {
    PrescribedWind::everywhere(Arc::new(MeanProfile::Uniform { speed: WIND }))
}

fn settings(n: usize, interval: f64) -> WakeSettings {
    WakeSettings {
        interval,
        resolution: Resolution {
            near_rows: 100,
            far_stride: 2,
            far_filaments: n + 1,
            length: 100.0 * SPAN,
            end: f64::INFINITY,
            far_rows: 60,
        },
        cores: Cores {
            initial_widths: 0.1,
            kinematic_viscosity: 0.0,
            eddy_constant: 0.0,
            strain: false,
        },
        bodies: BodyWakes::NONE,
        air_density: 1.0,
        accuracy: Accuracy { degree: 3, opening: 0.0 },
        shear: MeanShear::Carries,
        ground: false,
        shown: Points::NONE,
        n_blades: 1,
        far_rows_in_all: 60,
        n_elements: n,
        threads: None,
    }
}
