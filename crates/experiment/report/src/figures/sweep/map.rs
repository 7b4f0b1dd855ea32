//! Gain as a map over two swept numbers.

use super::super::WIDTH;
use super::super::sheet::colour_bar;
use super::{axis_name, key_name, number, numeric, parts, title};
use crate::draw::axes::{LARGE, MEDIUM, SMALL};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Role, Shape, TextStyle, rectangle, text};
use crate::words;
use basis::records::{SweepRow, SweepTable, SweptKey};

/// Maps at most.
const MOST_PANELS: usize = 3;
/// Height of a cell, and its width at most.
const CELL: [f64; 2] = [110.0, 38.0];
const LEFT: f64 = 84.0;
const TOP: f64 = 44.0;

/// One map: the rows of one run of the case file, and what of them is shown.
struct Panel<'a> {
    title: String,
    rows: Vec<&'a SweepRow>,
    part: &'a str,
}

/// Gains over the two numbers of a sweep of just two, a map for each run of the case file that was swept.
pub(super) fn map(table: &SweepTable) -> Option<Figure> {
    let numeric = numeric(table);
    let [(first, rows), (second, columns)] = numeric.as_slice() else { return None };
    let is_other = |key: &&SweptKey| key.key != first.key && key.key != second.key;
    if table.keys.iter().any(|key| is_other(&key)) {
        return None;
    }
    let panels = panels(table);
    let gains =
        || panels.iter().flat_map(|panel| panel.rows.iter().map(|row| gain(row, panel.part)));
    let greatest = gains().flatten().map(f64::abs).fold(0.0, f64::max);
    if greatest == 0.0 {
        return None;
    }
    // The darkest colours, on which no number can be read, are left out.
    let most = 1.5 * greatest;
    let step = (WIDTH - LEFT - 70.0) / panels.len() as f64;
    let width = CELL[0].min((step - 60.0) / columns.len() as f64);
    let height = CELL[1] * rows.len() as f64;
    let mut shapes = Vec::new();
    for (place, panel) in panels.iter().enumerate() {
        let left = LEFT + step.min(width * columns.len() as f64 + 90.0) * place as f64;
        let cell = |row: usize, column: usize| {
            // Upwards, as on an axis.
            let top = TOP + CELL[1] * (rows.len() - 1 - row) as f64;
            [left + width * column as f64, top, width, CELL[1]]
        };
        let heading = TextStyle::plain(Ink::Text, LARGE).bold();
        shapes.push(text([left, TOP - 12.0], panel.title.as_str(), heading));
        for row in &panel.rows {
            let place = |key, values: &[f64]| {
                let value = number(row, key)?;
                values.iter().position(|other| *other == value)
            };
            let places = place(first, rows).zip(place(second, columns));
            let Some(((r, c), gain)) = places.zip(gain(row, panel.part)) else { continue };
            shapes.push(drawn(cell(r, c), gain, most, &row.run));
        }
        let ticks = (left, width, height);
        labels(ticks, (rows, columns), (place == 0).then_some(first), second, &mut shapes);
    }
    let right = LEFT + step.min(width * columns.len() as f64 + 90.0) * panels.len() as f64;
    let bar = [(right - 40.0).min(WIDTH - 62.0), TOP, 14.0, height.max(110.0)];
    colour_bar(bar, [-100.0 * most, 100.0 * most], Map::Diverging, 5, "%", &mut shapes);
    Some(Figure {
        name: "sweep-map".to_owned(),
        title: format!("Power gain over {} and {}", key_name(first), key_name(second)),
        caption: "Gain of the mean power over the compared run in the same wind, in percent; white is none."
            .to_owned(),
        width: WIDTH,
        height: TOP + height.max(110.0) + 54.0,
        shapes,
    })
}

/// A map for each swept run of the case file, or for several parts where only one was swept.
fn panels(table: &SweepTable) -> Vec<Panel<'_>> {
    let mut bases: Vec<&str> = Vec::new();
    let is_compared = |row: &&SweepRow| row.parts.iter().any(|part| part.gain.is_some());
    for row in table.rows.iter().filter(is_compared) {
        if !bases.contains(&row.base.as_str()) {
            bases.push(&row.base);
        }
    }
    let parts = parts(table);
    let of = |base: &str| table.rows.iter().filter(|row| row.base == base).collect::<Vec<_>>();
    let panels: Vec<Panel> = match (bases.as_slice(), parts.as_slice()) {
        (_, []) => Vec::new(),
        ([base], parts) => parts
            .iter()
            .map(|part| Panel { title: title(part).to_owned(), rows: of(base), part })
            .collect(),
        (bases, [part, ..]) => bases
            .iter()
            .map(|base| Panel { title: format!("{base}, {}", title(part)), rows: of(base), part })
            .collect(),
    };
    panels.into_iter().take(MOST_PANELS).collect()
}

fn gain(row: &SweepRow, part: &str) -> Option<f64> {
    row.part(part)?.gain.map(|gain| gain.mean).filter(|gain| gain.is_finite())
}

/// A cell with its number.
fn drawn(area: [f64; 4], gain: f64, most: f64, run: &str) -> Shape {
    let [left, top, width, height] = area;
    let picture = Picture::new([1, 1], Map::Diverging, [-most, most], |_, _| gain);
    let setting = TextStyle::plain(Ink::OnField, SMALL).anchored(0.5).on_field();
    let middle = [left + 0.5 * width, top + 0.5 * height + 4.0];
    let shapes = vec![
        Shape::Field { area, picture },
        rectangle(area, Look::line(Ink::Paper, 1.5)),
        text(middle, words::signed(100.0 * gain, 1), setting),
    ];
    let told = format!("{run}: {}", words::signed_percent(gain));
    Shape::Group { role: Role::Mark(told), clip: None, shapes }
}

/// The values of both keys beside their cells; the name of the `first` one too, where it is given.
fn labels(
    (left, width, height): (f64, f64, f64),
    (rows, columns): (&[f64], &[f64]),
    first: Option<&SweptKey>,
    second: &SweptKey,
    shapes: &mut Vec<Shape>,
) {
    let setting = TextStyle::plain(Ink::Muted, SMALL);
    for (place, value) in rows.iter().rev().enumerate() {
        let y = TOP + CELL[1] * (place as f64 + 0.5) + 4.0;
        shapes.push(text([left - 7.0, y], value.to_string(), setting.anchored(1.0)));
    }
    for (place, value) in columns.iter().enumerate() {
        let x = left + width * (place as f64 + 0.5);
        shapes.push(text([x, TOP + height + 17.0], value.to_string(), setting.anchored(0.5)));
    }
    let setting = TextStyle::plain(Ink::Muted, MEDIUM).anchored(0.5);
    let middle = left + 0.5 * width * columns.len() as f64;
    shapes.push(text([middle, TOP + height + 38.0], axis_name(second), setting));
    if let Some(first) = first {
        let middle = [left - 56.0, TOP + 0.5 * height];
        shapes.push(text(middle, axis_name(first), setting.upwards()));
    }
}
