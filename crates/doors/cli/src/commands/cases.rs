//! `wakemix cases`: what comes with the program, studies and precursors, and how to get at it.

use super::arguments::check_free;
use super::output::{columns, print, tell};
use clap::Args;
use miette::{Result, miette};
use std::path::PathBuf;
use wakemix::formats::{atomic, shipped};
use wakemix::report::text_table::{Column, TextTable};

/// Arguments of `wakemix cases`.
#[derive(Args)]
pub(crate) struct CasesArguments {
    /// Case to write out, by its name, or control law, by that of its file; a list of all when left out
    name: Option<String>,
    /// File to write; NAME.toml, of a law NAME, in the current folder when left out, - for standard output
    #[arg(short, long, value_name = "FILE", requires = "name")]
    output: Option<PathBuf>,
    /// Put the new file in the place of an old one
    #[arg(long, requires = "name")]
    overwrite: bool,
}

/// Lists the shipped cases, or writes one.
///
/// # Errors
/// A name that there is not, a file that is there already or cannot be written.
pub(crate) fn run(arguments: &CasesArguments) -> Result<()> {
    let Some(name) = &arguments.name else { return print(&list(columns())?) };
    let study = shipped::find(name).map(|case| case.text());
    let law = shipped::find_law(name);
    let precursor = || shipped::find_precursor(name).map(|shipped| shipped.text());
    let text = study.or_else(precursor).or_else(|| law.map(str::to_owned));
    let Some(text) = text else {
        let studies = shipped::CASES.iter().map(|case| case.name);
        let precursors = shipped::PRECURSORS.iter().map(|shipped| shipped.name);
        let laws = shipped::LAWS.iter().map(|(name, _)| *name);
        let names: Vec<&str> = studies.chain(precursors).chain(laws).collect();
        return Err(miette!(
            help = format!("there are: {}", names.join(", ")),
            "no case called `{name}` comes with the program"
        ));
    };
    let usual = || PathBuf::from(if law.is_some() { name.clone() } else { format!("{name}.toml") });
    let output = arguments.output.clone().unwrap_or_else(usual);
    if output.as_os_str() == "-" {
        return print(&text);
    }
    check_free(std::slice::from_ref(&output), arguments.overwrite)?;
    let what = if law.is_some() { "the control law" } else { "the case file" };
    atomic::write(&output, what, text.as_bytes())?;
    tell(&format!("wrote {}", output.display()));
    for (law, _) in shipped::LAWS.iter().filter(|(law, _)| text.contains(law)) {
        tell(&format!("it reads {law}: that of the program, unless such a file stands beside it"));
    }
    Ok(())
}

/// Name, cost and purpose of each case, in `width` columns.
fn list(width: usize) -> Result<String> {
    let columns = [Column::number("runs"), Column::words("takes"), Column::words("shows")];
    let mut table = TextTable::new([Column::words("name")], columns);
    for shipped in shipped::CASES {
        let cases = shipped.cases()?;
        let runs = cases.iter().map(|case| case.runs.len()).sum::<usize>().to_string();
        let takes = takes(shipped.minutes);
        let description = cases.into_iter().next().and_then(|case| case.description);
        let mut shows = description.unwrap_or_default();
        if let Some(before) = shipped.after {
            shows += &format!(" (after {before})");
        }
        table.row([shipped.name.to_owned(), runs, takes, shows]);
    }
    for shipped in shipped::PRECURSORS {
        let shows = shipped.precursor()?.precursor.description.unwrap_or_default();
        let shows = shows + " (`wakemix inflow precursor NAME`)";
        table.row([shipped.name.to_owned(), String::new(), takes(shipped.minutes), shows]);
    }
    let below = "takes: all its runs on two cores, about; `wakemix run NAME --dry-run` says it for this machine\n";
    Ok(table.fitted(width) + &wakemix::report::text_table::wrapped(below, width))
}

/// `minutes` in words.
fn takes(minutes: f64) -> String {
    match minutes {
        short if short < 1.0 => format!("{:.0} s", 60.0 * short),
        short if short < 100.0 => format!("{short:.0} min"),
        long => format!("{:.1} h", long / 60.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wakemix::study::Prepared;

    #[test]
    fn every_case_stands_in_the_list() {
        wakemix::study::outputs::announce();
        for width in [100, 60] {
            let text = list(width).unwrap();
            let widest = text.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(widest <= width, "{widest}: {text}");
            let studies = shipped::CASES.iter().map(|case| case.name);
            for name in studies.chain(shipped::PRECURSORS.iter().map(|shipped| shipped.name)) {
                assert!(text.lines().any(|line| line.starts_with(name)), "{text}");
            }
        }
        assert_eq!([0.2, 3.0, 270.0].map(takes), ["12 s", "3 min", "4.5 h"]);
    }

    /// What the list says of the cost is the cost, for a machine that moves 200 million cells a second: on
    /// the lattice, where cells and steps are all there is to it.
    #[test]
    fn costs_are_those_of_the_cases() {
        wakemix::study::outputs::announce();
        for shipped in shipped::CASES.iter().filter(|case| case.after.is_none()) {
            let work = |case| {
                let prepared = Prepared::of(case).unwrap();
                let cells: usize = prepared.plan.n_cells.iter().product();
                cells as f64 * prepared.plan.n_steps as f64 * prepared.case.runs.len() as f64
            };
            let work: f64 = shipped.cases().unwrap().into_iter().map(work).sum();
            if work > 0.0 {
                let minutes = work / 200e6 / 60.0;
                let ratio = shipped.minutes / minutes;
                assert!((0.5..2.0).contains(&ratio), "{}: {minutes:.1} min", shipped.name);
            }
        }
    }
}
