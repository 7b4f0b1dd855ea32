//! Where the helix stands that meets a rotor: its amplitude and phases, from the moments at the blade roots.
//!
//! After van Vondelen et al. (2025), "Synchronized Helix wake mixing control", Wind Energ. Sci. 10, 2411: the wind that
//! meets the rotor has a tilt and a yaw component that swing at the excitation's rate; blades feel them as they turn; a
//! blade-element model with a wake says what moments they make of it; an extended Kalman filter finds the wind for which
//! those are the measured ones. Pitch is an input of the model, so the rotor may pitch as it likes meanwhile.

mod belief;
mod calibration;
mod clock;
mod estimate;
mod estimator;
mod filter;
mod flap;
mod linear;
mod model;
mod options;
mod rotor;
mod trust;
pub mod tuning;
mod wave;
mod weight;

pub use calibration::{Calibration, calibrate};
pub use estimate::{HelixEstimate, Status};
pub use estimator::{HelixEstimator, Setting, State};
pub use linear::{LinearEstimator, LinearState, OperatingPoint};
pub use model::MeasurementModel;
pub use options::{Adaptation, Eddies, Jacobian, Measurement, Noise, Options, Rotor, Wake};
pub use trust::Trust;
pub use wave::{Axis, Form};
