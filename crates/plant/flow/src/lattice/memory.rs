//! Zeroed memory for the populations, on huge pages where the system gives them.

use std::ptr::NonNull;

/// Alignment of the first value (bytes): a cache line.
const ALIGNMENT: usize = 64;

/// A zeroed array of `f32` that threads write into by address.
pub(crate) struct Memory {
    start: NonNull<f32>,
    n_values: usize,
}

// SAFETY: the array is plain data; who writes where is the business of the sweep, which documents it.
unsafe impl Send for Memory {}
// SAFETY: as above.
unsafe impl Sync for Memory {}

impl Memory {
    /// `n_values` zeros, or nothing when the system refuses.
    pub(crate) fn zeroed(n_values: usize) -> Option<Self> {
        let bytes = n_values.checked_mul(size_of::<f32>())?.max(ALIGNMENT);
        system::map(bytes).map(|start| Self { start, n_values })
    }

    /// Address of the first value.
    pub(crate) fn start(&self) -> *mut f32 {
        self.start.as_ptr()
    }

    /// All values.
    pub(crate) fn values(&self) -> &[f32] {
        // SAFETY: mapped, zeroed, and as long as asked; callers hold the solver, so no sweep is running.
        unsafe { std::slice::from_raw_parts(self.start.as_ptr(), self.n_values) }
    }

    /// All values, to be overwritten.
    pub(crate) fn values_mut(&mut self) -> &mut [f32] {
        // SAFETY: as for `values`, and borrowed exclusively.
        unsafe { std::slice::from_raw_parts_mut(self.start.as_ptr(), self.n_values) }
    }

    /// Size (bytes).
    pub(crate) fn bytes(&self) -> usize {
        self.n_values * size_of::<f32>()
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        system::unmap(self.start, self.bytes().max(ALIGNMENT));
    }
}

#[cfg(unix)]
mod system {
    use std::ptr::{NonNull, null_mut};

    pub(super) fn map(bytes: usize) -> Option<NonNull<f32>> {
        // The system promises more than it has and ends the program later; ask first.
        if installed().is_some_and(|installed| bytes > installed) {
            return None;
        }
        // SAFETY: an anonymous private mapping; the result is checked.
        let start = unsafe {
            libc::mmap(
                null_mut(),
                bytes,
                libc::PROT_READ | libc::PROT_WRITE,
                libc::MAP_PRIVATE | libc::MAP_ANONYMOUS,
                -1,
                0,
            )
        };
        if start == libc::MAP_FAILED {
            return None;
        }
        // Advice only: without huge pages the sweep runs a third slower, not differently.
        #[cfg(target_os = "linux")]
        // SAFETY: the range was just mapped.
        unsafe {
            libc::madvise(start, bytes, libc::MADV_HUGEPAGE);
        }
        NonNull::new(start.cast())
    }

    /// Memory of the machine (bytes), when the system tells.
    fn installed() -> Option<usize> {
        // SAFETY: plain queries.
        let (pages, size) =
            unsafe { (libc::sysconf(libc::_SC_PHYS_PAGES), libc::sysconf(libc::_SC_PAGESIZE)) };
        usize::try_from(pages).ok()?.checked_mul(usize::try_from(size).ok()?)
    }

    pub(super) fn unmap(start: NonNull<f32>, bytes: usize) {
        // SAFETY: mapped by `map` with the same length, and not used after.
        unsafe {
            libc::munmap(start.as_ptr().cast(), bytes);
        }
    }
}

#[cfg(not(unix))]
mod system {
    use super::ALIGNMENT;
    use std::alloc::{Layout, alloc_zeroed, dealloc};
    use std::ptr::NonNull;

    pub(super) fn map(bytes: usize) -> Option<NonNull<f32>> {
        let layout = Layout::from_size_align(bytes, ALIGNMENT).ok()?;
        // SAFETY: the layout is not empty.
        NonNull::new(unsafe { alloc_zeroed(layout) }.cast())
    }

    pub(super) fn unmap(start: NonNull<f32>, bytes: usize) {
        if let Ok(layout) = Layout::from_size_align(bytes, ALIGNMENT) {
            // SAFETY: allocated by `map` with the same layout.
            unsafe { dealloc(start.as_ptr().cast(), layout) }
        }
    }
}
