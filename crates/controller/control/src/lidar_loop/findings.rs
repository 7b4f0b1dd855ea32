//! What is found of a hub vortex that a controller followed.

use crate::outcome::{MissingChannel, TurbineRecord};
use basis::Channel;
use basis::channels::{HUB_VORTEX_TILT, HUB_VORTEX_YAW};
use basis::records::Finding;

/// The channels that are read: tilt and yaw of the hub vortex in the helix frame.
pub(crate) const CHANNELS: [Channel; 2] = [HUB_VORTEX_TILT, HUB_VORTEX_YAW];

/// Names of the means of [`CHANNELS`], which a later run can take as its reference.
pub const MEAN_HUB_VORTEX: [&str; 2] = ["hub-vortex-tilt", "hub-vortex-yaw"];

/// Means of the hub vortex in the helix frame, and how far it was off them.
///
/// # Errors
/// [`MissingChannel`] for records without it.
pub(crate) fn findings(record: &dyn TurbineRecord) -> Result<Vec<Finding>, MissingChannel> {
    let columns = [record.column(&CHANNELS[0])?, record.column(&CHANNELS[1])?];
    let n = columns[0].len().max(1) as f64;
    let means = columns.map(|samples| samples.iter().sum::<f64>() / n);
    let off = columns
        .iter()
        .zip(means)
        .map(|(samples, mean)| samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n)
        .sum::<f64>()
        .sqrt();
    let found = |name: &str, value, about: &str| Finding {
        name: name.to_owned(),
        value: Some(value),
        unit: "m".to_owned(),
        about: about.to_owned(),
    };
    Ok(vec![
        found(MEAN_HUB_VORTEX[0], means[0], "mean of the hub vortex in the helix frame, upwards"),
        found(MEAN_HUB_VORTEX[1], means[1], "the same to the right, looking downwind"),
        found("hub-vortex-spread", off, "root mean square of its distance from that mean"),
    ])
}
