//! The first stage: a case that is checked, its turbines loaded, its domain laid out. Nothing is simulated
//! yet.

use crate::StudyError;
use crate::atmosphere;
use crate::file_of_wind;
use crate::hosting;
use crate::linear_laws::{self, LawDigests};
use crate::models::{self, Machines};
use crate::slice_layout::{self, Laid};
use crate::threads;
use crate::warnings::{self, SetupWarning};
use farm::assemble::{AssemblyError, TurbineModel, controller, misalignment, sensing};
use farm::case::{Case, Run};
use farm::operation::check_operation;
use farm::wind::{self, Recorded, Site, Surroundings};
use farm::{Plan, plan};
use flow::Inflow;
use formats::case::{CaseFile, objection};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A case with everything that its runs share, as far as it is known without a simulation.
///
/// The next stage is [`Ready`](crate::Ready).
pub struct Prepared {
    /// The study.
    pub case: Case,
    /// The case as run, overrides included (TOML).
    pub case_text: String,
    /// One per turbine, in the case's order.
    pub models: Vec<TurbineModel>,
    /// Text of each turbine model's file, and of each controller's own input file with its table; none of
    /// models that were given as values.
    pub turbine_texts: BTreeMap<String, String>,
    /// SHA-256 of each shared library that controls a turbine, and of its input file, by their names; those
    /// of linear laws come with the runs that have one.
    pub libraries: BTreeMap<String, String>,
    /// Domain and steps.
    pub plan: Plan,
    /// The wind that enters, its turbulence left out.
    pub mean_inflow: Arc<dyn Inflow>,
    /// The planes of a file that enter, where they do.
    pub recorded: Option<Recorded>,
    /// The atmosphere of the precursor that they come from, where they come from one.
    pub surroundings: Option<Surroundings>,
    /// Memory that a precursor beside each run takes (bytes); 0 without one.
    pub memory_beside: u64,
    /// What a reader of the numbers must know.
    pub warnings: Vec<SetupWarning>,
    /// What the files of linear laws were when they were read.
    laws: LawDigests,
    /// Channels of each turbine's controller and further sensors (–), of every run by its name, in the case's
    /// order: counted where every controller is made as a check, which takes a while.
    n_told: BTreeMap<String, Vec<usize>>,
    /// Folder that paths in the case are relative to.
    folder: PathBuf,
}

impl Prepared {
    /// The first stage of the case of `file`, its turbines from library or files.
    ///
    /// # Errors
    /// Those of [`read`](Self::read).
    pub(crate) fn of_file(file: &CaseFile) -> Result<Self, StudyError> {
        Self::of_machines(file, models::load(file)?)
    }

    /// The same with `machines` as its turbines.
    ///
    /// # Errors
    /// Those of [`with_models`](Self::with_models).
    pub(crate) fn of_machines(file: &CaseFile, machines: Machines) -> Result<Self, StudyError> {
        Self::new(file, machines).map_err(|error| pointed_at(file, error))
    }

    fn new(file: &CaseFile, machines: Machines) -> Result<Self, StudyError> {
        let mut case = file.case.clone();
        hosting::attach(&mut case, file.folder());
        let laws = linear_laws::attach(&mut case, file.folder())?;
        let plan = plan(&case, &machines.footprints(case.wind.speed))?;
        let models = machines.equipped(&case);
        threads::check(file)?;
        slice_layout::check(file, Laid { case: &case, plan: &plan, models: &models })?;
        let table = file_of_wind::table(file, &plan)?;
        let planes = file_of_wind::planes(file, &plan)?;
        let planes = planes.as_deref();
        let speed = file_of_wind::recorded_speed(table.as_deref(), planes, &case);
        check_operation(&case, &plan, &models, speed)?;
        let n_told = check_control(&case, &plan, &models)?;
        let warned = file_of_wind::warning(&case, table.as_deref());
        let mean_inflow = match table {
            Some(table) => table as Arc<dyn Inflow>,
            None => wind::without_turbulence(&case, &plan)?,
        };
        let mut warnings = warnings::of(&case, &plan);
        warnings.extend(formats::case::unused_flow_keys(file).map(SetupWarning::from));
        let surroundings = atmosphere::surroundings(file, &plan)?;
        let memory_beside = atmosphere::memory_beside(&case, file.folder())?;
        let site =
            Site { case: &case, plan: &plan, models: &models, surroundings: surroundings.as_ref() };
        file_of_wind::check_grid(file, &site)?;
        let recorded = file_of_wind::at_inlet(file, &site, planes)?;
        let of_file = file_of_wind::warnings(file, &site, recorded)?;
        let turbulence = wind::turbulence(&site).and_then(|turbulence| turbulence.warning);
        let operation = warnings::of_operation(&case, &models);
        let further = turbulence
            .into_iter()
            .chain(machines.warnings)
            .chain(operation)
            .chain(warned)
            .chain(surroundings.iter().flat_map(|air| air.warnings(&case, &plan)))
            .chain(of_file);
        warnings.extend(further.map(SetupWarning::from));
        Ok(Self {
            case_text: formats::case::write(&case),
            turbine_texts: machines.texts,
            libraries: hosting::digests(&case, file.folder()),
            laws,
            folder: file.folder().to_owned(),
            n_told,
            case,
            models,
            plan,
            mean_inflow,
            recorded,
            surroundings,
            memory_beside,
            warnings,
        })
    }

    /// Folder that paths in the case are relative to.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// `run`, one of the case's, with the references that runs of reference have left by now.
    ///
    /// # Errors
    /// [`StudyError::File`].
    pub(crate) fn referred(&self, run: &Run) -> Result<Run, StudyError> {
        Ok(linear_laws::referred(run, &self.case.turbines, &self.folder)?)
    }

    /// SHA-256 of the shared libraries, and what decides the linear laws of `run`, by their names.
    pub(crate) fn libraries_of(&self, run: &Run) -> BTreeMap<String, String> {
        let laws = linear_laws::deciding(run, &self.case.turbines, &self.laws);
        self.libraries.clone().into_iter().chain(laws).collect()
    }

    /// Channels of the controller and the further sensors of turbine number `index` in `run`, one of the
    /// case's (–).
    pub(crate) fn n_told(&self, run: &Run, index: usize) -> usize {
        self.n_told.get(&run.name).map_or(0, |of_turbines| of_turbines[index])
    }

    /// What the wind is made for.
    pub(crate) fn site(&self) -> Site<'_> {
        let surroundings = self.surroundings.as_ref();
        Site { case: &self.case, plan: &self.plan, models: &self.models, surroundings }
    }
}

/// `error`, with an arrow at the key in `file` where only the turbines tell that it does not fit.
fn pointed_at(file: &CaseFile, error: StudyError) -> StudyError {
    match error {
        StudyError::Plan(error) => {
            StudyError::Case(objection(file, &error.key(), error.to_string()))
        }
        StudyError::Assembly(AssemblyError::Misalignment { ref turbine, .. }) => {
            let path = ["turbine", turbine.as_str(), "pitch_misalignment_deg"];
            StudyError::Case(objection(file, &path, error.to_string()))
        }
        StudyError::Assembly(AssemblyError::Sensor(ref found)) => {
            let path = ["turbine", &found.turbine, "sensors", &found.sensor, found.key];
            StudyError::Case(objection(file, &path, error.to_string()))
        }
        StudyError::Control { run, turbine, source } => {
            let mut message = format!("the controller of {turbine} cannot be built: {source}");
            let mut cause = source.source();
            while let Some(deeper) = cause {
                message += &format!(": {deeper}");
                cause = deeper.source();
            }
            let path = ["run", run.as_str(), "control", turbine.as_str()];
            StudyError::Case(objection(file, &path, message))
        }
        error => error,
    }
}

/// Whether every rotor that shall pitch by tilt and yaw has the blades for it, and every controller can be
/// made: known now, not when its run begins after hours of others. Gives [`Prepared::n_told`].
fn check_control(
    case: &Case,
    plan: &Plan,
    models: &[TurbineModel],
) -> Result<BTreeMap<String, Vec<usize>>, StudyError> {
    for (placement, model) in case.turbines.iter().zip(models) {
        misalignment(placement, model)?;
    }
    let mut n_told = BTreeMap::new();
    for run in &case.runs {
        let of_turbines =
            (0..models.len()).map(|index| check_control_of(case, plan, &models[index], run, index));
        n_told.insert(run.name.clone(), of_turbines.collect::<Result<_, _>>()?);
    }
    Ok(n_told)
}

/// The same of turbine number `index` in `run`.
fn check_control_of(
    case: &Case,
    plan: &Plan,
    model: &TurbineModel,
    run: &Run,
    index: usize,
) -> Result<usize, StudyError> {
    let (control, placement) = (&run.control[index], &case.turbines[index]);
    let n_blades = model.definition.n_blades;
    if control.kind().pitches_individually() && n_blades < 3 {
        let (run, turbine) = (run.name.clone(), placement.name.clone());
        return Err(StudyError::TooFewBlades { run, turbine, n_blades });
    }
    if !control.is_there() {
        return Ok(0);
    }
    // What is found before the runs, if there is to be anything, decides nothing here.
    let model = model.clone().without_individual_pitch();
    let mut control = control.clone();
    control.response = control.response.or(control.kind().any_response());
    linear_laws::for_a_check(&mut control);
    let built = controller(&control, &model, case, plan).map(|built| built.signals().len());
    let begun =
        |n_signals| hosting::check(&control, placement, &model, (case, plan)).map(|()| n_signals);
    let n_signals = built.and_then(begun).map_err(|source| {
        let (run, turbine) = (run.name.clone(), placement.name.clone());
        StudyError::Control { run, turbine, source: Box::new(source) }
    })?;
    Ok(n_signals + sensing(case, plan, &model, index)?.channels().len())
}
