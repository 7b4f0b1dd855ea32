//! Sums for each bin, of particles as they come.

use super::basis_functions::{MOST_TERMS, terms_at};
use super::binned::{Binned, Convergence, Tally};
use super::fit::{Fitted, Sums};
use super::settings::N_STAGES;
use super::{BinSettings, Particle};
use basis::records::{Moments, STRESSES};
use std::ops::Range;

/// Bins that take in particles.
#[derive(Clone, Debug)]
pub struct Binner {
    settings: BinSettings,
    n: Vec<u32>,
    sums: Vec<f64>,
    /// Velocity from which sums are taken, so that nothing cancels (m/s).
    reference: Option<[f64; 3]>,
    stages: Vec<Stage>,
    tally: Tally,
}

/// Means at an earlier stage.
#[derive(Clone, Debug)]
struct Stage {
    n_taken: u64,
    mean: [Vec<f32>; 3],
    error: f64,
}

impl Binner {
    /// Empty bins.
    pub fn new(settings: BinSettings) -> Self {
        let n_bins = settings.grid.len();
        Self {
            n: vec![0; n_bins],
            sums: vec![0.0; n_bins * settings.stride()],
            settings,
            reference: None,
            stages: Vec::new(),
            tally: Tally::default(),
        }
    }

    /// How particles are binned.
    pub fn settings(&self) -> &BinSettings {
        &self.settings
    }

    /// Takes in `particle`; allocates nothing. One that is not whole is counted and left out, as is one
    /// outside all bins.
    pub fn add(&mut self, particle: &Particle) {
        if !particle.is_whole() {
            self.tally.n_holes += 1;
            return;
        }
        let ranges = [0, 1, 2].map(|axis| self.reached(axis, particle.position[axis]));
        if ranges.iter().any(Range::is_empty) {
            self.tally.n_outside += 1;
            return;
        }
        self.tally.n_taken += 1;
        let reference = *self.reference.get_or_insert(particle.velocity);
        let velocity = [0, 1, 2].map(|axis| particle.velocity[axis] - reference[axis]);
        let [along_x, along_y, along_z] = ranges;
        for z in along_z {
            for y in along_y.clone() {
                for x in along_x.clone() {
                    self.add_to([x, y, z], particle.position, velocity);
                }
            }
        }
    }

    /// Counts `n` particles that were left out as outliers.
    pub fn count_outliers(&mut self, n: u64) {
        self.tally.n_outliers += n;
    }

    /// Steps along `axis` of the bins that hold `coordinate` (m).
    fn reached(&self, axis: usize, coordinate: f64) -> Range<usize> {
        let (grid, half) = (&self.settings.grid, 0.5 * self.settings.size[axis]);
        let steps = (coordinate - grid.origin[axis]) / grid.spacing[axis];
        let reach = half / grid.spacing[axis];
        let n = grid.n_points[axis] as f64;
        let first = (steps - reach).ceil().clamp(0.0, n);
        let last = (steps + reach).ceil().clamp(0.0, n);
        first as usize..last as usize
    }

    fn add_to(&mut self, place: [usize; 3], position: [f64; 3], velocity: [f64; 3]) {
        let settings = &self.settings;
        let (index, deviations) = (settings.grid.index(place), settings.deviations());
        let middle = settings.grid.position(place);
        let away = [0, 1, 2].map(|axis| position[axis] - middle[axis]);
        // Across an axis along which particles are not spread, all are as near.
        let near = |axis: usize| {
            let ratio = if settings.axes[axis] { away[axis] / deviations[axis] } else { 0.0 };
            ratio * ratio
        };
        let weight = (-0.5 * (near(0) + near(1) + near(2))).exp();
        let scaled = [0, 1, 2].map(|axis| 2.0 * away[axis] / settings.size[axis]);
        let mut terms = [0.0; MOST_TERMS];
        terms_at(scaled, settings.order, settings.axes, &mut terms);
        let n_terms = settings.n_terms();
        let stride = settings.stride();
        self.n[index] = self.n[index].saturating_add(1);
        let n_products = n_terms * (n_terms + 1) / 2;
        let bin = &mut self.sums[index * stride..(index + 1) * stride];
        let (squares, rest) = bin.split_at_mut(n_products);
        let (products, rest) = rest.split_at_mut(n_products);
        let (moments, velocities) = rest.split_at_mut(3 * n_terms);
        let mut next = products.iter_mut().zip(squares);
        for row in 0..n_terms {
            let weighted = weight * terms[row];
            for (term, (product, square)) in terms[..=row].iter().zip(&mut next) {
                *product += weighted * term;
                *square += weight * weighted * term;
            }
        }
        for (component, moments) in moments.chunks_exact_mut(n_terms).enumerate() {
            let weighted = weight * velocity[component];
            for (moment, term) in moments.iter_mut().zip(&terms) {
                *moment += weighted * term;
            }
        }
        for (sum, [first, second]) in velocities.iter_mut().zip(STRESSES) {
            *sum += weight * velocity[first] * velocity[second];
        }
    }

    /// Keeps the means of now, for convergence; of more stages than four the latest ones.
    pub fn keep_stage(&mut self) {
        if self.stages.len() == N_STAGES {
            self.stages.remove(0);
        }
        let (mean, error) = self.means();
        self.stages.push(Stage { n_taken: self.tally.n_taken, mean, error });
    }

    /// The polynomial of bin number `index`.
    fn fitted(&self, index: usize) -> Option<Fitted> {
        let stride = self.settings.stride();
        let bin = &self.sums[index * stride..(index + 1) * stride];
        Sums::of(bin, self.settings.n_terms()).fitted(self.n[index], &self.settings)
    }

    /// Means of all bins (m/s), and the root of the mean square of their standard errors (m/s).
    fn means(&self) -> ([Vec<f32>; 3], f64) {
        let n_bins = self.n.len();
        let reference = self.reference.unwrap_or_default();
        let mut mean = [0, 1, 2].map(|_| vec![f32::NAN; n_bins]);
        let (mut sum, mut n) = (0.0, 0_usize);
        for (index, fitted) in (0..n_bins).filter_map(|i| Some((i, self.fitted(i)?))) {
            for ((mean, own), from) in mean.iter_mut().zip(fitted.mean).zip(reference) {
                mean[index] = (from + own) as f32;
            }
            sum += fitted.error.iter().map(|error| error * error).sum::<f64>();
            n += 1;
        }
        (mean, (sum / (3 * n).max(1) as f64).sqrt())
    }

    /// What all bins say.
    pub fn binned(&self) -> Binned {
        let (settings, n_bins) = (self.settings, self.n.len());
        let nothing = || vec![f32::NAN; n_bins];
        let mut found = Binned {
            grid: settings.grid,
            size: settings.size,
            order: vec![None; n_bins],
            moments: Moments {
                n_samples: self.n.clone(),
                mean: std::array::from_fn(|_| nothing()),
                stress: std::array::from_fn(|_| nothing()),
            },
            error: std::array::from_fn(|_| nothing()),
            gradient: std::array::from_fn(|_| std::array::from_fn(|_| nothing())),
            convergence: Vec::new(),
            tally: self.tally,
        };
        let reference = self.reference.unwrap_or_default();
        for index in 0..n_bins {
            let Some(fitted) = self.fitted(index) else {
                found.tally.n_empty += u64::from(self.n[index] == 0);
                found.tally.n_thin += u64::from(self.n[index] > 0);
                continue;
            };
            found.order[index] = Some(fitted.order);
            for (component, from) in reference.into_iter().enumerate() {
                found.moments.mean[component][index] = (from + fitted.mean[component]) as f32;
                found.error[component][index] = fitted.error[component] as f32;
                for axis in 0..3 {
                    let slope = fitted.slope[component][axis] / (0.5 * settings.size[axis]);
                    found.gradient[component][axis][index] = slope as f32;
                }
            }
            for (values, stress) in found.moments.stress.iter_mut().zip(fitted.stress) {
                values[index] = stress as f32;
            }
        }
        found.convergence = self.convergence(&found);
        found
    }

    /// How far the means of earlier stages lie from those of `last`, and how sure they were.
    fn convergence(&self, last: &Binned) -> Vec<Convergence> {
        let stage = |stage: &Stage| {
            let (mut sum, mut n) = (0.0, 0_u64);
            for (early, late) in stage.mean.iter().zip(&last.moments.mean) {
                for (early, late) in early.iter().zip(late).filter(|(early, _)| early.is_finite()) {
                    sum += f64::from(early - late).powi(2);
                    n += 1;
                }
            }
            let change = (sum / n.max(1) as f64).sqrt();
            Convergence { n_taken: stage.n_taken, change, error: stage.error }
        };
        let mut all: Vec<Convergence> = self.stages.iter().map(stage).collect();
        let error = self.means().1;
        all.push(Convergence { n_taken: self.tally.n_taken, change: 0.0, error });
        all
    }
}
