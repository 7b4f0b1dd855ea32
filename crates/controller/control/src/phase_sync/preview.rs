//! The helix ahead of its arrival, through a lidar of the turbine that looks upwind.

use crate::baseline::CoefficientTable;
use crate::error::ControlError;
use crate::keys::sense;
use crate::kind::{Place, Site};
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::keys::{Objection, Values};
use basis::records::Finding;
use basis::{Channel, Measurements, channels};
use estimation::HelixEstimate;
use estimation::helix::{PreviewEstimate, PreviewEstimator, PreviewSettings, PreviewState};

/// Greatest thrust coefficient (–) of momentum theory in a wake that does not break down: an induction of
/// 0.4.
const MOST_THRUST: f64 = 0.96;
/// Slowest wind (m/s) that tip-speed ratios are formed with.
const SLOWEST: f64 = 1.0;

/// The preview of one turbine.
#[derive(Clone, Debug)]
pub struct Preview {
    /// Name of the lidar.
    sensor: String,
    estimator: PreviewEstimator,
    /// Radius of the rotor (m).
    radius: f64,
    /// How the rotor slows the air ahead of it; none where the air does not show that.
    coefficients: Option<CoefficientTable>,
    found: Option<PreviewEstimate>,
}

impl Preview {
    /// As `values` of a controller at `site` ask for it; none where they name no lidar.
    ///
    /// # Errors
    /// [`ControlError::Estimation`] for settings that cannot be.
    pub(super) fn of(values: &Values, site: &Site) -> Result<Option<Self>, ControlError> {
        if !values.has("preview") {
            return Ok(None);
        }
        let radius = site.rotor.rotor_radius();
        let settings = PreviewSettings {
            sense: sense(values),
            rate: site.rate(values.number("strouhal")),
            radius,
            speed_factor: values.optional_number("preview_speed_factor").unwrap_or(1.0),
        };
        let resolved = site.flow_resolves_induction;
        Ok(Some(Self {
            sensor: values.word("preview").to_owned(),
            estimator: PreviewEstimator::new(settings)?,
            radius,
            coefficients: resolved.then(|| (site.coefficients)(site.rotor)),
            found: None,
        }))
    }

    /// Axial induction (–) of the rotor in a free wind of `speed` (m/s): that of momentum theory at the
    /// thrust coefficient of speed and mean pitch.
    fn induction(&self, measurements: &Measurements, speed: f64) -> f64 {
        let Some(coefficients) = &self.coefficients else { return 0.0 };
        let ratio = measurements.rotor_speed * self.radius / speed.max(SLOWEST);
        let thrust = coefficients.thrust(ratio, measurements.pitch.mean());
        let induction = 0.5 * (1.0 - (1.0 - thrust.clamp(0.0, MOST_THRUST)).sqrt());
        if induction.is_finite() { induction } else { 0.0 }
    }

    /// `from_loads` with what the lidar sees in the place of its wave.
    pub(super) fn update(
        &mut self,
        measurements: &Measurements,
        from_loads: HelixEstimate,
    ) -> HelixEstimate {
        let induction = self.induction(measurements, from_loads.mean_wind);
        let scan = measurements.scan(&self.sensor);
        let now = (measurements.time, measurements.interval);
        let found = self.estimator.update(now, scan.as_ref(), induction);
        self.found = Some(found);
        from_loads.with_preview(&found)
    }

    /// Its signals.
    pub(super) fn signals() -> [Channel; 3] {
        [channels::PREVIEW_SHARE, channels::PREVIEW_TIME, channels::PREVIEW_LAG]
    }

    /// On return `values` hold its signals.
    pub(super) fn write_signals(&self, values: &mut [f64]) {
        let Some(PreviewEstimate { share, ahead, lag, .. }) = self.found else { return };
        values.copy_from_slice(&[share, ahead, lag]);
    }

    /// For a checkpoint.
    pub(super) fn state(&self) -> &PreviewState {
        self.estimator.state()
    }

    /// Goes on with the same bits.
    pub(super) fn restore(&mut self, state: PreviewState) {
        self.estimator.restore(state);
    }
}

/// Share of the free wind (–) that is left in a slow wake, by rule of thumb: that of momentum theory at the
/// induction of a third, the best for power. A rotor that is loaded more leaves less, and wakes mix.
const SLOW_WAKE: f64 = 1.0 / 3.0;

/// What about the preview in `values` cannot be at `place`.
pub(super) fn objections(values: &Values, place: &Place) -> Vec<Objection> {
    let objection = |key, message: String, label, fix: &str| {
        vec![Objection { key: Some(key), message, label, fix: fix.to_owned() }]
    };
    if !values.has("preview") {
        if values.has("preview_speed_factor") {
            let message = "has no effect here: no lidar is named in `preview`".to_owned();
            return objection("preview_speed_factor", message, "no effect", "leave it out");
        }
        return Vec::new();
    }
    let (name, turbine) = (values.word("preview"), place.turbine);
    let Some(sensor) = place.sensor(name).filter(|sensor| sensor.kind == "lidar") else {
        let message = format!("= \"{name}\" names no lidar of {turbine}");
        let fix = format!(
            "add sensors.{name} = {{ kind = \"lidar\", looks = \"upwind\", downwind = 5.0, focal_distance_diameters = 2.0 }} to its [[turbine]]"
        );
        return objection("preview", message, "no such lidar", &fix);
    };
    let lidar = sensor.values;
    if lidar.word("looks") != "upwind" {
        let message = format!("= \"{name}\" looks downwind, and the helix comes from upwind");
        let fix = format!("set looks = \"upwind\" in sensors.{name} of {turbine}");
        return objection("preview", message, "looks downwind", &fix);
    }
    if lidar.number("n_points") < 3.0 {
        let message = format!("= \"{name}\" has too few points to tell tilt and yaw from a mean");
        let fix = format!("set n_points = 3 or more in sensors.{name} of {turbine}");
        return objection("preview", message, "too few points", &fix);
    }
    let focus = lidar.optional_number("focal_distance_diameters").unwrap_or(1.0);
    let ranges = lidar.numbers("ranges_diameters");
    let furthest = ranges.iter().copied().reduce(f64::max).unwrap_or(focus);
    // Half a period of the wind is D/(2 St) long.
    let of_free_wind = 0.5 / values.number("strouhal");
    let least = SLOW_WAKE * of_free_wind;
    if furthest < least {
        let message = format!(
            "= \"{name}\" sees the wind {furthest} D ahead: an estimate without lag needs half a period of the helix, which is {of_free_wind:.2} D of the free wind and {least:.2} D of a slow wake, at a third of it"
        );
        let fix = format!(
            "look {of_free_wind:.2} D ahead, or as much of it as the wake's speed is of the free wind's, in sensors.{name} of {turbine}; never less than {least:.2} D"
        );
        return objection("preview", message, "too near", &fix);
    }
    Vec::new()
}

/// Share of the time without full sight, or with a lag, beyond which a reader must know (–).
const UNSEEN_SHARE: f64 = 0.02;

/// What a run tells of its preview.
///
/// # Errors
/// [`MissingChannel`] for records without it.
pub(super) fn outcome(record: &dyn TurbineRecord) -> Result<Outcome, MissingChannel> {
    let share = record.column(&channels::PREVIEW_SHARE)?;
    let ahead = record.column(&channels::PREVIEW_TIME)?;
    let lag = record.column(&channels::PREVIEW_LAG)?;
    let seen: Vec<usize> = (0..share.len()).filter(|row| share[*row] > 0.0).collect();
    let mean = |values: &[f64]| {
        seen.iter().map(|row| values[*row]).sum::<f64>() / seen.len().max(1) as f64
    };
    let (used, ahead, lags) = (
        share.iter().sum::<f64>() / share.len().max(1) as f64,
        mean(ahead),
        seen.iter().filter(|row| lag[**row] > 0.0).count() as f64 / seen.len().max(1) as f64,
    );
    let found = |name: &str, value, unit: &str, about: &str| Finding {
        name: name.to_owned(),
        value: Some(value),
        unit: unit.to_owned(),
        about: about.to_owned(),
    };
    let blind = (used < 1.0 - UNSEEN_SHARE).then(|| {
        format!(
            " saw the helix ahead through its lidar {:.0} % of the time, and found it in its blade loads alone for the rest",
            100.0 * used
        )
    });
    let late = (lags > UNSEEN_SHARE).then(|| {
        let lag = mean(lag);
        format!(
            " saw the helix {ahead:.1} s ahead on the mean, and its estimate lagged by {lag:.1} s since half a period is needed; look {:.2} times as far upwind, or more",
            (ahead + lag) / ahead
        )
    });
    Ok(Outcome {
        findings: vec![
            found(
                "preview-share",
                used,
                "–",
                "share of the estimate that came from the lidar, the rest from the blade loads",
            ),
            found("preview-time", ahead, "s", "mean time that the seen air took to the rotor"),
        ],
        warnings: blind.into_iter().chain(late).collect(),
        ..Outcome::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Share, time and lag of a preview, one row each.
    struct Rows(Vec<[f64; 4]>);

    impl TurbineRecord for Rows {
        fn column(&self, channel: &Channel) -> Result<&[f64], MissingChannel> {
            let place = Preview::signals().iter().position(|own| own == channel);
            let found = place.and_then(|place| self.0.get(place)).map(<[f64; 4]>::as_slice);
            found.ok_or_else(|| MissingChannel(channel.name.to_string()))
        }

        fn interval(&self) -> f64 {
            0.1
        }

        fn n_blades(&self) -> usize {
            3
        }
    }

    /// What is found of share (–) and time (s), and the warnings, for this share, time and lag.
    fn told(share: [f64; 4], ahead: [f64; 4], lag: [f64; 4]) -> ([f64; 2], Vec<String>) {
        let Outcome { findings, warnings, .. } =
            outcome(&Rows(vec![share, ahead, lag])).expect("all channels");
        let value = |name: &str| {
            let finding = findings.iter().find(|finding| finding.name == name);
            finding.and_then(|finding| finding.value).expect(name)
        };
        (["preview-share", "preview-time"].map(value), warnings)
    }

    #[test]
    fn a_preview_that_sees_far_enough_all_the_time_warns_of_nothing() {
        let (found, warnings) = told([1.0; 4], [50.0, 60.0, 70.0, 60.0], [0.0; 4]);
        assert_eq!((found, warnings), ([1.0, 60.0], Vec::new()));
    }

    #[test]
    fn a_blind_time_is_warned_of_and_counts_for_no_lag() {
        let (found, warnings) =
            told([1.0, 0.5, 0.0, 0.5], [60.0, 60.0, 0.0, 60.0], [0.0, 0.0, 50.0, 0.0]);
        assert_eq!(found, [0.5, 60.0]);
        let [blind] = warnings.as_slice() else { panic!("{warnings:?}") };
        assert!(blind.contains("through its lidar 50 % of the time"), "{blind}");
    }

    #[test]
    fn a_lag_is_warned_of_with_how_far_to_look() {
        let (_, warnings) = told([1.0; 4], [40.0; 4], [0.0, 20.0, 20.0, 0.0]);
        let [late] = warnings.as_slice() else { panic!("{warnings:?}") };
        assert!(late.contains("40.0 s ahead on the mean") && late.contains("by 10.0 s"), "{late}");
        assert!(late.contains("look 1.25 times as far"), "{late}");
    }

    #[test]
    fn records_without_it_are_refused() {
        let error = outcome(&Rows(vec![[1.0; 4]; 2])).expect_err("no lag");
        assert_eq!(error.0, "PreviewLag");
    }
}
