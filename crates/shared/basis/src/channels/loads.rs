//! Loads and motions of a turbine's structure, ElastoDyn's.

use super::{BladeChannel, Channel, Unit};
use std::borrow::Cow;

const FORCE: Unit = Unit::Kilonewton;
const MOMENT: Unit = Unit::KilonewtonMetre;
const ACCELERATION: Unit = Unit::MetrePerSecondSquared;

/// Strain gauges along a blade (–): at 1/8 to 7/8 of it.
pub const N_SPAN_GAUGES: usize = 7;

/// Out-of-plane moment at a blade's root.
pub const ROOT_MYC: BladeChannel = BladeChannel { stem: "RootMyc", unit: MOMENT };
/// Edgewise moment at a blade's root, in axes that pitch.
pub const ROOT_MXB: BladeChannel = BladeChannel { stem: "RootMxb", unit: MOMENT };
/// Flapwise moment at a blade's root, in axes that pitch.
pub const ROOT_MYB: BladeChannel = BladeChannel { stem: "RootMyb", unit: MOMENT };

const fn of(stem: &'static str, unit: Unit) -> BladeChannel {
    BladeChannel { stem, unit }
}

/// Of one turbine.
pub const TURBINE_LOADS: [Channel; 28] = [
    Channel::new("RotThrust", FORCE),
    Channel::new("RotTorq", MOMENT),
    Channel::new("LSShftFys", FORCE),
    Channel::new("LSShftFzs", FORCE),
    Channel::new("LSSTipMys", MOMENT),
    Channel::new("LSSTipMzs", MOMENT),
    Channel::new("LSShftFya", FORCE),
    Channel::new("LSShftFza", FORCE),
    Channel::new("LSSTipMya", MOMENT),
    Channel::new("LSSTipMza", MOMENT),
    Channel::new("YawBrFxp", FORCE),
    Channel::new("YawBrFyp", FORCE),
    Channel::new("YawBrFzp", FORCE),
    Channel::new("YawBrMxp", MOMENT),
    Channel::new("YawBrMyp", MOMENT),
    Channel::new("YawBrMzp", MOMENT),
    Channel::new("TwrBsFxt", FORCE),
    Channel::new("TwrBsFyt", FORCE),
    Channel::new("TwrBsFzt", FORCE),
    Channel::new("TwrBsMxt", MOMENT),
    Channel::new("TwrBsMyt", MOMENT),
    Channel::new("TwrBsMzt", MOMENT),
    Channel::new("TTDspFA", Unit::Metre),
    Channel::new("TTDspSS", Unit::Metre),
    Channel::new("TTDspAx", Unit::Metre),
    Channel::new("NcIMUTAxs", ACCELERATION),
    Channel::new("NcIMUTAys", ACCELERATION),
    Channel::new("NcIMUTAzs", ACCELERATION),
];

/// Of one blade, before the gauges along it.
pub const BLADE_LOADS: [BladeChannel; 13] = [
    of("RootFxc", FORCE),
    of("RootFyc", FORCE),
    of("RootFzc", FORCE),
    of("RootMxc", MOMENT),
    ROOT_MYC,
    of("RootMzc", MOMENT),
    of("RootFxb", FORCE),
    of("RootFyb", FORCE),
    ROOT_MXB,
    ROOT_MYB,
    of("OoPDefl", Unit::Metre),
    of("IPDefl", Unit::Metre),
    of("TipDzc", Unit::Metre),
];

/// Moment at `gauge` of `blade`, both numbered from 1, about the local axis `axis`, `x` or `y`.
pub fn span_moment(gauge: usize, axis: char, blade: usize) -> Channel {
    Channel { name: Cow::Owned(format!("Spn{gauge}ML{axis}b{blade}")), unit: MOMENT }
}

/// Of a turbine of `n_blades` blades.
pub fn loads_of(n_blades: usize) -> Vec<Channel> {
    let mut channels = TURBINE_LOADS.to_vec();
    for blade in 1..=n_blades {
        channels.extend(BLADE_LOADS.iter().map(|channel| channel.of_blade(blade)));
        for gauge in 1..=N_SPAN_GAUGES {
            channels.extend(['x', 'y'].map(|axis| span_moment(gauge, axis, blade)));
        }
    }
    channels
}
