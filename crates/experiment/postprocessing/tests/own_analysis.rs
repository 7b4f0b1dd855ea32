//! An analysis of one's own: a value in this file, in a list beside those of the program, put to the records
//! of a run.

#[path = "../../study/tests/small/mod.rs"]
mod small;

use formats::records::{RunFolder, read_series};
use postprocessing::analyses::{AnalysisSetting, Answer, Of, Request, Takes};
use postprocessing::{ANALYSES, Analysis, PostprocessingError};
use serde_json::json;
use small::{NREL_5MW, done, options, written};

/// The energy that a turbine made.
const ENERGY: Analysis = Analysis {
    name: "energy",
    about: "Energy that a turbine made over the whole run",
    of: Of::Run("Folder of a run"),
    settings: &[AnalysisSetting {
        name: "turbine",
        value: "NAME",
        takes: Takes::Text,
        about: "Turbine; T1 when left out",
    }],
    run: energy,
};

fn energy(request: &Request) -> Result<Answer, PostprocessingError> {
    let folder = request.run();
    let parent = folder.parent().unwrap_or(folder);
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let series = read_series(&RunFolder::new(parent, &name).series_path(), |_| true)?;
    let turbine = request.text("turbine").unwrap_or("T1");
    let channel = format!("{turbine}.GenPwr");
    let missing = || PostprocessingError::MissingChannel {
        path: Some(request.run().join("series.csv")),
        channel: channel.clone(),
    };
    let powers = series.column(&channel).ok_or_else(missing)?;
    let times = series.column("Time").ok_or_else(missing)?;
    let interval = times[1] - times[0];
    let energy = powers.iter().sum::<f64>() * interval / 3.6e6;
    Ok(Answer {
        text: format!("{turbine} made {energy:.1} kWh\n"),
        json: json!({ "turbine": turbine, "energy_kwh": energy }),
        remarks: Vec::new(),
    })
}

#[test]
fn an_analysis_of_ones_own_answers_beside_the_others() {
    let list = [ANALYSES, &[ENERGY]].concat();
    let names: Vec<&str> = list.iter().map(|analysis| analysis.name).collect();
    let expected = [
        "phase",
        "winds",
        "spectra",
        "moments",
        "tune",
        "offsets",
        "gains",
        "changes",
        "lock",
        "meandering",
        "hub-vortex",
        "phases",
        "entrainment",
        "budget",
        "vortices",
        "modes",
        "particles",
        "energy",
    ];
    assert_eq!(names, expected);
    let run = "[[run]]\nname = \"baseline\"\n[output]\ninterval = 0.4\n";
    let folder = written(&small::case("own", "", [10.0, 60.0], &[NREL_5MW; 2], run));
    let run = done(&options(folder.path())).join("baseline");

    let own = list.iter().find(|analysis| analysis.name == "energy").expect("it is listed");
    let answer = (own.run)(&Request::of(&run)).expect("sound records");
    let energy = answer.json["energy_kwh"].as_f64().expect("a number");
    // 60 s at somewhat less than 5 MW.
    assert!(energy > 10.0 && energy < 5e3 * 60.0 / 3600.0, "{energy} kWh");
    assert_eq!(answer.text, format!("T1 made {energy:.1} kWh\n"));
    let other = (own.run)(&Request::of(&run).with("turbine", "T9"));
    let reported = other.expect_err("no such turbine").to_string();
    assert!(reported.contains("T9.GenPwr"), "{reported}");
}
