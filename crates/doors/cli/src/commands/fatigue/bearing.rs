//! `wakemix fatigue --bearing`: the load of a blade's pitch bearing, all round its ring.

use super::{FatigueArguments, Span, name, open, read_span, six_digits};
use miette::{IntoDiagnostic, Result, miette};
use serde_json::json;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use wakemix::analysis::fatigue::{
    BEARING_SLOPE, BearingLoad, N_BEARING_POSITIONS, PitchBearing, PitchTravel, duty_convention,
};
use wakemix::formats::table::{Column, TableReader};

/// What was counted of one blade's pitching.
pub(super) struct Duty {
    span: Span,
    slope: f64,
    /// Pitch, flapwise and edgewise moment.
    columns: [Column; 3],
    /// Sum of all motion (rad).
    travel: f64,
    /// In the unit of the moments.
    loads: Vec<BearingLoad>,
}

/// Counts the pitching of the blade that `arguments` ask for.
///
/// # Errors
/// Files and channels that cannot be read, units that are missing or differ, and times that leave nothing to
/// count.
pub(super) fn count(arguments: &FatigueArguments) -> Result<Duty> {
    let slope = match arguments.slope[..] {
        [] => BEARING_SLOPE,
        [slope] => slope,
        [..] => {
            return Err(miette!(
                help = "give one slope, or none for 3",
                "--bearing with {} slopes",
                arguments.slope.len()
            ));
        }
    };
    let mut table = open(arguments)?;
    let columns = select(&mut table, arguments)?;
    let radians = radians(&columns[0])?;
    let [flapwise, edgewise] = [1, 2].map(|moment| unit(&columns[moment]));
    if flapwise != edgewise {
        return Err(miette!(
            help = "bring both to one unit",
            "{} is in \"{flapwise}\", {} in \"{edgewise}\"",
            columns[1].name,
            columns[2].name
        ));
    }
    let mut travel = PitchTravel::new();
    let mut bearing = PitchBearing::new(slope, N_BEARING_POSITIONS).into_diagnostic()?;
    let span = read_span(&mut table, arguments, |row| {
        let pitch = radians * row[1];
        travel.push(pitch).into_diagnostic()?;
        bearing.push(pitch, row[2], row[3]).into_diagnostic()
    })?;
    let travel = travel.travel(span.interval()).into_diagnostic()?.travel;
    let loads = bearing.loads(span.duration()).into_diagnostic()?;
    Ok(Duty { span, slope, columns, travel, loads })
}

/// Selects pitch, flapwise and edgewise moment of the blade.
fn select(table: &mut TableReader, arguments: &FatigueArguments) -> Result<[Column; 3]> {
    let blade = arguments.blade.map_or(1, NonZeroUsize::get);
    let prefix = arguments.turbine.as_ref().map_or(String::new(), |turbine| format!("{turbine}."));
    let pitch = format!("{prefix}BldPitch{blade}");
    if table.select(&[pitch.as_str()]).is_err() {
        return Err(miette!(
            help = "records of a run need --turbine, such as --turbine T1; OpenFAST has BldPitch1 where its OutList asks for it",
            "{} has no pitch of blade {blade}: \"{pitch}\" is none of its channels",
            table.path().display()
        ));
    }
    let [flapwise, edgewise] = ["RootMyb", "RootMxb"].map(|stem| format!("{prefix}{stem}{blade}"));
    table.select(&[pitch.as_str(), flapwise.as_str(), edgewise.as_str()])?;
    let columns: Vec<Column> = table.selected().cloned().collect();
    Ok(columns.try_into().expect("three were selected"))
}

/// Unit of `column`: its own, or what ends its name as in `RootMyb1_kN-m`; empty where neither tells.
fn unit(column: &Column) -> &str {
    if column.unit.is_empty() {
        column.name.rsplit_once('_').map_or("", |(_, unit)| unit)
    } else {
        &column.unit
    }
}

/// One unit of the pitch in `column` in radians.
///
/// # Errors
/// Another unit than degrees and radians, and none.
fn radians(column: &Column) -> Result<f64> {
    match unit(column) {
        "deg" => Ok(1_f64.to_radians()),
        "rad" => Ok(1.0),
        other => Err(miette!(
            help = "give pitch in deg or rad, with the unit behind its name, such as BldPitch1_deg",
            "{} has the unit \"{other}\", neither deg nor rad",
            column.name
        )),
    }
}

impl Duty {
    /// Travel in ten minutes (rad).
    fn travel_in_ten_minutes(&self) -> f64 {
        600.0 * self.travel / self.span.duration()
    }

    fn convention(&self) -> String {
        duty_convention(self.slope, self.loads.len(), self.span.interval())
    }

    /// As a table for people.
    pub(super) fn text(&self, arguments: &FatigueArguments) -> String {
        let [pitch, flapwise, edgewise] = self.columns.each_ref().map(name);
        let mut text = self.span.line(&arguments.file);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "pitch {pitch}, M_flap {flapwise}, M_edge {edgewise}, slope {}\n\
             pitch travel {} deg, {} deg in 10 minutes\n\
             position (deg)    equivalent load",
            self.slope,
            six_digits(self.travel.to_degrees()),
            six_digits(self.travel_in_ten_minutes().to_degrees()),
        );
        for BearingLoad { position, load } in &self.loads {
            let _ = writeln!(text, "{:>14.0} {:>18}", position.to_degrees(), six_digits(*load));
        }
        text + &self.convention() + "\n"
    }

    /// As an object for programs.
    pub(super) fn json(&self, arguments: &FatigueArguments) -> serde_json::Value {
        let [pitch, flapwise, edgewise] = self.columns.each_ref().map(|column| &column.name);
        let positions: Vec<serde_json::Value> = self
            .loads
            .iter()
            .map(|at| json!({ "position_deg": at.position.to_degrees(), "load": at.load }))
            .collect();
        let mut value = json!({
            "pitch": pitch,
            "flapwise": flapwise,
            "edgewise": edgewise,
            "unit": unit(&self.columns[1]),
            "slope": self.slope,
            "travel_deg": self.travel.to_degrees(),
            "travel_in_ten_minutes_deg": self.travel_in_ten_minutes().to_degrees(),
            "positions": positions,
            "convention": self.convention(),
        });
        self.span.tell(&arguments.file, &mut value);
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pitch_without_a_unit_is_refused() {
        let column = |name: &str, unit: &str| Column { name: name.into(), unit: unit.into() };
        assert_eq!(radians(&column("T1.BldPitch1_rad", "")).ok(), Some(1.0));
        assert_eq!(radians(&column("BldPitch1", "deg")).ok(), Some(1_f64.to_radians()));
        assert_eq!(radians(&column("BldPitch1_deg", "")).ok(), Some(1_f64.to_radians()));
        let message = radians(&column("BldPitch1", "")).unwrap_err().to_string();
        assert_eq!(message, "BldPitch1 has the unit \"\", neither deg nor rad");
    }
}
