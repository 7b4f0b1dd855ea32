//! The rotors of a prepared study against blade-element momentum, on its grid; and how fast this machine is.

use crate::StudyError;
use crate::air;
use crate::observer::Observer;
use crate::prepared::Prepared;
use farm::assemble::TurbineModel;
use farm::case::{Control, Run};
use farm::self_check::{SelfCheck, SelfCheckError, TIMED, Tunnel, self_check, updates_per_second};
use farm::{Unrecorded, assemble};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Cells of a domain up to which a study is timed in it (–): it takes a moment to fill.
const MOST_TIMED: usize = 2_000_000;

/// What the self-check of a study's rotors found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SelfChecked {
    /// Slowest rate of cell updates met (1/s); absent where no flow is resolved.
    pub updates_per_second: Option<f64>,
    /// Of each model that falls short.
    pub warnings: Vec<String>,
}

impl Prepared {
    /// Checks each turbine model against blade-element momentum; a break when `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError::SelfCheck`] when a check cannot be made; a model that falls short is a warning.
    pub fn self_check(
        &self,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<ControlFlow<(), SelfChecked>, StudyError> {
        let mut found = SelfChecked::default();
        if !self.case.flow.solver.needs_self_check {
            return Ok(ControlFlow::Continue(found));
        }
        let mut checked: Vec<(&str, Option<&str>, f64)> = Vec::new();
        for (index, placement) in self.case.turbines.iter().enumerate() {
            let (model, spacing) = (&self.models[index], self.plan.spacing_at(index));
            let machine = (model.definition.name.as_str(), placement.discon.as_deref(), spacing);
            if checked.contains(&machine) {
                continue;
            }
            checked.push(machine);
            let check = match self.check(index, stop, observer) {
                Err(SelfCheckError::BrokenOff) => return Ok(ControlFlow::Break(())),
                check => check?,
            };
            observer.checked(&check);
            if !check.passes() {
                let warning = warning(&model.definition.name, &check);
                observer.warned(&warning);
                found.warnings.push(warning);
            }
            let speed = check.updates_per_second;
            let slowest = found.updates_per_second.map_or(speed, |slowest| slowest.min(speed));
            found.updates_per_second = Some(slowest);
        }
        Ok(ControlFlow::Continue(found))
    }

    /// What can be known without a check: how fast this machine makes `run`, one of the case's, timed for a
    /// fraction of a second; in a large domain, whose turbines count for little, how fast it moves the air
    /// around the first of them.
    ///
    /// # Errors
    /// [`StudyError`] when the flow cannot be set up, or the turbines cannot be put together.
    pub(crate) fn timed(&self, run: &Run) -> Result<SelfChecked, StudyError> {
        let mut found = SelfChecked::default();
        let Some(model) = self.models.first().filter(|_| self.case.flow.solver.needs_self_check)
        else {
            return Ok(found);
        };
        if self.plan.cells() <= MOST_TIMED {
            found.updates_per_second = self.timed_in_place(run)?;
        } else {
            let diameter = model.definition.rotor_diameter();
            let tunnel = Tunnel::for_timing(diameter, &self.plan.alone(0));
            let speed =
                updates_per_second(model, &self.case.wind, &tunnel, self.case.flow.threads)?;
            found.updates_per_second = Some(speed);
        }
        Ok(found)
    }

    /// Cell updates a second (1/s) of the farm of `run` in its own domain: all of its turbines under baseline
    /// control, in wind without turbulence, of which nothing is kept. None where it breaks down at once.
    ///
    /// # Errors
    /// Those of [`timed`](Self::timed).
    fn timed_in_place(&self, run: &Run) -> Result<Option<f64>, StudyError> {
        let air = air::begin(self, &self.mean_inflow, &|_| ControlFlow::Continue(()))?;
        // What others' libraries do, and what is yet to be identified, is left out.
        let plain = |control: &Control| {
            if control.is_there() { Control::baseline() } else { control.clone() }
        };
        let run = Run { control: run.control.iter().map(plain).collect(), ..run.clone() };
        let models: Vec<TurbineModel> =
            self.models.iter().cloned().map(TurbineModel::without_individual_pitch).collect();
        let mut farm = assemble::farm(&self.case, &run, &self.plan, &models, air)?;
        let mut advance = || farm.advance(&mut Unrecorded).is_ok();
        // The first step touches memory for the first time.
        let mut is_sound = advance();
        // Grids of longer steps make theirs now and then: as often as they do in a run.
        let in_one = 1 << self.plan.depth();
        for _ in 1..in_one {
            is_sound = is_sound && advance();
        }
        let started = Instant::now();
        let mut n_steps = 0;
        while is_sound && (n_steps % in_one != 0 || n_steps == 0 || started.elapsed() < TIMED) {
            is_sound = advance();
            n_steps += 1;
        }
        let updates = self.plan.updates_of_step() * f64::from(n_steps);
        Ok(is_sound.then(|| updates / started.elapsed().as_secs_f64()))
    }

    /// Everything that decides what [`self_check`](Self::self_check) finds: equal for studies that are
    /// checked alike.
    pub(crate) fn checked_alike(&self) -> String {
        let mut wind = self.case.wind.clone();
        wind.seed = 0;
        let machines: Vec<String> =
            self.case.turbines.iter().map(farm::case::Placement::machine).collect();
        let interval = self.plan.interval;
        let cells: Vec<f64> = (0..machines.len()).map(|it| self.plan.spacing_at(it)).collect();
        format!("{wind:?} {machines:?} {cells:?} {interval:?} {:?}", self.case.flow.solver)
    }

    /// The model of turbine number `index` alone in a tunnel with the cells that it stands in and the study's
    /// step.
    fn check(
        &self,
        index: usize,
        stop: &AtomicBool,
        observer: &mut dyn Observer,
    ) -> Result<SelfCheck, SelfCheckError> {
        let model = &self.models[index];
        let what = format!("checking {}", model.definition.name);
        self_check(
            model,
            &self.case.wind,
            &Tunnel::of_study(&self.plan.alone(index)),
            self.case.flow.threads,
            &mut |share| {
                observer.preparing(&what, share);
                if stop.load(Ordering::Relaxed) {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            },
        )
    }
}

fn warning(name: &str, check: &SelfCheck) -> String {
    format!(
        "{name} alone in a steady {:.1} m/s gives {:+.1} % power and {:+.1} % thrust of blade-element momentum on this grid",
        check.wind_speed,
        100.0 * check.power_error(),
        100.0 * check.thrust_error()
    )
}
