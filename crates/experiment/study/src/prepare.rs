//! What all runs of a case share: turbines, domain, wind.

use crate::StudyError;
use crate::models::{self, Loaded};
use crate::probes::Probes;
use crate::watcher::{Estimate, Watcher};
use farm::assemble::{Model, controller};
use farm::case::Case;
use farm::self_check::{SelfCheckError, Tunnel, self_check};
use farm::wind::{self, Site};
use farm::{Plan, plan};
use flow::Inflow;
use flow::inflow::MeanProfile;
use formats::case::objection;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use turbine::blockage::equivalent_speed_ratio;

/// Rise of a rotor's power by the walls of the domain beyond which a reader must know (–).
const WALL_GAIN_TO_WARN: f64 = 0.05;
/// Thrust coefficient of a rotor below rated, with which that rise is estimated (–).
const USUAL_THRUST: f64 = 0.8;
/// Cells per diameter below which wakes are smeared (–).
const CELLS_TO_WARN: f64 = 16.0;
/// Blocks below which an interval says little (–).
const BLOCKS_TO_WARN: f64 = 3.0;

/// A case with everything that its runs share.
pub struct Setup {
    /// The study.
    pub case: Case,
    /// The case as run, overrides included (TOML).
    pub case_text: String,
    /// One per turbine, in the case's order; azimuth offsets of individual pitch control that their files leave out are found
    /// before the runs.
    pub models: Vec<Model>,
    /// Text of each turbine model's file, and of each controller's own input file with its table.
    pub turbine_texts: BTreeMap<String, String>,
    /// Domain and steps.
    pub plan: Plan,
    /// The wind that enters.
    pub inflow: Arc<dyn Inflow>,
    /// Folder that paths in the case are relative to.
    folder: PathBuf,
    /// What a reader of the numbers must know.
    pub warnings: Vec<String>,
}

impl Setup {
    /// Reads the case at `path` with `overrides`, loads its turbines and lays out its domain.
    ///
    /// # Errors
    /// [`StudyError`] for a case, a turbine or a layout that cannot be used.
    pub fn read(path: &Path, overrides: &[String]) -> Result<Self, StudyError> {
        let file = formats::case::read(path, overrides)?;
        let Loaded { models, texts, warnings } = models::load(&file)?;
        let case_text = formats::case::write(&file.case);
        let folder = file.folder().to_owned();
        let setup = Self::new(file.case.clone(), case_text, &models);
        let mut setup = setup.map_err(|error| match error {
            // What only the turbines tell is pointed at in the file, too.
            StudyError::Plan(error) => {
                StudyError::Case(objection(&file, &error.key(), error.to_string()))
            }
            StudyError::Control { run, turbine, source } => {
                let mut message = format!("{turbine} cannot be controlled so: {source}");
                let mut cause = source.source();
                while let Some(deeper) = cause {
                    message += &format!(": {deeper}");
                    cause = deeper.source();
                }
                let path = ["run", run.as_str(), "control", turbine.as_str()];
                StudyError::Case(objection(&file, &path, message))
            }
            error => error,
        })?;
        setup.turbine_texts = texts;
        setup.warnings.extend(warnings);
        setup.folder = folder;
        Ok(setup)
    }

    /// The same of a case whose machines are `loaded`, by the names of [`Placement::machine`](farm::case::Placement::machine).
    pub(crate) fn new(
        case: Case,
        case_text: String,
        loaded: &BTreeMap<String, Model>,
    ) -> Result<Self, StudyError> {
        let footprints = loaded
            .iter()
            .map(|(name, model)| (name.clone(), model.footprint(case.wind.speed)))
            .collect();
        let plan = plan(&case, &footprints)?;
        // Once a model, not once a machine and run: a table of coefficients takes a fraction of a second.
        let equip =
            |model: &Model| model.equipped(case.flow.solver, case.wind.air_density).into_owned();
        let equipped: BTreeMap<&String, Model> =
            loaded.iter().map(|(name, model)| (name, equip(model))).collect();
        let models: Vec<Model> =
            case.turbines.iter().map(|placement| equipped[&placement.machine()].clone()).collect();
        check_control(&case, &plan, &models)?;
        let warnings = warnings(&case, &plan);
        let inflow = Arc::new(MeanProfile::Uniform { speed: case.wind.speed });
        let turbine_texts = BTreeMap::new();
        let folder = PathBuf::new();
        let mut setup =
            Self { case, case_text, models, turbine_texts, plan, inflow, folder, warnings };
        setup.inflow = wind::without_turbulence(&setup.case, &setup.plan)?;
        let turbulence = wind::turbulence(&setup.site());
        setup.warnings.extend(turbulence.and_then(|turbulence| turbulence.warning));
        Ok(setup)
    }

    /// Folder that paths in the case are relative to.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// What the wind is made for.
    pub(crate) fn site(&self) -> Site<'_> {
        Site { case: &self.case, plan: &self.plan, models: &self.models }
    }

    /// The cost of `n_runs` runs and of `probes` before them, the machine's speed not known yet and the outputs left out.
    pub(crate) fn estimate(&self, n_runs: usize, probes: &Probes) -> Estimate {
        let plan = &self.plan;
        let costs = probes.costs();
        let field = (self.case.flow.solver.memory)(plan);
        Estimate {
            n_runs,
            n_probes: costs.len(),
            n_probe_steps: costs.iter().map(|cost| cost.n_steps).sum(),
            probe_work: costs.iter().map(|cost| cost.work).sum(),
            n_cells: plan.n_cells,
            spacing: plan.spacing,
            interval: plan.interval,
            n_steps: plan.n_steps,
            memory: field + self.turbulence_memory(),
            // A new checkpoint stands beside the old one until it is complete.
            disk: 2 * field,
            updates_per_second: None,
            blockage: plan.blockage,
            wall_gain: wall_gain(plan.blockage),
            lattice_speed: plan.lattice_speed,
        }
    }

    /// Whether this machine's free memory carries `estimate`; passes where the system does not tell.
    ///
    /// # Errors
    /// [`StudyError::Memory`].
    pub fn check_memory(&self, estimate: &Estimate) -> Result<(), StudyError> {
        const GIB: f64 = 1024.0 * 1024.0 * 1024.0;
        let needed = estimate.memory as f64 / GIB;
        match formats::machine::free_memory() {
            Some(free) if (free as f64) < estimate.memory as f64 => {
                Err(StudyError::Memory { needed, available: free as f64 / GIB })
            }
            _ => Ok(()),
        }
    }

    /// Checks each turbine model against blade-element momentum; gives the slowest update rate met (1/s), or a break when
    /// `stop` asked for an end.
    ///
    /// # Errors
    /// [`StudyError::SelfCheck`] when a check cannot be made; a model that falls short is a warning.
    pub fn self_check(
        &mut self,
        stop: &AtomicBool,
        watcher: &mut dyn Watcher,
    ) -> Result<ControlFlow<(), Option<f64>>, StudyError> {
        if !self.case.flow.solver.needs_self_check {
            return Ok(ControlFlow::Continue(None));
        }
        let mut checked: Vec<(&str, Option<&str>)> = Vec::new();
        let mut slowest: Option<f64> = None;
        for (model, placement) in self.models.iter().zip(&self.case.turbines) {
            let name = &model.definition.name;
            let machine = (name.as_str(), placement.discon.as_deref());
            if checked.contains(&machine) {
                continue;
            }
            checked.push(machine);
            let what = format!("checking {name}");
            let check = self_check(
                model,
                &self.case.wind,
                &Tunnel::of_study(self.plan.spacing, self.plan.interval),
                self.case.flow.threads,
                &mut |share| {
                    watcher.preparing(&what, share);
                    if stop.load(Ordering::Relaxed) {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                },
            );
            let check = match check {
                Err(SelfCheckError::BrokenOff) => return Ok(ControlFlow::Break(())),
                check => check?,
            };
            watcher.checked(&check);
            if !check.passes() {
                let warning = format!(
                    "{name} alone in a steady {:.1} m/s gives {:+.1} % power and {:+.1} % thrust of blade-element momentum on this grid",
                    check.wind_speed,
                    100.0 * check.power_error(),
                    100.0 * check.thrust_error()
                );
                watcher.warned(&warning);
                self.warnings.push(warning);
            }
            let speed = check.updates_per_second;
            slowest = Some(slowest.map_or(speed, |slowest| slowest.min(speed)));
        }
        Ok(ControlFlow::Continue(slowest))
    }

    fn turbulence_memory(&self) -> u64 {
        wind::turbulence(&self.site()).map_or(0, |turbulence| turbulence.memory)
    }

    /// On return the inflow carries the case's turbulence, where it enters a domain.
    ///
    /// # Errors
    /// [`StudyError::Inflow`] when it cannot be made.
    pub fn make_turbulence(&mut self, watcher: &mut dyn Watcher) -> Result<(), StudyError> {
        let watcher = RefCell::new(watcher);
        let told = |share| watcher.borrow_mut().preparing("turbulence", share);
        let entering = wind::entering(&self.site(), told)?;
        if let Some(inflow) = entering {
            self.inflow = inflow;
        }
        Ok(())
    }
}

/// Whether every rotor that shall pitch by tilt and yaw has the blades for it, and every controller can be made: known now,
/// not when its run begins after hours of others.
fn check_control(case: &Case, plan: &Plan, models: &[Model]) -> Result<(), StudyError> {
    for run in &case.runs {
        for ((control, placement), model) in run.control.iter().zip(&case.turbines).zip(models) {
            let n_blades = model.definition.n_blades;
            if control.kind().pitches_individually() && n_blades < 3 {
                let (run, turbine) = (run.name.clone(), placement.name.clone());
                return Err(StudyError::TooFewBlades { run, turbine, n_blades });
            }
            if !control.is_there() {
                continue;
            }
            // What is found before the runs, if there is to be anything, decides nothing here.
            let model = model.clone().without_individual_pitch();
            let mut control = control.clone();
            control.response = control.response.or(control.kind().any_response());
            if let Err(source) = controller(&control, &model, case, plan) {
                let (run, turbine) = (run.name.clone(), placement.name.clone());
                return Err(StudyError::Control { run, turbine, source });
            }
        }
    }
    Ok(())
}

/// Rise of a rotor's power (–) in a domain of which it takes `blockage` (–), over that in unbounded air.
fn wall_gain(blockage: f64) -> f64 {
    equivalent_speed_ratio(USUAL_THRUST, blockage).powi(3) - 1.0
}

fn warnings(case: &Case, plan: &Plan) -> Vec<String> {
    let mut warnings = Vec::from_iter(farm::wind::off_balance(case));
    let gain = wall_gain(plan.blockage);
    if gain > WALL_GAIN_TO_WARN {
        warnings.push(format!(
            "a rotor takes {:.1} % of the domain's cross-section: the walls raise its power by about {:.0} %, in every run alike; \
             raise flow.width_diameters or flow.height_diameters",
            100.0 * plan.blockage,
            100.0 * gain
        ));
    }
    if plan.cells() > 0 && case.flow.cells_per_diameter < CELLS_TO_WARN {
        warnings.push(format!(
            "{:.0} cells per diameter are coarse: wakes mix later than they should; 16 and more are for results",
            case.flow.cells_per_diameter
        ));
    }
    let is_absent = |index: usize| case.runs.iter().any(|run| !run.control[index].is_there());
    for &index in case.output.inflow_at.iter().filter(|&&index| !is_absent(index)) {
        let name = &case.turbines[index].name;
        warnings.push(format!("no wind is recorded at {name}: it stands there in every run"));
    }
    for &index in case.output.lines_at.iter().filter(|&&index| !is_absent(index)) {
        let name = &case.turbines[index].name;
        warnings.push(format!(
            "no run tells the true wind at {name}, as it stands there in every run: add one with control.{name} = {{ kind = \"absent\" }}"
        ));
    }
    let blocks = (case.time.duration - case.time.spin_up) / analysis::statistics::BLOCK_LENGTH;
    if blocks < BLOCKS_TO_WARN {
        warnings.push(format!(
            "{blocks:.1} blocks of ten minutes are analysed; with fewer than {BLOCKS_TO_WARN:.0} the intervals say little"
        ));
    }
    for run in &case.runs {
        for (control, placement) in run.control.iter().zip(&case.turbines) {
            for warning in control.kind().warnings(control) {
                warnings.push(format!("run {}: {}{warning}", run.name, placement.name));
            }
            let Some(strouhal) = control.kind().slowest_strouhal(control) else { continue };
            let period = plan.diameter / (strouhal * case.wind.speed);
            let periods = (case.time.duration - case.time.spin_up) / period;
            if periods < 3.0 {
                warnings.push(format!(
                    "run {}: only {periods:.1} periods of {}'s excitation ({period:.0} s) are analysed",
                    run.name, placement.name
                ));
            }
        }
    }
    warnings
}
