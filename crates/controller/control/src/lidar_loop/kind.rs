//! `kind = "lidar-loop"`: its keys, and how it is built.

use super::findings::{of_loop, of_reference};
use super::{CHANNELS, LidarLoop, Limits, Settings, Watch, findings};
use crate::Controller;
use crate::discon::base;
use crate::error::ControlError;
use crate::excitation::Excitation;
use crate::keys::{
    AMPLITUDE, AZIMUTH_OFFSET, BASE, LIDAR, SENSE, START, STROUHAL, TILT_PHASE, VORTEX_CENTRE,
    VORTEX_FILTER, VORTEX_INTERVAL, sense, starts_too_late,
};
use crate::kind::{Control, ControllerKind, Place, Site};
use crate::library::Hosted;
use crate::linear_law::LawFiles;
use crate::outcome::{MissingChannel, Outcome, TurbineRecord};
use basis::channels::{HUB_VORTEX_TRUST, LOOP_SHARE};
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
        _ => control.linear_law.as_ref()?.reference?,
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
            Holds::Text,
            "",
            Required,
            "File of the control law that `wakemix synthesize` wrote: from errors of the hub vortex (m) to tilt and yaw (deg), in the helix frame; a path relative to the case file. Where there is no `lidar-loop-controller.json`, that name is the one that comes with the program.",
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
        BASE[4],
    ],
};

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
        starts_too_late(values, place.duration).into_iter().chain(reference).collect()
    }

    fn build(&self, control: &Control, site: &Site) -> Result<Box<dyn Controller>, ControlError> {
        let values = control.values();
        let strouhal = values.number("strouhal");
        let frame = HelixFrame { sense: sense(values), rate: site.rate(strouhal) };
        let amplitude = values.angle("amplitude_deg");
        let start = values.number("start");
        let Some(law) = &control.linear_law else {
            return Err(ControlError::NoLinearLaw { file: values.word("controller").to_owned() });
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
        if law.interval < site.interval * (1.0 - 1e-6) {
            return Err(ControlError::FastLinearLaw {
                file: law.file.clone(),
                interval: law.interval,
                control: site.interval,
            });
        }
        let watch = Watch::of(values, site, frame)?;
        let law = (law.recursion.clone(), law.interval);
        Ok(LidarLoop::new(settings, watch, law).on_top_of(base(control, site)?))
    }

    fn law_files(&self, control: &Control) -> Option<LawFiles> {
        let values = control.values();
        Some(LawFiles {
            law: values.word("controller").to_owned(),
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

    fn outcome_channels(&self, _: &Control, _: usize) -> Vec<Channel> {
        CHANNELS.into_iter().chain([LOOP_SHARE, HUB_VORTEX_TRUST]).collect()
    }

    fn outcome(
        &self,
        control: &Control,
        record: &dyn TurbineRecord,
    ) -> Result<Outcome, MissingChannel> {
        let findings = findings(record)?;
        let reference = reference(control).map(|reference| of_reference(reference, &findings));
        let (of_loop, warning) = of_loop(record, control.values().number("least_trust"))?;
        let findings = findings.into_iter().chain(reference.into_iter().flatten()).chain(of_loop);
        Ok(Outcome {
            findings: findings.collect(),
            warnings: Vec::from_iter(warning),
            ..Outcome::default()
        })
    }
}
