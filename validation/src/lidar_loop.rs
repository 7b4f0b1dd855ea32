//! The chain from a record in a free wake to a loop that a lidar closes: model, controller, and what the loop
//! holds, beside a published study.

use crate::Row;
use crate::row::Tolerance::{AtLeast, AtMost, Within};
use crate::studies::{Carried, failure, find, summaries};
use basis::records::Summary;
use design::{Identified, IdentifyQuestion, Source, SynthesizeQuestion, Synthesized, Trend};
use design::{identify, synthesize};
use std::fs;
use std::path::Path;

/// Where the expected values come from: its sections 3.2.3, 3.3 and 3.3.1.
const SOURCE: &str = "Chen, van Vondelen, van Wingerden (2026), sections 3.2.3 to 3.3.1";
/// What the loop was made to do.
const DESIGN: &str = "the synthesised loop with the model itself";
/// Bounds that no source gives.
const OWN: &str = "this program's claim: the source gives no figure";

/// Time from which the record counts (s): the helix has faded in and its wake has passed the lidar.
const FROM: f64 = 130.0;
/// Samples of the record for one of the model: two seconds.
const DECIMATE: usize = 20;
/// The source's bandwidth (rad/s).
const BANDWIDTH: f64 = 0.02;
/// The source's weights, its Eqs. 11 and 12.
const WEIGHTS: &str = "method = \"h-infinity\"\n\n\
    [performance]\nbandwidth = 0.02\npeak = 10.0\nattenuation = 0.625\n\n\
    [control]\ncorner = 0.15\nratio = 10.0\nscale = 0.4\n";
/// Shift of the reference off where the open helix leaves the wake (m), of the case.
const SHIFT: [f64; 2] = [0.5, -0.5];

/// One turbine in a free wake: a record under noise, a model and a controller of it, the loop closed.
pub fn lidar_loop() -> Vec<Row> {
    made().unwrap_or_else(failure)
}

fn made() -> Result<Vec<Row>, String> {
    let (_, folder) =
        summaries(Carried::Shipped("lidar-identification"), "lidar-loop-record", Vec::new())?;
    // The source has its delay from the zeros of a model that was told none.
    let asked = Asked { decimate: DECIMATE, delay: 16.0, order: 8 };
    let alone = identified(&folder, Asked { delay: 0.0, order: 10, ..asked })?;
    let found = identified(&folder, asked)?;
    let designed = designed(&folder, &found)?;
    let case = Carried::Own(include_str!("../cases/lidar-loop.toml"));
    let (runs, _) = summaries(case, "lidar-loop", Vec::new())?;
    let of = |run: &str| find(&runs, run).ok_or_else(|| format!("there is no run {run}"));
    let mut rows = of_model(&alone, &found)?;
    rows.push(of_loop(&designed)?);
    rows.extend(held(of("open")?, of("closed")?, &designed)?);
    Ok(rows)
}

/// What is asked of a model.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    /// Samples of the record for one of the model (–).
    pub(crate) decimate: usize,
    /// How late its outputs are (s).
    pub(crate) delay: f64,
    /// Its order (–).
    pub(crate) order: usize,
}

/// A model of the record in `folder`, as `asked` for.
pub(crate) fn identified(folder: &Path, asked: Asked) -> Result<Identified, String> {
    let Asked { decimate, delay, order } = asked;
    let of = |what: &str| ["Tilt", "Yaw"].map(|axis| format!("T1.{what}{axis}")).to_vec();
    let question = IdentifyQuestion {
        source: Source {
            file: folder.join("probing"),
            inputs: of("Helix"),
            outputs: of("HubVortex"),
            span: [FROM, f64::INFINITY],
        },
        decimate,
        trend: Trend::Constant,
        windows: [15, 15],
        feedthrough: false,
        order: Some(order),
        delay,
        aside: 0.3,
        bandwidth: BANDWIDTH,
    };
    identify(&question).map_err(|error| error.to_string())
}

/// A controller for the model that was `found`, written into `folder` for the loop.
pub(crate) fn designed(folder: &Path, found: &Identified) -> Result<Synthesized, String> {
    let (model, weights) = (folder.join("model.json"), folder.join("weights.toml"));
    found.model.write(&model).map_err(|error| error.to_string())?;
    fs::write(&weights, WEIGHTS)
        .map_err(|error| format!("{} cannot be written: {error}", weights.display()))?;
    let designed = synthesize(&SynthesizeQuestion { model, weights });
    let designed = designed.map_err(|error| error.to_string())?;
    let law = folder.join("controller.json");
    designed.controller.write(&law).map_err(|error| error.to_string())?;
    Ok(designed)
}

fn of_model(alone: &Identified, found: &Identified) -> Result<Vec<Row>, String> {
    let here =
        "nrel-5mw in a free wake, 10 m/s even, helix 3° ccw at St 0.3 with 1° of noise, 870 s";
    let row = |what: &str, measured, expected, tolerance, unit, source| Row {
        what: format!("{here}: {what}"),
        measured,
        expected,
        tolerance,
        unit,
        source,
    };
    let [_, aside] = &found.accounted_for;
    let [rest, _] = found.relative_gains.as_ref().ok_or("there are no relative gains")?;
    // The source's commands go through such an offset.
    let offset = found.azimuth_offset.as_ref().ok_or("there is no azimuth offset")?;
    tell!("azimuth offset that decouples at rest: {:.1}°", offset.angle.to_degrees());
    let [_, turned] = &offset.relative_gains;
    tell!("gain at rest (m/deg): {:.3?}", found.gain);
    let mut rows: Vec<Row> = ["tilt", "yaw"]
        .iter()
        .zip(aside)
        .map(|(axis, share)| {
            let what = format!(
                "variance of the wake's {axis} kept aside that a model of order 8 accounts for"
            );
            row(&what, *share, 80.0, AtLeast, "%", OWN)
        })
        .collect();
    rows.push(row(
        "delay, half the sum of 2/z over the zeros of a model of order 10 without one",
        // Each zero pair stands for a delay of one output: both are late.
        0.5 * alone.delay_of_zeros,
        11.2,
        Within(2.0),
        "s",
        SOURCE,
    ));
    rows.push(row("first relative gain at rest", rest[0][0], 0.9935, Within(0.1), "–", SOURCE));
    rows.push(row(
        "first relative gain at 0.02 rad/s, commands turned by the offset that decouples at rest",
        turned[0][0],
        -1.278,
        Within(0.3),
        "–",
        SOURCE,
    ));
    Ok(rows)
}

fn of_loop(designed: &Synthesized) -> Result<Row, String> {
    let [sensitivity, complementary] = designed.peaks;
    tell!(
        "without the delay: peaks of S {sensitivity:.3} and T {complementary:.3}, bandwidth {:.4?} rad/s, margins {:?}",
        designed.bandwidth,
        designed.margins
    );
    tell!("with the delay and its predictor: {:?}", designed.with_delay);
    Ok(Row {
        what: "norm of the weighted loop without its delay, by its own Hamiltonian".to_owned(),
        measured: designed.achieved.ok_or("the controller has no norm")?,
        expected: 1.0,
        tolerance: AtMost,
        unit: "–",
        source: OWN,
    })
}

/// Share of a step by [`SHIFT`] that the design leaves at last (–).
fn left(designed: &Synthesized) -> Result<f64, String> {
    let last = |reference: usize, output: usize| {
        let samples = designed.steps.get(reference).and_then(|samples| samples.last());
        let answer = samples.and_then(|outputs| outputs.get(output)).copied();
        answer.ok_or("the design has no step response")
    };
    let mut squares = 0.0;
    for (output, asked) in SHIFT.iter().enumerate() {
        let reached = SHIFT[0] * last(0, output)? + SHIFT[1] * last(1, output)?;
        squares += (asked - reached).powi(2);
    }
    Ok(squares.sqrt() / SHIFT[0].hypot(SHIFT[1]))
}

/// What the two runs tell: whether an open helix stands still, and whether the loop moves the wake.
fn held(open: &Summary, closed: &Summary, designed: &Synthesized) -> Result<[Row; 3], String> {
    let names = ["hub-vortex-tilt", "hub-vortex-yaw", "hub-vortex-spread"];
    let [open_tilt, open_yaw, open_spread] = findings(open, names)?;
    let [tilt, yaw, spread] = findings(closed, names)?;
    let [distance] = findings(closed, ["reference-distance"])?;
    tell!("open at {open_tilt:.3} m and {open_yaw:.3} m, spread {open_spread:.3} m");
    tell!(
        "closed at {tilt:.3} m and {yaw:.3} m, {distance:.3} m off its reference, spread {spread:.3} m"
    );
    let here = "nrel-5mw in a free wake, 10 m/s even, helix 3° ccw at St 0.3";
    let row = |what: &str, measured, expected, tolerance, source| Row {
        what: format!("{here}: {what}"),
        measured,
        expected,
        tolerance,
        unit: "–",
        source,
    };
    Ok([
        row(
            "open, spread of the wake's centroid in the helix frame over its mean distance",
            open_spread / open_tilt.hypot(open_yaw),
            0.1,
            AtMost,
            OWN,
        ),
        row(
            "closed, what is left of a step of 0.71 m from 150 s to 360 s after it",
            distance / SHIFT[0].hypot(SHIFT[1]),
            left(designed)?,
            Within(0.05),
            DESIGN,
        ),
        row("closed, spread over that of the open helix", spread / open_spread, 1.0, AtMost, OWN),
    ])
}

/// What the controller of the one turbine of a run found.
fn findings<const N: usize>(run: &Summary, names: [&str; N]) -> Result<[f64; N], String> {
    let turbine = run.turbines.first().ok_or("a run without a turbine")?;
    let mut values = [0.0; N];
    for (value, name) in values.iter_mut().zip(names) {
        let found = turbine.control.findings.iter().find(|finding| finding.name == name);
        let found = found.and_then(|finding| finding.value);
        *value = found.ok_or_else(|| format!("{}: its controller tells no {name}", run.run))?;
    }
    Ok(values)
}
