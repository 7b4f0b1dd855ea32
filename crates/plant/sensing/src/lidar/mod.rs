//! A lidar: wind speeds along lines of sight, of any flow.
//!
//! The speed of a point is that of the air along the beam, positive away from the lidar, less that of the
//! lidar itself: u = Σ w (wind · d) − velocity · d, with the beam's direction d and the weights w of its
//! probe volume. Without motion and probe that is Eq. A1 of Chen, van Vondelen, van Wingerden (2026),
//! "Lidar-enhanced closed-loop active helix approach", Wind Energ. Sci. 11, 1871: a lidar that looks downwind
//! shows the wind with its sign, one that looks upwind against it.

mod checks;
mod keys;
mod optics;
mod pattern;
mod probe;

use crate::axes::level_axes;
use crate::noise::Draw;
use crate::sensor::{ForeignState, Mount, Scene, Sensor, SensorKind};
use basis::keys::{Objection, Table, Values};
use basis::registry::Named;
use basis::scan::{Scan, ScanBlocks, ScanLayout};
use basis::{Channel, Unit, Vector3, mixed};
use optics::{Optics, Pose};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// A lidar.
pub(crate) struct LidarKind;

/// The kind.
pub(crate) static LIDAR: LidarKind = LidarKind;

/// What sets the noise of a lidar apart from that of other instruments.
const STREAM: u64 = 0x6C69_6461_7200;
/// Share of a measuring interval by which rounding may be early (–).
const EARLY: f64 = 1e-6;

impl Named for LidarKind {
    fn name(&self) -> &'static str {
        "lidar"
    }
}

impl SensorKind for LidarKind {
    fn table(&self) -> &'static Table {
        &keys::TABLE
    }

    fn check(&self, values: &Values) -> Vec<Objection> {
        checks::of_values(values)
    }

    fn check_at(&self, values: &Values, mount: &Mount) -> Vec<Objection> {
        checks::at_mount(values, mount)
    }

    fn build(&self, values: &Values, mount: &Mount) -> Box<dyn Sensor> {
        Box::new(Lidar::new(values, mount))
    }
}

/// A lidar at work.
struct Lidar {
    optics: Optics,
    /// Beams measured at each measuring instant (–): all, or one.
    n_at_once: usize,
    /// Measuring instants a second (Hz).
    rate: f64,
    /// Standard deviation of its noise (m/s).
    noise: f64,
    /// Share of measurements that are lost (–).
    dropout: f64,
    seed: u64,
    state: State,
    /// Points that are due, by their places in a scan, each with where its air begins and ends.
    due: Vec<(usize, usize, usize)>,
    /// Where the air is looked at (m), with its weights (–), and how it blows there (m/s).
    nodes: Vec<Vector3>,
    weights: Vec<f64>,
    winds: Vec<Vector3>,
}

/// Everything of a lidar that time changes.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    /// Time of the first measuring instant (s).
    start: Option<f64>,
    /// Measuring instants so far.
    n_instants: u64,
    /// The latest scan, as its reading has it.
    latest: Vec<f64>,
}

impl Lidar {
    fn new(values: &Values, mount: &Mount) -> Self {
        let optics = Optics::of(values, mount);
        let (n_points, n_beams) = (optics.n_points(), optics.beams.len());
        let n_nodes = n_points * optics.nodes.len();
        let mut latest = vec![f64::NAN; Scan::n_values(n_points)];
        latest[..2].fill(0.0);
        Self {
            n_at_once: if values.word("order") == "in-turn" { 1 } else { n_beams },
            rate: values.number("rate_hz"),
            noise: values.number("noise"),
            dropout: values.number("dropout"),
            seed: mixed(mount.seed ^ STREAM).wrapping_add(values.number("seed") as u64),
            state: State { start: None, n_instants: 0, latest },
            due: Vec::with_capacity(n_points),
            nodes: Vec::with_capacity(n_nodes),
            weights: Vec::with_capacity(n_nodes),
            winds: vec![Vector3::ZERO; n_nodes],
            optics,
        }
    }

    /// The measuring instants that have come since the last reading, by their numbers; the last ones where
    /// they are more than a scan.
    fn instants(&mut self, time: f64) -> std::ops::Range<u64> {
        let start = *self.state.start.get_or_insert(time);
        let passed = ((time - start) * self.rate + EARLY).floor() as u64 + 1;
        let most = (self.optics.beams.len() / self.n_at_once) as u64;
        let first = self.state.n_instants.max(passed.saturating_sub(most));
        self.state.n_instants = passed.max(self.state.n_instants);
        first..self.state.n_instants
    }

    /// On return the due points and the places of their air are those of `instants` at `pose`, each seen from
    /// its place; what is below the ground is left out.
    fn aim(&mut self, instants: std::ops::Range<u64>, pose: &Pose) {
        let Self { optics, n_at_once, due, nodes, weights, .. } = self;
        let (n_beams, n_gates) = (optics.beams.len(), optics.n_gates);
        due.clear();
        nodes.clear();
        weights.clear();
        for instant in instants {
            let first = (instant as usize).wrapping_mul(*n_at_once) % n_beams;
            for beam in first..first + *n_at_once {
                let direction = pose.axes * optics.beams[beam];
                for gate in 0..n_gates {
                    let distance = optics.distances[beam * n_gates + gate];
                    let begin = nodes.len();
                    for (offset, weight) in &optics.nodes {
                        // A beam has no air behind its lidar.
                        let node = pose.place + direction * (distance + offset).max(0.0);
                        if node.z > optics.foot.z {
                            nodes.push(node);
                            weights.push(*weight);
                        }
                    }
                    due.push((gate * n_beams + beam, begin, nodes.len()));
                }
            }
        }
    }

    /// Measures the due points in `scene` from `pose`.
    fn measure(&mut self, scene: &Scene, pose: &Pose) {
        let Self { optics, due, nodes, weights, winds, state, .. } = self;
        let winds = &mut winds[..nodes.len()];
        scene.wind.sample(nodes, winds);
        let definition = scene.turbine.definition();
        let (origin, axes) = (scene.turbine.frame().hub, level_axes(scene.turbine.frame()));
        let n_beams = optics.beams.len();
        let reading = state.n_instants;
        let Some(scan) = ScanBlocks::of(&mut state.latest) else { return };
        for &(point, begin, end) in &*due {
            let (gate, beam) = (point / n_beams, point % n_beams);
            let direction = pose.axes * optics.beams[beam];
            let (mut sum, mut total) = (0.0, 0.0);
            for (wind, weight) in winds[begin..end].iter().zip(&weights[begin..end]) {
                sum += weight * wind.dot(direction);
                total += weight;
            }
            let draw = Draw { seed: self.seed, channel: point, reading };
            let is_lost = total <= 0.0
                || draw.uniform() < self.dropout
                || optics.passes_rotor() && pose.is_blocked(definition, direction);
            let speed = sum / total - pose.velocity.dot(direction) + self.noise * draw.normal();
            scan.speeds[point] = if is_lost { f64::NAN } else { speed };
            let distance = optics.distances[beam * optics.n_gates + gate];
            let place = axes.transpose() * (pose.place + direction * distance - origin);
            scan.places[0][point] = place.x;
            scan.places[1][point] = place.y;
            scan.places[2][point] = place.z;
            scan.times[point] = scene.truth.time;
        }
        let n_valid = scan.speeds.iter().filter(|speed| speed.is_finite()).count();
        scan.head[0] = reading as f64;
        scan.head[1] = n_valid as f64 / scan.speeds.len() as f64;
    }
}

impl Sensor for Lidar {
    fn channels(&self) -> Vec<Channel> {
        let speed = |point: usize| Channel {
            name: Cow::Owned(format!("Los{point:03}")),
            unit: Unit::MetrePerSecond,
        };
        let head = [Channel::new("Instants", Unit::One), Channel::new("Valid", Unit::One)];
        head.into_iter().chain((1..=self.optics.n_points()).map(speed)).collect()
    }

    fn n_values(&self) -> usize {
        Scan::n_values(self.optics.n_points())
    }

    fn scan_layout(&self) -> Option<ScanLayout> {
        let Optics { beams, distances, n_gates, .. } = &self.optics;
        let gates = 0..*n_gates;
        let directions = gates.clone().flat_map(|_| beams.iter().map(|beam| beam.to_array()));
        let ranges = gates.flat_map(|gate| distances.iter().skip(gate).step_by(*n_gates));
        Some(ScanLayout {
            directions: directions.collect(),
            ranges: ranges.copied().collect(),
            n_ranges: *n_gates,
            rate: self.rate,
        })
    }

    fn read(&mut self, scene: &Scene, values: &mut [f64]) {
        let instants = self.instants(scene.truth.time);
        if !instants.is_empty() {
            let pose = self.optics.pose(scene.turbine);
            self.aim(instants, &pose);
            self.measure(scene, &pose);
        }
        values.copy_from_slice(&self.state.latest);
    }

    fn save(&self) -> Vec<u8> {
        // Plain numbers always have a form.
        postcard::to_stdvec(&self.state).unwrap_or_default()
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), ForeignState> {
        let foreign = || ForeignState { sensor: "lidar".to_owned() };
        let state: State = postcard::from_bytes(state).map_err(|_| foreign())?;
        if state.latest.len() != self.state.latest.len() {
            return Err(foreign());
        }
        self.state = state;
        Ok(())
    }
}

#[cfg(test)]
mod tests;
