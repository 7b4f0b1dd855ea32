//! Averages by phase that a run kept.

use crate::PostprocessingError;
use crate::request::Request;
use crate::wake_fields::{Averaged, Wanted};
use basis::records::Summary;
use formats::records::{RunFolder, StoredPhaseAverages};
use miette::Diagnostic;
use std::error::Error;
use std::path::Path;

/// Most values that a report looks at in one file of averages: points times bins (–). They are 40 bytes each
/// on the disk; so many take some seconds.
const MOST_VALUES: u64 = 20_000_000;
/// Turbines stand where averages say to this share of the rotor diameter (–).
const NEAR: f64 = 0.01;

/// A run of the study.
pub(super) struct Run<'a> {
    /// Its numbers.
    pub(super) summary: &'a Summary,
    /// Its colour.
    pub(super) colour: usize,
    /// Its folder.
    pub(super) folder: RunFolder,
    /// The folder of the study.
    pub(super) study: &'a Path,
}

impl Run<'_> {
    /// Its name.
    pub(super) fn name(&self) -> &str {
        &self.summary.run
    }

    /// A request to an analysis of this run.
    pub(super) fn request(&self) -> Request {
        Request::of(self.folder.path())
    }

    /// `error` in words for a page: which file, why, and the fix; files are named from the study's folder on,
    /// so that the page says the same wherever that is.
    pub(super) fn told(&self, error: &PostprocessingError) -> String {
        let mut text = error.to_string();
        let mut source = error.source();
        while let Some(deeper) = source {
            text += &format!(": {deeper}");
            source = deeper.source();
        }
        if let Some(fix) = error.help() {
            text += &format!("; {fix}");
        }
        // With a slash at its end.
        let study = self.study.join("").display().to_string();
        text.replace(&study, "")
    }

    /// That `what` of `field` are not on the page because there are `how_many`, and the command that draws
    /// them.
    pub(super) fn too_large(
        &self,
        what: &str,
        field: &str,
        how_many: &str,
        analysis: &str,
    ) -> String {
        format!(
            "{what} of {field} of {run} are not shown here, to keep the report quick: {how_many}. In the folder of the study, wakemix analyse {analysis} {run} --field {field} --figures pictures draws them.",
            run = self.name()
        )
    }
}

/// Averages of a plane or a volume.
pub(super) struct Kept {
    /// Name of the output of the case that they are of.
    pub(super) output: String,
    /// Their name, which `--field` takes.
    pub(super) field: String,
    /// The request that they answer.
    pub(super) request: Request,
    /// They themselves.
    pub(super) averaged: Averaged,
}

impl Kept {
    /// Those of `run` in the file at `path`.
    ///
    /// # Errors
    /// What the page says instead.
    pub(super) fn of(run: &Run, path: &Path) -> Result<Self, String> {
        let field = RunFolder::phase_averages_name(path).unwrap_or_default().to_owned();
        let stored = StoredPhaseAverages::open(path).map_err(|error| run.told(&error.into()))?;
        let head = &stored.head;
        let n_values = head.grid.len() as u64 * head.bins.len() as u64;
        if n_values > MOST_VALUES {
            let (n_points, n_bins) = (head.grid.len(), head.bins.len());
            let how_many = format!("{n_points} points in {n_bins} bins");
            return Err(run.too_large("averages by phase", &field, &how_many, "entrainment"));
        }
        let mut request = run.request().with("field", &field);
        if let Some(turbine) = turbine_at(run.summary, &stored) {
            request = request.with("turbine", turbine);
        }
        let averaged = Averaged::of(&request, Wanted::Bins).map_err(|error| run.told(&error))?;
        let output = output_of(&field).to_owned();
        Ok(Self { output, field, request, averaged })
    }
}

/// Name of the output that keeps the averages called `field`: what stands before their place, such as
/// `-0D-beside`, `-1.5D` or `-volume`.
fn output_of(field: &str) -> &str {
    let sides = ["-beside", "-above"];
    let side = sides.into_iter().find_map(|side| field.strip_suffix(side));
    let place = side.unwrap_or(field).rsplit_once('-');
    // A place upwind has a minus of its own.
    place.map_or(field, |(output, _)| output.strip_suffix('-').unwrap_or(output))
}

/// Name of the turbine that `stored` were averaged behind; none where the summary does not tell.
fn turbine_at<'s>(summary: &'s Summary, stored: &StoredPhaseAverages) -> Option<&'s str> {
    let [x, y, _] = stored.setting.hub;
    let near = NEAR * stored.setting.diameter;
    let mut turbines = summary.turbines.iter();
    let is_there = |hub: [f64; 3]| (hub[0] - x).hypot(hub[1] - y) < near;
    let found = turbines.find(|turbine| turbine.rotor.is_some_and(|rotor| is_there(rotor.hub)));
    Some(&found?.name)
}

#[cfg(test)]
mod tests {
    use super::output_of;

    #[test]
    fn the_output_stands_before_the_place() {
        for (field, output) in [
            ("wake-0D-beside", "wake"),
            ("near-wake-0.5D-above", "near-wake"),
            ("discs-1.5D", "discs"),
            ("discs--1D", "discs"),
            ("all-volume", "all"),
            ("mine", "mine"),
        ] {
            assert_eq!(output_of(field), output);
        }
    }
}
