//! Delivered pitch: the part of an excitation that the pitch actuators realise.

use crate::line::{strongest, strongest_rotation};
use crate::{AnalysisError, statistics::mean};
use basis::PerBlade;
use basis::angle::wrap_to_half_turn;
use basis::mbc::to_fixed_frame;
use basis::records::DeliveredPitch;
use std::f64::consts::TAU;

/// How an excitation moves the blades.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Each blade at its own phase: the helix.
    Cyclic,
    /// All blades together: the pulse.
    Collective,
}

/// Amplitude and frequencies of the delivered excitation.
///
/// `azimuth` (rad, any range) and `pitch` (rad, one record per blade, blade 1 first) are sampled every
/// `interval` (s) while the excitation runs at full amplitude; `commanded_amplitude` (rad) and
/// `clipped_share` (–) are passed through.
///
/// A helix is identified in the fixed frame, where it is one spectral line even with varying rotor speed:
/// tilt and yaw of the delivered pitch turn together at −ω_e (ccw) or +ω_e (cw). The line in the blade's
/// frame then lies at mean rotor frequency minus the signed frequency of that turning, and has the same
/// amplitude. A pulse is identified in the mean over the blades and has one frequency in both frames.
///
/// Source: van Vondelen et al. (2025), Eqs. 4-7. Limits: collective pitch control that moves at the pulse's
/// frequency counts as delivered pulse.
///
/// # Errors
/// [`AnalysisError::TooFewBlades`] for a helix on fewer than three blades, [`AnalysisError::UnequalLengths`],
/// and those of [`strongest`].
pub fn delivered(
    motion: Motion,
    azimuth: &[f64],
    pitch: &[&[f64]],
    interval: f64,
    commanded_amplitude: f64,
    clipped_share: f64,
) -> Result<DeliveredPitch, AnalysisError> {
    for blade in pitch {
        if blade.len() != azimuth.len() {
            let (first, second) = (azimuth.len(), blade.len());
            return Err(AnalysisError::UnequalLengths { first, second });
        }
    }
    let least = if motion == Motion::Cyclic { 3 } else { 1 };
    if pitch.len() < least {
        return Err(AnalysisError::TooFewBlades { n_blades: pitch.len() });
    }
    let at = |index: usize| PerBlade::from_fn(pitch.len(), |blade| pitch[blade][index]);
    let (amplitude, frequency, excitation_frequency) = match motion {
        Motion::Cyclic => {
            let (tilt, yaw): (Vec<f64>, Vec<f64>) = azimuth
                .iter()
                .enumerate()
                .map(|(index, azimuth)| to_fixed_frame(*azimuth, &at(index)))
                .map(|fixed| (fixed.tilt, fixed.yaw))
                .unzip();
            let line = strongest_rotation(&tilt, &yaw, interval)?;
            let rotor_frequency = rotor_frequency(azimuth, interval);
            (line.amplitude, rotor_frequency - line.frequency, line.frequency.abs())
        }
        Motion::Collective => {
            let average: Vec<f64> = (0..azimuth.len()).map(|index| at(index).mean()).collect();
            let line = strongest(&average, interval)?;
            (line.amplitude, line.frequency, line.frequency)
        }
    };
    Ok(DeliveredPitch {
        commanded_amplitude_deg: commanded_amplitude.to_degrees(),
        delivered_amplitude_deg: amplitude.to_degrees(),
        frequency_hz: frequency,
        excitation_frequency_hz: excitation_frequency,
        clipped_share,
    })
}

/// Mean rotor frequency (Hz) from `azimuth` (rad, any range), sampled every `interval` (s), at least twice a
/// turn.
pub fn rotor_frequency(azimuth: &[f64], interval: f64) -> f64 {
    if azimuth.len() < 2 {
        return 0.0;
    }
    let turned: Vec<f64> =
        azimuth.windows(2).map(|pair| wrap_to_half_turn(pair[1] - pair[0])).collect();
    mean(&turned) / (TAU * interval)
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::FixedFrame;
    use basis::angle::wrap_to_turn;
    use basis::mbc::to_blades;

    const INTERVAL: f64 = 0.2;
    const RATE: f64 = 0.0687;

    /// Azimuth of a rotor whose speed breathes by 8 %, and three blades' pitch with a helix of `sign` (+1
    /// ccw) on top of a wandering collective pitch.
    fn record(sign: f64, amplitude: f64) -> (Vec<f64>, [Vec<f64>; 3]) {
        let times: Vec<f64> = (0..9000).map(|step| INTERVAL * f64::from(step)).collect();
        let azimuth: Vec<f64> =
            times.iter().map(|t| wrap_to_turn(0.7 * t + 0.056 / 0.02 * (0.02 * t).sin())).collect();
        let blade = |blade: usize| {
            times
                .iter()
                .zip(&azimuth)
                .map(|(t, azimuth)| {
                    let angle = RATE * t + 0.3;
                    let fixed = FixedFrame {
                        average: 0.05 + 0.03 * (0.011 * t).sin(),
                        tilt: amplitude * angle.sin(),
                        yaw: sign * amplitude * angle.cos(),
                    };
                    to_blades(azimuth + 0.2, fixed, 3)[blade]
                })
                .collect()
        };
        let pitch = [blade(0), blade(1), blade(2)];
        (azimuth, pitch)
    }

    #[test]
    fn a_helix_is_recovered_while_rotor_speed_varies() {
        for sign in [1.0, -1.0] {
            let amplitude = 4.0_f64.to_radians();
            let (azimuth, pitch) = record(sign, amplitude);
            let pitch: Vec<&[f64]> = pitch.iter().map(Vec::as_slice).collect();
            let found = delivered(Motion::Cyclic, &azimuth, &pitch, INTERVAL, amplitude, 0.1)
                .expect("a long record");
            assert!((found.delivered_amplitude_deg - 4.0).abs() < 1e-5);
            assert!((found.commanded_amplitude_deg - 4.0).abs() < 1e-12);
            assert!((found.excitation_frequency_hz - RATE / TAU).abs() < 1e-8);
            let rotor = rotor_frequency(&azimuth, INTERVAL);
            assert!((found.frequency_hz - (rotor + sign * RATE / TAU)).abs() < 1e-8);
            assert_eq!(found.clipped_share, 0.1);
        }
    }

    #[test]
    fn a_pulse_is_recovered() {
        let (azimuth, _) = record(1.0, 0.0);
        let pulse: Vec<f64> =
            (0..azimuth.len()).map(|i| 0.02 + 0.04 * (RATE * INTERVAL * i as f64).sin()).collect();
        let pitch = [pulse.as_slice(); 3];
        let found = delivered(Motion::Collective, &azimuth, &pitch, INTERVAL, 0.04, 0.0)
            .expect("a long record");
        assert!((found.delivered_amplitude_deg - 0.04_f64.to_degrees()).abs() < 1e-5);
        assert!((found.frequency_hz - RATE / TAU).abs() < 1e-8);
    }

    #[test]
    fn bad_records_are_refused() {
        let zeros = [0.0; 100];
        let two: [&[f64]; 2] = [&zeros; 2];
        assert_eq!(
            delivered(Motion::Cyclic, &zeros, &two, 1.0, 0.0, 0.0),
            Err(AnalysisError::TooFewBlades { n_blades: 2 })
        );
        let three: [&[f64]; 3] = [&zeros; 3];
        assert!(delivered(Motion::Cyclic, &zeros[..50], &three, 1.0, 0.0, 0.0).is_err());
    }
}
