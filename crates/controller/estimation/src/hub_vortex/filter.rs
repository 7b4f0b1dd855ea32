//! From scans to the hub vortex in the helix frame, one control instant at a time.

use super::circle::Circle;
use super::finder::{Finder, Found, Method, Search};
use crate::EstimationError;
use basis::HelixFrame;
use basis::scan::Scan;
use lti::fir::{self, Window};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Sum of weights in the low-pass filter (–) below which it tells nothing.
const LEAST_TOTAL: f64 = 1e-3;

/// How a hub vortex is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HubVortexSettings {
    /// How it is found in a scan.
    pub search: Search,
    /// Order of the low-pass filter (–).
    pub order: usize,
    /// Cut-off of the low-pass filter (Hz).
    pub cut_off: f64,
    /// The frame that turns with the helix.
    pub frame: HelixFrame,
    /// Whole helix periods over which the mean place is taken (–); 0 takes none off.
    pub n_periods: usize,
    /// What is taken off in place of that mean, to the left looking downwind and up (m): a mean that is found
    /// takes a steady bias off too.
    pub centre: Option<[f64; 2]>,
    /// Whether delay and damping of the low-pass filter at the helix's rate are made good.
    pub compensates: bool,
    /// Time between control instants (s).
    pub interval: f64,
}

impl HubVortexSettings {
    /// The source's, for a rotor of `radius` (m): the fast region, order 50, cut-off 0.05 Hz, delay left in.
    /// Its threshold, its region and the length of its mean are this program's choice.
    pub fn of_source(frame: HelixFrame, radius: f64, interval: f64) -> Self {
        Self {
            search: Search {
                method: Method::FastRegion { threshold: 0.6 },
                radius: 0.6 * radius,
                distances: [f64::MIN, f64::MAX],
            },
            order: 50,
            cut_off: 0.05,
            frame,
            n_periods: 1,
            centre: None,
            compensates: false,
            interval,
        }
    }

    /// One that bears shear, noise and drop-outs, for a rotor of `radius` (m), its delay made good.
    pub fn robust(frame: HelixFrame, radius: f64, interval: f64) -> Self {
        let source = Self::of_source(frame, radius, interval);
        let method = Method::Jet { width: 0.2 * radius };
        let search = Search { method, radius: 0.7 * radius, ..source.search };
        Self { search, compensates: true, ..source }
    }

    /// One of the whole wake over the disc of a rotor of `radius` (m), its delay made good.
    pub fn centroid(frame: HelixFrame, radius: f64, interval: f64) -> Self {
        let source = Self::of_source(frame, radius, interval);
        // A point on the disc's rim counts whatever its last digits are.
        let search = Search { method: Method::Centroid, radius: 1.001 * radius, ..source.search };
        Self { search, compensates: true, ..source }
    }

    /// Nothing where they can be.
    fn check(&self) -> Result<(), EstimationError> {
        let refuse =
            |name, value, expected| Err(EstimationError::Setting { name, value, expected });
        let positive = |value: f64| value.is_finite() && value > 0.0;
        for (name, value) in [
            ("control interval (s)", self.interval),
            ("helix rate (rad/s)", self.frame.rate),
            ("radius of the region (m)", self.search.radius),
        ] {
            if !positive(value) {
                return refuse(name, value, "take one above zero");
            }
        }
        if !(self.cut_off > 0.0 && self.cut_off * self.interval < 0.5) {
            return refuse(
                "cut-off of the low-pass filter (Hz)",
                self.cut_off,
                "take one above zero and below half the sampling rate",
            );
        }
        match self.search.method {
            Method::FastRegion { threshold } if !(0.0..1.0).contains(&threshold) => {
                refuse("threshold of the fast region (–)", threshold, "take one from 0 to below 1")
            }
            Method::Jet { width } if !positive(width) => {
                refuse("width of the jet (m)", width, "take one above zero")
            }
            _ => Ok(()),
        }
    }
}

/// The hub vortex at one instant. Places are to the left looking downwind and up from the rotor's centre (m).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HubVortex {
    /// Its place in the latest scan; the one before where it was not found.
    pub place: [f64; 2],
    /// Its place after the low-pass filter, `delay` ago.
    pub filtered: [f64; 2],
    /// Mean of the filtered place.
    pub mean: [f64; 2],
    /// Tilt (up) and yaw (to the right, as pitch has it) of the filtered place off its mean, in the helix
    /// frame (m).
    pub helix: [f64; 2],
    /// How long ago the filtered place was taken (s), the low-pass filter's delay and the scan's age.
    pub delay: f64,
    /// How sure it is (–), from 0 to 1: points seen, excess over noise, and how many scans of those in the
    /// filter found it.
    pub confidence: f64,
    /// How sure those of the scans in the filter are that found it (–): [`confidence`](Self::confidence)
    /// without its gaps.
    pub trust: f64,
    /// Whether it was not found in the latest scan.
    pub held: bool,
    /// Whether filter and mean are over scans alone, not their beginning.
    pub settled: bool,
}

impl HubVortex {
    /// Nothing seen yet.
    const NONE: Self = Self {
        place: [0.0; 2],
        filtered: [0.0; 2],
        mean: [0.0; 2],
        helix: [0.0; 2],
        delay: 0.0,
        confidence: 0.0,
        trust: 0.0,
        held: true,
        settled: false,
    };
}

/// One place of the hub vortex.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Sample {
    place: [f64; 2],
    /// When it was there (s).
    time: f64,
    /// Its confidence (–).
    weight: f64,
}

/// State of a [`HubVortexFilter`]: plain data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HubVortexState {
    /// Latest places in a ring.
    samples: Vec<Sample>,
    /// Latest filtered places in a ring.
    filtered: Vec<Sample>,
    /// Instants so far at which a place was known.
    n_known: usize,
    /// What was told last.
    last: HubVortex,
}

/// Follows a hub vortex from scan to scan.
///
/// In the source's manner a scan without a vortex holds the place before. Otherwise a place counts in the
/// low-pass filter as much as it is sure, and a scan without one not at all: the filter is a mean of what
/// was seen, and its delay that of what it holds, so that the helix frame is turned to the very time of the
/// place.
#[derive(Clone, Debug)]
pub struct HubVortexFilter {
    settings: HubVortexSettings,
    /// Taps of the low-pass, that of the newest sample first (–).
    taps: Vec<f64>,
    finder: Finder,
    /// Whole samples of the mean, and the share of one more (–).
    of_mean: (usize, f64),
    state: HubVortexState,
}

impl HubVortexFilter {
    /// A filter with `settings` for scans of at most `n_points` points.
    ///
    /// # Errors
    /// [`EstimationError::Setting`] naming the setting that cannot be.
    pub fn new(settings: HubVortexSettings, n_points: usize) -> Result<Self, EstimationError> {
        settings.check()?;
        let cut_off = settings.cut_off * settings.interval;
        let taps = fir::low_pass(settings.order + 1, cut_off, Window::Hamming);
        let length = settings.n_periods as f64 * TAU / (settings.frame.rate * settings.interval);
        let of_mean = (length.floor() as usize, length.fract());
        let state = HubVortexState {
            samples: vec![Sample::default(); settings.order + 1],
            filtered: vec![Sample::default(); of_mean.0 + 1],
            n_known: 0,
            last: HubVortex::NONE,
        };
        let finder = Finder::new(settings.search, n_points);
        Ok(Self { settings, taps, finder, of_mean, state })
    }

    /// The hub vortex after `scan` at `time` (s), the time that turns the helix frame.
    pub fn update(&mut self, time: f64, scan: &Scan) -> HubVortex {
        let found = self.finder.find(scan);
        // What was never seen has no place to hold.
        if found.is_none() && self.state.n_known == 0 {
            return HubVortex::NONE;
        }
        let sample = self.sample(time, found);
        let HubVortexState { samples, n_known, .. } = &mut self.state;
        let n_samples = samples.len();
        samples[*n_known % n_samples] = sample;
        *n_known += 1;
        let mut now = self.filtered(time);
        (now.place, now.held) = (sample.place, found.is_none());
        let HubVortexState { filtered, n_known, .. } = &mut self.state;
        let n_filtered = filtered.len();
        filtered[(*n_known - 1) % n_filtered] =
            Sample { place: now.filtered, time: time - now.delay, weight: now.confidence };
        let of_mean = if self.settings.centre.is_some() { 0 } else { self.of_mean.0 };
        now.settled = *n_known >= n_samples + of_mean;
        now.mean = self.mean();
        now.helix = self.in_helix_frame(time, &now);
        self.state.last = now;
        now
    }

    /// The state, for a checkpoint.
    pub fn state(&self) -> &HubVortexState {
        &self.state
    }

    /// Continues with the same bits from `state`, which came from a filter with the same settings.
    pub fn restore(&mut self, state: HubVortexState) {
        self.state = state;
    }

    /// Whether places count as much as they are sure.
    fn is_weighted(&self) -> bool {
        !matches!(self.settings.search.method, Method::FastRegion { .. })
    }

    /// What the low-pass filter takes in at `time` (s) of what was `found`.
    fn sample(&self, time: f64, found: Option<Found>) -> Sample {
        let is_weighted = self.is_weighted();
        match found {
            Some(found) => Sample {
                place: found.place,
                time: found.time,
                weight: if is_weighted { found.confidence } else { 1.0 },
            },
            None => {
                let weight = if is_weighted { 0.0 } else { 1.0 };
                Sample { place: self.state.last.place, time, weight }
            }
        }
    }

    /// Filtered place, delay and confidence at `time` (s).
    fn filtered(&self, time: f64) -> HubVortex {
        let HubVortexState { samples, n_known, .. } = &self.state;
        let (mut place, mut taken, mut total, mut found) = ([0.0; 2], 0.0, 0.0, 0.0);
        for (age, coefficient) in self.taps.iter().enumerate().take(*n_known) {
            let sample = &samples[(n_known - 1 - age) % samples.len()];
            let weight = coefficient * sample.weight;
            place[0] += weight * sample.place[0];
            place[1] += weight * sample.place[1];
            taken += weight * (time - sample.time);
            total += weight;
            found += if sample.weight > 0.0 { *coefficient } else { 0.0 };
        }
        // Of a filter with coefficients below zero little may be left after a gap, to divide by.
        if total < LEAST_TOTAL {
            let delay = self.state.last.delay + self.settings.interval;
            return HubVortex { delay, confidence: 0.0, ..self.state.last };
        }
        HubVortex {
            filtered: place.map(|sum| sum / total),
            delay: taken / total,
            confidence: total.min(1.0),
            trust: (total / found).min(1.0),
            ..HubVortex::NONE
        }
    }

    /// Mean of the filtered places over whole periods, as far as they reach.
    ///
    /// Where places are weighted it is that of mean + circle in the sense of the helix, by least squares: a
    /// gap does not pull it, and without one it is the plain mean.
    fn mean(&self) -> [f64; 2] {
        if let Some(centre) = self.settings.centre {
            return centre;
        }
        if self.settings.n_periods == 0 {
            return [0.0; 2];
        }
        let HubVortexState { filtered, n_known, .. } = &self.state;
        let (whole, part) = self.of_mean;
        let mut sums = Circle::default();
        for age in 0..=whole.min(n_known - 1) {
            let sample = &filtered[(n_known - 1 - age) % filtered.len()];
            let share = if age < whole { 1.0 } else { part };
            let turn = self.settings.frame.of_fixed(sample.time, [1.0, 0.0]);
            let weight = if self.is_weighted() { sample.weight } else { 1.0 };
            sums.add(share * weight, sample.place, turn);
        }
        match self.settings.search.method {
            Method::Jet { .. } => sums.centre(),
            Method::FastRegion { .. } | Method::Centroid => sums.mean(),
        }
    }

    /// Tilt and yaw in the helix frame of the place `now`, at `time` (s).
    fn in_helix_frame(&self, time: f64, now: &HubVortex) -> [f64; 2] {
        let HubVortexSettings { frame, compensates, .. } = &self.settings;
        let [left, up] = [now.filtered[0] - now.mean[0], now.filtered[1] - now.mean[1]];
        if *compensates {
            let gain = fir::gain(&self.taps, frame.rate * self.settings.interval);
            frame.of_fixed(time - now.delay, [up / gain, -left / gain])
        } else {
            frame.of_fixed(time, [up, -left])
        }
    }
}

/// Follows the hub vortex through a record of `scans`, each with its time (s), an interval apart.
///
/// # Errors
/// [`EstimationError::Setting`] naming the setting that cannot be.
pub fn follow<'a>(
    settings: HubVortexSettings,
    scans: impl IntoIterator<Item = (f64, Scan<'a>)>,
) -> Result<Vec<HubVortex>, EstimationError> {
    let mut scans = scans.into_iter().peekable();
    let n_points = scans.peek().map_or(0, |(_, scan)| scan.n_points());
    let mut filter = HubVortexFilter::new(settings, n_points)?;
    Ok(scans.map(|(time, scan)| filter.update(time, &scan)).collect())
}
