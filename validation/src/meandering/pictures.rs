//! The source's figures 3-3 to 3-8: what three generators make of each case of the bench, over time.

use super::bench::CASES;
use super::follower::{Case, END, INTERVAL, Instant, START, run};
use super::loops::kinds;
use basis::angle::wrap_to_half_turn;
use report::{Along, ReportError, Synchronisation, TrackFigure, TrackLine, TrackRow};
use std::f64::consts::TAU;
use std::path::Path;

/// Runs all cases of the bench again and draws them into `folder`/figures, as SVG and PNG; gives the figures'
/// names.
///
/// # Errors
/// Those of [`report::write_synchronisation`].
pub fn pictures(folder: &Path) -> Result<Vec<String>, ReportError> {
    let offset = CASES.iter().find(|case| case.figure == "3-5").map(tracking_errors);
    let tracks = CASES.iter().map(figure).chain(offset).collect();
    report::write_synchronisation(&Synchronisation { tracks, ..Synchronisation::default() }, folder)
}

/// What becomes of `case` from the start of control on.
fn figure(case: &Case) -> TrackFigure {
    let runs = controlled(case);
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
        along: Along::TIME,
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

/// The source's figure 3-6: what is left of amplitude and bias on `case` with each generator.
///
/// The errors are those of Eq. 2-38, reference minus estimated amplitude, and minus the estimated bias; a
/// SOGI estimates no bias.
fn tracking_errors(case: &Case) -> TrackFigure {
    let runs = controlled(case);
    let amplitude = row("amplitude error (m)", &runs, |now| now.reference - now.amplitude);
    let mut bias = row("bias error (m)", &runs, |now| -now.estimate.offset);
    bias.lines.retain(|line| line.name != NO_OFFSET);
    TrackFigure {
        along: Along::TIME,
        name: "figure-3-6".to_owned(),
        title: format!("Three masses on springs: tracking errors, {}", case.name),
        caption: "What is lacking of the reference amplitude, and minus the bias, both as the loop estimates them. A SOGI estimates no bias, \
                  and the offset makes its amplitude oscillate."
            .to_owned(),
        rows: vec![amplitude, bias],
        mark: Some(0.5 * END),
    }
}

/// Name of the generator that estimates no offset.
const NO_OFFSET: &str = "SOGI";

/// The runs of `case` with each generator from the start of control on.
fn controlled(case: &Case) -> [(&'static str, Vec<Instant>); 3] {
    kinds().map(|(name, kind)| {
        let run = run(case, kind, true).expect("the bench's own settings are sound");
        (name, run[(START / INTERVAL) as usize..].to_vec())
    })
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
        band: Vec::new(),
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
        let case = CASES.iter().find(|case| case.figure == "amplitude-jump").expect("a case");
        let figure = figure(case);
        assert_eq!(figure.name, "figure-amplitude-jump");
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

    /// With an offset in the force: errors go to zero where a generator estimates it; one that does not has
    /// no line of it, and its amplitude keeps oscillating.
    #[test]
    fn tracking_errors_vanish_where_the_offset_is_estimated() {
        let case = CASES.iter().find(|case| case.figure == "3-5").expect("a case");
        let figure = tracking_errors(case);
        let [amplitude, bias] = &figure.rows[..] else { panic!("two rows") };
        let names = |row: &TrackRow| -> Vec<String> {
            row.lines.iter().map(|line| line.name.clone()).collect()
        };
        assert_eq!(names(amplitude), ["SOGI", "ESOGI", "MSTOGI"]);
        assert_eq!(names(bias), ["ESOGI", "MSTOGI"]);
        // The largest over the last 200 s; of the bias over its largest of all.
        let last = |line: &TrackLine| {
            let n = (200.0 / INTERVAL) as usize;
            worst(line.values[line.values.len() - n..].iter().map(|value| value.abs()))
        };
        for line in &bias.lines {
            let whole = worst(line.values.iter().map(|value| value.abs()));
            assert!(last(line) < 0.1 * whole, "{}: {} of {whole}", line.name, last(line));
        }
        let [sogi, esogi, mstogi] = [0, 1, 2].map(|index| last(&amplitude.lines[index]));
        assert!(sogi > esogi.max(mstogi), "{sogi} {esogi} {mstogi}");
    }
}
