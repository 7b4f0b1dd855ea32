//! Channels of a run: every name and its unit, once. Where OpenFAST has a channel, it is OpenFAST's name and
//! unit; the others are named in the same manner.
//!
//! Values in memory are SI whatever the unit: files hold that one, and whoever writes or reads a file
//! converts. `T1.GenPwr` is the channel `GenPwr` of the turbine T1, `T1.GenPwr_kW` its column in a file.

mod loads;
mod unit;

pub use loads::{BLADE_LOADS, N_SPAN_GAUGES, TURBINE_LOADS, loads_of, span_moment};
pub use loads::{ROOT_MXB, ROOT_MYB, ROOT_MYC};
use std::borrow::Cow;
pub use unit::Unit;

/// What ties name and unit in a column of a file.
const BEFORE_UNIT: char = '_';

/// A channel: its name, and the unit that files hold it in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel {
    /// Its name without the unit, such as `GenPwr`, or `T1.GenPwr` of the turbine T1.
    pub name: Cow<'static, str>,
    /// The unit in files.
    pub unit: Unit,
}

impl Channel {
    /// The channel `name` in `unit`.
    pub const fn new(name: &'static str, unit: Unit) -> Self {
        Self { name: Cow::Borrowed(name), unit }
    }

    /// The name that it has at `place`, a turbine or one of its sensors: `T1.GenPwr`.
    pub fn at(&self, place: &str) -> String {
        format!("{place}.{}", self.name)
    }

    /// It, at `place`.
    pub fn of(&self, place: &str) -> Self {
        Self { name: Cow::Owned(self.at(place)), unit: self.unit }
    }

    /// What its column is called: `T1.GenPwr_kW`.
    pub fn column(&self) -> String {
        format!("{}{BEFORE_UNIT}{}", self.name, self.unit.symbol())
    }

    /// The channel whose column is called `column`; none where no unit that is known ends it.
    pub fn of_column(column: &str) -> Option<Self> {
        let (name, unit) = column.rsplit_once(BEFORE_UNIT)?;
        let unit = Unit::of_symbol(unit)?;
        (!name.is_empty()).then(|| Self { name: Cow::Owned(name.to_owned()), unit })
    }
}

/// A channel that every blade has: the blade's number follows the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BladeChannel {
    /// The name before the number.
    pub stem: &'static str,
    /// The unit in files.
    pub unit: Unit,
}

impl BladeChannel {
    /// That of `blade`, numbered from 1: `BldPitch1`.
    pub fn of_blade(&self, blade: usize) -> Channel {
        Channel { name: Cow::Owned(format!("{}{blade}", self.stem)), unit: self.unit }
    }

    /// The names that it has on the `n_blades` blades of `turbine`.
    pub fn at(&self, turbine: &str, n_blades: usize) -> Vec<String> {
        (1..=n_blades).map(|blade| self.of_blade(blade).at(turbine)).collect()
    }
}

/// Time since the start of the run, spin-up included; the first of every series.
pub const TIME: Channel = Channel::new("Time", Unit::Second);

/// Wind at the probe: downwind, to the left, upwards.
pub const WIND: [Channel; 3] = [WIND_U, speed("Wind.V"), speed("Wind.W")];
/// The first of them.
pub const WIND_U: Channel = speed("Wind.U");

/// Electrical power.
pub const GEN_PWR: Channel = Channel::new("GenPwr", Unit::Kilowatt);
/// Torque of the generator, on its own, the high-speed side.
pub const GEN_TQ: Channel = Channel::new("GenTq", Unit::KilonewtonMetre);
/// Speed of the generator, on its own, the high-speed side.
pub const GEN_SPEED: Channel = Channel::new("GenSpeed", Unit::TurnPerMinute);
/// Speed of the rotor.
pub const ROT_SPEED: Channel = Channel::new("RotSpeed", Unit::TurnPerMinute);
/// Azimuth of blade 1.
pub const AZIMUTH: Channel = angle("Azimuth");
/// Turn of the nacelle.
pub const NAC_YAW: Channel = angle("NacYaw");
/// Aerodynamic force of the rotor along the shaft.
pub const RT_AERO_FXH: Channel = Channel::new("RtAeroFxh", Unit::Newton);
/// Aerodynamic torque about the shaft.
pub const RT_AERO_MXH: Channel = Channel::new("RtAeroMxh", Unit::NewtonMetre);
/// Axial wind averaged over the swept area, at the blades. AeroDyn's `RtVAvgxh` is relative to the moving
/// blades, so that this is not it.
pub const ROT_WIND: Channel = speed("RotWind");
/// Pitch of a blade, as the actuator made it.
pub const BLD_PITCH: BladeChannel = BladeChannel { stem: "BldPitch", unit: Unit::Degree };
/// Pitch of a blade, as commanded.
pub const PITCH_CMD: BladeChannel = BladeChannel { stem: "PitchCmd", unit: Unit::Degree };

/// Of every turbine, beside what its blades and its structure have.
pub const OPERATION: [Channel; 9] =
    [GEN_PWR, GEN_TQ, GEN_SPEED, ROT_SPEED, AZIMUTH, NAC_YAW, RT_AERO_FXH, RT_AERO_MXH, ROT_WIND];
/// Of every blade, beside what the structure has.
pub const OPERATION_OF_BLADES: [BladeChannel; 2] = [BLD_PITCH, PITCH_CMD];

/// Mean wind over the rotor, as phase synchronisation estimates it.
pub const EST_WIND: Channel = speed("EstWind");
/// Standard deviation that the estimator has of it.
pub const EST_WIND_DEV: Channel = speed("EstWindDev");
/// The helix in the estimated wind, its tilt and yaw.
pub const EST_WIND_WAVES: [EstimatedWave; 2] = [
    EstimatedWave {
        wind: speed("EstWindTilt"),
        deviation: speed("EstWindTiltDev"),
        amplitude: speed("EstWindTiltAmp"),
        phase: angle("EstWindTiltPhase"),
        phase_deviation: angle("EstWindTiltPhaseDev"),
    },
    EstimatedWave {
        wind: speed("EstWindYaw"),
        deviation: speed("EstWindYawDev"),
        amplitude: speed("EstWindYawAmp"),
        phase: angle("EstWindYawPhase"),
        phase_deviation: angle("EstWindYawPhaseDev"),
    },
];
/// How far the estimated phases can be trusted.
pub const EST_TRUST: Channel = share("EstTrust");
/// Share of the amplitude that trust allows.
pub const SYNC_SHARE: Channel = share("SyncShare");

/// Share of the estimate that comes from a lidar which sees the helix ahead.
pub const PREVIEW_SHARE: Channel = share("PreviewShare");
/// How long the air that it sees takes to the rotor.
pub const PREVIEW_TIME: Channel = Channel::new("PreviewTime", Unit::Second);
/// How late the estimate is since that is less than half a period of the helix.
pub const PREVIEW_LAG: Channel = Channel::new("PreviewLag", Unit::Second);

/// What an estimator tells of the tilt or the yaw of a helix in the wind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EstimatedWave {
    /// The wind now.
    pub wind: Channel,
    /// Standard deviation that the estimator has of it.
    pub deviation: Channel,
    /// Its amplitude.
    pub amplitude: Channel,
    /// Its phase.
    pub phase: Channel,
    /// Standard deviation that the estimator has of the phase.
    pub phase_deviation: Channel,
}

/// Angular frequency of the meandering that is followed.
pub const MEAND_RATE: Channel = Channel::new("MeandRate", Unit::DegreePerSecond);
/// Its phase.
pub const MEAND_PHASE: Channel = angle("MeandPhase");
/// What is followed in the tilt and yaw moments.
pub const MEAND_AXES: [FollowedMoment; 2] = [
    FollowedMoment {
        amplitude: moment("MeandTiltAmp"),
        phase: angle("MeandTiltPhase"),
        offset: moment("MeandTiltOffset"),
        reference: moment("MeandTiltRef"),
        pitch: angle("MeandTiltPitch"),
    },
    FollowedMoment {
        amplitude: moment("MeandYawAmp"),
        phase: angle("MeandYawPhase"),
        offset: moment("MeandYawOffset"),
        reference: moment("MeandYawRef"),
        pitch: angle("MeandYawPitch"),
    },
];
/// Whether the loop is locked.
pub const MEAND_LOCK: Channel = share("MeandLock");
/// Share of the command that is given.
pub const MEAND_SHARE: Channel = share("MeandShare");

/// What a loop follows in one of a rotor's moments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FollowedMoment {
    /// Amplitude.
    pub amplitude: Channel,
    /// Phase.
    pub phase: Channel,
    /// Constant part.
    pub offset: Channel,
    /// Amplitude taken for that of the baseline.
    pub reference: Channel,
    /// Pitch that is added against it.
    pub pitch: Channel,
}

/// Tilt and yaw that are pitched, in the frame that turns with the helix.
pub const HELIX_FRAME: [Channel; 2] = [HELIX_TILT, HELIX_YAW];
/// Tilt that is pitched in the helix frame.
pub const HELIX_TILT: Channel = angle("HelixTilt");
/// Yaw that is pitched there.
pub const HELIX_YAW: Channel = angle("HelixYaw");

/// Where a lidar sees the hub vortex: to the left and up from the rotor's centre, then its tilt and yaw in
/// the frame that turns with the helix, and how far that can be trusted.
pub const HUB_VORTEX: [Channel; 5] = [
    length("HubVortexLeft"),
    length("HubVortexUp"),
    HUB_VORTEX_TILT,
    HUB_VORTEX_YAW,
    HUB_VORTEX_TRUST,
];
/// Tilt of the hub vortex (up) in the helix frame.
pub const HUB_VORTEX_TILT: Channel = length("HubVortexTilt");
/// Its yaw (right, looking downwind) there.
pub const HUB_VORTEX_YAW: Channel = length("HubVortexYaw");
/// How sure it is.
pub const HUB_VORTEX_TRUST: Channel = share("HubVortexTrust");
/// Share of a lidar loop's command that is given.
pub const LOOP_SHARE: Channel = share("LoopShare");
/// Filtered wind speed by which the laws of a lidar loop are blended, where they are several.
pub const LOOP_WIND: Channel = speed("LoopWind");

/// Average, tilt and yaw of the wind along radial lines at the place of an absent turbine.
pub const LINES: [Channel; 3] = [speed("LinesAvg"), speed("LinesTilt"), speed("LinesYaw")];

const fn speed(name: &'static str) -> Channel {
    Channel::new(name, Unit::MetrePerSecond)
}

const fn length(name: &'static str) -> Channel {
    Channel::new(name, Unit::Metre)
}

const fn angle(name: &'static str) -> Channel {
    Channel::new(name, Unit::Degree)
}

const fn moment(name: &'static str) -> Channel {
    Channel::new(name, Unit::KilonewtonMetre)
}

const fn share(name: &'static str) -> Channel {
    Channel::new(name, Unit::One)
}

/// The signals of phase synchronisation, in the order in which it tells them.
pub fn of_phase_sync() -> Vec<Channel> {
    let [tilt, yaw] = EST_WIND_WAVES;
    vec![
        EST_WIND,
        tilt.wind,
        yaw.wind,
        tilt.amplitude,
        yaw.amplitude,
        tilt.phase,
        yaw.phase,
        tilt.phase_deviation,
        yaw.phase_deviation,
        EST_WIND_DEV,
        tilt.deviation,
        yaw.deviation,
        EST_TRUST,
        SYNC_SHARE,
    ]
}

/// The signals of a controller that follows meandering, in the order in which it tells them.
pub fn of_meandering() -> Vec<Channel> {
    let [tilt, yaw] = MEAND_AXES;
    vec![
        MEAND_RATE,
        MEAND_PHASE,
        tilt.amplitude,
        yaw.amplitude,
        tilt.phase,
        yaw.phase,
        tilt.offset,
        yaw.offset,
        tilt.reference,
        yaw.reference,
        MEAND_LOCK,
        MEAND_SHARE,
        tilt.pitch,
        yaw.pitch,
    ]
}

/// The signals of a controller that pitches in the frame that turns with the helix and watches the hub
/// vortex.
pub fn of_helix_frame() -> Vec<Channel> {
    HELIX_FRAME.into_iter().chain(HUB_VORTEX).collect()
}

/// The signals of a lidar loop.
pub fn of_lidar_loop() -> Vec<Channel> {
    of_helix_frame().into_iter().chain([LOOP_SHARE]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_column_tells_name_and_unit_again() {
        for unit in Unit::ALL {
            let channel = Channel { name: Cow::Borrowed("T_1.own.Name_2"), unit };
            assert_eq!(Channel::of_column(&channel.column()), Some(channel));
        }
        assert_eq!(GEN_PWR.of("T1").column(), "T1.GenPwr_kW");
        assert_eq!(BLD_PITCH.of_blade(2).of("T1").column(), "T1.BldPitch2_deg");
        for foreign in ["time_s_", "T1.power_w", "T1.pitch_1_rad", "_kW", "GenPwr", "GenPwr_mW"] {
            assert_eq!(Channel::of_column(foreign), None, "{foreign}");
        }
    }

    #[test]
    fn every_name_of_a_turbine_stands_once() {
        let blades =
            OPERATION_OF_BLADES.iter().flat_map(|channel| [1, 2].map(|b| channel.of_blade(b)));
        let lists = OPERATION.into_iter().chain(blades).chain(loads_of(2));
        let names: Vec<Channel> = lists
            .chain(of_phase_sync())
            .chain(of_meandering())
            .chain(of_lidar_loop())
            .chain([LOOP_WIND, PREVIEW_SHARE, PREVIEW_TIME, PREVIEW_LAG])
            .chain(LINES)
            .collect();
        let unique: BTreeSet<&str> = names.iter().map(|channel| &*channel.name).collect();
        assert_eq!(unique.len(), names.len());
        let is_word = |c: char| c.is_ascii_alphanumeric();
        assert!(unique.iter().all(|name| name.starts_with(char::is_uppercase)), "{unique:?}");
        assert!(unique.iter().all(|name| name.chars().all(is_word)), "{unique:?}");
    }
}
