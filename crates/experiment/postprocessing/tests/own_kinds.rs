//! Kinds of controller and flow solver from outside: their records are read again, and the report tells of
//! them.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use basis::keys::Table;
use basis::registry::Named;
use basis::{Commands, Measurements};
use control::{CONTROLLERS, Control, ControlError, Controller, ControllerKind, ForeignState, Site};
use farm::solvers::{PRESCRIBED, SOLVERS, SolverKind};
use small::{NREL_5MW, case, done, options, written};
use std::fs;

/// The mean profile under another name.
static CALM: SolverKind =
    SolverKind { name: "calm", about: "prescribed wind, calmly", ..PRESCRIBED };

/// Half of the torque of baseline control.
struct Half(Box<dyn Controller>);

impl Controller for Half {
    fn update(&mut self, measurements: &Measurements) -> Commands {
        let mut commands = self.0.update(measurements);
        commands.generator_torque *= 0.5;
        commands
    }

    fn describe(&self) -> String {
        "half of the torque".to_owned()
    }

    fn save(&self) -> Vec<u8> {
        self.0.save()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        self.0.restore(state)
    }
}

struct HalfKind;

static HALF: Table =
    Table { heading: "control.T1 = { kind = \"half\" }", about: "Half of the torque.", keys: &[] };

impl Named for HalfKind {
    fn name(&self) -> &'static str {
        "half"
    }
}

impl ControllerKind for HalfKind {
    fn table(&self) -> &'static Table {
        &HALF
    }

    fn build(&self, _: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        Ok(Box::new(Half(site.baseline())))
    }
}

#[test]
fn the_report_of_a_study_tells_of_kinds_of_ones_own() {
    SOLVERS.add(&CALM).expect("no kind is called so yet");
    CONTROLLERS.add(&HalfKind).expect("no kind is called so yet");
    let runs = "[[run]]\nname = \"baseline\"\n[[run]]\nname = \"own\"\ncompare_with = \"baseline\"\ncontrol.T1 = { kind = \"half\" }\n";
    let text = case("own", "", [10.0, 60.0], &[NREL_5MW], runs);
    let folder = written(&text.replace("solver = \"uniform\"", "solver = \"calm\""));
    let study = done(&options(folder.path()));
    let postprocessing::ReportMade { summaries, page, .. } =
        postprocessing::report(&study).expect("sound records");
    assert!(summaries.iter().all(|it| it.flow.as_ref().is_some_and(|flow| flow.solver == "calm")));
    let page = fs::read_to_string(page).expect("a page");
    for expected in ["half of the torque", "kind = &quot;half&quot;"] {
        assert!(page.contains(expected), "{expected} is missing");
    }
}
