//! One axis: amplitude and offset of its load, brought to their references by proportional and integral
//! action.

use super::MeanderingControlSettings;
use estimation::phase_locked::Axis;
use serde::{Deserialize, Serialize};

/// Proportional and integral action that holds its sum within bounds; serialises whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Action {
    /// Integral (N m); nothing before the first update.
    integral: Option<f64>,
    /// Sum (N m).
    sum: f64,
}

impl Action {
    /// Takes in `error` (N m) over `interval` (s). The first error moves nothing at once, whatever the
    /// proportional gain; at a bound the integral stays where the sum just reaches it.
    fn update(
        &mut self,
        interval: f64,
        error: f64,
        settings: &MeanderingControlSettings,
        most: f64,
    ) {
        let proportional = settings.proportional * error;
        let integral = self.integral.unwrap_or(-proportional);
        let integral = integral + settings.bandwidth * error * interval;
        self.sum = (integral + proportional).clamp(-most, most);
        self.integral = Some(self.sum - proportional);
    }
}

/// What one axis remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct AxisLoop {
    amplitude: Action,
    offset: Action,
}

impl AxisLoop {
    /// Takes in the estimate of the axis, its amplitude to become `reference` (N m), over `interval` (s).
    /// van Veldhoven (2024), Eqs. 2-38, 2-39.
    pub(super) fn update(
        &mut self,
        interval: f64,
        load: &Axis,
        reference: f64,
        settings: &MeanderingControlSettings,
    ) {
        let gain = settings.decoupling.gain;
        let most = gain * settings.maximum_amplitude;
        self.amplitude.update(interval, reference - load.amplitude, settings, most);
        if settings.maximum_offset > 0.0 {
            self.offset.update(interval, -load.offset, settings, gain * settings.maximum_offset);
        }
    }

    /// Amplitude that is added to the load (N m), negative where it is taken away.
    pub(super) fn added_amplitude(&self) -> f64 {
        self.amplitude.sum
    }

    /// Offset that is added to the load (N m).
    pub(super) fn added_offset(&self) -> f64 {
        self.offset.sum
    }
}
