//! Pages that are made from what commands and kinds say of themselves are up to date: command line and case
//! file.

use crate::Arguments;
use clap::builder::StyledStr;
use clap::{Arg, ArgAction, Command, CommandFactory};
use std::fmt::Write;
use std::fs;
use std::path::Path;

const PREFACE: &str = "\
# Command line

Every command and option, made from the program's own help: `wakemix COMMAND --help` and `wakemix man COMMAND` print the same. Data goes to
standard output, all else to standard error. [What a run leaves](outputs.md#exit-codes) has the exit codes.
";

/// The page, from the commands themselves.
fn page() -> String {
    let mut program = Arguments::command();
    program.build();
    let mut page = PREFACE.to_owned();
    let globals: Vec<Arg> =
        program.get_arguments().filter(|argument| argument.is_global_set()).cloned().collect();
    page.push_str("\n## Options of every command\n");
    write_table(&mut page, &globals.iter().collect::<Vec<_>>()).expect("a string takes all text");
    write_command(&mut page, &mut program).expect("a string takes all text");
    page
}

/// Writes `command` and those below it, help aside.
fn write_command(page: &mut String, command: &mut Command) -> std::fmt::Result {
    let usage = command.render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ");
    let is_leaf = !command.has_subcommands();
    if is_leaf {
        let name = usage.split([' ', '\n']).take_while(|word| !word.starts_with(['<', '[', '-']));
        let about = command.get_long_about().or(command.get_about());
        writeln!(page, "\n## `{}`\n", name.collect::<Vec<_>>().join(" "))?;
        writeln!(page, "{}.\n\n```text\n{usage}\n```", line(about).trim_end_matches('.'))?;
        write_arguments(page, command)?;
    }
    for below in command.get_subcommands_mut().filter(|below| below.get_name() != "help") {
        write_command(page, below)?;
    }
    Ok(())
}

fn write_arguments(page: &mut String, command: &Command) -> std::fmt::Result {
    let own = |argument: &&Arg| {
        let is_usual = argument.get_id() == "help" || argument.get_id() == "version";
        !is_usual && !argument.is_global_set()
    };
    let mut arguments: Vec<&Arg> = command.get_arguments().filter(own).collect();
    arguments.sort_by_key(|argument| !argument.is_positional());
    write_table(page, &arguments)
}

fn write_table(page: &mut String, arguments: &[&Arg]) -> std::fmt::Result {
    if arguments.is_empty() {
        return Ok(());
    }
    writeln!(page, "\n| argument | default | meaning |\n| --- | --- | --- |")?;
    for argument in arguments {
        let default: Vec<_> =
            argument.get_default_values().iter().map(|v| v.to_string_lossy()).collect();
        let takes_value = argument.get_action().takes_values();
        let default = match default.join(", ") {
            _ if !takes_value => String::new(),
            none if none.is_empty() && argument.is_required_set() => "required".to_owned(),
            none if none.is_empty() => String::new(),
            value => format!("`{value}`"),
        };
        let meaning = line(argument.get_long_help().or(argument.get_help()));
        writeln!(page, "| {} | {default} | {meaning}{} |", spelling(argument), choices(argument))?;
    }
    Ok(())
}

/// How `argument` is written: `-o, --output OUTPUT`.
fn spelling(argument: &Arg) -> String {
    let values: Vec<&str> =
        argument.get_value_names().unwrap_or_default().iter().map(|n| n.as_str()).collect();
    let value = if argument.get_action().takes_values() { values.join(" ") } else { String::new() };
    let short = argument.get_short().map(|short| format!("-{short}, ")).unwrap_or_default();
    let long = argument.get_long().map(|long| format!("--{long} ")).unwrap_or_default();
    let many = argument.is_positional() && matches!(argument.get_action(), ArgAction::Append);
    format!("`{}`", format!("{short}{long}{value}{}", if many { " ..." } else { "" }).trim())
}

/// The values to choose from, with what each means.
fn choices(argument: &Arg) -> String {
    if !argument.get_action().takes_values() {
        return String::new();
    }
    let values = argument.get_possible_values();
    let words = values.iter().map(|value| match value.get_help() {
        Some(help) => format!("`{}`: {}", value.get_name(), line(Some(help))),
        None => format!("`{}`", value.get_name()),
    });
    let words = words.collect::<Vec<_>>().join("; ");
    if words.is_empty() { words } else { format!(". {words}") }
}

/// Help on one line of a table, its paragraphs as sentences.
fn line(help: Option<&StyledStr>) -> String {
    let words = help.map(ToString::to_string).unwrap_or_default();
    let sentence = |paragraph: &str| {
        let words: Vec<&str> = paragraph.trim_end_matches('.').split_whitespace().collect();
        words.join(" ").replace('|', "\\|")
    };
    words.split("\n\n").map(sentence).collect::<Vec<_>>().join(". ")
}

/// Compares the committed file at `path` with what is `made` now; WAKEMIX_UPDATE=1 writes it instead.
fn is_current(path: &str, made: &str) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..").join(path);
    if std::env::var_os("WAKEMIX_UPDATE").is_some() {
        fs::write(&file, made).unwrap();
    }
    let committed = fs::read_to_string(&file).unwrap_or_default();
    assert!(
        committed == made,
        "{path} is not current: run WAKEMIX_UPDATE=1 cargo test -p wakemix-cli"
    );
}

#[test]
fn the_page_of_the_command_line_is_current() {
    is_current("docs/reference/command-line.md", &page());
}

#[test]
fn page_and_schema_of_the_case_file_are_current() {
    // The program's own outputs are known to it, and not to the room that reads case files.
    wakemix::study::outputs::announce();
    is_current("docs/case-file.md", &wakemix::formats::case::reference());
    is_current("docs/case.schema.json", &wakemix::formats::case::schema());
    is_current("docs/precursor-file.md", &wakemix::formats::case::precursor_reference());
    is_current("docs/precursor.schema.json", &wakemix::formats::case::precursor_schema());
}
