//! Keys of the file of a campaign: the case, what is varied in it, what is kept.

use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Table, key};

/// The whole file.
pub(in crate::case) static CAMPAIGN: Table = Table {
    heading: "(top of the file)",
    about: "One case, and what is varied in it: every combination of levels is a task.",
    keys: &[
        key(
            "name",
            Holds::Folder,
            "",
            Otherwise("the name of the file"),
            "Name of the campaign; its folder is called so.",
        ),
        key(
            "description",
            Holds::Text,
            "",
            Otherwise("no description"),
            "What it is for, in one line.",
        ),
        key(
            "case",
            Holds::Text,
            "",
            Required,
            "Case file that is varied, relative to this file, or the name of a case that comes with the program.",
        ),
        key(
            "factors",
            Holds::Sweep,
            "",
            Otherwise("none"),
            "Levels of each key that is varied: \"wind.speed\" = [8, 10], or { from = 6, to = 12, step = 2 }.",
        ),
        key(
            "linked",
            Holds::Sweep,
            "",
            Otherwise("none"),
            "Factors whose levels set several keys at once: [[linked]] with name and levels = [{ name = \"helix\", \"KEY\" = VALUE, ... }, ...].",
        ),
        key(
            "table",
            Holds::Text,
            "",
            Otherwise("none"),
            "CSV, relative to this file, whose columns are keys: each row is a level of one factor.",
        ),
        key(
            "seeds",
            Holds::Sweep,
            "–",
            Otherwise("the case's own seed"),
            "Seeds of the wind: a list, or { from = 1, to = 6, step = 1 }.",
        ),
        key(
            "seed_key",
            Holds::Text,
            "",
            Value("\"wind.seed\""),
            "Key that the seeds are put under.",
        ),
        key(
            "exclude",
            Holds::Sweep,
            "",
            Otherwise("nothing"),
            "Tasks that are left out: [[exclude]] with a value, or a list of them, for each of some keys or linked factors.",
        ),
        key(
            "draw",
            Holds::Whole { least: 1, most: 10_000_000 },
            "–",
            Otherwise("all"),
            "So many combinations of levels alone, drawn by chance, always the same ones, each with all its seeds.",
        ),
        key(
            "draw_whole",
            Holds::Sweep,
            "",
            Otherwise("none"),
            "Factors that are not drawn: each combination that is drawn of the others is made with all of their levels, as with all seeds.",
        ),
        key(
            "runs",
            Holds::Sweep,
            "",
            Otherwise("all"),
            "Names of the runs of the case that each task makes.",
        ),
        key(
            "keep",
            Holds::Choice(&["summary", "series", "all"]),
            "",
            Value("\"summary\""),
            "What stays of a task: its numbers alone, its series as well, or everything that a run leaves.",
        ),
        key(
            "collect",
            Holds::Sweep,
            "",
            Otherwise("all"),
            "Names of the numbers that `collect` writes, `*` for any part: [\"T1.*\", \"*.power.mean\"].",
        ),
        key(
            "threads",
            Holds::Whole { least: 1, most: 1024 },
            "–",
            Otherwise("1 in prescribed wind, else all cores"),
            "Threads of a task. The results do not depend on it.",
        ),
    ],
};
