//! What the machine can do, measured beside what a solver does with it.

use std::sync::Barrier;
use std::time::Instant;

/// Best rate of reading and writing back an array in place (bytes/s, both directions counted), on `n_threads`
/// threads.
///
/// `mebibytes` is the array's size, many times that of the caches; `n_repeats` runs are made and the best one
/// counts.
pub fn in_place_bandwidth(n_threads: usize, mebibytes: usize, n_repeats: usize) -> f64 {
    let n = (mebibytes * (1 << 20) / size_of::<f32>()).next_multiple_of(n_threads);
    let mut array = HugeArray::new(n);
    let share = n / n_threads;
    let barrier = Barrier::new(n_threads);
    let origin = Instant::now();
    // Start and end of each thread's part of each repeat (s).
    let mut spans = vec![vec![(0.0, 0.0); n_repeats]; n_threads];
    std::thread::scope(|scope| {
        for (chunk, spans) in array.values().chunks_mut(share).zip(&mut spans) {
            let barrier = &barrier;
            scope.spawn(move || {
                chunk.fill(1.0);
                for span in spans {
                    barrier.wait();
                    span.0 = origin.elapsed().as_secs_f64();
                    for value in chunk.iter_mut() {
                        *value = *value * 0.999 + 0.001;
                    }
                    span.1 = origin.elapsed().as_secs_f64();
                }
            });
        }
    });
    let best = (0..n_repeats)
        .map(|repeat| {
            let spans = spans.iter().map(|spans| spans[repeat]);
            let (start, end) =
                spans.fold((f64::INFINITY, 0.0_f64), |(s, e), (a, b)| (s.min(a), e.max(b)));
            end - start
        })
        .fold(f64::INFINITY, f64::min);
    2.0 * (n * size_of::<f32>()) as f64 / best
}

/// Zeroed values on huge pages where the system gives them, as the solver's own.
struct HugeArray {
    values: Vec<f32>,
}

impl HugeArray {
    fn new(n: usize) -> Self {
        let values = vec![0.0; n];
        #[cfg(target_os = "linux")]
        // SAFETY: advice on whole pages inside an allocation that lives on.
        unsafe {
            const PAGE: usize = 4096;
            let start = (values.as_ptr() as usize).next_multiple_of(PAGE);
            let end = (values.as_ptr() as usize + size_of_val(&values[..])) / PAGE * PAGE;
            libc::madvise(start as *mut libc::c_void, end - start, libc::MADV_HUGEPAGE);
        }
        Self { values }
    }

    fn values(&mut self) -> &mut [f32] {
        &mut self.values
    }
}
