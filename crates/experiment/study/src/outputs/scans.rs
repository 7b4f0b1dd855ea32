//! The scans of lidars, every one that a controller saw: `scans-TURBINE.SENSOR.nc`.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::{Section, Stored};
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use basis::scan::{Scan, ScanLayout};
use basis::{Commands, HelixFrame, Matrix3, Truth, Vector3};
use control::excitation_rate;
use farm::case::{Mounted, Run};
use formats::records::{ScanInstant, ScanSetting, ScanWriter, scan_bytes};
use sensing::{Mount, level_axes};

pub(super) static KIND: OutputKind = OutputKind {
    name: "scans",
    keys: Keys::OfOutput(&["scans"]),
    fed_by: FedBy::AnyFlow,
    disk,
    begin,
};

/// Measuring instants more than fit into a time, by rounding at its ends (–).
const N_MORE: u64 = 2;

/// Lidars of the turbines that stand in `run`: machine, place in the case, sensor, and what of its scans does
/// not change.
fn lidars<'a>(
    setup: &'a Prepared,
    run: &'a Run,
) -> impl Iterator<Item = (usize, usize, &'a Mounted, ScanLayout)> + 'a {
    let places = run.present().enumerate();
    places.flat_map(move |(machine, index)| {
        let mount = Mount {
            definition: &setup.models[index].definition,
            foot: setup.plan.positions[index],
            interval: setup.plan.interval,
            seed: 0,
        };
        setup.case.turbines[index].sensors.iter().filter_map(move |mounted| {
            let layout = mounted.kind.build(&mounted.values, &mount).scan_layout()?;
            Some((machine, index, mounted, layout))
        })
    })
}

fn disk(setup: &Prepared, run: &Run, _: &Values) -> u64 {
    if !setup.case.output.keeps_scans {
        return 0;
    }
    let n_steps = setup.plan.n_steps;
    let of_lidar = |(_, _, _, layout): (usize, usize, &Mounted, ScanLayout)| {
        let measured = n_steps as f64 * setup.plan.interval * layout.rate;
        let n_scans = n_steps.min(measured.ceil() as u64 + N_MORE);
        let [header, scan] = scan_bytes(layout.ranges.len() as u64);
        header + n_scans * scan
    };
    lidars(setup, run).map(of_lidar).sum()
}

struct Scans {
    kept: Vec<Kept>,
}

/// The scans of one lidar under way.
struct Kept {
    /// Which of the farm's machines has it, and by what name.
    machine: usize,
    sensor: String,
    writer: ScanWriter,
    /// Measuring instants that the latest scan on the disk had behind it (–).
    n_instants: f64,
    /// The machine when the scan was seen: time (s), azimuth (rad), centre of the rotor (m), axes.
    seen: (f64, f64, Vector3, Matrix3),
}

fn begin(scene: &Scene, stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    let Scene { setup, run, .. } = *scene;
    if !setup.case.output.keeps_scans || lidars(setup, run).next().is_none() {
        return Ok(None);
    }
    // Scans of each that are sure, with the measuring instants behind the last.
    let sure: Option<Vec<(u64, f64)>> = stored.map(Stored::state).transpose()?;
    let kept = lidars(setup, run).enumerate().map(|(place, (machine, index, mounted, layout))| {
        let setting = setting(scene, index, mounted, layout);
        let path = scene.folder.scans_path(&setting.turbine, &setting.sensor);
        let sure = sure.as_ref().and_then(|sure| sure.get(place)).copied();
        let (writer, n_instants) = match sure {
            Some((n, n_instants)) => (ScanWriter::resume(&path, &setting, n)?, n_instants),
            None => (ScanWriter::create(&path, &setting)?, 0.0),
        };
        let seen = (0.0, 0.0, Vector3::ZERO, Matrix3::IDENTITY);
        Ok(Kept { machine, sensor: setting.sensor, writer, n_instants, seen })
    });
    let kept = kept.collect::<Result<Vec<Kept>, StudyError>>()?;
    Ok(Some(Box::new(Scans { kept })))
}

/// What the scans with `layout` of `mounted`, a lidar of turbine number `index`, are of.
fn setting(scene: &Scene, index: usize, mounted: &Mounted, layout: ScanLayout) -> ScanSetting {
    let Scene { setup, run, .. } = *scene;
    let (case, plan) = (&setup.case, &setup.plan);
    let definition = &setup.models[index].definition;
    let helix = run.control[index].helix().map(|(sense, strouhal)| HelixFrame {
        sense,
        rate: excitation_rate(strouhal, case.wind.speed, plan.diameter),
    });
    let hub = plan.positions[index] + Vector3::Z * definition.rotor.hub_height;
    ScanSetting {
        case: case.name.clone(),
        run: run.name.clone(),
        turbine: case.turbines[index].name.clone(),
        sensor: mounted.name.clone(),
        values: mounted.values.clone(),
        layout,
        hub: hub.to_array(),
        rotor_diameter: definition.rotor_diameter(),
        helix,
        wind_speed: case.wind.speed,
    }
}

impl Output for Scans {
    fn schedule(&self) -> Schedule {
        Schedule::steps(1)
    }

    fn before_step(&mut self, scene: &Scene) {
        for kept in &mut self.kept {
            let frame = scene.farm.machines()[kept.machine].turbine.frame();
            (kept.seen.2, kept.seen.3) = (frame.hub, level_axes(frame));
        }
    }

    fn record(&mut self, turbine: usize, truth: &Truth, _: &Commands) {
        for kept in self.kept.iter_mut().filter(|kept| kept.machine == turbine) {
            (kept.seen.0, kept.seen.1) = (truth.time, truth.azimuth);
        }
    }

    fn write(&mut self, scene: &Scene) -> Result<(), StudyError> {
        for kept in &mut self.kept {
            let readings = scene.farm.machines()[kept.machine].sensing.readings();
            let reading = readings.iter().find(|reading| reading.sensor == kept.sensor);
            let Some(scan) = reading.and_then(|reading| Scan::of(&reading.values)) else {
                continue;
            };
            if scan.n_instants() == kept.n_instants {
                continue;
            }
            kept.n_instants = scan.n_instants();
            let (time, azimuth, origin, axes) = kept.seen;
            kept.writer.write(&ScanInstant { time, azimuth, origin, axes, scan })?;
        }
        Ok(())
    }

    fn checkpoint(&mut self, section: Section) -> Result<(), StudyError> {
        let flushed = self.kept.iter_mut().map(|kept| Ok((kept.writer.flush()?, kept.n_instants)));
        let sure: Vec<(u64, f64)> = flushed.collect::<Result<_, StudyError>>()?;
        section.keep(&sure)
    }

    fn finish(&mut self, _scene: &Scene) -> Result<(), StudyError> {
        Ok(self.kept.iter_mut().try_for_each(|kept| kept.writer.finish())?)
    }
}
