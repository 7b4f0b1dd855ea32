//! The page: one HTML file with style, script, figures and case file inside.

pub(crate) mod answer;
mod control;
mod loads;
pub(crate) mod precursor;
pub(crate) mod sweep;
mod tables;

use crate::ReportError;
use crate::draw::colour::{Ink, hex};
use crate::draw::{Figure, svg};
use crate::figures::Figures;
use crate::sentence;
use crate::study::Study;
use crate::words;
use basis::records::Summary;
use minijinja::{Environment, Value, context};
use std::fmt::Write;

const TEMPLATE: &str = include_str!("report.html");
/// What several pages have: how they begin, warnings, facts, figures.
const SHARED: [(&str, &str); 4] = [
    ("head.html", include_str!("head.html")),
    ("warnings.html", include_str!("warnings.html")),
    ("facts.html", include_str!("facts.html")),
    ("figures.html", include_str!("figures.html")),
];
const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");
/// Zoom and pointer of D3, and its licences.
const D3: &str = include_str!("d3/d3.min.js");
const D3_LICENCES: &str = include_str!("d3/LICENSE");

/// The page of `study` with `figures`.
pub(crate) fn render(study: &Study, figures: &Figures) -> Result<String, ReportError> {
    let records = study.records;
    let best = study.best();
    let warnings = warnings(study);
    let (glance_heads, glance) = tables::glance(study);
    let lead = leading(figures);
    let leading = lead.iter().map(|figure| drawing(figure)).collect::<Result<Vec<_>, _>>()?;
    let sentences: Vec<Vec<String>> = study
        .runs()
        .iter()
        .filter(|run| best.is_some_and(|best| best.summary.run != run.summary.run))
        .filter_map(|run| Some(vec![run.summary.run.clone(), sentence::short_gain(study, run)?]))
        .collect();
    let own = context! {
        title => records.case_name.clone(),
        description => records.description.clone(),
        version => records.version.clone(),
        incomplete => sentence::incomplete(study),
        headline => sentence::headline(study),
        confidence => sentence::confidence(study),
        headline_conditions => sentence::conditions_line(study, best),
        compared_with => best.and_then(|run| run.summary.compare_with.clone()),
        other_results => sentences,
        warnings => warnings,
        chips => chips(study),
        conditions => tables::conditions(study),
        excitations => control::excitations(study),
        responses => control::responses(study),
        glance_heads,
        glance,
        rows => tables::results(study),
        power_unit => study.units().power.name,
        thrust_unit => study.units().thrust.name,
        has_gains => best.is_some(),
        load_conventions => loads::conventions(study),
        loads => loads::loads(study),
        bearings => loads::bearings(study),
        meanderings => control::meanderings(study),
        findings => control::findings(study),
        run_names => study.names().into_iter().map(|(_, name)| name.to_owned()).collect::<Vec<_>>(),
        conditions_line => sentence::conditions_line(study, None),
        small_print => small_print(study),
        leading,
        parts => parts(figures, lead)?,
        phases => control::phases(study),
        costs => tables::costs(study),
        case_text => records.case_text.clone(),
    };
    filled("report.html", TEMPLATE, own)
}

/// The page of the `template` called `name`, filled in with what is its `own`; head, style and script are
/// those of every page.
fn filled(name: &'static str, template: &'static str, own: Value) -> Result<String, ReportError> {
    let mut environment = Environment::new();
    // The name's ending turns escaping on.
    for (name, part) in SHARED {
        environment.add_template(name, part)?;
    }
    environment.add_template(name, template)?;
    let page = environment.get_template(name)?.render(context! {
        style => Value::from_safe_string(format!("{}{STYLE}", inks())),
        script => Value::from_safe_string(format!("/*\n{D3_LICENCES}*/\n{D3}\n{SCRIPT}")),
        ..own
    })?;
    Ok(page + "\n")
}

/// The colours of every ink as variables, for light and dark pages, and the classes that use them.
fn inks() -> String {
    let list = |dark: bool| -> String {
        Ink::all().map(|ink| format!("--{}:{};", ink.name(), hex(ink.rgb(dark)))).collect()
    };
    let mut css = format!(":root{{{}}}", list(false));
    let _ = write!(css, "@media (prefers-color-scheme:dark){{:root{{{}}}}}", list(true));
    let _ = write!(css, "@media print{{:root{{{}}}}}", list(false));
    for name in Ink::all().map(Ink::name) {
        let _ = write!(css, ".f-{name}{{fill:var(--{name})}}.s-{name}{{stroke:var(--{name})}}");
    }
    css
}

fn chips(study: &Study) -> Vec<Value> {
    study
        .runs()
        .iter()
        .zip(&study.colours)
        .map(|(run, &colour)| {
            let mut controls: Vec<String> = sentence::excitation_conditions(study, run);
            if controls.is_empty() {
                let turbines = run.summary.turbines.iter();
                controls = turbines.map(|turbine| turbine.control.description.clone()).collect();
                controls.dedup();
            }
            context! {
                colour,
                ink => Ink::Run(colour).name(),
                name => run.summary.run.clone(),
                control => controls.join("; "),
            }
        })
        .collect()
}

/// Every warning once, with the runs that it came from.
fn warnings(study: &Study) -> Vec<Vec<String>> {
    let mut found: Vec<(&str, Vec<String>)> = Vec::new();
    for run in study.runs() {
        for warning in &run.summary.warnings {
            match found.iter_mut().find(|(known, _)| *known == warning.message) {
                Some((_, runs)) => runs.push(run.summary.run.clone()),
                None => found.push((&warning.message, vec![run.summary.run.clone()])),
            }
        }
    }
    found
        .into_iter()
        .map(|(warning, runs)| {
            let all = runs.len() == study.runs().len() && runs.len() > 1;
            let origin = if all { "all runs".to_owned() } else { words::list(&runs) };
            vec![words::capitalised(warning), origin]
        })
        .collect()
}

/// How the air was moved, and what that leaves out.
fn method(summary: &Summary) -> String {
    let solver = summary.flow.as_ref().map_or("prescribed", |flow| flow.solver.as_str());
    match (summary.conditions.cells_per_diameter, summary.has_wakes()) {
        (Some(_), true) => "Large-eddy simulation with actuator lines: blades are lines of force from tabulated \
                            aerofoil data; rotor speed follows torque and inertia; blades, tower and drive train \
                            bend unless the case says rigid."
            .to_owned(),
        (None, true) => format!(
            "Flow solver “{solver}”, without a grid, whose wind holds wakes; what they are made of is that \
             solver's own."
        ),
        (_, false) => "Prescribed wind: turbines make their own induction by blade-element momentum with skewed \
                       wake, and with dynamic inflow and dynamic stall unless the case says otherwise; no turbine \
                       feels another's wake, so their power is not added up. What a helix does to wakes is not in \
                       these figures."
            .to_owned(),
    }
}

/// What a careful reader must know of the method and its coarseness.
fn small_print(study: &Study) -> Vec<String> {
    let summary = &study.runs()[0].summary;
    let conditions = &summary.conditions;
    let mut items = vec![method(summary)];
    let limits = summary.flow.as_ref().map_or("", |flow| flow.limits.as_str());
    items.extend((!limits.is_empty()).then(|| limits.to_owned()));
    if let Some(cells) = conditions.cells_per_diameter.filter(|cells| *cells < 24.0) {
        items.push(format!(
            "{} cells per diameter are coarse: the near wake and the tip vortices are blurred, small \
             turbulence is modelled rather than resolved. Differences between runs are more \
             trustworthy than absolute values; repeat at 24 to 32 cells before relying on either.",
            words::number(cells, 0)
        ));
    }
    let n_blocks = summary.array_power.n_blocks;
    if n_blocks < 6 {
        items.push(format!(
            "Intervals rest on {} {} of one realisation of the turbulence (seed {}). They cover \
             sampling error, not errors of the model; longer runs or more seeds narrow them.",
            words::small_count(n_blocks),
            if n_blocks == 1 { "block" } else { "blocks" },
            conditions.seed
        ));
    }
    items.push(
        "Gains are ratios of mean power to the compared run in the same inflow, minus one; their \
         intervals come from paired blocks. Counter-clockwise means that the blades pitch at rotor \
         frequency plus excitation frequency."
            .to_owned(),
    );
    items
}

/// Parts of the page: anchor, heading, lead, and the figures that belong there.
const PARTS: [(&str, &str, &str, &[&str]); 3] = [
    ("power-figures", "Power", "", &["gains", "gain-over-amplitude", "power"]),
    (
        "wake-figures",
        "The wake",
        "Velocities are relative to the target free stream at hub height; lengths to the first turbine's \
         rotor diameter D.",
        &[
            "mean-hub-height",
            "difference-hub-height",
            "instant-hub-height",
            "mean-streamwise",
            "mean-crosswind",
            "wake-geometry",
            "profiles",
            "recovery",
        ],
    ),
    ("blade-figures", "Blades and rotor", "", &["pitch", "rotor-speed"]),
];

/// The figures that the page opens with: the wake from above, and the gains, or else power over time.
fn leading(figures: &Figures) -> Vec<&Figure> {
    let named = |name: &str| figures.study.iter().find(|figure| figure.name == name);
    let second = named("gains").or_else(|| named("power"));
    named("mean-hub-height").into_iter().chain(second).collect()
}

/// The figures without those that lead, in the order and under the headings of the page.
fn parts(figures: &Figures, lead: Vec<&Figure>) -> Result<Vec<Value>, ReportError> {
    const JOINED: &str = "A turbine finds the helix that meets it in its blade loads, and joins it with a phase offset: the lead of its \
         pitch over the wind that meets it.";
    // What has no place of its own stands in the last.
    let place = |figure: &Figure| {
        let name = figure.name.as_str();
        PARTS.iter().position(|(.., names)| names.contains(&name)).unwrap_or(PARTS.len() - 1)
    };
    let leads = |figure: &&Figure| lead.iter().any(|other| other.name == figure.name);
    let mut parts = Vec::new();
    for (index, (id, title, words, _)) in PARTS.iter().enumerate() {
        let here = figures.study.iter().filter(|figure| place(figure) == index);
        parts.extend(part(id, [title, words], here.filter(|figure| !leads(figure)), &[])?);
    }
    for (index, (title, figures)) in figures.joined.iter().enumerate() {
        parts.extend(part(&format!("joined-{}", index + 1), [title, JOINED], figures.iter(), &[])?);
    }
    for (index, own) in figures.signals.iter().enumerate() {
        let (id, words) = (format!("signals-{}", index + 1), [own.title.as_str(), &own.lead]);
        parts.extend(part(&id, words, own.figures.iter(), &own.notes)?);
    }
    Ok(parts)
}

/// `figures` and `notes` under a heading with an anchor and a lead; nothing where there is neither.
fn part<'f>(
    id: &str,
    [title, lead]: [&str; 2],
    figures: impl Iterator<Item = &'f Figure>,
    notes: &[String],
) -> Result<Option<Value>, ReportError> {
    let drawings: Vec<Value> = figures.map(drawing).collect::<Result<_, _>>()?;
    let is_empty = drawings.is_empty() && notes.is_empty();
    Ok((!is_empty)
        .then(|| context! { id, title, lead, figures => drawings, notes => notes.to_vec() }))
}

/// A figure for the template.
fn drawing(figure: &Figure) -> Result<Value, ReportError> {
    let drawn = svg::inline(figure)
        .map_err(|source| ReportError::Picture { figure: figure.name.clone(), source })?;
    Ok(context! {
        name => figure.name.clone(),
        title => figure.title.clone(),
        caption => figure.caption.clone(),
        svg => Value::from_safe_string(drawn),
    })
}
