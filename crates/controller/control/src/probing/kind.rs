//! `kind = "probing"`: its keys, and how it is built.

use super::Probing;
use super::noise::BinaryNoise;
use crate::Controller;
use crate::discon::base;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::keys::{
    AMPLITUDE, AZIMUTH_OFFSET, BASE, LIDAR, SENSE, START, STROUHAL, TILT_PHASE, VORTEX_CENTRE,
    VORTEX_FILTER, VORTEX_INTERVAL, sense, starts_too_late, too_late,
};
use crate::kind::{Control, ControllerKind, Place, Site};
use crate::library::Hosted;
use crate::lidar_loop::{CHANNELS, Watch, findings, no_lidar};
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::keys::LeftOut::{Otherwise, Value};
use basis::keys::{Holds, Objection, Table, Values, above, from, key};
use basis::registry::Named;
use basis::{Channel, HelixFrame, Sense};
use std::f64::consts::{SQRT_2, TAU};

/// Probing.
pub struct ProbingKind;

/// The kind.
pub static PROBING: ProbingKind = ProbingKind;

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"probing\", … }",
    about: "A helix with pseudo-random binary noise on its tilt and yaw in the helix frame, on top of baseline: what `wakemix identify` finds a model from.",
    keys: &[
        SENSE,
        AMPLITUDE,
        STROUHAL,
        key(
            "noise_amplitude_deg",
            from(0.0, 5.0),
            "deg",
            Value("1"),
            "Amplitude of the binary noise on tilt and on yaw, before it is filtered; 0 is a helix whose hub vortex is watched.",
        ),
        key(
            "noise_from_hz",
            from(0.0, 10.0),
            "Hz",
            Value("0"),
            "Lower end of the noise's band; 0 keeps slow changes.",
        ),
        key("noise_to_hz", above(0.0, 10.0), "Hz", Value("0.03"), "Upper end of the noise's band."),
        key(
            "noise_start",
            from(0.0, 1e6),
            "s",
            Otherwise("`start`"),
            "Time at which the noise fades in, over one period of the helix.",
        ),
        key(
            "noise_seed",
            Holds::Whole { least: 0, most: 1 << 32 },
            "",
            Value("1"),
            "Another noise for every seed.",
        ),
        LIDAR,
        VORTEX_FILTER,
        VORTEX_CENTRE,
        VORTEX_INTERVAL,
        TILT_PHASE,
        AZIMUTH_OFFSET,
        START,
        BASE[0],
        BASE[1],
        BASE[2],
        BASE[3],
        BASE[4],
    ],
};

impl Named for ProbingKind {
    fn name(&self) -> &'static str {
        "probing"
    }
}

impl ControllerKind for ProbingKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        let [lower, upper] = ["noise_from_hz", "noise_to_hz"].map(|key| values.number(key));
        let band = (lower >= upper).then(|| Objection {
            key: Some("noise_from_hz"),
            message: format!("= {lower} Hz is not below `noise_to_hz` = {upper} Hz"),
            label: "no band is left",
            fix: "lower `noise_from_hz`, or raise `noise_to_hz`".to_owned(),
        });
        let noise = values.optional_number("noise_start");
        let late = [
            starts_too_late(values, place.duration),
            noise.and_then(|start| too_late("noise_start", start, place.duration)),
            no_lidar(values, place),
        ];
        late.into_iter().flatten().chain(band).collect()
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let values = control.values();
        let frame = HelixFrame { sense: sense(values), rate: site.rate(values.number("strouhal")) };
        let band = ["noise_from_hz", "noise_to_hz"].map(|key| TAU * values.number(key));
        let start = values.number("start");
        let [helix, noise] = ["amplitude_deg", "noise_amplitude_deg"].map(|key| values.angle(key));
        // A swashplate stands still where blades go round.
        let going_round = match site.rotor.swashplate {
            Some(_) => 0.0,
            None => site.constants.rated_rotor_speed,
        };
        let turning = match frame.sense {
            Sense::CounterClockwise => going_round + frame.rate,
            Sense::Clockwise => (going_round - frame.rate).abs(),
        };
        let most = site.rotor.pitch_actuator.maximum_rate;
        Asked { helix, noise, turning, upper: band[1] }.follows(most)?;
        let probing = Probing {
            frame,
            helix: frame.open_helix(helix, values.angle("phase_deg")),
            noise,
            azimuth_offset: values.angle("azimuth_offset_deg"),
            starts: [start, values.optional_number("noise_start").unwrap_or(start)],
            sources: [0, 1]
                .map(|channel| BinaryNoise::new(values.number("noise_seed") as u64, channel, band)),
            commands: [0.0; 2],
            watch: Watch::of(values, site, frame)?,
        };
        Ok(probing.on_top_of(base(control, site)?))
    }

    fn helix(&self, control: &Control) -> Option<(Sense, f64)> {
        let values = control.values();
        Some((sense(values), values.number("strouhal")))
    }

    fn hosted(&self, control: &Control) -> Option<Hosted> {
        Hosted::of(control.values())
    }

    fn outcome_channels(&self, _: &Control, _: usize) -> Vec<Channel> {
        CHANNELS.to_vec()
    }

    fn outcome(&self, _: &Control, record: &dyn TurbineRecord) -> Result<Outcome, MissingChannel> {
        Ok(Outcome { findings: findings(record)?, ..Outcome::default() })
    }
}

/// What is asked of a blade's pitch.
struct Asked {
    /// Amplitude of the helix, and of the noise on each of its axes (rad).
    helix: f64,
    noise: f64,
    /// Rate of the helix frame as the actuator sees it: rated rotor speed and the helix's (rad/s).
    turning: f64,
    /// Upper end of the noise's band (rad/s).
    upper: f64,
}

impl Asked {
    /// Fastest pitch (rad/s) under the helix and a sine on each axis at the band's upper end: with
    /// r² + (r′/ω)² = 2 a², r the length of both and r′ its rate, Ω r + r′ is at most √2 a √(Ω² + ω²).
    fn rate(&self) -> f64 {
        self.helix * self.turning + SQRT_2 * self.noise * self.turning.hypot(self.upper)
    }

    /// Whether an actuator of the rate `most` (rad/s) follows; one without noise is a helix, which has no
    /// band to be lowered.
    ///
    /// # Errors
    /// [`ControlError::NoiseTooFast`].
    fn follows(&self, most: f64) -> Result<(), ControlError> {
        let asked = self.rate();
        if self.noise == 0.0 || asked <= most {
            return Ok(());
        }
        let left = ((most - self.helix * self.turning) / (SQRT_2 * self.noise)).max(0.0);
        let frequency = (left * left - self.turning * self.turning).max(0.0).sqrt() / TAU;
        // Rounded down, so that what is printed can be taken.
        let frequency = (100.0 * frequency).floor() / 100.0;
        Err(ControlError::NoiseTooFast {
            amplitude_deg: self.noise.to_degrees(),
            frequency: self.upper / TAU,
            helix_deg: self.helix.to_degrees(),
            asked_deg: asked.to_degrees(),
            most_deg: most.to_degrees(),
            fix: if frequency > 0.0 {
                format!("lower noise_to_hz to {frequency:.2} Hz or less, or an amplitude")
            } else {
                "lower noise_amplitude_deg or amplitude_deg".to_owned()
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_no_faster_than_the_actuator() {
        let [helix, noise, most] = [3.0_f64, 1.0, 8.0].map(f64::to_radians);
        let asked = |hertz: f64| Asked { helix, noise, turning: 1.4, upper: TAU * hertz };
        // By hand: 3·1.4 + √2·√(1.4² + (2π·0.1)²), °/s.
        assert!((asked(0.1).rate().to_degrees() - 6.370_2).abs() < 1e-4);
        assert!(asked(0.2).follows(most).is_ok());
        let error = asked(10.0).follows(most).expect_err("93°/s").to_string();
        assert!(error.contains("ask for 93.1°/s") && error.contains("has 8.0°/s"), "{error}");
        assert!(error.contains("noise_to_hz to 0.36 Hz or less"), "{error}");
        assert!(asked(0.36).follows(most).is_ok() && asked(0.37).follows(most).is_err());
        // A helix that leaves nothing for noise.
        let wide = Asked { helix: 2.0 * helix, ..asked(0.1) };
        let error = wide.follows(most).expect_err("8.4°/s alone").to_string();
        assert!(error.contains("lower noise_amplitude_deg or amplitude_deg"), "{error}");
        // No noise is never too fast.
        assert!(Asked { noise: 0.0, ..asked(10.0) }.follows(most).is_ok());
    }

    /// No pair of sines on the axes makes a blade pitch faster, and one comes near it.
    #[test]
    fn no_sines_pitch_faster_than_what_is_said() {
        let asked = Asked { helix: 0.05, noise: 0.02, turning: 1.4, upper: 0.6 };
        let fastest = |lag: f64| {
            let pitch = |t: f64| {
                let (sine, cosine) = (asked.turning * t).sin_cos();
                let [tilt, yaw] = [0.0, lag].map(|lag| asked.noise * (asked.upper * t + lag).cos());
                asked.helix * cosine + tilt * cosine + yaw * sine
            };
            let step = 1e-3;
            let rates = (0..400_000).map(|i| {
                let t = f64::from(i) * step;
                ((pitch(t + step) - pitch(t)) / step).abs()
            });
            rates.fold(0.0, f64::max)
        };
        let found = [0.0, 0.7, 1.5, -0.7, -1.5, 3.0].map(fastest);
        assert!(found.iter().all(|rate| *rate <= asked.rate() * (1.0 + 1e-6)), "{found:?}");
        assert!(found.iter().any(|rate| *rate >= 0.95 * asked.rate()), "{found:?}");
    }
}
