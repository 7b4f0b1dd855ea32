//! How many vector instructions this machine works out in a second: the limit that a kernel in the caches is
//! held against.
//!
//! No load and no store: chains of sums, products and both at once, as many side by side as hide how long
//! each takes. What a mixture of them reaches differs from machine to machine, so that several are tried, and
//! the fastest counts.

use std::hint::black_box;
use std::time::Instant;

/// Vectors of single precision that the widest instructions here work on at once (–), and how many of these a
/// thread works out in a second.
#[derive(Clone, Copy, Debug)]
pub struct Limit {
    /// Values in a vector.
    pub lanes: usize,
    /// Instructions a second (1/s).
    pub rate: f64,
}

/// Chains side by side, and rounds of a trial.
const N_CHAINS: usize = 16;
const N_ROUNDS: usize = 2_000_000;
const N_TRIALS: usize = 5;

/// The limit of one thread; none where this machine has neither AVX-512 nor AVX2.
pub fn limit() -> Option<Limit> {
    #[cfg(target_arch = "x86_64")]
    {
        let fastest = |work: &dyn Fn(usize), lanes: usize| {
            let rate = |share: usize| {
                let started = Instant::now();
                work(share);
                (N_CHAINS * N_ROUNDS) as f64 / started.elapsed().as_secs_f64()
            };
            let trials = (0..N_TRIALS).flat_map(|_| [0, 2, 4, 8]).map(rate);
            Limit { lanes, rate: trials.fold(0.0, f64::max) }
        };
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the instructions were found.
            return Some(fastest(&|share| unsafe { x86::chains512(share) }, 16));
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: as above.
            return Some(fastest(&|share| unsafe { x86::chains256(share) }, 8));
        }
    }
    None
}

/// Double-precision operations of threads in registers, a sum of a product counting for two.
#[derive(Clone, Copy, Debug)]
pub struct DoubleLimit {
    /// Of all threads together in a second (1/s), the fastest of some trials.
    pub rate: f64,
    /// In a second of one processor's time (1/s), all trials: neighbours of the machine take none of it.
    pub rate_of_processor: f64,
}

/// Processor time of all threads of this process so far (s).
pub fn processor_seconds() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the time is there to be written to.
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// The limit of `n_threads`; none where this machine has neither AVX-512 nor AVX2.
pub fn double_limit(n_threads: usize) -> Option<DoubleLimit> {
    #[cfg(target_arch = "x86_64")]
    {
        let together = |work: fn(), lanes: usize| {
            let done = (2 * lanes * N_CHAINS * N_ROUNDS * n_threads) as f64;
            let processor = processor_seconds();
            let rate = |_| {
                let started = Instant::now();
                std::thread::scope(|scope| {
                    for _ in 0..n_threads {
                        scope.spawn(work);
                    }
                });
                done / started.elapsed().as_secs_f64()
            };
            let rate = (0..N_TRIALS).map(rate).fold(0.0, f64::max);
            let rate_of_processor = N_TRIALS as f64 * done / (processor_seconds() - processor);
            DoubleLimit { rate, rate_of_processor }
        };
        if is_x86_feature_detected!("avx512f") {
            // SAFETY: the instructions were found.
            return Some(together(|| unsafe { x86::doubles512(0) }, 8));
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            // SAFETY: as above.
            return Some(together(|| unsafe { x86::doubles256(0) }, 4));
        }
    }
    let _ = n_threads;
    None
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use super::{N_CHAINS, N_ROUNDS, black_box};
    use std::arch::x86_64::*;

    macro_rules! chains {
        ($name:ident, $features:literal, $vector:ty, $splat:ident, $fmadd:ident, $add:ident) => {
            /// [`N_ROUNDS`] of all chains, one in `share` of them sums and the others sums of products; with
            /// 0 all are these.
            ///
            /// # Safety
            /// On a machine with the instructions.
            #[target_feature(enable = $features)]
            pub(super) unsafe fn $name(share: usize) {
                match share {
                    2 => rounds::<2>(),
                    4 => rounds::<4>(),
                    8 => rounds::<8>(),
                    _ => rounds::<{ N_CHAINS + 1 }>(),
                }

                #[target_feature(enable = $features)]
                fn rounds<const SHARE: usize>() {
                    let (factor, addend) = (black_box($splat(0.999)), black_box($splat(1e-3)));
                    let mut chains: [$vector; N_CHAINS] = [$splat(1.0); N_CHAINS];
                    for _ in 0..N_ROUNDS {
                        for (k, chain) in chains.iter_mut().enumerate() {
                            *chain = if k % SHARE == SHARE - 1 {
                                $add(*chain, addend)
                            } else {
                                $fmadd(*chain, factor, addend)
                            };
                        }
                    }
                    black_box(chains);
                }
            }
        };
    }

    chains!(chains512, "avx512f", __m512, _mm512_set1_ps, _mm512_fmadd_ps, _mm512_add_ps);
    chains!(chains256, "avx2,fma", __m256, _mm256_set1_ps, _mm256_fmadd_ps, _mm256_add_ps);
    chains!(doubles512, "avx512f", __m512d, _mm512_set1_pd, _mm512_fmadd_pd, _mm512_add_pd);
    chains!(doubles256, "avx2,fma", __m256d, _mm256_set1_pd, _mm256_fmadd_pd, _mm256_add_pd);
}
