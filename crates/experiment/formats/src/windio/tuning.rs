//! Gains of torque and pitch control from the rotor and the frequencies that a windIO file asks for.
//!
//! Pitch after Jonkman et al., NREL/TP-500-38060, 2009, §7.3: frequency ω and damping ratio ζ of rotor speed
//! above rated give K_P = 2 J Ω ζ ω / (−∂P/∂θ) and K_I = J Ω ω² / (−∂P/∂θ). Torque likewise from J alone:
//! K_P = 2 ζ ω J, K_I = ω² J. J is the inertia of rotor and generator, Ω rated speed, P aerodynamic power.

use super::node::Node;
use crate::turbine_file::{
    self, Controller, Document, SetPointSmoothing, TurbineFile, TurbineFileError,
};
use control::baseline::greedy_torque_gain;
use turbine::aero::blade_element::Theory;
use turbine::steady::SteadyRotor;
use turbine::structure::{BeamSection, EndBody, bending_modes};

/// Corner of the set-point smoother (rad/s): ROSCO's.
const SMOOTHER_CORNER: f64 = 0.6283;
/// Corner of the speed filter over the first edgewise frequency of a blade (–): Jonkman et al., §7.1.
const FILTER_SHARE: f64 = 0.25;
/// Greatest torque over rated (–): ROSCO's.
const TORQUE_RESERVE: f64 = 1.1;
/// Pitch angles of the schedule (deg).
const SCHEDULE: [f64; 9] = [0.0, 2.0, 4.0, 6.0, 9.0, 12.0, 15.0, 19.0, 23.0];
/// Step of the derivative of power to pitch (deg); winds between which rated power is sought, and the step in
/// which it is (m/s).
const PITCH_STEP: f64 = 0.25;
const WINDS: [f64; 2] = [4.0, 60.0];
const WIND_STEP: f64 = 0.5;
/// Fall of power with pitch over the most of it (–) below which a pitch angle has no gains of its own.
const LEAST_FALL: f64 = 0.1;
/// What the group says of it.
const SOURCE: &str = "gains from the frequencies and damping ratios that the file asks for, by blade-element momentum (Jonkman et al., NREL/TP-500-38060, 2009, sec. 7.3); corners of filters assumed";
/// What stands for a gain until it is known; no result depends on it.
const ANY: f64 = 1.0;

/// What a windIO file asks of its controllers: frequency (rad/s) and damping ratio (–).
#[derive(Clone, Copy, Debug)]
pub(super) struct Targets {
    pitch: Option<[f64; 2]>,
    torque: Option<[f64; 2]>,
}

impl Targets {
    /// What the group `control` of the file under `root` asks for.
    ///
    /// # Errors
    /// [`TurbineFileError`] for what is no number.
    pub(super) fn read(root: &Node) -> Result<Self, TurbineFileError> {
        let of = |group: &str, [frequency, damping]: [&str; 2]| {
            let group = root.optional("control").and_then(|control| control.optional(group));
            let Some(group) = group.filter(|group| {
                group.optional(frequency).is_some() && group.optional(damping).is_some()
            }) else {
                return Ok(None);
            };
            Ok(Some([group.number(frequency)?, group.number(damping)?]))
        };
        Ok(Self {
            pitch: of("pitch", ["PC_omega", "PC_zeta"])?,
            torque: of("torque", ["VS_omega", "VS_zeta"])?,
        })
    }
}

/// On return the controller of `document` has gains for air of `air_density` (kg/m³), where all that they
/// depend on is known and none were given; `notes` say so.
///
/// # Errors
/// [`TurbineFileError`] for a turbine that cannot be, which is called `origin`.
pub(super) fn derive(
    document: &mut Document,
    targets: &Targets,
    (air_density, origin): (f64, &str),
    notes: &mut Vec<String>,
) -> Result<(), TurbineFileError> {
    let (Some(pitch), Some(torque), Some(given)) =
        (targets.pitch, targets.torque, document.controller.clone())
    else {
        return Ok(());
    };
    if !given.torque_gain.is_nan() || !given.pitch_gains.is_empty() {
        return Ok(());
    }
    let mut trial = document.clone();
    trial.controller = Some(provisional(&given));
    if !turbine_file::write(&trial).missing.is_empty() {
        // What is missing beside is told of; gains wait for it.
        return Ok(());
    }
    let file = turbine_file::check(&trial, origin)?;
    let rotor = Rotor::new(&file, air_density);
    let efficiency = file.definition.efficiency();
    let power = 1e3 * given.rated_power_kw / efficiency;
    let ratio = given.optimal_tip_speed_ratio;
    let coefficient = rotor.steady.coefficients(ratio, file.controller.fine_pitch).power;
    let rated_torque = power / rotor.rated_speed;
    let [frequency, damping] = torque;
    let mut smoothing = given.set_point_smoothing.clone();
    smoothing.filter_corner = or(smoothing.filter_corner, SMOOTHER_CORNER);
    let corner = FILTER_SHARE * edge_frequency(document);
    notes.push(format!(
        "controller: gains from {} rad/s (pitch) and {frequency} rad/s (torque), power coefficient {coefficient:.4} at tip-speed ratio {ratio:.2} by blade-element momentum; speed_filter_corner and filter_corner are assumed",
        pitch[0]
    ));
    document.controller = Some(Controller {
        source: format!("{}; {SOURCE}", given.source),
        torque_gain: greedy_torque_gain(air_density, rotor.radius, coefficient, ratio),
        rated_torque,
        maximum_torque: TORQUE_RESERVE * rated_torque,
        torque_proportional: 2.0 * damping * frequency * rotor.inertia,
        torque_integral: frequency.powi(2) * rotor.inertia,
        speed_filter_corner: or(given.speed_filter_corner, corner),
        pitch_gains: rotor.pitch_gains(power, pitch),
        set_point_smoothing: smoothing,
        ..given
    });
    Ok(())
}

/// `value`, or `otherwise` where it is not known.
fn or(value: f64, otherwise: f64) -> f64 {
    if value.is_nan() { otherwise } else { value }
}

/// `given` with something in every place, so that the turbine can be looked at as a whole.
fn provisional(given: &Controller) -> Controller {
    let smoothing = &given.set_point_smoothing;
    Controller {
        torque_gain: ANY,
        rated_torque: ANY,
        maximum_torque: ANY,
        torque_proportional: ANY,
        torque_integral: ANY,
        speed_filter_corner: or(given.speed_filter_corner, ANY),
        pitch_gains: vec![[0.0, ANY, ANY]],
        set_point_smoothing: SetPointSmoothing {
            filter_corner: or(smoothing.filter_corner, SMOOTHER_CORNER),
            ..smoothing.clone()
        },
        ..given.clone()
    }
}

/// First edgewise frequency of a blade of `document` that stands still (rad/s); not a number where it has
/// none.
fn edge_frequency(document: &Document) -> f64 {
    let (Some(structure), Some(rotor)) = (&document.blade_structure, &document.rotor) else {
        return f64::NAN;
    };
    let section =
        |row: &[f64; 5]| BeamSection { position: row[0], mass: row[2], stiffness: row[4] };
    let sections: Vec<BeamSection> = structure.sections.iter().map(section).collect();
    let modes = bending_modes(rotor.tip_radius - rotor.hub_radius, &sections, EndBody::default());
    modes.map_or(f64::NAN, |[first, _]| first.frequency)
}

/// A rotor at its rated speed.
struct Rotor<'a> {
    steady: SteadyRotor<'a>,
    /// Swept radius (m) and area (m²).
    radius: f64,
    area: f64,
    /// With the generator (kg m²).
    inertia: f64,
    rated_speed: f64,
    air_density: f64,
}

impl<'a> Rotor<'a> {
    fn new(file: &'a TurbineFile, air_density: f64) -> Self {
        let definition = &file.definition;
        Self {
            steady: SteadyRotor::new(definition, Theory::default()),
            radius: file.controller.rotor_radius,
            area: definition.rotor_area(),
            inertia: definition.drive_train_inertia(),
            rated_speed: file.controller.rated_rotor_speed,
            air_density,
        }
    }

    /// Power (W) at rated speed in `wind` (m/s) with `pitch` (deg).
    fn power(&self, wind: f64, pitch: f64) -> f64 {
        let ratio = self.rated_speed * self.radius / wind;
        let coefficient = self.steady.coefficients(ratio, pitch.to_radians()).power;
        0.5 * self.air_density * self.area * wind.powi(3) * coefficient
    }

    /// Least wind (m/s) in which it has `power` (W) with `pitch` (deg), to a thousandth; none where it never
    /// has.
    fn wind(&self, power: f64, pitch: f64) -> Option<f64> {
        let [mut low, most] = WINDS;
        while self.power(low + WIND_STEP, pitch) < power {
            low += WIND_STEP;
            if low > most {
                return None;
            }
        }
        let mut high = low + WIND_STEP;
        while high - low > 1e-3 {
            let middle = 0.5 * (low + high);
            if self.power(middle, pitch) < power { low = middle } else { high = middle }
        }
        Some(high)
    }

    /// Rows of pitch (deg), K_P (s) and K_I (–) at mechanical `power` (W), for frequency (rad/s) and damping
    /// ratio (–).
    ///
    /// The fall of power with pitch is the straight line through what is found at all pitch angles, as the
    /// source has it: close to fine pitch, where a rotor is at its best, power hardly falls, and a gain from
    /// there alone would have no bound. Pitch angles at which it falls by less than a tenth of the most have
    /// no row: below its first row a controller holds that one's gains.
    fn pitch_gains(&self, power: f64, [frequency, damping]: [f64; 2]) -> Vec<[f64; 3]> {
        let fall = |pitch: f64| {
            let wind = self.wind(power, pitch)?;
            let [more, less] = [PITCH_STEP, -PITCH_STEP].map(|step| self.power(wind, pitch + step));
            Some((pitch, (less - more) / (2.0 * PITCH_STEP).to_radians()))
        };
        let line = straight_line(&SCHEDULE.into_iter().filter_map(fall).collect::<Vec<_>>());
        let along = |pitch: f64| line[0] + line[1] * pitch;
        let most = SCHEDULE.into_iter().map(along).fold(0.0, f64::max);
        let row = |pitch: f64| {
            let fall = along(pitch);
            let scale = self.inertia * self.rated_speed / fall;
            let gains = [pitch, 2.0 * damping * frequency * scale, frequency.powi(2) * scale];
            (most > 0.0 && fall >= LEAST_FALL * most).then_some(gains)
        };
        SCHEDULE.into_iter().filter_map(row).collect()
    }
}

/// Value at zero and slope of the straight line nearest to `points` in the least-squares sense; not numbers
/// for fewer than two.
fn straight_line(points: &[(f64, f64)]) -> [f64; 2] {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x_mean, y_mean) = (mean(|point| point.0), mean(|point| point.1));
    let (mut with, mut own) = (0.0, 0.0);
    for (x, y) in points {
        with += (x - x_mean) * (y - y_mean);
        own += (x - x_mean).powi(2);
    }
    let slope = with / own;
    [y_mean - slope * x_mean, slope]
}

#[cfg(test)]
mod tests {
    use super::straight_line;

    #[test]
    fn the_line_through_points_of_a_line_is_that_line() {
        let points = [0.0, 2.0, 9.0, 23.0].map(|x| (x, 3.0 + 0.5 * x));
        let [at_zero, slope] = straight_line(&points);
        assert!((at_zero - 3.0).abs() < 1e-12 && (slope - 0.5).abs() < 1e-12);
        // One point says nothing of a slope.
        assert!(straight_line(&points[..1])[1].is_nan());
    }
}
