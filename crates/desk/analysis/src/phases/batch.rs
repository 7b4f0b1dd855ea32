//! Instants that are taken in together.

use super::{Bins, PhaseError};

/// An instant with its phases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseInstant {
    /// Time (s).
    pub time: f64,
    /// Azimuth of the rotor (rad).
    pub rotor: f64,
    /// Azimuth of the helix (rad); none where there is none.
    pub helix: Option<f64>,
}

impl PhaseInstant {
    /// The azimuth of the helix that counts in `bins` (rad), zero where they do not ask for one, once all of
    /// this is sound and later than `before` (s).
    pub(super) fn checked(&self, bins: &Bins, before: Option<f64>) -> Result<f64, PhaseError> {
        let Self { time, rotor, helix } = *self;
        let helix = match (bins.helix_width(), helix) {
            (None, _) => 0.0,
            (Some(_), Some(helix)) => helix,
            (Some(_), None) => return Err(PhaseError::NoHelix { time }),
        };
        for (what, value) in [("time", time), ("rotor azimuth", rotor), ("helix azimuth", helix)] {
            if !value.is_finite() {
                return Err(PhaseError::NotFinite { what, value, time });
            }
        }
        match before {
            Some(before) if time <= before => Err(PhaseError::TimeRunsBack { time, before }),
            _ => Ok(helix),
        }
    }
}

/// Instants that follow one another, sorted into bins: found once, and taken in wherever points are.
#[derive(Clone, Debug, PartialEq)]
pub struct PhaseBatch {
    pub(super) bins: Bins,
    /// First and last (s).
    pub(super) span: [f64; 2],
    /// Numbers of all of them.
    pub(super) all: Vec<u32>,
    /// Numbers of those in each bin.
    pub(super) each: Vec<Vec<u32>>,
}

impl PhaseBatch {
    /// The `instants` in `bins`.
    ///
    /// # Errors
    /// [`PhaseError`] for a time that runs back, an azimuth that is missing or no number.
    ///
    /// # Panics
    /// Where there is no instant.
    pub fn new(bins: Bins, instants: &[PhaseInstant]) -> Result<Self, PhaseError> {
        let mut each = vec![Vec::new(); bins.len()];
        let mut before = None;
        for (number, instant) in instants.iter().enumerate() {
            let helix = instant.checked(&bins, before)?;
            bins.of_instant(instant.rotor, helix).for_each(|bin| each[bin].push(number as u32));
            before = Some(instant.time);
        }
        let span = [instants[0].time, instants[instants.len() - 1].time];
        Ok(Self { bins, span, all: (0..instants.len() as u32).collect(), each })
    }

    /// The bins.
    pub fn bins(&self) -> &Bins {
        &self.bins
    }

    /// Instants (–).
    pub fn len(&self) -> usize {
        self.all.len()
    }

    /// Whether there is no instant; there always is.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Visits to bin number `bin` that begin here, where the instant before was in it or not; and whether
    /// the last instant is in it.
    pub(super) fn visits(&self, bin: usize, was_inside: bool) -> (u64, bool) {
        let mut next = was_inside.then_some(0);
        let mut n_visits = 0;
        for member in &self.each[bin] {
            n_visits += u64::from(next != Some(*member));
            next = Some(member + 1);
        }
        (n_visits, next == Some(self.all.len() as u32))
    }
}
