//! What the desk reads: linear models, surrogates, tables of samples, files of campaigns.

use super::survives;
use crate::case::read_campaign;
use crate::linear_model::{LinearModel, Port, Role};
use crate::surrogate_model::{StoredObservations, StoredPart, StoredTerm, SurrogateModel};
use crate::table::Samples;
use std::fs;

const SAMPLES: &str =
    "# by hand\nspeed [m/s],\"sense\",load (kN)\n8,1,2.5\n10,-1,3e1\n\n12,1,3.5\n";
const CASE: &str = "name = \"c\"\n[[run]]\nname = \"helix\"\ncontrol.T1 = { kind = \"helix\", sense = \"ccw\", amplitude_deg = 3.0, strouhal = 0.25 }\n";
const CAMPAIGN: &str = "case = \"case.toml\"\ntable = \"points.csv\"\nseeds = { from = 1, to = 3, step = 1 }\n[factors]\n\"wind.speed\" = [8, 10.5]\n\"control.T1.amplitude_deg\" = { from = 1, to = 3, step = 0.5 }\n[[linked]]\nname = \"air\"\nlevels = [{ name = \"thin\", wind.turbulence_intensity = 0.05 }]\n[[exclude]]\n\"wind.speed\" = [8]\n";
const POINTS: &str = "wind.shear_exponent\n0.1\n0.2\n";

fn port(name: &str, unit: &str) -> Port {
    Port { name: name.to_owned(), unit: unit.to_owned() }
}

/// The bytes that `write` leaves in a file.
fn bytes(write: impl Fn(&std::path::Path)) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.json");
    write(&path);
    fs::read(path).unwrap()
}

#[test]
fn linear_models() {
    let matrices = [vec![vec![0.9]], vec![vec![0.1]], vec![vec![1.5]], vec![vec![0.0]]];
    let ports = [vec![port("tilt", "deg")], vec![port("up", "m")]];
    let model = LinearModel::new(Role::Model, "a lag".to_owned(), Some(0.1), ports, matrices);
    let written = bytes(|path| model.write(path).unwrap());
    survives(vec![("model.json", written)], |folder| {
        LinearModel::read(&folder.join("model.json"), Role::Model)?;
        Ok(())
    });
}

#[test]
fn surrogates() {
    let part = StoredPart {
        shape: "matern32".to_owned(),
        inputs: vec![0],
        lengths: vec![2.0],
        exponent: None,
        period: None,
    };
    let observations = StoredObservations {
        inputs: None,
        values: vec![1.0, 2.0],
        counts: vec![1.0, 2.0],
        within: vec![0.0, 0.1],
        known_variances: vec![0.0, 0.0],
        groups: vec![0, 0],
    };
    let kernel = vec![StoredTerm { variance: 1.0, parts: vec![part] }];
    let mut model =
        SurrogateModel::new("by hand".to_owned(), port("load", "kN"), (kernel, observations));
    model.inputs = vec![port("speed", "m/s")];
    model.ranges = vec![[8.0, 12.0]];
    model.trend = "constant".to_owned();
    model.coefficients = vec![1.5];
    model.noise_variances = vec![0.1];
    model.points = vec![vec![8.0], vec![12.0]];
    model.weights = vec![0.5, -0.5];
    let written = bytes(|path| model.write(path).unwrap());
    survives(vec![("model.json", written)], |folder| {
        SurrogateModel::read(&folder.join("model.json"))?;
        Ok(())
    });
}

#[test]
fn tables_of_samples() {
    survives(vec![("samples.csv", SAMPLES.into())], |folder| {
        Samples::read(&folder.join("samples.csv"), &["speed", "load"])?;
        Ok(())
    });
}

#[test]
fn campaigns() {
    let files = vec![
        ("loads.toml", CAMPAIGN.into()),
        ("case.toml", CASE.into()),
        ("points.csv", POINTS.into()),
    ];
    survives(files, |folder| {
        read_campaign(&folder.join("loads.toml"), &|_| None)?;
        Ok(())
    });
}
