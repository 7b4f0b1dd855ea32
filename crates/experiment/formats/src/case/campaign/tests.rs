//! Files of campaigns: what their factors come to, and what is told of those that are wrong.

use super::*;
use std::fs;
use tempfile::TempDir;

const CASE: &str = "
name = \"c\"
[[run]]
name = \"baseline\"
[[run]]
name = \"helix\"
control.T1 = { kind = \"helix\", sense = \"ccw\", amplitude_deg = 3.0, strouhal = 0.25 }
";

/// A folder with the campaign of `text` over [`CASE`].
fn written(text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.toml"), CASE).unwrap();
    fs::write(folder.path().join("loads.toml"), format!("case = \"case.toml\"\n{text}")).unwrap();
    folder
}

fn read(text: &str) -> Result<CampaignFile, CaseError> {
    read_campaign(&written(text).path().join("loads.toml"), &|_| None)
}

fn names(factor: &Factor) -> Vec<String> {
    factor.levels.iter().map(|level| level.name.words()).collect()
}

#[test]
fn lists_ranges_and_linked_keys_are_factors() {
    let file = read(
        "seeds = { from = 1, to = 3, step = 1 }
        [factors]
        wind.speed = [8, 10.5]
        \"wind.turbulence_intensity\" = { from = 0.1, to = 0.3, step = 0.1 }
        [[linked]]
        name = \"control\"
        levels = [
            { name = \"greedy\", \"run.helix.control.T1\" = { kind = \"baseline\" } },
            { name = \"wide\", \"run.helix.control.T1\" = { kind = \"pulse\", amplitude_deg = 1.0 } },
        ]
        [[exclude]]
        \"wind.speed\" = 8
        control = \"greedy\"",
    )
    .unwrap();
    assert_eq!((file.name.as_str(), file.keep), ("loads", Keep::Summary));
    let [speed, intensity, control, seed] = &file.factors[..] else { panic!("{:?}", file.factors) };
    assert_eq!(names(speed), ["8", "10.5"]);
    // Not 0.30000000000000004.
    assert_eq!(names(intensity), ["0.1", "0.2", "0.3"]);
    assert_eq!(intensity.levels[2].settings[0].text, "0.3");
    assert_eq!((control.is_linked, names(control)), (true, vec!["greedy".into(), "wide".into()]));
    assert_eq!(control.levels[0].settings[0].text, "{ kind = \"baseline\" }");
    assert_eq!((seed.name.as_str(), names(seed).len()), ("wind.seed", 3));
    assert_eq!(file.excluded[0].conditions.len(), 2);
}

#[test]
fn a_key_of_controls_goes_to_every_run_that_takes_it() {
    let file = read("[factors]\n\"control.T1.amplitude_deg\" = [1.0, 2.0]").unwrap();
    let setting = &file.factors[0].levels[1].settings[0];
    assert_eq!(setting.places, ["run.helix.control.T1.amplitude_deg"]);
    assert_eq!(setting.key, "control.T1.amplitude_deg");
}

#[test]
fn rows_of_a_table_are_levels() {
    let folder = written("table = \"points.csv\"");
    let path = folder.path().join("points.csv");
    fs::write(&path, "wind.speed, run.helix.control.T1.sense\n8,cw\n# later\n9.5,ccw\n").unwrap();
    let file = read_campaign(&folder.path().join("loads.toml"), &|_| None).unwrap();
    let texts: Vec<&str> =
        file.factors[0].levels.iter().flat_map(|l| &l.settings).map(|s| s.text.as_str()).collect();
    assert_eq!(texts, ["8", "\"cw\"", "9.5", "\"ccw\""]);
    fs::write(&path, "wind.speed,wind.seed\n8,1\n9\n").unwrap();
    let error =
        read_campaign(&folder.path().join("loads.toml"), &|_| None).unwrap_err().to_string();
    assert!(error.contains("points.csv") && error.contains("line 3: 1 values"), "{error}");
}

#[test]
fn what_is_wrong_is_told_with_its_line_and_a_fix() {
    for (text, expected) in [
        ("[factor]\n\"wind.speed\" = [8]", ":2: there is no key `factor`; did you mean `factors`"),
        ("keep = \"some\"\n[factors]\n\"wind.speed\" = [8]", "`keep` = \"some\" is unknown"),
        ("[factors]\n\"wind.speed\" = []", ":3: `wind.speed` must have a list of levels"),
        (
            "[factors]\n\"wind.speed\" = { from = 1, to = 2, step = 0.3 }",
            "a range that its steps fill",
        ),
        ("[factors]\n\"wind.speed\" = [8, 8.0]", "`wind.speed` has the level 8 twice"),
        (
            "[factors]\n\"control.T2.strouhal\" = [0.2]",
            "no run of the case takes `control.T2.strouhal`",
        ),
        ("seeds = [0.5]", "`seeds` must be whole numbers from 0; write seeds = [1, 2, 3]"),
        ("seeds = [1]\n[factors]\nwind.seed = [2]", "`wind.seed` is varied twice"),
        ("", "nothing is varied; give [factors]"),
        ("[[linked]]\nname = \"a\"\nlevels = [{ name = \"b\" }]", "a linked factor has a `name`"),
        ("seeds = [1]\n[[exclude]]\n\"wind.seed\" = 7", "`wind.seed` has no level 7"),
        ("seeds = [1]\n[[exclude]]\n\"wind.speed\" = 7", "`wind.speed` is not varied"),
        ("collect = 3\nseeds = [1]", "`collect` must be a list of texts"),
    ] {
        let said = read(text).unwrap_err().to_lines();
        assert!(said.contains(expected), "{text}: {said}");
    }
}
