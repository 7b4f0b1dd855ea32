//! The source's figures 3-3 to 3-8: what three generators make of each case of the bench, over time.

use super::bench::CASES;
use super::follower::{Case, END, INTERVAL, Instant, START, run};
use super::loops::kinds;
use basis::angle::wrap_to_half_turn;
use report::{ReportError, Synchronisation, TrackFigure, TrackLine, TrackRow};
use std::f64::consts::TAU;
use std::path::Path;

/// Runs all cases of the bench again and draws them into `folder`/figures, as SVG and PNG; gives the figures'
/// names.
///
/// # Errors
/// Those of [`report::write_synchronisation`].
pub fn pictures(folder: &Path) -> Result<Vec<String>, ReportError> {
    let tracks = CASES.iter().map(figure).collect();
    report::write_synchronisation(&Synchronisation { tracks, ..Synchronisation::default() }, folder)
}

/// What becomes of `case` from the start of control on.
fn figure(case: &Case) -> TrackFigure {
    let runs = kinds().map(|(name, kind)| {
        let run = run(case, kind, true).expect("the bench's own settings are sound");
        (name, run[(START / INTERVAL) as usize..].to_vec())
    });
    let mut rate = row("frequency (mHz)", &runs, |now| millihertz(now.estimate.rate));
    let mut amplitude = row("amplitude (m)", &runs, |now| now.amplitude);
    let error = row("phase error (°)", &runs, |now| {
        wrap_to_half_turn(now.estimate.phase - now.phase).to_degrees()
    });
    let place = row("place (m)", &runs, |now| now.place);
    // What should be found and reached is the same in all three; behind them.
    let truth = |of: fn(&Instant) -> f64| line("true rate, reference", 0, &runs[0].1, of);
    rate.lines.insert(0, truth(|now| millihertz(now.rate)));
    amplitude.lines.insert(0, truth(|now| now.reference));
    TrackFigure {
        name: format!("figure-{}", case.figure),
        title: format!("Three masses on springs: {}", case.name),
        caption: "A loop with each generator brings the swing of the first mass to its reference. The phase error is the \
                  estimated phase less that of the swing at which the masses would settle under the force of the moment; \
                  after a change they take minutes to do so."
            .to_owned(),
        rows: vec![rate, amplitude, error, place],
        mark: (!case.sweeps).then_some(0.5 * END),
    }
}

fn millihertz(rate: f64) -> f64 {
    1e3 * rate / TAU
}

/// A row called `label` with a line for each of the `runs`.
fn row(label: &str, runs: &[(&str, Vec<Instant>)], of: fn(&Instant) -> f64) -> TrackRow {
    let lines = runs.iter().enumerate();
    let lines = lines.map(|(index, (name, run))| line(name, 1 + index, run, of)).collect();
    TrackRow { label: label.to_owned(), is_angle: false, lines }
}

fn line(name: &str, colour: usize, run: &[Instant], of: fn(&Instant) -> f64) -> TrackLine {
    TrackLine {
        name: name.to_owned(),
        colour,
        times: run.iter().map(|now| now.time).collect(),
        values: run.iter().map(of).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folds::worst;

    /// On the jump of amplitude, whose frequency stays: the loops end at the true rate, the reference and the
    /// true phase.
    #[test]
    fn a_picture_holds_what_its_labels_say() {
        let case = CASES.iter().find(|case| case.figure == "3-6").expect("a case");
        let figure = figure(case);
        assert_eq!(figure.name, "figure-3-6");
        let [rate, amplitude, error, place] = &figure.rows[..] else { panic!("four rows") };
        let last = |row: &TrackRow, index: usize| *row.lines[index].values.last().expect("values");
        // St 0.2 in 7 m/s past 240 m.
        assert!((last(rate, 0) - 1e3 * 0.2 * 7.0 / 240.0).abs() < 1e-9);
        for generator in 1..=3 {
            assert!((last(rate, generator) / last(rate, 0) - 1.0).abs() < 0.02);
            assert!((last(amplitude, generator) / last(amplitude, 0) - 1.0).abs() < 0.15);
            assert!(last(error, generator - 1).abs() < 20.0, "{}", last(error, generator - 1));
            let places = &place.lines[generator - 1].values;
            let largest = worst(places.iter().copied());
            assert!((0.8..3.0).contains(&(largest / last(amplitude, 0))), "{largest}");
        }
        let names: Vec<&str> = rate.lines.iter().map(|line| line.name.as_str()).collect();
        assert_eq!(names, ["true rate, reference", "SOGI", "ESOGI", "MSTOGI"]);
    }
}
