//! Figures as shapes, and the two ways to put them on a medium: SVG and pixels.

pub(crate) mod axes;
pub(crate) mod colour;
pub(crate) mod field;
pub(crate) mod font;
pub(crate) mod raster;
pub(crate) mod svg;
pub(crate) mod whisker;

use colour::Ink;
use field::Picture;

/// One drawing: shapes on a sheet, in units of a screen pixel, y downwards.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// Name of its files.
    pub(crate) name: String,
    /// What it shows, in a few words.
    pub(crate) title: String,
    /// What to look for, with the conditions.
    pub(crate) caption: String,
    /// Width of the sheet.
    pub(crate) width: f64,
    /// Height of the sheet.
    pub(crate) height: f64,
    /// The shapes, first at the back.
    pub(crate) shapes: Vec<Shape>,
}

/// One shape.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    /// Straight pieces through `points`.
    Path {
        /// The corners.
        points: Vec<[f64; 2]>,
        /// Whether the last point joins the first.
        closed: bool,
        /// How it looks.
        look: Look,
    },
    /// A full circle.
    Circle {
        /// Its centre.
        center: [f64; 2],
        /// Its radius.
        radius: f64,
        /// How it looks.
        look: Look,
    },
    /// One line of text.
    Text {
        /// Where it is anchored: on the base line.
        position: [f64; 2],
        /// What it says.
        content: String,
        /// How it is set.
        setting: TextStyle,
    },
    /// A coloured field that fills a rectangle.
    Field {
        /// Left, top, width, height.
        area: [f64; 4],
        /// The pixels.
        picture: Picture,
    },
    /// Shapes that belong together.
    Group {
        /// What they are.
        role: Role,
        /// Left, top, width, height outside which nothing is drawn.
        clip: Option<[f64; 4]>,
        /// The shapes.
        shapes: Vec<Shape>,
    },
}

/// What a group of shapes is to the page's script.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Role {
    /// Nothing in particular.
    Plain,
    /// All that a run draws, so that it can be hidden.
    Run(usize),
    /// What stands in one pair of axes, whose values can be read off and which can be enlarged.
    Panel(axes::Readout),
    /// What lies behind the panel in this frame (left, top, width, height), below its grid, and is enlarged
    /// with it.
    Behind([f64; 4]),
    /// The ticks along one side of the pair of axes in this frame (left, top, width, height), which others
    /// replace where it is enlarged.
    Ticks([f64; 4], Axis),
    /// A line of this name.
    Line(String),
    /// Something that tells this to a pointer on it.
    Mark(String),
    /// The bar that tells the colours of the fields of this drawing.
    Bar,
}

/// One of the two axes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    /// The horizontal one.
    X,
    /// The vertical one.
    Y,
}

/// How a shape looks.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Look {
    /// Colour of the inside.
    pub(crate) fill: Option<Ink>,
    /// Colour of the outline.
    pub(crate) stroke: Option<Ink>,
    /// Width of the outline.
    pub(crate) width: f64,
    /// Lengths of dash and gap.
    pub(crate) dash: Option<[f64; 2]>,
    /// Share of light that it holds back.
    pub(crate) opacity: f64,
    /// Whether the values of this line can be read off.
    pub(crate) readable: bool,
}

impl Look {
    /// A line of `width`.
    pub(crate) fn line(ink: Ink, width: f64) -> Self {
        Self { stroke: Some(ink), width, opacity: 1.0, ..Self::default() }
    }

    /// A filled shape.
    pub(crate) fn fill(ink: Ink) -> Self {
        Self { fill: Some(ink), opacity: 1.0, ..Self::default() }
    }

    /// The same with another opacity.
    pub(crate) fn opacity(self, opacity: f64) -> Self {
        Self { opacity, ..self }
    }

    /// The same, dashed when `dash` is given.
    pub(crate) fn dashed(self, dash: Option<[f64; 2]>) -> Self {
        Self { dash, ..self }
    }
}

/// How a text is set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextStyle {
    /// Its colour.
    pub(crate) ink: Ink,
    /// Size of the letters.
    pub(crate) size: f64,
    /// Whether it is bold.
    pub(crate) bold: bool,
    /// Where its anchor lies: 0 at its start, 0.5 in its middle, 1 at its end.
    pub(crate) anchor: f64,
    /// Whether it reads upwards.
    pub(crate) upwards: bool,
    /// Whether it has a pale halo, so that it can be read on a coloured field.
    pub(crate) halo: bool,
}

impl TextStyle {
    /// Plain text of `size`, anchored at its start.
    pub(crate) fn plain(ink: Ink, size: f64) -> Self {
        Self { ink, size, bold: false, anchor: 0.0, upwards: false, halo: false }
    }

    /// The same, bold.
    pub(crate) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// The same, anchored elsewhere.
    pub(crate) fn anchored(self, anchor: f64) -> Self {
        Self { anchor, ..self }
    }

    /// The same with a halo.
    pub(crate) fn on_field(self) -> Self {
        Self { halo: true, ..self }
    }

    /// The same, reading upwards.
    pub(crate) fn upwards(self) -> Self {
        Self { upwards: true, ..self }
    }
}

/// A straight line between two points.
pub(crate) fn segment(from: [f64; 2], to: [f64; 2], look: Look) -> Shape {
    Shape::Path { points: vec![from, to], closed: false, look }
}

/// A line through `points`.
pub(crate) fn polyline(points: Vec<[f64; 2]>, look: Look) -> Shape {
    Shape::Path { points, closed: false, look }
}

/// A rectangle: left, top, width, height.
pub(crate) fn rectangle([left, top, width, height]: [f64; 4], look: Look) -> Shape {
    let (right, bottom) = (left + width, top + height);
    let points = vec![[left, top], [right, top], [right, bottom], [left, bottom]];
    Shape::Path { points, closed: true, look }
}

/// A line of text.
pub(crate) fn text(position: [f64; 2], content: impl Into<String>, setting: TextStyle) -> Shape {
    Shape::Text { position, content: content.into(), setting }
}
