//! Which runs of which studies are asked for.

use crate::StudyError;
use crate::prepared::Prepared;
use basis::records::Sweep;
use farm::case::Run;

/// Places of the runs called `names` in each of `studies`, all when there are no names; none where a study is
/// not asked for.
///
/// A name is that of a run, or of one in the file that swept keys make several of; with the folder of a study
/// of `sweep` and a slash before it, of that study alone.
///
/// # Errors
/// [`StudyError::UnknownRun`].
pub(super) fn of_studies(
    names: &[String],
    sweep: Option<&Sweep>,
    studies: &[Prepared],
) -> Result<Vec<Option<Vec<usize>>>, StudyError> {
    let mut wanted: Vec<Vec<usize>> = vec![Vec::new(); studies.len()];
    for name in names {
        let mut found = false;
        for (index, study) in studies.iter().enumerate() {
            let folder = sweep.map_or("", |sweep| sweep.studies[index].folder.as_str());
            let run = match name.split_once('/') {
                Some((study, run)) if study == folder => run,
                Some(_) => continue,
                None => name.as_str(),
            };
            for place in places(run, sweep, &study.case.runs) {
                found = true;
                // One that is named twice is made once.
                if !wanted[index].contains(&place) {
                    wanted[index].push(place);
                }
            }
        }
        if !found {
            let known = studies[0].case.runs.iter().map(|run| run.name.clone()).collect();
            return Err(StudyError::UnknownRun { name: name.clone(), known });
        }
    }
    let all = |study: &Prepared| (0..study.case.runs.len()).collect();
    let studies = studies.iter().zip(wanted);
    Ok(studies
        .map(|(study, wanted)| match (names, wanted) {
            ([], _) => Some(all(study)),
            (_, wanted) => (!wanted.is_empty()).then_some(wanted),
        })
        .collect())
}

/// Places of the runs that `name` is about in `runs`.
fn places(name: &str, sweep: Option<&Sweep>, runs: &[Run]) -> Vec<usize> {
    let is_meant = |run: &Run| {
        let mut swept = sweep.iter().flat_map(|sweep| &sweep.runs);
        let is_made_of = swept.any(|swept| swept.run == run.name && swept.base == name);
        run.name == name || is_made_of
    };
    let meant = runs.iter().enumerate().filter(|(_, run)| is_meant(run));
    meant.map(|(place, _)| place).collect()
}
