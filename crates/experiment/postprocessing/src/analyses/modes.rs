//! `modes`: what moves together in a wake, by energy and by energy at each frequency.

mod figures;
mod found;
mod source;

use super::{Analysis, AnalysisSetting, Answer, FIGURES, Of, Request, Takes, drawn};
use crate::PostprocessingError;
use crate::wake_fields::settings::{
    self, AZIMUTHS, DIAMETER, EXCITATION_HZ, FIELD, FROM, HUB, LENGTHS, MEMORY, ROTOR_HZ, TURBINE,
    WIND_SPEED, ZEROS,
};
use crate::wake_fields::{Fields, Instants, NO_TIMES, TELL_TIMES, refused};
use found::{Found, Question};
use report::Signals;
use report::text_table::{Column, TextTable};
use serde_json::json;
use source::Source;

/// The analysis.
pub(super) const ANALYSIS: Analysis = Analysis {
    name: "modes",
    about: "What moves together in a wake: modes by energy (POD, method of snapshots) and by energy at each frequency (SPOD, Towne, Schmidt and Colonius 2018), those of the helix and the rotor named",
    of: Of::Run(
        "Folder of a run that kept planes at instants, or a file of fields (NetCDF, .vti or a folder of them, Tecplot's text)",
    ),
    settings: &[
        FIELD,
        TURBINE,
        COMPONENT,
        BLOCK,
        OVERLAP,
        MODES,
        EXCITATION_HZ,
        ROTOR_HZ,
        MEMORY,
        FROM,
        AZIMUTHS,
        DIAMETER,
        WIND_SPEED,
        HUB,
        LENGTHS,
        ZEROS,
        FIGURES,
    ],
    run,
};

const COMPONENT: AnalysisSetting = AnalysisSetting {
    name: "component",
    value: "COMPONENT",
    takes: Takes::Choice(&[
        ("u", "Downwind"),
        ("v", "To the left looking downwind"),
        ("w", "Upward"),
        ("all", "All three"),
    ]),
    about: "Component of the velocity that counts; all three when left out",
};
const BLOCK: AnalysisSetting = settings::setting(
    "block",
    "N",
    Takes::Number,
    "Instants of a block; whole periods of the helix in about a third of the record when left out",
);
const OVERLAP: AnalysisSetting = settings::setting(
    "overlap",
    "SHARE",
    Takes::Number,
    "Share of a block that the next one has, too; 0.5 when left out",
);
const MODES: AnalysisSetting =
    settings::setting("modes", "N", Takes::Number, "Modes whose shapes are kept; 3 when left out");
/// Frequencies that the table lists beside those with a name (–).
const N_LISTED: usize = 5;
/// Modes whose energy the table shows (–).
const N_SHOWN: usize = 3;

fn run(request: &Request) -> Result<Answer, PostprocessingError> {
    let found = found(request)?;
    let mut remarks = Vec::from_iter(drawn(request, &[figures::signals(&found)])?);
    remarks.extend(left_out(&found));
    Ok(Answer { text: text(&found, request.width()), json: json(&found), remarks })
}

/// The figures of what `request` asks for, and what must be said.
///
/// # Errors
/// [`PostprocessingError`].
pub(crate) fn shown(request: &Request) -> Result<Signals, PostprocessingError> {
    let found = found(request)?;
    Ok(Signals { notes: Vec::from_iter(left_out(&found)), ..figures::signals(&found) })
}

/// Points without modes, in words; none where all have some.
fn left_out(found: &Found) -> Option<String> {
    let (n, all) = (found.spod.n_masked, found.grid.len());
    (n > 0).then(|| format!("{n} of {all} points have a hole at some instant and are left out"))
}

/// The modes of the fields that `request` is about.
fn found(request: &Request) -> Result<Found, PostprocessingError> {
    let instants = Fields::instants(request)?;
    let path = instants.file.path().to_owned();
    if !instants.file.has_times() {
        return Err(refused(&path, NO_TIMES, TELL_TIMES));
    }
    let question = question(request, &instants)?;
    let Instants { file, setting, places, .. } = instants;
    let mut source = Source { file, places };
    Found::of(&mut source, setting, &question).map_err(|trouble| trouble.at(&path))
}

/// What `request` asks for.
fn question(request: &Request, instants: &Instants) -> Result<Question, PostprocessingError> {
    let span = instants.span();
    let rates = instants.angles.as_ref().and_then(|angles| angles.rates(span));
    let component = request.text(COMPONENT.name).unwrap_or("all");
    let given = |setting: &AnalysisSetting| {
        let is_given = request.text(setting.name).is_some();
        is_given.then(|| settings::positive(request, setting, 1.0)).transpose()
    };
    let is_asked = request.text(BLOCK.name).is_some();
    Ok(Question {
        components: ["u", "v", "w"].map(|name| component == "all" || component == name),
        n_block: is_asked.then(|| settings::whole(request, &BLOCK, 4, 4)).transpose()?,
        overlap: request.number(OVERLAP.name).unwrap_or(0.5),
        n_modes: settings::whole(request, &MODES, 1, 3)?,
        memory: (settings::whole(request, &MEMORY, 1, 256)? as u64) << 20,
        excitation: given(&EXCITATION_HZ)?
            .or(rates.and_then(|(_, helix)| helix).map(|(rate, _)| rate)),
        rotor: given(&ROTOR_HZ)?.or(rates.map(|(rotor, _)| rotor)),
    })
}

/// Numbers of the frequencies that are listed, ascending: those with a name, and the strongest.
fn listed(answer: &Found) -> Vec<usize> {
    let n = answer.spod.densities.len();
    let mut order: Vec<usize> = (1..n).collect();
    order.sort_by(|a, b| answer.spod.density(*b).total_cmp(&answer.spod.density(*a)));
    let mut listed: Vec<usize> = order.into_iter().take(N_LISTED).collect();
    listed.extend((1..n).filter(|index| answer.name_of(*index).is_some()));
    listed.sort_unstable();
    listed.dedup();
    listed
}

/// What stands below the tables.
const CONVENTIONS: &str = "energy: mean over the area of |u'|²; over frequency one-sided, a step wide; share: of all modes at the frequency, and of all energy; POD frequency: strongest line of the mode's coefficient, with its share of the mode's energy\n";

fn text(answer: &Found, width: usize) -> String {
    let spod = &answer.spod;
    let [low, high] = spod.interval_95;
    let mut text = format!(
        "{}\n{}; a step of {:.4} Hz; a density lies with 95 % between {low:.2} and {high:.2} of its value; strips of at most {:.0} MB\n",
        answer.conditions,
        answer.samples(),
        spod.frequency_step,
        answer.memory as f64 / f64::from(1 << 20)
    );
    let mut columns = vec![Column::number("energy m²/s²"), Column::number("of all %")];
    columns.extend((1..=N_SHOWN).map(|mode| Column::number(format!("mode {mode} %"))));
    columns.push(Column::words("name"));
    let mut table = TextTable::new([Column::number("frequency Hz")], columns);
    for index in listed(answer) {
        let all = spod.density(index);
        let energy = all * spod.frequency_step;
        let mut cells = vec![
            format!("{:.4}", spod.frequency(index)),
            format!("{energy:.5}"),
            format!("{:.2}", 100.0 * energy / spod.total()),
        ];
        let share = |mode: usize| spod.densities[index].get(mode).map(|part| 100.0 * part / all);
        cells.extend(
            (0..N_SHOWN).map(|m| share(m).map_or("–".into(), |share| format!("{share:.1}"))),
        );
        cells.push(answer.name_of(index).unwrap_or_default());
        table.row(cells);
    }
    text += &table.fitted(width);
    text += &by_energy(answer, width);
    text + CONVENTIONS
}

/// The table of the modes over all frequencies.
fn by_energy(answer: &Found, width: usize) -> String {
    let headings = ["energy m²/s²", "of all %", "frequency Hz", "line %"];
    let mut columns: Vec<Column> = headings.into_iter().map(Column::number).collect();
    columns.push(Column::words("name"));
    let mut table = TextTable::new([Column::number("POD mode")], columns);
    for (mode, line) in answer.pod_lines.iter().enumerate() {
        let energy = answer.pod.energies[mode];
        let [frequency, share] = line
            .map_or(["–".to_owned(), "–".to_owned()], |[frequency, share]| {
                [format!("{frequency:.4}"), format!("{:.1}", 100.0 * share)]
            });
        table.row([
            format!("{}", mode + 1),
            format!("{energy:.5}"),
            format!("{:.2}", 100.0 * energy / answer.pod.total),
            frequency,
            share,
            answer.pod_name(mode).unwrap_or_default(),
        ]);
    }
    table.fitted(width)
}

fn json(answer: &Found) -> serde_json::Value {
    let (spod, pod) = (&answer.spod, &answer.pod);
    let frequencies: Vec<f64> = (0..spod.densities.len()).map(|i| spod.frequency(i)).collect();
    let names: Vec<_> = (0..spod.densities.len()).map(|index| answer.name_of(index)).collect();
    let pod_modes = answer.pod_lines.iter().enumerate().map(|(mode, line)| {
        json!({
            "energy_m2_s2": pod.energies[mode],
            "frequency_hz": line.map(|line| line[0]),
            "line_share": line.map(|line| line[1]),
            "name": answer.pod_name(mode),
            "coefficients_m_s": pod.coefficients[mode],
        })
    });
    let pairs = ["u", "v", "w"].into_iter().zip(answer.components);
    let components: Vec<&str> = pairs.filter(|(_, is)| *is).map(|(name, _)| name).collect();
    let named = answer.names.all.iter();
    let named = named.map(|one| json!({ "name": one.name, "frequency_hz": one.frequency }));
    json!({
        "conditions": answer.conditions,
        "components": components,
        "n_points": answer.grid.len(),
        "n_masked": spod.n_masked,
        "n_instants": answer.n_instants,
        "from_s": answer.span[0],
        "to_s": answer.span[1],
        "strip_bytes": answer.memory,
        "wind_speed_m_s": answer.setting.wind_speed,
        "diameter_m": answer.setting.diameter,
        "named_frequencies": named.collect::<Vec<_>>(),
        "spod": {
            "n_blocks": spod.n_blocks,
            "block": spod.n_block,
            "hop": spod.hop,
            "window": "hamming",
            "frequency_step_hz": spod.frequency_step,
            "interval_95": spod.interval_95,
            "frequencies_hz": frequencies,
            "names": names,
            "densities_m2_s2_hz": spod.densities,
            "total_m2_s2": spod.total(),
        },
        "pod": {
            "total_m2_s2": pod.total,
            "energies_m2_s2": pod.energies,
            "modes": pod_modes.collect::<Vec<_>>(),
        },
    })
}
