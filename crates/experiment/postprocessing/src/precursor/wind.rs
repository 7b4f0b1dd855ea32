//! Spectra and coherence of the recorded planes at hub height.

use crate::PostprocessingError;
use analysis::lateral::lateral_coherence;
use analysis::spectra::power_density;
use flow::inflow::Planes;
use flow::inflow::iec::Kaimal;
use report::{CoherenceLine, DensityFigure, DensityRow, HubWind, SpectrumLine};

/// Segments that a record is cut into (–), before they overlap.
const SEGMENTS: usize = 8;
/// Frequencies whose coherence is shown (Hz).
const FREQUENCIES: [f64; 4] = [0.0025, 0.005, 0.01, 0.02];
/// Steps of frequency in the lowest of them at least (–), and share of the sampling frequency at most.
const LEAST_STEPS: f64 = 1.5;
const MOST_SHARE: f64 = 0.25;
/// Distance up to which coherence is shown, over hub height (–).
const REACH: f64 = 4.0;

/// The wind of planes in the row of points nearest to hub height.
pub(super) struct HubRow {
    /// Of u, v, w, a record of each point, from the right to the left looking downwind (m/s).
    wind: [Vec<Vec<f64>>; 3],
    /// Time between planes (s).
    interval: f64,
    /// Distance of points (m).
    spacing: f64,
}

impl HubRow {
    /// That of `planes` nearest to `height` (m).
    ///
    /// # Errors
    /// [`PostprocessingError::Planes`] for a plane that cannot be read.
    pub(super) fn read(planes: &mut dyn Planes, height: f64) -> Result<Self, PostprocessingError> {
        let grid = planes.grid();
        let row = ((height - grid.first[1]) / grid.spacing[1]).round().max(0.0) as usize;
        let start = row.min(grid.n_z - 1) * grid.n_y;
        let record = || vec![Vec::with_capacity(grid.n_steps); grid.n_y];
        let mut wind = [record(), record(), record()];
        let mut plane = vec![[0.0; 3]; grid.n_y * grid.n_z];
        for step in 0..grid.n_steps {
            planes.read(step, &mut plane)?;
            for (point, velocity) in plane[start..start + grid.n_y].iter().enumerate() {
                for (component, value) in wind.iter_mut().zip(velocity) {
                    component[point].push(f64::from(*value));
                }
            }
        }
        Ok(Self { wind, interval: grid.interval, spacing: grid.spacing[0] })
    }

    /// Samples of a segment (–).
    fn n_segment(&self) -> usize {
        self.wind[0].first().map_or(0, Vec::len) / SEGMENTS
    }
}

/// Spectra of u, v, w, mean over all points, beside Kaimal's; none where the record is too short.
pub(super) fn spectra(row: &HubRow, hub: &HubWind) -> Option<DensityFigure> {
    let model = model(hub)?;
    let line = |name: &str, colour, frequency_step, values| SpectrumLine {
        name: name.to_owned(),
        colour,
        frequency_step,
        values,
    };
    let of = |(component, name): (usize, &str)| -> Option<DensityRow> {
        let mut sum: Vec<f64> = Vec::new();
        let points = &row.wind[component];
        let mut step = 0.0;
        for samples in points {
            let spectrum = power_density(samples, row.interval, row.n_segment()).ok()?;
            step = spectrum.frequency_step;
            sum.resize(spectrum.values.len(), 0.0);
            sum.iter_mut().zip(&spectrum.values).for_each(|(sum, value)| *sum += value);
        }
        sum.iter_mut().for_each(|value| *value /= points.len() as f64);
        let kaimal = (0..sum.len()).map(|k| model.spectrum(component, k as f64 * step)).collect();
        let lines = vec![line("recorded", 2, step, sum), line("Kaimal", 0, step, kaimal)];
        Some(DensityRow { label: format!("{name} (m²/s² per Hz)"), lines })
    };
    let rows: Option<Vec<DensityRow>> = ["u", "v", "w"].into_iter().enumerate().map(of).collect();
    Some(DensityFigure {
        name: "spectra".to_owned(),
        title: "Spectra at hub height".to_owned(),
        caption: "Power spectral densities at hub height, mean over all points across the wind, beside Kaimal's of IEC 61400-1 (2005, eq. B.14) with the same hub height, speed and standard deviation of u. Beyond a wave of some cells the box resolves none.".to_owned(),
        lowest_frequency: Some(1.0 / (row.n_segment() as f64 * row.interval)),
        highest_frequency: (0.5 * hub.speed / row.spacing).min(0.5 / row.interval),
        marks: Vec::new(),
        band: None,
        rows: rows?,
    })
}

/// Coherence of u beside the exponential model; none where the record is too short.
pub(super) fn coherence(row: &HubRow, hub: &HubWind) -> Vec<CoherenceLine> {
    let (n_segment, model) = (row.n_segment(), model(hub));
    let step = 1.0 / (n_segment as f64 * row.interval);
    let told = |frequency: &f64| {
        *frequency >= LEAST_STEPS * step && *frequency <= MOST_SHARE / row.interval
    };
    let frequencies: Vec<f64> = FREQUENCIES.into_iter().filter(told).collect();
    let n_distances = (REACH * hub.height / row.spacing).round() as usize;
    let found = lateral_coherence(&row.wind[0], row.interval, &frequencies, n_segment, n_distances);
    let (Ok(found), Some(model)) = (found, model) else { return Vec::new() };
    let line = |one: analysis::lateral::LateralCoherence| {
        let place = |index: usize| index as f64 * row.spacing;
        let points = one.values.iter().enumerate();
        CoherenceLine {
            frequency: one.frequency,
            points: points.map(|(index, value)| [place(index), *value]).collect(),
            model: (0..one.values.len())
                .map(|index| [place(index), model.coherence(one.frequency, place(index))])
                .collect(),
        }
    };
    found.into_iter().map(line).collect()
}

/// Kaimal's model with the wind at the hub.
fn model(hub: &HubWind) -> Option<Kaimal> {
    Kaimal::new(hub.height, hub.speed, hub.turbulence_intensity * hub.speed).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spectra_hold_the_variance_and_points_that_are_alike_are_coherent() {
        // A chirp has power at all frequencies; 1600 s in segments of 200 s.
        let record: Vec<f64> =
            (0..1600).map(|k| 10.0 + (2e-4 * f64::from(k) * f64::from(k)).sin()).collect();
        let row = HubRow {
            wind: [vec![record.clone(); 8], vec![record.clone(); 8], vec![record; 8]],
            interval: 1.0,
            spacing: 20.0,
        };
        let hub = HubWind {
            height: 90.0,
            rotor_diameter: None,
            speed: 10.0,
            direction_deg: 270.0,
            turbulence_intensity: 0.07,
        };
        let told = spectra(&row, &hub).expect("a figure");
        let line = &told.rows[0].lines[0];
        let variance = line.values.iter().sum::<f64>() * line.frequency_step;
        assert!((variance - 0.5).abs() < 0.1, "{variance}");
        assert_eq!((told.rows.len(), told.highest_frequency), (3, 0.25));
        let lines = coherence(&row, &hub);
        let frequencies: Vec<f64> = lines.iter().map(|line| line.frequency).collect();
        assert_eq!(frequencies, [0.01, 0.02]);
        for line in &lines {
            assert_eq!(line.points.len(), 8);
            assert!(line.points.iter().all(|point| (point[1] - 1.0).abs() < 1e-12));
            assert!(line.model[7][1] < line.model[1][1] && line.model[7][0] == 140.0);
        }
        let short = HubRow {
            wind: row
                .wind
                .map(|points| points[..2].iter().map(|record| record[..90].to_vec()).collect()),
            ..row
        };
        assert!(spectra(&short, &hub).is_none() && coherence(&short, &hub).is_empty());
    }
}
