//! Speed of averages by phase over large fields: `cargo bench -p wakemix-benches --bench phases`.
//!
//! Fields of ten million points in a NetCDF file, instant by instant: read alone by the system, read as
//! fields, and averaged in bins of the rotor's azimuth. Two limits stand beside it: what one core's memory
//! gives to a loop that reads and writes in place, for sums that lie in memory already, and what the system
//! gives of the file, for what is read from it. The file is written just before, so that where memory is
//! plenty the system has it in memory: that is the harder limit. Memory is that of averages, the file and one
//! field, however many instants there are.
//! Options after `--`: `quick` for a hundredth of the points, a number for the instants (8).

use analysis::phases::{Bins, PhaseAverager};
use basis::records::{Plane, PlaneAxes};
use benches::bandwidth::Limit;
use formats::fields::{FieldFile, Lengths};
use formats::netcdf::{InstantWriter, PlacedTurbine, PlaneSetting};
use std::fs::File;
use std::hint::black_box;
use std::io::Read;
use std::path::Path;
use std::time::Instant;

/// Bins of a revolution: few, so that ten million points fit into the memory of a small machine.
const N_BINS: usize = 4;
/// Bytes that a point moves for each of the sums that an instant goes into, of all and of one bin: velocity
/// and reference in; a count, three sums and six of products in and out.
const SUM_BYTES: f64 = 24.0 + 2.0 * 76.0;
/// Bytes that a point moves when holes are looked for: velocity and one value of the reference.
const LOOK_BYTES: f64 = 16.0;
/// Bytes of a point in a field.
const FIELD_BYTES: f64 = 12.0;
/// Memory that the limit is measured on (MiB).
const MEBIBYTES: usize = 512;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let quick = arguments.iter().any(|argument| argument == "quick");
    let n_instants =
        arguments.iter().find_map(|argument| argument.parse().ok()).unwrap_or(8).max(2);
    let side = if quick { 316 } else { 3163 };
    let path = std::env::temp_dir().join(format!("wakemix-bench-{}.nc", std::process::id()));
    write(&path, side, n_instants);
    let n_points = (side * side) as f64;
    let gigabytes = n_points * FIELD_BYTES * n_instants as f64 / 1e9;
    println!("{n_points:.2e} points, {n_instants} instants: {gigabytes:.2} GB");

    let by_system = timed(|| by_system(&path));
    let mut file = FieldFile::open(&path, Lengths::Metres).expect("the bench's own file");
    let mut field = file.empty();
    let read = timed(|| {
        for index in 0..n_instants {
            file.read(index, &mut field).expect("the bench's own instant");
            black_box(&field);
        }
    });
    let bins = Bins::of_rotor(N_BINS).expect("sound bins");
    let grid = *file.grid();
    let mut averager = PhaseAverager::new(grid, bins);
    // What sums first touch the system has to find first; no instant after that does.
    let angle = |step: usize| std::f64::consts::TAU * step as f64 / N_BINS as f64;
    let mut time = 0.0;
    let mut add = |averager: &mut PhaseAverager, step: usize, field: &basis::records::Field| {
        time += 1.0;
        let velocity = field.velocity.each_ref().map(Vec::as_slice);
        averager.add(time, angle(step), None, velocity).expect("a sound instant");
    };
    (0..N_BINS).for_each(|step| add(&mut averager, step, &field));
    let limit = Limit::find(1, MEBIBYTES, 3);
    let before = limit.now(3);
    let summed = timed(|| (0..n_instants).for_each(|step| add(&mut averager, step, &field)));
    let after = limit.now(3);
    let both = timed(|| {
        for index in 0..n_instants {
            file.read(index, &mut field).expect("the bench's own instant");
            add(&mut averager, index, &field);
        }
    });
    black_box(averager.all().mean[0][0]);

    let memory = 0.5 * (before + after) / 1e9;
    let moved = n_points * n_instants as f64 * (2.0 * SUM_BYTES + LOOK_BYTES) / 1e9;
    let row = |what: &str, seconds: f64, amount: f64, limit: f64| {
        let rate = amount / seconds;
        println!("{what:<44} {rate:>7.2} GB/s, {:>5.1} % of {limit:.2}", 100.0 * rate / limit);
    };
    let disk = gigabytes / by_system;
    row("the file, read by the system", by_system, gigabytes, disk);
    row("the file, read as fields", read, gigabytes, disk);
    row("the file, read and averaged", both, gigabytes, disk);
    row("sums of fields in memory, bytes moved", summed, moved, memory);
    let taken = PhaseAverager::memory(grid.len() as u64, &bins) as f64 + n_points * FIELD_BYTES;
    println!("memory of {N_BINS} bins and a field: {:.2} GB, whatever the instants", taken / 1e9);
    if let Err(error) = std::fs::remove_file(&path) {
        eprintln!("{} stays: {error}", path.display());
    }
}

/// Seconds that `work` takes.
fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// Reads all of the file at `path`, a mebibyte at a time.
fn by_system(path: &Path) {
    let mut file = File::open(path).expect("the bench's own file");
    let mut bytes = vec![0; 1 << 20];
    while file.read(&mut bytes).expect("the bench's own file") > 0 {
        black_box(&bytes);
    }
}

/// Writes `n_instants` of a plane along the wind of `side` points squared to `path`.
fn write(path: &Path, side: usize, n_instants: usize) {
    let turbine =
        PlacedTurbine { name: "T1".to_owned(), hub: [0.0; 3], rotor_diameter: 1.0, is_there: true };
    let setting = PlaneSetting {
        case: "bench".to_owned(),
        run: "bench".to_owned(),
        wind_speed: 5.0,
        wind_direction_deg: 270.0,
        turbulence_intensity: 0.01,
        air_density: 1.225,
        turbines: vec![turbine],
    };
    let value = |point: usize| 5.0 + 0.001 * (point % 997) as f32;
    let column: Vec<f32> = (0..side * side).map(value).collect();
    let mut plane = Plane {
        name: "streamwise".to_owned(),
        axes: PlaneAxes::Streamwise,
        origin: [0.0; 3],
        spacing: [0.01; 2],
        n_points: [side; 2],
        time: 0.0,
        averaged: 0.0,
        velocity: [column.clone(), column.clone(), column],
    };
    let mut writer = InstantWriter::create(path, &setting, &plane).expect("room for the file");
    for step in 0..n_instants {
        plane.time = step as f64;
        writer.write(&plane).expect("room for the instant");
    }
    writer.finish().expect("a whole file");
}
