//! IEC turbulence: Kaimal's spectra, u with exponential coherence, v and w without; what TurbSim calls
//! IECKAI.

mod coherent;
#[cfg(test)]
#[path = "kaimal_tests.rs"]
mod tests;

use super::iec::Kaimal;
use super::mann::passes;
use super::{InflowError, TurbulenceBox, positive};
use coherent::Coherent;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rustfft::num_complex::Complex32;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// What to make.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct KaimalSettings {
    /// Points along x, y, z (–), at least 2 each; x, which is time, even. Products of 2, 3 and 5 are fastest.
    pub n_points: [usize; 3],
    /// Distance of neighbouring points along x, y, z (m); along x it is hub speed × time step.
    pub spacing: [f64; 3],
    /// Mean speed at hub height (m/s).
    pub hub_speed: f64,
    /// Hub height (m).
    pub hub_height: f64,
    /// Height of the lowest row of points (m).
    pub lowest_height: f64,
    /// Standard deviation of u over all frequencies (m/s).
    pub standard_deviation: f64,
    /// Whether the realised standard deviation is made the model's.
    pub scaling: Scaling,
    /// Seed.
    pub seed: u64,
    /// Threads; all cores when absent. The result does not depend on it.
    pub threads: Option<usize>,
}

/// What is done about a realised standard deviation, which lies below the model's: a record holds neither
/// waves longer than itself nor shorter than two time steps, and it varies with the seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Scaling {
    /// Nothing.
    #[default]
    None,
    /// Each component everywhere times one factor, with which the point nearest the hub meets the model's.
    Hub,
    /// Every point by itself meets the model's, each component.
    EachPoint,
}

impl KaimalSettings {
    /// # Errors
    /// [`InflowError::Setting`] names what cannot be used.
    fn check(&self) -> Result<(), InflowError> {
        super::check_grid(self.n_points, self.spacing)?;
        positive("mean speed at hub height (m/s)", self.hub_speed)?;
        super::not_negative("height of the lowest points (m)", self.lowest_height)?;
        self.model().map(|_| ())
    }

    /// The spectra and coherence that the box is drawn from.
    ///
    /// # Errors
    /// [`InflowError::Setting`] names what cannot be used.
    pub fn model(&self) -> Result<Kaimal, InflowError> {
        Kaimal::new(self.hub_height, self.hub_speed, self.standard_deviation)
    }

    /// Time between planes (s).
    pub fn interval(&self) -> f64 {
        self.spacing[0] / self.hub_speed
    }

    /// Frequency (Hz) of wave `index` of the record.
    fn frequency(&self, index: usize) -> f64 {
        index as f64 / (self.n_points[0] as f64 * self.interval())
    }

    /// Index of the point nearest the hub, which stands in the middle of the width.
    fn hub_point(&self) -> usize {
        let [_, n_y, n_z] = self.n_points;
        let row = ((self.hub_height - self.lowest_height) / self.spacing[2]).round().max(0.0);
        (row as usize).min(n_z - 1) * n_y + n_y / 2
    }
}

/// Bytes that [`generate`] holds at its peak: three components and one half-spectrum.
pub fn peak_memory([n_x, n_y, n_z]: [usize; 3]) -> u64 {
    let plane = n_y as u64 * n_z as u64;
    plane * (3 * 4 * n_x as u64 + 8 * (n_x as u64 / 2 + 1))
}

/// Draws a box; `progress` receives the share done, 0 to 1, on the calling thread.
///
/// Each point and component is a sum of waves at the record's frequencies f with amplitude √(2 S(f) Δf) and
/// random phase. Phases of v and w are independent from point to point. Those of u are made coherent: at each
/// frequency the grid is put on a torus large enough that coherence has died away half-way round; there the
/// Fourier modes are the eigenvectors of the coherence matrix, and a field with random phases per mode,
/// weighted by the roots of the eigenvalues, has exactly that coherence ("circulant embedding"). Veers'
/// Cholesky factor gives the same statistics for a cost that grows with the cube of the points; this grows
/// with their logarithm. Eigenvalues that come out negative are set to zero: [`clipped_share`] measures how
/// much that is.
///
/// The box repeats in x, that is in time; in y and z it does not: its first and last points are as far apart
/// as they look. Source: Veers (1988) SAND88-0152; Dietrich, Newsam (1997) SIAM J. Sci. Comput. 18 (1997)
/// 1088-1107; spectra and coherence [`Kaimal`].
///
/// # Errors
/// [`InflowError`] for settings out of range, or a box that memory cannot hold.
pub fn generate(
    settings: &KaimalSettings,
    progress: impl Fn(f64),
) -> Result<TurbulenceBox, InflowError> {
    generate_until(settings, |share| {
        progress(share);
        ControlFlow::Continue(())
    })
}

/// As [`generate`]; a break of `progress`, which is asked many times a second, ends it.
///
/// # Errors
/// Those of [`generate`], and [`InflowError::BrokenOff`] after a break.
pub fn generate_until(
    settings: &KaimalSettings,
    progress: impl Fn(f64) -> ControlFlow<()>,
) -> Result<TurbulenceBox, InflowError> {
    settings.check()?;
    let model = settings.model()?;
    let [n_x, n_y, n_z] = settings.n_points;
    let size = n_y * n_z;
    let out_of_memory = |_| InflowError::Memory {
        n_points: settings.n_points,
        memory: peak_memory(settings.n_points),
    };
    let n_threads = settings
        .threads
        .unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from))
        .clamp(1, 64);
    let phases = Phases::new(settings.seed);
    let coherent = Coherent::new(settings, &model);
    let mut velocity: [Vec<f32>; 3] = Default::default();
    for (component, values) in velocity.iter_mut().enumerate() {
        let mut spectrum: Vec<Complex32> = Vec::new();
        spectrum.try_reserve_exact((n_x / 2 + 1) * size).map_err(out_of_memory)?;
        spectrum.resize((n_x / 2 + 1) * size, Complex32::default());
        values.try_reserve_exact(n_x * size).map_err(out_of_memory)?;
        values.resize(n_x * size, 0.0);
        let fill = |wave: usize, plane: &mut [Complex32], workspace: &mut coherent::Workspace| {
            // Neither a mean nor the wave of two points, whose phase is not free.
            if wave == 0 || 2 * wave == n_x {
                return;
            }
            let interval = settings.frequency(1);
            let power = model.spectrum(component, settings.frequency(wave)) * interval;
            let amplitude = (0.5 * power).sqrt() as f32;
            if component == 0 && coherent.fill(wave, amplitude, &phases, workspace, plane) {
                return;
            }
            phases.fill(component, wave, amplitude, &mut workspace.bytes, plane);
        };
        let share = |done: f64| progress((component as f64 + done) / 3.0);
        let across = |done: f64| share(0.7 * done);
        if by_planes(&mut spectrum, size, n_threads, &fill, &across).is_break() {
            return Err(InflowError::BrokenOff);
        }
        let along = |done: f64| share(0.7 + 0.3 * done);
        if passes::along(spectrum, values, n_x, size, n_threads, &along).is_break() {
            return Err(InflowError::BrokenOff);
        }
        scale(settings, model.standard_deviations()[component], values);
        if share(1.0).is_break() {
            return Err(InflowError::BrokenOff);
        }
    }
    TurbulenceBox::new(settings.n_points, settings.spacing, velocity)
}

/// Largest share (–) of the variance of u at any one frequency that negative eigenvalues take, see
/// [`generate`]; the coherence of the box then differs from the model's by no more than twice that.
///
/// # Errors
/// As [`generate`].
pub fn clipped_share(settings: &KaimalSettings) -> Result<f64, InflowError> {
    settings.check()?;
    let coherent = Coherent::new(settings, &settings.model()?);
    Ok(coherent.clipped_share())
}

/// Calls `fill(plane index, plane, workspace)` on every plane of `spectrum`, on several threads; a break of
/// `progress` ends it, and is given back.
fn by_planes(
    spectrum: &mut [Complex32],
    size: usize,
    n_threads: usize,
    fill: &(impl Fn(usize, &mut [Complex32], &mut coherent::Workspace) + Sync),
    progress: &impl Fn(f64) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let n_planes = spectrum.len() / size;
    let planes = Mutex::new(spectrum.chunks_mut(size).enumerate());
    let (done, broken) = (AtomicUsize::new(0), AtomicBool::new(false));
    let work = |progress: Option<&dyn Fn(f64) -> ControlFlow<()>>| {
        let mut workspace = coherent::Workspace::default();
        while !broken.load(Ordering::Relaxed) {
            let next = planes.lock().map_or(None, |mut planes| planes.next());
            let Some((index, plane)) = next else { break };
            fill(index, plane, &mut workspace);
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if progress.is_some_and(|progress| progress(done as f64 / n_planes as f64).is_break()) {
                broken.store(true, Ordering::Relaxed);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..n_threads {
            scope.spawn(|| work(None));
        }
        work(Some(progress));
    });
    if broken.into_inner() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// On return the standard deviation of `values`, planes of one component, is `deviation` (m/s) where given.
fn scale(settings: &KaimalSettings, deviation: f64, values: &mut [f32]) {
    if settings.scaling == Scaling::None {
        return;
    }
    let [n_x, n_y, n_z] = settings.n_points;
    let size = n_y * n_z;
    let mut squares = vec![0.0; size];
    for plane in values.chunks(size) {
        for (sum, value) in squares.iter_mut().zip(plane) {
            *sum += f64::from(*value).powi(2);
        }
    }
    // Means are zero: no wave of zero frequency was drawn.
    let factor = |square: f64| {
        if square > 0.0 { (deviation / (square / n_x as f64).sqrt()) as f32 } else { 1.0 }
    };
    let factors: Vec<f32> = match settings.scaling {
        Scaling::EachPoint => squares.iter().map(|square| factor(*square)).collect(),
        _ => vec![factor(squares[settings.hub_point()]); size],
    };
    for plane in values.chunks_mut(size) {
        for (value, factor) in plane.iter_mut().zip(&factors) {
            *value *= factor;
        }
    }
}

/// Directions on the circle that a phase can have: their first 4095 moments are those of a continuous phase.
const DIRECTIONS: usize = 4096;

/// Random phases that belong to a seed, a component and a wave: the same for any number of threads.
struct Phases {
    seeded: ChaCha8Rng,
    circle: Vec<Complex32>,
}

impl Phases {
    fn new(seed: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..24].copy_from_slice(b"wakemix kaimal 1");
        let circle = (0..DIRECTIONS)
            .map(|index| {
                let angle = TAU * (index as f64 + 0.5) / DIRECTIONS as f64;
                Complex32::new(angle.cos() as f32, angle.sin() as f32)
            })
            .collect();
        Self { seeded: ChaCha8Rng::from_seed(key), circle }
    }

    /// On return `values` are waves of `amplitude` with the phases of `component` and `wave`.
    fn fill(
        &self,
        component: usize,
        wave: usize,
        amplitude: f32,
        bytes: &mut Vec<u8>,
        values: &mut [Complex32],
    ) {
        let mut stream = self.seeded.clone();
        stream.set_stream((wave as u64) << 2 | component as u64);
        stream.set_word_pos(0);
        bytes.resize(2 * values.len(), 0);
        stream.fill_bytes(bytes);
        for (value, two) in values.iter_mut().zip(bytes.chunks_exact(2)) {
            let direction = usize::from(u16::from_le_bytes([two[0], two[1]])) % DIRECTIONS;
            *value = self.circle[direction] * amplitude;
        }
    }
}
