//! The figures of a report.

mod gains;
mod pitch;
mod power;
mod profiles;
mod sheet;
mod slices;
pub(crate) mod synchronisation;

use crate::draw::colour::Ink;
use crate::draw::font::Face;
use crate::draw::{Figure, Setting, text};
use crate::sentence;
use crate::study::Study;

/// Width of every figure.
const WIDTH: f64 = 1000.0;

/// Every figure that the records allow, in the order of the page.
pub(crate) fn all(study: &Study) -> Vec<Figure> {
    let mut figures = Vec::new();
    figures.extend(gains::gains(study));
    figures.extend(gains::gain_over_amplitude(study));
    figures.extend(power::power(study));
    figures.extend(slices::mean(study));
    figures.extend(slices::difference(study));
    figures.extend(slices::instants(study));
    figures.extend(slices::streamwise(study));
    figures.extend(slices::crosswind(study));
    figures.extend(profiles::profiles(study));
    figures.extend(profiles::centre_line(study));
    figures.extend(pitch::pitch(study));
    figures.extend(power::rotor_speed(study));
    figures.extend(study.records.synchronisation.iter().flat_map(synchronisation::all));
    let conditions = sentence::study_line(study);
    figures.iter_mut().for_each(|figure| sign(figure, &conditions));
    figures
}

/// Writes the conditions below a figure, so that it keeps them wherever it is shown.
fn sign(figure: &mut Figure, conditions: &str) {
    const SIZE: f64 = 10.5;
    const LINE: f64 = 15.0;
    let face = Face::new(false);
    let mut line = String::new();
    let mut lines = Vec::new();
    for item in conditions.split(" · ") {
        let longer = if line.is_empty() { item.to_owned() } else { format!("{line} · {item}") };
        // Readers' own fonts may be wider than the one that is measured.
        if !line.is_empty() && 1.1 * face.width(&longer, SIZE) > figure.width - 40.0 {
            lines.push(std::mem::replace(&mut line, item.to_owned()));
        } else {
            line = longer;
        }
    }
    lines.push(line);
    let setting = Setting::plain(Ink::Muted, SIZE);
    for line in lines {
        figure.height += LINE;
        figure.shapes.push(text([16.0, figure.height - 4.0], line, setting));
    }
    figure.height += 4.0;
}
