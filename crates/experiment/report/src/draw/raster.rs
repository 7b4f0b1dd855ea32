//! Figures as pixels.

use super::colour::{self, Ink};
use super::font::Face;
use super::svg::HALO;
use super::{Figure, Look, Shape, TextStyle};
use tiny_skia::{
    Color, FillRule, FilterQuality, LineCap, LineJoin, Mask, Paint, Path, PathBuilder, Pixmap,
    PixmapPaint, PremultipliedColorU8, Rect, Stroke, StrokeDash, Transform,
};

/// Pixels for each unit of a figure.
const SCALE: f32 = 2.0;

/// The figure as a PNG file, two pixels for each of its units, on white.
pub(crate) fn png(figure: &Figure) -> Result<Vec<u8>, png::EncodingError> {
    let width = (figure.width as f32 * SCALE).ceil().max(1.0) as u32;
    let height = (figure.height as f32 * SCALE).ceil().max(1.0) as u32;
    let mut pixels = Vec::new();
    if let Some(mut sheet) = Pixmap::new(width, height) {
        let [red, green, blue] = Ink::Paper.rgb(false);
        sheet.fill(Color::from_rgba8(red, green, blue, 255));
        let mut painter = Painter { sheet, faces: [Face::new(false), Face::new(true)], mask: None };
        for shape in &figure.shapes {
            painter.shape(shape);
        }
        // The sheet is opaque: colours are not premultiplied by anything.
        pixels = painter
            .sheet
            .pixels()
            .iter()
            .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
            .collect();
    }
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels)?;
    writer.finish()?;
    Ok(bytes)
}

struct Painter {
    sheet: Pixmap,
    faces: [Face; 2],
    mask: Option<Mask>,
}

impl Painter {
    fn shape(&mut self, shape: &Shape) {
        match shape {
            Shape::Path { points, closed, look } => {
                let mut builder = PathBuilder::new();
                for (index, [x, y]) in points.iter().enumerate() {
                    if index == 0 {
                        builder.move_to(*x as f32, *y as f32);
                    } else {
                        builder.line_to(*x as f32, *y as f32);
                    }
                }
                if *closed {
                    builder.close();
                }
                self.path(builder.finish(), look);
            }
            Shape::Circle { center, radius, look } => {
                let [x, y] = center.map(|value| value as f32);
                self.path(PathBuilder::from_circle(x, y, *radius as f32), look);
            }
            Shape::Text { position, content, setting } => self.text(*position, content, setting),
            Shape::Field { area, picture } => {
                let colours = colour::palette(picture.map);
                let Some(mut pixmap) = Pixmap::new(picture.width as u32, picture.height as u32)
                else {
                    return;
                };
                for (pixel, &index) in pixmap.pixels_mut().iter_mut().zip(&picture.indices) {
                    let [red, green, blue] = colours[usize::from(index)];
                    *pixel = PremultipliedColorU8::from_rgba(red, green, blue, 255)
                        .unwrap_or(PremultipliedColorU8::TRANSPARENT);
                }
                let [left, top, width, height] = area.map(|value| value as f32);
                let fit = Transform::from_row(
                    width / picture.width as f32,
                    0.0,
                    0.0,
                    height / picture.height as f32,
                    left,
                    top,
                )
                .post_scale(SCALE, SCALE);
                let paint = PixmapPaint { quality: FilterQuality::Bilinear, ..Default::default() };
                self.sheet.draw_pixmap(0, 0, pixmap.as_ref(), &paint, fit, self.mask.as_ref());
            }
            Shape::Group { clip, shapes, .. } => {
                let outer = clip.map(|area| self.clip(area));
                for shape in shapes {
                    self.shape(shape);
                }
                if let Some(outer) = outer {
                    self.mask = outer;
                }
            }
        }
    }

    /// Keeps what follows inside `area` and gives back the mask that held before.
    fn clip(&mut self, [left, top, width, height]: [f64; 4]) -> Option<Mask> {
        let outer = self.mask.clone();
        let area = Rect::from_xywh(left as f32, top as f32, width as f32, height as f32);
        if let Some(area) = area {
            let path = PathBuilder::from_rect(area);
            let transform = Transform::from_scale(SCALE, SCALE);
            if let Some(mask) = &mut self.mask {
                mask.intersect_path(&path, FillRule::Winding, true, transform);
            } else if let Some(mut mask) = Mask::new(self.sheet.width(), self.sheet.height()) {
                mask.fill_path(&path, FillRule::Winding, true, transform);
                self.mask = Some(mask);
            }
        }
        outer
    }

    fn path(&mut self, path: Option<Path>, look: &Look) {
        let Some(path) = path else { return };
        let transform = Transform::from_scale(SCALE, SCALE);
        if let Some(ink) = look.fill {
            let paint = paint(ink, look.opacity);
            let mask = self.mask.as_ref();
            self.sheet.fill_path(&path, &paint, FillRule::Winding, transform, mask);
        }
        if let Some(ink) = look.stroke {
            let stroke = Stroke {
                width: look.width as f32,
                line_cap: LineCap::Butt,
                line_join: LineJoin::Round,
                dash: look
                    .dash
                    .and_then(|dash| StrokeDash::new(dash.map(|d| d as f32).to_vec(), 0.0)),
                ..Stroke::default()
            };
            let paint = paint(ink, look.opacity);
            self.sheet.stroke_path(&path, &paint, &stroke, transform, self.mask.as_ref());
        }
    }

    fn text(&mut self, [x, y]: [f64; 2], content: &str, setting: &TextStyle) {
        let face = &self.faces[usize::from(setting.bold)];
        let start = -setting.anchor * face.width(content, setting.size);
        let mut pen = Pen { builder: PathBuilder::new(), start: 0.0 };
        face.outlines(content, setting.size, &mut pen, |pen, start| pen.start = start);
        let Some(path) = pen.builder.finish() else { return };
        let turn = if setting.upwards { -90.0 } else { 0.0 };
        let transform = Transform::from_translate(start as f32, 0.0)
            .post_concat(Transform::from_rotate(turn))
            .post_translate(x as f32, y as f32)
            .post_scale(SCALE, SCALE);
        if setting.halo {
            let stroke =
                Stroke { width: HALO as f32, line_join: LineJoin::Round, ..Stroke::default() };
            let paint = paint(Ink::FieldHalo, 1.0);
            self.sheet.stroke_path(&path, &paint, &stroke, transform, self.mask.as_ref());
        }
        let paint = paint(setting.ink, 1.0);
        self.sheet.fill_path(&path, &paint, FillRule::Winding, transform, self.mask.as_ref());
    }
}

fn paint(ink: Ink, opacity: f64) -> Paint<'static> {
    let [red, green, blue] = ink.rgb(false);
    let mut paint = Paint { anti_alias: true, ..Paint::default() };
    paint.set_color_rgba8(red, green, blue, (255.0 * opacity).round() as u8);
    paint
}

/// Turns the outlines of letters, y upwards, into one path, y downwards.
struct Pen {
    builder: PathBuilder,
    start: f32,
}

impl ttf_parser::OutlineBuilder for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.builder.move_to(self.start + x, -y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.builder.line_to(self.start + x, -y);
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.builder.quad_to(self.start + cx, -cy, self.start + x, -y);
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let start = self.start;
        self.builder.cubic_to(start + cx0, -cy0, start + cx1, -cy1, start + x, -y);
    }

    fn close(&mut self) {
        self.builder.close();
    }
}
