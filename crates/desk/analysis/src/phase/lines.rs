//! Line-effective winds: radial lines over a rotor's disc, and their fixed-frame components.
//!
//! Source: van Vondelen et al. (2025), Eq. 23 and Algorithm 2; Moens, Coquelet, Trigaux, Duponcheel,
//! "Handling Individual Pitch Control within an Actuator Disk framework", J. Phys.: Conf. Ser. 2265, 022053,
//! 2022.

use crate::AnalysisError;
use basis::mbc::blade_azimuth;
use basis::{FixedFrame, Vector3};

/// Radial lines over a disc across the wind, from its centre outwards, line 1 upwards and the others after it
/// in the rotor's turning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lines {
    /// Centre of the disc, farm frame (m).
    pub center: Vector3,
    /// Radius of the disc (m).
    pub radius: f64,
    /// Lines (–).
    pub n_lines: usize,
    /// Points on each line (–), in the middles of equal pieces.
    pub n_points: usize,
}

impl Lines {
    /// Sampling points of the wind, farm frame (m): `n_lines × n_points`, the points of a line together.
    pub fn positions(&self) -> Vec<Vector3> {
        let point = |line: usize, point: usize| {
            let (sine, cosine) = line_azimuth(line, self.n_lines).sin_cos();
            let distance = self.radius * (point as f64 + 0.5) / self.n_points as f64;
            self.center + distance * Vector3::new(0.0, -sine, cosine)
        };
        (0..self.n_lines)
            .flat_map(|line| (0..self.n_points).map(move |at| point(line, at)))
            .collect()
    }

    /// On return `means` (`n_lines` long) holds the mean streamwise velocity along each line (m/s) of the
    /// `velocities` (m/s, farm frame) at [`positions`](Self::positions).
    ///
    /// Every piece of a line counts the same, whatever its radius, as in Algorithm 2.
    pub fn means(&self, velocities: &[Vector3], means: &mut [f64]) {
        for (mean, line) in means.iter_mut().zip(velocities.chunks_exact(self.n_points)) {
            *mean = line.iter().map(|velocity| velocity.x).sum::<f64>() / self.n_points as f64;
        }
    }
}

/// Azimuth (rad) of line `line` of `n_lines`: 0 points up, a quarter turn on to the right looking downwind.
pub fn line_azimuth(line: usize, n_lines: usize) -> f64 {
    blade_azimuth(0.0, line, n_lines)
}

/// Fixed-frame components of the line-effective winds `winds` (m/s) at one instant, line 1 pointing up:
/// (2/n) Σ U_i {1/2, cos ψ_i, sin ψ_i}. van Vondelen et al. (2025), Eq. 23.
///
/// Meaningless with fewer than three lines.
pub fn lines_to_fixed_frame(winds: &[f64]) -> FixedFrame {
    fixed_frame(0.0, winds.len(), |line| winds[line])
}

/// The transformation of [`basis::mbc::to_fixed_frame`] for more values than a rotor has blades.
pub(super) fn fixed_frame(azimuth: f64, n: usize, value: impl Fn(usize) -> f64) -> FixedFrame {
    let scale = 2.0 / n as f64;
    (0..n).fold(FixedFrame::default(), |sum, index| {
        let (sine, cosine) = blade_azimuth(azimuth, index, n).sin_cos();
        let scaled = scale * value(index);
        FixedFrame {
            average: sum.average + 0.5 * scaled,
            tilt: sum.tilt + cosine * scaled,
            yaw: sum.yaw + sine * scaled,
        }
    })
}

/// Fixed-frame winds (m/s) over time from one column of winds (m/s) for each line, line 1 pointing up.
///
/// # Errors
/// [`AnalysisError::TooFewLines`] with fewer than three columns, [`AnalysisError::UnequalLengths`] when they
/// differ in length.
pub fn winds_of_lines(columns: &[&[f64]]) -> Result<Vec<FixedFrame>, AnalysisError> {
    let [first, _, _, ..] = columns else {
        return Err(AnalysisError::TooFewLines { n_lines: columns.len() });
    };
    if let Some(odd) = columns.iter().find(|column| column.len() != first.len()) {
        return Err(AnalysisError::UnequalLengths { first: first.len(), second: odd.len() });
    }
    let mut winds = vec![0.0; columns.len()];
    Ok((0..first.len())
        .map(|index| {
            for (wind, column) in winds.iter_mut().zip(columns) {
                *wind = column[index];
            }
            lines_to_fixed_frame(&winds)
        })
        .collect())
}
