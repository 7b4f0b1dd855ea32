//! Gains over the compared run: by turbine, and over amplitude.

use super::WIDTH;
use crate::draw::axes::{Frame, MEDIUM, SMALL, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::font::Face;
use crate::draw::{Figure, Look, Role, Shape, TextStyle, rectangle, segment, text};
use crate::study::{ExcitationKind, Study};
use crate::words;
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
    let ends = rows().flat_map(|row| {
        let half = row.2.half_width_95.unwrap_or(0.0);
        [100.0 * (row.2.mean - half), 100.0 * (row.2.mean + half), 0.0]
    });
    let frame = Frame {
        area: [left, 18.0, WIDTH - left - 150.0, height],
        x: Scale::around(ends, 0.06),
        y: Scale::linear(0.0, 1.0),
    };
    let mut shapes = Vec::new();
    bands(&groups, frame.area[1], &mut shapes);
    ruler(&frame, &mut shapes);
    let mut y = frame.area[1];
    for (_, rows) in &groups {
        y += 7.0;
        for row in rows {
            shapes.push(whisker(row, &frame, left - 16.0, y + 0.5 * ROW));
            y += ROW;
        }
        y += 7.0;
    }
    Some(Figure {
        name: "gains".to_owned(),
        title: "Power gain over the compared run".to_owned(),
        caption: "Dots: gain of the mean power; whiskers: 95\u{a0}% interval from paired blocks."
            .to_owned(),
        width: WIDTH,
        height: frame.area[1] + height + 50.0,
        shapes,
    })
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
fn ruler(frame: &Frame, shapes: &mut Vec<Shape>) {
    let (ticks, decimals) = frame.x.ticks(8);
    for tick in ticks {
        let [x, _] = frame.point([tick, 0.0]);
        let bottom = frame.area[1] + frame.area[3];
        let ink = if tick == 0.0 { Ink::Axis } else { Ink::Grid };
        shapes.push(segment([x, frame.area[1]], [x, bottom], Look::line(ink, 1.0)));
        let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(0.5);
        shapes.push(text([x, bottom + 17.0], words::number(tick, decimals), setting));
    }
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
    if groups.len() > 1 {
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

fn whisker((colour, name, gain): &Row, frame: &Frame, name_end: f64, y: f64) -> Shape {
    let x = |share: f64| frame.point([100.0 * share, 0.0])[0];
    let look = Look::line(Ink::Run(*colour), 2.0);
    let mut shapes = Vec::new();
    let setting = TextStyle::plain(Ink::Text, MEDIUM).anchored(1.0);
    shapes.push(text([name_end, y + 4.0], *name, setting));
    if let Some(half) = gain.half_width_95 {
        let (from, to) = (x(gain.mean - half), x(gain.mean + half));
        shapes.push(segment([from, y], [to, y], look));
        shapes.push(segment([from, y - 5.0], [from, y + 5.0], look));
        shapes.push(segment([to, y - 5.0], [to, y + 5.0], look));
    }
    let center = [x(gain.mean), y];
    shapes.push(Shape::Circle { center, radius: 5.0, look: Look::fill(Ink::Run(*colour)) });
    let label = match gain.half_width_95 {
        Some(_) => words::gain(gain),
        None => words::signed_percent(gain.mean),
    };
    let setting = TextStyle::plain(Ink::Text, MEDIUM).anchored(1.0);
    shapes.push(text([WIDTH - 22.0, y + 4.0], label, setting));
    Shape::Group { role: Role::Run(*colour), clip: None, shapes }
}

/// A line of the figure over amplitude.
struct Line {
    name: &'static str,
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
    let names: Vec<(usize, &str)> = lines.iter().map(|line| (line.colour, line.name)).collect();
    let top =
        22.0 + legend([64.0, 22.0], WIDTH - 90.0, |_| Role::Plain, &names, &mut shapes) + 18.0;
    for (side, title) in ["all together", "the excited turbine"].into_iter().enumerate() {
        let ends = lines.iter().flat_map(|line| &line.points).flat_map(|(_, gains)| {
            let half = gains[side].half_width_95.unwrap_or(0.0);
            [gains[side].mean - half, gains[side].mean + half, 0.0].map(|share| 100.0 * share)
        });
        let frame = Frame {
            area: [64.0 + 476.0 * side as f64, top, 424.0, HEIGHT],
            x: Scale::linear(0.0, 1.06 * largest),
            y: Scale::around(ends, 0.06),
        };
        frame.rows(5, true, &mut shapes);
        frame.columns(6, true, &mut shapes);
        frame.title(title, &mut shapes);
        frame.x_label("delivered amplitude (°)", &mut shapes);
        if side == 0 {
            frame.y_label("power gain (%)", 46.0, &mut shapes);
        }
        let zero = [frame.point([0.0, 0.0]), frame.point([frame.x.high, 0.0])];
        shapes.push(segment(zero[0], zero[1], Look::line(Ink::Axis, 1.0)));
        for line in &lines {
            over_amplitude(line, side, &frame, &mut shapes);
        }
    }
    Some(Figure {
        name: "gain-over-amplitude".to_owned(),
        title: "Power gain over amplitude".to_owned(),
        caption:
            "Whiskers: 95\u{a0}% intervals from paired blocks; amplitude zero is the compared \
                  run itself."
                .to_owned(),
        width: WIDTH,
        height: top + HEIGHT + 50.0,
        shapes,
    })
}

fn lines_over_amplitude(study: &Study) -> Vec<Line> {
    const KINDS: [(ExcitationKind, &str); 3] = [
        (ExcitationKind::CounterClockwise, "counter-clockwise helix"),
        (ExcitationKind::Clockwise, "clockwise helix"),
        (ExcitationKind::Pulse, "pulse"),
    ];
    let mut lines = Vec::new();
    for (kind, name) in KINDS {
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

fn over_amplitude(line: &Line, side: usize, frame: &Frame, shapes: &mut Vec<Shape>) {
    let ink = Ink::Run(line.colour);
    let gains = line.points.iter().map(|(amplitude, gains)| (*amplitude, gains[side]));
    let through: Vec<[f64; 2]> = std::iter::once([0.0, 0.0])
        .chain(gains.clone().map(|(amplitude, gain)| [amplitude, 100.0 * gain.mean]))
        .collect();
    let look = Look::line(ink, 1.8).dashed(run_dash(line.colour));
    shapes.push(crate::draw::polyline(frame.points(&through), look));
    for (amplitude, gain) in gains {
        if let Some(half) = gain.half_width_95 {
            let ends = [gain.mean - half, gain.mean + half]
                .map(|share| frame.point([amplitude, 100.0 * share]));
            shapes.push(segment(ends[0], ends[1], Look::line(ink, 1.6)));
        }
        let center = frame.point([amplitude, 100.0 * gain.mean]);
        shapes.push(Shape::Circle { center, radius: 4.5, look: Look::fill(ink) });
    }
}
