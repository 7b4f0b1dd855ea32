//! Every number of the headers of boxes, one at a time in the place of which no number can be.

use super::tests::stored;
use super::*;
use crate::fuzz::numbers::{NEVER, numbers_of};
use std::fs;

#[test]
fn headers_of_hawc_boxes() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.toml");
    write(&path, &stored([4, 3, 2])).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    let numbers = numbers_of(&text);
    assert!(numbers.len() > 8, "{}", numbers.len());
    for number in numbers {
        let is_height = number.key == "wind.lowest_height";
        let negative = (!is_height && number.key != "wind.mean_speeds").then_some("-1.0");
        for bad in NEVER.into_iter().chain(negative) {
            let mut damaged = text.clone();
            damaged.replace_range(number.bytes.clone(), bad);
            fs::write(&path, damaged).unwrap();
            let line = 1 + text[..number.bytes.start].matches('\n').count();
            let refusals = [read(&path).err(), open(&path).err()];
            for refusal in refusals {
                let message =
                    refusal.unwrap_or_else(|| panic!("{} = {bad}", number.key)).to_string();
                assert!(message.contains(&format!("line {line}: ")), "{message}, line {line}");
            }
        }
    }
}

/// On return the box called `name` was refused with each of `bad` in the place of the little-endian single at
/// each of `places`.
fn refused(name: &str, places: impl Iterator<Item = usize> + Clone, bad: &[f32]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write(&path, &stored([4, 3, 2])).unwrap();
    let bytes = fs::read(&path).unwrap();
    open(&path).unwrap();
    for place in places {
        for value in bad {
            let mut damaged = bytes.clone();
            damaged[place..place + 4].copy_from_slice(&value.to_le_bytes());
            fs::write(&path, damaged).unwrap();
            let message =
                open(&path).err().unwrap_or_else(|| panic!("{name}, byte {place}: {value}"));
            assert!(message.to_string().contains(name), "{message}");
        }
    }
}

const NOT_FINITE: [f32; 4] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38];

#[test]
fn headers_of_turbsim_fields() {
    // Spacings, step, speed, heights, then slope and intercept of u, v, w.
    refused("box.bts", (0..12).map(|number| 18 + 4 * number), &NOT_FINITE);
    refused("box.bts", (0..5).map(|number| 18 + 4 * number), &[0.0, -1.0]);
}

#[test]
fn headers_of_bladed_fields() {
    // Intensities, spacings and speed; the summary gives the height.
    let places = [20, 24, 28, 32, 36, 40, 48];
    refused("box.wnd", places.into_iter(), &NOT_FINITE);
    refused("box.wnd", places.into_iter(), &[-1.0]);
}

#[test]
fn summaries_of_bladed_fields() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("box.wnd");
    write(&path, &stored([4, 3, 2])).unwrap();
    let summary = folder.path().join("box.sum");
    let text = fs::read_to_string(&summary).unwrap();
    for key in ["Hub height", "Height Offset", "TI(u)"] {
        let (index, line) = text.lines().enumerate().find(|(_, line)| line.contains(key)).unwrap();
        let word = line.split([' ', '=']).find(|word| word.parse::<f64>().is_ok()).unwrap();
        for bad in NEVER {
            let damaged = text.replacen(line, &line.replacen(word, bad, 1), 1);
            fs::write(&summary, damaged).unwrap();
            let message = open(&path).err().unwrap_or_else(|| panic!("{key}: {bad}")).to_string();
            let place = format!("line {}: {bad}", index + 1);
            assert!(message.contains("box.sum") && message.contains(&place), "{message}");
        }
    }
}
