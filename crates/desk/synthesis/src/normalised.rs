//! A generalised plant with D12 = (0; I), D21 = (0, I) and D22 = 0, and the way back.

use crate::SynthesisError;
use crate::generalised_plant::{GeneralisedPlant, Parts};
use faer::Mat;
use lti::matrices::dense::{identity, part, singular_decomposition};
use lti::matrices::{MatrixError, StateSpace, feedback};

/// Errors and disturbances turned, controls and measurements scaled.
///
/// Source: Zhou, Doyle and Glover, "Robust and Optimal Control", 1996, §17.2.
pub(crate) struct Normalised {
    pub(crate) a: Mat<f64>,
    pub(crate) parts: Parts,
    /// u = `to_controls` ũ.
    to_controls: Mat<f64>,
    /// ỹ = `of_measurements` y.
    of_measurements: Mat<f64>,
    d22: Mat<f64>,
}

impl Normalised {
    /// Of a plant whose D12 and D21 have full rank.
    pub(crate) fn new(plant: &GeneralisedPlant) -> Result<Self, SynthesisError> {
        let parts = plant.parts();
        let (turn_z, to_controls) = turned(&parts.d12)?;
        let (turn_w, to_measurements) = turned(&parts.d21.transpose().to_owned())?;
        let of_measurements = to_measurements.transpose().to_owned();
        Ok(Self {
            a: plant.system.a.clone(),
            parts: Parts {
                b1: &parts.b1 * &turn_w,
                b2: &parts.b2 * &to_controls,
                c1: turn_z.transpose() * &parts.c1,
                c2: &of_measurements * &parts.c2,
                d11: turn_z.transpose() * &parts.d11 * &turn_w,
                d12: turn_z.transpose() * &parts.d12 * &to_controls,
                d21: &of_measurements * &parts.d21 * &turn_w,
                d22: Mat::zeros(plant.measurements, plant.controls),
            },
            to_controls,
            of_measurements,
            d22: parts.d22,
        })
    }

    /// The controller of the plant itself: scaled back, and around the D22 that was left out.
    pub(crate) fn restored(&self, controller: &StateSpace) -> Result<StateSpace, MatrixError> {
        let scaled = StateSpace::new(
            controller.a.clone(),
            &controller.b * &self.of_measurements,
            &self.to_controls * &controller.c,
            &self.to_controls * &controller.d * &self.of_measurements,
            controller.interval,
        );
        if self.d22.norm_max() == 0.0 {
            return Ok(scaled);
        }
        feedback(&scaled, &StateSpace::gain(self.d22.clone(), controller.interval))
    }
}

/// An orthogonal U and an invertible M with Uᵀ D M = (0; I), for D of full column rank.
fn turned(d: &Mat<f64>) -> Result<(Mat<f64>, Mat<f64>), MatrixError> {
    let (rows, columns) = (d.nrows(), d.ncols());
    let (left, values, right) = singular_decomposition(d)?;
    // The directions that D does not reach come first; the others are turned so that the block is I.
    let reached = part(&left, 0, 0, rows, columns);
    let reached = &reached * right.transpose();
    let unreached = rows - columns;
    let whole = Mat::from_fn(rows, rows, |i, j| {
        if j < unreached { left[(i, columns + j)] } else { reached[(i, j - unreached)] }
    });
    let inverse = Mat::from_fn(columns, columns, |i, j| {
        (0..columns).map(|k| right[(i, k)] * right[(j, k)] / values[k]).sum::<f64>()
    });
    debug_assert!((whole.transpose() * &whole - identity(rows)).norm_l2() < 1e-8);
    Ok((whole, inverse))
}
