//! The wakes of all blades in the wind, as a flow.

use super::body::{Body, N_SIDES, sides_to_nodes};
use super::field::{CHUNK, Field};
use super::neighbours::{GROUP, Neighbours};
use super::rotor::Rotor;
use super::segment::Segment;
use super::settings::{MeanShear, WakeError, WakeSettings};
use super::sheet::Sheet;
use crate::inflow::PrescribedWind;
use crate::pool::Pool;
use crate::simd::Backend;
use crate::{FlowError, FlowSolver, WindField};
use basis::{Answer, PointForce, Vector3};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Farthest that a rotor may turn in a step (rad) at the speed that it is expected to have: beyond it the
/// wake is no helix.
pub const FARTHEST_TURN: f64 = std::f64::consts::FRAC_PI_4;
/// The same of any step made (rad), for the speed of a rotor swings about the expected one.
const FARTHEST_STEP: f64 = 48.0 * std::f64::consts::PI / 180.0;
/// Speed that no air has that these equations hold for (m/s): sound.
const FASTEST: f64 = 340.0;
/// Lowest that a node of a wake over ground comes (m).
const LOWEST: f64 = 0.01;

/// Lifting lines in the wind, and the wakes that they shed.
///
/// Each step every node of the wake moves with the wind and with what all vortices induce, second order in
/// time. The rings that leave the blades in a step carry the circulation of that very step: the flow tells a
/// turbine how its wind [answers](FlowSolver::answer), and both are found together. The lift that goes with a
/// circulation is the turbine's (Kutta-Joukowski). Forces of discs, such as nacelles, leave rings behind;
/// others without a bound vortex, such as the blades' drag and the tower's, leave no trace.
///
/// Limits: the air is incompressible and free of turbulence of its own making; vorticity of shear in the wind
/// is not bent by the rotors, and what it would hold against is left out with it ([`MeanShear`]); bodies
/// do not push the air aside.
pub struct FreeWake {
    pub(super) settings: WakeSettings,
    pub(super) wind: PrescribedWind,
    pub(super) sheets: Vec<Sheet>,
    /// One for each turbine that was met, in the order of their places in the farm.
    pub(super) rotors: Vec<Rotor>,
    /// Those whose wakes are followed.
    pub(super) bodies: Vec<Body>,
    segments: Vec<Segment>,
    field: Field,
    nodes: Vec<Vector3>,
    /// Places at which vortices carry the nodes.
    middles: Vec<Vector3>,
    neighbours: Neighbours,
    /// What vortices induce at these, in their order.
    sorted: Vec<Vector3>,
    winds: Vec<Vector3>,
    induced: Vec<Vector3>,
    pool: Mutex<Pool>,
    /// Room for the wind on planes.
    pub(super) room: Mutex<Vec<Vector3>>,
    n_threads: usize,
}

impl FreeWake {
    /// No wake yet in `wind`.
    ///
    /// # Errors
    /// [`WakeError`] for settings that cannot be.
    pub fn new(settings: WakeSettings, wind: PrescribedWind) -> Result<Self, WakeError> {
        settings.check()?;
        let cores = || std::thread::available_parallelism().map_or(1, usize::from);
        let n_threads = settings.threads.unwrap_or_else(cores).max(1);
        let most = settings.most_segments();
        let field = Field::with_capacity(settings.accuracy, Backend::detect(), most);
        Ok(Self {
            wind,
            sheets: Vec::new(),
            rotors: Vec::new(),
            bodies: Vec::new(),
            segments: Vec::with_capacity(most),
            field,
            nodes: Vec::with_capacity(most),
            middles: Vec::with_capacity(most),
            neighbours: Neighbours::with_capacity(most),
            sorted: Vec::with_capacity(most),
            winds: Vec::with_capacity(most),
            induced: Vec::with_capacity(most),
            pool: Mutex::new(Pool::new(n_threads)),
            room: Mutex::new(Vec::new()),
            n_threads,
            settings,
        })
    }

    /// Time (s).
    pub fn time(&self) -> f64 {
        self.wind.time()
    }

    /// Threads (–).
    pub fn n_threads(&self) -> usize {
        self.n_threads
    }

    /// Instructions that it runs on.
    pub fn backend(&self) -> &'static str {
        self.field.backend().name()
    }

    /// All vortices now.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Memory that wakes take at `settings` (bytes).
    pub fn memory_of(settings: &WakeSettings) -> u64 {
        // A segment in double precision, as boxes knew it and in single precision, its number and its length
        // so far; a node's position, velocities, wind, middle, and what is induced, in both orders.
        const OF_SEGMENT: u64 = 64 + 64 + 44 + 8 + 16 + 8 * 24;
        let boxes = Field::memory_of_boxes(settings.accuracy, settings.most_segments());
        settings.most_segments() as u64 * OF_SEGMENT + boxes
    }

    /// The same for these.
    pub fn memory(&self) -> u64 {
        Self::memory_of(&self.settings)
    }

    pub(super) fn pool(&self) -> MutexGuard<'_, Pool> {
        self.pool.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// On return `velocities` (m/s) hold what all vortices induce at `positions` (m), images included.
    fn induce(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        self.field.sample(positions, velocities);
        if !self.settings.ground {
            return;
        }
        // An image below the ground induces here what its vortex does below the ground, upside down.
        let upside_down = Vector3::new(1.0, 1.0, -1.0);
        for (positions, velocities) in positions.chunks(GROUP).zip(velocities.chunks_mut(GROUP)) {
            let (mut below, mut images) = ([Vector3::ZERO; GROUP], [Vector3::ZERO; GROUP]);
            let n = positions.len();
            for (below, position) in below.iter_mut().zip(positions) {
                *below = upside_down * *position;
            }
            self.field.sample(&below[..n], &mut images[..n]);
            for (velocity, image) in velocities.iter_mut().zip(images) {
                *velocity += upside_down * image;
            }
        }
    }

    /// What bound vortices among `forces` say of their turbines, and what drag leaves behind; makes sheets of
    /// blades that are new. Says whether there are new vortices.
    fn meet(&mut self, forces: &[PointForce]) -> bool {
        if self.rotors.is_empty() && self.bodies.is_empty() {
            self.rotors = Rotor::all_of(forces);
            self.bodies = Body::all_of(forces, self.settings.bodies);
            for (index, rotor) in self.rotors.iter().enumerate() {
                for (blade, n) in rotor.blades().enumerate() {
                    self.sheets.push(Sheet::new([index, blade], n, self.settings.resolution));
                }
            }
        }
        for rotor in &mut self.rotors {
            rotor.read(forces);
        }
        let WakeSettings { interval, air_density, .. } = self.settings;
        let discs = forces.iter().filter(|force| force.disc_radius.is_some());
        let mut is_new = false;
        for (body, force) in self.bodies.iter_mut().zip(discs) {
            is_new |= body.shed(force, interval, air_density);
        }
        is_new
    }

    /// # Errors
    /// [`FlowError::TurnedTooFar`] where a rotor turns too far in a step of `duration` (s) from now.
    fn check_turns(&self, duration: f64) -> Result<(), FlowError> {
        let farthest = self.rotors.iter().max_by(|a, b| a.turn().total_cmp(&b.turn()));
        let Some(rotor) = farthest.filter(|rotor| rotor.turn() > FARTHEST_STEP) else {
            return Ok(());
        };
        let (time, position) = (self.wind.time() + duration, rotor.middle());
        Err(FlowError::TurnedTooFar { time, position, turn: rotor.turn(), most: FARTHEST_STEP })
    }

    /// On return segments and field are those of the rings.
    pub(super) fn gather(&mut self, is_new: bool) {
        self.segments.clear();
        for sheet in &self.sheets {
            sheet.push_segments(&self.settings.cores, &mut self.segments);
        }
        for body in &self.bodies {
            body.push_segments(&self.settings.cores, &mut self.segments);
        }
        let Self { field, segments, pool, .. } = self;
        let pool = pool.get_mut().unwrap_or_else(PoisonError::into_inner);
        if is_new {
            field.rebuild(segments, pool);
        } else {
            field.refresh(segments, pool);
        }
    }

    /// On return `winds` holds the velocity at each of the nodes of all sheets, then of all bodies' rings.
    fn feel(&mut self) -> Result<(), FlowError> {
        self.nodes.clear();
        self.middles.clear();
        for sheet in &self.sheets {
            self.nodes.extend_from_slice(&sheet.far.positions);
            self.nodes.extend_from_slice(&sheet.near.positions);
            sheet.push_middles(&mut self.middles);
        }
        for body in &self.bodies {
            self.nodes.extend_from_slice(&body.positions);
            body.push_middles(&mut self.middles);
        }
        self.winds.resize(self.nodes.len(), Vector3::ZERO);
        self.induced.resize(self.nodes.len(), Vector3::ZERO);
        self.wind.sample(&self.nodes, &mut self.winds);
        self.leave_shear_out();
        self.feel_vortices();
        self.move_to_nodes();
        for ((wind, induced), position) in self.winds.iter_mut().zip(&self.induced).zip(&self.nodes)
        {
            *wind += *induced;
            let speed = wind.length();
            if speed.is_nan() || speed > FASTEST {
                let (time, position) = (self.wind.time(), *position);
                return Err(FlowError::Diverged { time, position, speed });
            }
        }
        Ok(())
    }

    /// On return `winds` is without what does not carry wakes.
    fn leave_shear_out(&mut self) {
        let Self { settings, winds, nodes, sheets, rotors, bodies, .. } = self;
        let shear = &settings.shear;
        if *shear == MeanShear::Carries {
            return;
        }
        let of_sheets = sheets.iter().map(|sheet| {
            let n_nodes = sheet.far.positions.len() + sheet.near.positions.len();
            (n_nodes, rotors[sheet.owner[0]].height())
        });
        let of_bodies = bodies.iter().map(|body| (body.positions.len(), body.position.z));
        let mut places = winds.iter_mut().zip(nodes.iter());
        for (n_nodes, of_hub) in of_sheets.chain(of_bodies) {
            let at_hub = shear.left_out(of_hub);
            for (wind, node) in places.by_ref().take(n_nodes) {
                *wind -= shear.left_out(node.z) - at_hub;
            }
        }
    }

    /// On return `induced` holds what vortices induce at the middles of filaments.
    fn feel_vortices(&mut self) {
        let Self { neighbours, middles, pool, .. } = self;
        neighbours.sort(middles, pool.get_mut().unwrap_or_else(PoisonError::into_inner));
        let mut sorted = std::mem::take(&mut self.sorted);
        sorted.resize(self.middles.len(), Vector3::ZERO);
        self.pool().for_chunks(&mut sorted, CHUNK, &|first, chunk| {
            self.induce(&self.neighbours.sorted()[first..first + chunk.len()], chunk);
        });
        self.neighbours.to_own_order(&sorted, &mut self.induced);
        self.sorted = sorted;
    }

    /// On return `induced` holds what vortices induce at nodes, in place of the middles of filaments.
    fn move_to_nodes(&mut self) {
        let mut rest = &mut self.induced[..];
        for sheet in &self.sheets {
            let n_nodes = sheet.far.positions.len() + sheet.near.positions.len();
            let (mine, others) = rest.split_at_mut(n_nodes);
            sheet.to_nodes(mine);
            rest = others;
        }
        sides_to_nodes(N_SIDES, rest);
    }

    /// Moves the nodes of all sheets and bodies' rings with the velocities of [`feel`](Self::feel).
    fn carry(&mut self, duration: f64) {
        let WakeSettings { ground, cores, .. } = self.settings;
        let mut start = 0;
        for sheet in &mut self.sheets {
            if cores.strain {
                sheet.live(0.5 * duration);
            }
            for strip in [&mut sheet.far, &mut sheet.near] {
                let end = start + strip.positions.len();
                strip.advance(duration, &self.winds[start..end]);
                if ground {
                    strip.positions.iter_mut().for_each(|node| node.z = node.z.max(LOWEST));
                }
                start = end;
            }
            if cores.strain {
                sheet.live(0.5 * duration);
            }
        }
        for body in &mut self.bodies {
            let end = start + body.positions.len();
            body.advance(duration, &self.winds[start..end]);
            if ground {
                body.positions.iter_mut().for_each(|node| node.z = node.z.max(LOWEST));
            }
            start = end;
        }
    }

    /// Tells every rotor what its youngest rings do to its elements, and its nacelle's to the nacelle.
    pub(super) fn tell_rotors(&mut self) {
        let Self { rotors, sheets, bodies, settings, pool, .. } = self;
        let pool = pool.get_mut().unwrap_or_else(PoisonError::into_inner);
        for (index, rotor) in rotors.iter_mut().enumerate() {
            let mine = sheets.iter().filter(|sheet| sheet.owner[0] == index);
            rotor.feel_rings(mine, &settings.cores, pool);
            let mine = bodies.iter().filter(|body| body.turbine == rotor.turbine());
            rotor.at_nacelle = mine.map(|body| body.own_velocity(&settings.cores)).sum();
        }
    }
}

impl WindField for FreeWake {
    fn sample(&self, positions: &[Vector3], velocities: &mut [Vector3]) {
        self.wind.sample(positions, velocities);
        for (positions, velocities) in positions.chunks(GROUP).zip(velocities.chunks_mut(GROUP)) {
            let mut induced = [Vector3::ZERO; GROUP];
            self.induce(positions, &mut induced[..positions.len()]);
            for (velocity, induced) in velocities.iter_mut().zip(induced) {
                *velocity += induced;
            }
        }
    }
}

impl FlowSolver for FreeWake {
    fn advance(&mut self, duration: f64, forces: &[PointForce]) -> Result<(), FlowError> {
        if duration != self.settings.interval {
            return Err(FlowError::FractionalStep { duration, step: self.settings.interval });
        }
        let mut is_new = self.meet(forces);
        self.check_turns(duration)?;
        for sheet in &mut self.sheets {
            let rotor = &self.rotors[sheet.owner[0]];
            let circulations = rotor.circulations_of(sheet.owner[1]);
            if sheet.near.n_rows() == 0 {
                sheet.place_line(rotor.line_of(sheet.owner[1]), circulations);
                is_new = true;
            }
            sheet.release(circulations);
        }
        self.gather(is_new);
        self.feel()?;
        self.carry(duration);
        self.wind.advance(duration, forces)?;
        for rotor in &mut self.rotors {
            rotor.move_on();
        }
        for sheet in &mut self.sheets {
            let rotor = &self.rotors[sheet.owner[0]];
            let blade = sheet.owner[1];
            sheet.place_line(rotor.line_of(blade), rotor.circulations_of(blade));
        }
        self.gather(true);
        self.tell_rotors();
        Ok(())
    }

    fn resolves_induction(&self) -> bool {
        true
    }

    fn answer(&self, turbine: usize) -> Option<Answer<'_>> {
        self.rotors.iter().find(|rotor| rotor.turbine() == turbine)?.answer()
    }
}
