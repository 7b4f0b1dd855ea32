//! Gains over the compared run: by turbine, and over amplitude.

use super::WIDTH;
use crate::draw::axes::{Frame, MEDIUM, SMALL, Scale, legend};
use crate::draw::colour::{Ink, run_dash};
use crate::draw::font::Face;
use crate::draw::{Figure, Look, Role, Setting, Shape, rectangle, segment, text};
use crate::sentence;
use crate::study::{Kind, Study};
use crate::words;
use basis::records::Statistic;

const ROW: f64 = 24.0;

/// One row of the figure: colour, name of the run, gain.
type Row<'a> = (usize, &'a str, Statistic);

/// Gain of each turbine and of all together in each run, with 95 % intervals.
pub(crate) fn gains(study: &Study) -> Option<Figure> {
    let groups = groups(study);
    let rows = || groups.iter().flat_map(|(_, rows)| rows);
    if rows().next().is_none() {
        return None;
    }
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
    let mut y = frame.area[1];
    for (index, (name, rows)) in groups.iter().enumerate() {
        let group_height = ROW * rows.len() as f64 + 14.0;
        if index % 2 == 0 {
            let area = [8.0, y, WIDTH - 16.0, group_height];
            shapes.push(rectangle(area, Look::fill(Ink::Band)));
        }
        let setting = Setting::plain(Ink::Text, MEDIUM).bold();
        shapes.push(text([20.0, y + 7.0 + 0.5 * ROW + 4.0], name.as_str(), setting));
        y += group_height;
    }
    let (ticks, decimals) = frame.x.ticks(8);
    for tick in ticks {
        let [x, _] = frame.point([tick, 0.0]);
        let bottom = frame.area[1] + height;
        let ink = if tick == 0.0 { Ink::Axis } else { Ink::Grid };
        shapes.push(segment([x, frame.area[1]], [x, bottom], Look::line(ink, 1.0)));
        let setting = Setting::plain(Ink::Muted, SMALL).anchored(0.5);
        shapes.push(text([x, bottom + 17.0], words::number(tick, decimals), setting));
    }
    frame.x_label("power gain over the compared run (%)", &mut shapes);
    let mut y = frame.area[1];
    for (_, rows) in &groups {
        y += 7.0;
        for row in rows {
            shapes.push(whisker(row, &frame, left - 16.0, y + 0.5 * ROW));
            y += ROW;
        }
        y += 7.0;
    }
    let best = study.best();
    Some(Figure {
        name: "gains".to_owned(),
        title: "Power gain over the compared run".to_owned(),
        caption: format!(
            "Dots: gain of the mean power; whiskers: 95 % interval from paired blocks. {}.",
            sentence::conditions_line(study, best)
        ),
        width: WIDTH,
        height: frame.area[1] + height + 50.0,
        shapes,
    })
}

/// Rows of every turbine, then of all together.
fn groups<'a>(study: &Study<'a>) -> Vec<(String, Vec<Row<'a>>)> {
    let runs = || study.runs().iter().zip(&study.colours);
    let mut groups: Vec<(String, Vec<Row>)> = study.runs()[0]
        .summary
        .turbines
        .iter()
        .map(|turbine| {
            let rows = runs()
                .filter_map(|(run, &colour)| {
                    let same = run.summary.turbines.iter().find(|t| t.name == turbine.name)?;
                    Some((colour, run.summary.run.as_str(), same.power_gain?))
                })
                .filter(|row: &Row| row.2.mean.is_finite())
                .collect();
            (turbine.name.clone(), rows)
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
    let setting = Setting::plain(Ink::Text, MEDIUM).anchored(1.0);
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
    let setting = Setting::plain(Ink::Text, MEDIUM).anchored(1.0);
    shapes.push(text([WIDTH - 22.0, y + 4.0], label, setting));
    Shape::Group { role: Role::Run(*colour), clip: None, shapes }
}

/// Gain of all turbines together over the amplitude on the first excited one, a line for each
/// kind of excitation; only for studies with three amplitudes of a kind.
pub(crate) fn gain_over_amplitude(study: &Study) -> Option<Figure> {
    const KINDS: [(Kind, &str); 3] = [
        (Kind::CounterClockwise, "counter-clockwise helix"),
        (Kind::Clockwise, "clockwise helix"),
        (Kind::Pulse, "pulse"),
    ];
    // Kind, colour of its first run, points of amplitude (deg) and gain (%), half widths (%).
    let mut lines: Vec<(&str, usize, Vec<[f64; 3]>)> = Vec::new();
    for (kind, name) in KINDS {
        let mut points = Vec::new();
        let mut first_colour = None;
        for (run, &colour) in study.runs().iter().zip(&study.colours) {
            let excitations = study.excitations(run);
            let [excitation] = excitations.as_slice() else { continue };
            let Some(gain) = run.summary.array_power_gain else { continue };
            if excitation.kind == kind && gain.mean.is_finite() {
                first_colour.get_or_insert(colour);
                let half = gain.half_width_95.unwrap_or(0.0);
                let amplitude = excitation.pitch.delivered_amplitude_deg;
                points.push([amplitude, 100.0 * gain.mean, 100.0 * half]);
            }
        }
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        if let (Some(colour), true) = (first_colour, points.len() > 2) {
            lines.push((name, colour, points));
        }
    }
    if lines.is_empty() {
        return None;
    }
    let all = || lines.iter().flat_map(|line| &line.2);
    let largest = all().map(|point| point[0]).fold(0.0, f64::max);
    let mut shapes = Vec::new();
    let names: Vec<(usize, &str)> = lines.iter().map(|line| (line.1, line.0)).collect();
    let top = 22.0 + legend([64.0, 22.0], WIDTH - 90.0, &names, &mut shapes);
    let frame = Frame {
        area: [64.0, top, 560.0, 260.0],
        x: Scale::linear(0.0, 1.06 * largest),
        y: Scale::around(all().flat_map(|p| [p[1] - p[2], p[1] + p[2], 0.0]), 0.06),
    };
    frame.rows(5, &mut shapes);
    frame.columns(6, true, &mut shapes);
    let zero = [frame.point([0.0, 0.0]), frame.point([frame.x.high, 0.0])];
    shapes.push(segment(zero[0], zero[1], Look::line(Ink::Axis, 1.0)));
    frame.x_label("delivered amplitude (°)", &mut shapes);
    frame.y_label("gain of all turbines together (%)", 46.0, &mut shapes);
    for (_, colour, points) in &lines {
        let ink = Ink::Run(*colour);
        let through: Vec<[f64; 2]> =
            std::iter::once([0.0, 0.0]).chain(points.iter().map(|p| [p[0], p[1]])).collect();
        let look = Look::line(ink, 1.6).dashed(run_dash(*colour));
        shapes.push(frame.panel(vec![frame.line(&through, look)], ["°", "%"]));
        for [amplitude, gain, half] in points {
            let ends = [gain - half, gain + half].map(|value| frame.point([*amplitude, value]));
            shapes.push(segment(ends[0], ends[1], Look::line(ink, 1.6)));
            let center = frame.point([*amplitude, *gain]);
            shapes.push(Shape::Circle { center, radius: 4.5, look: Look::fill(ink) });
        }
    }
    Some(Figure {
        name: "gain-over-amplitude".to_owned(),
        title: "Gain of the array over amplitude".to_owned(),
        caption: format!(
            "Whiskers: 95 % intervals from paired blocks; amplitude zero is the compared run itself. \
             {}.",
            sentence::conditions_line(study, study.best())
        ),
        width: WIDTH,
        height: top + 260.0 + 50.0,
        shapes,
    })
}
