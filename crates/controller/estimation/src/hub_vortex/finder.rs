//! Where the hub vortex is in one scan.

use super::background::Background;
use super::jet;
use super::point::{Point, median};
use basis::scan::Scan;

/// How the hub vortex is found among the points of a scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The source's: the mean place of the points that are faster along their lines of sight than a
    /// threshold.
    ///
    /// The source does not say how its threshold is set. Here it lies `threshold` (–) of the way from the
    /// median of the points in the region to the fastest of them, so that it follows the wind; 0 would take
    /// half of all points, 1 none. With 0.6 and a region of 0.6 rotor radii a jet that circles at 0.15 to
    /// 0.25 radii over wakes of several shapes is seen at its radius within a fifth; of smaller circles 80
    /// points are too coarse a picture.
    FastRegion {
        /// Share of the way from the median to the fastest (–).
        threshold: f64,
    },
    /// A Gaussian jet, fitted together with the wind around it: shear, and the wake's bowl to the fourth
    /// power of the radius. It is looked for from the centroid of what is faster than a first background,
    /// within a Gaussian window that moves to where the centroid is (mean shift: Comaniciu, Meer, IEEE Trans.
    /// Pattern Anal. Mach. Intell. 24, 2002). Speeds are taken for the cosine of an axial wind.
    Jet {
        /// Standard deviation that it is looked for with (m); it may have 0.4 to 1.75 of that.
        width: f64,
    },
    /// Centroid of the wind over the points, less that of the points: what moves it is the fast side of the
    /// whole wake, hub vortex and all. Of a wake that a helix displaces it grows with the amplitude where the
    /// place of a jet does not: beyond some degrees wind from outside passes near the axis on one side. It is
    /// a measure of the displacement, smaller than that itself, and wind that varies over the disc by
    /// itself (shear, eddies) moves it too. Speeds are taken for the cosine of an axial wind: wind across the
    /// beams adds to it. It wants the whole disc: a side without points hides a side of the wake.
    Centroid,
}

/// Points that are looked at, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Search {
    /// How the hub vortex is found.
    pub method: Method,
    /// Points further than this from the rotor's axis are passed over (m): beyond the wake the wind is
    /// faster than any vortex.
    pub radius: f64,
    /// Points nearer and further downwind are passed over (m), negative upwind: one range of many.
    pub distances: [f64; 2],
}

/// The hub vortex in one scan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Found {
    /// Place: to the left looking downwind, and up, from the rotor's centre (m).
    pub(super) place: [f64; 2],
    /// When its points were measured, on average (s).
    pub(super) time: f64,
    /// How sure it is (–), from 0 to 1.
    pub(super) confidence: f64,
}

/// Finds the hub vortex, with working memory for a scan.
#[derive(Clone, Debug)]
pub(super) struct Finder {
    search: Search,
    points: Vec<Point>,
    scratch: Vec<f64>,
    speeds: Vec<f64>,
    background: Background,
}

/// Fewest points that tell a place (–).
const FEWEST: usize = 8;
/// Points at which the window may start (–): the fastest.
const N_STARTS: usize = 8;
/// Steps of the window (–).
const N_STEPS: usize = 12;
/// A step of the window that is its last, in parts of its width (–).
const NEAR: f64 = 0.01;
/// Error of the place that is as sure as not, in parts of the width (–).
const EVEN: f64 = 0.5;

impl Finder {
    /// A finder with memory for `n_points`.
    pub(super) fn new(search: Search, n_points: usize) -> Self {
        let numbers = || Vec::with_capacity(n_points);
        Self {
            search,
            points: Vec::with_capacity(n_points),
            scratch: numbers(),
            speeds: numbers(),
            background: Background::with_capacity(n_points),
        }
    }

    /// The hub vortex in `scan`; none where too few points have a speed, or none stands out.
    pub(super) fn find(&mut self, scan: &Scan) -> Option<Found> {
        let n_there = self.gather(scan);
        if self.points.len() < FEWEST {
            return None;
        }
        let coverage = self.points.len() as f64 / n_there as f64;
        let found = match self.search.method {
            Method::FastRegion { threshold } => self.fast_region(threshold),
            Method::Jet { width } => self.jet(width),
            Method::Centroid => self.centroid(),
        };
        found.map(|found| Found { confidence: coverage * found.confidence, ..found })
    }

    /// On return the points are those of `scan` that count and have a speed; gives how many count.
    fn gather(&mut self, scan: &Scan) -> usize {
        let Search { method, radius, distances: [nearest, furthest] } = self.search;
        let is_axial = !matches!(method, Method::FastRegion { .. });
        self.points.clear();
        let mut n_there = 0;
        let places = scan.downwind().iter().zip(scan.left()).zip(scan.up());
        let values = scan.speeds().iter().zip(scan.times());
        for (((x, y), z), (speed, time)) in places.zip(values) {
            // A point without a place was not measured yet; it is missed all the same.
            let is_near = y.hypot(*z) <= radius && (nearest..=furthest).contains(x);
            n_there += usize::from(is_near || x.is_nan());
            if is_near && speed.is_finite() && self.points.len() < self.points.capacity() {
                // The wind blows along the axis by and large: the beam sees its cosine.
                let cosine = if is_axial { x / (x * x + y * y + z * z).sqrt() } else { 1.0 };
                self.points.push(Point { place: [*y, *z], speed: speed / cosine, time: *time });
            }
        }
        n_there
    }

    fn fast_region(&mut self, threshold: f64) -> Option<Found> {
        self.scratch.clear();
        self.scratch.extend(self.points.iter().map(|point| point.speed));
        let median = median(&mut self.scratch);
        let fastest = self.scratch.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let bound = median + threshold * (fastest - median);
        let (mut place, mut time, mut n) = ([0.0; 2], 0.0, 0.0);
        for point in self.points.iter().filter(|point| point.speed > bound) {
            place[0] += point.place[0];
            place[1] += point.place[1];
            time += point.time;
            n += 1.0;
        }
        // All alike: nothing stands out.
        (n > 0.0).then(|| Found {
            place: place.map(|sum| sum / n),
            time: time / n,
            confidence: 1.0,
        })
    }

    fn centroid(&self) -> Option<Found> {
        let n = self.points.len() as f64;
        let mean = |of: fn(&Point) -> f64| self.points.iter().map(of).sum::<f64>() / n;
        let middle = [mean(|point| point.place[0]), mean(|point| point.place[1])];
        let (speed, time) = (mean(|point| point.speed), mean(|point| point.time));
        // Less the points' own middle: points that are lost have one, and even wind has no displacement.
        let mut place = [0.0; 2];
        for point in &self.points {
            for axis in 0..2 {
                place[axis] += (point.speed - speed) * (point.place[axis] - middle[axis]);
            }
        }
        (speed > 0.0).then(|| Found {
            place: place.map(|sum| sum / (n * speed)),
            time,
            confidence: 1.0,
        })
    }

    fn jet(&mut self, width: f64) -> Option<Found> {
        let Self { points, scratch, speeds, background, search } = self;
        speeds.clear();
        speeds.extend(points.iter().map(|point| point.speed));
        background.remove(points, search.radius)?;
        let mut centre = start(points, width, scratch);
        let mut time = f64::NAN;
        for _ in 0..N_STEPS {
            let (next, mean_time, weight) = centroid(points, centre, width);
            if weight <= 0.0 {
                return None;
            }
            let step = (next[0] - centre[0]).hypot(next[1] - centre[1]);
            (centre, time) = (next, mean_time);
            if step < NEAR * width {
                break;
            }
        }
        for (point, speed) in points.iter_mut().zip(&*speeds) {
            point.speed = *speed;
        }
        let jet = jet::fit(points, search.radius, centre, width)?;
        let ratio = jet.error / (EVEN * width);
        Some(Found { place: jet.place, time, confidence: 1.0 / (1.0 + ratio * ratio) })
    }
}

/// Place of that of the fastest points which has the greatest excess around it: where the window starts.
fn start(points: &[Point], window: f64, scratch: &mut Vec<f64>) -> [f64; 2] {
    scratch.clear();
    scratch.extend(points.iter().map(|point| point.speed));
    let place = scratch.len() - N_STARTS.min(scratch.len());
    let bound = *scratch.select_nth_unstable_by(place, f64::total_cmp).1;
    let mut best = ([0.0; 2], f64::NEG_INFINITY);
    for point in points.iter().filter(|point| point.speed >= bound) {
        let sum = centroid(points, point.place, window).2;
        if sum > best.1 {
            best = (point.place, sum);
        }
    }
    best.0
}

/// Mean place (m) and time (s) of the excess around `centre`, and its sum (m/s).
fn centroid(points: &[Point], centre: [f64; 2], window: f64) -> ([f64; 2], f64, f64) {
    let (mut place, mut time, mut sum) = ([0.0; 2], 0.0, 0.0);
    for point in points.iter().filter(|point| point.speed > 0.0) {
        let weight = point.speed * gaussian(point.place, centre, window);
        place[0] += weight * point.place[0];
        place[1] += weight * point.place[1];
        time += weight * point.time;
        sum += weight;
    }
    (place.map(|value| value / sum), time / sum, sum)
}

fn gaussian(place: [f64; 2], centre: [f64; 2], window: f64) -> f64 {
    let (left, up) = (place[0] - centre[0], place[1] - centre[1]);
    (-0.5 * (left * left + up * up) / (window * window)).exp()
}
