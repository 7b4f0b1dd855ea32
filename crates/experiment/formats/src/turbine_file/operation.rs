//! The group `operation`: between which mean wind speeds a turbine works.

use super::error::{Place, Step::Key, TurbineFileError};
use serde::{Deserialize, Serialize};
use turbine::definition;

/// Between which mean wind speeds at hub height a turbine works.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Operation {
    /// Where the figures come from.
    pub source: String,
    /// It starts in this wind (m/s).
    pub cut_in_wind_speed: f64,
    /// It is stopped above this wind (m/s).
    pub cut_out_wind_speed: f64,
}

/// The same in the turbine's definition.
///
/// # Errors
/// [`TurbineFileError::Value`] for a cut-out that does not lie above the cut-in.
pub(super) fn operation_of(
    operation: &Operation,
    place: &Place,
) -> Result<definition::Operation, TurbineFileError> {
    let (cut_in, cut_out) = (operation.cut_in_wind_speed, operation.cut_out_wind_speed);
    if cut_out > cut_in {
        return Ok(definition::Operation { cut_in, cut_out });
    }
    let expected = format!("more than cut_in_wind_speed, {cut_in} m/s");
    let path = [Key("operation"), Key("cut_out_wind_speed")];
    Err(place.error(&path, expected, cut_out.to_string(), "exchange the two, or correct one"))
}
