//! What OpenFAST's users expect of a turbine in prescribed wind: one `.outb` file.

use super::output::{FedBy, Keys, Output, OutputKind, Scene};
use super::schedule::Schedule;
use super::section::Stored;
use super::series;
use crate::channels;
use crate::error::StudyError;
use crate::prepared::Prepared;
use basis::keys::Values;
use farm::case::Run;
use formats::openfast_output::{Encoding, Layout, OutbWriter};
use formats::records::RunFolder;
use formats::table::{Column, TableReader};
use turbine::structure::{Channel, channels_of};

/// Channels of ours under OpenFAST's names: ours, theirs, unit, factor to it; `{}` is the turbine's name.
const RENAMED: [(&str, &str, &str, f64); 6] = [
    ("wind.u_m_s", "Wind1VelX", "m/s", 1.0),
    ("wind.v_m_s", "Wind1VelY", "m/s", 1.0),
    ("wind.w_m_s", "Wind1VelZ", "m/s", 1.0),
    ("{}.power_w", "GenPwr", "kW", 1e-3),
    ("{}.thrust_n", "RtFldFxh", "N", 1.0),
    ("{}.aerodynamic_torque_nm", "RtFldMxh", "N-m", 1.0),
];

/// Bytes of a value in the file, and in the rows that gather beside the file of one turbine at a time.
const VALUE_BYTES: u64 = size_of::<i16>() as u64;
const GATHERED_BYTES: u64 = size_of::<f64>() as u64;
/// Bytes of a channel above the rows: name, unit, range.
const HEADER_BYTES: u64 = 32;

pub(super) static KIND: OutputKind = OutputKind {
    name: "outb",
    keys: Keys::OfOutput(&[]),
    fed_by: FedBy::PrescribedWind,
    disk,
    begin,
};

fn disk(setup: &Prepared, run: &Run, _: &Values) -> u64 {
    let n_rows = series::n_rows(setup);
    let of_turbine = |index: usize| (RENAMED.len() + 1 + channels::n_loads(setup, index)) as u64;
    let n_channels: u64 = run.present().map(of_turbine).sum();
    let most = run.present().map(of_turbine).max().unwrap_or(0);
    n_channels * (n_rows * VALUE_BYTES + HEADER_BYTES) + most * n_rows * GATHERED_BYTES
}

struct Outb;

fn begin(_scene: &Scene, _stored: Option<Stored>) -> Result<Option<Box<dyn Output>>, StudyError> {
    Ok(Some(Box::new(Outb)))
}

impl Output for Outb {
    fn schedule(&self) -> Schedule {
        Schedule::at_the_end()
    }

    fn finish(&mut self, scene: &Scene) -> Result<(), StudyError> {
        let turbines = &mut scene.run.present();
        turbines.try_for_each(|index| write(scene.setup, scene.run, scene.folder, index))
    }
}

/// Writes `TURBINE.outb` into `folder`, from the run's complete series, for turbine number `index` of the
/// case.
fn write(setup: &Prepared, run: &Run, folder: &RunFolder, index: usize) -> Result<(), StudyError> {
    let turbine = setup.case.turbines[index].name.as_str();
    let mut reader = TableReader::open(&folder.series_path())?;
    let (mut ours, mut channels, mut scales) = (Vec::new(), Vec::new(), Vec::new());
    // Ours is on the low-speed side.
    let gear_ratio = setup.models[index].definition.drive_train.gear_ratio;
    let torque = ("{}.generator_torque_nm", "GenTq", "kN-m", 1e-3 / gear_ratio);
    for (own, name, unit, scale) in RENAMED.into_iter().chain([torque]) {
        ours.push(own.replace("{}", turbine));
        channels.push(Column { name: name.to_owned(), unit: unit.to_owned() });
        scales.push(scale);
    }
    // Loads already stand under OpenFAST's names and units.
    for Channel { name, unit, .. } in channels_of(setup.models[index].definition.n_blades) {
        let own = format!("{turbine}.{name}_{unit}");
        if reader.channels().any(|column| column.name == own) {
            ours.push(own);
            channels.push(Column { name, unit: unit.to_owned() });
            scales.push(1.0);
        }
    }
    let names: Vec<&str> = ours.iter().map(String::as_str).collect();
    reader.select(&names)?;
    let layout = Layout {
        description: format!("wakemix, case {}, run {}", setup.case.name, run.name),
        channels,
        start: 0.0,
        interval: setup.plan.row_interval(),
    };
    let path = folder.path().join(format!("{turbine}.outb"));
    let mut writer = OutbWriter::create(&path, layout, Encoding::Compressed)?;
    let mut row = vec![0.0; names.len() + 1];
    let mut values = vec![0.0; names.len()];
    while reader.read(&mut row)? {
        for ((value, own), scale) in values.iter_mut().zip(&row[1..]).zip(&scales) {
            *value = own * scale;
        }
        writer.write(&values)?;
    }
    writer.finish()?;
    Ok(())
}
