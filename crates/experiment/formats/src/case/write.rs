//! A case as text: every key written out, defaults included.

use super::instruments::instruments_text;
use super::kinds;
use super::momentum::momentum_text;
use super::wind::write_wind;
use farm::case::{Case, Flow, Ground, Output, Placement, Run, Sides};
use std::fmt::Write;

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
    for turbine in &case.turbines {
        write_turbine(text, turbine)?;
    }
    for run in &case.runs {
        write_run(text, run, &case.turbines)?;
    }
    write_output(text, &case.output, &case.turbines)
}

fn write_flow(text: &mut String, flow: &Flow) -> std::fmt::Result {
    writeln!(text, "\n[flow]\nsolver = \"{}\"", flow.solver.name)?;
    writeln!(text, "cells_per_diameter = {:?}", flow.cells_per_diameter)?;
    writeln!(text, "upstream_diameters = {:?}", flow.upstream_diameters)?;
    writeln!(text, "downstream_diameters = {:?}", flow.downstream_diameters)?;
    writeln!(text, "width_diameters = {:?}", flow.width_diameters)?;
    writeln!(text, "height_diameters = {:?}", flow.height_diameters)?;
    match flow.ground {
        Ground::Slip => writeln!(text, "ground = \"slip\"")?,
        Ground::Rough { roughness_length } => {
            writeln!(text, "ground = {{ roughness_length = {roughness_length:?} }}")?;
        }
    }
    let sides = if flow.sides == Sides::Slip { "slip" } else { "periodic" };
    writeln!(text, "sides = \"{sides}\"")?;
    if let Some(step) = flow.step {
        writeln!(text, "step = {step:?}")?;
    }
    if let Some(threads) = flow.threads {
        writeln!(text, "threads = {threads}")?;
    }
    Ok(())
}

fn write_turbine(text: &mut String, turbine: &Placement) -> std::fmt::Result {
    let [x, y] = turbine.position_diameters;
    writeln!(text, "\n[[turbine]]\nname = {}", quoted(&turbine.name))?;
    writeln!(text, "model = {}\nposition_diameters = [{x:?}, {y:?}]", quoted(&turbine.model))?;
    // Only where it is used, so that the fingerprint of a case without it stays what it was.
    if let Some(discon) = &turbine.discon {
        writeln!(text, "discon = {}", quoted(discon))?;
    }
    let structure = if turbine.flexible { "flexible" } else { "rigid" };
    writeln!(text, "structure = \"{structure}\"")?;
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
    }
    writeln!(text, "checkpoint_interval = {:?}", output.checkpoint_interval)
}

/// The degrees with the fewest digits that give `angle` (rad) back, bit for bit where any do.
pub(super) fn degrees(angle: f64) -> f64 {
    shortest(angle, angle.to_degrees(), f64::to_radians)
}

/// The number near `exact` with the fewest digits that `back` makes `value` of again, bit for bit where any
/// does.
pub(super) fn shortest(value: f64, exact: f64, back: impl Fn(f64) -> f64) -> f64 {
    (0..17)
        .filter_map(|digits| format!("{exact:.digits$e}").parse::<f64>().ok())
        .chain([exact, exact.next_up(), exact.next_down()])
        .find(|number| back(*number) == value)
        .unwrap_or(exact)
}

pub(super) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}
