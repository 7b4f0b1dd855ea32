//! A case as text: every key written out, defaults included.

use super::instruments::instruments_text;
use super::keys;
use super::kinds;
use super::momentum::momentum_text;
use super::position::{misalignment_text, position_text, yaw_text};
use super::solver::write_flow;
use super::text::quoted;
use super::wind::write_wind;
use farm::case::{Case, Output, Placement, Run};
use std::fmt::Write;

/// Length of blocks that a case need not say (s).
const USUAL_BLOCK: f64 = 600.0;

/// The case file that reads back as `case`, with every default written out.
pub fn write(case: &Case) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_to(&mut text, case);
    text
}

fn write_to(text: &mut String, case: &Case) -> std::fmt::Result {
    writeln!(text, "name = {}", quoted(&case.name))?;
    if let Some(description) = &case.description {
        writeln!(text, "description = {}", quoted(description))?;
    }
    write_wind(text, &case.wind)?;
    write_flow(text, &case.flow)?;
    writeln!(text, "\n[time]")?;
    writeln!(text, "spin_up = {:?}\nduration = {:?}", case.time.spin_up, case.time.duration)?;
    // Only where it is another, so that the fingerprint of a case without it stays what it was.
    if case.time.block != USUAL_BLOCK {
        writeln!(text, "block = {:?}", case.time.block)?;
    }
    for turbine in &case.turbines {
        write_turbine(text, turbine)?;
    }
    for run in &case.runs {
        write_run(text, run, &case.turbines)?;
    }
    write_output(text, &case.output, &case.turbines)
}

fn write_turbine(text: &mut String, turbine: &Placement) -> std::fmt::Result {
    writeln!(text, "\n[[turbine]]\nname = {}", quoted(&turbine.name))?;
    writeln!(text, "model = {}\n{}", quoted(&turbine.model), position_text(turbine))?;
    text.push_str(&yaw_text(turbine));
    text.push_str(&misalignment_text(turbine));
    // Only where it is used, so that the fingerprint of a case without it stays what it was.
    if let Some(discon) = &turbine.discon {
        writeln!(text, "discon = {}", quoted(discon))?;
    }
    if let Some(gain) = turbine.torque_gain {
        writeln!(text, "torque_gain = {gain:?}")?;
    }
    let structure = if turbine.flexible { "flexible" } else { "rigid" };
    writeln!(text, "structure = \"{structure}\"")?;
    if let Some(step) = turbine.structure_step {
        writeln!(text, "structure_step = {step:?}")?;
    }
    let stall = if turbine.dynamic_stall { "dynamic" } else { "steady" };
    writeln!(text, "stall = \"{stall}\"")?;
    text.push_str(&momentum_text(turbine));
    text.push_str(&instruments_text(&turbine.instruments));
    for sensor in &turbine.sensors {
        let table = kinds::text(sensor.kind.name(), &sensor.values);
        writeln!(text, "sensors.{} = {table}", sensor.name)?;
    }
    Ok(())
}

fn write_run(text: &mut String, run: &Run, turbines: &[Placement]) -> std::fmt::Result {
    writeln!(text, "\n[[run]]\nname = {}", quoted(&run.name))?;
    if let Some(other) = &run.compare_with {
        writeln!(text, "compare_with = {}", quoted(other))?;
    }
    for (turbine, control) in turbines.iter().zip(&run.control) {
        writeln!(
            text,
            "control.{} = {}",
            turbine.name,
            kinds::text(control.kind().name(), control.values())
        )?;
    }
    Ok(())
}

fn write_output(text: &mut String, output: &Output, turbines: &[Placement]) -> std::fmt::Result {
    writeln!(text, "\n[output]")?;
    if let Some(interval) = output.interval {
        writeln!(text, "interval = {interval:?}")?;
    }
    if let Some(interval) = output.plane_interval {
        writeln!(text, "plane_interval = {interval:?}")?;
    }
    writeln!(text, "crosswind_diameters = {:?}", output.crosswind_diameters)?;
    if let Some(count) = output.helix_phases {
        writeln!(text, "helix_phases = {count}")?;
    }
    for (key, places) in [("lines_at", &output.lines_at), ("inflow_at", &output.inflow_at)] {
        let names: Vec<&str> = places.iter().map(|&index| turbines[index].name.as_str()).collect();
        writeln!(text, "{key} = {names:?}")?;
    }
    if let Some(interval) = output.volume_interval {
        writeln!(text, "volume_interval = {interval:?}")?;
        if output.volume_stride != keys::USUAL_STRIDE {
            writeln!(text, "volume_stride = {}", output.volume_stride)?;
        }
    }
    if let Some(interval) = output.filament_interval {
        writeln!(text, "filament_interval = {interval:?}")?;
    }
    writeln!(text, "checkpoint_interval = {:?}", output.checkpoint_interval)?;
    // Only where they are used, so that the text of a case without them stays what it was.
    if !output.keeps_scans {
        writeln!(text, "scans = \"none\"")?;
    }
    if !output.keeps_checkpoint {
        writeln!(text, "last_checkpoint = \"remove\"")?;
    }
    for further in &output.further {
        let table = kinds::text(further.kind.name(), &further.values);
        writeln!(text, "further.{} = {table}", further.name)?;
    }
    Ok(())
}
