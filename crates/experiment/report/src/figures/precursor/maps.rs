//! Quantities over time and height, as fields of colour.

use crate::draw::axes::{FieldValues, Frame, Readout, Scale};
use crate::draw::colour::{Ink, Map};
use crate::draw::field::Picture;
use crate::draw::{Figure, Look, Shape, segment};
use crate::figures::WIDTH;
use crate::figures::sheet::colour_bar;
use crate::precursor::{HubWind, PrecursorRecords, TimeHeightMap};

const HEIGHT: f64 = 210.0;
const LEFT: f64 = 64.0;
const RIGHT: f64 = 84.0;
const TOP: f64 = 34.0;
const GAP: f64 = 44.0;

/// The maps, one below the other.
pub(super) fn maps(records: &PrecursorRecords) -> Option<Figure> {
    let whole = |map: &&TimeHeightMap| {
        map.times.len() > 1
            && map.heights.len() > 1
            && map.values.len() == map.times.len() * map.heights.len()
    };
    let maps: Vec<&TimeHeightMap> = records.maps.iter().filter(whole).collect();
    let mut shapes = Vec::new();
    for (index, map) in maps.iter().enumerate() {
        let area = [LEFT, TOP + (HEIGHT + GAP) * index as f64, WIDTH - LEFT - RIGHT, HEIGHT];
        drawn(map, area, (&records.hub, index + 1 == maps.len()), records.record_from, &mut shapes);
    }
    (!maps.is_empty()).then(|| Figure {
        name: "over-time-and-height".to_owned(),
        title: "Over time and height".to_owned(),
        caption: "Means over each level. The upright line is the beginning of the record, the dashed ones are the rotor's highest and lowest point, or the hub.".to_owned(),
        width: WIDTH,
        height: TOP + (HEIGHT + GAP) * maps.len() as f64 - GAP + 50.0,
        shapes,
    })
}

/// `map` in `area`, with its bar, and its times where it is the last.
fn drawn(
    map: &TimeHeightMap,
    area: [f64; 4],
    (hub, is_last): (&HubWind, bool),
    record_from: f64,
    shapes: &mut Vec<Shape>,
) {
    let [_, top, width, height] = area;
    let ends = |values: &[f64]| [values[0], values[values.len() - 1]];
    let ([start, end], [_, highest]) = (ends(&map.times), ends(&map.heights));
    let frame = Frame { area, x: Scale::linear(start, end), y: Scale::linear(0.0, highest) };
    let scale = Scale::around(map.values.iter().copied(), 0.0);
    let range = [scale.low, scale.high];
    let size = [width.round() as usize, height.round() as usize];
    let picture = Picture::new(size, Map::Sequential, range, |column, row| {
        let share = [(column as f64 + 0.5) / width, 1.0 - (row as f64 + 0.5) / height];
        let time = nearest(&map.times, start + share[0] * (end - start));
        map.values[time * map.heights.len() + nearest(&map.heights, share[1] * highest)]
    });
    let mut inner = vec![Shape::Field { area, picture }];
    // Pale, so that it is seen on the dark end of the colours; outlined for the pale one.
    let mut line = |from, to, dash| {
        for look in [Look::line(Ink::OnField, 2.4).opacity(0.5), Look::line(Ink::FieldHalo, 1.2)] {
            inner.push(segment(from, to, look.dashed(dash)));
        }
    };
    let record = [0.0, highest].map(|height| frame.point([record_from, height]));
    line(record[0], record[1], None);
    let half = hub.rotor_diameter.map_or(0.0, |diameter| 0.5 * diameter);
    for side in [-half, half] {
        let ends = [start, end].map(|time| frame.point([time, hub.height + side]));
        line(ends[0], ends[1], Some([4.0, 3.0]));
    }
    frame.title(&map.name, shapes);
    frame.heights(5, shapes);
    frame.y_label("height (m)", 48.0, shapes);
    frame.columns(9, is_last, shapes);
    if is_last {
        frame.x_label("time (s)", shapes);
    }
    let bar = [WIDTH - RIGHT + 22.0, top + 6.0, 14.0, height - 6.0];
    colour_bar(bar, range, Map::Sequential, 5, &map.unit, shapes);
    let (name, unit) = (map.name.clone(), map.unit.clone());
    let field = Some(FieldValues { name, run: 0, range, unit });
    shapes.push(Readout { field, ..frame.readout(["s", "m"]) }.group(0.0, inner));
}

/// Place of the value of `values`, which ascend, that is nearest to `wanted`.
fn nearest(values: &[f64], wanted: f64) -> usize {
    let above = values.partition_point(|value| *value < wanted).min(values.len() - 1);
    let below = above.saturating_sub(1);
    if wanted - values[below] < values[above] - wanted { below } else { above }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_value_is_found() {
        let values = [10.0, 30.0, 50.0];
        for (wanted, place) in [(-5.0, 0), (19.0, 0), (21.0, 1), (49.0, 2), (900.0, 2)] {
            assert_eq!(nearest(&values, wanted), place, "{wanted}");
        }
    }
}
