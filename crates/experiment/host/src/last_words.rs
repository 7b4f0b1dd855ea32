//! What is told when a library takes the program along: it crashes, or ends the process.
//!
//! Nobody can catch either. But whose library it was can still be written, and that is all that is done in
//! the handlers: signals then take their usual course.

use std::cell::Cell;
use std::ptr;
use std::sync::Once;

/// Signals of a crash.
const SIGNALS: [libc::c_int; 5] =
    [libc::SIGSEGV, libc::SIGBUS, libc::SIGILL, libc::SIGFPE, libc::SIGABRT];

/// Exit code of a process that a library has ended: that of a run that broke down.
const ENDED: libc::c_int = 3;

thread_local! {
    /// Text for the crash of the library that this thread is in; none outside of libraries.
    static WORDS: Cell<Option<&'static [u8]>> = const { Cell::new(None) };
}

/// Handlers as they were before ours.
static mut BEFORE: [Option<libc::sigaction>; SIGNALS.len()] = [None; SIGNALS.len()];

/// As long as it lives, the thread is in a library.
pub(crate) struct Within;

impl Within {
    /// Should the library end the process, `words` are written.
    pub(crate) fn library(words: &'static [u8]) -> Self {
        WORDS.set(Some(words));
        Self
    }
}

impl Drop for Within {
    fn drop(&mut self) {
        WORDS.set(None);
    }
}

/// Installs the handlers, once in a process.
pub(crate) fn install() {
    static INSTALLED: Once = Once::new();
    INSTALLED.call_once(|| {
        for (index, signal) in SIGNALS.into_iter().enumerate() {
            // SAFETY: all-zero bytes are a sigaction; nobody else writes BEFORE, and handlers read it only
            // for signals whose handler is installed after it is written.
            unsafe {
                let mut before: libc::sigaction = std::mem::zeroed();
                if libc::sigaction(signal, ptr::null(), &raw mut before) != 0 {
                    continue;
                }
                BEFORE[index] = Some(before);
                let mut own: libc::sigaction = std::mem::zeroed();
                own.sa_sigaction = on_signal as *const () as usize;
                own.sa_flags = libc::SA_SIGINFO | libc::SA_ONSTACK;
                libc::sigemptyset(&raw mut own.sa_mask);
                libc::sigaction(signal, &raw const own, ptr::null_mut());
            }
        }
        // SAFETY: the function may be called at any exit of the process.
        unsafe { libc::atexit(on_exit) };
    });
}

extern "C" fn on_signal(signal: libc::c_int, _: *mut libc::siginfo_t, _: *mut libc::c_void) {
    if let Some(words) = WORDS.get() {
        write(words);
    }
    let Some(index) = SIGNALS.iter().position(|own| *own == signal) else { return };
    // SAFETY: see `install`. The instruction that failed runs again, and meets who handled it before.
    unsafe {
        let before = &raw const BEFORE[index];
        if let Some(before) = &*before {
            libc::sigaction(signal, before, ptr::null_mut());
        }
    }
}

extern "C" fn on_exit() {
    if let Some(words) = WORDS.get() {
        write(words);
        // SAFETY: ends the process at once; a library's `STOP` is no success.
        unsafe { libc::_exit(ENDED) };
    }
}

fn write(words: &[u8]) {
    // SAFETY: the bytes are valid for their length; `write` may be called in signal handlers.
    unsafe { libc::write(libc::STDERR_FILENO, words.as_ptr().cast(), words.len()) };
}
