//! `kind = "lidar-loop"`: its keys, and how it is built.

use super::family::{Family, FamilyState, Schedule};
use super::findings::{of_loop, of_reference, of_wind};
use super::{CHANNELS, LidarLoop, Limits, Settings, Watch, checks, findings};
use crate::Controller;
use crate::discon::base;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::keys::{
    AMPLITUDE, AZIMUTH_OFFSET, BASE, LIDAR, SENSE, START, STROUHAL, TILT_PHASE, VORTEX_CENTRE,
    VORTEX_FILTER, VORTEX_INTERVAL, sense, starts_too_late,
};
use crate::kind::{Control, ControllerKind, Place, Site};
use crate::library::{ANEMOMETER, Hosted};
use crate::linear_law::LawFiles;
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::channels::{HUB_VORTEX_TRUST, LOOP_SHARE, LOOP_WIND};
use basis::keys::LeftOut::{Otherwise, Required, Value};
use basis::keys::{Holds, Objection, Table, Values, above, from, key};
use basis::registry::Named;
use basis::{Channel, HelixFrame, Sense};

/// The lidar loop.
pub struct LidarLoopKind;

/// The kind.
pub static LIDAR_LOOP: LidarLoopKind = LidarLoopKind;

/// Where the hub vortex is to be (m); none of a run of reference that is not read.
fn reference(control: &Control) -> Option<[f64; 2]> {
    let values = control.values();
    let given = ["reference_tilt", "reference_yaw"].map(|key| values.optional_number(key));
    let place = match given {
        [Some(tilt), Some(yaw)] => [tilt, yaw],
        _ => control.linear_laws.as_ref()?.reference?,
    };
    let shift = ["reference_shift_tilt", "reference_shift_yaw"].map(|key| values.number(key));
    Some([0, 1].map(|axis| place[axis] + shift[axis]))
}

static TABLE: Table = Table {
    heading: "control.T1 = { kind = \"lidar-loop\", … }",
    about: "A helix whose hub vortex, seen by a lidar that looks downwind, is held where it is wanted in the helix frame (Chen et al. 2026), on top of baseline.",
    keys: &[
        SENSE,
        AMPLITUDE,
        STROUHAL,
        key(
            "controller",
            Holds::Files(&MEMBER),
            "",
            Required,
            "File of the control law that `wakemix synthesize` wrote: from errors of the hub vortex (m) to tilt and yaw (deg), in the helix frame; a path relative to the case file. Where there is no `lidar-loop-controller.json`, that name is the one that comes with the program. Or a family of laws, each made at a wind speed: `[{ wind_speed = 8.0, file = \"law-8.json\" }, { wind_speed = 10.0, file = \"law-10.json\" }]`, in ascending order, all of one interval. All run on the same error, the two next to the measured wind speed are blended linearly, and beyond the first and the last the command is theirs.",
        ),
        key(
            "wind_filter_time",
            above(0.0, 1e5),
            "s",
            Otherwise("60 with a family of laws"),
            "Time constant of the low-pass filter on the wind speed of `anemometer`, by which a family is blended; slower than the helix, so that the wake's own swing blends nothing.",
        ),
        key(
            "reference_tilt",
            from(-500.0, 500.0),
            "m",
            Otherwise("the mean of `reference_run`"),
            "Where the hub vortex is to be in the helix frame, up component.",
        ),
        key(
            "reference_yaw",
            from(-500.0, 500.0),
            "m",
            Otherwise("the mean of `reference_run`"),
            "The same, component to the right.",
        ),
        key(
            "reference_run",
            Holds::Text,
            "",
            Otherwise("none: `reference_tilt` and `reference_yaw` say where"),
            "Folder of a complete run whose mean hub vortex of this turbine is the reference, such as one with an open helix in even wind (`kind = \"probing\"` with `noise_amplitude_deg = 0`); a path relative to the case file. A run that the same command makes is made first.",
        ),
        key(
            "reference_shift_tilt",
            from(-500.0, 500.0),
            "m",
            Value("0"),
            "Added to the reference, up component: another place beside that of a run.",
        ),
        key(
            "reference_shift_yaw",
            from(-500.0, 500.0),
            "m",
            Value("0"),
            "The same, component to the right.",
        ),
        key(
            "loop_start",
            from(0.0, 1e6),
            "s",
            Otherwise("`start`"),
            "Time from which the loop is closed; before that the helix is open.",
        ),
        LIDAR,
        VORTEX_FILTER,
        VORTEX_CENTRE,
        VORTEX_INTERVAL,
        key(
            "least_trust",
            from(0.0, 1.0),
            "–",
            Value("0.1"),
            "Confidence in the hub vortex below which the lidar counts as blind.",
        ),
        key(
            "blind_after",
            above(0.0, 1e5),
            "s",
            Value("5"),
            "Time without a hub vortex after which the loop fades out to the open helix, over one period of it, before it can close again.",
        ),
        key(
            "correction_limit_deg",
            above(0.0, 10.0),
            "deg",
            Value("3"),
            "Most that the loop adds to the open helix.",
        ),
        key(
            "correction_rate_deg_per_s",
            above(0.0, 20.0),
            "deg/s",
            Value("0.5"),
            "Greatest rate at which that changes, in the helix frame.",
        ),
        TILT_PHASE,
        AZIMUTH_OFFSET,
        START,
        BASE[0],
        BASE[1],
        BASE[2],
        BASE[3],
        key(
            "anemometer",
            Holds::Name,
            "",
            Otherwise("the turbine's sensor called `anemometer`"),
            "Sensor of the turbine whose first value is the wind speed by which a family of laws is blended, in the free stream's terms: give an anemometer the `factor` that its place asks for. It shows a library its wind too: speed (record 27), and yaw error where it has a second channel (record 24); `none` for a library that looks at no wind, with one law.",
        ),
    ],
};

static MEMBER: Table = Table {
    heading: "control.T1.controller = [{ … }, …]",
    about: "A law of a family of the lidar loop, and the wind speed that it was made at.",
    keys: &[
        key(
            "wind_speed",
            above(0.0, 100.0),
            "m/s",
            Required,
            "Wind speed of the record that the law's model was identified from; greater than that of the law before.",
        ),
        key(
            "file",
            Holds::Text,
            "",
            Required,
            "File of the law that `wakemix synthesize` wrote; a path relative to the case file.",
        ),
    ],
};

/// Time constant of the filter on the wind speed (s), where none is given.
const WIND_FILTER_TIME: f64 = 60.0;

impl Named for LidarLoopKind {
    fn name(&self) -> &'static str {
        "lidar-loop"
    }
}

impl ControllerKind for LidarLoopKind {
    fn table(&self) -> &'static Table {
        &TABLE
    }

    fn check(&self, values: &mut Values, place: &Place) -> Vec<Objection> {
        let given = ["reference_tilt", "reference_yaw"].map(|key| values.has(key));
        let reference = match (given, values.has("reference_run")) {
            ([true, true], false) | ([false, false], true) => None,
            ([false, false], false) => Some("no reference is given"),
            (_, true) => Some("the reference is given twice"),
            (_, false) => Some("half of the reference is given"),
        };
        let reference = reference.map(|label| Objection {
            key: None,
            message: "needs to know where the hub vortex is to be".to_owned(),
            label,
            fix: "give `reference_tilt` and `reference_yaw`, or `reference_run`".to_owned(),
        });
        let late = starts_too_late(values, place.duration);
        let lidar = checks::no_lidar(values, place);
        let laws = match schedule(values) {
            Some(schedule) => checks::of_family(&schedule, &files(values), place),
            None => checks::of_one_law(values),
        };
        late.into_iter().chain(reference).chain(lidar).chain(laws).collect()
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let values = control.values();
        let strouhal = values.number("strouhal");
        let frame = HelixFrame { sense: sense(values), rate: site.rate(strouhal) };
        let amplitude = values.angle("amplitude_deg");
        let start = values.number("start");
        let Some(laws) = &control.linear_laws else {
            return Err(ControlError::NoLinearLaws { files: files(values).join(", ") });
        };
        let reference = reference(control).ok_or_else(|| ControlError::NoReference {
            run: values.word("reference_run").to_owned(),
        })?;
        let settings = Settings {
            frame,
            amplitude,
            strouhal,
            helix: frame.open_helix(amplitude, values.angle("phase_deg")),
            azimuth_offset: values.angle("azimuth_offset_deg"),
            reference,
            starts: [start, values.optional_number("loop_start").unwrap_or(start)],
            blind_after: values.number("blind_after"),
            least_trust: values.number("least_trust"),
            limits: Limits {
                size: values.angle("correction_limit_deg"),
                rate: values.angle("correction_rate_deg_per_s"),
            },
        };
        if let Some(law) = laws.laws.first()
            && laws.interval < site.interval * (1.0 - 1e-6)
        {
            return Err(ControlError::FastLinearLaw {
                file: law.file.clone(),
                interval: laws.interval,
                control: site.interval,
            });
        }
        let family = Family { schedule: schedule(values), interval: laws.interval };
        let laws = laws.laws.iter().map(|law| law.recursion.clone()).collect();
        let watch = Watch::of(values, site, frame)?;
        let begun = LidarLoop::new(settings, watch, family, FamilyState::at_rest(laws));
        Ok(begun.on_top_of(base(control, site)?))
    }

    fn law_files(&self, control: &Control) -> Option<LawFiles> {
        let values = control.values();
        Some(LawFiles {
            laws: files(values),
            reference_run: values
                .has("reference_run")
                .then(|| values.word("reference_run").to_owned()),
        })
    }

    fn helix(&self, control: &Control) -> Option<(Sense, f64)> {
        let values = control.values();
        Some((sense(values), values.number("strouhal")))
    }

    fn hosted(&self, control: &Control) -> Option<Hosted> {
        Hosted::of(control.values())
    }

    fn outcome_channels(&self, control: &Control, _: usize) -> Vec<Channel> {
        let wind = schedule(control.values()).map(|_| LOOP_WIND);
        CHANNELS.into_iter().chain([LOOP_SHARE, HUB_VORTEX_TRUST]).chain(wind).collect()
    }

    fn outcome(
        &self,
        control: &Control,
        record: &dyn TurbineRecord,
    ) -> Result<Outcome, MissingChannel> {
        let mut findings = findings(record)?;
        let reference = reference(control).map(|reference| of_reference(reference, &findings));
        let (of_loop, warning) = of_loop(record, control.values().number("least_trust"))?;
        findings.extend(reference.into_iter().flatten().chain(of_loop));
        let mut warnings = Vec::from_iter(warning);
        if let Some(schedule) = schedule(control.values()) {
            let (found, warning) = of_wind(&schedule.speeds, record.column(&LOOP_WIND)?);
            findings.push(found);
            warnings.extend(warning);
        }
        Ok(Outcome { findings, warnings, ..Outcome::default() })
    }
}

/// Files of the laws that `values` name, in their order.
fn files(values: &Values) -> Vec<String> {
    match values.tables("controller") {
        [] => vec![values.word("controller").to_owned()],
        members => members.iter().map(|member| member.word("file").to_owned()).collect(),
    }
}

/// How the laws that `values` name are blended; none of one alone.
fn schedule(values: &Values) -> Option<Schedule> {
    let members = values.tables("controller");
    (members.len() > 1).then(|| Schedule {
        speeds: members.iter().map(|member| member.number("wind_speed")).collect(),
        anemometer: anemometer(values).to_owned(),
        filter_time: values.optional_number("wind_filter_time").unwrap_or(WIND_FILTER_TIME),
    })
}

/// The sensor that shows the wind.
fn anemometer(values: &Values) -> &str {
    if values.has("anemometer") { values.word("anemometer") } else { ANEMOMETER }
}
