//! The wind of a case at any points: here a shear that turns with height, and a gust that passes.
//!
//! cargo run --release -p wakemix --example 04-sample-the-wind

use wakemix::basis::Vector3;
use wakemix::farm::Unrecorded;
use wakemix::flow::WindField;
use wakemix::formats::case;
use wakemix::study::Prepared;

const CASE: &str = r#"
name = "wind"
[wind]
speed = 10.0
turbulence_intensity = 0.0
shear_exponent = 0.2
event = { kind = "ramp", start = 10.0, duration = 20.0, speed = 12.0 }
[flow]
solver = "uniform"
[time]
spin_up = 0.0
duration = 40.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
[[run]]
name = "baseline"
"#;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ready = Prepared::of(case::parse("wind", CASE, &[])?)?.ready()?;
    let hub_height = ready.prepared.plan.hub_height;
    let mut farm = ready.farm(&ready.prepared.case.runs[0])?;
    // x downwind, y left, z up; the origin is the foot of the first turbine.
    let points = [0.5, 1.0, 1.5].map(|height| Vector3::new(0.0, 0.0, height * hub_height));
    let mut wind = [Vector3::ZERO; 3];
    for time in [0.0, 20.0, 40.0] {
        while farm.time() < time {
            farm.advance(&mut Unrecorded)?;
        }
        farm.flow().sample(&points, &mut wind);
        let speeds = wind.map(|wind| format!("{:6.3}", wind.x)).join(" ");
        println!("{:4.0} s: {speeds} m/s at half, one and one and a half hub heights", farm.time());
        let hub_speed = 10.0 + 2.0 * ((time - 10.0) / 20.0).clamp(0.0, 1.0);
        for (wind, point) in wind.iter().zip(&points) {
            let expected = hub_speed * (point.z / hub_height).powf(0.2);
            assert!((wind.x - expected).abs() < 1e-2, "{} m/s, not {expected}", wind.x);
        }
    }
    Ok(())
}
