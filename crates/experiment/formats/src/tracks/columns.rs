//! Which column of a file is which, and in what unit.

use super::Particle;
use crate::fields::{Lengths, length_in, speed_in, time_in};

const FIX: &str = "name columns x, y, z, u, v, w (and time where there is one), with their units, such as `x [mm]` and `u [m/s]`";

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Place along x.
    X,
    /// Place along y.
    Y,
    /// Place along z.
    Z,
    /// Velocity along x.
    U,
    /// Velocity along y.
    V,
    /// Velocity along z.
    W,
    /// Instant.
    Time,
}

/// Roles with the names that have them, in lower case.
const NAMES: [(Role, &str, &[&str]); 7] = [
    (Role::X, "x", &["x"]),
    (Role::Y, "y", &["y"]),
    (Role::Z, "z", &["z"]),
    (Role::U, "u", &["u", "vx", "velocity_x", "velocity x"]),
    (Role::V, "v", &["v", "vy", "velocity_y", "velocity y"]),
    (Role::W, "w", &["w", "vz", "velocity_z", "velocity z"]),
    (Role::Time, "time", &["time", "t"]),
];

/// A column: where it is, and SI units of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placed {
    pub(crate) place: usize,
    pub(crate) scale: f64,
}

/// The columns of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Columns {
    all: [Placed; 6],
    time: Option<Placed>,
    has_bare_lengths: bool,
}

impl Columns {
    /// Those among `named`, each a name and a unit, of which either may hold the unit.
    ///
    /// # Errors
    /// The problem and its fix, in words.
    pub(crate) fn find<'a>(
        named: impl Iterator<Item = (&'a str, &'a str)>,
        lengths: Lengths,
    ) -> Result<Self, (String, String)> {
        let named: Vec<(String, String)> = named.map(|(name, unit)| parted(name, unit)).collect();
        let mut found: [Option<Placed>; 7] = [None; 7];
        let (mut lengths_told, mut speeds_told) = (Vec::new(), Vec::new());
        for ((role, own, names), found) in NAMES.into_iter().zip(&mut found) {
            let place = named.iter().position(|(name, _)| names.contains(&name.as_str()));
            let Some(place) = place else {
                if role == Role::Time {
                    continue;
                }
                return Err((format!("it has no column `{own}`"), FIX.to_owned()));
            };
            let unit = named[place].1.as_str();
            let scale = scale_of(role, unit)
                .map_err(|problem| (format!("`{own}` is in {unit}; {problem}"), FIX.to_owned()))?;
            match role {
                Role::X | Role::Y | Role::Z => lengths_told.push((own, scale)),
                Role::U | Role::V | Role::W => speeds_told.push((own, scale)),
                Role::Time => {}
            }
            *found = Some(Placed { place, scale: scale.unwrap_or(1.0) });
        }
        mixed(&lengths_told, "give all lengths in one unit, m or mm, and name it with each")?;
        mixed(&speeds_told, "give all speeds in one unit, m/s or mm/s, and name it with each")?;
        let has_bare_lengths = lengths_told.iter().all(|(_, unit)| unit.is_none());
        let placed = |place: usize| found[place].unwrap_or(Placed { place: 0, scale: 1.0 });
        let mut all: [Placed; 6] = std::array::from_fn(placed);
        if has_bare_lengths {
            for column in &mut all[..3] {
                column.scale = lengths.in_metres();
            }
        }
        Ok(Self { all, time: found[6], has_bare_lengths })
    }

    /// Whether lengths have no unit.
    pub(crate) fn has_bare_lengths(&self) -> bool {
        self.has_bare_lengths
    }

    /// Whether column number `place` is one of them.
    pub(crate) fn is_wanted(&self, place: usize) -> bool {
        self.all.iter().chain(&self.time).any(|column| column.place == place)
    }

    /// The column of `role`.
    pub(crate) fn of(&self, role: Role) -> Option<Placed> {
        match role {
            Role::Time => self.time,
            role => Some(self.all[role as usize]),
        }
    }

    /// Those of the velocity.
    pub(crate) fn velocity(&self) -> [Placed; 3] {
        [self.all[3], self.all[4], self.all[5]]
    }

    /// The particle in a `row` of all columns.
    pub(crate) fn particle(&self, row: &[f64]) -> Particle {
        let value = |column: &Placed| column.scale * row[column.place];
        let [x, y, z, u, v, w] = self.all.each_ref().map(value);
        Particle { time: self.time.as_ref().map(value), position: [x, y, z], velocity: [u, v, w] }
    }
}

/// Refuses columns of which not all are in one unit, or told without one; `fix` says what to do.
fn mixed(units: &[(&str, Option<f64>)], fix: &str) -> Result<(), (String, String)> {
    let [(first, unit), rest @ ..] = units else { return Ok(()) };
    match rest.iter().find(|(_, other)| other != unit) {
        Some((other, _)) => {
            let problem = format!("`{first}` and `{other}` are in different units");
            Err((problem, fix.to_owned()))
        }
        None => Ok(()),
    }
}

/// SI units of one `unit`; none where it is empty.
fn scale_of(role: Role, unit: &str) -> Result<Option<f64>, &'static str> {
    if unit.is_empty() {
        return Ok(None);
    }
    let (scale, expected) = match role {
        Role::X | Role::Y | Role::Z => (length_in(unit), "lengths in m or mm are read"),
        Role::Time => (time_in(unit), "times in s or ms are read"),
        _ => (speed_in(unit), "speeds in m/s or mm/s are read"),
    };
    scale.map(Some).ok_or(expected)
}

/// Name in lower case, and unit: of `X [mm]`, `x (mm)`, `x_mm` and the like.
fn parted(name: &str, unit: &str) -> (String, String) {
    let name = name.trim();
    if !unit.is_empty() {
        return (name.to_lowercase(), unit.to_owned());
    }
    for [open, close] in [['[', ']'], ['(', ')']] {
        if let Some((before, after)) = name.split_once(open) {
            let unit = after.trim_end().trim_end_matches(close);
            return (before.trim().to_lowercase(), unit.trim().to_owned());
        }
    }
    let known = ["_mm", "_m", "_s", "_ms"].into_iter().find(|end| name.ends_with(end));
    match known {
        Some(end) if name.len() > end.len() => {
            (name[..name.len() - end.len()].to_lowercase(), end[1..].to_owned())
        }
        _ => (name.to_lowercase(), String::new()),
    }
}
