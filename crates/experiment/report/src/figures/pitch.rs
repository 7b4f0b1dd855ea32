//! What the blades did: pitch over a few turns of the rotor, and the lines in its spectrum.

use super::WIDTH;
use crate::RunRecords;
use crate::draw::axes::{Frame, SMALL, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::{Figure, Look, Role, Shape, TextStyle, segment, text};
use crate::study::Study;
use crate::trace::{peaks, thinned};
use analysis::spectra::amplitude;
use basis::channels::{BLD_PITCH, TIME};
use std::f64::consts::TAU;

/// Turns of the rotor that are shown.
const N_TURNS: f64 = 6.0;
/// Blades that are shown at most (–).
const N_BLADES: usize = 3;
const HEIGHT: f64 = 215.0;

/// Whether the channel `requested` of an excited turbine is shown.
pub(crate) fn draws(requested: &str) -> bool {
    (1..=N_BLADES).any(|blade| BLD_PITCH.of_blade(blade).name == requested)
}

/// One excited turbine in one run.
struct Excited<'a> {
    colour: usize,
    run: &'a RunRecords,
    turbine: &'a str,
    /// Frequency of the rotor (Hz).
    rotor: f64,
    /// Frequency of the excitation (Hz).
    excitation: f64,
}

/// Blade pitch over a few turns and its spectrum, a row for each excited turbine.
pub(crate) fn pitch(study: &Study) -> Option<Figure> {
    let excited: Vec<Excited> = study
        .runs()
        .iter()
        .zip(&study.colours)
        .flat_map(|(run, &colour)| {
            study.excitations(run).into_iter().map(move |excitation| Excited {
                colour,
                run,
                turbine: excitation.turbine.name.as_str(),
                rotor: excitation.turbine.rotor_speed.mean / TAU,
                excitation: excitation.pitch.excitation_frequency_hz.abs(),
            })
        })
        .filter(|one| blade(one.run, one.turbine, 1).is_some() && one.rotor > 0.0)
        .collect();
    let mut turbines: Vec<&str> = excited.iter().map(|one| one.turbine).collect();
    turbines.sort_unstable();
    turbines.dedup();
    if turbines.is_empty() {
        return None;
    }
    let mut names: Vec<(usize, &str)> =
        excited.iter().map(|one| (one.colour, one.run.summary.run.as_str())).collect();
    names.dedup();
    let mut shapes = Vec::new();
    let mut top = 22.0 + legend([58.0, 22.0], WIDTH - 90.0, Role::Run, &names, &mut shapes) + 30.0;
    for turbine in turbines {
        let rows: Vec<&Excited> = excited.iter().filter(|one| one.turbine == turbine).collect();
        over_turns(&rows, [58.0, top, 420.0, HEIGHT], &mut shapes);
        spectra(&rows, [548.0, top, 428.0, HEIGHT], &mut shapes);
        top += HEIGHT + 84.0;
    }
    Some(Figure {
        name: "pitch".to_owned(),
        title: "Blade pitch as delivered".to_owned(),
        caption: "Left: pitch of blade 1 (thick) and of the others (thin) at the end of the run. Right: \
             amplitude spectrum of blade 1's pitch over the analysed time, with the rotor frequency \
             1P and 1P ± fₑ marked; a clean helix is one line."
            .to_owned(),
        width: WIDTH,
        height: top - 30.0,
        shapes,
    })
}

/// Times (s) and pitch (deg) of a blade.
fn blade<'a>(run: &'a RunRecords, turbine: &str, blade: usize) -> Option<(&'a [f64], Vec<f64>)> {
    let times = run.series.column(&TIME.name)?;
    let pitch = run.series.column(&BLD_PITCH.of_blade(blade).at(turbine))?;
    let pitch: Vec<f64> = pitch.iter().map(|angle| angle.to_degrees()).collect();
    (times.len() > 4 && pitch.len() == times.len()).then_some((times, pitch))
}

fn over_turns(rows: &[&Excited], area: [f64; 4], shapes: &mut Vec<Shape>) {
    // Beyond two runs the other blades would only confuse.
    let blades = if rows.len() > 2 { 1 } else { N_BLADES };
    let mut lines = Vec::new();
    for one in rows {
        for number in (1..=blades).rev() {
            let Some((times, pitch)) = blade(one.run, one.turbine, number) else { continue };
            let end = times[times.len() - 1];
            let start = end - N_TURNS / one.rotor;
            let first = times.partition_point(|time| *time < start);
            let turns: Vec<f64> =
                times[first..].iter().map(|time| (time - start) * one.rotor).collect();
            lines.push((one.colour, number, thinned(&turns, &pitch[first..], 400)));
        }
    }
    let frame = Frame {
        area,
        x: Scale::linear(0.0, N_TURNS),
        y: Scale::around(lines.iter().flat_map(|line| line.2.iter().map(|point| point[1])), 0.08),
    };
    frame.rows(5, true, shapes);
    frame.columns(6, true, shapes);
    frame.title(&format!("{}, last {N_TURNS:.0} turns", rows[0].turbine), shapes);
    frame.x_label("turns of the rotor", shapes);
    frame.y_label("pitch (°)", 40.0, shapes);
    let group = lines
        .into_iter()
        .map(|(colour, number, line)| {
            let shape = if number == 1 {
                let look = Look::line(Ink::Run(colour), 2.2).dashed(run_dash(colour));
                frame.line(&line, look)
            } else {
                let look = Look::line(Ink::Run(colour), 1.0).opacity(0.45);
                crate::draw::polyline(frame.points(&line), look)
            };
            Shape::Group { role: Role::Run(colour), clip: None, shapes: vec![shape] }
        })
        .collect();
    shapes.push(frame.panel(group, ["turns", "°"]));
}

fn spectra(rows: &[&Excited], area: [f64; 4], shapes: &mut Vec<Shape>) {
    let rotor = rows.iter().map(|one| one.rotor).sum::<f64>() / rows.len() as f64;
    let excitation = rows.iter().map(|one| one.excitation).fold(0.0, f64::max);
    let highest = 2.2 * rotor.max(excitation);
    let mut lines = Vec::new();
    for one in rows {
        let Some((times, pitch)) = blade(one.run, one.turbine, 1) else { continue };
        let spin_up = one.run.summary.conditions.spin_up;
        let first = times.partition_point(|time| *time < spin_up).min(times.len() - 4);
        let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
        // A record too short for a spectrum has no line to show.
        let Ok(spectrum) = amplitude(&pitch[first..], interval) else { continue };
        let n_shown = (highest / spectrum.frequency_step) as usize;
        let points: Vec<[f64; 2]> = (1..spectrum.values.len().min(n_shown + 1))
            .map(|index| [spectrum.frequency(index), spectrum.values[index]])
            .collect();
        lines.push((one.colour, peaks(&points, 360)));
    }
    let largest = lines.iter().flat_map(|line| &line.1).map(|point| point[1]).fold(1e-2, f64::max);
    let frame = Frame {
        area,
        x: Scale::linear(0.0, highest),
        y: Scale { low: 1e-3, high: 10f64.powf((2.5 * largest).log10()), logarithmic: true },
    };
    frame.rows(5, true, shapes);
    frame.columns(6, true, shapes);
    frame.x_label("frequency (Hz)", shapes);
    frame.y_label("amplitude (°)", 46.0, shapes);
    let marks = [(rotor - excitation, "1P−fₑ"), (rotor, "1P"), (rotor + excitation, "1P+fₑ")];
    let base = area[1] + area[3];
    let mut inner: Vec<Shape> = Vec::new();
    for (index, (frequency, name)) in marks.into_iter().enumerate() {
        if frequency <= 0.0 {
            continue;
        }
        let [x, _] = frame.point([frequency, 1.0]);
        let look = Look::line(Ink::Axis, 1.0).dashed(Some([4.0, 3.0]));
        inner.push(segment([x, area[1]], [x, base], look));
        // Labels stand apart even where the excitation is slow.
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored([1.0, 0.0, 0.0][index]);
        let shift = [-4.0, 4.0, 4.0][index];
        let below = if index == 1 { 26.0 } else { 12.0 };
        inner.push(text([x + shift, area[1] + below], name, setting));
    }
    inner.extend(lines.into_iter().map(|(colour, line)| {
        let look = Look::line(Ink::Run(colour), 1.8).dashed(run_dash(colour));
        Shape::Group { role: Role::Run(colour), clip: None, shapes: vec![frame.line(&line, look)] }
    }));
    shapes.push(frame.panel(inner, ["Hz", "°"]));
}
