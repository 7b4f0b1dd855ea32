//! Winds of studies: which studies differ in a seed alone, and what each wind is, in words.

use super::ChangesWind;
use crate::seeds::Study;
use basis::records::{Conditions, Summary};
use formats::case;
use formats::records::Manifest;
use std::path::Path;

/// Studies in winds of one climate.
pub(super) struct Group<'s> {
    pub(super) wind: ChangesWind,
    pub(super) studies: Vec<&'s Study<'s>>,
}

/// `studies` together that are of the same case but for the seed of the wind and the runs.
pub(super) fn groups<'s>(studies: &'s [Study<'s>]) -> Vec<Group<'s>> {
    let mut keyed: Vec<(String, Vec<&Study>)> = Vec::new();
    for study in studies {
        let key = key(&study.runs[0].0);
        match keyed.iter_mut().find(|(known, _)| *known == key) {
            Some((_, known)) => known.push(study),
            None => keyed.push((key, vec![study])),
        }
    }
    let conditions = |studies: &[&Study]| studies[0].runs[0].1.conditions;
    let all: Vec<Conditions> = keyed.iter().map(|(_, studies)| conditions(studies)).collect();
    let mut names: Vec<String> = all.iter().map(|own| words(own, &all)).collect();
    for (place, (_, studies)) in keyed.iter().enumerate() {
        // What else differs is known by the folder alone.
        if names.iter().filter(|other| **other == names[place]).count() > 1 {
            names[place] += &format!(", {}", studies[0].folder.display());
        }
    }
    let groups = keyed.into_iter().zip(names);
    groups
        .map(|((_, studies), name)| {
            let Conditions {
                target_wind_speed, target_turbulence_intensity, shear_exponent, ..
            } = conditions(&studies);
            let of = |study: &&Study| (study.folder.to_owned(), study.runs[0].1.conditions.seed);
            let wind = ChangesWind {
                name,
                speed: target_wind_speed,
                turbulence_intensity: target_turbulence_intensity,
                shear_exponent,
                studies: studies.iter().map(of).collect(),
            };
            Group { wind, studies }
        })
        .collect()
}

/// What decides the bits of all runs of a study beside the seed of the wind, and what they are controlled by.
fn key(manifest: &Manifest) -> String {
    match case::parse("the manifest's case", &manifest.case_text, &[]) {
        Ok(mut case) => {
            case.wind.seed = 0;
            case.runs.clear();
            case::decisive_text(&case)
        }
        Err(_) => manifest.case_text.clone(),
    }
}

/// A wind in words: what tells it from even wind, and its speed where `all` do not have the same.
fn words(conditions: &Conditions, all: &[Conditions]) -> String {
    let Conditions { target_wind_speed: speed, shear_exponent, roughness_length, .. } = conditions;
    let is_other = |other: &Conditions| other.target_wind_speed != *speed;
    let mut words = Vec::new();
    if all.iter().any(is_other) {
        words.push(format!("{speed} m/s"));
    }
    words
        .extend(shear_exponent.filter(|shear| *shear != 0.0).map(|shear| format!("shear {shear}")));
    words.extend(roughness_length.map(|length| format!("roughness {length} m")));
    let turbulence = conditions.target_turbulence_intensity;
    if turbulence > 0.0 {
        // 6 % of 0.06, whose hundredfold is not six.
        words.push(format!("TI {} %", (1e4 * turbulence).round() / 100.0));
    }
    if words.is_empty() { "even wind".to_owned() } else { words.join(", ") }
}

/// A name for each of several runs in `folders`: that of the run, with its wind where several are called
/// alike, and with its folder where that does not tell them either.
pub(crate) fn names_of_runs(runs: &[(&Path, Summary)]) -> Vec<String> {
    let all: Vec<Conditions> = runs.iter().map(|(_, summary)| summary.conditions).collect();
    let plain: Vec<String> = runs.iter().map(|(_, summary)| summary.run.clone()).collect();
    let name = |(place, (_, summary)): (usize, &(&Path, Summary))| {
        if plain.iter().filter(|other| **other == plain[place]).count() > 1 {
            format!("{}, {}", summary.run, words(&summary.conditions, &all))
        } else {
            summary.run.clone()
        }
    };
    let named: Vec<String> = runs.iter().enumerate().map(name).collect();
    let folder = |(place, (folder, _)): (usize, &(&Path, Summary))| {
        if named.iter().filter(|other| **other == named[place]).count() > 1 {
            folder.display().to_string()
        } else {
            named[place].clone()
        }
    };
    runs.iter().enumerate().map(folder).collect()
}
