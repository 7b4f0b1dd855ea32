//! Who may import whom: the tables of ARCHITECTURE.md against the manifests.

use super::exceptions::Exceptions;
use super::{Finding, room, unused};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

const MAP: &str = "ARCHITECTURE.md";

/// What the map says about rooms, for the checks of their sources.
#[derive(Debug, Default)]
pub(super) struct Rules {
    /// Folder of each room.
    pub(super) folders: BTreeMap<String, PathBuf>,
    /// Rooms that may do what the key says, such as `open files`.
    pub(super) permits: BTreeMap<String, BTreeSet<String>>,
    /// Manifest and name of dependencies that no source uses.
    pub(super) unused: BTreeSet<(PathBuf, String)>,
}

impl Rules {
    /// The room that `file` lies in.
    pub(super) fn room_of(&self, file: &Path) -> Option<&str> {
        self.folders
            .iter()
            .find(|(_, folder)| file.starts_with(folder))
            .map(|(room, _)| room.as_str())
    }
}

struct Row {
    line: usize,
    room: String,
    folder: String,
    imports: BTreeSet<String>,
}

/// Checks every manifest against the map, and the map against the folders.
pub(super) fn check(
    root: &Path,
    exceptions: &Exceptions,
    findings: &mut Vec<Finding>,
) -> io::Result<Rules> {
    let map = fs::read_to_string(root.join(MAP))?;
    let (rows, permits) = read_map(&map);
    let rooms: BTreeSet<&str> = rows.iter().map(|row| row.room.as_str()).collect();
    let mut report = |file: &Path, line, message| {
        findings.push(Finding { file: file.to_owned(), line, message });
    };
    if rows.is_empty() {
        report(Path::new(MAP), None, "no table `room | folder | may import`".to_owned());
    }
    let members = members(root)?;
    for row in &rows {
        if !members.contains(&row.folder) {
            let message = format!(
                "stale row: {} names {}, which is no member of the workspace",
                row.room, row.folder
            );
            report(Path::new(MAP), Some(row.line), message);
            continue;
        }
        for unknown in row.imports.iter().filter(|import| !rooms.contains(import.as_str())) {
            let message = format!("{} may import {unknown}, which is no room", row.room);
            report(Path::new(MAP), Some(row.line), message);
        }
    }
    for member in &members {
        if !rows.iter().any(|row| row.folder == *member) {
            report(Path::new(MAP), None, format!("no row for {member}"));
        }
    }
    for (permit, permitted) in &permits {
        for unknown in permitted.iter().filter(|room| !rooms.contains(room.as_str())) {
            let message = format!("`{permit}` names {unknown}, which is no room");
            report(Path::new(MAP), None, message);
        }
    }
    let mut unused = BTreeSet::new();
    for row in rows.iter().filter(|row| members.contains(&row.folder)) {
        unused.extend(check_manifest(root, row, &rooms, exceptions, findings)?);
    }
    let folders = rows.into_iter().map(|row| (row.room, PathBuf::from(row.folder))).collect();
    Ok(Rules { folders, permits, unused })
}

/// Checks the manifest of `row` against what it may import and against its sources; gives manifest and name
/// of what no source uses.
fn check_manifest(
    root: &Path,
    row: &Row,
    rooms: &BTreeSet<&str>,
    exceptions: &Exceptions,
    findings: &mut Vec<Finding>,
) -> io::Result<BTreeSet<(PathBuf, String)>> {
    let folder = Path::new(&row.folder);
    let manifest = read_manifest(&root.join(folder).join("Cargo.toml"))?;
    let (mut imported, mut refused) = (BTreeSet::new(), BTreeSet::new());
    for import in imports(&manifest) {
        let local = rooms.contains(import.name.as_str()) || import.is_path;
        if local && !row.imports.contains(&import.name) {
            let message =
                format!("{} imports {}, which {MAP} does not allow", row.room, import.name);
            findings.push(Finding { file: folder.join("Cargo.toml"), line: None, message });
            refused.insert(import.name.clone());
        }
        imported.insert(import.name);
    }
    for unused in row.imports.iter().filter(|import| rooms.contains(import.as_str())) {
        if !imported.contains(unused) {
            let message = format!("{} may import {unused} and does not: take it out", row.room);
            findings.push(Finding { file: MAP.into(), line: Some(row.line), message });
        }
    }
    let modules = room::modules(root, folder)?;
    let file = folder.join("Cargo.toml");
    let mut named = BTreeSet::new();
    for (kind, name) in unused::unused(root, folder, &manifest, &refused, &modules)? {
        let key = (file.clone(), name);
        if !exceptions.dependencies.contains(&key) {
            let message = format!("`{}` in [{kind}] is used by no source: take it out", key.1);
            findings.push(Finding { file: file.clone(), line: None, message });
        }
        named.insert(key);
    }
    Ok(named)
}

/// Rows of the table `room | folder | may import`, and of the table `only these rooms | are`.
fn read_map(map: &str) -> (Vec<Row>, BTreeMap<String, BTreeSet<String>>) {
    let (mut rows, mut permits) = (Vec::new(), BTreeMap::new());
    let mut header: Vec<String> = Vec::new();
    for (index, line) in map.lines().enumerate() {
        let Some(inner) = line.trim().strip_prefix('|').and_then(|l| l.strip_suffix('|')) else {
            header.clear();
            continue;
        };
        let cells: Vec<String> = inner.split('|').map(|cell| cell.trim().to_owned()).collect();
        if header.is_empty() {
            header = cells;
            continue;
        }
        if cells.iter().all(|cell| cell.chars().all(|c| "-:".contains(c)) && !cell.is_empty()) {
            continue;
        }
        let words = |cell: &str| cell.split_whitespace().map(str::to_owned).collect();
        match (header.iter().map(String::as_str).collect::<Vec<_>>().as_slice(), cells.as_slice()) {
            (["room", "folder", "may import"], [room, folder, imports]) => rows.push(Row {
                line: index + 1,
                room: room.clone(),
                folder: folder.clone(),
                imports: words(imports),
            }),
            (["only these rooms", "are"], [permit, rooms]) => {
                permits.insert(permit.clone(), words(rooms));
            }
            _ => {}
        }
    }
    (rows, permits)
}

fn members(root: &Path) -> io::Result<BTreeSet<String>> {
    let manifest = read_manifest(&root.join("Cargo.toml"))?;
    let members =
        manifest.get("workspace").and_then(|w| w.get("members")).and_then(Value::as_array);
    Ok(members.into_iter().flatten().filter_map(Value::as_str).map(str::to_owned).collect())
}

fn read_manifest(path: &Path) -> io::Result<Table> {
    let text = fs::read_to_string(path)
        .map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))?;
    text.parse().map_err(|error| {
        io::Error::new(io::ErrorKind::InvalidData, format!("{}: {error}", path.display()))
    })
}

struct Import {
    name: String,
    is_path: bool,
}

/// What a manifest imports, for the product, its tests and its build script, on any target.
fn imports(manifest: &Table) -> Vec<Import> {
    let of = |table: &Table| {
        ["dependencies", "dev-dependencies", "build-dependencies"]
            .iter()
            .filter_map(|kind| table.get(*kind).and_then(Value::as_table))
            .flatten()
            .map(|(name, value)| Import {
                name: name.clone(),
                is_path: value.get("path").is_some(),
            })
            .collect::<Vec<_>>()
    };
    let targets = manifest.get("target").and_then(Value::as_table).into_iter().flatten();
    let on_targets = targets.filter_map(|(_, table)| table.as_table()).flat_map(of);
    of(manifest).into_iter().chain(on_targets).collect()
}
