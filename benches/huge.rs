//! Memory as the solver holds it.

/// Zeroed values on huge pages where the system gives them, as the solver's own.
pub(crate) struct HugeArray {
    values: Vec<f32>,
}

impl HugeArray {
    pub(crate) fn new(n: usize) -> Self {
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

    pub(crate) fn values(&mut self) -> &mut [f32] {
        &mut self.values
    }
}
