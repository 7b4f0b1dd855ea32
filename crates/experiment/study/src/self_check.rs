//! The rotors of a prepared study against blade-element momentum, in its air; and how fast this machine is.

use crate::StudyError;
use crate::air;
use crate::observer::Observer;
use crate::prepared::Prepared;
use crate::threads::cores;
use farm::assemble::TurbineModel;
use farm::case::{Control, Run, WindSource};
use farm::self_check::{SelfCheck, SelfCheckError, TIMED, Tunnel, self_check, updates_per_second};
use farm::{Unrecorded, assemble};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Cells of a domain up to which a study is timed in it (–): it takes a moment to fill.
pub(crate) const MOST_TIMED: usize = 2_000_000;
/// Steps that are timed at least where a precursor goes on beside them (–).
const STEPS_BESIDE: u32 = 16;

/// What the self-check of a study's rotors found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SelfChecked {
    /// Slowest rate of cell updates met (1/s), or, where the air has no cells, of steps with wakes of full
    /// length; absent where no flow is resolved.
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
        let mut checked: Vec<(String, f64)> = Vec::new();
        for (index, placement) in self.case.turbines.iter().enumerate() {
            let (model, spacing) = (&self.models[index], self.plan.spacing_at(index));
            let machine = (placement.machine(), spacing);
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
                let warning = self.warning_of(&model.definition.name, &check);
                observer.warned(&warning);
                found.warnings.push(warning);
            }
            // Air without cells is timed with all of its wakes.
            if self.plan.cells() > 0 {
                let speed = check.updates_per_second;
                let slowest = found.updates_per_second.map_or(speed, |slowest| slowest.min(speed));
                found.updates_per_second = Some(slowest);
            }
        }
        Ok(ControlFlow::Continue(found))
    }

    /// What can be known without a check: how fast this machine makes `run`, one of the case's, `n_jobs` of
    /// them at a time, timed for a fraction of a second; in a large domain, whose turbines count for little,
    /// how fast it moves the air around the first of them.
    ///
    /// # Errors
    /// [`StudyError`] when the flow cannot be set up, or the turbines cannot be put together.
    pub(crate) fn timed(&self, run: &Run, n_jobs: usize) -> Result<SelfChecked, StudyError> {
        let mut found = SelfChecked::default();
        let Some(model) = self.models.first().filter(|_| self.case.flow.solver.needs_self_check)
        else {
            return Ok(found);
        };
        // No tunnel has an atmosphere.
        if self.plan.cells() <= MOST_TIMED || self.surroundings.is_some() {
            found.updates_per_second = self.timed_in_place(run, n_jobs)?;
        } else {
            let diameter = model.definition.rotor_diameter();
            let tunnel = Tunnel::for_timing(diameter, &self.plan.alone(0));
            let speed =
                updates_per_second(model, &self.case.wind, &tunnel, self.case.flow.threads)?;
            found.updates_per_second = Some(speed);
        }
        Ok(found)
    }

    /// Cell updates a second (1/s) of the farm of `run` in its own domain, or its steps with wakes of full
    /// length: all of its turbines under baseline control, in wind without turbulence, or in that of its
    /// planes as long as a run lasts, of which nothing is kept. None where it breaks down at once.
    ///
    /// # Errors
    /// Those of [`timed`](Self::timed).
    pub(crate) fn timed_in_place(
        &self,
        run: &Run,
        n_jobs: usize,
    ) -> Result<Option<f64>, StudyError> {
        let mut case = self.case.clone();
        // Runs without cells share the cores among them; a lattice is timed as if it had them all.
        let n_jobs = if self.plan.cells() > 0 { 1 } else { n_jobs };
        if n_jobs > 1 {
            case.flow.threads.get_or_insert((cores() / n_jobs).max(1));
        }
        let air = air::steady(self, &mut case)?;
        // What others' libraries do, and what is yet to be identified, is left out.
        let plain = |control: &Control| {
            if control.is_there() { Control::baseline() } else { control.clone() }
        };
        let run = Run { control: run.control.iter().map(plain).collect(), ..run.clone() };
        let models: Vec<TurbineModel> =
            self.models.iter().cloned().map(TurbineModel::without_individual_pitch).collect();
        let mut farm = assemble::farm(&case, &run, &self.plan, &models, air)?;
        // The first step touches memory for the first time, and begins the wakes.
        let mut is_sound = farm.advance(&mut Unrecorded).is_ok();
        farm.flow_mut().reach_full_cost();
        let mut advance = || farm.advance(&mut Unrecorded).is_ok();
        // Grids of longer steps make theirs now and then: as often as they do in a run.
        let in_one = 1 << self.plan.depth();
        for _ in 1..in_one {
            is_sound = is_sound && advance();
        }
        let started = Instant::now();
        let mut n_steps = 0_u32;
        // Planes that do not repeat end with the run.
        let most = match case.wind_source() {
            WindSource::Planes => self.plan.n_steps.saturating_sub(1).max(1),
            _ => u64::MAX,
        };
        // A precursor beside it makes its steps now and then, too.
        let least = if self.memory_beside > 0 { STEPS_BESIDE } else { 1 };
        while is_sound
            && u64::from(n_steps) < most
            && (!n_steps.is_multiple_of(in_one) || n_steps < least || started.elapsed() < TIMED)
        {
            is_sound = advance();
            n_steps += 1;
        }
        let work = self.plan.effort().of_step * f64::from(n_steps) * n_jobs as f64;
        Ok(is_sound.then(|| work / started.elapsed().as_secs_f64()))
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
        let flow = &self.case.flow;
        // How wakes are resolved; a box of cells decides nothing beside their size.
        let values = (self.plan.cells() == 0).then(|| flow.values.iter().collect::<Vec<_>>());
        format!("{wind:?} {machines:?} {cells:?} {interval:?} {:?} {values:?}", flow.solver)
    }

    /// The model of turbine number `index` alone in a tunnel with the cells that it stands in, or wakes like
    /// the study's, and the study's step.
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
            &(self.case.flow.solver.tunnel)(&self.plan.alone(index), &self.case.flow),
            &self.case.flow,
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

    fn warning_of(&self, name: &str, check: &SelfCheck) -> String {
        let place = match self.plan.cells() {
            0 => format!("with flow.solver = \"{}\" as it is set", self.case.flow.solver.name),
            _ => "on this grid".to_owned(),
        };
        format!(
            "{name} alone in a steady {:.1} m/s gives {:+.1} % power and {:+.1} % thrust of blade-element momentum {place}",
            check.wind_speed,
            100.0 * check.power_error(),
            100.0 * check.thrust_error()
        )
    }
}
