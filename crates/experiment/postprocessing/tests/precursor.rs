//! The report of a precursor, made by a small box.

use std::fs;
use std::sync::atomic::AtomicBool;
use study::Silent;
use study::precursor::{PrecursorOptions, PrecursorOutcome, precursor};

/// A layer of 100 m in 32 × 32 × 16 cells, one minute and a hundred seconds long.
const CASE: &str = "name = \"small\"\ndescription = \"A trial\"\n\
    [box]\nlength = 400\nwidth = 400\nheight = 200\ncell = 12.5\n\
    [atmosphere]\nlatitude_deg = 52.6\nroughness_length = 0.01\nhub_wind = 7.5\n\
    hub_direction_deg = 240\ninversion_height = 100\ninversion_strength = 2\ninversion_depth = 25\n\
    [time]\nspin_up = 60\nrecord = 100\nstatistics_interval = 10\n\
    [planes]\nhub_height = 70\nrotor_diameter = 80\n";

#[test]
fn a_precursor_has_a_page_of_its_own_which_is_made_anew() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("small.toml");
    fs::write(&case, CASE).unwrap();
    let output = Some(folder.path().join("small"));
    let options = PrecursorOptions { case, output, ..PrecursorOptions::default() };
    let outcome = precursor(&options, &AtomicBool::new(false), &mut Silent).unwrap();
    let PrecursorOutcome::Done { result, folder } = outcome else { panic!("{outcome:?}") };
    let made = postprocessing::report(folder.path()).unwrap();
    assert_eq!((&made.page, made.summaries.len()), (&folder.report_path(), 0));
    let page = fs::read_to_string(&made.page).unwrap().replace('\u{a0}', " ");
    let headline = format!(
        "{:.2} m&#x2f;s from {:.1}° at 70 m, turbulence intensity {:.1} %.",
        result.planes.hub_speed,
        result.planes.direction_deg,
        100.0 * result.planes.turbulence_intensity
    );
    let expected = [
        headline.as_str(),
        "<p class=\"description\">A trial</p>",
        "The box is 4.0 times as wide as its layer is deep",
        "at the end; moved to hold 7.5 m&#x2f;s at the hub",
        "the band what the rotor spans",
        "hub_wind = 7.5",
    ];
    for expected in expected {
        assert!(page.contains(expected), "`{expected}` is missing");
    }
    for name in ["profiles", "histories", "over-time-and-height", "spectra"] {
        assert!(page.contains(&format!("<figure id=\"{name}\">")), "{name}");
        assert!(folder.path().join(format!("figures/{name}.png")).is_file(), "{name}");
    }
    // Too short to tell slow waves apart.
    assert!(!page.contains("<figure id=\"coherence\">"));
    // The same records give the same bytes, and nothing beside it is asked for.
    let before = fs::read(&made.page).unwrap();
    assert_eq!(postprocessing::report_of_precursor(folder.path()).unwrap(), made.page);
    assert!(fs::read(&made.page).unwrap() == before);
    assert!(!page.contains("src=\"http") && !page.contains("href=\"http"));

    // A file that was damaged is named.
    fs::write(folder.statistics_path(), "no statistics").unwrap();
    let error = postprocessing::report(folder.path()).unwrap_err().to_string();
    assert!(error.contains("statistics.nc"), "{error}");
}
