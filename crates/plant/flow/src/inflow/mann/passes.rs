//! Fourier passes over half-spectra, on several threads with the same bits for any number of them.

use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex32;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Columns transformed together along x: a cache line or two of each plane.
const BLOCK: usize = 32;

/// Fills each streamwise plane of three half-spectra by `fill(x, planes)`, then transforms it over y and z.
///
/// `spectra` are n × n_z × n_y, y fastest. `progress` receives the share done on the calling thread; a break
/// ends it, and is given back: the spectra are then of no use.
pub(super) fn across(
    spectra: &mut [Vec<Complex32>; 3],
    n_y: usize,
    n_z: usize,
    n_threads: usize,
    fill: &(impl Fn(usize, [&mut [Complex32]; 3]) + Sync),
    progress: &impl Fn(f64) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let mut planner = FftPlanner::new();
    let (over_y, over_z) = (planner.plan_fft_inverse(n_y), planner.plan_fft_inverse(n_z));
    let size = n_y * n_z;
    let n_planes = spectra[0].len() / size;
    let [u, v, w] = spectra;
    let planes = u.chunks_mut(size).zip(v.chunks_mut(size)).zip(w.chunks_mut(size)).enumerate();
    let planes = Mutex::new(planes);
    let (done, broken) = (AtomicUsize::new(0), AtomicBool::new(false));
    let work = |progress: Option<&dyn Fn(f64) -> ControlFlow<()>>| {
        let mut turned = vec![Complex32::default(); size];
        let needed = over_y.get_inplace_scratch_len().max(over_z.get_inplace_scratch_len());
        let mut scratch = vec![Complex32::default(); needed];
        while !broken.load(Ordering::Relaxed) {
            let next = planes.lock().map_or(None, |mut planes| planes.next());
            let Some((x, ((u, v), w))) = next else { break };
            fill(x, [u, v, w]);
            for plane in [u, v, w] {
                over_y.process_with_scratch(plane, &mut scratch);
                turn(plane, &mut turned, n_y);
                over_z.process_with_scratch(&mut turned, &mut scratch);
                turn(&turned, plane, n_z);
            }
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

/// Transforms a half-spectrum along x into real `values`, n_x × `n_columns`.
///
/// `progress` receives the share done, about, on the calling thread; a break ends it, and is given back: the
/// values are then of no use.
pub(in crate::inflow) fn along(
    mut spectrum: Vec<Complex32>,
    values: &mut [f32],
    n_x: usize,
    n_columns: usize,
    n_threads: usize,
    progress: &impl Fn(f64) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let transform = RealFftPlanner::<f32>::new().plan_fft_inverse(n_x);
    let share = n_columns.div_ceil(n_threads);
    let parts =
        split(&mut spectrum, n_columns, share).into_iter().zip(split(values, n_columns, share));
    let broken = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let mut first = None;
        for (waves, values) in parts {
            if first.is_none() {
                first = Some((waves, values));
                continue;
            }
            let (transform, broken) = (&transform, &broken);
            let goes_on = move |_| !broken.load(Ordering::Relaxed);
            scope.spawn(move || columns(transform.as_ref(), &waves, values, &goes_on));
        }
        // The first part is done here, where progress may be told.
        if let Some((waves, values)) = first {
            columns(transform.as_ref(), &waves, values, &|share| {
                let goes_on = progress(share).is_continue();
                broken.fetch_or(!goes_on, Ordering::Relaxed);
                goes_on
            });
        }
    });
    if broken.into_inner() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// The columns of every row of `rows`, dealt out in runs of `share`: one list of part-rows per run.
fn split<T>(rows: &mut [T], n_columns: usize, share: usize) -> Vec<Vec<&mut [T]>> {
    let mut parts: Vec<Vec<&mut [T]>> =
        (0..n_columns.div_ceil(share)).map(|_| Vec::new()).collect();
    for row in rows.chunks_mut(n_columns) {
        for (part, columns) in parts.iter_mut().zip(row.chunks_mut(share)) {
            part.push(columns);
        }
    }
    parts
}

/// Transforms the columns of `waves` into those of `values` as long as `goes_on`, which is told the share
/// done.
fn columns(
    transform: &dyn realfft::ComplexToReal<f32>,
    waves: &[&mut [Complex32]],
    mut values: Vec<&mut [f32]>,
    goes_on: &dyn Fn(f64) -> bool,
) {
    let (n_waves, n_x) = (waves.len(), values.len());
    let n_columns = waves[0].len();
    let mut gathered = vec![Complex32::default(); BLOCK * n_waves];
    let mut transformed = vec![0.0; BLOCK * n_x];
    let mut scratch = transform.make_scratch_vec();
    for start in (0..n_columns).step_by(BLOCK) {
        if !goes_on(start as f64 / n_columns as f64) {
            return;
        }
        let block = BLOCK.min(n_columns - start);
        for (x, row) in waves.iter().enumerate() {
            for (column, value) in row[start..start + block].iter().enumerate() {
                gathered[column * n_waves + x] = *value;
            }
        }
        for (waves, values) in
            gathered.chunks_mut(n_waves).zip(transformed.chunks_mut(n_x)).take(block)
        {
            // Zero by construction, up to the rounding of the passes before.
            waves[0].im = 0.0;
            waves[n_waves - 1].im = 0.0;
            if transform.process_with_scratch(waves, values, &mut scratch).is_err() {
                // Lengths come from the plan itself and the imaginary parts were just cleared.
                unreachable!("lengths are the transform's own");
            }
        }
        for (x, row) in values.iter_mut().enumerate() {
            for (column, value) in row[start..start + block].iter_mut().enumerate() {
                *value = transformed[column * n_x + x];
            }
        }
    }
}

/// `to` is `from`, whose rows have `width` values, with rows and columns exchanged.
fn turn(from: &[Complex32], to: &mut [Complex32], width: usize) {
    let height = from.len() / width;
    for (row, values) in from.chunks(width).enumerate() {
        for (column, value) in values.iter().enumerate() {
            to[column * height + row] = *value;
        }
    }
}
