//! Estimation of the helix in the wind at a rotor: its amplitude and phases, from the moments at the blade
//! roots.
//!
//! After van Vondelen et al. (2025), "Synchronized Helix wake mixing control", Wind Energ. Sci. 10, 2411: the
//! wind that meets the rotor has a tilt and a yaw component that oscillate at the excitation rate, which the
//! rotating blades sample. A blade-element model with a wake predicts the blade moments; an extended Kalman
//! filter estimates the wind for which they equal the measured ones. Pitch is an input of the model, so the
//! rotor may pitch in any way meanwhile.

mod calibration;
mod clock;
mod estimate;
mod estimator;
mod filter;
mod flap;
mod leftover;
mod linear;
mod model;
mod options;
mod preview;
mod rotor;
mod settings;
mod smoother;
mod state_estimate;
mod transition;
mod true_wave;
mod trust;
pub mod tuning;
mod wave;
mod weight;

pub use calibration::{Calibration, calibrate};
pub use estimate::{HelixEstimate, Status};
pub use estimator::{HelixEstimator, HelixEstimatorState};
pub use linear::{LinearEstimator, LinearEstimatorState, OperatingPoint};
pub use model::MeasurementModel;
pub use options::{Adaptation, Eddies, HelixOptions, Jacobian, Measurement, Noise, Rotor, Wake};
pub use preview::{PreviewEstimate, PreviewEstimator, PreviewSettings, PreviewState};
pub use settings::HelixSettings;
pub use smoother::smooth;
pub use trust::Trust;
pub use wave::{Axis, Form};
