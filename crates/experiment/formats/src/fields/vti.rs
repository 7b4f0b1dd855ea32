//! Fields as VTK image data (`.vti`), a file for each instant: raw appended numbers or text, not compressed.

use super::WHAT;
use super::netcdf::refusal;
use super::numbers::{Coding, Kind};
use super::placed::PlacedReader;
use super::tags::{attribute, content, numbers, tag};
use crate::{FileError, atomic};
use basis::records::Grid;
use std::fs;
use std::io::Read;
use std::ops::Range;
use std::path::{Path, PathBuf};

const FIX: &str = "write XML image data (.vti) with a vector `velocity`, appended as raw numbers or as text, without compression";

/// What begins the appended numbers.
const APPENDED: &[u8] = b"<AppendedData";
/// Bytes of a file in which its head is looked for.
const HEAD_BYTES: u64 = 1 << 16;

/// Files of one grid, an instant each.
pub(super) struct VtiFields {
    files: Vec<PathBuf>,
    grid: Grid,
    /// Where the numbers of each lie; none of text, and of heads that are longer than usual.
    places: Vec<Option<Place>>,
    reader: Option<PlacedReader>,
    /// Room for a piece of numbers, components of a point together.
    mixed: Vec<f32>,
}

/// Where raw numbers lie.
struct Place {
    /// The first (byte).
    at: u64,
    coding: Coding,
}

impl VtiFields {
    /// The file at `path`, or those in the folder that it is, which must have the same points; and their
    /// instants: all must tell their time, or none.
    pub(super) fn open(path: &Path) -> Result<(Self, Vec<Option<f64>>), FileError> {
        let files = files(path)?;
        let mut first: Option<Grid> = None;
        let (mut times, mut places) = (Vec::new(), Vec::new());
        for path in &files {
            let (own, time, place) = head(path)?;
            if own != *first.get_or_insert(own) {
                return Err(other_points(path));
            }
            times.push(time);
            places.push(place);
            if times[0].is_some() != time.is_some() {
                let problem = "of the files some tell their instant (`TimeValue`), some do not";
                return Err(FileError::content(WHAT, path, problem, "write it into all of them"));
            }
        }
        let grid = first.unwrap_or(Grid { origin: [0.0; 3], spacing: [1.0; 3], n_points: [0; 3] });
        Ok((Self { files, grid, places, reader: None, mixed: Vec::new() }, times))
    }

    pub(super) fn grid(&self) -> Grid {
        self.grid
    }

    /// Whether numbers are read where they lie.
    pub(super) fn reads_in_places(&self) -> bool {
        self.places.iter().all(Option::is_some)
    }

    /// On return `velocity` is that at `instant` at `points`.
    pub(super) fn read(
        &mut self,
        instant: usize,
        points: &Range<usize>,
        velocity: [&mut [f32]; 3],
    ) -> Result<(), FileError> {
        match self.places[instant] {
            Some(_) => self.read_raw(instant, points, velocity),
            None => self.read_whole(instant, points, velocity),
        }
    }

    /// The raw numbers of file number `index` at `points`, whose head was read.
    fn read_raw(
        &mut self,
        index: usize,
        points: &Range<usize>,
        velocity: [&mut [f32]; 3],
    ) -> Result<(), FileError> {
        let (path, mixed) = (&self.files[index], &mut self.mixed);
        let Some(Place { at, coding }) = &self.places[index] else { return Ok(()) };
        let of_point = 3 * coding.n_bytes();
        let mut n_read = 0;
        let mut take = |bytes: &[u8]| {
            let n_points = bytes.len() / of_point;
            mixed.resize(3 * n_points, 0.0);
            coding.decode(bytes, mixed);
            for (i, own) in mixed.as_chunks::<3>().0.iter().enumerate() {
                (0..3).for_each(|component| velocity[component][n_read + i] = own[component]);
            }
            n_read += n_points;
        };
        let opened = match &mut self.reader {
            Some(reader) => reader.turn_to(path).map(|()| reader),
            none => PlacedReader::open(path).map(|reader| none.insert(reader)),
        };
        let offset = at + (points.start * of_point) as u64;
        let read =
            opened.and_then(|reader| reader.read(offset, points.len() * of_point, &mut take));
        read.map_err(|error| refusal(path, error))
    }

    /// File number `index`, whatever it holds, at `points`.
    fn read_whole(
        &self,
        index: usize,
        points: &Range<usize>,
        velocity: [&mut [f32]; 3],
    ) -> Result<(), FileError> {
        let path = &self.files[index];
        let bytes = atomic::read_bytes(path, WHAT)?;
        let image = decode(&bytes);
        let image = image.map_err(|problem| FileError::content(WHAT, path, problem, FIX))?;
        if image.grid != self.grid {
            return Err(other_points(path));
        }
        for (component, values) in velocity.into_iter().enumerate() {
            let own = image.velocity[3 * points.start..].iter().skip(component).step_by(3);
            values.iter_mut().zip(own).for_each(|(value, own)| *value = *own);
        }
        Ok(())
    }
}

fn other_points(path: &Path) -> FileError {
    let problem = "its points are not those of the first file";
    FileError::content(WHAT, path, problem, "give files of one grid")
}

/// The files at `path`: itself, or the `.vti` in the folder that it is, by name.
fn files(path: &Path) -> Result<Vec<PathBuf>, FileError> {
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

/// Points and instant of the file at `path`, and where its numbers lie, from its beginning alone.
fn head(path: &Path) -> Result<(Grid, Option<f64>, Option<Place>), FileError> {
    let mut bytes = Vec::new();
    let read = atomic::open(path).and_then(|mut file| {
        (&mut file).take(HEAD_BYTES).read_to_end(&mut bytes)?;
        Ok(file.metadata()?.len())
    });
    let length = read.map_err(|error| FileError::system("read", WHAT, path, error))?;
    let text = text_before_data(&bytes);
    // Text that is cut in the middle of a letter is sound up to there.
    let text = match std::str::from_utf8(text) {
        Ok(text) => text,
        Err(error) => std::str::from_utf8(&text[..error.valid_up_to()]).unwrap_or_default(),
    };
    let refused = |problem| FileError::content(WHAT, path, problem, FIX);
    let (grid, time) = head_of(text).map_err(refused)?;
    // Room is made for the points before the numbers are read.
    n_values_of(&grid, usize::try_from(length).unwrap_or(usize::MAX)).map_err(refused)?;
    // What else is wrong with numbers is told when they are read.
    Ok((grid, time, place_of(text, &bytes[text.len()..], length)))
}

/// Where the raw numbers of a file of `length` bytes lie that begins with `head` and goes on with `rest`;
/// none where that does not tell, or the file is shorter.
fn place_of(head: &str, rest: &[u8], length: u64) -> Option<Place> {
    let array = velocity_array(head).ok()?;
    if attribute(array, "format") != Some("appended") {
        return None;
    }
    let n_values = n_values_of(&head_of(head).ok()?.0, usize::try_from(length).ok()?).ok()?;
    let file = tag(head, "VTKFile", |_| true)?;
    let (from, coding) = appended_from(file, array, rest, n_values).ok()?;
    let at = (head.len() + from) as u64;
    let end = at.checked_add((n_values as u64).checked_mul(coding.n_bytes() as u64)?)?;
    (end <= length).then_some(Place { at, coding })
}

/// What stands before the appended numbers.
fn text_before_data(bytes: &[u8]) -> &[u8] {
    let end = bytes.windows(APPENDED.len()).position(|window| window == APPENDED);
    &bytes[..end.unwrap_or(bytes.len())]
}

/// What a file holds.
struct Image {
    grid: Grid,
    /// Components of a point together.
    velocity: Vec<f32>,
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
    let n_values = n_values_of(&grid, bytes.len())?;
    let array = velocity_array(head)?;
    let velocity = match attribute(array, "format") {
        Some("ascii") => in_text(content(head, array).unwrap_or_default(), n_values)?,
        Some("appended") => {
            let (from, coding) = appended_from(file, array, rest, n_values)?;
            let to = n_values.checked_mul(coding.n_bytes()).and_then(|n| n.checked_add(from));
            let data = to.and_then(|to| rest.get(from..to)).ok_or("its numbers are cut short")?;
            let mut values = vec![0.0; n_values];
            coding.decode(data, &mut values);
            values
        }
        other => return Err(format!("`velocity` has the format {}", other.unwrap_or("none"))),
    };
    Ok(Image { grid, velocity })
}

/// Numbers of the velocity on `grid` in a file of `most` bytes.
fn n_values_of(grid: &Grid, most: usize) -> Result<usize, String> {
    let n_points = grid.n_points.into_iter().try_fold(1_usize, usize::checked_mul);
    let n_values = n_points.and_then(|n| n.checked_mul(3)).filter(|n| *n <= most);
    n_values.ok_or_else(|| "it has fewer numbers than its extent says".to_owned())
}

/// The tag of the velocity in `head`.
fn velocity_array(head: &str) -> Result<&str, String> {
    let array = tag(head, "DataArray", |tag| {
        attribute(tag, "Name").is_some_and(|name| name.eq_ignore_ascii_case("velocity"))
    });
    let array = array.ok_or("it lacks a `DataArray` called `velocity`")?;
    if attribute(array, "NumberOfComponents") != Some("3") {
        return Err("`velocity` does not have 3 components".to_owned());
    }
    Ok(array)
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

/// Where the `n_values` numbers of `array` begin in `rest`, which begins with `<AppendedData`.
fn appended_from(
    file: &str,
    array: &str,
    rest: &[u8],
    n_values: usize,
) -> Result<(usize, Coding), String> {
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
    let kind = match attribute(array, "type") {
        Some("Float32") => Kind::F32,
        Some("Float64") => Kind::F64,
        other => return Err(format!("`velocity` is of type {}", other.unwrap_or("none"))),
    };
    let coding = Coding::plain(kind, is_little);
    let from = mark.checked_add(offset).and_then(|from| from.checked_add(count_bytes));
    let count = from.and_then(|from| rest.get(from - count_bytes..from));
    let count = count.ok_or("its numbers are cut short")?;
    let place = |index: usize| if is_little { index } else { count_bytes - 1 - index };
    let n_bytes =
        (0..count_bytes).fold(0_u64, |sum, i| sum | u64::from(count[place(i)]) << (8 * i));
    if Some(n_bytes) != n_values.checked_mul(coding.n_bytes()).map(|n| n as u64) {
        return Err(format!("`velocity` has {n_bytes} bytes, not those of {n_values} numbers"));
    }
    let from = from.ok_or("its numbers are cut short")?;
    Ok((from, coding))
}
