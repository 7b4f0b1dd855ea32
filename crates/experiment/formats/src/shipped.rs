//! The cases that come with the program: each can be run by its name, anywhere.

use crate::FileError;
use crate::case::{self, CampaignFile, CaseError, CaseFile, CaseFiles, PrecursorFile};
use crate::linear_model::{LinearModel, Role};
use crate::records;
use farm::case::Case;
use std::io::ErrorKind;
use std::path::Path;

/// A case that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShippedCase {
    /// Its name, which stands for its file.
    pub name: &'static str,
    /// The file in the repository.
    file: &'static str,
    /// Wall time of all its runs on two cores (min), about.
    pub minutes: f64,
    /// The shipped case or precursor that has to be run before, where it reads what another one leaves.
    pub after: Option<&'static str>,
}

/// All of them, those to begin with first.
pub const CASES: &[ShippedCase] = &[
    ShippedCase {
        name: "quickstart",
        file: include_str!("../../../../cases/quickstart.toml"),
        minutes: 3.0,
        after: None,
    },
    ShippedCase {
        name: "one-turbine",
        file: include_str!("../../../../cases/one-turbine.toml"),
        minutes: 0.2,
        after: None,
    },
    ShippedCase {
        name: "free-wake",
        file: include_str!("../../../../cases/free-wake.toml"),
        minutes: 2.0,
        after: None,
    },
    ShippedCase {
        name: "lidar-open-loop",
        file: include_str!("../../../../cases/lidar-open-loop.toml"),
        minutes: 160.0,
        after: None,
    },
    ShippedCase {
        name: "lidar-identification",
        file: include_str!("../../../../cases/lidar-identification.toml"),
        minutes: 6.0,
        after: None,
    },
    ShippedCase {
        name: "lidar-closed-loop",
        file: include_str!("../../../../cases/lidar-closed-loop.toml"),
        minutes: 240.0,
        after: None,
    },
    ShippedCase {
        name: "helix-two-turbines",
        file: include_str!("../../../../cases/helix-two-turbines.toml"),
        minutes: 35.0,
        after: None,
    },
    ShippedCase {
        name: "sweep-helix",
        file: include_str!("../../../../cases/sweep-helix.toml"),
        minutes: 7.0,
        after: None,
    },
    ShippedCase {
        name: "tunnel-helix",
        file: include_str!("../../../../cases/tunnel-helix.toml"),
        minutes: 7.0,
        after: None,
    },
    ShippedCase {
        name: "tunnel-helix-free-wake",
        file: include_str!("../../../../cases/tunnel-helix-free-wake.toml"),
        minutes: 20.0,
        after: None,
    },
    ShippedCase {
        name: "tunnel-tip-vortices",
        file: include_str!("../../../../cases/tunnel-tip-vortices.toml"),
        minutes: 8.0,
        after: None,
    },
    ShippedCase {
        name: "wake-steering",
        file: include_str!("../../../../cases/wake-steering.toml"),
        minutes: 15.0,
        after: None,
    },
    ShippedCase {
        name: "helix-three-turbines",
        file: include_str!("../../../../cases/helix-three-turbines.toml"),
        minutes: 270.0,
        after: None,
    },
    ShippedCase {
        name: "synchronised-helix",
        file: include_str!("../../../../cases/synchronised-helix.toml"),
        minutes: 60.0,
        after: None,
    },
    ShippedCase {
        name: "meandering",
        file: include_str!("../../../../cases/meandering.toml"),
        minutes: 31.0,
        after: None,
    },
    ShippedCase {
        name: "meandering-disk",
        file: include_str!("../../../../cases/meandering-disk.toml"),
        minutes: 1.0,
        after: None,
    },
    ShippedCase {
        name: "wake-inflow",
        file: include_str!("../../../../cases/wake-inflow.toml"),
        minutes: 15.0,
        after: None,
    },
    ShippedCase {
        name: "meandering-in-wake",
        file: include_str!("../../../../cases/meandering-in-wake.toml"),
        minutes: 2.0,
        after: Some("wake-inflow"),
    },
    ShippedCase {
        name: "wake-slices",
        file: include_str!("../../../../cases/wake-slices.toml"),
        minutes: 10.0,
        after: None,
    },
    ShippedCase {
        name: "wake-slices-array",
        file: include_str!("../../../../cases/wake-slices-array.toml"),
        minutes: 15.0,
        after: None,
    },
    ShippedCase {
        name: "in-slices",
        file: include_str!("../../../../cases/in-slices.toml"),
        minutes: 0.1,
        after: Some("wake-slices"),
    },
    ShippedCase {
        name: "helix-offshore",
        file: include_str!("../../../../cases/helix-offshore.toml"),
        minutes: 12.0,
        after: Some("precursor-offshore"),
    },
    ShippedCase {
        name: "synchronised-offshore",
        file: include_str!("../../../../cases/synchronised-offshore.toml"),
        minutes: 36.0,
        after: Some("precursor-seed-000"),
    },
];

/// Control laws that come with the program: the names of their files, which cases give, and what they hold.
pub const LAWS: &[(&str, &str)] =
    &[("lidar-loop-controller.json", include_str!("../../../../cases/lidar-loop-controller.json"))];

/// The shipped control law in the file called `name`.
pub fn find_law(name: &str) -> Option<&'static str> {
    LAWS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

/// The control law that a case in `folder` names as `file`, with its file's SHA-256: the shipped one of that
/// name where no such file is there.
///
/// # Errors
/// Those of [`LinearModel::read`].
pub fn read_law(folder: &Path, file: &str) -> Result<(LinearModel, String), FileError> {
    let path = folder.join(file);
    match find_law(file).filter(|_| !path.is_file()) {
        Some(text) => {
            let law = LinearModel::parse(&path, text, Role::Controller)?;
            Ok((law, records::sha256(text.as_bytes())))
        }
        None => {
            let law = LinearModel::read(&path, Role::Controller)?;
            Ok((law, records::sha256_of_file(&path, "a control law")?))
        }
    }
}

/// A precursor that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShippedPrecursor {
    /// Its name, which stands for its file.
    pub name: &'static str,
    /// The file in the repository.
    file: &'static str,
    /// Wall time on two cores (min), about.
    pub minutes: f64,
}

/// All of them.
pub const PRECURSORS: &[ShippedPrecursor] = &[
    ShippedPrecursor {
        name: "precursor-offshore",
        file: include_str!("../../../../cases/precursor-offshore.toml"),
        minutes: 170.0,
    },
    ShippedPrecursor {
        name: "precursor-seed-000",
        file: include_str!("../../../../cases/precursor-seed-000.toml"),
        minutes: 290.0,
    },
    ShippedPrecursor {
        name: "precursor-berg",
        file: include_str!("../../../../cases/precursor-berg.toml"),
        minutes: 200.0,
    },
];

impl ShippedPrecursor {
    /// Its text for any folder.
    pub fn text(&self) -> String {
        anywhere(self.file)
    }

    /// The precursor itself.
    ///
    /// # Errors
    /// [`CaseError`] for what a test holds not to be wrong.
    pub fn precursor(&self) -> Result<PrecursorFile, CaseError> {
        case::parse_precursor(Path::new(self.name), &self.text(), &[])
    }
}

/// The shipped precursor called `name`.
pub fn find_precursor(name: &str) -> Option<&'static ShippedPrecursor> {
    PRECURSORS.iter().find(|precursor| precursor.name == name)
}

/// Reads the precursor's file at `path`, or the shipped one that it stands for, and applies `overrides`.
///
/// # Errors
/// Those of [`case::read_precursor`].
pub fn read_precursor(path: &Path, overrides: &[String]) -> Result<PrecursorFile, CaseError> {
    let named = path.to_str().and_then(find_precursor).filter(|_| !path.is_file());
    match named {
        Some(shipped) => case::parse_precursor(path, &shipped.text(), overrides),
        None => case::read_precursor(path, overrides),
    }
}

/// `file` of the repository without the line of its schema, which stands beside `cases/`.
fn anywhere(file: &str) -> String {
    let lines = file.lines().filter(|line| !line.starts_with("#:schema"));
    lines.map(|line| line.to_owned() + "\n").collect()
}

impl ShippedCase {
    /// Its text for any folder. In the repository a case stands in `cases/`, beside the schema and with
    /// `runs/` one folder up; here `runs/` is in the current folder, and cases are called by their names.
    pub fn text(&self) -> String {
        let mut text = anywhere(self.file).replace("../runs/", "runs/");
        for case in CASES {
            text = text.replace(&format!("cases/{}.toml", case.name), case.name);
        }
        text
    }

    /// The case itself, one for each of its studies.
    ///
    /// # Errors
    /// [`CaseError`] where a kind of output that it asks for is not known yet.
    pub fn cases(&self) -> Result<Vec<Case>, CaseError> {
        Ok(case::parse_all(self.name, &self.text(), &[])?.0)
    }
}

/// The shipped case called `name`.
pub fn find(name: &str) -> Option<&'static ShippedCase> {
    CASES.iter().find(|case| case.name == name)
}

/// The shipped case that `path` stands for: one of this name, where there is no file of it.
pub fn instead_of(path: &Path) -> Option<&'static ShippedCase> {
    find(path.to_str()?).filter(|_| !path.is_file())
}

/// Reads the case file at `path`, or the shipped case that it stands for, and applies `overrides`.
///
/// # Errors
/// Those of [`case::read`]; where there is no such file, with the shipped cases as a way on.
pub fn read(path: &Path, overrides: &[String]) -> Result<CaseFile, CaseError> {
    if let Some(shipped) = instead_of(path) {
        let text = shipped.text();
        let case = case::parse(shipped.name, &text, overrides)?;
        let (overrides, path) = (overrides.to_vec(), path.to_owned());
        return Ok(CaseFile { case, text, overrides, path, study: 0 });
    }
    case::read(path, overrides).map_err(with_advice)
}

/// The same of a case that may sweep keys which make studies.
///
/// # Errors
/// Those of [`case::read_all`]; where there is no such file, with the shipped cases as a way on.
pub fn read_all(path: &Path, overrides: &[String]) -> Result<CaseFiles, CaseError> {
    match instead_of(path) {
        Some(shipped) => case::of_text(path, shipped.text(), overrides),
        None => case::read_all(path, overrides).map_err(with_advice),
    }
}

/// Reads the file of a campaign at `path`, whose case may be a shipped one.
///
/// # Errors
/// Those of [`case::read_campaign`].
pub fn read_campaign(path: &Path) -> Result<CampaignFile, CaseError> {
    case::read_campaign(path, &|name| find(name).map(ShippedCase::text))
}

/// `error`, and what to do where it is of a file that is not there.
fn with_advice(error: CaseError) -> CaseError {
    match error {
        CaseError::File(FileError::System { verb, what, path, source, .. })
            if source.kind() == ErrorKind::NotFound =>
        {
            let fix = advice(&path);
            CaseError::File(FileError::System { verb, what, path, fix, source })
        }
        error => error,
    }
}

/// What to do where there is no case file at `path`.
fn advice(path: &Path) -> String {
    let stem = path.file_stem().and_then(|stem| stem.to_str()).and_then(find);
    match stem {
        Some(case) => format!("a case of that name comes with the program: give its name, {}", case.name),
        None => "correct the path, write a case with `wakemix init`, or give the name of one that `wakemix cases` lists".to_owned(),
    }
}

#[cfg(test)]
mod tests;
