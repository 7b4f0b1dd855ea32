//! The helix of a wake's centre: how far it swings and with which phase.
//!
//! A wake that moves left leaves more wind on the right, one that sinks more wind above. So the phase of its
//! centre is given as the wind phase that it brings (see [`phase`](crate::phase)): with the excitation's
//! angle θ and the yaw's lead λ,
//!
//! ```text
//! y = mean + r sin(θ + λ + φ)        z = mean − r sin(θ + φ)
//! ```

use super::{PhasePlane, centre, centre_line};
use crate::AnalysisError;
use crate::phase::Reference;
use basis::angle::wrap_to_turn;
use basis::records::PlaneAxes;
use basis::{Matrix3, Vector3};
use realfft::num_complex::Complex64;

/// Swing of the wake's centre line at one distance, in the plane's own direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swing {
    /// Distance along the wind, farm frame (m).
    pub x: f64,
    /// Mean of the centre's y, or of its z in a streamwise plane, farm frame (m).
    pub mean: f64,
    /// Amplitude r of its first harmonic over the excitation (m).
    pub amplitude: f64,
    /// Its phase φ (rad, [0, 2π)).
    pub phase: f64,
}

/// Path of the wake's centre across the wind over one period of the excitation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    /// Its middle, y and z, farm frame (m).
    pub mean: [f64; 2],
    /// Radius of the circle that it describes in the excitation's sense (m).
    pub radius: f64,
    /// Phase φ on that circle (rad, [0, 2π)).
    pub phase: f64,
    /// Radius of the circle in the other sense (m); the path is an ellipse of half axes `radius` ±
    /// `counter_radius`.
    pub counter_radius: f64,
}

/// Swing of the wake's centre line at each x of the horizontal or streamwise `planes`, in one sense with
/// `reference`.
///
/// Centres as in [`centre_line`], with a Gaussian of `width` (m); then a least-squares fit of mean and first
/// harmonic over the phases.
///
/// # Errors
/// Those of [`centre_line`]; [`AnalysisError::TooShort`] with fewer than three phases;
/// [`AnalysisError::UnequalLengths`] when planes differ in their points.
pub fn swing(
    planes: &[PhasePlane],
    reference: &Reference,
    free_stream: impl Fn(f64) -> f64,
    width: f64,
) -> Result<Vec<Swing>, AnalysisError> {
    let fit = Fit::new(planes)?;
    let lines: Vec<Vec<[f64; 2]>> = planes
        .iter()
        .map(|phase| centre_line(&phase.plane, &free_stream, width))
        .collect::<Result<_, _>>()?;
    if let Some(odd) = lines.iter().find(|line| line.len() != lines[0].len()) {
        return Err(AnalysisError::UnequalLengths { first: lines[0].len(), second: odd.len() });
    }
    let sideways = planes[0].plane.axes == PlaneAxes::Horizontal;
    let (sign, lead) = if sideways { (1.0, reference.sense.yaw_lead()) } else { (-1.0, 0.0) };
    let at = |index: usize| {
        let [mean, cosine, sine] = fit.harmonic(|phase| lines[phase][index][1]);
        let phase = wrap_to_turn((sign * cosine).atan2(sign * sine) - lead);
        Swing { x: lines[0][index][0], mean, amplitude: cosine.hypot(sine), phase }
    };
    Ok((0..lines[0].len()).map(at).collect())
}

/// Path of the wake's centre in the crosswind `planes`, in the sense of `reference` and against it.
///
/// Centres as in [`centre`], with a Gaussian of `width` (m).
/// Limits: a plane that ends at the ground cuts the wake there; a wake of deviation 0.4 D about a hub at 0.6
/// D seems to swing some 6 % less in the vertical than it does, which shows as a `counter_radius` of 3 % of
/// the radius.
///
/// # Errors
/// Those of [`centre`]; [`AnalysisError::TooShort`] with fewer than three phases.
pub fn orbit(
    planes: &[PhasePlane],
    reference: &Reference,
    free_stream: impl Fn(f64) -> f64,
    width: f64,
) -> Result<Orbit, AnalysisError> {
    let fit = Fit::new(planes)?;
    let centres: Vec<[f64; 2]> = planes
        .iter()
        .map(|phase| centre(&phase.plane, &free_stream, width))
        .collect::<Result<_, _>>()?;
    let [y, y_cosine, y_sine] = fit.harmonic(|phase| centres[phase][0]);
    let [z, z_cosine, z_sine] = fit.harmonic(|phase| centres[phase][1]);
    // The centre as a number that turns forwards with the excitation in its own sense: ±(y − mean) − i (z −
    // mean).
    let side = reference.sense.yaw_lead().signum();
    let cosine = Complex64::new(side * y_cosine, -z_cosine);
    let sine = Complex64::new(side * y_sine, -z_sine);
    let (forward, backward) =
        (0.5 * (cosine - Complex64::i() * sine), 0.5 * (cosine + Complex64::i() * sine));
    Ok(Orbit {
        mean: [y, z],
        radius: forward.norm(),
        phase: wrap_to_turn(forward.arg()),
        counter_radius: backward.norm(),
    })
}

/// Least-squares fit of a mean and the first harmonic to values at the phases of planes.
struct Fit {
    rows: Vec<Vector3>,
    inverse: Matrix3,
}

impl Fit {
    fn new(planes: &[PhasePlane]) -> Result<Self, AnalysisError> {
        if planes.len() < 3 {
            return Err(AnalysisError::TooShort { n_samples: planes.len(), needed: 3 });
        }
        let rows: Vec<Vector3> = planes
            .iter()
            .map(|plane| Vector3::new(1.0, plane.phase.cos(), plane.phase.sin()))
            .collect();
        let normal = rows.iter().fold(Matrix3::ZERO, |sum, row| {
            sum + Matrix3::from_cols(*row * row.x, *row * row.y, *row * row.z)
        });
        Ok(Self { rows, inverse: normal.inverse() })
    }

    /// Mean, cosine and sine part of `value` over the phases, in its unit.
    fn harmonic(&self, value: impl Fn(usize) -> f64) -> [f64; 3] {
        let right = |(phase, row): (usize, &Vector3)| value(phase) * *row;
        (self.inverse * self.rows.iter().enumerate().map(right).sum::<Vector3>()).to_array()
    }
}
