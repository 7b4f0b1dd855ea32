//! Gains over the compared run: by turbine, and over amplitude.

use super::WIDTH;
use crate::draw::axes::{Frame, MEDIUM, Readout, SMALL, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::font::Face;
use crate::draw::whisker::{self, Style, whisker};
use crate::draw::{Axis, Figure, Look, Role, Shape, TextStyle, rectangle, segment, text};
use crate::study::{ExcitationKind, Study};
use crate::words;
use basis::Sense;
use basis::records::Statistic;

const ROW: f64 = 24.0;

/// One row of the figure: colour, name of the run, gain.
type Row<'a> = (usize, &'a str, Statistic);

/// The rows of a turbine, or of all together, under their name.
type Group<'a> = (String, Vec<Row<'a>>);

/// Gain of each turbine and of all together in each run, with 95 % intervals.
pub(crate) fn gains(study: &Study) -> Option<Figure> {
    let groups = groups(study);
    let rows = || groups.iter().flat_map(|(_, rows)| rows);
    rows().next()?;
    let face = Face::new(false);
    let name_width = rows().map(|row| face.width(row.1, MEDIUM)).fold(60.0, f64::max).min(260.0);
    let group_face = Face::new(true);
    let group_width =
        groups.iter().map(|group| group_face.width(&group.0, MEDIUM)).fold(40.0, f64::max);
    let left = 16.0 + group_width + 16.0 + name_width + 16.0;
    let height: f64 = groups.iter().map(|(_, rows)| ROW * rows.len() as f64 + 14.0).sum::<f64>();
    let frame = Frame {
        area: [left, 18.0, WIDTH - left - 150.0, height],
        x: scale(rows().map(|row| row.2)),
        y: Scale::linear(0.0, 1.0),
    };
    let mut shapes = Vec::new();
    bands(&groups, frame.area[1], &mut shapes);
    ruler(&frame, &mut shapes);
    let mut y = frame.area[1];
    let mut whiskers = Vec::new();
    for (name, rows) in &groups {
        y += 7.0;
        for row in rows {
            names(row, left - 16.0, y + 0.5 * ROW, &mut shapes);
            whiskers.push(row_whisker(name, row, &frame, y + 0.5 * ROW));
            y += ROW;
        }
        y += 7.0;
    }
    shapes.push(Readout { both: false, ..frame.readout(["%", ""]) }.group(6.0, whiskers));
    Some(Figure {
        name: "gains".to_owned(),
        title: "Power gain over the compared run".to_owned(),
        caption: "Dots: gain of the mean power; whiskers: 95\u{a0}% interval from paired blocks, an arrow \
                  where one goes on beyond the axis."
            .to_owned(),
        width: WIDTH,
        height: frame.area[1] + height + 50.0,
        shapes,
    })
}

/// The axis (%) of `gains`: zero, every mean, and the intervals that are not far beyond the usual.
fn scale(gains: impl Iterator<Item = Statistic>) -> Scale {
    let whisker = |gain: Statistic| (100.0 * gain.mean, 100.0 * gain.half_width_95.unwrap_or(0.0));
    let whiskers: Vec<(f64, f64)> = gains.map(whisker).collect();
    let halves = whiskers.iter().map(|whisker| whisker.1).filter(|half| *half > 0.0);
    Scale::around_whiskers([0.0], &whiskers, whisker::reach(halves), 0.06)
}

/// A band with its name for each of `groups`, the first one below `y`.
fn bands(groups: &[Group], mut y: f64, shapes: &mut Vec<Shape>) {
    for (index, (name, rows)) in groups.iter().enumerate() {
        let group_height = ROW * rows.len() as f64 + 14.0;
        if index % 2 == 0 {
            let area = [8.0, y, WIDTH - 16.0, group_height];
            shapes.push(rectangle(area, Look::fill(Ink::Band)));
        }
        let setting = TextStyle::plain(Ink::Text, MEDIUM).bold();
        shapes.push(text([20.0, y + 7.0 + 0.5 * ROW + 4.0], name.as_str(), setting));
        y += group_height;
    }
}

/// Lines at round gains, with their numbers and what they are below.
pub(super) fn ruler(frame: &Frame, shapes: &mut Vec<Shape>) {
    let (ticks, decimals) = frame.x.ticks(8);
    let bottom = frame.area[1] + frame.area[3];
    let mut inner = Vec::new();
    for tick in ticks {
        let [x, _] = frame.point([tick, 0.0]);
        inner.push(segment([x, frame.area[1]], [x, bottom], Look::line(Ink::Grid, 1.0)));
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(0.5);
        inner.push(text([x, bottom + 17.0], words::number(tick, decimals), setting));
    }
    frame.ticks(Axis::X, inner, shapes);
    frame.x_label("power gain over the compared run (%)", shapes);
}

/// Rows of every turbine, then of all together.
fn groups<'a>(study: &Study<'a>) -> Vec<Group<'a>> {
    let runs = || study.runs().iter().zip(&study.colours);
    let mut groups: Vec<Group> = study
        .turbines()
        .into_iter()
        .map(|turbine| {
            let rows = runs()
                .filter_map(|(run, &colour)| {
                    let same = run.summary.turbines.iter().find(|t| t.name == turbine)?;
                    Some((colour, run.summary.run.as_str(), same.power_gain?))
                })
                .filter(|row: &Row| row.2.mean.is_finite())
                .collect();
            (turbine.to_owned(), rows)
        })
        .collect();
    if groups.len() > 1 && study.has_wakes() {
        let rows = runs()
            .filter_map(|(run, &colour)| {
                Some((colour, run.summary.run.as_str(), run.summary.array_power_gain?))
            })
            .filter(|row: &Row| row.2.mean.is_finite())
            .collect();
        groups.push(("All".to_owned(), rows));
    }
    groups.retain(|(_, rows)| !rows.is_empty());
    groups
}

/// Name and number of a row, at its two ends.
fn names((colour, name, gain): &Row, name_end: f64, y: f64, shapes: &mut Vec<Shape>) {
    let setting = TextStyle::plain(Ink::Text, MEDIUM).anchored(1.0);
    let label = match gain.half_width_95 {
        Some(_) => words::gain(gain),
        None => words::signed_percent(gain.mean),
    };
    let inner = vec![
        text([name_end, y + 4.0], *name, setting),
        text([WIDTH - 22.0, y + 4.0], label, setting),
    ];
    shapes.push(Shape::Group { role: Role::Run(*colour), clip: None, shapes: inner });
}

/// The gain of a row of the group called `group`, with a line at zero behind it.
fn row_whisker(group: &str, (colour, name, gain): &Row, frame: &Frame, y: f64) -> Shape {
    let style =
        Style { ink: Ink::Run(*colour), width: 2.0, cap: 5.0, radius: 5.0, numbered: false };
    let half = gain.half_width_95.map(|half| 100.0 * half);
    let [zero, _] = frame.point([0.0, 0.0]);
    let line = segment([zero, y - 0.5 * ROW], [zero, y + 0.5 * ROW], Look::line(Ink::Axis, 1.0));
    let mut shapes = vec![line];
    shapes.extend(whisker(frame, Axis::X, y, 100.0 * gain.mean, half, style));
    told(format!("{group}, {name}: {}", words::gain(gain)), *colour, shapes)
}

/// `shapes` of a run that tell `words`.
fn told(words: String, colour: usize, shapes: Vec<Shape>) -> Shape {
    let mark = Shape::Group { role: Role::Mark(words), clip: None, shapes };
    Shape::Group { role: Role::Run(colour), clip: None, shapes: vec![mark] }
}

/// A line of the figure over amplitude.
struct Line {
    name: String,
    /// Colour of its first run.
    colour: usize,
    /// Delivered amplitude (deg) with the gains of all together and of the excited turbine.
    points: Vec<(f64, [Statistic; 2])>,
}

/// Gain of all together and of the excited turbine over the delivered amplitude, a line for each
/// kind of excitation; only for studies with three amplitudes of a kind on one turbine.
pub(crate) fn gain_over_amplitude(study: &Study) -> Option<Figure> {
    const HEIGHT: f64 = 250.0;
    let lines = lines_over_amplitude(study);
    let amplitudes = lines.iter().flat_map(|line| line.points.iter().map(|point| point.0));
    let largest = amplitudes.fold(0.0, f64::max);
    if largest <= 0.0 {
        return None;
    }
    let mut shapes = Vec::new();
    let names: Vec<(usize, &str)> =
        lines.iter().map(|line| (line.colour, line.name.as_str())).collect();
    let top =
        22.0 + legend([64.0, 22.0], WIDTH - 90.0, |_| Role::Plain, &names, &mut shapes) + 18.0;
    // Without wakes there is no "together".
    let first = if study.has_wakes() { 0 } else { 1 };
    let panels = ["all together", "the excited turbine"].into_iter().enumerate().skip(first);
    for (side, title) in panels {
        let points = lines.iter().flat_map(|line| &line.points);
        let frame = Frame {
            area: [64.0 + 476.0 * (side - first) as f64, top, 424.0, HEIGHT],
            x: Scale::linear(0.0, 1.06 * largest),
            y: scale(points.map(|(_, gains)| gains[side])),
        };
        frame.rows(5, true, &mut shapes);
        frame.columns(6, true, &mut shapes);
        frame.title(title, &mut shapes);
        frame.x_label("delivered amplitude (°)", &mut shapes);
        if side == first {
            frame.y_label("power gain (%)", 46.0, &mut shapes);
        }
        let zero = [frame.point([0.0, 0.0]), frame.point([frame.x.high, 0.0])];
        let zero = segment(zero[0], zero[1], Look::line(Ink::Axis, 1.0));
        shapes.push(frame.behind(vec![zero]));
        let inner = lines.iter().map(|line| over_amplitude(line, side, &frame)).collect();
        shapes.push(frame.readout(["°", "%"]).group(6.0, inner));
    }
    Some(Figure {
        name: "gain-over-amplitude".to_owned(),
        title: "Power gain over amplitude".to_owned(),
        caption:
            "Whiskers: 95\u{a0}% intervals from paired blocks, with an arrow and its end's number where one \
             goes on beyond the axis; amplitude zero is the compared run itself."
                .to_owned(),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}

fn lines_over_amplitude(study: &Study) -> Vec<Line> {
    let mut kinds: Vec<ExcitationKind> = Vec::new();
    for excitation in study.runs().iter().flat_map(|run| study.excitations(run)) {
        if !kinds.contains(&excitation.kind) {
            kinds.push(excitation.kind);
        }
    }
    let mut lines = Vec::new();
    for kind in kinds {
        let name = match kind {
            ExcitationKind::Helix(Sense::CounterClockwise) => "counter-clockwise helix".to_owned(),
            ExcitationKind::Helix(Sense::Clockwise) => "clockwise helix".to_owned(),
            ExcitationKind::Pulse => "pulse".to_owned(),
            // Its gain is a matter of the phase offset.
            ExcitationKind::Synchronised(_) => continue,
            ExcitationKind::Named(name) => name.to_owned(),
        };
        let mut colours = Vec::new();
        let mut points = Vec::new();
        for (run, &colour) in study.runs().iter().zip(&study.colours) {
            let excitations = study.excitations(run);
            let [excitation] = excitations.as_slice() else { continue };
            let gains = (run.summary.array_power_gain, excitation.turbine.power_gain);
            let (Some(all), Some(excited)) = gains else { continue };
            if excitation.kind == kind && all.mean.is_finite() && excited.mean.is_finite() {
                colours.push(colour);
                points.push((excitation.pitch.delivered_amplitude_deg, [all, excited]));
            }
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if points.len() > 2 {
            lines.push(Line { name, colour: colours[0], points });
        }
    }
    lines
}

fn over_amplitude(line: &Line, side: usize, frame: &Frame) -> Shape {
    let ink = Ink::Run(line.colour);
    let gains = line.points.iter().map(|(amplitude, gains)| (*amplitude, gains[side]));
    let through: Vec<[f64; 2]> = std::iter::once([0.0, 0.0])
        .chain(gains.clone().map(|(amplitude, gain)| [amplitude, 100.0 * gain.mean]))
        .collect();
    let look = Look::line(ink, 1.8).dashed(run_dash(line.colour));
    let mut shapes = vec![crate::draw::polyline(frame.points(&through), look)];
    let style = Style { ink, width: 1.6, cap: 0.0, radius: 4.5, numbered: true };
    for (amplitude, gain) in gains {
        let half = gain.half_width_95.map(|half| 100.0 * half);
        let [x, _] = frame.point([amplitude, 0.0]);
        let mark = whisker(frame, Axis::Y, x, 100.0 * gain.mean, half, style);
        let degrees = words::number(amplitude, 2);
        let words = format!("{}, {degrees}°: {}", line.name, words::gain(&gain));
        shapes.push(Shape::Group { role: Role::Mark(words), clip: None, shapes: mark });
    }
    Shape::Group { role: Role::Plain, clip: None, shapes }
}
