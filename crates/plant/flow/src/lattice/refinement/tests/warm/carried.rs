//! A warm blob on its way through boxes.

use super::*;
use crate::Inflow;

const WIND: Vector3 = Vector3::new(0.1, 0.01, 0.0);
/// Radius of the blob (m): three coarse cells.
const RADIUS: f64 = 3.0;

/// Steady wind that carries a blob, a kelvin warmer than the air around it at time zero, as means over cells
/// of some size (m).
struct Blob(f64);

impl Inflow for Blob {
    fn sample(&self, _: f64, _: &[Vector3], velocities: &mut [Vector3]) {
        velocities.fill(WIND);
    }

    fn sample_temperature(&self, _: f64, positions: &[Vector3], temperatures: &mut [f64]) -> bool {
        let radius = (RADIUS * RADIUS + self.0 * self.0 / 12.0).sqrt();
        let peak = (RADIUS / radius).powi(3);
        for (position, temperature) in positions.iter().zip(temperatures) {
            let away = (*position - Vector3::new(12.0, 10.0, 8.0)).length() / radius;
            *temperature = 300.0 + peak * (-0.5 * away * away).exp();
        }
        true
    }
}

/// What is told of the blob.
#[derive(Debug)]
struct Told {
    heat: f64,
    centre: Vector3,
    peak: f64,
    coldest: f64,
    /// Temperatures on cells of a metre.
    values: Vec<f64>,
}

fn tell(air: &Refined) -> Told {
    let n = [64, 24, 20];
    let mut told = Told {
        heat: 0.0,
        centre: Vector3::ZERO,
        peak: 0.0,
        coldest: 0.0,
        values: vec![0.0; n.iter().product()],
    };
    for cell in warm_cells(air) {
        let heat = cell.temperature * cell.volume;
        told.heat += heat;
        told.centre += cell.centre * heat;
        told.peak = told.peak.max(cell.temperature);
        told.coldest = told.coldest.min(cell.temperature);
        let [x, y, z] = cell.centre.to_array().map(|place| (place + 0.5).floor() as usize);
        told.values[(z * n[1] + y) * n[0] + x] += heat;
    }
    told.centre /= told.heat;
    told
}

/// The blob after `duration` (s), on cells of a metre with `boxes`, or of half a metre.
fn carried(halved: bool, boxes: &[Refinement], duration: f64) -> [Told; 2] {
    let mut coarse = periodic_box([64, 24, 20], 1e-6);
    coarse.threads = Some(1);
    coarse.atmosphere = Some(Atmosphere { gravity: 0.0, ..Atmosphere::new(300.0) });
    let settings = if halved { fine(&coarse) } else { coarse };
    let spacing = settings.spacing;
    let mut air = Refined::new(settings, boxes, Arc::new(Blob(spacing))).expect("sound settings");
    let before = tell(&air);
    air.advance(duration, &[]).expect("no divergence");
    [before, tell(&air)]
}

#[test]
fn a_warm_blob_is_carried_through_a_box() {
    let place = cells([20, 5, 7], [22, 14, 10]);
    // In the middle of the box, and behind it.
    for duration in [190.0, 360.0] {
        let [_, fine] = carried(true, &[], duration);
        let norm = fine.values.iter().map(|v| v * v).sum::<f64>().sqrt();
        let off = |told: &Told| {
            let square = told.values.iter().zip(&fine.values).map(|(a, b)| (a - b).powi(2));
            square.sum::<f64>().sqrt() / norm
        };
        let [_, coarse] = carried(false, &[], duration);
        let [before, boxed] = carried(false, std::slice::from_ref(&place), duration);
        println!(
            "{duration} s: peak {:.4} fine, {:.4} boxed, {:.4} coarse; off by {:.4}, {:.4}; coldest {:.4}",
            fine.peak,
            boxed.peak,
            coarse.peak,
            off(&boxed),
            off(&coarse),
            boxed.coldest
        );
        let kept = boxed.heat / before.heat - 1.0;
        let shift = boxed.centre - before.centre - WIND * duration;
        println!("heat {kept:e}, centre off by {shift}");
        assert!(kept.abs() < 2e-6, "heat changed by {kept:e}");
        assert!(shift.length() < 0.02, "{shift} beside its way");
        assert!(off(&boxed) < 0.85 * off(&coarse), "off by {}", off(&boxed));
        assert!(boxed.coldest > -0.002, "{} K", boxed.coldest);
        // Behind the box its cells are coarse again.
        let in_box = duration < 200.0;
        assert!(!in_box || (boxed.peak - fine.peak).abs() < 0.005, "{}", boxed.peak);
    }
}
