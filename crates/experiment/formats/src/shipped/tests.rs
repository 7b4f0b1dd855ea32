//! What ships is what the repository holds, and needs nothing beside it.

use super::*;

#[test]
fn every_case_of_the_repository_is_shipped_under_its_name() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../cases");
    let (cases, laws): (Vec<_>, Vec<_>) = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .partition(|path| path.extension().is_some_and(|ending| ending == "toml"));
    let mut files: Vec<String> =
        cases.iter().map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    files.sort();
    let laws: Vec<&str> =
        laws.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(laws, LAWS.iter().map(|(name, _)| *name).collect::<Vec<_>>());
    let studies = CASES.iter().map(|case| case.name);
    let mut names: Vec<&str> =
        studies.chain(PRECURSORS.iter().map(|shipped| shipped.name)).collect();
    names.sort();
    assert_eq!(names, files);
    for shipped in CASES {
        if crate::fuzz::asks_for_what_studies_write(&shipped.text()) {
            continue;
        }
        for case in shipped.cases().unwrap() {
            assert_eq!(case.name, shipped.name);
            assert!(case.description.is_some_and(|words| words.len() > 20), "{}", shipped.name);
            // It needs nothing beside it: turbines of the library, and wind that a shipped case leaves.
            for turbine in &case.turbines {
                assert!(crate::library::names().any(|name| name == turbine.model));
                assert_eq!(turbine.discon, None);
            }
            // What comes before leaves a folder: a precursor is named itself, of a study a file in it.
            let wind = case.wind.precursor.or(case.wind.planes);
            let before = shipped.after.map(|name| format!("runs/{name}"));
            assert_eq!(wind.is_some(), before.is_some());
            assert!(wind.zip(before).is_none_or(|(wind, folder)| wind.starts_with(&folder)));
        }
        let is_there = |name| find(name).is_some() || find_precursor(name).is_some();
        assert!(shipped.after.is_none_or(is_there));
        let text = shipped.text();
        assert!(!text.contains("../") && !text.contains("cases/"), "{text}");
    }
}

#[test]
fn a_law_stands_for_its_file_where_there_is_none() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in LAWS {
        let (shipped, sha256) = read_law(folder.path(), name).unwrap();
        assert_eq!(sha256, records::sha256(text.as_bytes()));
        let own = LinearModel { interval_s: Some(77.0), ..shipped.clone() };
        own.write(&folder.path().join(name)).unwrap();
        let (found, other) = read_law(folder.path(), name).unwrap();
        assert!(found == own && other != sha256);
    }
    assert!(read_law(folder.path(), "none.json").is_err());
}

#[test]
fn a_precursor_is_found_by_its_name() {
    for shipped in PRECURSORS {
        let precursor = shipped.precursor().unwrap().precursor;
        assert_eq!(precursor.name, shipped.name);
        assert!(precursor.description.is_some_and(|words| words.len() > 20));
        assert!(!shipped.text().contains("../") && find(shipped.name).is_none());
    }
    let file = read_precursor(Path::new("precursor-offshore"), &["seed=3".to_owned()]);
    assert_eq!(file.unwrap().precursor.seed, 3);
    assert!(read_precursor(Path::new("no-such-precursor"), &[]).is_err());
}

#[test]
fn a_name_stands_for_a_case_where_no_file_has_it() {
    assert_eq!(instead_of(Path::new("quickstart")).map(|case| case.name), Some("quickstart"));
    assert_eq!(instead_of(Path::new("quickstart.toml")), None);
    assert_eq!(instead_of(Path::new("no-such-case")), None);
    assert!(advice(Path::new("cases/quickstart.toml")).ends_with("quickstart"));
    assert!(advice(Path::new("mine.toml")).contains("wakemix cases"));
    let case = read(Path::new("quickstart"), &["wind.speed=8".to_owned()]).unwrap();
    assert_eq!((case.case.wind.speed, case.folder()), (8.0, Path::new("")));
    let error = read(Path::new("quick.toml"), &[]).unwrap_err();
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    assert!(help.contains("wakemix init"), "{help}");
}
