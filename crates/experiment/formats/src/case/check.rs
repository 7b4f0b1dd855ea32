//! From checked tables to a [`Case`], and the checks that need more than one key.

use super::document::{Entry, Node, Value};
use super::error::{Problem, ProblemKind};
use super::findings::Findings;
use super::instruments::instruments_of;
use super::keys;
use super::kinds;
use super::momentum::{dynamic_inflow_of, tower_influence_of};
use super::position::{check_overlap, position_of};
use super::section::Section;
use super::solver::flow_of;
use super::sources::Sources;
use super::spelling::{list, nearest};
use super::wind::{check_together, wind_of};
use basis::keys::Table;
use control::{CONTROLLERS, ControllerKind, FurtherSensor, Place};
use farm::case::{
    Case, Control, Mounted, Output, Placement, Requested, Run, Solver, Time, helix_upstream, places,
};
use farm::outputs::{OUTPUTS, OutputKeys};
use sensing::{SENSORS, SensorKind};

/// Names of folders that a study has for itself beside those of its runs.
const OWN_FOLDERS: [&str; 1] = ["figures"];

/// The case that `entries` describe.
///
/// # Errors
/// Everything that is wrong, from top to bottom of the file.
pub(super) fn check(
    entries: &[Entry],
    length: usize,
    sources: &Sources,
) -> Result<Case, Vec<Problem>> {
    let findings = Findings::new(entries, sources);
    let case = {
        // What is missing at the top is reported at the end of the file, where it can be added.
        let end = length.saturating_sub(1)..length;
        case_of(&Section::open(&keys::ROOT, entries, end, String::new(), &findings))
    };
    let problems = findings.into_problems();
    if problems.is_empty() { Ok(case) } else { Err(problems) }
}

fn case_of(root: &Section) -> Case {
    let name = root.text("name");
    let description = root.optional_text("description");
    let wind_section = root.section_or_missing("wind", &keys::WIND);
    let wind = wind_of(&wind_section);
    let flow = flow_of(root);
    let time = time_of(&root.section_or_missing("time", &keys::TIME));
    if let Some(section) = &wind_section {
        check_together(section, &wind, &flow, time.duration);
    }
    let turbines = turbines_of(root, flow.solver);
    let places = places(&turbines, wind.direction);
    let runs = runs_of(root, &turbines, &places, time);
    let output = output_of(&root.section("output", &keys::OUTPUT), &turbines, flow.solver);
    Case { name, description, wind, flow, time, turbines, runs, output }
}

impl<'a> Section<'a> {
    /// The section of a required table; when it is missing, only that is noted, not each of its keys.
    fn section_or_missing(&self, key: &str, table: &'static Table) -> Option<Section<'a>> {
        let is_table = matches!(self.entry(key)?.node.value, Value::Table(_));
        let section = self.section(key, table);
        is_table.then_some(section)
    }
}

fn time_of(section: &Option<Section>) -> Time {
    let Some(section) = section else {
        return Time { spin_up: f64::NAN, duration: f64::NAN, block: f64::NAN };
    };
    let (spin_up, duration) = (section.number("spin_up"), section.number("duration"));
    if duration <= spin_up {
        let kind = ProblemKind::NothingAnalysed { duration, spin_up };
        let fix = "raise `duration`; it counts from the start of the run, spin-up included";
        section.findings().note(section.span_of("duration"), kind, Some(fix.into()));
    }
    Time { spin_up, duration, block: section.number("block") }
}

fn turbines_of(root: &Section, solver: Solver) -> Vec<Placement> {
    let sections = root.sections("turbine", &keys::TURBINE);
    let mut turbines: Vec<Placement> = Vec::with_capacity(sections.len());
    for section in &sections {
        let placement = Placement {
            name: section.text("name"),
            model: section.text("model"),
            discon: section.optional_text("discon"),
            torque_gain: torque_gain_of(section),
            position: position_of(section, &turbines),
            yaw: section.number("yaw_deg").to_radians(),
            pitch_misalignment: section
                .numbers("pitch_misalignment_deg")
                .iter()
                .map(|angle| angle.to_radians())
                .collect(),
            flexible: section.choice("structure") != "rigid",
            structure_step: section.optional_number("structure_step"),
            dynamic_stall: if section.has("stall") {
                section.choice("stall") == "dynamic"
            } else {
                !solver.resolves_induction
            },
            dynamic_inflow: dynamic_inflow_of(section, solver),
            tower_influence: tower_influence_of(section, solver),
            instruments: instruments_of(section),
            sensors: sensors_of(section),
        };
        if section.has("name") && turbines.iter().any(|other| other.name == placement.name) {
            note_duplicate(section, "turbine", &placement.name);
        }
        check_overlap(section, &placement.name, placement.position, &turbines);
        turbines.push(placement);
    }
    turbines
}

/// The gain of k ω² that `turbine` has of its own; notes where its controller's input file has one.
fn torque_gain_of(turbine: &Section) -> Option<f64> {
    let gain = turbine.optional_number("torque_gain")?;
    if turbine.has("discon") {
        let why = "the input file of the controller has the gain, VS_Rgn2K".to_owned();
        let kind = ProblemKind::NoUse { key: turbine.key_path("torque_gain"), why };
        let fix = "leave one of the two out".to_owned();
        turbine.findings().note(turbine.span_of("torque_gain"), kind, Some(fix));
    }
    Some(gain)
}

/// The further sensors of a turbine, by their names.
fn sensors_of(turbine: &Section) -> Vec<Mounted> {
    let table = |kind: &(dyn SensorKind + 'static)| kind.table();
    let read = kinds::named(turbine, "sensors", &SENSORS, table, "which kind of sensor it is");
    let mounted = read.into_iter().map(|(name, read)| {
        read.note(read.kind.check(&read.values));
        Mounted { name, kind: read.kind, values: read.values }
    });
    mounted.collect()
}

/// The further outputs, by their names; notes those that the air of `solver` cannot feed.
fn further_of(output: &Section, solver: Solver) -> Vec<Requested> {
    let table = |kind: &(dyn OutputKeys + 'static)| kind.table();
    let read = kinds::named(output, "further", &OUTPUTS, table, "which kind of output it is");
    let requested = read.into_iter().map(|(name, read)| {
        read.note(read.kind.check(&read.values));
        if !read.kind.takes(solver.resolves_induction) {
            let flow = if solver.resolves_induction { "prescribed wind" } else { "resolved flow" };
            let why = format!("`{}`: `{}` is made of {flow}", read.path(), read.kind.name());
            let kind = ProblemKind::NotWithSolver { solver: solver.name, why };
            let fix = "leave it out, or take another flow.solver".to_owned();
            output.findings().note(read.place_of("kind"), kind, Some(fix));
        }
        Requested { name, kind: read.kind, values: read.values }
    });
    requested.collect()
}

fn runs_of(root: &Section, turbines: &[Placement], places: &[[f64; 2]], time: Time) -> Vec<Run> {
    let sections = root.sections("run", &keys::RUN);
    let mut runs: Vec<Run> = Vec::with_capacity(sections.len());
    for section in &sections {
        let name = section.text("name");
        // Folders of file systems that do not tell capitals apart would collide.
        if section.has("name") && runs.iter().any(|other| other.name.eq_ignore_ascii_case(&name)) {
            note_duplicate(section, "run", &name);
        }
        if OWN_FOLDERS.iter().any(|own| own.eq_ignore_ascii_case(&name)) {
            let key = section.key_path("name");
            let why = format!("a study's folder has its own `{name}`, beside those of the runs");
            let fix = Some("choose another name".to_owned());
            section.findings().note(section.span_of("name"), ProblemKind::Taken { key, why }, fix);
        }
        let compare_with = section.optional_text("compare_with");
        let control = controls_of(section, turbines, places, time);
        if !control.is_empty() && !control.iter().any(Control::is_there) {
            let kind = ProblemKind::NobodyThere { name: name.clone() };
            section.findings().note(section.span_of("control"), kind, None);
        }
        runs.push(Run { name, compare_with, control });
    }
    for (index, (section, run)) in sections.iter().zip(&runs).enumerate() {
        let Some(other) = &run.compare_with else { continue };
        if *other == run.name {
            let kind = ProblemKind::ComparedWithItself { name: run.name.clone() };
            let fix = "name another run, or leave `compare_with` out";
            section.findings().note(section.span_of("compare_with"), kind, Some(fix.into()));
        } else if !runs.iter().any(|run| run.name == *other) {
            let names = || runs.iter().map(|run| run.name.as_str());
            let kind = ProblemKind::UnknownName {
                key: section.key_path("compare_with"),
                what: "run",
                name: other.clone(),
                known: list(names()),
            };
            let fix = nearest(other, names()).map(|name| format!("did you mean \"{name}\"?"));
            section.findings().note(section.span_of("compare_with"), kind, fix);
        } else if !runs[..index].iter().any(|run| run.name == *other) {
            let kind =
                ProblemKind::ComparedWithLater { name: run.name.clone(), other: other.clone() };
            let fix = format!("put [[run]] `{other}` before");
            section.findings().note(section.span_of("compare_with"), kind, Some(fix));
        }
    }
    runs
}

fn controls_of(
    run: &Section,
    turbines: &[Placement],
    places: &[[f64; 2]],
    time: Time,
) -> Vec<Control> {
    let mut controls = vec![Control::baseline(); turbines.len()];
    let Some(entry) = run.entry("control") else { return controls };
    let Value::Table(entries) = &entry.node.value else {
        run.wrong_type(
            "control",
            &entry.node,
            "a table, such as control.T1 = { kind = \"helix\", … }",
        );
        return controls;
    };
    // Those downstream last: they may join what those upstream do.
    let mut entries: Vec<(&Entry, Option<usize>)> = entries
        .iter()
        .map(|entry| (entry, turbines.iter().position(|turbine| turbine.name == entry.key)))
        .collect();
    let downwind = |index: Option<usize>| index.map_or(f64::NEG_INFINITY, |i| places[i][0]);
    entries.sort_by(|a, b| downwind(a.1).total_cmp(&downwind(b.1)));
    for (entry, index) in entries {
        let path = format!("{}.{}", run.key_path("control"), entry.key);
        let Some(index) = index else {
            run.findings().is_turbine(path, &entry.key, &entry.key_span);
            continue;
        };
        match &entry.node.value {
            Value::Table(inner) => {
                let upstream = helix_upstream(index, places, &controls);
                let Placement { name: turbine, sensors, .. } = &turbines[index];
                let sensors: Vec<FurtherSensor> = sensors.iter().map(further_sensor).collect();
                let (duration, sensors) = (time.duration, sensors.as_slice());
                let place = Place { turbine, upstream, duration, sensors };
                controls[index] = control_of(run.findings(), inner, &entry.node, path, &place);
            }
            _ => {
                let kind = ProblemKind::WrongType {
                    key: path,
                    expected: "a table, such as { kind = \"baseline\" }".into(),
                    found: entry.node.kind().into(),
                };
                run.findings().note(entry.node.span.clone(), kind, None);
            }
        }
    }
    controls
}

/// What a controller may know of the sensor `mounted` on its turbine.
fn further_sensor(mounted: &Mounted) -> FurtherSensor<'_> {
    FurtherSensor { name: &mounted.name, kind: mounted.kind.name(), values: &mounted.values }
}

fn control_of(
    findings: &Findings,
    entries: &[Entry],
    node: &Node,
    path: String,
    place: &Place,
) -> Control {
    let what = "what runs on the turbine";
    let table = |kind: &(dyn ControllerKind + 'static)| kind.table();
    let at = (node.span.clone(), path);
    let Some(mut read) = kinds::read(&CONTROLLERS, table, what, entries, at, findings) else {
        return Control::baseline();
    };
    let objections = read.kind.check(&mut read.values, place);
    read.note(objections);
    Control::checked(read.kind, read.values)
}

/// Places in `turbines` of those that the list `key` names.
fn places_of(section: &Section, key: &str, turbines: &[Placement]) -> Vec<usize> {
    let place = |name: &String| turbines.iter().position(|turbine| turbine.name == *name);
    section.turbines(key).iter().filter_map(place).collect()
}

/// What is kept of a run; notes what is said of volumes where none are kept.
fn output_of(section: &Section, turbines: &[Placement], solver: Solver) -> Output {
    let volume_interval = section.optional_number("volume_interval");
    let volume_stride = section.optional_whole("volume_stride");
    if volume_interval.is_none() && volume_stride.is_some() {
        let why = "no volumes are kept without `output.volume_interval`".to_owned();
        let kind = ProblemKind::NoUse { key: section.key_path("volume_stride"), why };
        let fix = "add `volume_interval`, or leave `volume_stride` out".to_owned();
        section.findings().note(section.span_of("volume_stride"), kind, Some(fix));
    }
    let filament_interval = section.optional_number("filament_interval");
    if filament_interval.is_some() && solver.most_filaments.is_none() {
        let why = format!("flow.solver = \"{}\" has no vortices to show", solver.name);
        let kind = ProblemKind::NoUse { key: section.key_path("filament_interval"), why };
        let fix = "leave it out, or use flow.solver = \"vortex\"".to_owned();
        section.findings().note(section.span_of("filament_interval"), kind, Some(fix));
    }
    Output {
        filament_interval,
        lines_at: places_of(section, "lines_at", turbines),
        inflow_at: places_of(section, "inflow_at", turbines),
        helix_phases: section
            .optional_whole("helix_phases")
            .and_then(|count| usize::try_from(count).ok()),
        interval: section.optional_number("interval"),
        plane_interval: section.optional_number("plane_interval"),
        crosswind_diameters: section.numbers("crosswind_diameters"),
        volume_interval,
        volume_stride: volume_stride.map_or(keys::USUAL_STRIDE, |stride| stride as usize),
        keeps_scans: section.choice("scans") == "keep",
        checkpoint_interval: section.number("checkpoint_interval"),
        keeps_checkpoint: section.choice("last_checkpoint") == "keep",
        further: further_of(section, solver),
    }
}

fn note_duplicate(section: &Section, what: &'static str, name: &str) {
    let kind = ProblemKind::Duplicate { what, name: name.to_owned() };
    section.findings().note(section.span_of("name"), kind, Some("choose another name".into()));
}
