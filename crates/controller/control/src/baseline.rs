//! Torque and collective pitch control: most power below rated, rated power above.

mod constants;

pub use constants::{
    Constants, MinimumPitch, PitchGains, SetPointSmoothing, TorqueGains, greedy_torque_gain,
};
