//! A case that runs in a moment.

/// The case called `name`: one turbine, T1, for 40 s in steady wind; `rest`, with further turbines and the
/// runs, stands behind it.
pub(crate) fn case(name: &str, rest: &str) -> String {
    format!(
        r#"
name = "{name}"
[wind]
speed = 9.0
turbulence_intensity = 0.0
[flow]
solver = "uniform"
[time]
spin_up = 10.0
duration = 40.0
[[turbine]]
name = "T1"
model = "nrel-5mw"
position_diameters = [0.0, 0.0]
{rest}"#
    )
}
