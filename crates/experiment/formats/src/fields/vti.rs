//! Fields as VTK image data (`.vti`), a file for each instant: raw appended numbers or text, not compressed.

use super::WHAT;
use crate::{FileError, atomic};
use basis::records::Grid;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

const FIX: &str = "write XML image data (.vti) with a vector `velocity`, appended as raw numbers or as text, without compression";

/// What begins the appended numbers.
const APPENDED: &[u8] = b"<AppendedData";
/// Bytes of a file in which its head is looked for.
const HEAD_BYTES: u64 = 1 << 16;

/// The files at `path`: itself, or the `.vti` in the folder that it is, by name.
pub(super) fn files(path: &Path) -> Result<Vec<PathBuf>, FileError> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let failed = |error| FileError::system("read", "the folder", path, error);
    let mut files = Vec::new();
    for entry in fs::read_dir(path).map_err(failed)? {
        let file = entry.map_err(failed)?.path();
        let name = file.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        if name.ends_with(".vti") {
            files.push(file);
        }
    }
    files.sort();
    if files.is_empty() {
        let fix = "name a folder of .vti, or a file";
        return Err(FileError::content(WHAT, path, "it holds no .vti", fix));
    }
    Ok(files)
}

/// Points and instants of `files`, which must have the same points, and all tell their time or none.
pub(super) fn heads(files: &[PathBuf]) -> Result<(Grid, Vec<Option<f64>>), FileError> {
    let mut first: Option<Grid> = None;
    let mut times = Vec::with_capacity(files.len());
    for path in files {
        let (own, time) = head(path)?;
        if own != *first.get_or_insert(own) {
            let problem = "its points are not those of the first file";
            return Err(FileError::content(WHAT, path, problem, "give files of one grid"));
        }
        times.push(time);
        if times[0].is_some() != time.is_some() {
            let problem = "of the files some tell their instant (`TimeValue`), some do not";
            return Err(FileError::content(WHAT, path, problem, "write it into all of them"));
        }
    }
    Ok((first.unwrap_or(Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [0; 3] }), times))
}

/// Points and instant of the file at `path`, from its beginning alone.
fn head(path: &Path) -> Result<(Grid, Option<f64>), FileError> {
    let mut bytes = Vec::new();
    let read = atomic::open(path).and_then(|file| file.take(HEAD_BYTES).read_to_end(&mut bytes));
    read.map_err(|error| FileError::system("read", WHAT, path, error))?;
    let text = text_before_data(&bytes);
    // Text that is cut in the middle of a letter is sound up to there.
    let text = match std::str::from_utf8(text) {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(&text[..error.valid_up_to()]).unwrap_or_default(),
    };
    head_of(text).map_err(|problem| FileError::content(WHAT, path, problem, FIX))
}

/// What stands before the appended numbers.
fn text_before_data(bytes: &[u8]) -> &[u8] {
    let end = bytes.windows(APPENDED.len()).position(|window| window == APPENDED);
    &bytes[..end.unwrap_or(bytes.len())]
}

/// On return `velocity` is that in the file at `path`, which must have the points of `grid`.
pub(super) fn read(
    path: &Path,
    grid: &Grid,
    velocity: &mut [Vec<f32>; 3],
) -> Result<(), FileError> {
    let image = Image::read(path)?;
    if image.grid != *grid {
        let problem = "its points are not those of the first file";
        return Err(FileError::content(WHAT, path, problem, "give files of one grid"));
    }
    for (component, values) in velocity.iter_mut().enumerate() {
        values.clear();
        values.extend(image.velocity.iter().skip(component).step_by(3));
    }
    Ok(())
}

/// What a file holds.
struct Image {
    grid: Grid,
    /// Components of a point together.
    velocity: Vec<f32>,
}

impl Image {
    fn read(path: &Path) -> Result<Self, FileError> {
        let bytes = atomic::read_bytes(path, WHAT)?;
        decode(&bytes).map_err(|problem| FileError::content(WHAT, path, problem, FIX))
    }
}

/// Points and instant that the `head` of a file tells.
fn head_of(head: &str) -> Result<(Grid, Option<f64>), String> {
    let file = tag(head, "VTKFile", |_| true).ok_or("it has no `VTKFile`")?;
    if attribute(file, "type") != Some("ImageData") {
        return Err("it is no `ImageData`".to_owned());
    }
    if attribute(file, "compressor").is_some() {
        return Err("its numbers are compressed".to_owned());
    }
    let image = tag(head, "ImageData", |_| true).ok_or("it has no `ImageData`")?;
    let extent: [i64; 6] = numbers(image, "WholeExtent")?;
    let mut grid = Grid {
        origin: numbers(image, "Origin")?,
        spacing: numbers(image, "Spacing")?,
        n_points: [1; 3],
    };
    for axis in 0..3 {
        let [low, high] = [extent[2 * axis], extent[2 * axis + 1]];
        let n = high.checked_sub(low).and_then(|n| usize::try_from(n).ok());
        grid.n_points[axis] = n.and_then(|n| n.checked_add(1)).ok_or("its extent is empty")?;
        let is_sound = grid.spacing[axis] > 0.0 && grid.spacing[axis].is_finite();
        if !is_sound || !grid.origin[axis].is_finite() {
            return Err("its `Origin` or `Spacing` is no sound number".to_owned());
        }
        grid.origin[axis] += low as f64 * grid.spacing[axis];
    }
    const UPRIGHT: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    if attribute(image, "Direction").is_some() && numbers::<f64, 9>(image, "Direction")? != UPRIGHT
    {
        return Err("its axes are turned (`Direction`)".to_owned());
    }
    let piece = tag(head, "Piece", |tag| attribute(tag, "Extent").is_some());
    if let Some(piece) = piece
        && numbers::<i64, 6>(piece, "Extent")? != extent
    {
        return Err("it is in pieces".to_owned());
    }
    Ok((grid, time_of(head)?))
}

/// The instant that the `head` of a file tells.
fn time_of(head: &str) -> Result<Option<f64>, String> {
    let Some(array) = tag(head, "DataArray", |tag| attribute(tag, "Name") == Some("TimeValue"))
    else {
        return Ok(None);
    };
    let text = content(head, array).map_or("", str::trim);
    let time = text.parse().ok().filter(|time: &f64| time.is_finite());
    time.map(Some).ok_or_else(|| format!("its `TimeValue` is `{text}`, no number in text"))
}

fn decode(bytes: &[u8]) -> Result<Image, String> {
    let (head, rest) = bytes.split_at(text_before_data(bytes).len());
    let head = std::str::from_utf8(head).map_err(|_| "its head is no text".to_owned())?;
    let (grid, _) = head_of(head)?;
    let file = tag(head, "VTKFile", |_| true).ok_or("it has no `VTKFile`")?;
    let n_points = grid.n_points.into_iter().try_fold(1_usize, usize::checked_mul);
    let n_values = n_points.and_then(|n| n.checked_mul(3)).filter(|n| *n <= bytes.len());
    let n_values = n_values.ok_or("it has fewer numbers than its extent says")?;
    let array = tag(head, "DataArray", |tag| {
        attribute(tag, "Name").is_some_and(|name| name.eq_ignore_ascii_case("velocity"))
    });
    let array = array.ok_or("it lacks a `DataArray` called `velocity`")?;
    if attribute(array, "NumberOfComponents") != Some("3") {
        return Err("`velocity` does not have 3 components".to_owned());
    }
    let velocity = match attribute(array, "format") {
        Some("ascii") => in_text(content(head, array).unwrap_or_default(), n_values)?,
        Some("appended") => appended(file, array, rest, n_values)?,
        other => return Err(format!("`velocity` has the format {}", other.unwrap_or("none"))),
    };
    Ok(Image { grid, velocity })
}

fn in_text(text: &str, n_values: usize) -> Result<Vec<f32>, String> {
    let values: Result<Vec<f32>, _> = text.split_ascii_whitespace().map(str::parse).collect();
    let values = values.map_err(|_| "a number of `velocity` is none".to_owned())?;
    if values.len() == n_values {
        Ok(values)
    } else {
        Err(format!("`velocity` has {} numbers, not {n_values}", values.len()))
    }
}

/// The numbers of `array` in `rest`, from `<AppendedData` on.
fn appended(file: &str, array: &str, rest: &[u8], n_values: usize) -> Result<Vec<f32>, String> {
    let start = rest.iter().position(|byte| *byte == b'>').map(|place| place + 1);
    let start = start.ok_or("it lacks the data that are appended")?;
    let opening = std::str::from_utf8(&rest[..start]).unwrap_or_default();
    if attribute(opening, "encoding") != Some("raw") {
        return Err("its appended numbers are not raw".to_owned());
    }
    let mark = rest[start..].iter().position(|byte| *byte == b'_');
    let mark = start + mark.ok_or("it lacks the mark `_` before its numbers")? + 1;
    let offset: usize =
        attribute(array, "offset").and_then(|offset| offset.parse().ok()).unwrap_or(0);
    let is_little = attribute(file, "byte_order") != Some("BigEndian");
    let count_bytes = if attribute(file, "header_type") == Some("UInt64") { 8 } else { 4 };
    let value_bytes = match attribute(array, "type") {
        Some("Float32") => 4,
        Some("Float64") => 8,
        other => return Err(format!("`velocity` is of type {}", other.unwrap_or("none"))),
    };
    let from = mark.checked_add(offset).and_then(|from| from.checked_add(count_bytes));
    let count = from.and_then(|from| rest.get(from - count_bytes..from));
    let count = count.ok_or("its numbers are cut short")?;
    let place = |index: usize| if is_little { index } else { count_bytes - 1 - index };
    let n_bytes =
        (0..count_bytes).fold(0_u64, |sum, i| sum | u64::from(count[place(i)]) << (8 * i));
    if Some(n_bytes) != n_values.checked_mul(value_bytes).map(|n| n as u64) {
        return Err(format!("`velocity` has {n_bytes} bytes, not those of {n_values} numbers"));
    }
    let to = from.and_then(|from| from.checked_add(n_values.checked_mul(value_bytes)?));
    let data = from.zip(to).and_then(|(from, to)| rest.get(from..to));
    let data = data.ok_or("its numbers are cut short")?;
    let value = |bytes: &[u8]| {
        let mut own = [0; 8];
        own[..value_bytes].copy_from_slice(bytes);
        if !is_little {
            own[..value_bytes].reverse();
        }
        match value_bytes {
            4 => f32::from_le_bytes([own[0], own[1], own[2], own[3]]),
            _ => f64::from_le_bytes(own) as f32,
        }
    };
    Ok(data.chunks_exact(value_bytes).map(value).collect())
}

/// The first tag called `name` of which `is_one` holds, without its brackets.
fn tag<'a>(text: &'a str, name: &str, is_one: impl Fn(&str) -> bool) -> Option<&'a str> {
    let mut rest = text;
    while let Some(place) = rest.find('<') {
        rest = &rest[place + 1..];
        let end = rest.find('>')?;
        let own = &rest[..end];
        let word = own.split(|c: char| c.is_whitespace() || c == '/').next();
        if word == Some(name) && is_one(own) {
            return Some(own);
        }
        rest = &rest[end..];
    }
    None
}

/// What stands between `tag`, a part of `text`, and the next one.
fn content<'a>(text: &'a str, tag: &str) -> Option<&'a str> {
    let from = tag.as_ptr() as usize - text.as_ptr() as usize + tag.len() + 1;
    let rest = text.get(from..)?;
    Some(&rest[..rest.find('<')?])
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let mut rest = tag;
    while let Some(place) = rest.find(name) {
        let before = rest[..place].chars().next_back();
        let after = &rest[place + name.len()..];
        if before.is_some_and(char::is_whitespace)
            && let Some(value) = after.trim_start().strip_prefix('=')
        {
            let value = value.trim_start();
            let quote = value.chars().next().filter(|c| ['"', '\''].contains(c))?;
            let value = &value[1..];
            return Some(&value[..value.find(quote)?]);
        }
        rest = after;
    }
    None
}

/// The numbers of the attribute `name` of `tag`.
fn numbers<T: std::str::FromStr, const N: usize>(tag: &str, name: &str) -> Result<[T; N], String> {
    let text = attribute(tag, name).ok_or_else(|| format!("it lacks `{name}`"))?;
    let values: Option<Vec<T>> =
        text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
    let values = values.and_then(|values| values.try_into().ok());
    values.ok_or_else(|| format!("`{name}` does not hold {N} numbers"))
}
