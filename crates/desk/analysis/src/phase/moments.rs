//! Moments of the rotor in the fixed frame over time, from those of its blades.

use super::lines::fixed_frame;
use crate::AnalysisError;
use basis::FixedFrame;

/// Fixed-frame moments (unit of the blades' moments) over time, from the `azimuths` of blade 1 (rad) and one
/// column of moments for each blade, all of one length. van Vondelen et al. (2025), Eq. 4.
///
/// # Errors
/// [`AnalysisError::TooFewBlades`] below three blades; [`AnalysisError::UnequalLengths`];
/// [`AnalysisError::NotFinite`] for a gap in azimuths or moments.
pub fn fixed_frame_moments(
    azimuths: &[f64],
    blades: &[&[f64]],
) -> Result<Vec<FixedFrame>, AnalysisError> {
    if blades.len() < 3 {
        return Err(AnalysisError::TooFewBlades { n_blades: blades.len() });
    }
    if let Some(odd) = blades.iter().find(|column| column.len() != azimuths.len()) {
        return Err(AnalysisError::UnequalLengths { first: azimuths.len(), second: odd.len() });
    }
    azimuths
        .iter()
        .enumerate()
        .map(|(index, azimuth)| {
            let fixed = fixed_frame(*azimuth, blades.len(), |blade| blades[blade][index]);
            let finite = (fixed.average + fixed.tilt + fixed.yaw).is_finite();
            finite.then_some(fixed).ok_or(AnalysisError::NotFinite { index })
        })
        .collect()
}
