//! The air of a precursor under way: a periodic box, and what drives it.

use super::hub_control::HubControl;
use super::{Precursor, PrecursorPlan};
use flow::lattice::atmosphere::LevelStatistics;
use flow::lattice::{Lattice, LatticeError};
use flow::{FlowError, FlowSolver};
use serde::{Deserialize, Serialize};

/// The air of a precursor, stepped under the geostrophic wind that is given, or that holds the wind at hub
/// height.
pub struct AirBox {
    air: Lattice,
    plan: PrecursorPlan,
    hub_height: f64,
    drive: Drive,
    /// What sets it, where the wind at hub height is held.
    control: Option<HubControl>,
}

/// What drives it, as a checkpoint keeps it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// The geostrophic wind, towards east and north (m/s).
    pub geostrophic: [f64; 2],
    /// State of the control that has set it; none without one.
    pub control: Option<[f64; 2]>,
}

impl AirBox {
    /// The air of `precursor`, laid out as `plan`, at time zero.
    ///
    /// # Errors
    /// [`LatticeError`] for air that cannot be set up.
    pub fn new(precursor: &Precursor, plan: &PrecursorPlan) -> Result<Self, LatticeError> {
        let geostrophic = precursor.geostrophic();
        let control = precursor
            .held_wind()
            .map(|wanted| HubControl::new(wanted, precursor.coriolis(), geostrophic));
        Ok(Self {
            air: Lattice::new(precursor.settings(plan), precursor.start())?,
            plan: *plan,
            hub_height: precursor.planes.hub_height,
            drive: Drive { geostrophic, control: control.map(|control| control.state()) },
            control,
        })
    }

    /// Its lattice.
    pub fn air(&self) -> &Lattice {
        &self.air
    }

    /// The same, to be looked at and saved.
    pub fn air_mut(&mut self) -> &mut Lattice {
        &mut self.air
    }

    /// What drives it.
    pub fn drive(&self) -> Drive {
        self.drive
    }

    /// Goes on under `drive`, once its air stands where that was told.
    pub fn restore(&mut self, drive: Drive) {
        if let (Some(control), Some(state)) = (&mut self.control, drive.control) {
            control.set_state(state);
            self.drive = drive;
            self.air.drive(drive.geostrophic);
        }
    }

    /// Makes a step.
    ///
    /// # Errors
    /// [`FlowError`] when the air is no longer valid.
    pub fn step(&mut self) -> Result<(), FlowError> {
        self.air.advance(self.plan.interval, &[])?;
        if self.air.n_steps().is_multiple_of(self.plan.control_stride) {
            self.hold_wind();
        }
        Ok(())
    }

    /// Where the wind at hub height is held, the control of it takes another look, and drives the air. It
    /// goes on while planes are recorded, or a longer spin-up would not have the same bits as one at once.
    fn hold_wind(&mut self) {
        let Some(control) = &mut self.control else { return };
        let (hub, plan) = (self.hub_height, &self.plan);
        let below = (hub / plan.spacing - 0.5).floor().max(0.0) as usize;
        let wind = hub_wind(&self.air.statistics_of(below..below + 2), hub);
        let geostrophic = control.update(wind, plan.time(plan.control_stride));
        self.drive = Drive { geostrophic, control: Some(control.state()) };
        self.air.drive(geostrophic);
    }
}

/// Mean wind towards east and north (m/s) at the height `hub` (m), linear between `levels`.
pub fn hub_wind(levels: &[LevelStatistics], hub: f64) -> [f64; 2] {
    let horizontal = |level: &LevelStatistics| [level.velocity[0], level.velocity[1]];
    let above = levels.partition_point(|level| level.height <= hub);
    let at = |index: usize| horizontal(&levels[index.min(levels.len() - 1)]);
    let (Some(low), true) = (above.checked_sub(1), above < levels.len()) else { return at(above) };
    let share = (hub - levels[low].height) / (levels[above].height - levels[low].height);
    let [low, high] = [at(low), at(above)];
    std::array::from_fn(|axis| low[axis] + share * (high[axis] - low[axis]))
}
