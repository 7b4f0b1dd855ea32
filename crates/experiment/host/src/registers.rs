//! Rounding and flushing as they were: a library that is compiled for speed may switch denormal numbers off
//! for the whole thread, and with them bits of the simulation.

/// The control register of floating-point arithmetic, put back when it goes.
pub(crate) struct Registers {
    #[cfg(target_arch = "x86_64")]
    control: u32,
}

#[cfg(target_arch = "x86_64")]
impl Registers {
    /// As they are now.
    pub(crate) fn kept() -> Self {
        let mut control = 0_u32;
        // SAFETY: the instruction stores the register into the four bytes that it is given.
        unsafe {
            std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut control, options(nostack, preserves_flags));
        }
        Self { control }
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for Registers {
    fn drop(&mut self) {
        // SAFETY: the register gets a value that it had.
        unsafe {
            std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const self.control, options(nostack, preserves_flags));
        }
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Registers {
    /// Nothing to be kept.
    pub(crate) fn kept() -> Self {
        Self {}
    }
}
