//! What is found of a helix in its own frame: what was pitched, where the hub vortex was, and how a lidar
//! loop fared.

use crate::outcome::{MissingChannel, TurbineRecord};
use basis::Channel;
use basis::channels::{
    HELIX_TILT, HELIX_YAW, HUB_VORTEX_TILT, HUB_VORTEX_TRUST, HUB_VORTEX_YAW, LOOP_SHARE,
};
use basis::records::Finding;

/// The channels that are read: tilt and yaw that are pitched, and those of the hub vortex, in the helix
/// frame.
pub(crate) const CHANNELS: [Channel; 4] = [HUB_VORTEX_TILT, HUB_VORTEX_YAW, HELIX_TILT, HELIX_YAW];

/// Names of the means of the hub vortex, which a later run can take as its reference.
pub const MEAN_HUB_VORTEX: [&str; 2] = ["hub-vortex-tilt", "hub-vortex-yaw"];

/// Share of the loop (–) below which it counts as open.
const CLOSED: f64 = 0.99;

fn found(name: &str, value: f64, unit: &str, about: &str) -> Finding {
    Finding {
        name: name.to_owned(),
        value: Some(value),
        unit: unit.to_owned(),
        about: about.to_owned(),
    }
}

/// The mean of `samples`; of none it is zero.
fn mean(samples: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = samples.len().max(1) as f64;
    samples.sum::<f64>() / n
}

/// Means of the hub vortex in the helix frame, how far it was off them, and what was pitched there.
///
/// # Errors
/// [`MissingChannel`] for records without it.
pub(crate) fn findings(record: &dyn TurbineRecord) -> Result<Vec<Finding>, MissingChannel> {
    let [up, right] = [record.column(&CHANNELS[0])?, record.column(&CHANNELS[1])?];
    let means = [up, right].map(|samples| mean(samples.iter().copied()));
    let squares = up.iter().zip(right);
    let squares = squares.map(|(up, right)| (up - means[0]).powi(2) + (right - means[1]).powi(2));
    let [tilt, yaw] = [record.column(&CHANNELS[2])?, record.column(&CHANNELS[3])?];
    let lengths = tilt.iter().zip(yaw).map(|(tilt, yaw)| tilt.hypot(*yaw));
    let [pitch_tilt, pitch_yaw] = [tilt, yaw].map(|samples| mean(samples.iter().copied()));
    Ok(vec![
        found(
            MEAN_HUB_VORTEX[0],
            means[0],
            "m",
            "mean of the hub vortex in the helix frame, upwards",
        ),
        found(MEAN_HUB_VORTEX[1], means[1], "m", "the same to the right, looking downwind"),
        found(
            "hub-vortex-spread",
            mean(squares).sqrt(),
            "m",
            "root mean square of its distance from that mean",
        ),
        found(
            "helix-pitch",
            mean(lengths).to_degrees(),
            "deg",
            "mean magnitude of the tilt and yaw that were pitched, in the helix frame",
        ),
        found("helix-tilt", pitch_tilt.to_degrees(), "deg", "mean of that tilt"),
        found("helix-yaw", pitch_yaw.to_degrees(), "deg", "mean of that yaw"),
    ])
}

/// Where the hub vortex was to be, `reference` (m), and how far the mean of it in `findings` is from there.
pub(super) fn of_reference([tilt, yaw]: [f64; 2], findings: &[Finding]) -> [Finding; 3] {
    let [up, right] = MEAN_HUB_VORTEX.map(|name| {
        let finding = findings.iter().find(|finding| finding.name == name);
        finding.and_then(|finding| finding.value).unwrap_or(f64::NAN)
    });
    let off = (up - tilt).hypot(right - yaw);
    [
        found("reference-tilt", tilt, "m", "where the hub vortex was to be, upwards"),
        found("reference-yaw", yaw, "m", "the same to the right"),
        found("reference-distance", off, "m", "distance of its mean from there"),
    ]
}

/// How long the loop was open and its lidar blind, which is surer than `least_trust` (–) of the hub vortex
/// else; and a warning where it was open.
///
/// # Errors
/// [`MissingChannel`] for records without it.
pub(super) fn of_loop(
    record: &dyn TurbineRecord,
    least_trust: f64,
) -> Result<(Vec<Finding>, Option<String>), MissingChannel> {
    let shares = record.column(&LOOP_SHARE)?;
    let trust = record.column(&HUB_VORTEX_TRUST)?;
    let one_where = |is_so: bool| f64::from(u8::from(is_so));
    let open = mean(shares.iter().map(|share| one_where(*share < CLOSED)));
    let opened = shares.windows(2).filter(|pair| pair[0] >= CLOSED && pair[1] < CLOSED).count();
    let blind = mean(trust.iter().map(|trust| one_where(*trust < least_trust)));
    let trust = mean(trust.iter().copied());
    let findings = vec![
        found(
            "loop-open-share",
            open,
            "–",
            "share of the time in which the loop was open, fading out included",
        ),
        found("loop-openings", opened as f64, "–", "how often it opened"),
        found(
            "lidar-blind-share",
            blind,
            "–",
            "share of the time in which the confidence in the hub vortex was below `least_trust`",
        ),
        found("hub-vortex-confidence", trust, "–", "mean of that confidence"),
    ];
    let warning = (open > 0.0).then(|| {
        format!(
            " had its lidar loop open for {:.1} % of the analysed time: the lidar did not see the hub vortex (confidence {trust:.2} on the mean), `loop_start` came later, or `anemometer` showed a family of laws no wind yet",
            100.0 * open
        )
    });
    Ok((findings, warning))
}

/// What the filtered wind `measured` (m/s) tells of a family made at `speeds` (m/s), ascending.
pub(super) fn of_wind(speeds: &[f64], measured: &[f64]) -> (Finding, Option<String>) {
    let n = measured.len().max(1) as f64;
    let [slowest, fastest] =
        [speeds.first(), speeds.last()].map(|speed| speed.copied().unwrap_or(f64::NAN));
    let n_beyond = measured.iter().filter(|wind| **wind < slowest || **wind > fastest).count();
    let beyond = n_beyond as f64 / n;
    let finding = found(
        "loop-wind",
        mean(measured.iter().copied()),
        "m/s",
        "mean of the filtered wind speed by which the loop's laws were blended",
    );
    let warning = (beyond > 0.0).then(|| {
        format!(
            " measured a wind outside the {slowest} to {fastest} m/s of its lidar loop's laws for {:.1} % of the analysed time: the first or the last law ran alone then",
            100.0 * beyond
        )
    });
    (finding, warning)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Columns by the names of their channels.
    struct Columns(BTreeMap<String, Vec<f64>>);

    impl TurbineRecord for Columns {
        fn column(&self, channel: &Channel) -> Result<&[f64], MissingChannel> {
            let found = self.0.get(channel.name.as_ref()).map(Vec::as_slice);
            found.ok_or_else(|| MissingChannel(channel.name.to_string()))
        }

        fn interval(&self) -> f64 {
            0.1
        }

        fn n_blades(&self) -> usize {
            3
        }
    }

    fn columns(values: &[(&Channel, [f64; 4])]) -> Columns {
        let column =
            |(channel, values): &(&Channel, [f64; 4])| (channel.name.to_string(), values.to_vec());
        Columns(values.iter().map(column).collect())
    }

    fn values(findings: &[Finding]) -> BTreeMap<&str, f64> {
        let value = |finding: &'_ Finding| finding.value.expect("a number");
        findings.iter().map(|finding| (finding.name.as_str(), value(finding))).collect()
    }

    #[test]
    fn pitch_and_hub_vortex_are_told_by_their_means() {
        let record = columns(&[
            (&CHANNELS[0], [1.0, 3.0, 1.0, 3.0]),
            (&CHANNELS[1], [5.0, 5.0, 5.0, 5.0]),
            // Of 3° and 5° in turn, though their mean is shorter.
            (&CHANNELS[2], [3.0, -3.0, 3.0, -3.0].map(f64::to_radians)),
            (&CHANNELS[3], [0.0, 4.0, 0.0, 4.0].map(f64::to_radians)),
        ]);
        let found = findings(&record).expect("all channels");
        let told = values(&found);
        for (name, expected) in [
            ("hub-vortex-tilt", 2.0),
            ("hub-vortex-yaw", 5.0),
            ("hub-vortex-spread", 1.0),
            ("helix-pitch", 4.0),
            ("helix-tilt", 0.0),
            ("helix-yaw", 2.0),
        ] {
            assert!((told[name] - expected).abs() < 1e-12, "{name}: {}", told[name]);
        }
        let beside = of_reference([-1.0, 1.0], &found);
        assert!((values(&beside)["reference-distance"] - 5.0).abs() < 1e-12);
        assert!(findings(&columns(&[(&CHANNELS[0], [0.0; 4])])).is_err());
    }

    #[test]
    fn a_loop_tells_how_long_it_was_open_and_blind() {
        let record = columns(&[
            (&LOOP_SHARE, [1.0, 0.5, 1.0, 0.0]),
            (&HUB_VORTEX_TRUST, [0.9, 0.05, 0.9, 0.95]),
        ]);
        let (found, warning) = of_loop(&record, 0.1).expect("all channels");
        let told = values(&found);
        assert_eq!([told["loop-open-share"], told["loop-openings"]], [0.5, 2.0]);
        assert_eq!(told["lidar-blind-share"], 0.25);
        assert!((told["hub-vortex-confidence"] - 0.7).abs() < 1e-12);
        assert!(warning.is_some_and(|warning| warning.contains("50.0 %")));
        let closed = columns(&[(&LOOP_SHARE, [1.0; 4]), (&HUB_VORTEX_TRUST, [0.9; 4])]);
        assert_eq!(of_loop(&closed, 0.1).expect("all channels").1, None);
    }

    #[test]
    fn wind_beyond_a_family_is_told_with_its_share_of_the_time() {
        let speeds = [8.0, 10.0, 12.0];
        // At the ends the first and the last law run as they were made.
        let (found, warning) = of_wind(&speeds, &[8.0, 9.0, 12.0, 10.0]);
        assert_eq!((found.name.as_str(), found.value), ("loop-wind", Some(9.75)));
        assert_eq!((found.unit.as_str(), warning), ("m/s", None));
        let (found, warning) = of_wind(&speeds, &[7.5, 9.0, 12.5, 12.5, 8.5]);
        assert_eq!(found.value, Some(10.0));
        let warning = warning.expect("it was beyond");
        assert!(warning.contains("outside the 8 to 12 m/s"), "{warning}");
        assert!(warning.contains("for 60.0 % of the analysed time"), "{warning}");
    }
}
