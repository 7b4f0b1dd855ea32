//! What speaks against a precursor, beyond what its keys say one by one.

use super::Precursor;
use crate::plan::MAXIMUM_LATTICE_SPEED;
use basis::keys::Objection;

/// Least length and width of the box over the height of the inversion (–): rolls and streaks of the layer
/// are two to three times as wide as it is deep, and a box that holds one of them makes it last.
const LEAST_LENGTH: f64 = 3.0;
/// Fewest cells below the inversion (–).
const LEAST_DEPTH: f64 = 8.0;
/// Most cells along an axis (–).
const MOST_CELLS: f64 = 16_384.0;
/// Departure of a length from a whole number of cells that is rounding (–).
const ROUNDING: f64 = 1e-6;
/// Cells that the roughness length may take at most (–): the logarithmic law holds at the lowest centre.
const ROUGHEST: f64 = 0.5 / std::f64::consts::E;
/// Latitude below which a pressure gradient drives no geostrophic wind (rad).
const TROPICS: f64 = 5.0 * std::f64::consts::PI / 180.0;
/// Steps in the shortest period of a buoyancy oscillation, at least (–).
const STEPS_OF_A_PERIOD: f64 = 20.0;
/// Most records of statistics (–).
const MOST_STATISTICS: f64 = 20_000.0;

/// An objection to a key of the table that is named.
type Fault = (&'static str, Objection);

fn fault(
    (table, key): (&'static str, &'static str),
    message: String,
    label: &'static str,
    fix: String,
) -> Fault {
    (table, Objection { key: Some(key), message, label, fix })
}

impl Precursor {
    /// What speaks against it, each with the table of the case file that it is about. What is not a number
    /// is passed over.
    pub fn faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        self.check_box(&mut faults);
        self.check_layer(&mut faults);
        self.check_driving(&mut faults);
        self.check_ground(&mut faults);
        self.check_steps(&mut faults);
        self.check_planes(&mut faults);
        faults
    }

    /// What the lattice says against it; to be asked where nothing else is wrong.
    pub fn misfit(&self) -> Option<Fault> {
        let error = self.settings(&self.plan()).check().err()?;
        let message = format!("gives a lattice that cannot be built: {error}");
        Some(fault(("box", "cell"), message, "does not fit", "change what it names".to_owned()))
    }

    fn check_box(&self, faults: &mut Vec<Fault>) {
        let cell = self.domain.cell;
        let keys = ["length", "width", "height"];
        for ((key, n_cells), length) in keys.into_iter().zip(self.cells()).zip(self.domain.size) {
            if n_cells > MOST_CELLS {
                let message = format!("= {cell} m makes {n_cells:.0} cells along the {key}");
                let fix = format!("use cells of at least {} m", length / MOST_CELLS);
                faults.push(fault(("box", "cell"), message, "too small", fix));
            } else if (n_cells - n_cells.round()).abs() > ROUNDING * n_cells {
                let message = format!("= {length} m is {n_cells:.3} cells of {cell} m");
                let [low, high] = [n_cells.floor().max(1.0), n_cells.ceil()].map(|n| n * cell);
                let fix = format!("use a whole number of cells: {low} or {high} m");
                faults.push(fault(("box", key), message, "no whole number", fix));
            }
        }
    }

    fn check_layer(&self, faults: &mut Vec<Fault>) {
        let (depth, height) = (self.air.inversion_height, self.domain.size[2]);
        for (key, length) in ["length", "width"].into_iter().zip(self.domain.size) {
            if length < LEAST_LENGTH * depth {
                let message = format!(
                    "= {length} m is too short for its eddies: they are as long as {LEAST_LENGTH} times the layer is deep, and atmosphere.inversion_height is {depth} m"
                );
                let least = LEAST_LENGTH * depth;
                let fix = format!("use at least {least} m, or a lower atmosphere.inversion_height");
                faults.push(fault(("box", key), message, "too short", fix));
            }
        }
        if depth / self.domain.cell < LEAST_DEPTH {
            let cell = self.domain.cell;
            let message = format!(
                "= {cell} m leaves {:.1} cells below the inversion at {depth} m, {LEAST_DEPTH} are the fewest",
                depth / cell
            );
            let fix = format!("use cells of at most {} m", depth / LEAST_DEPTH);
            faults.push(fault(("box", "cell"), message, "too large", fix));
        }
        let (top, damped) = (self.inversion_top(), self.damping_from());
        if damped >= height {
            let message = format!("= {damped} m is not below the top of the box at {height} m");
            let fix = "lower it, or raise box.height".to_owned();
            faults.push(fault(("atmosphere", "damping_from"), message, "too high", fix));
        } else if top > damped {
            let place = if top > height {
                format!("outside the box, which ends at {height} m")
            } else {
                format!("in the layer that is damped, from {damped} m on")
            };
            let message =
                format!("= {depth} m puts the inversion, which reaches up to {top} m, {place}");
            let fix = "lower it or atmosphere.inversion_depth, or raise box.height".to_owned();
            faults.push(fault(("atmosphere", "inversion_height"), message, "too high", fix));
        }
    }

    fn check_driving(&self, faults: &mut Vec<Fault>) {
        let air = &self.air;
        let mut object = |key, message: String, label, fix: &str| {
            faults.push(fault(("atmosphere", key), message, label, fix.to_owned()));
        };
        match (air.geostrophic_wind, air.hub_wind) {
            (None, None) => object(
                "geostrophic_wind",
                "is missing, and so is atmosphere.hub_wind: one of the two drives the air"
                    .to_owned(),
                "without wind",
                "give geostrophic_wind, or hub_wind where the wind at hub height is to be held",
            ),
            (Some(_), Some(_)) => object(
                "hub_wind",
                "stands beside atmosphere.geostrophic_wind, which would follow from it".to_owned(),
                "one too many",
                "leave one of the two out",
            ),
            _ => {}
        }
        for (key, direction, wind, other) in [
            ("geostrophic_direction_deg", air.geostrophic_direction, air.geostrophic_wind, "hub_"),
            ("hub_direction_deg", air.hub_direction, air.hub_wind, "geostrophic_"),
        ] {
            if direction.is_some() && wind.is_none() {
                let message =
                    format!("is of a wind that is not given, for atmosphere.{other}wind drives");
                let fix = format!("use {other}direction_deg");
                object(key, message, "of another wind", &fix);
            }
        }
    }

    fn check_ground(&self, faults: &mut Vec<Fault>) {
        let air = &self.air;
        if air.latitude.abs() < TROPICS {
            let message =
                "is too near the equator, where no pressure gradient holds a geostrophic wind"
                    .to_owned();
            let fix = "use at least 5 degrees north or south".to_owned();
            faults.push(fault(("atmosphere", "latitude_deg"), message, "too low", fix));
        }
        let roughest = ROUGHEST * self.domain.cell;
        if air.roughness_length > roughest {
            let message = format!(
                "= {} m does not fit below the centres of the lowest cells, {} m high",
                air.roughness_length,
                0.5 * self.domain.cell
            );
            let fix = format!("use at most {roughest:.3} m, or larger cells");
            faults.push(fault(("atmosphere", "roughness_length"), message, "too rough", fix));
        }
        if air.heat_flux.is_some() && air.cooling_rate.is_some() {
            let message = "stands beside atmosphere.heat_flux, which says the same".to_owned();
            let fix = "leave one of the two out".to_owned();
            faults.push(fault(("atmosphere", "cooling_rate"), message, "one too many", fix));
        }
    }

    fn check_steps(&self, faults: &mut Vec<Fault>) {
        let (time, air, cell) = (&self.time, &self.air, self.domain.cell);
        let by_wind = MAXIMUM_LATTICE_SPEED * cell / self.geostrophic_speed();
        let by_buoyancy = self.shortest_period() / STEPS_OF_A_PERIOD;
        let by_damping = 0.5 / air.damping_rate;
        let step = self.plan().interval;
        let broken = [
            (by_wind, "the wind moves more than 0.12 cells a step"),
            (by_buoyancy, "buoyancy swings in fewer than 20 steps"),
            (by_damping, "more than half of the wind at the top is damped in a step"),
        ];
        let shortest = broken.into_iter().reduce(|a, b| if b.0 < a.0 { b } else { a });
        if let Some((longest, why)) = shortest
            && step > longest
        {
            let message = format!("= {step} s breaks the scheme's stability: {why}");
            let fix = format!("use at most {longest:.4} s, or leave it out");
            faults.push(fault(("time", "step"), message, "too long", fix));
        }
        for (key, interval) in
            [("statistics_interval", Some(time.statistics_interval)), ("record", Some(time.record))]
        {
            if let Some(interval) = interval.filter(|interval| *interval < step) {
                let message = format!("= {interval} s is shorter than a step of {step:.4} s");
                let fix = format!("use at least {step:.4} s");
                faults.push(fault(("time", key), message, "too short", fix));
            }
        }
        if time.record >= step && time.record < time.statistics_interval {
            let message = format!(
                "= {} s is shorter than time.statistics_interval, {} s: nothing would be known of it",
                time.record, time.statistics_interval
            );
            let fix = format!("use at least {} s, or a shorter interval", time.statistics_interval);
            faults.push(fault(("time", "record"), message, "too short", fix));
        }
        let all = time.spin_up + time.record;
        if all / time.statistics_interval > MOST_STATISTICS {
            let message = format!(
                "= {} s makes {:.0} records of statistics in {all} s, {MOST_STATISTICS} are the most",
                time.statistics_interval,
                all / time.statistics_interval
            );
            let fix = format!("use at least {:.0} s", (all / MOST_STATISTICS).ceil());
            faults.push(fault(("time", "statistics_interval"), message, "too short", fix));
        }
    }

    fn check_planes(&self, faults: &mut Vec<Fault>) {
        let (planes, cell) = (&self.planes, self.domain.cell);
        let [length, width, height] = self.domain.size;
        let mut check = |key, value: f64, [least, most]: [f64; 2], what: &str| {
            if value < least || value > most {
                let message = format!("= {value} m is not between {least} and {most} m, {what}");
                let label = if value < least { "too low" } else { "too high" };
                let fix = format!("use {least} to {most} m");
                faults.push(fault(("planes", key), message, label, fix));
            }
        };
        let shorter = length.min(width);
        check("width", self.plane_width(), [2.0 * cell, shorter], "the shorter side of the box");
        check("height", self.plane_height(), [2.0 * cell, height], "the top of the box");
        let highest = self.plane_height() - 0.5 * cell;
        let hub = "the heights that are recorded";
        check("hub_height", planes.hub_height, [0.5 * cell, highest], hub);
        let (step, record) = (self.plan().interval, self.time.record);
        if let Some(interval) = planes.interval
            && (interval < step || interval > record)
        {
            let message = format!(
                "= {interval} s is not between a step of {step:.4} s and time.record, {record} s"
            );
            let fix = "leave it out: the wind then crosses half a cell from plane to plane";
            faults.push(fault(("planes", "interval"), message, "out of range", fix.to_owned()));
        }
    }
}
