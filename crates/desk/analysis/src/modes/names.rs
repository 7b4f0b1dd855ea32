//! Frequencies of modes in the words of the rotor and the helix.

/// What `frequency` (Hz) is, where it is within `within` (Hz) of a sum of few multiples of the excitation
/// frequency `excitation` and the rotor's frequency `rotor` (Hz, either may be absent): such as `f_e`, `2
/// f_e`, `3 f_r`, `f_r − f_e`. None where it is near no such sum; of several the one of the lowest multiples.
pub fn frequency_name(
    frequency: f64,
    excitation: Option<f64>,
    rotor: Option<f64>,
    within: f64,
) -> Option<String> {
    let mut best: Option<(i32, f64, String)> = None;
    for of_rotor in 0..=6_i32 {
        for of_helix in -3..=4_i32 {
            let lacks = |multiple: i32, given: Option<f64>| multiple != 0 && given.is_none();
            if lacks(of_rotor, rotor) || lacks(of_helix, excitation) {
                continue;
            }
            let sum = f64::from(of_rotor) * rotor.unwrap_or(0.0)
                + f64::from(of_helix) * excitation.unwrap_or(0.0);
            let (off, order) = ((frequency - sum).abs(), of_rotor + of_helix.abs());
            let is_one = sum > 0.0 && off <= within;
            let beats = |other: &(i32, f64, String)| (order, off) < (other.0, other.1);
            if is_one && best.as_ref().is_none_or(beats) {
                best = Some((order, off, name(of_rotor, of_helix)));
            }
        }
    }
    best.map(|(_, _, name)| name)
}

fn name(of_rotor: i32, of_helix: i32) -> String {
    let part = |multiple: i32, of: &str| match multiple.abs() {
        1 => of.to_owned(),
        multiple => format!("{multiple} {of}"),
    };
    match (of_rotor, of_helix) {
        (0, helix) if helix < 0 => format!("−{}", part(helix, "f_e")),
        (0, helix) => part(helix, "f_e"),
        (rotor, 0) => part(rotor, "f_r"),
        (rotor, helix) => {
            let sign = if helix < 0 { "−" } else { "+" };
            format!("{} {sign} {}", part(rotor, "f_r"), part(helix, "f_e"))
        }
    }
}
