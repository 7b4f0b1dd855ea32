//! Tests of tables in text.

use super::*;
use basis::channels::{GEN_PWR, ROOT_MYC, TIME};
use proptest::prelude::*;
use std::fs;

fn written(name: &str, text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    (folder, path)
}

/// All rows of the table, of the channels `names`.
fn rows(path: &Path, names: &[&str]) -> Result<Vec<Vec<f64>>, FileError> {
    let mut table = TableReader::open(path)?;
    table.select(names)?;
    let mut rows = Vec::new();
    let mut row = vec![0.0; names.len() + 1];
    while table.read(&mut row)? {
        rows.push(row.clone());
    }
    Ok(rows)
}

/// Problem and fix of a refusal.
fn complaint<T: std::fmt::Debug>(result: Result<T, FileError>) -> String {
    match result.unwrap_err() {
        FileError::Content { problem, fix, .. } => format!("{problem} | {fix}"),
        other => panic!("{other}"),
    }
}

#[test]
fn ways_of_writing_a_table_read_the_same() {
    let texts = [
        "time_s,RootMyc1,TwrBsMyt\n0.0,1.5,-2e3\n0.1,2.5,3E3\n",
        "\u{feff}# made by hand\nTime;RootMyc1 [kN-m];TwrBsMyt [kN-m]\n0;1.5;-2e3\n\n0.1;2.5;3e3\n",
        "Time_[s],RootMyc1_[kN-m],TwrBsMyt_[kN-m]\r\n0,1.5,-2000\r\n0.1,2.5,3000",
        "\"t\"\t\"RootMyc1\"\t\"TwrBsMyt\"\n(s)\t(kN-m)\t(kN-m)\n0\t1.5\t-2000\n0.1\t2.5\t3000\n",
        "TwrBsMyt  time  RootMyc1\n  -2000   0.0    1.5\n  0.3D4   0.1    2.5\n",
        "time (s), RootMyc1 (kN-m), TwrBsMyt (kN-m)\n0, 1.5, -2000\n0.1, 2.5, 3000\n",
    ];
    for text in texts {
        let (_folder, path) = written("loads.csv", text);
        let found = rows(&path, &["TwrBsMyt", "RootMyc1"]).unwrap();
        assert_eq!(found, [[0.0, -2000.0, 1.5], [0.1, 3000.0, 2.5]], "{text}");
    }
}

#[test]
fn units_are_distinguished_from_names() {
    let (_folder, path) = written("a.csv", "Time_[s],RootMyc1_[kN-m],Cp,[odd]\n0,1,2,3\n");
    let table = TableReader::open(&path).unwrap();
    let channels: Vec<(&str, &str)> =
        table.channels().map(|c| (c.name.as_str(), c.unit.as_str())).collect();
    assert_eq!(channels, [("RootMyc1", "kN-m"), ("Cp", ""), ("[odd]", "")]);
}

#[test]
fn the_project_s_own_series_is_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let channels = [TIME, GEN_PWR.of("T1"), ROOT_MYC.of_blade(1).of("T1")];
    let path = folder.path().join("series.csv");
    let mut writer = crate::records::SeriesWriter::create(&path, &channels).unwrap();
    for step in 0..20 {
        let time = f64::from(step) / 7.0;
        writer.write(&[time, 1e6 / 3.0, 1e7 * time.sin()]).unwrap();
    }
    writer.finish().unwrap();
    // Its folder stands for it, and the unit at the end of a name may be left out.
    for path in [path.as_path(), folder.path()] {
        let found = rows(path, &["t1.rootmyc1"]).unwrap();
        assert_eq!(found.len(), 20);
        for (step, row) in found.iter().enumerate() {
            let time = step as f64 / 7.0;
            assert_eq!(row[..], [time, 1e7 * time.sin() / 1e3]);
        }
    }
}

#[test]
fn openfast_s_text_is_a_table() {
    let text = "\n\
        Predictions were generated on 21-Nov-2026 using OpenFAST, compiled as a 64-bit application.\n\
        \x20linked with  NWTC Subroutine Library; ElastoDyn\n\n\
        Description from the FAST input file: a test\n\n\
        Time      \tGenSpeed  \tRootMyc1\n\
        (s)       \t(rpm)     \t(kN-m)\n\
        \x20   0.0000\t 9.441E+02\t-1.5-101\n\
        \x20   0.1000\t 9.459E+02\t 2.0E+03\n\n\
        This output file was closed on 21-Nov-2026 at 10:15:16.\n";
    let (_folder, path) = written("run.out", text);
    assert_eq!(
        rows(&path, &["RootMyc1", "genspeed"]).unwrap(),
        [[0.0, -1.5e-101, 944.1], [0.1, 2000.0, 945.9]]
    );
    let table = TableReader::open(&path).unwrap();
    assert!(table.description().contains("a test"), "{}", table.description());
    assert_eq!(table.channels().next().unwrap().unit, "rpm");
    let blanks = text.replace('\t', "   ");
    fs::write(&path, blanks).unwrap();
    assert_eq!(rows(&path, &["RootMyc1"]).unwrap()[1], [0.1, 2000.0]);
}

#[test]
fn a_name_that_is_not_there_is_reported_with_what_may_be_meant() {
    let names = "time,RootMyc1,RootMyc2,RootMyc3,TwrBsMyt_kN-m";
    let (_folder, path) = written("a.csv", &format!("{names}\n0,1,2,3,4\n"));
    let message = |name: &str| complaint(rows(&path, &[name]));
    assert_eq!(message("RotMyc1"), "it has no channel \"RotMyc1\" | did you mean \"RootMyc1\"?");
    let with_unit = message("TwrBsMxt");
    assert!(with_unit.ends_with("did you mean \"TwrBsMyt_kN-m\"?"), "{with_unit}");
    let several = message("Myc");
    assert!(several.ends_with("one of its 3 channels: RootMyc1, RootMyc2, RootMyc3"), "{several}");
    let all = message("blade");
    assert!(all.contains("one of its 5 channels: time, RootMyc1"), "{all}");
    assert_eq!(rows(&path, &["twrbsmyt"]).unwrap(), [[0.0, 4.0]]);
    let (_folder, path) = written("b.csv", "time,a_1,a_2\n0,1,2\n");
    let several = complaint(rows(&path, &["a"]));
    assert!(several.contains("is one of 2: a_1, a_2"), "{several}");
    let (_folder, path) = written("c.csv", "time,a,a\n0,1,2\n");
    let twice = complaint(rows(&path, &["a"]));
    assert!(twice.starts_with("2 channels are called \"a\""), "{twice}");
}

#[test]
fn openfast_s_other_names_find_the_channel_that_is_written() {
    let names = "Time_s,T1.RootMyb1_kN-m,T1.RootMxb1_kN-m,T1.RotTorq_kN-m,T1.LSSTipMys_kN-m";
    let (_folder, path) = written("series.csv", &format!("{names}\n0,1,2,3,4\n"));
    let requested = ["T1.RootMFlp1", "t1.rootmedg1", "T1.LSSGagMxs", "T1.LSSGagMys"];
    assert_eq!(rows(&path, &requested).unwrap(), [[0.0, 1.0, 2.0, 3.0, 4.0]]);
    let message = complaint(rows(&path, &["T1.RootMFlp2"]));
    assert!(message.starts_with("it has no channel \"T1.RootMFlp2\" | "), "{message}");
    let (_folder, path) = written("T1.out", "Time RootMyb1 RotTorq\n(s) (kN-m) (kN-m)\n0.0 5 6\n");
    assert_eq!(rows(&path, &["LSSGagMxs", "RootMFlp1"]).unwrap(), [[0.0, 6.0, 5.0]]);
    // What a file has under the very name comes first.
    let (_folder, path) = written("a.csv", "time,RootMyb1,RootMFlp1\n0,7,8\n");
    assert_eq!(rows(&path, &["RootMFlp1"]).unwrap(), [[0.0, 8.0]]);
    let mut table = TableReader::open(&path).unwrap();
    table.select(&["RootMFlp1", "RootMyb1"]).unwrap();
    assert_eq!(table.selected().next().unwrap().name, "RootMFlp1");
}

#[test]
fn bad_tables_are_reported_with_line_and_fix() {
    let cases = [
        ("a.csv", "", "it has no line of names"),
        ("a.csv", "0,1,2\n1,2,3\n", "line 1 has numbers where names are needed"),
        ("a.csv", "a,b\n1,2\n", "none of its 2 columns is time | call the column of time"),
        ("a.csv", "time_ms,a\n1,2\n", "its time \"time_ms\" is in \"ms\""),
        ("a.csv", "time,a\n0,1\n1\n", "line 3: 1 values under 2 names: the row is cut short"),
        ("a.csv", "time,a\n0,1,2\n", "line 2: 3 values under 2 names"),
        ("a.csv", "time,a\n0,one\n", "line 2: `one` in a is not a number"),
        ("a.csv", "time,a\n0,1\n0.5,NaN\n", "line 3 (0.5 s): a is NaN, not a finite number"),
        ("a.csv", "time,a\n0,1\n-1,2\n", "line 3: time goes back from 0 s to -1 s"),
        ("a.csv", "time,a\ninf,1\n", "line 2: time is inf, not a finite number"),
        ("a.csv", "\u{4}\0\u{a}\0", "its first line is no text | name OpenFAST's binary output"),
        ("a.out", "one\ntwo\n", "none of its first 100 lines begins with Time"),
        ("a.out", "Time a\n(s) (m)\n0.0 ****\n", "line 3: `****` in a is not a number"),
        ("a.out", "Time a\n(s) (m)\n0.0 1.0\n0.1\n", "line 4: 1 values under 2 names"),
    ];
    for (name, text, expected) in cases {
        let (_folder, path) = written(name, text);
        let message = complaint(rows(&path, &["a"]));
        assert!(message.contains(expected), "{message}\n{expected}");
        assert!(message.len() > message.find('|').unwrap() + 10, "{message}");
    }
    let missing = TableReader::open(Path::new("/nowhere/a.csv")).unwrap_err();
    assert!(matches!(missing, FileError::System { .. }), "{missing}");
}

#[test]
fn what_was_not_selected_is_not_looked_at() {
    let (_folder, path) = written("a.csv", "time,a,b\n0,1,oops\n1,2,NaN\n");
    assert_eq!(rows(&path, &["a"]).unwrap(), [[0.0, 1.0], [1.0, 2.0]]);
    assert!(rows(&path, &["b"]).is_err());
}

#[test]
fn fortran_s_numbers() {
    let number = |text: &str| text::number(text.as_bytes());
    for (text, expected) in [
        ("1.5D+03", 1500.0),
        ("-2.5-103", -2.5e-103),
        ("1.e2", 100.0),
        (" 7 ", 7.0),
        ("+1d-2", 0.01),
    ] {
        assert_eq!(number(text), Some(expected), "{text}");
    }
    for text in ["", "-", "1-", "D+3", "1.5D+03x", "--1", "1e", "1,5"] {
        assert_eq!(number(text), None, "{text}");
    }
}

proptest! {
    #[test]
    fn no_text_makes_the_reader_panic(
        name in prop::sample::select(vec!["a.csv", "a.out"]),
        text in "(time|Time|t|a|\\(s\\)|NaN|inf|[0-9eED+\\-.]{1,4}|[,;\t \n\r\"#]|\\PC){0,60}",
    ) {
        let (_folder, path) = written(name, &text);
        let _ = rows(&path, &["a"]);
        let _ = rows(&path, &[]);
    }

    #[test]
    fn no_bytes_make_the_reader_panic(
        name in prop::sample::select(vec!["a.csv", "a.out"]),
        bytes in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let _ = rows(&path, &[]);
    }
}
