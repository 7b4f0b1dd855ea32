//! What is read from the file of a precursor, and what is refused.

use super::*;
use crate::fuzz::numbers::{NEVER, numbers_of};
use flow::lattice::{Subgrid, SubgridModel};

const TEXT: &str = "name = \"small\"\n\
    [box]\nlength = 1600\nwidth = 800.0\nheight = 400\ncell = 20.0\n\
    [atmosphere]\nlatitude_deg = 52.6\nroughness_length = 0.001\ngeostrophic_wind = 10.0\n\
    geostrophic_direction_deg = 240.0\ninversion_height = 200.0\ninversion_strength = 2.5\ninversion_depth = 50.0\n\
    [time]\nspin_up = 7200.0\nrecord = 900.0\n\
    [planes]\nhub_height = 90.0\n";

fn parsed(text: &str, overrides: &[&str]) -> Result<PrecursorFile, String> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
    parse_precursor(Path::new("small.toml"), text, &overrides).map_err(|error| error.to_lines())
}

/// That `TEXT` with `set` is refused at `line` with all of `words`.
fn refused(set: &str, line: usize, words: &[&str]) {
    let (key, value) = set.split_once('=').unwrap();
    let key = format!("\n{} = ", key.trim());
    let text = if TEXT.contains(&key) {
        let (before, after) = TEXT.split_once(&key).unwrap();
        let rest = after.split_once('\n').unwrap().1;
        format!("{before}{key}{value}\n{rest}")
    } else {
        // At the end of [atmosphere], or of what comes after it.
        let heading =
            if key.contains("step") || key.contains("interval") { "[planes]" } else { "[time]" };
        TEXT.replace(heading, &format!("{}{value}\n{heading}", key.trim_start()))
    };
    let lines = parsed(&text, &[]).expect_err(set);
    let told = lines.lines().find(|told| words.iter().all(|word| told.contains(word)));
    let told = told.unwrap_or_else(|| panic!("{set}: {lines}"));
    assert!(told.starts_with(&format!("small.toml:{line}: ")), "{told}");
}

#[test]
fn what_the_file_says_is_read_and_laid_out() {
    let file = parsed(TEXT, &[]).unwrap();
    let precursor = &file.precursor;
    assert_eq!(precursor.domain.size, [1600.0, 800.0, 400.0]);
    let [east, north] = precursor.geostrophic();
    assert!((east - 10.0 * 60f64.to_radians().sin()).abs() < 1e-12);
    assert!((north - 5.0).abs() < 1e-12);
    assert_eq!(precursor.damping_from(), 300.0);
    let plan = precursor.plan();
    assert_eq!(plan.n_cells, [80, 40, 20]);
    // A tenth of a cell a step, and a whole number of them in a minute; half a cell from plane to plane.
    assert!((plan.interval - 0.2).abs() < 1e-12);
    assert_eq!((plan.plane_stride, plan.statistics_stride, plan.first_plane), (5, 300, 36_000));
    assert_eq!((plan.grid.n_y, plan.grid.n_z, plan.grid.n_steps), (40, 10, 901));
    assert_eq!(plan.n_steps, 36_000 + 900 * 5);
    assert_eq!(plan.grid.across(), [-390.0, 390.0]);
    let atmosphere = precursor.settings(&plan).atmosphere.unwrap();
    assert!((atmosphere.coriolis - 1.1586e-4).abs() < 1e-8, "{}", atmosphere.coriolis);
    let temperatures = [0.0, 200.0, 250.0, 350.0].map(|z| atmosphere.temperature_at(z) - 288.15);
    for (found, expected) in temperatures.into_iter().zip([0.0, 0.0, 2.5, 2.8]) {
        assert!((found - expected).abs() < 1e-9, "{temperatures:?}");
    }
}

#[test]
fn what_is_written_is_read_again_and_times_do_not_decide() {
    let file = parsed(TEXT, &["seed=7", "atmosphere.cooling_rate=0.25"]).unwrap();
    let again = parsed(&file.text, &[]).unwrap();
    assert_eq!((&again.precursor, &again.text), (&file.precursor, &file.text));
    assert!(file.text.contains("lapse_rate = 0.003"), "{}", file.text);
    let print = |overrides: &[&str]| parsed(TEXT, overrides).unwrap().fingerprint();
    for set in ["time.record=1200", "time.spin_up=9000", "box.threads=1", "name=other"] {
        assert_eq!(print(&[set]), print(&[]), "{set}");
    }
    for set in
        ["seed=2", "planes.hub_height=100", "atmosphere.inversion_strength=2.0", "box.subgrid=amd"]
    {
        assert_ne!(print(&[set]), print(&[]), "{set}");
    }
}

#[test]
fn the_model_of_eddies_is_chosen() {
    let subgrid = |overrides: &[&str]| {
        let precursor = parsed(TEXT, overrides).unwrap().precursor;
        precursor.settings(&precursor.plan()).subgrid
    };
    assert_eq!(subgrid(&[]), Subgrid::smagorinsky(0.16));
    for model in SubgridModel::ALL.into_iter().filter(|model| model.needs_neighbours()) {
        let set = format!("box.subgrid={}", model.word());
        assert_eq!(subgrid(&[&set]), Subgrid::new(model));
    }
}

#[test]
fn a_box_that_does_not_suit_its_air_is_refused_at_its_key() {
    refused("length=500", 3, &["`box.length`", "too short for its eddies", "use at least 600 m"]);
    refused("width=810", 4, &["`box.width`", "40.500 cells", "800 or 820 m"]);
    refused("length=1.6", 3, &["`box.length`", "did you mean 1600 m?"]);
    refused("cell=40", 6, &["`box.cell`", "5.0 cells below the inversion", "at most 25 m"]);
    refused("cell=1e-3", 6, &["`box.cell`", "1600000 cells along the length"]);
    let outside = ["`atmosphere.inversion_height`", "outside the box, which ends at 400 m"];
    refused("inversion_height=390", 12, &outside);
    refused("inversion_depth=150", 12, &["in the layer that is damped, from 300 m on"]);
    refused("damping_from=400", 15, &["`atmosphere.damping_from`", "not below the top"]);
    refused("roughness_length=4", 9, &["`atmosphere.roughness_length`", "use at most 3.679 m"]);
    refused("latitude_deg=-3", 8, &["`atmosphere.latitude_deg`", "equator"]);
    refused("lapse_rate=3", 15, &["`atmosphere.lapse_rate`", "did you mean 0.003 K/m?"]);
    refused("hub_height=250", 19, &["`planes.hub_height`", "10 and 190 m"]);
}

#[test]
fn a_step_that_breaks_the_scheme_is_refused_with_one_that_does_not() {
    refused("step=0.25", 18, &["`time.step`", "0.12 cells a step", "at most 0.2400 s"]);
    let text = TEXT.replace("strength = 2.5", "strength = 50").replace("depth = 50.0", "depth = 1");
    // In half the wind: buoyancy swings once in 4.8 s.
    let text = text.replace("wind = 10.0", "wind = 5.0");
    let lines = parsed(&text, &["time.step=0.3"]).unwrap_err();
    assert!(lines.contains("buoyancy swings in fewer than 20 steps"), "{lines}");
    // Left to itself the step follows.
    assert!(parsed(&text, &[]).is_ok());
    refused("record=30", 17, &["`time.record`", "shorter than time.statistics_interval, 60 s"]);
    refused("statistics_interval=0.1", 18, &["`time.statistics_interval`", "shorter than a step"]);
    refused("record=0.01", 17, &["`time.record`", "shorter than a step"]);
    let lines = parsed(TEXT, &["atmosphere.heat_flux=0.01", "atmosphere.cooling_rate=0.25"]);
    assert!(lines.unwrap_err().contains("leave one of the two out"));
}

#[test]
fn the_wind_is_given_aloft_or_at_hub_height() {
    let held = TEXT.replace("geostrophic_wind = 10.0", "hub_wind = 9.0");
    let held = held.replace("geostrophic_direction", "hub_direction");
    let precursor = parsed(&held, &[]).unwrap().precursor;
    let wind = precursor.held_wind().unwrap();
    let towards = [9.0 * 60f64.to_radians().sin(), 4.5];
    assert!((0..2).all(|axis| (wind[axis] - towards[axis]).abs() < 1e-12), "{wind:?}");
    // The geostrophic wind is faster, and comes from further to the right of who looks into it.
    let [east, north] = precursor.geostrophic();
    let ratio = east.hypot(north) / 9.0;
    assert!((1.05..1.25).contains(&ratio), "{ratio}");
    let turned = (wind[0] * north - wind[1] * east).atan2(wind[0] * east + wind[1] * north);
    assert!((-20.0..-5.0).contains(&turned.to_degrees()), "{}", turned.to_degrees());
    let south = parsed(&held, &["atmosphere.latitude_deg=-52.6"]).unwrap().precursor.geostrophic();
    assert!(wind[0] * south[1] - wind[1] * south[0] > 0.0 && parsed(TEXT, &[]).is_ok());
    // It starts with the wind that is asked for.
    let mut start = [basis::Vector3::ZERO];
    let above_hub = basis::Vector3::new(0.0, 0.0, 90.0);
    precursor.start().sample(0.0, &[above_hub], &mut start);
    let wave = start[0] - basis::Vector3::new(wind[0], wind[1], 0.0);
    assert!(wave.length() < 0.1 * 9.0 * ratio, "{start:?}");

    let lines = parsed(&TEXT.replace("geostrophic_wind = 10.0\n", ""), &[]).unwrap_err();
    assert!(lines.contains("geostrophic_wind` is missing, and so is"), "{lines}");
    assert!(lines.contains("give geostrophic_wind, or hub_wind"), "{lines}");
    refused("hub_wind=9", 15, &["`atmosphere.hub_wind`", "leave one of the two out"]);
    refused("hub_direction_deg=9", 15, &["`atmosphere.hub_direction_deg`", "use geostrophic_dir"]);
    let lines = parsed(&held, &["atmosphere.geostrophic_direction_deg=230"]).unwrap_err();
    assert!(lines.contains("use hub_direction_deg"), "{lines}");
}

#[test]
fn what_is_missing_misspelt_or_no_number_is_told() {
    let lines = parsed(&TEXT.replace("latitude_deg", "latitude"), &[]).unwrap_err();
    assert!(lines.contains("did you mean `latitude_deg`?"), "{lines}");
    assert!(lines.contains("`atmosphere.latitude_deg` is missing"), "{lines}");
    let lines = parsed("name = \"a\"\n", &[]).unwrap_err();
    for table in ["box", "atmosphere", "time", "planes"] {
        assert!(lines.contains(&format!("`{table}` is missing")), "{lines}");
    }
    for number in numbers_of(TEXT) {
        for bad in NEVER {
            let mut damaged = TEXT.to_owned();
            damaged.replace_range(number.bytes.clone(), bad);
            let lines = parsed(&damaged, &[]).expect_err(&format!("{} = {bad}", number.key));
            let line = 1 + TEXT[..number.bytes.start].matches('\n').count();
            assert!(lines.contains(&format!("small.toml:{line}: ")), "{bad}: {lines}");
        }
    }
}

#[test]
fn the_example_of_the_reference_page_reads() {
    let page = crate::case::precursor_reference();
    let example = page.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    parsed(example, &[]).unwrap_or_else(|lines| panic!("{lines}"));
}
