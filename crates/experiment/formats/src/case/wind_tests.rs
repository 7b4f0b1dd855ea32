//! From `[wind]` in a case file to the wind at a point, and what is refused on the way.

use super::*;
use basis::Vector3;
use farm::case::Beyond;
use farm::plan::{Footprint, plan};
use farm::wind::{deterministic, off_balance};
use flow::inflow::DeterministicWind;
use std::collections::BTreeMap;

const DIAMETER: f64 = 200.0;
const HUB: f64 = 120.0;

/// A case with `keys` under `[wind]` and one turbine, half a diameter to the left.
fn text(keys: &str) -> String {
    format!(
        "name = \"windy\"\n[wind]\nspeed = 10.0\nturbulence_intensity = 0.0\nshear_exponent = 0.2\n{keys}\n\
         [flow]\nsolver = \"uniform\"\n[time]\nspin_up = 0\nduration = 600\n\
         [[turbine]]\nname = \"T1\"\nmodel = \"m\"\nposition_diameters = [0.0, 0.5]\n[[run]]\nname = \"r\"\n"
    )
}

/// A case whose profile is logarithmic.
fn logarithmic(roughness_length: &str) -> String {
    text("").replace("shear_exponent = 0.2", &format!("roughness_length = {roughness_length}"))
}

/// The wind of a case with `keys`, after it was written and read again.
fn wind(keys: &str) -> DeterministicWind {
    wind_of_case(&text(keys))
}

fn wind_of_case(text: &str) -> DeterministicWind {
    let case = parse("windy.toml", text, &[]);
    let case = case.unwrap_or_else(|error| panic!("{}", error.to_lines()));
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case, "{text}");
    let footprint =
        Footprint { diameter: DIAMETER, hub_height: HUB, tip_speed: 80.0, rated_tip_speed: 80.0 };
    let plan = plan(&case, &BTreeMap::from([("m".to_owned(), footprint)])).unwrap();
    let wind = deterministic(&case, &plan);
    wind.check().unwrap();
    wind
}

fn at(wind: &DeterministicWind, time: f64, y: f64, z: f64) -> [f64; 3] {
    wind.wind(time, Vector3::new(700.0, y, z)).to_array()
}

fn near(found: [f64; 3], expected: [f64; 3]) {
    let distance = (Vector3::from_array(found) - Vector3::from_array(expected)).length();
    assert!(distance < 1e-9, "{found:?} instead of {expected:?}");
}

#[test]
fn shear_and_veer_turn_the_wind_over_height() {
    let still = wind("");
    near(at(&still, 5.0, 0.0, HUB), [10.0, 0.0, 0.0]);
    near(at(&still, 5.0, 0.0, 2.0 * HUB), [10.0 * 2_f64.powf(0.2), 0.0, 0.0]);
    let veering = wind("veer_deg_per_m = 0.05");
    near(at(&veering, 5.0, 0.0, HUB), [10.0, 0.0, 0.0]);
    // 100 m up it has turned by 5° clockwise seen from above, to the right looking downwind.
    let speed = 10.0 * ((HUB + 100.0) / HUB).powf(0.2);
    let (sine, cosine) = 5_f64.to_radians().sin_cos();
    near(at(&veering, 5.0, 0.0, HUB + 100.0), [speed * cosine, -speed * sine, 0.0]);
}

#[test]
fn a_roughness_length_makes_the_profile_logarithmic() {
    let wind = wind_of_case(&logarithmic("0.06"));
    for height in [30.0, HUB, 2.0 * HUB] {
        let speed = 10.0 * (height / 0.06_f64).ln() / (HUB / 0.06).ln();
        near(at(&wind, 5.0, 0.0, height), [speed, 0.0, 0.0]);
    }
    for calm in [0.06, 0.01, -5.0] {
        near(at(&wind, 5.0, 0.0, calm), [0.0; 3]);
    }
}

#[test]
fn turbulence_may_have_points_of_its_own() {
    let grid = "grid = { width = 300.0, height = 200.0, columns = 31, rows = 11 }";
    let turbulent = |solver: &str| {
        let text = text(grid).replace("intensity = 0.0", "intensity = 0.1");
        parse("windy.toml", &text.replace("\"uniform\"", &format!("\"{solver}\"")), &[])
    };
    for solver in ["turbulence", "vortex"] {
        let case = turbulent(solver).unwrap();
        let grid = case.wind.grid.unwrap();
        assert_eq!((grid.columns, grid.rows, grid.spacing()), (31, 11, [10.0, 20.0]));
        assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    }
    for solver in ["lattice", "uniform"] {
        let lines = turbulent(solver).unwrap_err().to_lines();
        let why = "`wind.grid` has no effect here: no turbulence is made around the rotors";
        assert!(lines.contains(why), "{lines}");
    }
}

#[test]
fn a_rough_ground_asks_for_its_own_profile() {
    let message = |text: String, ground: &str| {
        let text = text.replace("solver = \"uniform\"", &format!("ground = {ground}"));
        off_balance(&parse("windy.toml", &text, &[]).unwrap())
    };
    let rough = "{ roughness_length = 0.001 }";
    assert_eq!(message(logarithmic("0.001"), rough), None);
    assert_eq!(message(logarithmic("0.002"), "\"slip\""), None);
    let other = message(logarithmic("0.002"), rough).unwrap();
    assert!(other.contains("the logarithmic law of z₀ = 0.002 m blows in"), "{other}");
    let power = message(text(""), rough).unwrap();
    assert!(power.contains("a power law of exponent 0.2 blows in"), "{power}");
    assert!(power.contains("write wind.roughness_length = 0.001, and no wind.shear_exponent"));
    // Prescribed wind meets no ground.
    let uniform = text("").replace("[flow]\n", &format!("[flow]\nground = {rough}\n"));
    assert_eq!(off_balance(&parse("windy.toml", &uniform, &[]).unwrap()), None);
}

#[test]
fn events_come_when_and_as_the_file_says() {
    let hub = |keys: &str, time: f64| at(&wind(&format!("event = {{ {keys} }}")), time, 0.0, HUB);
    let step = "kind = \"step\", start = 100.0, speed = 12.5";
    near(hub(step, 99.9), [10.0, 0.0, 0.0]);
    near(hub(step, 100.0), [12.5, 0.0, 0.0]);
    let ramp = "kind = \"ramp\", start = 100.0, duration = 50.0, speed = 5.0";
    near(hub(ramp, 125.0), [7.5, 0.0, 0.0]);
    let stairs = "kind = \"staircase\", start = 100.0, hold = 10.0, rise = -1.5, n_steps = 4";
    near(hub(stairs, 115.0), [7.0, 0.0, 0.0]);
    near(hub(stairs, 500.0), [4.0, 0.0, 0.0]);
    // A half through, eq. 18 is 0.37 · sin(3π/2) · 2 below the mean: 0.74 V_gust above.
    let gust = "kind = \"operating-gust\", start = 100.0, gust = 6.0";
    near(hub(gust, 105.25), [10.0 + 0.74 * 6.0, 0.0, 0.0]);
    let turn = "kind = \"direction-change\", start = 100.0, change_deg = 30";
    near(
        hub(turn, 103.0),
        [10.0 * 15_f64.to_radians().cos(), 10.0 * 15_f64.to_radians().sin(), 0.0],
    );
    let coherent = "kind = \"coherent-gust\", start = 100.0, change_deg = -90";
    near(hub(coherent, 200.0), [0.0, -25.0, 0.0]);
}

#[test]
fn events_with_a_place_stand_at_the_first_turbine() {
    let (hub_y, radius) = (0.5 * DIAMETER, 0.5 * DIAMETER);
    let shear = wind("event = { kind = \"extreme-shear\", start = 100.0, horizontal = 4.0 }");
    near(at(&shear, 106.0, hub_y, HUB), [10.0, 0.0, 0.0]);
    near(at(&shear, 106.0, hub_y + radius, HUB), [14.0, 0.0, 0.0]);
    let disk = wind(
        "event = { kind = \"rotating-disk\", speed = 5.0, strouhal = 0.2, strouhal_last = 0.2, sense = \"ccw\" }",
    );
    // A tenth of a diameter above the hub at first; a quarter of a turn later a fifth to the left.
    let top = HUB + 0.1 * DIAMETER;
    near(at(&disk, 0.0, hub_y, top + 0.49 * DIAMETER), [5.0, 0.0, 0.0]);
    assert!(at(&disk, 0.0, hub_y, top + 0.51 * DIAMETER)[0] > 10.0);
    let quarter = 0.25 * DIAMETER / (0.2 * 10.0);
    let left = hub_y + 0.2 * DIAMETER;
    near(at(&disk, quarter, left + 0.49 * DIAMETER, HUB), [5.0, 0.0, 0.0]);
    near(at(&disk, quarter, left + 0.51 * DIAMETER, HUB), [10.0, 0.0, 0.0]);
    near(at(&disk, quarter, left - 0.51 * DIAMETER, HUB), [10.0, 0.0, 0.0]);
}

#[test]
fn what_cannot_be_is_reported_with_its_line() {
    let step = "event = { kind = \"step\", start = 100.0, speed = 12.0 }";
    let cases = [
        ("event = 3", "uniform", "windy.toml:6: `wind.event` must be a table, such as"),
        (
            "event = { kind = \"stepp\" }",
            "uniform",
            "windy.toml:6: `wind.event.kind` = \"stepp\" is unknown; expected one of \"step\", \"ramp\"",
        ),
        ("event = { start = 3 }", "uniform", "`wind.event.kind` is missing"),
        (
            "event = { kind = \"step\", start = 3 }",
            "uniform",
            "windy.toml:6: `wind.event.speed` is missing",
        ),
        (
            "event = { kind = \"step\", start = 3, sped = 4 }",
            "uniform",
            "there is no key `wind.event.sped`; did you mean `speed`?",
        ),
        (
            "event = { kind = \"step\", start = 3, speed = 54 }",
            "uniform",
            "did you mean 15 m/s? 54 km/h would be that",
        ),
        (
            "event = { kind = \"step\", start = 600, speed = 4 }",
            "uniform",
            "`wind.event.start` = 600 s is not before the end of the run",
        ),
        (
            "event = { kind = \"staircase\", start = 0, hold = 9, rise = -3, n_steps = 4 }",
            "uniform",
            "windy.toml:6: `wind.event.rise` = -3 is out of range: rise >= -2.5000 m/s for 4 steps down to calm",
        ),
        (
            "event = { kind = \"extreme-shear\", start = 3 }",
            "vortex",
            "windy.toml:6: `wind.event.kind` has no effect here: neither `vertical` nor `horizontal` says how much the wind shears; give one of them or both",
        ),
        (
            "roughness_length = 0.06",
            "uniform",
            "windy.toml:5: `wind.shear_exponent` has no effect here: the profile is logarithmic with wind.roughness_length; leave one of the two out",
        ),
        (
            "roughness_length = 0.06",
            "planes",
            "windy.toml:6: `wind.roughness_length` has no effect here: the wind is taken as the file has it",
        ),
        ("roughness_length = 0", "uniform", "0 < roughness_length <= 5 m"),
        ("veer_deg_per_m = 5", "uniform", "did you mean 0.05 deg/m? 5 deg per 100 m would be that"),
        (
            "veer_deg_per_m = 0.05",
            "planes",
            "windy.toml:6: `wind.veer_deg_per_m` has no effect here: the wind is taken as the file has it; leave it out",
        ),
        (
            step,
            "lattice",
            "windy.toml:6: `wind.event` has no effect here: flow.solver = \"lattice\"",
        ),
        (step, "turbulence", "`wind.event` has no effect here"),
        (
            "planes = \"field.bts\"\nveer_deg_per_m = 0.1",
            "lattice",
            "windy.toml:7: `wind.veer_deg_per_m` has no effect here: the file of wind.planes brings its own veer",
        ),
        (
            "beyond_planes = \"mean\"",
            "lattice",
            "windy.toml:6: `wind.beyond_planes` has no effect here: it is for recorded planes at the inlet of resolved flow",
        ),
        (
            "planes = \"field.bts\"\nbeyond_planes = \"mean\"",
            "planes",
            "windy.toml:7: `wind.beyond_planes` has no effect here",
        ),
        (
            "table = \"u.csv\"",
            "lattice",
            "windy.toml:6: `wind.table` has no effect here: flow.solver = \"lattice\" would answer wind that changes everywhere at once",
        ),
        ("planes = \"field.bts\"", "uniform", "`wind.planes` has no effect here"),
        ("planes = \"field.bts\"", "turbulence", "`wind.planes` has no effect here"),
    ];
    for (keys, solver, expected) in cases {
        let text = text(keys).replace("\"uniform\"", &format!("\"{solver}\""));
        let message = parse("windy.toml", &text, &[]).unwrap_err().to_lines();
        assert!(message.contains(expected), "{keys}\nexpected {expected}\nfound    {message}");
    }
    for (text, other) in [(text(""), "roughness_length"), (logarithmic("0.06"), "shear_exponent")] {
        let message = parse("windy.toml", &text, &[format!("wind.{other}=0.1")]);
        let message = message.unwrap_err().to_lines();
        assert!(message.contains("`wind.shear_exponent` has no effect here"), "{other}: {message}");
        assert!(
            message.contains("where --set gives one, the other must go from the file"),
            "{message}"
        );
    }
    // Free wakes take the wind that changes in time, as what it is prescribed by.
    for keys in
        [step, "table = \"u.csv\"", "event = { kind = \"extreme-shear\", start = 3, vertical = 2 }"]
    {
        let text = text(keys).replace("\"uniform\"", "\"vortex\"");
        assert!(parse("windy.toml", &text, &[]).is_ok(), "{keys}");
    }
    let veering = |flow: &str| {
        let text = text("veer_deg_per_m = 0.05").replace("solver = \"uniform\"", flow);
        parse("windy.toml", &text, &[])
    };
    assert!(veering("solver = \"turbulence\"").is_ok());
    assert!(veering("solver = \"lattice\"").is_ok());
    let message = veering("sides = \"slip\"").unwrap_err().to_lines();
    assert!(message.contains("sides along which the air is to slip; leave it out"), "{message}");
    let read = text("planes = \"field.bts\"").replace("\"uniform\"", "\"planes\"");
    let case = parse("windy.toml", &read, &[]).unwrap();
    assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    for (name, beyond) in
        [("repeat", Beyond::Repeat), ("mean", Beyond::Mean), ("hold", Beyond::Hold)]
    {
        let text = text(&format!("planes = \"field.bts\"\nbeyond_planes = \"{name}\""))
            .replace("\"uniform\"", "\"lattice\"");
        let case = parse("windy.toml", &text, &[]).unwrap();
        assert_eq!(case.wind.beyond_planes, Some(beyond));
        assert_eq!(parse("again", &write(&case), &[]).unwrap(), case);
    }
}
