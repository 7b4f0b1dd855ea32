//! What the system gives of a file: from its memory, and from the disk.

use std::fs::File;
use std::hint::black_box;
use std::io::Read;
use std::path::Path;
use std::time::Instant;

/// Bytes read at a time from memory, and from the disk.
const FROM_MEMORY: usize = 1 << 20;
const FROM_DISK: usize = 16 << 20;
/// What the disk wants buffers to be aligned to.
const ALIGNED: usize = 4096;

/// Seconds that `work` takes.
pub fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// Reads all of the file at `path` as any program does, and looks at none of it.
///
/// # Panics
/// Where it cannot be read.
pub fn read(path: &Path) {
    let mut file = File::open(path).expect("the bench's own file");
    let mut bytes = vec![0; FROM_MEMORY];
    while file.read(&mut bytes).expect("the bench's own file") > 0 {
        black_box(&bytes);
    }
}

/// Reads all of the file at `path` past the system's memory, in large pieces one after the other: the most
/// that a program without threads gets from a disk. False where the system does not offer it.
///
/// # Panics
/// Where it cannot be read.
pub fn read_directly(path: &Path) -> bool {
    #[cfg(target_os = "linux")]
    {
        use std::os::unix::fs::OpenOptionsExt;
        let opened = File::options().read(true).custom_flags(libc::O_DIRECT).open(path);
        let Ok(mut file) = opened else { return false };
        let mut bytes = vec![0; FROM_DISK + ALIGNED];
        let start = bytes.as_ptr().align_offset(ALIGNED);
        let piece = &mut bytes[start..start + FROM_DISK];
        // The end of a file is read less a piece of a block, which leaves the place at odds with the disk.
        while file.read(piece).expect("the bench's own file") == FROM_DISK {
            black_box(&piece);
        }
        true
    }
    #[cfg(not(target_os = "linux"))]
    {
        let _ = (path, FROM_DISK, ALIGNED);
        false
    }
}

/// On return the system has little of the file at `path` in its memory, as far as it takes advice.
///
/// # Panics
/// Where the file cannot be opened.
pub fn forget(path: &Path) {
    let file = File::open(path).expect("the bench's own file");
    file.sync_all().expect("a disk");
    #[cfg(target_os = "linux")]
    {
        use std::os::fd::AsRawFd;
        // SAFETY: the descriptor is open; the advice is about its pages alone.
        let _ = unsafe { libc::posix_fadvise(file.as_raw_fd(), 0, 0, libc::POSIX_FADV_DONTNEED) };
    }
}

/// Most memory that this process had since [`begin_peak`] (bytes); none where the system does not tell.
pub fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? << 10)
}

/// What memory this process has had so far does not count in [`peak`] any more.
pub fn begin_peak() {
    // Where the system does not offer it, the peak is that since the start.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}
