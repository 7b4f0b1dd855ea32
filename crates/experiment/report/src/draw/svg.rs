//! Figures as SVG: readable text, inks as classes, so that a page's style sheet may recolour them.

use super::axes::Readout;
use super::colour::{Ink, hex};
use super::field::base64;
use super::{Axis, Figure, Look, Role, Shape, TextStyle};
use std::fmt::Write;

/// The figure as a file of its own.
pub(crate) fn document(figure: &Figure) -> Result<Vec<u8>, png::EncodingError> {
    Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\n", inline(figure)?).into_bytes())
}

/// The figure as an element of a page.
pub(crate) fn inline(figure: &Figure) -> Result<String, png::EncodingError> {
    let mut text = String::new();
    let (width, height) = (short(figure.width), short(figure.height));
    let _ = write!(
        text,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         width=\"{width}\" height=\"{height}\" role=\"img\" aria-label=\"{}\" \
         font-family=\"system-ui, 'Noto Sans', 'Segoe UI', sans-serif\">\
         <rect width=\"{width}\" height=\"{height}\" {}/>",
        escaped(&figure.title),
        fill(Some(Ink::Paper)),
    );
    let mut writer = Writer { text, name: &figure.name, n_clips: 0 };
    for shape in &figure.shapes {
        writer.shape(shape)?;
    }
    writer.text.push_str("</svg>");
    Ok(writer.text)
}

/// Width of the halo of a text.
pub(crate) const HALO: f64 = 3.0;

struct Writer<'a> {
    text: String,
    name: &'a str,
    n_clips: usize,
}

impl Writer<'_> {
    fn shape(&mut self, shape: &Shape) -> Result<(), png::EncodingError> {
        match shape {
            Shape::Path { points, closed, look } => self.path(points, *closed, look),
            Shape::Circle { center, radius, look } => {
                let _ = write!(
                    self.text,
                    "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>",
                    short(center[0]),
                    short(center[1]),
                    short(*radius),
                    looks(look)
                );
            }
            Shape::Text { position, content, setting } => self.line(*position, content, setting),
            Shape::Field { area: [left, top, width, height], picture } => {
                let _ = write!(
                    self.text,
                    "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" \
                     preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/>",
                    short(*left),
                    short(*top),
                    short(*width),
                    short(*height),
                    base64(&picture.to_png()?)
                );
            }
            Shape::Group { role, clip, shapes } => self.group(role, *clip, shapes)?,
        }
        Ok(())
    }

    fn path(&mut self, points: &[[f64; 2]], closed: bool, look: &Look) {
        self.text.push_str("<path d=\"");
        for (index, [x, y]) in points.iter().enumerate() {
            let letter = if index == 0 { 'M' } else { 'L' };
            let _ = write!(self.text, "{letter}{} {}", short(*x), short(*y));
        }
        let _ = write!(self.text, "{}\" {}/>", if closed { "Z" } else { "" }, looks(look));
    }

    fn line(&mut self, [x, y]: [f64; 2], content: &str, setting: &TextStyle) {
        let anchor = match setting.anchor {
            a if a < 0.25 => "",
            a if a < 0.75 => " text-anchor=\"middle\"",
            _ => " text-anchor=\"end\"",
        };
        let (x, y) = (short(x), short(y));
        let turn = match setting.upwards {
            true => format!(" transform=\"rotate(-90 {x} {y})\""),
            false => String::new(),
        };
        let look = Look { fill: Some(setting.ink), opacity: 1.0, ..Look::default() };
        let (look, halo) = match setting.halo {
            true => {
                let halo = Look { stroke: Some(Ink::FieldHalo), width: HALO, ..look };
                (halo, " paint-order=\"stroke\"")
            }
            false => (look, ""),
        };
        let _ = write!(
            self.text,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\"{anchor}{}{turn}{halo} {}>{}</text>",
            short(setting.size),
            if setting.bold { " font-weight=\"600\"" } else { "" },
            looks(&look),
            escaped(content)
        );
    }

    fn group(
        &mut self,
        role: &Role,
        clip: Option<[f64; 4]>,
        shapes: &[Shape],
    ) -> Result<(), png::EncodingError> {
        let mut attributes = match role {
            Role::Plain => String::new(),
            Role::Run(run) => format!(" data-run=\"{run}\""),
            Role::Panel(readout) => of_panel(readout),
            Role::Behind(frame) => format!(" data-behind=\"{}\"", numbers(frame)),
            Role::Ticks(frame, axis) => {
                let axis = if *axis == Axis::X { "x" } else { "y" };
                format!(" data-ticks=\"{axis}\" data-frame=\"{}\"", numbers(frame))
            }
            Role::Line(name) => format!(" data-line=\"{}\"", escaped(name)),
            Role::Mark(words) => format!(" data-mark=\"{}\"", escaped(words)),
            Role::Bar => " data-bar=\"\"".to_owned(),
        };
        if let Some([left, top, width, height]) = clip {
            self.n_clips += 1;
            let id = format!("{}-clip-{}", self.name, self.n_clips);
            let _ = write!(
                self.text,
                "<clipPath id=\"{id}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>",
                short(left),
                short(top),
                short(width),
                short(height)
            );
            let _ = write!(attributes, " clip-path=\"url(#{id})\"");
        }
        // What is enlarged lies inside what cuts it.
        let (open, close) = match role {
            Role::Panel(_) | Role::Behind(_) => ("<g class=\"zoom\">", "</g></g>"),
            _ => ("", "</g>"),
        };
        let _ = write!(self.text, "<g{attributes}>{open}");
        for shape in shapes {
            self.shape(shape)?;
        }
        self.text.push_str(close);
        Ok(())
    }
}

/// What the page's script must know of a pair of axes.
fn of_panel(readout: &Readout) -> String {
    let mut text = format!(
        " data-panel=\"{} {}\" data-log=\"{} {}\" data-x=\"{}\" data-y=\"{}\" data-along=\"{}\" data-zoom=\"{}\"",
        numbers(&readout.frame),
        numbers(&readout.range),
        u8::from(readout.logarithmic[0]),
        u8::from(readout.logarithmic[1]),
        escaped(&readout.x_unit),
        escaped(&readout.y_unit),
        if readout.along == Axis::X { "x" } else { "y" },
        if readout.both { "xy" } else { "x" },
    );
    if let Some(field) = &readout.field {
        let _ = write!(
            text,
            " data-field=\"{}\" data-unit=\"{}\" data-name=\"{}\" data-colour=\"{}\"",
            numbers(&field.range),
            escaped(&field.unit),
            escaped(&field.name),
            field.run
        );
    }
    text
}

/// Numbers for the script, precise enough to tell frames apart and values to four digits.
fn numbers(values: &[f64]) -> String {
    let each: Vec<String> = values.iter().map(|value| format!("{value:.6}")).collect();
    each.join(" ")
}

/// Attributes of a look; the class lets a style sheet overrule the colour.
fn looks(look: &Look) -> String {
    let mut classes = Vec::new();
    let mut text = String::new();
    match look.fill {
        Some(ink) => {
            classes.push(format!("f-{}", ink.name()));
            let _ = write!(text, " fill=\"{}\"", hex(ink.rgb(false)));
        }
        None => text.push_str(" fill=\"none\""),
    }
    if let Some(ink) = look.stroke {
        classes.push(format!("s-{}", ink.name()));
        let _ = write!(text, " stroke=\"{}\"", hex(ink.rgb(false)));
        let _ = write!(text, " stroke-width=\"{}\" stroke-linejoin=\"round\"", short(look.width));
    }
    if let Some([dash, gap]) = look.dash {
        let _ = write!(text, " stroke-dasharray=\"{} {}\"", short(dash), short(gap));
    }
    if look.opacity < 1.0 {
        let _ = write!(text, " opacity=\"{}\"", short(look.opacity));
    }
    if look.readable {
        classes.push("line".to_owned());
    }
    format!("class=\"{}\"{text}", classes.join(" "))
}

/// Attributes of a filled shape without an outline.
fn fill(ink: Option<Ink>) -> String {
    looks(&Look { fill: ink, opacity: 1.0, ..Look::default() })
}

/// A coordinate with at most two digits after the point.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// `text` with the characters that XML reserves replaced.
fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            control if control.is_control() => safe.push(' '),
            other => safe.push(other),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_text_is_safe() {
        assert_eq!(short(12.0), "12");
        assert_eq!(short(-0.001), "0");
        assert_eq!(short(1.256), "1.26");
        assert_eq!(escaped("a<b & \"c\""), "a&lt;b &amp; &quot;c&quot;");
    }
}
