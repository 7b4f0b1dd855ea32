//! Before a study: does each rotor, alone in a steady wind on this grid, give what blade-element momentum says?

/// Power and thrust of one turbine in steady uniform flow, by the actuator line and by blade-element momentum.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfCheck {
    /// Turbine model.
    pub model: String,
    /// Free-stream speed (m/s).
    pub wind_speed: f64,
    /// Tip-speed ratio held during the check (–).
    pub tip_speed_ratio: f64,
    /// Aerodynamic power of the actuator line (W).
    pub power: f64,
    /// Power of blade-element momentum in the unbounded air that gives the box's speed-up (W).
    pub expected_power: f64,
    /// Thrust of the actuator line (N).
    pub thrust: f64,
    /// Thrust of blade-element momentum, likewise (N).
    pub expected_thrust: f64,
    /// Cell updates a second that the check reached, everything included (1/s).
    pub updates_per_second: f64,
}

/// Difference beyond which the self-check warns (–).
pub const TOLERANCE: f64 = 0.05;

impl SelfCheck {
    /// Power over its expectation, minus one (–).
    pub fn power_error(&self) -> f64 {
        self.power / self.expected_power - 1.0
    }

    /// Thrust over its expectation, minus one (–).
    pub fn thrust_error(&self) -> f64 {
        self.thrust / self.expected_thrust - 1.0
    }

    /// Whether both lie within [`TOLERANCE`].
    pub fn passes(&self) -> bool {
        self.power_error().abs() <= TOLERANCE && self.thrust_error().abs() <= TOLERANCE
    }
}
