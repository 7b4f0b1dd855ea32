//! Speed of averages by phase over large fields: `cargo bench -p wakemix-benches --bench phases`.
//!
//! Two files in NetCDF: a part of ten million points at a thousand instants, and all of them at a few.
//! Each is read by the system and as fields, from memory (it was written just before) and, once the
//! system was told to forget it, from the disk; then `analyse phases` goes over it, in 204 bins, strip
//! by strip. A file of ten million points at a thousand instants has 120 GB, more than most memories:
//! there the disk is the limit, read past the system's memory in large pieces. Sums of fields that lie
//! in memory are held against what one core's memory gives to a loop that reads and writes in place.
//! Options after `--`: `quick` for a hundredth of the points, `memory=MB` for strips of that (256), a
//! number for the instants of all points (40).

use analysis::phases::{Bins, PhaseAverager};
use basis::records::{Field, Grid, Plane, PlaneAxes};
use benches::bandwidth::Limit;
use benches::disk::{self, timed};
use formats::fields::{FieldFile, Lengths};
use formats::netcdf::{InstantWriter, PlacedTurbine, PlaneSetting};
use postprocessing::analyses::{ANALYSES, Request};
use std::fmt::Write;
use std::hint::black_box;
use std::path::{Path, PathBuf};

/// Bytes of a point in a field.
const FIELD_BYTES: f64 = 12.0;
/// Points of a plane that is large, and of that which is long, of square planes.
const LARGE: usize = 3163;
const LONG: usize = 632;
/// Instants of the long one, and of the record that is spoken of.
const N_LONG: usize = 1000;
/// Revolutions of the rotor in three cycles of the helix, and from instant to instant.
const REVOLUTIONS: f64 = 17.0;
const TURNS: f64 = 0.07;
/// Bins of sums in memory: few, so that ten million points fit into the memory of a small machine.
const N_BINS: usize = 4;
/// Bytes that a point moves for each of the sums that an instant goes into, of all and of one bin: velocity
/// and reference in; a count, three sums and six of products in and out.
const SUM_BYTES: f64 = 24.0 + 2.0 * 76.0;
/// Bytes that a point moves when holes are looked for: velocity and one value of the reference.
const LOOK_BYTES: f64 = 16.0;
/// Memory that the limit is measured on (MiB).
const MEBIBYTES: usize = 512;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let quick = arguments.iter().any(|argument| argument == "quick");
    let n_instants = arguments.iter().find_map(|argument| argument.parse().ok()).unwrap_or(40);
    let memory = arguments.iter().find_map(|argument| argument.strip_prefix("memory="));
    let memory = memory.unwrap_or("256");
    let scale = if quick { 10 } else { 1 };
    for (side, n_instants, writes) in
        [(LONG / scale, N_LONG, true), (LARGE / scale, n_instants.max(2), false)]
    {
        let files = Files::write(side, n_instants);
        files.tell_reading();
        files.tell_command(memory, false, false);
        files.tell_command(memory, true, false);
        if writes {
            files.tell_command(memory, true, true);
        }
        println!();
    }
    sums(LARGE / scale);
}

/// A file of fields, and the azimuths beside it.
struct Files {
    fields: PathBuf,
    azimuths: PathBuf,
    out: PathBuf,
    n_points: f64,
    n_instants: usize,
    /// Bytes of the velocities (10⁹).
    gigabytes: f64,
}

impl Files {
    /// Writes `n_instants` of a plane along the wind of `side` points squared, and tells of it.
    fn write(side: usize, n_instants: usize) -> Self {
        let place = |ending: &str| {
            std::env::temp_dir().join(format!("wakemix-bench-{}{ending}", std::process::id()))
        };
        let n_points = (side * side) as f64;
        let gigabytes = n_points * FIELD_BYTES * n_instants as f64 / 1e9;
        println!("{n_points:.2e} points, {n_instants} instants: {gigabytes:.2} GB");
        let (fields, azimuths, out) = (place(".nc"), place(".csv"), place("-averages.nc"));
        let mut table = "time_s,Azimuth_deg,Helix_deg\n".to_owned();
        for step in 0..n_instants {
            let turns = TURNS * step as f64;
            let helix = 3.0 * turns / REVOLUTIONS;
            let row = writeln!(table, "{step},{},{}", 360.0 * turns.fract(), 360.0 * helix.fract());
            row.expect("room for a row");
        }
        std::fs::write(&azimuths, table).expect("room for azimuths");
        write(&fields, side, n_instants);
        Self { fields, azimuths, out, n_points, n_instants, gigabytes }
    }

    /// Tells `seconds` of `what`, which read all of the file, beside what the disk and what memory gave
    /// (10⁹ bytes/s).
    fn row(&self, what: &str, seconds: f64, [disk, warm]: [f64; 2]) {
        let rate = self.gigabytes / seconds;
        println!(
            "{what:<52} {rate:>6.2} GB/s, {:>4.0} % of the disk, {:>4.0} % of the system's memory",
            100.0 * rate / disk,
            100.0 * rate / warm
        );
    }

    /// What the system gives from the disk and from its memory (10⁹ bytes/s), measured now.
    fn limits(&self) -> [f64; 2] {
        disk::forget(&self.fields);
        let mut is_direct = false;
        let direct = timed(|| is_direct = disk::read_directly(&self.fields));
        let cold = timed(|| disk::read(&self.fields));
        let warm = timed(|| disk::read(&self.fields));
        let from_disk = if is_direct { direct.min(cold) } else { cold };
        [self.gigabytes / from_disk, self.gigabytes / warm]
    }

    fn tell_reading(&self) {
        let limits = self.limits();
        let [disk, warm] = limits;
        println!("the system: {disk:.2} GB/s from the disk, {warm:.2} GB/s from its memory");
        let whole = || {
            let mut file = self.open();
            let mut field = file.empty();
            for index in 0..self.n_instants {
                file.read(index, &mut field).expect("the bench's own instant");
                black_box(&field);
            }
        };
        self.row("read as fields, from memory", timed(whole), limits);
        disk::forget(&self.fields);
        self.row("read by the system, from the disk", timed(|| disk::read(&self.fields)), limits);
        disk::forget(&self.fields);
        self.row("read as fields, from the disk", timed(whole), limits);
    }

    fn open(&self) -> FieldFile {
        FieldFile::open(&self.fields, Lengths::Metres).expect("the bench's own file")
    }

    /// `analyse phases --memory MEMORY`, with the file forgotten where `is_cold`, its averages written where
    /// `writes`; limits measured before and after.
    fn tell_command(&self, memory: &str, is_cold: bool, writes: bool) {
        let mut request = Request::of(&self.fields)
            .with("azimuths", &self.azimuths.to_string_lossy())
            .with("memory", memory);
        if writes {
            request = request.with("out", &self.out.to_string_lossy());
        }
        let before = self.limits();
        if is_cold {
            disk::forget(&self.fields);
        }
        disk::begin_peak();
        let phases = ANALYSES.iter().find(|one| one.name == "phases").expect("a listed one");
        let mut answer = None;
        let seconds = timed(|| answer = Some((phases.run)(&request)));
        let answer = answer.expect("an answer").expect("the bench's own fields");
        let peak = disk::peak().unwrap_or_default() as f64 / 1e9;
        let after = self.limits();
        let from = if is_cold { "the disk" } else { "memory" };
        let and = if writes { ", averages written" } else { "" };
        let limits = [0, 1].map(|limit| 0.5 * (before[limit] + after[limit]));
        self.row(&format!("analyse phases, from {from}{and}"), seconds, limits);
        let remark = answer.remarks.iter().find(|remark| remark.starts_with("averages of"));
        println!("  {}", remark.map_or("", String::as_str));
        let each = seconds / self.n_points;
        println!(
            "  {seconds:.1} s, {:.2} us a point; peak {peak:.2} GB of memory; of 1e7 points {:.0} s",
            1e6 * each,
            1e7 * each
        );
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        for path in [&self.fields, &self.azimuths, &self.out] {
            if let Err(error) = std::fs::remove_file(path)
                && path.exists()
            {
                eprintln!("{} stays: {error}", path.display());
            }
        }
    }
}

/// Tells of sums of a plane of `side` points squared that lies in memory, an instant at a time.
fn sums(side: usize) {
    let plane = plane(side);
    let n_points = side * side;
    let grid = Grid { origin: [0.0; 3], spacing: [0.01, 1.0, 0.01], n_points: [side, 1, side] };
    let field = Field { grid, time: 0.0, velocity: plane.velocity };
    let bins = Bins::of_rotor(N_BINS).expect("sound bins");
    let mut averager = PhaseAverager::new(grid, bins);
    // What sums first touch the system has to find first; no instant after that does.
    let angle = |step: usize| std::f64::consts::TAU * step as f64 / N_BINS as f64;
    let mut time = 0.0;
    let mut add = |step: usize| {
        time += 1.0;
        let velocity = field.velocity.each_ref().map(Vec::as_slice);
        averager.add(time, angle(step), None, velocity).expect("a sound instant");
    };
    (0..N_BINS).for_each(&mut add);
    let limit = Limit::find(1, MEBIBYTES, 3);
    let before = limit.now(3);
    let n_instants = 2 * N_BINS;
    let summed = timed(|| (0..n_instants).for_each(&mut add));
    let after = limit.now(3);
    black_box(averager.all().mean[0][0]);
    let moved = (n_points * n_instants) as f64 * (2.0 * SUM_BYTES + LOOK_BYTES) / 1e9;
    let (rate, limit) = (moved / summed, 0.5 * (before + after) / 1e9);
    println!(
        "sums of {n_points} points in memory, an instant at a time: {rate:.2} GB/s moved, {:.0} % of {limit:.2}",
        100.0 * rate / limit
    );
}

/// A plane along the wind of `side` points squared.
fn plane(side: usize) -> Plane {
    let value = |point: usize| 5.0 + 0.001 * (point % 997) as f32;
    let column: Vec<f32> = (0..side * side).map(value).collect();
    Plane {
        name: "streamwise".to_owned(),
        axes: PlaneAxes::Streamwise,
        origin: [0.0; 3],
        spacing: [0.01; 2],
        n_points: [side; 2],
        time: 0.0,
        averaged: 0.0,
        velocity: [column.clone(), column.clone(), column],
    }
}

/// Writes `n_instants` of a plane of `side` points squared to `path`.
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
    let mut plane = plane(side);
    let mut writer = InstantWriter::create(path, &setting, &plane).expect("room for the file");
    for step in 0..n_instants {
        plane.time = step as f64;
        writer.write(&plane).expect("room for the instant");
    }
    writer.finish().expect("a whole file");
}
