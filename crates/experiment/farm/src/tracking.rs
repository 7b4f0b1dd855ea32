//! What a controller must know of its rotor to track the tip-speed ratio.

use crate::assemble::TurbineModel;
use crate::case::Solver;
pub use crate::coefficients::coefficient_table;
use control::baseline::TorqueControl;
use std::borrow::Cow;

impl TurbineModel {
    /// The same with what its controller needs to estimate the wind in air of `air_density` (kg/m³): it then
    /// tracks the tip-speed ratio, unless the turbine's file asks for k ω². Takes a fraction of a second.
    pub fn with_estimator(self, air_density: f64) -> Self {
        let inertia = self.definition.drive_train_inertia();
        let table = coefficient_table(&self.definition);
        let constants = self.constants.with_estimator(inertia, air_density, table);
        Self { constants, ..self }
    }

    /// The same with what its controller needs in the air of `solver` with `air_density` (kg/m³): torque is
    /// controlled as the turbine's file asks; otherwise it tracks the tip-speed ratio in prescribed wind, and
    /// follows k ω² in resolved flow, whose studies have been made so.
    pub fn equipped(&self, solver: Solver, air_density: f64) -> Cow<'_, Self> {
        let default = if solver.resolves_induction {
            TorqueControl::KOmegaSquared
        } else {
            TorqueControl::TipSpeedRatio
        };
        let tracks =
            self.constants.torque_control.unwrap_or(default) == TorqueControl::TipSpeedRatio;
        if tracks && self.constants.estimator.is_none() {
            Cow::Owned(self.clone().with_estimator(air_density))
        } else {
            Cow::Borrowed(self)
        }
    }
}
