//! Gains wind by wind, and all winds together with their interval.

use super::super::WIDTH;
use super::super::gains::ruler;
use super::lines::scale;
use super::{parts, settings, title};
use crate::draw::axes::{Frame, MEDIUM, Readout, Scale};
use crate::draw::colour::Ink;
use crate::draw::font::Face;
use crate::draw::whisker::{Style, whisker};
use crate::draw::{Axis, Figure, Look, Role, Shape, TextStyle, rectangle, segment, text};
use crate::words;
use basis::records::{Statistic, SweepPart, SweepRow, SweepTable};

const ROW: f64 = 26.0;
/// Rows at most; a table tells of more.
const MOST: usize = 60;

/// A row: name, and what came of one of its parts.
struct Row<'a> {
    name: String,
    part: &'a SweepPart,
    gain: Statistic,
}

/// The gain of each run, of all together or else of each turbine: a small dot for each wind, a large one with
/// its interval for all.
pub(super) fn winds(table: &SweepTable) -> Option<Figure> {
    let rows = rows(table);
    rows.first()?;
    let face = Face::new(false);
    let width = rows.iter().map(|row| face.width(&row.name, MEDIUM)).fold(60.0, f64::max);
    let left = 40.0 + 1.08 * width.min(420.0);
    let height = ROW * rows.len() as f64 + 14.0;
    let single = rows.iter().flat_map(|row| &row.part.gains);
    let single = single.map(|gain| Statistic {
        mean: gain.gain,
        standard_deviation: 0.0,
        half_width_95: None,
        n_blocks: 1,
    });
    let frame = Frame {
        area: [left, 18.0, WIDTH - left - 140.0, height],
        x: scale(rows.iter().map(|row| row.gain).chain(single)),
        y: Scale::linear(0.0, 1.0),
    };
    let area = [8.0, frame.area[1], WIDTH - 16.0, height];
    let mut shapes = vec![rectangle(area, Look::fill(Ink::Band))];
    ruler(&frame, &mut shapes);
    let mut marks = Vec::new();
    for (place, row) in rows.iter().enumerate() {
        let y = frame.area[1] + 7.0 + ROW * (place as f64 + 0.5);
        let setting = TextStyle::plain(Ink::Text, MEDIUM);
        shapes.push(text([left - 16.0, y + 4.0], row.name.as_str(), setting.anchored(1.0)));
        let label = words::gain(&row.gain);
        shapes.push(text([WIDTH - 22.0, y + 4.0], label, setting.anchored(1.0)));
        marks.push(drawn(row, &frame, y));
    }
    shapes.push(Readout { both: false, ..frame.readout(["%", ""]) }.group(6.0, marks));
    Some(Figure {
        name: "sweep-winds".to_owned(),
        title: "Power gain, wind by wind".to_owned(),
        caption: format!(
            "Small dots: gain of the mean power over the compared run in each of {} winds; large dot and whiskers: their mean with its 95\u{a0}% \
             interval by Student's t, an arrow where one goes on beyond the axis.",
            table.seeds.len()
        ),
        width: WIDTH,
        height: frame.area[1] + height + 50.0,
        shapes,
    })
}

/// What is drawn, of all together where turbines feel one another, else of every turbine.
fn rows(table: &SweepTable) -> Vec<Row<'_>> {
    let names = parts(table);
    let names = if names.first() == Some(&"all") { &names[..1] } else { &names[..] };
    let row = |row: &'_ SweepRow, name: &&str| -> Option<(String, Statistic)> {
        let gain = row.part(name)?.gain.filter(|gain| gain.mean.is_finite())?;
        let values: Vec<String> = settings(table, row, |_| true).collect();
        let of = if names.len() > 1 { format!("{}, ", title(name)) } else { String::new() };
        let with =
            if values.is_empty() { String::new() } else { format!(": {}", values.join(", ")) };
        Some((format!("{of}{}{with}", row.base), gain))
    };
    let mut rows = Vec::new();
    for name in names {
        for own in &table.rows {
            let Some(part) = own.part(name).filter(|part| part.gains.len() > 1) else { continue };
            let Some((name, gain)) = row(own, name) else { continue };
            rows.push(Row { name, part, gain });
        }
    }
    rows.truncate(MOST);
    rows
}

/// The marks of `row` at the height `y`, with a line at zero behind them.
fn drawn(row: &Row, frame: &Frame, y: f64) -> Shape {
    let [zero, _] = frame.point([0.0, 0.0]);
    let line = segment([zero, y - 0.5 * ROW], [zero, y + 0.5 * ROW], Look::line(Ink::Axis, 1.0));
    let mut shapes = vec![line];
    let ink = Ink::Run(1);
    let style = Style { ink, width: 2.0, cap: 5.0, radius: 5.0, numbered: false };
    let half = row.gain.half_width_95.map(|half| 100.0 * half);
    shapes.extend(whisker(frame, Axis::X, y, 100.0 * row.gain.mean, half, style));
    for gain in &row.part.gains {
        let [x, _] = frame.point([100.0 * gain.gain, 0.0]);
        let look = Look::fill(Ink::Run(2)).opacity(0.75);
        shapes.push(Shape::Circle { center: [x, y], radius: 2.6, look });
    }
    let told = format!("{}: {}", row.name, words::gain(&row.gain));
    Shape::Group { role: Role::Mark(told), clip: None, shapes }
}
