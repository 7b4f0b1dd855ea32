//! What a reader of the numbers must know of a case before it runs.

use crate::threads::cores;
use farm::Plan;
use farm::assemble::TurbineModel;
use farm::case::{Case, Placement, Run};
use farm::wind::wall_gain;
use std::fmt;

/// Rise of a rotor's power by the walls of the domain beyond which a reader must know (–).
const WALL_GAIN_TO_WARN: f64 = 0.05;
/// Blocks below which an interval says little (–).
const BLOCKS_TO_WARN: f64 = 3.0;
/// Steps of a run beyond which somebody should know (–): ten million take hours of prescribed wind.
const STEPS_TO_WARN: u64 = 10_000_000;
/// Periods of an excitation below which its analysis says little (–).
const PERIODS_TO_WARN: f64 = 3.0;

/// What a reader of the numbers must know, as it is seen before the runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SetupWarning {
    /// The run that it is about, by its name; all where absent.
    pub run: Option<String>,
    /// The turbine that it is about, by its name; the whole run where absent.
    pub turbine: Option<String>,
    /// What is to be known, in a sentence that names run and turbine.
    pub message: String,
}

impl SetupWarning {
    /// Whether it is about the run called `run`.
    pub fn concerns(&self, run: &str) -> bool {
        self.run.as_ref().is_none_or(|own| own == run)
    }
}

impl From<String> for SetupWarning {
    fn from(message: String) -> Self {
        Self { run: None, turbine: None, message }
    }
}

impl fmt::Display for SetupWarning {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

/// All warnings of `case` as it is laid out in `plan`.
pub(crate) fn of(case: &Case, plan: &Plan) -> Vec<SetupWarning> {
    let mut warnings = Vec::from_iter(farm::wind::off_balance(case));
    warnings.extend(of_domain(case, plan));
    warnings.extend(of_cost(case, plan));
    warnings.extend(of_places(case));
    let length = case.time.block;
    let blocks = (case.time.duration - case.time.spin_up) / length;
    if blocks < BLOCKS_TO_WARN {
        warnings.push(format!(
            "{blocks:.1} blocks of {} are analysed; with fewer than {BLOCKS_TO_WARN:.0} the intervals say little",
            if length == 600.0 { "ten minutes".to_owned() } else { format!("{length} s") }
        ));
    }
    let mut warnings: Vec<SetupWarning> = warnings.into_iter().map(SetupWarning::from).collect();
    warnings.extend(case.runs.iter().flat_map(|run| of_run(case, plan, run)));
    warnings
}

/// Of steps that hardly end, and of more threads than there are cores.
fn of_cost(case: &Case, plan: &Plan) -> Vec<String> {
    let mut warnings = Vec::new();
    if plan.n_steps > STEPS_TO_WARN {
        warnings.push(format!(
            "a run takes {:.1e} steps of {:?} s: raise flow.step, or lower time.duration",
            plan.n_steps as f64, plan.interval
        ));
    }
    let n_cores = cores();
    if let Some(threads) = case.flow.threads.filter(|threads| *threads > n_cores) {
        warnings.push(format!(
            "flow.threads = {threads} on {n_cores} cores: threads that wait for each other are slower than fewer"
        ));
    }
    warnings
}

/// Of turbines whose files state no cut-in and cut-out wind speeds.
pub(crate) fn of_operation(case: &Case, models: &[TurbineModel]) -> Option<String> {
    let silent = |(_, model): &(&Placement, &TurbineModel)| model.definition.operation.is_none();
    let named = case.turbines.iter().zip(models).filter(silent).map(|(it, _)| it.name.as_str());
    let names: Vec<&str> = named.collect();
    (!names.is_empty()).then(|| {
        format!(
            "the wind is not held against cut-in and cut-out of {}: the turbine file states none; add the group [operation]",
            names.join(", ")
        )
    })
}

/// Of walls that are near, and cells that are coarse.
fn of_domain(case: &Case, plan: &Plan) -> Vec<String> {
    let mut warnings = Vec::new();
    let gain = wall_gain(case, plan);
    if gain > WALL_GAIN_TO_WARN {
        warnings.push(format!(
            "a rotor takes {:.1} % of the domain's cross-section: the walls raise its power by about {:.0} %, in every run alike; \
             raise flow.width_diameters or flow.height_diameters, or write flow.blockage = \"corrected\"",
            100.0 * plan.blockage,
            100.0 * gain
        ));
    }
    warnings.extend((case.flow.solver.warnings)(case, plan));
    warnings
}

/// Of places where the wind is to be kept, and where a turbine stands in every run.
fn of_places(case: &Case) -> Vec<String> {
    let stands = |index: usize| case.runs.iter().all(|run| run.control[index].is_there());
    let occupied = |places: &[usize]| {
        let names = places.iter().filter(|&&index| stands(index));
        names.map(|&index| case.turbines[index].name.clone()).collect::<Vec<_>>()
    };
    let mut warnings = Vec::new();
    for name in occupied(&case.output.inflow_at) {
        warnings.push(format!("no wind is recorded at {name}: it stands there in every run"));
    }
    for name in occupied(&case.output.lines_at) {
        warnings.push(format!(
            "no run has the true wind at {name}, as it stands there in every run: add one with control.{name} = {{ kind = \"absent\" }}"
        ));
    }
    warnings
}

/// Of phase offsets beyond a turn, and of excitations that are analysed over too few periods.
fn of_run(case: &Case, plan: &Plan, run: &Run) -> Vec<SetupWarning> {
    let mut warnings = Vec::new();
    for (control, placement) in run.control.iter().zip(&case.turbines) {
        let about = |message| SetupWarning {
            run: Some(run.name.clone()),
            turbine: Some(placement.name.clone()),
            message,
        };
        for warning in control.kind().warnings(control) {
            warnings.push(about(format!("run {}: {}{warning}", run.name, placement.name)));
        }
        let Some(strouhal) = control.kind().slowest_strouhal(control) else { continue };
        let period = plan.diameter / (strouhal * case.wind.speed);
        let periods = (case.time.duration - case.time.spin_up) / period;
        if periods < PERIODS_TO_WARN {
            warnings.push(about(format!(
                "run {}: only {periods:.1} periods of {}'s excitation ({period:.0} s) are analysed",
                run.name, placement.name
            )));
        }
    }
    warnings
}
