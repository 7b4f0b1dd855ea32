//! How a lidar's scan crosses the wall: one reading that holds speeds, places and times of its points.
//!
//! A reading of n points is: measuring instants so far, share of points with a speed, then the n speeds, and
//! behind them the places downwind, to the left and upwards, and the times. A point without a speed, because
//! its beam was lost or it was never measured, is not a number; it is never zero.

/// Values before the points (–).
const N_HEAD: usize = 2;
/// Values of each point (–).
const N_OF_POINT: usize = 5;

/// A lidar's latest scan as a controller sees it.
///
/// Places are relative to the centre of the undeflected rotor, in level axes that turn with the nacelle:
/// downwind, to the left looking downwind, upwards.
///
/// ```
/// use basis::scan::{Scan, ScanBlocks};
/// let mut reading = vec![f64::NAN; Scan::n_values(2)];
/// let scan = ScanBlocks::of(&mut reading).expect("room for whole points");
/// scan.speeds.copy_from_slice(&[7.5, f64::NAN]);
/// let scan = Scan::of(&reading).expect("a whole scan");
/// assert_eq!((scan.n_points(), scan.n_valid()), (2, 1));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Scan<'a> {
    head: &'a [f64],
    points: &'a [f64],
}

impl<'a> Scan<'a> {
    /// Values of a reading of `n_points` points (–).
    pub const fn n_values(n_points: usize) -> usize {
        N_HEAD + N_OF_POINT * n_points
    }

    /// The scan in a sensor's `reading`; none where it is no scan.
    pub fn of(reading: &'a [f64]) -> Option<Self> {
        let is_whole =
            reading.len() > N_HEAD && (reading.len() - N_HEAD).is_multiple_of(N_OF_POINT);
        is_whole.then(|| {
            let (head, points) = reading.split_at(N_HEAD);
            Self { head, points }
        })
    }

    /// Points, measured or not (–).
    pub fn n_points(&self) -> usize {
        self.points.len() / N_OF_POINT
    }

    /// Points with a speed (–).
    pub fn n_valid(&self) -> usize {
        self.speeds().iter().filter(|speed| speed.is_finite()).count()
    }

    /// Instants at which it measured so far (–); a scan is new where this has changed.
    pub fn n_instants(&self) -> f64 {
        self.head[0]
    }

    /// Speeds along the lines of sight, away from the lidar (m/s); not a number where there is none.
    pub fn speeds(&self) -> &'a [f64] {
        self.block(0)
    }

    /// Places downwind of the rotor's centre (m).
    pub fn downwind(&self) -> &'a [f64] {
        self.block(1)
    }

    /// Places to the left of the rotor's centre, looking downwind (m).
    pub fn left(&self) -> &'a [f64] {
        self.block(2)
    }

    /// Places above the rotor's centre (m).
    pub fn up(&self) -> &'a [f64] {
        self.block(3)
    }

    /// When each point was measured last, since the start of the run (s).
    pub fn times(&self) -> &'a [f64] {
        self.block(4)
    }

    fn block(&self, index: usize) -> &'a [f64] {
        let n = self.n_points();
        &self.points[index * n..(index + 1) * n]
    }
}

/// What of a scan does not change: where its points are looked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScanLayout {
    /// Lines of sight (–), one for each point: downwind, left, up, unit vectors in the axes of what the lidar
    /// rides on.
    pub directions: Vec<[f64; 3]>,
    /// Distances along them (m), one for each point.
    pub ranges: Vec<f64>,
    /// Distances on each line (–); points go through all lines at the first, then at the next.
    pub n_ranges: usize,
    /// Measuring instants a second (Hz).
    pub rate: f64,
}

/// The same reading, to be written.
#[derive(Debug)]
pub struct ScanBlocks<'a> {
    /// Instants at which it measured so far (–), and the share of points that have a speed (–).
    pub head: &'a mut [f64],
    /// Speeds along the lines of sight, away from the lidar (m/s).
    pub speeds: &'a mut [f64],
    /// Places downwind, to the left and upwards of the rotor's centre (m).
    pub places: [&'a mut [f64]; 3],
    /// When each point was measured last (s).
    pub times: &'a mut [f64],
}

impl<'a> ScanBlocks<'a> {
    /// The blocks of a `reading`; none where it is no scan.
    pub fn of(reading: &'a mut [f64]) -> Option<Self> {
        let n = Scan::of(reading)?.n_points();
        let (head, rest) = reading.split_at_mut(N_HEAD);
        let (speeds, rest) = rest.split_at_mut(n);
        let (downwind, rest) = rest.split_at_mut(n);
        let (left, rest) = rest.split_at_mut(n);
        let (up, times) = rest.split_at_mut(n);
        Some(Self { head, speeds, places: [downwind, left, up], times })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_seen_in_its_place() {
        let mut reading = vec![0.0; Scan::n_values(3)];
        let blocks = ScanBlocks::of(&mut reading).expect("three points");
        blocks.head.copy_from_slice(&[4.0, 2.0 / 3.0]);
        blocks.speeds.copy_from_slice(&[6.0, f64::NAN, 7.0]);
        for (place, values) in blocks.places.into_iter().enumerate() {
            values.fill(10.0 + place as f64);
        }
        blocks.times.fill(99.0);
        let scan = Scan::of(&reading).expect("three points");
        assert_eq!((scan.n_points(), scan.n_valid(), scan.n_instants()), (3, 2, 4.0));
        assert_eq!(scan.downwind(), [10.0; 3]);
        assert_eq!(scan.left(), [11.0; 3]);
        assert_eq!(scan.up(), [12.0; 3]);
        assert_eq!(scan.times(), [99.0; 3]);
    }

    #[test]
    fn a_reading_of_another_sensor_is_no_scan() {
        for n_values in [0, 1, 2, 3, 6, 8, 13] {
            assert!(Scan::of(&vec![0.0; n_values]).is_none(), "{n_values}");
        }
    }
}
