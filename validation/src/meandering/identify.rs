//! How pitch acts on the loads, found by two small helices in the very wind that the loads come from.

use super::rig::{INTERVAL, Rig};
use basis::{FixedFrame, Sense};
use control::Helix;
use control::meandering::{Answer, Decoupling};
use std::f64::consts::TAU;

/// Strouhal number (–) of the helices in the disk's ambient wind, amid those of the disk, and their amplitude
/// (rad).
const STROUHAL: f64 = 0.2;
const AMPLITUDE: f64 = std::f64::consts::PI / 180.0;
/// When the answer is taken to have settled (s), and over how many periods it is looked at (–).
const SETTLED: f64 = 400.0;
const PERIODS: f64 = 8.0;

/// Azimuth offset, delay and gain, from runs of `rig` with a helix of either sense beside `loads` (N m, one
/// for each step) without: the wind being the same to the last bit, the difference is what the helix does.
pub(super) fn decoupling(rig: &Rig, loads: &[FixedFrame]) -> Decoupling {
    let helix = |sense| Helix::new(sense, AMPLITUDE, STROUHAL, 16.0, 240.0);
    let rate = helix(Sense::Clockwise).rate;
    let [ccw, cw] = [Sense::CounterClockwise, Sense::Clockwise].map(|sense| {
        let helix = helix(sense);
        let mut machine = rig.clone();
        let end = SETTLED + PERIODS * TAU / rate;
        // Correlation of the moment lost with the tilt command and with the same a quarter period earlier,
        // both axes.
        let mut sums = [0.0; 2];
        let mut n = 0.0;
        for before in loads.iter().take((end / INTERVAL) as usize) {
            let reading = machine.advance(|pitch, measurements| {
                let added = helix.pitch(measurements.time, measurements.azimuth, pitch.len());
                pitch.iter_mut().zip(added.iter()).for_each(|(pitch, added)| *pitch += added);
            });
            if reading.time >= SETTLED {
                let angle = rate * reading.time;
                let lost = [before.tilt - reading.loads.tilt, before.yaw - reading.loads.yaw];
                for (lost, angle) in lost.into_iter().zip([angle, angle + sense.yaw_lead()]) {
                    sums[0] += lost * angle.sin();
                    sums[1] += lost * angle.cos();
                    n += 0.5;
                }
            }
        }
        Answer { gain: sums[0].hypot(sums[1]) / n / AMPLITUDE, lead: sums[1].atan2(sums[0]) }
    });
    for (sense, answer) in [(Sense::CounterClockwise, ccw), (Sense::Clockwise, cw)] {
        let (gain, lead) = (1e-6 * answer.gain, answer.lead.to_degrees());
        tell!("helix {sense}: {gain:.1} MN m lost per radian of pitch, lead {lead:.1}°");
    }
    Decoupling::from_senses(rate, ccw, cw)
}
