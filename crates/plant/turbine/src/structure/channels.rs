//! Loads under the names, axes and signs of OpenFAST's ElastoDyn.

use super::loads::{Loads, N_GAUGES};
use super::machine::Pitch;
use basis::channels::{
    AZIMUTH, BLADE_LOADS, BLD_PITCH, BladeChannel, Channel, GEN_SPEED, N_SPAN_GAUGES, NAC_YAW,
    ROT_SPEED, TURBINE_LOADS, span_moment,
};

/// How the turbine stands and turns; before its loads.
const MOTION: [Channel; 4] = [AZIMUTH, ROT_SPEED, GEN_SPEED, NAC_YAW];

const _: () = assert!(N_GAUGES == N_SPAN_GAUGES, "every gauge has its channels");

/// Channels of one blade, before those of its gauges.
fn of_blade() -> impl Iterator<Item = BladeChannel> {
    std::iter::once(BLD_PITCH).chain(BLADE_LOADS)
}

/// OpenFAST's other names of the same channels; a blade's number follows both, or neither.
const ALIASES: [(&str, &str); 26] = [
    ("RotSpeed", "LSSTipVxa"),
    ("NacYaw", "YawPzn"),
    ("RotThrust", "LSShftFxa"),
    ("RotThrust", "LSShftFxs"),
    ("RotTorq", "LSShftTq"),
    ("RotTorq", "LSShftMxa"),
    ("RotTorq", "LSShftMxs"),
    ("RotTorq", "LSSGagMxa"),
    ("RotTorq", "LSSGagMxs"),
    ("LSSTipMys", "LSSGagMys"),
    ("LSSTipMzs", "LSSGagMzs"),
    ("LSSTipMya", "LSSGagMya"),
    ("LSSTipMza", "LSSGagMza"),
    ("YawBrFzp", "YawBrFzn"),
    ("YawBrMzp", "YawBrMzn"),
    ("TTDspFA", "YawBrTDxt"),
    ("TTDspSS", "YawBrTDyt"),
    ("RootFzc", "RootFzb"),
    ("RootMzc", "RootMzb"),
    ("RootMxc", "RootMIP"),
    ("RootMyc", "RootMOoP"),
    ("RootMxb", "RootMEdg"),
    ("RootMyb", "RootMFlp"),
    ("OoPDefl", "TipDxc"),
    ("IPDefl", "TipDyc"),
    ("TipDzc", "TipDzb"),
];

/// The table of channels of a turbine with `n_blades` blades.
///
/// `Spn1` to `Spn7` lie at 1/8 to 7/8 of the blade; the shaft's strain gauges lie at the rotor apex.
pub(super) fn table(n_blades: usize) -> Vec<Channel> {
    let mut channels: Vec<Channel> = MOTION.into_iter().chain(TURBINE_LOADS).collect();
    for blade in 1..=n_blades {
        channels.extend(of_blade().map(|channel| channel.of_blade(blade)));
        for gauge in 1..=N_GAUGES {
            channels.extend(['x', 'y'].map(|axis| span_moment(gauge, axis, blade)));
        }
    }
    channels
}

/// Index of the channel called `name` in `table`; case does not matter, and OpenFAST's other names work too.
pub(super) fn index(table: &[Channel], name: &str) -> Option<usize> {
    let find = |name: &str| table.iter().position(|c| c.name.eq_ignore_ascii_case(name));
    find(name).or_else(|| find(&canonical(name)?))
}

/// The name under which the channel called `name` is written: `RootMyb1` for `RootMFlp1`; None where `name`
/// is not an alias of a channel. Case does not matter.
///
/// The shaft's strain gauges (`LSSGagMys`) stand for the moments at the rotor apex. Gauges that OpenFAST's
/// `ShftGagL` puts elsewhere measure another bending moment.
pub fn canonical(name: &str) -> Option<String> {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let number = &name[stem.len()..];
    let (same, _) = ALIASES.iter().find(|(_, alias)| alias.eq_ignore_ascii_case(stem))?;
    let of_blade = of_blade().any(|blade| blade.stem == *same);
    (of_blade != number.is_empty()).then(|| format!("{same}{number}"))
}

/// On return `values` holds each channel of the table in SI units (N, N m, m, rad, rad/s, m/s²); bearings
/// stand at the `pitch` of their blades less the `misalignment` that blades are mounted with (rad).
pub(super) fn write(
    loads: &Loads,
    yaw: f64,
    pitch: &[Pitch],
    misalignment: &[f64],
    values: &mut [f64],
) {
    let mut rest = values.iter_mut();
    let mut put = |value: f64| {
        if let Some(slot) = rest.next() {
            *slot = value;
        }
    };
    let (shaft, rotating) = (&loads.shaft, &loads.rotating_shaft);
    [
        basis::angle::wrap_to_turn(loads.azimuth),
        loads.rotor_speed,
        loads.generator_speed,
        yaw,
        shaft.force.x,
        shaft.moment.x,
        shaft.force.y,
        shaft.force.z,
        shaft.moment.y,
        shaft.moment.z,
        rotating.force.y,
        rotating.force.z,
        rotating.moment.y,
        rotating.moment.z,
    ]
    .into_iter()
    .for_each(&mut put);
    for wrench in [&loads.yaw_bearing, &loads.tower_base] {
        wrench.force.to_array().into_iter().for_each(&mut put);
        wrench.moment.to_array().into_iter().for_each(&mut put);
    }
    loads.tower_top.to_array().into_iter().for_each(&mut put);
    loads.nacelle_acceleration.to_array().into_iter().for_each(&mut put);
    for ((blade, pitch), misalignment) in loads.blades.iter().zip(pitch).zip(misalignment) {
        put(pitch.angle - misalignment);
        blade.root.force.to_array().into_iter().for_each(&mut put);
        blade.root.moment.to_array().into_iter().for_each(&mut put);
        let pitched = &blade.pitched_root;
        [pitched.force.x, pitched.force.y, pitched.moment.x, pitched.moment.y]
            .into_iter()
            .for_each(&mut put);
        blade.tip_deflection.to_array().into_iter().for_each(&mut put);
        blade.span_moments.iter().flatten().for_each(|moment| put(*moment));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::PerBlade;

    #[test]
    fn names_are_unique_and_aliases_lead_to_them() {
        let table = table(4);
        for (place, channel) in table.iter().enumerate() {
            assert_eq!(index(&table, &channel.name), Some(place), "{}", channel.name);
        }
        for (name, alias) in ALIASES {
            let number = if of_blade().any(|blade| blade.stem == name) { "4" } else { "" };
            let found = index(&table, &format!("{alias}{number}"));
            assert_eq!(found, index(&table, &format!("{name}{number}")), "{alias}");
            assert!(found.is_some(), "{alias}");
        }
        assert_eq!(index(&table, "rootmyc2"), index(&table, "RootMOoP2"));
        assert_eq!(index(&table, "RootMyc5"), None);
        assert_eq!(canonical("rootmflp2").as_deref(), Some("RootMyb2"));
        assert_eq!(canonical("LSSGagMxs").as_deref(), Some("RotTorq"));
        for name in ["RootMFlp", "LSSGagMxs1", "RootMyb1", "", "7"] {
            assert_eq!(canonical(name), None, "{name}");
        }
        assert_eq!(index(&table, "é9"), None);
    }

    #[test]
    fn every_channel_is_written_in_its_place() {
        let table = table(2);
        let mut loads = Loads {
            azimuth: 7.0,
            rotor_speed: 1.0,
            generator_speed: 2.0,
            blades: PerBlade::splat(2, Default::default()),
            shaft: Default::default(),
            rotating_shaft: Default::default(),
            yaw_bearing: Default::default(),
            tower_base: Default::default(),
            tower_top: Default::default(),
            nacelle_acceleration: basis::Vector3::new(0.0, 0.0, 5.0),
        };
        loads.tower_base.moment.y = 11.0;
        loads.blades[1].root.moment.y = 12.0;
        loads.blades[1].span_moments[N_GAUGES - 1][1] = 13.0;
        let mut values = vec![f64::NAN; table.len()];
        write(&loads, 0.1, &[Pitch::default(); 2], &[0.0; 2], &mut values);
        assert!(values.iter().all(|value| value.is_finite()));
        let value = |name: &str| index(&table, name).map(|place| values[place]);
        assert_eq!(value("GenSpeed"), Some(2.0));
        assert_eq!(value("NacYaw"), Some(0.1));
        assert_eq!(value("NcIMUTAzs"), Some(5.0));
        assert_eq!(value("TwrBsMyt"), Some(11.0));
        assert_eq!(value("RootMyc2"), Some(12.0));
        assert_eq!(values.last(), Some(&13.0));
        assert!((value("Azimuth").unwrap() - (7.0 - std::f64::consts::TAU)).abs() < 1e-12);
    }
}
