//! A part of recorded planes: a window of time, on a rectangle that is laid anywhere in them.

use super::{InflowError, PlaneGrid, Planes};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What is taken of a record of planes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cut {
    /// Where in the record the first window begins (s).
    pub from: f64,
    /// Length of a window (s); to the record's end where there is none.
    pub duration: Option<f64>,
    /// Which of the windows that follow one another, from 1 (–).
    pub block: u64,
    /// Width of the rectangle (m); the record's where there is none.
    pub width: Option<f64>,
    /// Its height (m), half of it above the hub; the record's rows where there is none.
    pub height: Option<f64>,
    /// Distance of its points along y and z (m); the record's where there is none.
    pub spacing: Option<f64>,
    /// How far its middle lies to the left of the record's, looking downwind (m).
    pub shift: f64,
}

impl Default for Cut {
    /// All of the record.
    fn default() -> Self {
        let (duration, width, height, spacing) = (None, None, None, None);
        Self { from: 0.0, duration, block: 1, width, height, spacing, shift: 0.0 }
    }
}

/// Why a part cannot be taken of a record.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CutError {
    /// A window that goes on when the record is over.
    #[error(
        "block {block} goes from {begin:.1} to {end:.1} s, and the record ends at {length:.1} s: {fix}",
        fix = match fitting {
            0 => "take a shorter duration, or an earlier begin".to_owned(),
            1 => "only block 1 fits into it; take a shorter duration, or record longer".to_owned(),
            n => format!("blocks 1 to {n} fit into it; take one of them, a shorter duration, or record longer"),
        }
    )]
    Over {
        /// Number of the window, from 1 (–).
        block: u64,
        /// Its begin and its end (s).
        begin: f64,
        /// Its end (s).
        end: f64,
        /// Length of the record (s).
        length: f64,
        /// Windows that fit into the record (–).
        fitting: u64,
    },
    /// Windows that follow one another, of no length.
    #[error("block {block} is one of several, and nothing says how long they are: give a duration")]
    Endless {
        /// Number of the window, from 1 (–).
        block: u64,
    },
    /// A window that is shorter than the time between two planes.
    #[error(
        "{duration:.3} s are less than the {interval:.3} s between two planes: take a longer duration"
    )]
    Brief {
        /// Length of the window (s).
        duration: f64,
        /// Time between planes (s).
        interval: f64,
    },
    /// Points that stand closer than those of the record.
    #[error(
        "points {spacing} m apart are finer than those of the record, {of_record:.3} m along {axis}: take {of_record:.3} m or more, or record with a smaller spacing"
    )]
    Fine {
        /// Distance of points that is asked for (m).
        spacing: f64,
        /// That of the record (m).
        of_record: f64,
        /// Axis on which it is too small.
        axis: char,
    },
    /// A length that points of this distance do not fill.
    #[error(
        "{length} m are no whole number of spacings of {spacing:.3} m: take {below:.3} or {above:.3} m"
    )]
    Uneven {
        /// `width` or `height`.
        key: &'static str,
        /// What is asked for (m).
        length: f64,
        /// Distance of points (m).
        spacing: f64,
        /// The next length below that fits (m).
        below: f64,
        /// The next one above (m).
        above: f64,
    },
    /// A rectangle that leaves the record to the side.
    #[error("it takes y {low:.1} to {high:.1} m of the record, which holds {left:.1} to {right:.1} m: {fix}", low = across[0], high = across[1], left = held[0], right = held[1])]
    Aside {
        /// `width` or `shift`, whichever is to blame.
        key: &'static str,
        /// What the rectangle spans along y of the record (m).
        across: [f64; 2],
        /// What the record spans (m).
        held: [f64; 2],
        /// What would fit.
        fix: String,
    },
    /// A rectangle that rises above the record.
    #[error(
        "it takes heights up to {top:.1} m, and the record ends at {held:.1} m: with the hub at {hub_height:.1} m take a height of {most:.1} m at most, or record a higher slice"
    )]
    High {
        /// The rectangle's highest row (m).
        top: f64,
        /// That of the record (m).
        held: f64,
        /// Hub height (m).
        hub_height: f64,
        /// Greatest height that fits (m).
        most: f64,
    },
    /// A rectangle that reaches below the ground.
    #[error(
        "its lowest row would lie at {lowest:.1} m, at or below the ground: with the hub at {hub_height:.1} m take a height below {most:.1} m"
    )]
    Ground {
        /// The lowest row (m).
        lowest: f64,
        /// Hub height (m).
        hub_height: f64,
        /// The height that reaches the ground (m).
        most: f64,
    },
    /// A window in which the wind does not blow downwind.
    #[error(
        "the mean wind over the cut at hub height is {speed:.3} m/s, which carries no planes downwind: take another window or shift"
    )]
    Calm {
        /// Mean of u there (m/s).
        speed: f64,
    },
    /// Planes that cannot be had.
    #[error(transparent)]
    Planes(#[from] InflowError),
}

impl CutError {
    /// The part of [`Cut`] that is to blame; none where it is the record.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::Over { begin, length, block: 1, .. } if begin >= length => Some("from"),
            Self::Over { block: 1, .. } | Self::Brief { .. } => Some("duration"),
            Self::Over { .. } | Self::Endless { .. } => Some("block"),
            Self::Fine { .. } => Some("spacing"),
            Self::Uneven { key, .. } | Self::Aside { key, .. } => Some(key),
            Self::High { .. } | Self::Ground { .. } => Some("height"),
            Self::Calm { .. } => Some("from"),
            Self::Planes(_) => None,
        }
    }
}

/// A window of a record on points of one's own, bilinear between those of the record.
///
/// Planes are those of the record whose times lie in the window; the first is the first at or after its
/// begin. They do not repeat, whatever the record does. They are carried along with the mean wind at hub
/// height over the width of the cut: in the middle of a wake alone it is slower than what a rotor meets.
/// Below the record's lowest row the wind of that row blows. Temperature is left out.
pub struct CutPlanes {
    planes: Box<dyn Planes>,
    grid: PlaneGrid,
    /// Place of the first plane in the record.
    first: usize,
    columns: Axis,
    rows: Axis,
    /// Points of the record along y, and room for one of its planes.
    n_y: usize,
    plane: Vec<[f32; 3]>,
}

/// Points along one axis, among those of the record.
struct Axis {
    /// Place of the first (m).
    first: f64,
    /// Their distance (m).
    spacing: f64,
    /// The record's points before and after each, and the share of the latter.
    between: Vec<([usize; 2], f32)>,
}

impl CutPlanes {
    /// What `cut` takes of `planes` for a hub at `hub_height` (m); the window is read once for its mean wind.
    ///
    /// # Errors
    /// [`CutError`] says what of `cut` does not fit, and what would.
    pub fn new(planes: Box<dyn Planes>, cut: &Cut, hub_height: f64) -> Result<Self, CutError> {
        let record = planes.grid();
        record.check()?;
        let (first, n_steps) = window(&record, cut)?;
        let (columns, rows) = (columns(&record, cut)?, rows(&record, cut, hub_height)?);
        let n_y = columns.between.len();
        let grid = PlaneGrid {
            n_y,
            n_z: rows.between.len(),
            spacing: [columns.spacing, rows.spacing],
            first: [-0.5 * (n_y - 1) as f64 * columns.spacing, rows.first],
            n_steps,
            repeats: false,
            ..record
        };
        let plane = vec![[0.0; 3]; record.n_y * record.n_z];
        let mut found = Self { planes, grid, first, columns, rows, n_y: record.n_y, plane };
        found.grid.speed = found.mean_speed(&record, hub_height)?;
        Ok(found)
    }

    /// Mean of u (m/s) over the window and all columns at `height` (m).
    fn mean_speed(&mut self, record: &PlaneGrid, height: f64) -> Result<f64, CutError> {
        let row = between(record.n_z, record.first[1], record.spacing[1], height);
        let mut sum = 0.0;
        for step in 0..self.grid.n_steps {
            self.planes.read(self.first + step, &mut self.plane)?;
            let columns = self.columns.between.iter();
            sum += columns.map(|column| f64::from(self.at(*column, row)[0])).sum::<f64>();
        }
        let speed = sum / (self.grid.n_steps * self.grid.n_y) as f64;
        if speed > 0.0 { Ok(speed) } else { Err(CutError::Calm { speed }) }
    }

    /// Wind (m/s) of the record's plane that was read last, between two of its columns and two of its rows.
    #[inline]
    fn at(&self, (columns, left): ([usize; 2], f32), (rows, up): ([usize; 2], f32)) -> [f32; 3] {
        let [low, high] = rows.map(|row| {
            let [right, left_one] = columns.map(|column| self.plane[row * self.n_y + column]);
            mixed(right, left_one, left)
        });
        mixed(low, high, up)
    }
}

impl Planes for CutPlanes {
    fn grid(&self) -> PlaneGrid {
        self.grid
    }

    fn read(&mut self, step: usize, values: &mut [[f32; 3]]) -> Result<(), InflowError> {
        self.planes.read(self.first + step, &mut self.plane)?;
        for (row, values) in self.rows.between.iter().zip(values.chunks_mut(self.grid.n_y)) {
            for (column, value) in self.columns.between.iter().zip(values) {
                *value = self.at(*column, *row);
            }
        }
        Ok(())
    }
}

/// Share of a spacing or an interval by which files that hold single precision may miss what was meant (–).
const SLACK: f64 = 1e-2;

/// Place of the first plane of the window in the record of `grid`, and number of its planes.
fn window(grid: &PlaneGrid, cut: &Cut) -> Result<(usize, usize), CutError> {
    let (interval, last) = (grid.interval, grid.n_steps - 1);
    let length = last as f64 * interval;
    let block = cut.block.max(1);
    let duration = match cut.duration {
        Some(duration) => duration,
        None if block > 1 => return Err(CutError::Endless { block }),
        // From its end on there is nothing, which is told below.
        None => (length - cut.from).max(interval),
    };
    let begin = cut.from + (block - 1) as f64 * duration;
    let end = begin + duration;
    if end > length + SLACK * interval {
        let left = (length - cut.from).max(0.0) + SLACK * interval;
        let fitting = (left / duration).floor() as u64;
        return Err(CutError::Over { block, begin, end, length, fitting });
    }
    let first = (begin / interval - SLACK).ceil().max(0.0) as usize;
    let n_intervals = (duration / interval + SLACK).floor() as usize;
    let n_intervals = n_intervals.min(last.saturating_sub(first));
    if n_intervals == 0 {
        return Err(CutError::Brief { duration, interval });
    }
    Ok((first, n_intervals + 1))
}

/// Columns of `cut` among those of the record of `grid`.
fn columns(grid: &PlaneGrid, cut: &Cut) -> Result<Axis, CutError> {
    let [left, right] = grid.across();
    let spacing = spacing_of(cut, grid.spacing[0], 'y')?;
    let n = count("width", cut.width, right - left, spacing)?;
    let (width, middle) = ((n - 1) as f64 * spacing, 0.5 * (left + right));
    let across = [-0.5, 0.5].map(|half| middle + cut.shift + half * width);
    let slack = SLACK * grid.spacing[0];
    if across[0] < left - slack || across[1] > right + slack {
        let room = 0.5 * (right - left - width);
        let widest = (right - left - 2.0 * cut.shift.abs()).max(0.0);
        let (key, fix) = if room < 0.0 || cut.width.is_none() && cut.shift != 0.0 {
            (
                "width",
                format!(
                    "with this shift take a width of {widest:.1} m at most, or record a wider slice"
                ),
            )
        } else {
            (
                "shift",
                format!(
                    "with this width take a shift from {:.1} to {room:.1} m, or record a wider slice",
                    -room
                ),
            )
        };
        return Err(CutError::Aside { key, across, held: [left, right], fix });
    }
    Ok(axis(n, across[0], spacing, (grid.n_y, left, grid.spacing[0])))
}

/// Rows of `cut` among those of the record of `grid`, for a hub at `hub_height` (m).
fn rows(grid: &PlaneGrid, cut: &Cut, hub_height: f64) -> Result<Axis, CutError> {
    let [low, high] = grid.up();
    let spacing = spacing_of(cut, grid.spacing[1], 'z')?;
    let n = count("height", cut.height, high - low, spacing)?;
    let height = (n - 1) as f64 * spacing;
    // Without a height of its own it begins where the record does.
    let lowest = if cut.height.is_some() { hub_height - 0.5 * height } else { low };
    if cut.height.is_some() && lowest <= 0.0 {
        return Err(CutError::Ground { lowest, hub_height, most: 2.0 * hub_height });
    }
    let top = lowest + height;
    if top > high + SLACK * grid.spacing[1] {
        let most = (2.0 * (high - hub_height)).max(0.0);
        return Err(CutError::High { top, held: high, hub_height, most });
    }
    Ok(axis(n, lowest, spacing, (grid.n_z, low, grid.spacing[1])))
}

/// Distance of points (m) along `axis`, on which those of the record stand `of_record` (m) apart.
fn spacing_of(cut: &Cut, of_record: f64, axis: char) -> Result<f64, CutError> {
    match cut.spacing {
        Some(spacing) if spacing < (1.0 - SLACK) * of_record => {
            Err(CutError::Fine { spacing, of_record, axis })
        }
        Some(spacing) => Ok(spacing),
        None => Ok(of_record),
    }
}

/// Points `spacing` (m) apart over the `length` (m) under `key`, or over as much of `held` (m) as they fill.
fn count(
    key: &'static str,
    length: Option<f64>,
    held: f64,
    spacing: f64,
) -> Result<usize, CutError> {
    let Some(length) = length else { return Ok((held / spacing + SLACK).floor() as usize + 1) };
    let n = (length / spacing).round();
    if (length - n * spacing).abs() > SLACK * spacing {
        let [below, above] = [f64::floor, f64::ceil].map(|to| to(length / spacing) * spacing);
        return Err(CutError::Uneven { key, length, spacing, below, above });
    }
    Ok(n as usize + 1)
}

/// `n` points from `first` on (m), `spacing` (m) apart, among those of the record: their number, the place of
/// the first (m) and their distance (m).
fn axis(n: usize, first: f64, spacing: f64, (of, begin, apart): (usize, f64, f64)) -> Axis {
    let place = |index: usize| between(of, begin, apart, first + index as f64 * spacing);
    Axis { first, spacing, between: (0..n).map(place).collect() }
}

/// Points before and after `place` (m) of `n` from `first` on (m), `spacing` (m) apart, and the share of the
/// latter; beyond the ends the end alone.
fn between(n: usize, first: f64, spacing: f64, place: f64) -> ([usize; 2], f32) {
    let place = ((place - first) / spacing).clamp(0.0, (n - 1) as f64);
    let before = place.floor() as usize;
    ([before, (before + 1).min(n - 1)], place.fract() as f32)
}

fn mixed(a: [f32; 3], b: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|axis| a[axis] + share * (b[axis] - a[axis]))
}

#[cfg(test)]
#[path = "cut_tests.rs"]
mod tests;
