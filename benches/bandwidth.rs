//! How fast this machine reads values and writes them back in place: the limit that a kernel in memory is
//! held against.
//!
//! One loop is no limit: wider vectors, more streams and prefetching each change what a machine gives, and
//! differently on each. So a set of loops is tried on memory as the solver holds it (huge pages, skewed
//! streams), and the fastest of them are run again around every figure.

use crate::huge::HugeArray;
use std::sync::Barrier;
use std::time::Instant;

/// Values in a cache line.
const LINE: usize = 16;
/// Values in a page, and what each stream is shifted by against it, as in the solver.
const PAGE: usize = 1024;
const SKEW: usize = 3 * LINE;

/// Width of the vectors of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Whatever the compiler makes of plain Rust for any machine.
    Plain,
    /// 256 bits.
    Avx2,
    /// 512 bits.
    Avx512,
}

impl Width {
    fn is_available(self) -> bool {
        match self {
            Self::Plain => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"),
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => is_x86_feature_detected!("avx512f"),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 | Self::Avx512 => false,
        }
    }
}

/// One loop that reads an array and writes it back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Loop {
    /// Vectors that it works with.
    pub width: Width,
    /// Streams that it reads and writes side by side.
    pub n_streams: usize,
    /// Cache lines that it prefetches ahead; 0 leaves that to the machine.
    pub lines_ahead: usize,
}

impl Loop {
    /// All loops that this machine can run.
    fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for width in [Width::Plain, Width::Avx2, Width::Avx512] {
            for n_streams in [1, 2, 4, 8, 19] {
                for lines_ahead in [0, 4, 8, 16, 32] {
                    all.push(Self { width, n_streams, lines_ahead });
                }
            }
        }
        all.retain(|one| one.width.is_available());
        all
    }

    /// Reads and writes back `n` values of each stream; streams lie `stride` values apart from `start`.
    ///
    /// # Safety
    /// All of that is one array, `n` is a multiple of a line, `start` is aligned to one, and `stride` too.
    unsafe fn run(self, start: *mut f32, stride: usize, n: usize) {
        // SAFETY: handed through; the width was found on this machine.
        unsafe {
            match self.width {
                Width::Plain => plain(self, start, stride, n),
                #[cfg(target_arch = "x86_64")]
                Width::Avx2 => x86::avx2(self, start, stride, n),
                #[cfg(target_arch = "x86_64")]
                Width::Avx512 => x86::avx512(self, start, stride, n),
                #[cfg(not(target_arch = "x86_64"))]
                Width::Avx2 | Width::Avx512 => plain(self, start, stride, n),
            }
        }
    }
}

/// The loop in plain Rust.
unsafe fn plain(how: Loop, start: *mut f32, stride: usize, n: usize) {
    for first in (0..n).step_by(LINE) {
        for stream in 0..how.n_streams {
            // SAFETY: as `Loop::run` asks.
            let line = unsafe { &mut *start.add(stream * stride + first).cast::<[f32; LINE]>() };
            prefetch(line.as_ptr().wrapping_add(how.lines_ahead * LINE), how.lines_ahead);
            for value in line {
                *value = *value * 0.999 + 0.001;
            }
        }
    }
}

#[inline(always)]
fn prefetch(address: *const f32, lines_ahead: usize) {
    #[cfg(target_arch = "x86_64")]
    if lines_ahead > 0 {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: reads nothing, whatever the address.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast()) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (address, lines_ahead);
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{LINE, Loop, prefetch};
    use std::arch::x86_64::*;

    #[target_feature(enable = "avx2,fma")]
    pub(super) unsafe fn avx2(how: Loop, start: *mut f32, stride: usize, n: usize) {
        let (factor, addend) = (_mm256_set1_ps(0.999), _mm256_set1_ps(0.001));
        for first in (0..n).step_by(LINE) {
            for stream in 0..how.n_streams {
                // SAFETY: as `Loop::run` asks.
                unsafe {
                    let place = start.add(stream * stride + first);
                    prefetch(place.wrapping_add(how.lines_ahead * LINE), how.lines_ahead);
                    for half in [place, place.add(8)] {
                        _mm256_store_ps(
                            half,
                            _mm256_fmadd_ps(_mm256_load_ps(half), factor, addend),
                        );
                    }
                }
            }
        }
    }

    #[target_feature(enable = "avx512f")]
    pub(super) unsafe fn avx512(how: Loop, start: *mut f32, stride: usize, n: usize) {
        let (factor, addend) = (_mm512_set1_ps(0.999), _mm512_set1_ps(0.001));
        for first in (0..n).step_by(LINE) {
            for stream in 0..how.n_streams {
                // SAFETY: as `Loop::run` asks.
                unsafe {
                    let place = start.add(stream * stride + first);
                    prefetch(place.wrapping_add(how.lines_ahead * LINE), how.lines_ahead);
                    _mm512_store_ps(place, _mm512_fmadd_ps(_mm512_load_ps(place), factor, addend));
                }
            }
        }
    }
}

/// What memory gives `n_threads` threads, found by the fastest of all loops.
pub struct Limit {
    n_threads: usize,
    mebibytes: usize,
    /// The fastest loops of the trial, with the rates found in it (bytes/s), the fastest first.
    pub loops: Vec<(Loop, f64)>,
}

/// Loops that are run again around every figure.
const KEPT: usize = 4;

impl Limit {
    /// Tries all loops on `mebibytes` of memory, each `n_repeats` times, and keeps the fastest.
    pub fn find(n_threads: usize, mebibytes: usize, n_repeats: usize) -> Self {
        let mut loops: Vec<_> = Loop::all()
            .into_iter()
            .map(|one| (one, rate(one, n_threads, mebibytes, n_repeats)))
            .collect();
        loops.sort_by(|a, b| b.1.total_cmp(&a.1));
        loops.truncate(KEPT);
        Self { n_threads, mebibytes, loops }
    }

    /// Best rate of the loops kept, now (bytes/s, both directions counted).
    pub fn now(&self, n_repeats: usize) -> f64 {
        let rates =
            self.loops.iter().map(|(one, _)| rate(*one, self.n_threads, self.mebibytes, n_repeats));
        rates.fold(0.0, f64::max)
    }
}

/// Best rate of `how` on `n_threads` threads with `mebibytes` of memory in all (bytes/s, both directions).
fn rate(how: Loop, n_threads: usize, mebibytes: usize, n_repeats: usize) -> f64 {
    let share = mebibytes * (1 << 20) / size_of::<f32>() / n_threads;
    let n = share / how.n_streams / PAGE * PAGE;
    let stride = n + SKEW;
    let mut arrays: Vec<_> =
        (0..n_threads).map(|_| HugeArray::new(stride * how.n_streams + LINE)).collect();
    let barrier = Barrier::new(n_threads);
    let origin = Instant::now();
    // Start and end of each thread's part of each repeat (s).
    let mut spans = vec![vec![(0.0, 0.0); n_repeats]; n_threads];
    std::thread::scope(|scope| {
        for (array, spans) in arrays.iter_mut().zip(&mut spans) {
            let barrier = &barrier;
            scope.spawn(move || {
                let values = array.values();
                values.fill(1.0);
                let start = values.as_mut_ptr();
                // The first value on a cache line.
                let start = start.wrapping_add(start.align_offset(LINE * size_of::<f32>()));
                for span in spans {
                    barrier.wait();
                    span.0 = origin.elapsed().as_secs_f64();
                    // SAFETY: the array is a line longer than all streams, the start is aligned.
                    unsafe { how.run(start, stride, n) };
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
    2.0 * (n * how.n_streams * n_threads * size_of::<f32>()) as f64 / best
}
