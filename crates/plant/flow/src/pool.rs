//! Threads that stay, and one job at a time for all of them.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread::JoinHandle;

/// Turns spent watching for news before a thread goes to sleep.
const PATIENCE: usize = 4096;

type Job<'a> = dyn Fn(usize) + Sync + 'a;

/// `n_threads` threads, the caller among them.
pub(crate) struct Pool {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

struct Shared {
    /// Number of the job at hand; raised when a new one is ready.
    round: AtomicUsize,
    /// Threads still at work on it, the caller not counted.
    busy: AtomicUsize,
    board: Mutex<Board>,
    news: Condvar,
    done: Condvar,
}

#[derive(Default)]
struct Board {
    job: Option<Address>,
    stop: bool,
    panic: Option<Box<dyn std::any::Any + Send>>,
}

/// Address of the job, valid until the round's last thread has finished.
#[derive(Clone, Copy)]
struct Address(*const Job<'static>);

// SAFETY: the job behind it is `Sync`, and `run` outlives every use.
unsafe impl Send for Address {}

impl Pool {
    /// A pool of `n_threads` ≥ 1.
    pub(crate) fn new(n_threads: usize) -> Self {
        let shared = Arc::new(Shared {
            round: AtomicUsize::new(0),
            busy: AtomicUsize::new(0),
            board: Mutex::new(Board::default()),
            news: Condvar::new(),
            done: Condvar::new(),
        });
        let threads = (1..n_threads)
            .map(|index| {
                let shared = Arc::clone(&shared);
                std::thread::spawn(move || shared.serve(index))
            })
            .collect();
        Self { shared, threads }
    }

    /// Threads (–).
    pub(crate) fn n_threads(&self) -> usize {
        self.threads.len() + 1
    }

    /// Calls `job(thread)` once on every thread; returns when all have finished.
    ///
    /// # Panics
    /// When a thread's call does.
    pub(crate) fn run(&mut self, job: &Job<'_>) {
        let shared = &*self.shared;
        if self.threads.is_empty() {
            job(0);
            return;
        }
        shared.busy.store(self.threads.len(), Ordering::Relaxed);
        {
            let mut board = shared.board();
            // SAFETY: only the lifetime changes; this function does not return before every thread is done
            // with it.
            let job = unsafe {
                std::mem::transmute::<*const Job<'_>, *const Job<'static>>(std::ptr::from_ref(job))
            };
            board.job = Some(Address(job));
            shared.round.fetch_add(1, Ordering::Release);
            shared.news.notify_all();
        }
        let own = catch_unwind(AssertUnwindSafe(|| job(0)));
        shared.wait_for_others();
        let other = shared.board().panic.take();
        if let Some(panic) = own.err().or(other) {
            resume_unwind(panic);
        }
    }
}

impl Pool {
    /// Calls `job(first, chunk)` once for every chunk of `size` of `values`, the last one shorter; `first` is
    /// the place of its first value. Threads take the next chunk when they are done with one.
    ///
    /// # Panics
    /// When a call does.
    pub(crate) fn for_chunks<T: Send>(
        &mut self,
        values: &mut [T],
        size: usize,
        job: &(dyn Fn(usize, &mut [T]) + Sync),
    ) {
        let next = AtomicUsize::new(0);
        let (start, n) = (Start(values.as_mut_ptr()), values.len());
        let start = &start;
        self.run(&|_| {
            loop {
                let first = next.fetch_add(size, Ordering::Relaxed);
                if first >= n {
                    break;
                }
                // SAFETY: each chunk is taken by one thread, and `values` is borrowed until all are done.
                let chunk = unsafe {
                    std::slice::from_raw_parts_mut(start.0.add(first), size.min(n - first))
                };
                job(first, chunk);
            }
        });
    }
}

/// Where values begin that threads share among them.
struct Start<T>(*mut T);

// SAFETY: every thread writes to chunks of its own.
unsafe impl<T: Send> Sync for Start<T> {}

impl Drop for Pool {
    fn drop(&mut self) {
        {
            let mut board = self.shared.board();
            board.stop = true;
            self.shared.round.fetch_add(1, Ordering::Release);
            self.shared.news.notify_all();
        }
        for thread in self.threads.drain(..) {
            // A panic was already handed on by `run`.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    fn serve(&self, index: usize) {
        let mut seen = 0;
        loop {
            let Some(job) = self.wait_for_job(seen) else { return };
            seen = seen.wrapping_add(1);
            // SAFETY: `run` keeps the job alive until `busy` is zero, which is set below.
            let result = catch_unwind(AssertUnwindSafe(|| unsafe { (*job.0)(index) }));
            if let Err(panic) = result {
                self.board().panic = Some(panic);
            }
            if self.busy.fetch_sub(1, Ordering::AcqRel) == 1 {
                let _board = self.board();
                self.done.notify_all();
            }
        }
    }

    fn wait_for_job(&self, seen: usize) -> Option<Address> {
        for _ in 0..PATIENCE {
            if self.round.load(Ordering::Acquire) != seen {
                break;
            }
            std::hint::spin_loop();
        }
        let mut board = self.board();
        while self.round.load(Ordering::Acquire) == seen {
            board = self.news.wait(board).unwrap_or_else(std::sync::PoisonError::into_inner);
        }
        if board.stop { None } else { board.job }
    }

    fn wait_for_others(&self) {
        for _ in 0..PATIENCE {
            if self.busy.load(Ordering::Acquire) == 0 {
                return;
            }
            std::hint::spin_loop();
        }
        let mut board = self.board();
        while self.busy.load(Ordering::Acquire) != 0 {
            board = self.done.wait(board).unwrap_or_else(std::sync::PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_thread_works_on_every_job() {
        for n_threads in [1, 2, 5] {
            let mut pool = Pool::new(n_threads);
            let counts: Vec<AtomicUsize> = (0..n_threads).map(|_| AtomicUsize::new(0)).collect();
            for _ in 0..200 {
                pool.run(&|thread| {
                    counts[thread].fetch_add(1, Ordering::Relaxed);
                });
            }
            assert!(counts.iter().all(|count| count.load(Ordering::Relaxed) == 200));
        }
    }

    #[test]
    fn chunks_are_made_once_each() {
        for n_threads in [1, 3] {
            let mut values = vec![0; 101];
            Pool::new(n_threads).for_chunks(&mut values, 8, &|first, chunk| {
                for (k, value) in chunk.iter_mut().enumerate() {
                    *value += first + k;
                }
            });
            assert!(values.iter().enumerate().all(|(k, value)| k == *value));
        }
    }

    #[test]
    fn a_panic_reaches_the_caller_and_the_pool_lives_on() {
        let mut pool = Pool::new(3);
        let result = catch_unwind(AssertUnwindSafe(|| {
            pool.run(&|thread| assert!(thread != 2, "thread two"))
        }));
        assert!(result.is_err());
        let count = AtomicUsize::new(0);
        pool.run(&|_| {
            count.fetch_add(1, Ordering::Relaxed);
        });
        assert_eq!(count.load(Ordering::Relaxed), 3);
    }
}
