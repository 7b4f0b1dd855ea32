//! The figures of a report.

mod gains;
mod pitch;
mod power;
mod profiles;
mod slices;

use crate::draw::Figure;
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
    figures
}
