//! What `--verbose` says of a study: what was read, what was built, and how long each stage took.

use crate::commands::{manner, output::detail};
use indicatif::HumanBytes;
use std::path::Path;
use std::time::Instant;
use wakemix::farm::plan::GridOfPlan;
use wakemix::formats::shipped;
use wakemix::study::Prepared;

/// The clock of a study: one stage after the other.
pub(super) struct Stages {
    name: String,
    began: Instant,
}

impl Stages {
    /// The first stage, from now on.
    pub(super) fn new() -> Self {
        Self { name: "reading and laying out".to_owned(), began: Instant::now() }
    }

    /// The stage called `name` begins, where it has not begun already; gives what there is to say of the one
    /// before.
    pub(super) fn enter(&mut self, name: &str) -> Option<String> {
        if self.name == name {
            return None;
        }
        let seconds = self.began.elapsed().as_secs_f64();
        let before = std::mem::replace(&mut self.name, name.to_owned());
        self.began = Instant::now();
        let is_said = manner::says_details() && !before.is_empty();
        is_said.then(|| format!("time: {seconds:.2} s {before}"))
    }
}

/// Says what was read for `prepared`, the case at `path`, and what was built of it.
pub(super) fn say_prepared(path: &Path, prepared: &Prepared) {
    if !manner::says_details() {
        return;
    }
    let case = &prepared.case;
    match shipped::instead_of(path) {
        Some(_) => detail(&format!("read: case {}, which comes with the program", path.display())),
        None => detail(&format!("read: case {}", path.display())),
    }
    for (name, text) in &prepared.turbine_texts {
        let bytes = HumanBytes(text.len() as u64);
        let is_shipped = wakemix::formats::library::text(name).is_some();
        let place = if is_shipped { ", which comes with the program" } else { "" };
        detail(&format!("read: {name}, {bytes}{place}"));
    }
    if let Some(name) = case.wind.planes.as_ref().or(case.wind.precursor.as_ref()) {
        detail(&format!("read: wind {name}"));
    }
    detail(&format!(
        "built: {} turbines, {} runs; flow solver {}, domain {} × {} × {} cells{}, {} steps of {:.4} s",
        case.turbines.len(),
        case.runs.len(),
        case.flow.solver.name,
        prepared.plan.n_cells[0],
        prepared.plan.n_cells[1],
        prepared.plan.n_cells[2],
        boxes(prepared),
        prepared.plan.n_steps,
        prepared.plan.interval,
    ));
    for run in &case.runs {
        let control = run.control.iter().zip(&case.turbines);
        let kinds: Vec<String> = control
            .map(|(control, turbine)| format!("{} {}", turbine.name, control.kind().name()))
            .collect();
        detail(&format!("built: run {}: {}", run.name, kinds.join(", ")));
    }
}

/// Boxes of finer cells, each with its place in the wind's frame.
fn boxes(prepared: &Prepared) -> String {
    let of_grid = |grid: &GridOfPlan| {
        let [x, y, z] = std::array::from_fn(|axis| {
            let end = grid.origin[axis] + grid.n_cells[axis] as f64 * grid.spacing;
            format!("{:.0} to {end:.0} m", grid.origin[axis])
        });
        format!("; cells of {:.2} m in x = {x}, y = {y}, z = {z}", grid.spacing)
    };
    prepared.plan.grids().iter().skip(1).map(of_grid).collect()
}
