//! The 1-Hz damage-equivalent load of a record: of a sine, whose load is known, and of a blade root in a run.
//!
//! cargo run --release -p wakemix --example 06-damage-equivalent-load

use std::f64::consts::TAU;
use wakemix::analysis::fatigue::damage_equivalent_load;
use wakemix::formats::case;
use wakemix::study::Prepared;

const CASE: &str = r#"
name = "loads"
[wind]
speed = 9.0
turbulence_intensity = 0.0
shear_exponent = 0.2
[flow]
solver = "uniform"
[time]
spin_up = 30.0
duration = 150.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
"#;
/// Wöhler's exponent of composite blades (–).
const SLOPE: f64 = 10.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A sine of amplitude A and frequency f: ranges of 2 A, f of them a second.
    let (amplitude, frequency, interval) = (3.0, 0.2, 0.05);
    let sine: Vec<f64> = (0..=12_000)
        .map(|sample| amplitude * (TAU * frequency * interval * f64::from(sample)).sin())
        .collect();
    let found = damage_equivalent_load(&sine, interval, SLOPE, 1.0)?;
    let expected = 2.0 * amplitude * f64::powf(frequency, 1.0 / SLOPE);
    println!("sine: {found:.3}, by hand {expected:.3}");
    assert!((found / expected - 1.0).abs() < 0.01);

    // Flapwise moment at the root of blade 1 of a flexible turbine in sheared wind, under OpenFAST's name.
    let ready = Prepared::of(case::parse("loads", CASE, &[])?)?.ready()?;
    let result = ready.run("baseline")?;
    let column = |name: &str| result.series.column(name).ok_or(format!("no channel {name}"));
    let (times, moments) = (column("Time")?, column("T1.RootMyb1")?);
    let first = times.iter().position(|time| *time >= 30.0).ok_or("the run is longer")?;
    let load = damage_equivalent_load(&moments[first..], times[1] - times[0], SLOPE, 1.0)?;
    let analysed = &moments[first..];
    let highest = analysed.iter().copied().fold(f64::MIN, f64::max);
    let lowest = analysed.iter().copied().fold(f64::MAX, f64::min);
    let [load_kn, low_kn, high_kn] = [load, lowest, highest].map(|moment| 1e-3 * moment);
    println!("blade root: {load_kn:.0} kN m; it swings from {low_kn:.0} to {high_kn:.0} kN m");
    // About one cycle a turn, of a turn each five seconds: somewhat less than the whole swing.
    assert!(load > 0.5 * (highest - lowest) && load < highest - lowest);
    Ok(())
}
