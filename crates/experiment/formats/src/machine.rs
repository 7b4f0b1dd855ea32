//! What this machine has to offer, and what of it a process took.

use std::fs;

/// Memory (bytes) that can be had without swapping; none where the system does not report it.
pub fn free_memory() -> Option<u64> {
    amount(&fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable:")
}

/// Most memory (bytes) that this process has held at once; none where the system does not report it.
pub fn peak_memory() -> Option<u64> {
    peak_of("self")
}

/// The same of the process numbered `id`; none, too, once that has ended.
pub fn peak_memory_of(id: u32) -> Option<u64> {
    peak_of(&id.to_string())
}

fn peak_of(process: &str) -> Option<u64> {
    // The high-water mark of what is resident.
    amount(&fs::read_to_string(format!("/proc/{process}/status")).ok()?, "VmHWM:")
}

/// The amount (bytes) on the line of `text` that begins with `label`.
fn amount(text: &str, label: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(label))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kibibytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_line_that_tells() {
        let meminfo =
            "MemTotal:       24000000 kB\nMemFree:  1000 kB\nMemAvailable:   23000000 kB\n";
        assert_eq!(amount(meminfo, "MemAvailable:"), Some(23_000_000 * 1024));
        assert_eq!(amount("MemTotal: 1 kB\n", "MemAvailable:"), None);
        assert_eq!(amount("MemAvailable: many kB\n", "MemAvailable:"), None);
        let status =
            "Name:\twakemix\nVmPeak:\t  300000 kB\nVmHWM:\t  120000 kB\nVmRSS:\t   90000 kB\n";
        assert_eq!(amount(status, "VmHWM:"), Some(120_000 * 1024));
    }

    #[test]
    fn a_peak_outlives_what_made_it() {
        // Where the system tells nothing there is nothing to compare.
        if peak_memory().is_none() {
            return;
        }
        drop(std::hint::black_box(vec![1_u8; 64 << 20]));
        // The system counts pages a little behind time.
        let least = 48 << 20;
        for peak in [peak_memory(), peak_memory_of(std::process::id())] {
            assert!(peak.is_some_and(|peak| peak >= least), "{peak:?}");
        }
    }
}
