//! Means over height, with the span of a rotor.

use crate::draw::axes::{Frame, Readout, SMALL, Scale};
use crate::draw::colour::Ink;
use crate::draw::{Axis, Figure, Look, Shape, TextStyle, rectangle, segment, text};
use crate::figures::WIDTH;
use crate::precursor::{HubWind, LevelRow, PrecursorRecords};

const HEIGHT: f64 = 320.0;
const LEFT: f64 = 64.0;
const TOP: f64 = 34.0;
const GAP: f64 = 22.0;

/// A quantity of a level: title, unit, value.
type Quantity = (&'static str, &'static str, fn(&LevelRow, &HubWind) -> f64);

/// What is shown, side by side.
const QUANTITIES: [Quantity; 5] = [
    ("Speed", "m/s", |level, _| level.speed),
    ("Direction", "°", |level, hub| {
        let turned = level.direction_deg - hub.direction_deg;
        hub.direction_deg + (turned + 180.0).rem_euclid(360.0) - 180.0
    }),
    ("Turbulence intensity", "%", |level, _| 100.0 * level.turbulence_intensity),
    ("Stress", "m²/s²", |level, _| level.stress),
    ("Temperature", "K", |level, _| level.temperature),
];

/// Profiles over the record.
pub(super) fn profiles(records: &PrecursorRecords) -> Option<Figure> {
    let top = records.levels.last()?.height;
    let n = QUANTITIES.len() as f64;
    let width = (WIDTH - LEFT - 24.0 - GAP * (n - 1.0)) / n;
    let mut shapes = Vec::new();
    for (index, (title, unit, of)) in QUANTITIES.iter().enumerate() {
        let line: Vec<[f64; 2]> =
            records.levels.iter().map(|level| [of(level, &records.hub), level.height]).collect();
        let frame = Frame {
            area: [LEFT + (width + GAP) * index as f64, TOP, width, HEIGHT],
            x: Scale::around(line.iter().map(|point| point[0]), 0.06),
            y: Scale::linear(0.0, top),
        };
        shapes.push(frame.behind(rotor(&records.hub, &frame, index == 0)));
        frame.rows(6, index == 0, &mut shapes);
        frame.columns(3, true, &mut shapes);
        frame.title(title, &mut shapes);
        frame.x_label(unit, &mut shapes);
        if index == 0 {
            frame.y_label("height (m)", 48.0, &mut shapes);
        }
        let drawn = frame.line(&line, Look::line(Ink::Run(2), 2.0));
        let readout = frame.readout([unit, "m"]);
        shapes.push(Readout { along: Axis::Y, ..readout }.group(0.0, vec![drawn]));
    }
    let marked = match records.hub.rotor_diameter {
        Some(_) => "The dashed line is the hub, the band what the rotor spans.",
        None => "The dashed line is the hub.",
    };
    Some(Figure {
        name: "profiles".to_owned(),
        title: "Means over the record".to_owned(),
        caption: format!(
            "Means over each level and the record. Direction is where the wind comes from, clockwise from north; turbulence intensity is √(2k/3) over speed, of all three components; stress and temperature hold what the grid does not resolve. {marked}"
        ),
        width: WIDTH,
        height: TOP + HEIGHT + 50.0,
        shapes,
    })
}

/// What the rotor spans, and the line of the hub, named where `named`.
fn rotor(hub: &HubWind, frame: &Frame, named: bool) -> Vec<Shape> {
    let mut shapes = Vec::new();
    if let Some(diameter) = hub.rotor_diameter {
        let ends = [-0.5, 0.5].map(|side| hub.height + side * diameter);
        let area = frame.rectangle([frame.x.low, ends[0]], [frame.x.high, ends[1]]);
        shapes.push(rectangle(area, Look::fill(Ink::Grid).opacity(0.8)));
    }
    let ends = [frame.x.low, frame.x.high].map(|x| frame.point([x, hub.height]));
    let look = Look::line(Ink::Axis, 1.0).dashed(Some([4.0, 3.0]));
    shapes.push(segment(ends[0], ends[1], look));
    if named {
        let place = [ends[0][0] + 4.0, ends[0][1] - 4.0];
        shapes.push(text(place, "hub", TextStyle::plain(Ink::Muted, SMALL)));
    }
    shapes
}
