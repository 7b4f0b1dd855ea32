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
use std::f64::consts::TAU;

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
        let noise = values.angle("noise_amplitude_deg");
        follows(noise, band[1], site.rotor.pitch_actuator.maximum_rate)?;
        let probing = Probing {
            frame,
            helix: frame.open_helix(values.angle("amplitude_deg"), values.angle("phase_deg")),
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

/// Whether an actuator of the rate `most` (rad/s) follows a wave of the size `noise` (rad) at the upper end
/// of its band, `upper` (rad/s).
///
/// # Errors
/// [`ControlError::NoiseTooFast`].
fn follows(noise: f64, upper: f64, most: f64) -> Result<(), ControlError> {
    let asked = noise * upper;
    if asked <= most {
        return Ok(());
    }
    Err(ControlError::NoiseTooFast {
        amplitude_deg: noise.to_degrees(),
        frequency: upper / TAU,
        asked_deg: asked.to_degrees(),
        most_deg: most.to_degrees(),
        // Rounded down, so that what is printed can be taken.
        most_frequency: (100.0 * most / noise / TAU).floor() / 100.0,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_no_faster_than_the_actuator() {
        let [noise, rate] = [5.0_f64, 8.0].map(f64::to_radians);
        assert!(follows(noise, TAU * 0.25, rate).is_ok());
        let error = follows(noise, TAU * 10.0, rate).expect_err("314°/s").to_string();
        assert!(error.contains("asks for 314.2°/s") && error.contains("has 8.0°/s"), "{error}");
        assert!(error.contains("noise_to_hz to 0.25 Hz or less"), "{error}");
        // No noise is never too fast.
        assert!(follows(0.0, TAU * 10.0, rate).is_ok());
    }
}
