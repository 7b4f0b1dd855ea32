//! What Linux' control groups leave a process of memory: containers and jobs of clusters have less than their
//! machine.

use std::fs;
use std::path::{Path, PathBuf};

/// Files of a group in either version: its limit, what is used of it, and how that is made up, with the line
/// of what can be taken back at once.
const UNIFIED: [&str; 4] = ["memory.max", "memory.current", "memory.stat", "inactive_file"];
const LEGACY: [&str; 4] =
    ["memory.limit_in_bytes", "memory.usage_in_bytes", "memory.stat", "total_inactive_file"];

/// Memory (bytes) that the groups of a process, `groups` as in `/proc/self/cgroup`, and those above them let
/// it have beside what is in use; none without a limit. `root` is where groups are mounted.
pub(super) fn free_memory(root: &Path, groups: &str) -> Option<u64> {
    groups.lines().flat_map(|line| of_group(root, line)).min()
}

/// What the group of `line` (`NUMBER:CONTROLLERS:PATH`) and those above it leave.
fn of_group(root: &Path, line: &str) -> Vec<u64> {
    let mut parts = line.splitn(3, ':').skip(1);
    let (Some(controllers), Some(path)) = (parts.next(), parts.next()) else { return Vec::new() };
    let (mount, files) = if controllers.is_empty() {
        (root.to_owned(), UNIFIED)
    } else if controllers.split(',').any(|controller| controller == "memory") {
        (root.join("memory"), LEGACY)
    } else {
        return Vec::new();
    };
    // In a container the path may be the machine's, of which nothing is seen but the mount itself, its own.
    let path = Path::new(path.trim_start_matches('/'));
    let folders: Vec<PathBuf> = path.ancestors().map(|path| mount.join(path)).collect();
    folders.iter().filter_map(|folder| left_in(folder, files)).collect()
}

/// What the group in `folder` leaves; none where it has no limit.
fn left_in(folder: &Path, [limit, used, made_of, reclaimable]: [&str; 4]) -> Option<u64> {
    let text = |name: &str| fs::read_to_string(folder.join(name)).ok();
    // Without a limit it is `max`, or so large that no machine has it.
    let limit: u64 = text(limit)?.trim().parse().ok()?;
    let used: u64 = text(used)?.trim().parse().ok()?;
    let reclaimable = text(made_of).and_then(|text| {
        let lines = text.lines().map(|line| line.split_once(' ').unwrap_or((line, "")));
        lines.filter(|(name, _)| *name == reclaimable).find_map(|(_, bytes)| bytes.parse().ok())
    });
    Some(limit.saturating_sub(used.saturating_sub(reclaimable.unwrap_or(0))))
}

#[cfg(test)]
mod tests {
    use super::*;

    const MIB: u64 = 1 << 20;

    /// A mount of groups with these files.
    fn mount(files: &[(&str, String)]) -> tempfile::TempDir {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        root
    }

    fn line(bytes: u64) -> String {
        format!("{bytes}\n")
    }

    #[test]
    fn the_tightest_group_above_a_process_counts() {
        let root = mount(&[
            ("memory.stat", "anon 5\n".into()),
            ("jobs/memory.max", line(900 * MIB)),
            ("jobs/memory.current", line(500 * MIB)),
            ("jobs/memory.stat", format!("anon 1\ninactive_file {}\n", 100 * MIB)),
            ("jobs/17/memory.max", line(800 * MIB)),
            ("jobs/17/memory.current", line(100 * MIB)),
            ("jobs/17/step/memory.max", "max\n".into()),
            ("jobs/17/step/memory.current", line(90 * MIB)),
        ]);
        let free = |groups: &str| free_memory(root.path(), groups);
        assert_eq!(free("0::/jobs/17/step\n"), Some(500 * MIB));
        assert_eq!(free("0::/jobs/17\n"), Some(500 * MIB));
        assert_eq!(free("0::/elsewhere\n"), None);
        assert_eq!(free(""), None);
        assert_eq!(free("nonsense"), None);
    }

    #[test]
    fn a_container_of_the_first_version_is_seen_where_its_path_is_not() {
        let root = mount(&[
            ("memory/memory.limit_in_bytes", line(2000 * MIB)),
            ("memory/memory.usage_in_bytes", line(1500 * MIB)),
            (
                "memory/memory.stat",
                format!("inactive_file 7\ntotal_inactive_file {}\n", 1000 * MIB),
            ),
        ]);
        let groups = "12:cpu,cpuacct:/docker/abc\n11:memory:/docker/abc\n0::/docker/abc\n";
        assert_eq!(free_memory(root.path(), groups), Some(1500 * MIB));
        assert_eq!(free_memory(root.path(), "12:cpu:/docker/abc\n"), None);
    }

    #[test]
    fn a_group_that_is_full_leaves_nothing() {
        let root = mount(&[("memory.max", line(10 * MIB)), ("memory.current", line(11 * MIB))]);
        assert_eq!(free_memory(root.path(), "0::/"), Some(0));
    }
}
