//! What is made from the definition of the commands: completions for shells, and manual pages.

use super::output::{print, tell};
use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use std::path::PathBuf;
use wakemix::formats::atomic;

/// Arguments of `wakemix man`.
#[derive(Args)]
pub(crate) struct ManArguments {
    /// Command whose page is printed, such as `run` or `turbine show`; the program's own when left out
    command: Vec<String>,
    /// Write the pages of the program and of all its commands into this folder instead, such as
    /// ~/.local/share/man/man1
    #[arg(short, long, value_name = "FOLDER", conflicts_with = "command")]
    output: Option<PathBuf>,
}

/// Prints the completions of `program` for `shell`.
///
/// # Errors
/// An output that takes no more.
pub(crate) fn completions(shell: Shell, mut program: Command) -> Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, "wakemix", &mut script);
    print(&String::from_utf8_lossy(&script))
}

/// Prints the manual page that `arguments` ask for, or writes all of them.
///
/// # Errors
/// A command that there is not, a folder that cannot be written, an output that takes no more.
pub(crate) fn man(arguments: &ManArguments, program: Command) -> Result<()> {
    let pages = pages(program)?;
    if let Some(folder) = &arguments.output {
        std::fs::create_dir_all(folder)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot make the folder {}", folder.display()))?;
        for (name, page) in &pages {
            atomic::write(&folder.join(format!("{name}.1")), "a manual page", page.as_bytes())?;
        }
        tell(&format!("wrote {} pages into {}", pages.len(), folder.display()));
        return Ok(());
    }
    let name = ["wakemix"].into_iter().chain(arguments.command.iter().map(String::as_str));
    let name = name.collect::<Vec<_>>().join("-");
    let Some((_, page)) = pages.iter().find(|(own, _)| *own == name) else {
        let known: Vec<String> = pages
            .iter()
            .skip(1)
            .map(|(name, _)| name["wakemix-".len()..].replace('-', " "))
            .collect();
        return Err(miette!(
            help = format!("there are: {}", known.join(", ")),
            "there is no command `{}`",
            arguments.command.join(" ")
        ));
    };
    print(page)
}

/// Name and text of the page of each command, the program's own first.
fn pages(program: Command) -> Result<Vec<(String, String)>> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let mut pages = Vec::new();
    add_pages(&program, "wakemix".to_owned(), &mut pages)?;
    Ok(pages)
}

fn add_pages(command: &Command, name: String, pages: &mut Vec<(String, String)>) -> Result<()> {
    let mut page = Vec::new();
    let made_by = format!("wakemix {}", env!("CARGO_PKG_VERSION"));
    Man::new(command.clone()).source(made_by).render(&mut page).into_diagnostic()?;
    pages.push((name.clone(), String::from_utf8_lossy(&page).into_owned()));
    for below in command.get_subcommands() {
        add_pages(below, format!("{name}-{}", below.get_name()), pages)?;
    }
    Ok(())
}
