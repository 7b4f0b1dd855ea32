//! What this machine has to offer, and what of it a process took.

mod control_groups;

use std::fs;
use std::path::Path;

/// Memory (bytes) that this process can have without swapping: what is free on the machine, or less where a
/// control group, such as that of a container or of a job on a cluster, allows less. None where the system
/// does not tell.
pub fn free_memory() -> Option<u64> {
    let machine = fs::read_to_string("/proc/meminfo").ok();
    let machine = machine.and_then(|text| amount(&text, "MemAvailable:"));
    let groups = fs::read_to_string("/proc/self/cgroup").ok();
    let allowed =
        groups.and_then(|groups| control_groups::free_memory(Path::new("/sys/fs/cgroup"), &groups));
    [machine, allowed].into_iter().flatten().min()
}

/// Free space (bytes) for this user on the disk that holds `path`, or will hold it; none where the system
/// does not tell.
#[cfg(unix)]
pub fn free_disk(path: &Path) -> Option<u64> {
    // Of a path that is not there yet, the nearest folder that is.
    let path = std::path::absolute(path).ok()?;
    let there = path.ancestors().find(|path| path.exists())?;
    let disk = rustix::fs::statvfs(there).ok()?;
    disk.f_bavail.checked_mul(disk.f_frsize)
}

/// Free space (bytes) on the disk that holds `path`: this system does not tell.
#[cfg(not(unix))]
pub fn free_disk(_path: &Path) -> Option<u64> {
    None
}

/// Name of this machine; empty where the system does not tell.
pub fn host() -> String {
    let name = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
    name.trim().to_owned()
}

/// Whether `path` is on a file system that several machines share, as far as the system tells: there a
/// database cannot use shared memory.
#[cfg(target_os = "linux")]
pub fn is_shared(path: &Path) -> bool {
    /// NFS, SMB, SMB2, Lustre, GPFS, BeeGFS, Ceph, FUSE, 9P, AFS, by the numbers that Linux gives them.
    const SHARED: [u32; 10] = [
        0x6969,
        0x517b,
        0xfe53_4d42,
        0x0bd0_0bd0,
        0x4750_4653,
        0x1983_0326,
        0x00c3_6400,
        0x6573_5546,
        0x0102_1997,
        0x5346_414f,
    ];
    rustix::fs::statfs(path).is_ok_and(|system| SHARED.contains(&(system.f_type as u32)))
}

/// Whether `path` is on a file system that several machines share: this system does not tell.
#[cfg(not(target_os = "linux"))]
pub fn is_shared(_path: &Path) -> bool {
    false
}

/// Bytes of all files in the folder `path` and those in it; 0 where there is none.
pub fn size_of_folder(path: &Path) -> u64 {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let size = |entry: fs::DirEntry| match entry.metadata() {
        Ok(metadata) if metadata.is_dir() => size_of_folder(&entry.path()),
        Ok(metadata) => metadata.len(),
        Err(_) => 0,
    };
    entries.map(size).sum()
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
    fn the_free_disk_is_that_of_the_nearest_folder() {
        let folder = tempfile::tempdir().unwrap();
        let [here, below] = [folder.path().to_owned(), folder.path().join("not/there/yet")]
            .map(|path| free_disk(&path));
        if !cfg!(unix) {
            assert_eq!([here, below], [None, None]);
            return;
        }
        // Others write meanwhile.
        let (here, below) = (here.unwrap() as f64, below.unwrap() as f64);
        assert!(here > 0.0 && (below / here - 1.0).abs() < 0.1, "{here} {below}");
    }

    #[test]
    fn a_folder_is_as_large_as_its_files() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("planes")).unwrap();
        fs::write(folder.path().join("a"), [1; 700]).unwrap();
        fs::write(folder.path().join("planes/b"), [1; 33]).unwrap();
        assert_eq!(size_of_folder(folder.path()), 733);
        assert_eq!(size_of_folder(&folder.path().join("none")), 0);
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
