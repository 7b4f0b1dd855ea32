//! Probing: a helix with pseudo-random binary noise on its tilt and yaw in the helix frame, for
//! identification of what the wake answers.
//!
//! Source: Chen, van Vondelen, van Wingerden (2026), "Lidar-enhanced closed-loop active helix approach", Wind
//! Energ. Sci. 11, 1871, Appendix C: noise of 1° up to 0.03 Hz on both components.

mod kind;
mod noise;

pub use kind::PROBING;

use crate::controller::{ForeignState, from_bytes, to_bytes};
use crate::excitation::{Excitation, add, share};
use crate::lidar_loop::{Watch, WatchState};
use basis::channels::of_helix_frame;
use basis::mbc::to_blades;
use basis::{Channel, FixedFrame, HelixFrame, Measurements, PerBlade};
use noise::BinaryNoise;

/// A helix with noise, as it runs on one turbine.
#[derive(Clone, Debug)]
pub struct Probing {
    frame: HelixFrame,
    /// The open helix in its frame (rad).
    helix: [f64; 2],
    /// Amplitude of the noise before it is filtered (rad).
    noise: f64,
    azimuth_offset: f64,
    /// Times at which helix and noise begin (s).
    starts: [f64; 2],
    sources: [BinaryNoise; 2],
    /// Tilt and yaw at the last instant, in the helix frame (rad).
    commands: [f64; 2],
    watch: Watch,
}

impl Probing {
    /// Tilt and yaw (rad) in the helix frame at the instant of `measurements`.
    fn advance(&mut self, measurements: &Measurements) -> [f64; 2] {
        let Measurements { time, interval, .. } = *measurements;
        let [helix, noise] = self.starts.map(|start| share(time, start, None, self.frame.rate));
        let mut noises = [0.0; 2];
        if time >= self.starts[1] {
            for (value, source) in noises.iter_mut().zip(&mut self.sources) {
                *value = noise * self.noise * source.next(interval);
            }
        }
        [0, 1].map(|axis| helix * self.helix[axis] + noises[axis])
    }
}

impl Excitation for Probing {
    fn add_to(&mut self, pitch: &mut PerBlade<f64>, measurements: &Measurements) {
        self.watch.update(measurements);
        self.commands = self.advance(measurements);
        let [tilt, yaw] = self.frame.to_fixed(measurements.time, self.commands);
        let azimuth = measurements.azimuth + self.azimuth_offset;
        let added = to_blades(azimuth, FixedFrame { average: 0.0, tilt, yaw }, pitch.len());
        add(pitch, &added);
    }

    fn describe(&self) -> String {
        let [helix, noise] = [self.helix[0].hypot(self.helix[1]), self.noise].map(f64::to_degrees);
        format!("helix {} {helix:.1}° with noise of {noise:.1}°", self.frame.sense)
    }

    fn signals(&self) -> Vec<Channel> {
        of_helix_frame()
    }

    fn write_signals(&self, values: &mut [f64]) {
        let (commands, watched) = values.split_at_mut(2);
        commands.copy_from_slice(&self.commands);
        self.watch.write_signals(watched);
    }

    fn save(&self) -> Vec<u8> {
        to_bytes(&(self.sources, self.commands, self.watch.save()))
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let watch: WatchState;
        (self.sources, self.commands, watch) = from_bytes(state)?;
        self.watch.restore(watch);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Helix;
    use basis::Sense;

    fn probing(sense: Sense, noise: f64) -> Probing {
        let frame = HelixFrame { sense, rate: 0.15 };
        Probing {
            frame,
            helix: frame.open_helix(0.05, 0.3),
            noise,
            azimuth_offset: 0.1,
            starts: [20.0, 100.0],
            sources: [0, 1].map(|channel| BinaryNoise::new(1, channel, [0.0, 0.19])),
            commands: [0.0; 2],
            watch: Watch::for_tests(frame, Some([0.0; 2])),
        }
    }

    #[test]
    fn without_noise_it_is_the_helix() {
        for sense in [Sense::CounterClockwise, Sense::Clockwise] {
            let mut probing = probing(sense, 0.0);
            let helix = Helix {
                phase: 0.3,
                azimuth_offset: 0.1,
                start: 20.0,
                rate: 0.15,
                ..Helix::new(sense, 0.05, 0.3, 10.0, 126.0)
            };
            for step in 0..3000 {
                let time = 0.1 * f64::from(step);
                let azimuth = 1.2 * time;
                let measured =
                    Measurements { time, azimuth, interval: 0.1, ..Measurements::at_rest(3) };
                let mut pitch = PerBlade::splat(3, 0.01);
                probing.add_to(&mut pitch, &measured);
                for (pitch, added) in pitch.iter().zip(helix.pitch(time, azimuth, 3).iter()) {
                    assert!((pitch - 0.01 - added).abs() < 1e-12, "{time} s");
                }
            }
        }
    }

    /// Pitch of an offset is that of commands that the matrix of `identification::decoupling` turns: the
    /// offset that a model asks for is the one to add to `azimuth_offset_deg`.
    #[test]
    fn an_azimuth_offset_turns_the_commands_in_the_helix_frame() {
        for sense in [Sense::CounterClockwise, Sense::Clockwise] {
            let mut probing = probing(sense, 0.0);
            let (sine, cosine) = probing.azimuth_offset.sin_cos();
            let mut straight = Probing { azimuth_offset: 0.0, ..probing.clone() };
            let [tilt, yaw] = straight.helix;
            straight.helix = [cosine * tilt + sine * yaw, cosine * yaw - sine * tilt];
            for step in 0..2000 {
                let time = 0.1 * f64::from(step);
                let measured = Measurements {
                    time,
                    azimuth: 1.3 * time,
                    interval: 0.1,
                    ..Measurements::at_rest(3)
                };
                let [mut with, mut without] = [0, 1].map(|_| PerBlade::splat(3, 0.0));
                probing.add_to(&mut with, &measured);
                straight.add_to(&mut without, &measured);
                for (with, without) in with.iter().zip(without.iter()) {
                    assert!((with - without).abs() < 1e-12, "{time} s");
                }
            }
        }
    }

    #[test]
    fn it_goes_on_from_what_it_saved_to_the_same_bits() {
        let commands = |probing: &mut Probing, steps: std::ops::Range<i32>| -> Vec<[f64; 2]> {
            steps
                .map(|step| {
                    let time = 0.1 * f64::from(step);
                    let measured = Measurements { time, interval: 0.1, ..Measurements::at_rest(3) };
                    probing.add_to(&mut PerBlade::splat(3, 0.0), &measured);
                    probing.commands
                })
                .collect()
        };
        let mut whole = probing(Sense::CounterClockwise, 0.02);
        commands(&mut whole, 0..2000);
        let mut resumed = probing(Sense::CounterClockwise, 0.02);
        resumed.restore(&whole.save()).unwrap();
        assert_eq!(commands(&mut whole, 2000..3000), commands(&mut resumed, 2000..3000));
        assert_eq!(resumed.restore(&[1]), Err(ForeignState));
    }
}
