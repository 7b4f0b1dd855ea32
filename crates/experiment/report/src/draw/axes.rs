//! Pairs of axes: where a value lies on the sheet, ticks at round numbers, grids, labels.

use super::colour::Ink;
use super::font::Face;
use super::{Axis, Look, Role, Shape, TextStyle, polyline, rectangle, segment, text};
use crate::words;

/// Size of tick labels.
pub(crate) const SMALL: f64 = 11.5;
/// Size of axis labels.
pub(crate) const MEDIUM: f64 = 12.5;
/// Size of panel titles.
pub(crate) const LARGE: f64 = 13.5;

/// Ratio of the ends of a logarithmic axis from which on powers of ten are ticks enough.
const LONG: f64 = 1e3;
/// Multiples of a power of ten that are ticks of a shorter one.
const MULTIPLES: [f64; 3] = [1.0, 2.0, 5.0];

/// Values along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    /// Value at the left or lower end; the larger one where an axis runs backwards.
    pub(crate) low: f64,
    /// Value at the other end.
    pub(crate) high: f64,
    /// Whether equal steps are equal ratios.
    pub(crate) logarithmic: bool,
}

impl Scale {
    /// From `low` to `high` in equal steps.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        Self { low, high, logarithmic: false }
    }

    /// Around all finite `values`, with a margin of `margin` of their spread; never empty.
    pub(crate) fn around(values: impl IntoIterator<Item = f64>, margin: f64) -> Self {
        let finite = values.into_iter().filter(|value| value.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if low > high {
            return Self::linear(0.0, 1.0);
        }
        let least = 1e-3 * low.abs().max(high.abs()).max(1e-9);
        let spread = (high - low).max(least);
        let middle = 0.5 * (low + high);
        Self::linear(middle - (0.5 + margin) * spread, middle + (0.5 + margin) * spread)
    }

    /// Around all finite `values` and the means of `whiskers`, each with its half length, which it holds too
    /// as far as `reach` beyond their means.
    pub(crate) fn around_whiskers(
        values: impl IntoIterator<Item = f64>,
        whiskers: &[(f64, f64)],
        reach: f64,
        margin: f64,
    ) -> Self {
        let ends = whiskers.iter().flat_map(|&(mean, half)| {
            let half = half.clamp(0.0, reach);
            [mean - half, mean + half]
        });
        Self::around(values.into_iter().chain(ends), margin)
    }

    /// Where `value` lies between the ends (0 to 1 within).
    fn share(&self, value: f64) -> f64 {
        if self.logarithmic {
            (value.max(f64::MIN_POSITIVE) / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// The words for a tick of so many decimals.
    fn label(&self, tick: f64, decimals: usize) -> String {
        if self.logarithmic { power(tick) } else { words::number(tick, decimals) }
    }

    /// Round values between the ends, about `n_wanted` of them, and their decimals.
    pub(crate) fn ticks(&self, n_wanted: usize) -> (Vec<f64>, usize) {
        let (low, high) = (self.low.min(self.high), self.low.max(self.high));
        if self.logarithmic {
            let first = low.log10().ceil() as i32;
            let last = high.log10().floor() as i32;
            let powers = |power: i32| MULTIPLES.map(|multiple| multiple * 10f64.powi(power));
            let is_long = high > LONG * low;
            let shown = |tick: &f64| (low..=high).contains(tick);
            let ticks = if is_long {
                (first..=last).map(|power| 10f64.powi(power)).collect()
            } else {
                (first - 1..=last).flat_map(powers).filter(shown).collect()
            };
            return (ticks, 0);
        }
        let rough = (high - low) / n_wanted.max(1) as f64;
        if !(rough.is_finite() && rough > 0.0) {
            return (Vec::new(), 0);
        }
        let power = rough.log10().floor();
        let factor = rough / 10f64.powf(power);
        let (factor, power) = match factor {
            f if f < 1.5 => (1.0, power),
            f if f < 3.5 => (2.0, power),
            f if f < 7.5 => (5.0, power),
            _ => (1.0, power + 1.0),
        };
        let step = factor * 10f64.powf(power);
        let first = (low / step - 1e-6).ceil() as i64;
        let last = (high / step + 1e-6).floor() as i64;
        ((first..=last).map(|index| index as f64 * step).collect(), (-power).max(0.0) as usize)
    }
}

/// What a pointer can read off a panel.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Readout {
    /// Left, top, width, height of the frame.
    pub(crate) frame: [f64; 4],
    /// Values at the left, right, lower and upper end.
    pub(crate) range: [f64; 4],
    /// Whether the horizontal and the vertical axis are logarithmic.
    pub(crate) logarithmic: [bool; 2],
    /// Unit of the horizontal axis.
    pub(crate) x_unit: String,
    /// Unit of the vertical axis.
    pub(crate) y_unit: String,
    /// The axis along which the nearest point of a line is looked for.
    pub(crate) along: Axis,
    /// Whether both axes are enlarged, not the horizontal one alone.
    pub(crate) both: bool,
    /// What the colours mean, where it is a field.
    pub(crate) field: Option<FieldValues>,
}

impl Readout {
    /// `shapes` as the group that it tells of, cut `margin` outside its frame.
    pub(crate) fn group(self, margin: f64, shapes: Vec<Shape>) -> Shape {
        let [left, top, width, height] = self.frame;
        let clip = [left - margin, top - margin, width + 2.0 * margin, height + 2.0 * margin];
        Shape::Group { role: Role::Panel(self), clip: Some(clip), shapes }
    }
}

/// What the colours of a field mean.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FieldValues {
    /// What it shows, in a few words.
    pub(crate) name: String,
    /// Colour index of its run.
    pub(crate) run: usize,
    /// Values of the first and the last colour.
    pub(crate) range: [f64; 2],
    /// Unit of the values.
    pub(crate) unit: String,
}

/// A rectangle on the sheet with a scale on each side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frame {
    /// Left, top, width, height.
    pub(crate) area: [f64; 4],
    /// Horizontal values.
    pub(crate) x: Scale,
    /// Vertical values, upwards.
    pub(crate) y: Scale,
}

impl Frame {
    /// Where the values (x, y) lie on the sheet.
    pub(crate) fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, width, height] = self.area;
        [left + width * self.x.share(x), top + height * (1.0 - self.y.share(y))]
    }

    /// Where all `values` lie on the sheet.
    pub(crate) fn points(&self, values: &[[f64; 2]]) -> Vec<[f64; 2]> {
        values
            .iter()
            .filter(|value| value[0].is_finite() && value[1].is_finite())
            .map(|value| self.point(*value))
            .collect()
    }

    /// A line through `values` that a pointer can read.
    pub(crate) fn line(&self, values: &[[f64; 2]], look: Look) -> Shape {
        polyline(self.points(values), Look { readable: true, ..look })
    }

    /// The rectangle on the sheet that spans two corners in values.
    pub(crate) fn rectangle(&self, from: [f64; 2], to: [f64; 2]) -> [f64; 4] {
        let (from, to) = (self.point(from), self.point(to));
        let (left, top) = (from[0].min(to[0]), from[1].min(to[1]));
        [left, top, (to[0] - from[0]).abs(), (to[1] - from[1]).abs()]
    }

    /// Horizontal grid lines, with their values at the left where `labelled`.
    pub(crate) fn rows(&self, n_wanted: usize, labelled: bool, shapes: &mut Vec<Shape>) {
        let [left, _, width, _] = self.area;
        let (ticks, decimals) = self.y.ticks(n_wanted);
        let mut inner = Vec::new();
        for tick in ticks {
            let [_, y] = self.point([self.x.low, tick]);
            inner.push(segment([left, y], [left + width, y], Look::line(Ink::Grid, 1.0)));
            if !labelled {
                continue;
            }
            let label = self.y.label(tick, decimals);
            let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(1.0);
            inner.push(text([left - 7.0, y + 4.0], label, setting));
        }
        self.ticks(Axis::Y, inner, shapes);
    }

    /// Ticks with their values left of a field, without grid lines across it.
    pub(crate) fn heights(&self, n_wanted: usize, shapes: &mut Vec<Shape>) {
        let left = self.area[0];
        let (ticks, decimals) = self.y.ticks(n_wanted);
        let mut inner = Vec::new();
        for tick in ticks {
            let [_, y] = self.point([self.x.low, tick]);
            inner.push(segment([left - 4.0, y], [left, y], Look::line(Ink::Axis, 1.0)));
            let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(1.0);
            inner.push(text([left - 7.0, y + 4.0], words::number(tick, decimals), setting));
        }
        self.ticks(Axis::Y, inner, shapes);
    }

    /// Ticks below, with their values where `labelled`, and the line that carries them.
    pub(crate) fn columns(&self, n_wanted: usize, labelled: bool, shapes: &mut Vec<Shape>) {
        let [left, top, width, height] = self.area;
        let base = top + height;
        shapes.push(segment([left, base], [left + width, base], Look::line(Ink::Axis, 1.0)));
        let (ticks, decimals) = self.x.ticks(n_wanted);
        let mut inner = Vec::new();
        for tick in ticks {
            let [x, _] = self.point([tick, self.y.low]);
            inner.push(segment([x, base], [x, base + 4.0], Look::line(Ink::Axis, 1.0)));
            if labelled {
                let setting = TextStyle::plain(Ink::Muted, SMALL).anchored(0.5);
                inner.push(text([x, base + 17.0], self.x.label(tick, decimals), setting));
            }
        }
        self.ticks(Axis::X, inner, shapes);
    }

    /// A title above the frame at its left.
    pub(crate) fn title(&self, content: &str, shapes: &mut Vec<Shape>) {
        let [left, top, ..] = self.area;
        shapes.push(text([left, top - 9.0], content, TextStyle::plain(Ink::Text, LARGE).bold()));
    }

    /// The label of the horizontal axis.
    pub(crate) fn x_label(&self, content: &str, shapes: &mut Vec<Shape>) {
        let [left, top, width, height] = self.area;
        let setting = TextStyle::plain(Ink::Muted, MEDIUM).anchored(0.5);
        shapes.push(text([left + 0.5 * width, top + height + 36.0], content, setting));
    }

    /// The label of the vertical axis, reading upwards, `distance` left of the frame.
    pub(crate) fn y_label(&self, content: &str, distance: f64, shapes: &mut Vec<Shape>) {
        let [left, top, _, height] = self.area;
        let setting = TextStyle::plain(Ink::Muted, MEDIUM).anchored(0.5).upwards();
        shapes.push(text([left - distance, top + 0.5 * height], content, setting));
    }

    /// `shapes` behind the lines and the grid of this frame, cut at its edges.
    pub(crate) fn behind(&self, shapes: Vec<Shape>) -> Shape {
        Shape::Group { role: Role::Behind(self.area), clip: Some(self.area), shapes }
    }

    /// A pale band over the whole height between two horizontal values.
    pub(crate) fn band(&self, from: f64, to: f64, shapes: &mut Vec<Shape>) {
        let area = self.rectangle([from, self.y.low], [to, self.y.high]);
        shapes.push(rectangle(area, Look::fill(Ink::Band)));
    }

    /// What a pointer can read off this frame, with the units of its axes.
    pub(crate) fn readout(&self, units: [&str; 2]) -> Readout {
        Readout {
            frame: self.area,
            range: [self.x.low, self.x.high, self.y.low, self.y.high],
            logarithmic: [self.x.logarithmic, self.y.logarithmic],
            x_unit: units[0].to_owned(),
            y_unit: units[1].to_owned(),
            along: Axis::X,
            both: true,
            field: None,
        }
    }

    /// The lines of this frame as one group, cut at its edges, whose values can be read off.
    pub(crate) fn panel(&self, lines: Vec<Shape>, units: [&str; 2]) -> Shape {
        self.readout(units).group(0.0, lines)
    }

    /// Ticks along one side of this frame.
    pub(crate) fn ticks(&self, axis: Axis, ticks: Vec<Shape>, shapes: &mut Vec<Shape>) {
        shapes.push(Shape::Group { role: Role::Ticks(self.area, axis), clip: None, shapes: ticks });
    }
}

/// Colours and names in rows from (`left`, `base`) to the right; gives the height used. Entries for
/// single runs vanish with them when `role` is [`Role::Run`].
pub(crate) fn legend(
    [left, base]: [f64; 2],
    width: f64,
    role: fn(usize) -> Role,
    runs: &[(usize, &str)],
    shapes: &mut Vec<Shape>,
) -> f64 {
    const LINE: f64 = 20.0;
    let face = Face::new(false);
    let (mut x, mut y) = (left, base);
    for &(run, name) in runs {
        let length = 32.0 + face.width(name, MEDIUM) * 1.06 + 22.0;
        if x > left && x + length > left + width {
            (x, y) = (left, y + LINE);
        }
        let look = Look::line(Ink::Run(run), 3.0).dashed(super::colour::run_dash(run));
        let setting = TextStyle::plain(Ink::Text, MEDIUM);
        let sample = segment([x, y - 4.0], [x + 24.0, y - 4.0], look);
        let label = text([x + 32.0, y], name, setting);
        shapes.push(Shape::Group { role: role(run), clip: None, shapes: vec![sample, label] });
        x += length;
    }
    y - base + LINE
}

/// A power of ten, or a multiple of it by one digit, in words that a reader of axes knows.
fn power(value: f64) -> String {
    let exponent = (value.log10() + 1e-9).floor() as i32;
    let digit = (value / 10f64.powi(exponent)).round();
    if exponent >= -3 {
        words::number(value, usize::try_from(-exponent).unwrap_or(0))
    } else {
        format!("{digit}e−{}", -exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(Scale::linear(0.0, 10.0).ticks(5), (vec![0.0, 2.0, 4.0, 6.0, 8.0, 10.0], 0));
        let (ticks, decimals) = Scale::linear(0.31, 1.09).ticks(4);
        assert_eq!(decimals, 1);
        assert_eq!(ticks.len(), 4);
        assert!(ticks.iter().zip([0.4, 0.6, 0.8, 1.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        assert_eq!(Scale::linear(2.0, -2.0).ticks(4).0.len(), 5);
        let logarithmic = Scale { low: 1e-3, high: 10.0, logarithmic: true };
        assert_eq!(logarithmic.ticks(4).0.len(), 5);
        let of = [1e-5, 2e-4, 0.001, 0.05, 1.0, 200.0].map(power);
        assert_eq!(of, ["1e−5", "2e−4", "0.001", "0.05", "1", "200"]);
        let short = Scale { low: 1.5, high: 60.0, logarithmic: true };
        assert_eq!(short.ticks(4).0, [2.0, 5.0, 10.0, 20.0, 50.0]);
        assert!(Scale::linear(1.0, 1.0).ticks(4).0.is_empty());
    }

    #[test]
    fn a_frame_turns_values_over() {
        let frame = Frame {
            area: [10.0, 20.0, 100.0, 50.0],
            x: Scale::linear(2.0, -2.0),
            y: Scale { low: 0.1, high: 10.0, logarithmic: true },
        };
        assert_eq!(frame.point([2.0, 0.1]), [10.0, 70.0]);
        let middle = frame.point([0.0, 1.0]);
        assert!((middle[0] - 60.0).abs() < 1e-12 && (middle[1] - 45.0).abs() < 1e-12);
    }

    #[test]
    fn a_scale_is_never_empty() {
        for values in [vec![], vec![f64::NAN], vec![0.0, 0.0], vec![5.0]] {
            let scale = Scale::around(values, 0.1);
            assert!(scale.high > scale.low);
        }
    }
}
