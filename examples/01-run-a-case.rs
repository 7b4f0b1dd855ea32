//! A case as text, changed as a value, run in memory: no file is read or written.
//!
//! cargo run --release -p wakemix --example 01-run-a-case

use wakemix::formats::case;
use wakemix::study::Prepared;

/// Every key is explained in docs/case-file.md; what is left out has a default.
const CASE: &str = r#"
name = "example"
[wind]
speed = 8.0                      # m/s at hub height
turbulence_intensity = 0.0
[flow]
solver = "uniform"               # prescribed wind: seconds instead of hours
[time]
spin_up = 60.0                   # s, not analysed
duration = 240.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
structure = "rigid"
[[run]]
name = "baseline"
[[run]]
name = "helix"
control.T1 = { kind = "helix", sense = "ccw", amplitude_deg = 4.0, strouhal = 0.25 }
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut case = case::parse("the example", CASE, &[])?;
    case.wind.speed = 9.0;

    // Case → Prepared (checked, sized, costed) → Ready (pitch responses, turbulence) → runs.
    let prepared = Prepared::of(case)?;
    println!("{} steps of {} s a run", prepared.plan.n_steps, prepared.plan.interval);
    for warning in &prepared.warnings {
        println!("warning: {warning}");
    }
    let ready = prepared.ready()?;

    let mut mean_powers = Vec::new();
    for result in ready.run_all()? {
        let series = &result.series;
        let (times, powers) = (series.column("Time"), series.column("T1.GenPwr"));
        let (times, powers) = times.zip(powers).ok_or("a series has time and power")?;
        let analysed: Vec<f64> =
            times.iter().zip(powers).filter(|(time, _)| **time >= 60.0).map(|row| *row.1).collect();
        let mean = analysed.iter().sum::<f64>() / analysed.len() as f64;
        println!("{:<10} {:.0} kW over {} rows", result.summary.run, mean / 1e3, analysed.len());
        mean_powers.push(mean);
    }
    let gain = mean_powers[1] / mean_powers[0] - 1.0;
    println!("a helix of 4 degrees costs its own turbine {:.2} %", -100.0 * gain);
    assert!((-0.1..0.0).contains(&gain), "a helix costs its own turbine some power");
    Ok(())
}
