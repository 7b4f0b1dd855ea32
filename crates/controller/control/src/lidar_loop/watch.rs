//! What a controller sees of the hub vortex through its lidar.

use crate::error::ControlError;
use crate::kind::Site;
use crate::samples::Samples;
use basis::keys::Values;
use basis::scan::Scan;
use basis::{HelixFrame, Measurements};
use estimation::hub_vortex::{HubVortex, HubVortexFilter, HubVortexSettings, HubVortexState};
use serde::{Deserialize, Serialize};

/// Most points that a scan may have (–).
const MOST_POINTS: usize = 4096;

/// The hub vortex, followed sample by sample.
#[derive(Clone, Debug)]
pub(crate) struct Watch {
    /// Name of the lidar.
    sensor: String,
    filter: HubVortexFilter,
    /// Time between samples (s).
    interval: f64,
    seen: Seen,
}

/// What was seen so far.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Seen {
    samples: Samples,
    last: Option<HubVortex>,
    /// Time since the vortex was last found (s).
    blind: f64,
}

impl Seen {
    const NOTHING: Self = Self { samples: Samples::NONE, last: None, blind: f64::INFINITY };
}

/// Everything of a [`Watch`] that time changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct WatchState {
    filter: HubVortexState,
    seen: Seen,
}

impl Watch {
    /// As `values` of a controller at `site` ask for it, in `frame`.
    ///
    /// # Errors
    /// [`ControlError::Estimation`] for settings that cannot be.
    pub(crate) fn of(
        values: &Values,
        site: &Site,
        frame: HelixFrame,
    ) -> Result<Self, ControlError> {
        let (radius, interval) = (site.rotor.rotor_radius(), values.number("vortex_interval"));
        let settings = match values.word("vortex_filter") {
            "published" => HubVortexSettings::of_source,
            "centroid" => HubVortexSettings::centroid,
            _ => HubVortexSettings::robust,
        };
        let settings = settings(frame, radius, interval);
        let centre = match values.numbers("vortex_centre") {
            [left, up] => Some([*left, *up]),
            _ => None,
        };
        Ok(Self {
            sensor: values.word("lidar").to_owned(),
            filter: HubVortexFilter::new(HubVortexSettings { centre, ..settings }, MOST_POINTS)?,
            interval,
            seen: Seen::NOTHING,
        })
    }

    /// Takes the latest scan where a sample is due.
    pub(crate) fn update(&mut self, measurements: &Measurements) {
        let Self { sensor, filter, interval, seen } = self;
        let time = measurements.time;
        if !seen.samples.due(time, *interval) {
            return;
        }
        seen.blind += *interval;
        if let Some(scan) = measurements.reading(sensor).and_then(Scan::of) {
            let vortex = filter.update(time, &scan);
            if !vortex.held {
                seen.blind = 0.0;
            }
            seen.last = Some(vortex);
        }
    }

    /// The hub vortex at the last sample; none before it was seen.
    pub(crate) fn vortex(&self) -> Option<&HubVortex> {
        self.seen.last.as_ref()
    }

    /// Time since it was last found (s); infinite before that.
    pub(crate) fn blind(&self) -> f64 {
        self.seen.blind
    }

    /// On return `values` hold its [channels](basis::channels::HUB_VORTEX); as they were before anything was
    /// seen.
    pub(crate) fn write_signals(&self, values: &mut [f64]) {
        let Some(HubVortex { filtered, helix, confidence, .. }) = self.vortex() else { return };
        values.copy_from_slice(&[filtered[0], filtered[1], helix[0], helix[1], *confidence]);
    }

    /// For a checkpoint.
    pub(crate) fn save(&self) -> WatchState {
        WatchState { filter: self.filter.state().clone(), seen: self.seen }
    }

    /// Goes on with the same bits.
    pub(crate) fn restore(&mut self, WatchState { filter, seen }: WatchState) {
        self.filter.restore(filter);
        self.seen = seen;
    }
}

#[cfg(test)]
impl Watch {
    /// One that looks through a sensor called `lidar` at the wake of a rotor of 63 m radius every 0.1 s,
    /// about a `centre` that is known or found.
    pub(crate) fn for_tests(frame: HelixFrame, centre: Option<[f64; 2]>) -> Self {
        let settings = HubVortexSettings::robust(frame, 63.0, 0.1);
        let settings = HubVortexSettings { centre, ..settings };
        Self {
            sensor: "lidar".to_owned(),
            filter: HubVortexFilter::new(settings, MOST_POINTS).expect("sound settings"),
            interval: 0.1,
            seen: Seen::NOTHING,
        }
    }
}
