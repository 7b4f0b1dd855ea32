//! Work that is shared out to threads, one task after another: which thread does a task changes nothing in
//! it.

use std::sync::{Mutex, PoisonError};

/// Does `work` for each of `tasks` on `n_threads`, each with a state of its own from `begin`.
pub(crate) fn share<T: Send, S>(
    n_threads: usize,
    tasks: Vec<T>,
    begin: impl Fn() -> S + Sync,
    work: impl Fn(&mut S, T) + Sync,
) {
    let n_threads = n_threads.min(tasks.len());
    if n_threads <= 1 {
        let mut state = begin();
        tasks.into_iter().for_each(|task| work(&mut state, task));
        return;
    }
    let queue = Mutex::new(tasks.into_iter());
    let next = || queue.lock().unwrap_or_else(PoisonError::into_inner).next();
    let serve = || {
        let mut state = begin();
        while let Some(task) = next() {
            work(&mut state, task);
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..n_threads {
            scope.spawn(serve);
        }
        serve();
    });
}

/// Threads to work on: `asked`, or as many as the machine has where that is 0.
pub(crate) fn number(asked: usize) -> usize {
    match asked {
        0 => std::thread::available_parallelism().map_or(1, |n| n.get()),
        asked => asked,
    }
}
