//! Headers of Bladed's full fields, old and new, and the summary beside them.

use super::{IMPROVED_VON_KARMAN, NEW, Outline, WHAT};
use crate::FileError;
use crate::atomic;
use std::io::Read;
use std::path::Path;

/// Bytes that the longest header takes, and some.
const LONGEST: u64 = 1024;
/// Greatest number of a summary that means something: heights in m, intensities in %.
const GREATEST: f64 = 1e5;

/// What a header says.
#[derive(Debug)]
pub(super) struct Header {
    pub n_y: usize,
    pub n_z: usize,
    pub n_steps: usize,
    /// Along x, y, z (m).
    pub spacing: [f64; 3],
    /// Mean speed (m/s).
    pub mean_speed: f64,
    /// Intensities of u, v, w (%), where it carries them.
    pub intensities: Option<[f64; 3]>,
    /// Height of the grid's middle (m), where it carries it.
    pub middle_height: Option<f64>,
    /// Byte of the first value.
    pub start: u64,
}

/// Numbers in the order in which they come.
struct Numbers<'a> {
    path: &'a Path,
    bytes: &'a [u8],
    place: usize,
}

impl Numbers<'_> {
    fn take<const N: usize>(&mut self, name: &str) -> Result<[u8; N], FileError> {
        let end = self.place + N;
        let taken = self.bytes.get(self.place..end).and_then(|bytes| bytes.try_into().ok());
        let Some(taken) = taken else {
            let found = self.bytes.len();
            let problem = format!("it ends after {found} bytes, within its header ({name})");
            return Err(FileError::content(WHAT, self.path, problem, "copy the file again"));
        };
        self.place = end;
        Ok(taken)
    }

    fn short(&mut self, name: &str) -> Result<i16, FileError> {
        self.take(name).map(i16::from_le_bytes)
    }

    fn long(&mut self, name: &str) -> Result<i32, FileError> {
        self.take(name).map(i32::from_le_bytes)
    }

    fn real(&mut self, name: &str) -> Result<f64, FileError> {
        self.take(name).map(|bytes| f64::from(f32::from_le_bytes(bytes)))
    }

    fn skip(&mut self, n_bytes: usize, name: &str) -> Result<(), FileError> {
        (0..n_bytes).try_for_each(|_| self.take::<1>(name).map(|_| ()))
    }

    fn wrong<T>(&self, problem: String, fix: &str) -> Result<T, FileError> {
        Err(FileError::content(WHAT, self.path, problem, fix))
    }
}

impl Header {
    /// # Errors
    /// [`FileError`] names what is wrong in the `found` bytes of the file at `path`.
    pub(super) fn read(path: &Path, file: &mut impl Read, found: u64) -> Result<Self, FileError> {
        let mut bytes = Vec::new();
        file.take(LONGEST)
            .read_to_end(&mut bytes)
            .map_err(|source| FileError::system("read", WHAT, path, source))?;
        let mut numbers = Numbers { path, bytes: &bytes, place: 0 };
        let identifier = numbers.short("identifier")?;
        let mut header = match identifier {
            NEW => Self::read_new(&mut numbers)?,
            -3 => Self::read_old(&mut numbers)?,
            -1 | -2 => {
                let problem = format!("byte 0: it has {} of three components", -identifier);
                return numbers.wrong(problem, "write the file with u, v and w");
            }
            _ => {
                let swapped = identifier.swap_bytes();
                if [NEW, -1, -2, -3].contains(&swapped) {
                    let problem = format!(
                        "byte 0: the identifier is {swapped} with its bytes swapped: the byte order is big-endian"
                    );
                    return numbers.wrong(problem, "write the file in little-endian order");
                }
                let problem = format!("byte 0: the identifier is {identifier}, not {NEW} or -3");
                return numbers.wrong(problem, "give a .wnd file of Bladed or TurbSim (WrBLFF = True); InflowWind's uniform wind of the same name is text");
            }
        };
        header.check(&numbers, found)?;
        Ok(header)
    }

    /// The header that starts with −99.
    fn read_new(numbers: &mut Numbers<'_>) -> Result<Self, FileError> {
        let kind = numbers.short("type of turbulence")?;
        let (mut intensities, mut middle_height, mut declared) = (None, None, None);
        let n_components = match kind {
            1 | 2 => 1,
            3 | 5 => 3,
            IMPROVED_VON_KARMAN => {
                let n_components = numbers.long("number of components")?;
                numbers.skip(8, "latitude and roughness")?;
                middle_height = Some(numbers.real("reference height")?);
                let mut three = [0.0; 3];
                for value in &mut three {
                    *value = numbers.real("intensity")?;
                }
                intensities = Some(three);
                n_components
            }
            7 | 8 => {
                declared = Some(numbers.long("length of the header")?);
                numbers.long("number of components")?
            }
            _ => {
                let problem =
                    format!("byte 2: the type of turbulence is {kind}, not one of 3, 4, 5, 7, 8");
                return numbers.wrong(problem, "convert it with the program that wrote it");
            }
        };
        if n_components != 3 {
            let problem = format!("it has {n_components} of three components");
            return numbers.wrong(problem, "write the file with u, v and w");
        }
        let mut spacing = [0.0; 3];
        for axis in [2, 1, 0] {
            spacing[axis] = numbers.real("spacing")?;
        }
        let half_steps = numbers.long("half the number of steps")?;
        let mean_speed = numbers.real("mean speed")?;
        numbers.skip(5 * 4, "length scales and seed")?;
        let n_z = numbers.long("points along z")?;
        let n_y = numbers.long("points along y")?;
        numbers.skip(6 * 4, "length scales")?;
        match kind {
            7 => numbers.skip(2 * 4, "coherence")?,
            8 => numbers.skip(16 * 4, "parameters of Mann's model")?,
            _ => {}
        }
        let mut start = numbers.place as u64;
        if let Some(declared) = declared.and_then(|bytes| u64::try_from(bytes).ok()) {
            // Later versions of Bladed have longer headers of these types, and say so.
            start = start.max(declared.min(LONGEST));
        }
        let count = |value: i32| usize::try_from(value).unwrap_or(0);
        Ok(Self {
            n_y: count(n_y),
            n_z: count(n_z),
            n_steps: count(half_steps).saturating_mul(2),
            spacing,
            mean_speed,
            intensities,
            middle_height,
            start,
        })
    }

    /// The header of 16-bit integers: lengths in mm, ten times the speed, a thousand times the points.
    fn read_old(numbers: &mut Numbers<'_>) -> Result<Self, FileError> {
        let mut spacing = [0.0; 3];
        for axis in [2, 1, 0] {
            spacing[axis] = 0.001 * f64::from(numbers.short("spacing")?);
        }
        let half_steps = numbers.short("half the number of steps")?;
        let mean_speed = 0.1 * f64::from(numbers.short("mean speed")?);
        numbers.skip(5 * 2, "length scales and seed")?;
        let n_z = numbers.short("points along z")? / 1000;
        let n_y = numbers.short("points along y")? / 1000;
        numbers.skip(6 * 2, "length scales")?;
        let count = |value: i16| usize::try_from(value).unwrap_or(0);
        Ok(Self {
            n_y: count(n_y),
            n_z: count(n_z),
            n_steps: 2 * count(half_steps),
            spacing,
            mean_speed,
            intensities: None,
            middle_height: None,
            start: numbers.place as u64,
        })
    }

    /// Makes sure that the numbers are a grid and fit the `found` bytes of the file; on return an odd last
    /// step counts.
    fn check(&mut self, numbers: &Numbers<'_>, found: u64) -> Result<(), FileError> {
        let again = "copy the file again or write it again";
        let counts = [self.n_y, self.n_z, self.n_steps];
        for (count, name) in counts.into_iter().zip(["points along y", "points along z", "steps"]) {
            if count == 0 {
                return numbers.wrong(format!("the header counts no {name}"), again);
            }
        }
        let lengths = [self.spacing[0], self.spacing[1], self.spacing[2], self.mean_speed];
        let names = ["spacing along x", "spacing along y", "spacing along z", "mean speed"];
        for (value, name) in lengths.into_iter().zip(names) {
            if !(value.is_finite() && value > 0.0) {
                return numbers.wrong(format!("the {name} is {value}"), again);
            }
        }
        let percents = self.intensities.unwrap_or_default();
        if !percents.iter().all(|percent| percent.is_finite() && *percent >= 0.0) {
            return numbers.wrong(format!("the intensities are {percents:?} %"), again);
        }
        if self.middle_height.is_some_and(|height| !height.is_finite()) {
            return numbers.wrong("the reference height is not a number".into(), again);
        }
        let per_step = 6 * self.n_y as u128 * self.n_z as u128;
        let needed = u128::from(self.start) + per_step * self.n_steps as u128;
        let found = u128::from(found);
        if found == needed + per_step {
            // The header can count even numbers only.
            self.n_steps += 1;
        } else if found != needed {
            let how = if found < needed {
                let step = found.saturating_sub(u128::from(self.start)) / per_step + 1;
                format!("it ends within step {step} of {}", self.n_steps)
            } else {
                "it goes on behind the last step".to_owned()
            };
            let problem = format!(
                "{found} bytes instead of {needed} for {} steps of {} × {} points: {how}",
                self.n_steps, self.n_y, self.n_z
            );
            return numbers.wrong(problem, again);
        }
        Ok(())
    }
}

/// What says in a summary of ours, in capitals, that the record ends. OpenFAST takes any line with the word
/// PERIODIC, negated or not, for a record that repeats.
const ONCE: &str = "DOES NOT REPEAT";

/// What a summary beside a file says; without one, what is taken for granted.
pub(super) struct Summary {
    /// Intensities of u, v, w (%).
    pub intensities: Option<[f64; 3]>,
    /// Hub height (m).
    pub hub_height: Option<f64>,
    /// How far the hub is above the grid's middle (m).
    pub height_offset: f64,
    /// Whether columns start at the left, looking downwind.
    pub from_left: bool,
    /// Whether the record repeats.
    pub repeats: bool,
}

impl Summary {
    /// # Errors
    /// [`FileError`] when there is one, but it cannot be read.
    pub(super) fn beside(path: &Path) -> Result<Self, FileError> {
        let mut summary = Self {
            intensities: None,
            hub_height: None,
            height_offset: 0.0,
            from_left: false,
            repeats: true,
        };
        let path = path.with_extension("sum");
        if !path.exists() {
            return Ok(summary);
        }
        let text = atomic::read_text(&path, super::SUMMARY)?;
        let mut intensities = [None; 3];
        let mut repeats = None;
        for (index, line) in text.lines().enumerate() {
            let upper = line.to_uppercase();
            let number = || number_in(&path, index + 1, line);
            for (component, name) in ["TI(U", "TI(V", "TI(W"].into_iter().enumerate() {
                if upper.contains(name) {
                    intensities[component] = number()?.filter(|percent| *percent >= 0.0);
                }
            }
            if upper.contains("CLOCKWISE") {
                summary.from_left = upper.trim_start().starts_with('T');
            } else if upper.contains("HUB HEIGHT") && summary.hub_height.is_none() {
                summary.hub_height = number()?;
            } else if upper.contains("HEIGHT OFFSET") {
                summary.height_offset = number()?.unwrap_or(0.0);
            } else if upper.contains(ONCE) {
                repeats = Some(false);
            } else if upper.contains("PERIODIC") {
                repeats = Some(!upper.contains("NON-PERIODIC") && !upper.contains("NOT PERIODIC"));
            }
        }
        if let [Some(u), Some(v), Some(w)] = intensities {
            summary.intensities = Some([u, v, w]);
        }
        summary.repeats = repeats.unwrap_or(true);
        Ok(summary)
    }
}

/// The number in a line of the summary at `path`: `value  name` in one part of it, `name = value` in another;
/// none where that is a word.
///
/// # Errors
/// [`FileError::Content`] for a number that is not finite, or beyond all that a summary tells of.
fn number_in(path: &Path, line: usize, text: &str) -> Result<Option<f64>, FileError> {
    let part = text.split_once('=').map_or(text, |(_, value)| value);
    let word = part.split_whitespace().next().unwrap_or_default();
    let Ok(number) = word.parse::<f64>() else { return Ok(None) };
    if number.abs() <= GREATEST {
        return Ok(Some(number));
    }
    let problem = format!("line {line}: {word} is no number from -{GREATEST} to {GREATEST}");
    Err(FileError::content(super::SUMMARY, path, problem, "correct the line, or take it away"))
}

/// The new header, type 4, of the box that `outline` is of, whose integers are scaled with `intensities` (%).
///
/// # Errors
/// [`FileError`] when the format cannot count the points.
pub(super) fn bytes(
    path: &Path,
    outline: &Outline,
    intensities: [f32; 3],
) -> Result<Vec<u8>, FileError> {
    let [n_x, n_y, n_z] = outline.n_points;
    let [spacing_x, spacing_y, spacing_z] = outline.spacing;
    let count = |n: usize| {
        i32::try_from(n).map_err(|_| {
            let problem = format!("{n} points are more than the format counts");
            FileError::content(WHAT, path, problem, "make the box shorter")
        })
    };
    let middle = outline.lowest_height + 0.5 * (n_z - 1) as f64 * spacing_z;
    let mut bytes = Vec::with_capacity(128);
    bytes.extend_from_slice(&NEW.to_le_bytes());
    bytes.extend_from_slice(&IMPROVED_VON_KARMAN.to_le_bytes());
    bytes.extend_from_slice(&3_i32.to_le_bytes());
    let reals = |bytes: &mut Vec<u8>, values: &[f64]| {
        for value in values {
            bytes.extend_from_slice(&(*value as f32).to_le_bytes());
        }
    };
    reals(&mut bytes, &[0.0, 0.0, middle]);
    reals(&mut bytes, &intensities.map(f64::from));
    reals(&mut bytes, &[spacing_z, spacing_y, spacing_x]);
    bytes.extend_from_slice(&count(n_x / 2)?.to_le_bytes());
    reals(&mut bytes, &[outline.hub_speed, 0.0, 0.0, 0.0]);
    for value in [0, 0, count(n_z)?, count(n_y)?] {
        bytes.extend_from_slice(&value.to_le_bytes());
    }
    reals(&mut bytes, &[0.0; 6]);
    Ok(bytes)
}

/// Text of the summary of the box that `outline` is of, whose integers are scaled with `intensities` (%).
pub(super) fn summary(outline: &Outline, intensities: [f32; 3]) -> String {
    let [_, n_y, n_z] = outline.n_points;
    let [_, spacing_y, spacing_z] = outline.spacing;
    let height = (n_z - 1) as f64 * spacing_z;
    let [u, v, w] = intensities;
    format!(
        "Summary of a full-field wind file: {}\n\n\
         \x20  F  Clockwise rotation when looking downwind (columns run from the right to the left)\n\
         \x20  {:.4}  Hub height [m]\n\
         \x20  {height:.4}  Grid height [m]\n\
         \x20  {:.4}  Grid width [m]\n\n\
         \x20  UBar  = {:.6} m/s\n\
         \x20  TI(u) = {u:.6} %\n\
         \x20  TI(v) = {v:.6} %\n\
         \x20  TI(w) = {w:.6} %\n\n\
         \x20  Height Offset = {:.4} m\n\
         \x20  Grid Base     = {:.4} m\n\n\
         {}\n",
        outline.description,
        outline.hub_height,
        (n_y - 1) as f64 * spacing_y,
        outline.hub_speed,
        outline.hub_height - outline.lowest_height - 0.5 * height,
        outline.lowest_height,
        if outline.repeats {
            "Creating a PERIODIC output file."
        } else {
            "The record does not repeat."
        },
    )
}
