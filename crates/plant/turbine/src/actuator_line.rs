//! Actuator lines: blades as lines of elements in a wind that already contains the rotor's own, smeared
//! induction.

use crate::aero::Polar;
use crate::definition::{BladeStation, Definition};
use crate::lifting_line::{OPTIMAL_WIDTH_OVER_CHORD, SmearingCorrection, Span};
use crate::loading::{Loading, excess};
use crate::rotor::Frame;
use basis::Vector3;
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

/// Sweeps of the lifting-line fixed point per step (–); each step starts from the last result, so few
/// suffice.
const N_SWEEPS: usize = 4;
/// Relaxation of a sweep at an element whose circulation does not react to its own induction (–).
const RELAXATION: f64 = 0.6;
/// Share of uniform spacing among the elements' borders (–); the rest is cosine spacing, finer at root and
/// tip.
const UNIFORM_SHARE: f64 = 0.5;

/// The blades of a rotor, all alike; parameters only.
#[derive(Clone, Debug)]
pub struct ActuatorLine {
    air_density: f64,
    elements: Vec<Element>,
    span: Span,
    /// Smearing of a wind sample: that of the forces and of the interpolation (m).
    seen_width: f64,
    /// Made where it is used: it takes a fraction of a second.
    correction: OnceLock<SmearingCorrection>,
    loading: Loading,
    definition: Arc<Definition>,
}

/// One element of a blade.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// Distance of its middle from the rotor apex along the pitch axis (m).
    pub span: f64,
    /// Distance of its middle from the pitch axis, upwind (m).
    pub prebend: f64,
    /// Distance of its middle from the shaft's axis (m).
    pub radius: f64,
    /// Local cone angle: of the blade's line out of the rotor plane, tips upwind, precone and prebend (rad).
    pub cone_angle: f64,
    /// Length along the blade's line (m).
    pub width: f64,
    /// Share of it that lies inside of the middle, which is one of angles where elements become narrow (–).
    pub inner_share: f64,
    /// Chord (m).
    pub chord: f64,
    /// Twist, positive to feather (rad).
    pub twist: f64,
    /// Polars of the definition's stations on either side, and the share of the second (–).
    pub(crate) polars: [usize; 2],
    pub(crate) share: f64,
    /// Relaxation of its smearing correction (–).
    relaxation: f64,
}

/// Wind at an element, in the blade's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Onset {
    /// Out of the surface that the blade sweeps, downwind (m/s).
    pub normal: f64,
    /// Against the rotation, the blade's own motion included (m/s).
    pub tangential: f64,
}

/// Load of an element: force on the blade per metre of span, and the circulation behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Downwind, out of the swept surface (N/m).
    pub normal: f64,
    /// Along the rotation (N/m).
    pub tangential: f64,
    /// Circulation, positive where lift drives the rotor (m²/s).
    pub circulation: f64,
}

/// How the sections of a rotor respond to the wind at them.
pub trait Sections {
    /// Lift and drag coefficient (–) of element number `index`, blade after blade, at `angle_of_attack` (rad)
    /// and a relative `speed` (m/s). It may be called several times for one instant; the last call counts.
    fn coefficients(&mut self, index: usize, angle_of_attack: f64, speed: f64) -> [f64; 2];
}

/// Quasi-steady sections: their polars hold at once.
#[derive(Clone, Copy, Debug)]
pub struct QuasiSteady<'a>(pub &'a ActuatorLine);

impl Sections for QuasiSteady<'_> {
    fn coefficients(&mut self, index: usize, angle_of_attack: f64, _speed: f64) -> [f64; 2] {
        let Self(line) = self;
        let element = &line.elements[index % line.elements.len()];
        let [inner, outer] =
            element.polars.map(|polar| line.definition.polars[polar].at(angle_of_attack));
        [
            inner.lift + element.share * (outer.lift - inner.lift),
            inner.drag + element.share * (outer.drag - inner.drag),
        ]
    }
}

/// Working memory of [`ActuatorLine::loads`]; carries nothing from one call to the next.
#[derive(Clone, Debug)]
pub struct Scratch {
    circulations: Vec<f64>,
    thrusts: Vec<f64>,
    speeds: Vec<f64>,
    excess: Vec<f64>,
}

impl Scratch {
    /// For `n_blades` blades of `n_elements` elements each.
    pub fn new(n_blades: usize, n_elements: usize) -> Self {
        let rings = || vec![0.0; n_elements];
        Self {
            circulations: vec![0.0; n_blades * n_elements],
            thrusts: rings(),
            speeds: rings(),
            excess: rings(),
        }
    }
}

impl ActuatorLine {
    /// The blades of `definition` in `n_elements` each, forces smeared over `smearing_length` (m).
    ///
    /// Wind samples that a flow interpolates linearly between points `sample_spacing` (m) apart are smeared a
    /// little more: a hat of that half-width has the variance `sample_spacing`²/6 where a Gaussian of width ε
    /// has ε²/2.
    pub fn new(
        definition: Arc<Definition>,
        n_elements: usize,
        air_density: f64,
        smearing_length: f64,
        sample_spacing: f64,
    ) -> Self {
        let geometry = &definition.rotor;
        let at = |share: f64| {
            let cosine = 0.5 * (1.0 - (PI * share).cos());
            (UNIFORM_SHARE * share + (1.0 - UNIFORM_SHARE) * cosine) * definition.blade_length()
        };
        let radius = |station: &BladeStation| {
            definition.distance_from_shaft(geometry.hub_radius + station.span, station.prebend)
        };
        let section = |index: f64| section(&definition.blade, at(index / n_elements as f64));
        let borders: Vec<BladeStation> = (0..=n_elements).map(|i| section(i as f64).0).collect();
        let mut elements: Vec<Element> = borders
            .windows(2)
            .enumerate()
            .map(|(i, ends)| {
                let (middle, polars, share) = section(i as f64 + 0.5);
                let (length, bend) =
                    (ends[1].span - ends[0].span, ends[1].prebend - ends[0].prebend);
                Element {
                    span: geometry.hub_radius + middle.span,
                    prebend: middle.prebend,
                    radius: radius(&middle),
                    cone_angle: geometry.precone + bend.atan2(length),
                    width: length.hypot(bend),
                    inner_share: (middle.span - ends[0].span) / length,
                    chord: middle.chord,
                    twist: middle.twist,
                    polars,
                    share,
                    relaxation: 0.0,
                }
            })
            .collect();
        for element in &mut elements {
            // Γ reacts to an upwash with π c (thin aerofoil), the upwash to Γ with 1/(π Δr) (its own border
            // vortices).
            element.relaxation = RELAXATION / (1.0 + element.chord / element.width);
        }
        let core = |station: &BladeStation| {
            (OPTIMAL_WIDTH_OVER_CHORD * station.chord)
                .clamp(1e-4 * definition.rotor_radius(), smearing_length)
        };
        let span = Span {
            borders: borders.iter().map(radius).collect(),
            centres: elements.iter().map(|element| element.radius).collect(),
            cores: borders.iter().map(core).collect(),
        };
        let seen_width = smearing_length.hypot(sample_spacing / 3.0_f64.sqrt());
        let loading = Loading::new(&span.centres, seen_width);
        let correction = OnceLock::new();
        Self { air_density, elements, span, seen_width, correction, loading, definition }
    }

    /// The smearing correction, made at the first call: call it once before time begins.
    pub fn correction(&self) -> &SmearingCorrection {
        let make =
            || SmearingCorrection::new(self.definition.n_blades, &self.span, self.seen_width);
        self.correction.get_or_init(make)
    }

    /// Elements of each blade, root to tip.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Loads of all elements in the winds `onsets`, sections turned by `pitch` (rad) beside their twist, with
    /// the smearing correction.
    ///
    /// `onsets`, `pitch`, `corrections` and `loads` hold `n_blades × n_elements` values, blade after blade.
    /// `corrections` is the state of the smearing correction: the induced velocity lost by smearing, axial
    /// and along the rotation (m/s). On return it has been relaxed towards the value that belongs to `loads`.
    /// `rotor_speed` (rad/s) sets the pitch of the helical wake together with the mean wind through the
    /// rotor; `sections` respond to the wind at each element.
    pub fn loads(
        &self,
        onsets: &[Onset],
        rotor_speed: f64,
        pitch: &[f64],
        sections: &mut impl Sections,
        corrections: &mut [[f64; 2]],
        loads: &mut [Load],
        scratch: &mut Scratch,
    ) {
        let n = self.elements.len();
        let carried = self.mean_wind(onsets);
        let correction = self.correction();
        let helix = correction.helix(carried / rotor_speed.max(1e-3));
        for sweep in 0..=N_SWEEPS {
            self.loads_under(onsets, pitch, sections, corrections, loads);
            for (circulation, load) in scratch.circulations.iter_mut().zip(&*loads) {
                *circulation = load.circulation;
            }
            if sweep == N_SWEEPS {
                break;
            }
            self.nonlinear_part(onsets, carried, scratch);
            for (index, corrections) in corrections.iter_mut().enumerate() {
                let (axial, tangential) = correction.velocity_correction(
                    helix,
                    index / n,
                    index % n,
                    &scratch.circulations,
                );
                let axial = axial + scratch.excess[index % n];
                let relaxation = self.elements[index % n].relaxation;
                corrections[0] += relaxation * (axial - corrections[0]);
                corrections[1] += relaxation * (tangential - corrections[1]);
            }
        }
    }

    /// Loads of all elements like [`ActuatorLine::loads`], with the smearing `corrections` (m/s) held.
    pub fn loads_under(
        &self,
        onsets: &[Onset],
        pitch: &[f64],
        sections: &mut impl Sections,
        corrections: &[[f64; 2]],
        loads: &mut [Load],
    ) {
        for (index, (load, onset)) in loads.iter_mut().zip(onsets).enumerate() {
            *load = self.load(index, onset.with(corrections[index]), pitch[index], sections);
        }
    }

    /// On return `scratch.excess` holds the nonlinear part of the smearing correction on each ring (m/s), by
    /// momentum theory.
    fn nonlinear_part(&self, onsets: &[Onset], carried: f64, scratch: &mut Scratch) {
        let n = self.elements.len();
        let Scratch { circulations, thrusts, speeds, excess: parts } = scratch;
        let n_blades = onsets.len() / n;
        thrusts.fill(0.0);
        speeds.fill(0.0);
        for (index, (onset, circulation)) in onsets.iter().zip(&*circulations).enumerate() {
            // Lift across the wind of rotation, over the density (m⁴/s²).
            thrusts[index % n] += circulation * onset.tangential * self.elements[index % n].width;
            speeds[index % n] += onset.normal / n_blades as f64;
        }
        for (station, (part, element)) in parts.iter_mut().zip(&self.elements).enumerate() {
            let thin = thrusts[station] / (2.0 * PI * element.radius * element.width);
            let smeared = self.loading.smeared(station, thrusts);
            *part = excess(speeds[station], smeared, thin, carried);
        }
    }

    /// Component of `winds` (m/s, one for each element, blade after blade) along `shaft`, averaged over the
    /// swept area (m/s).
    pub fn mean_axial(&self, winds: &[Vector3], shaft: Vector3) -> f64 {
        let (mut sum, mut area) = (Vector3::ZERO, 0.0);
        for (wind, element) in winds.iter().zip(self.elements.iter().cycle()) {
            let ring = element.radius * element.width;
            sum += *wind * ring;
            area += ring;
        }
        sum.dot(shaft) / area
    }

    /// Wind out of the swept surface (m/s), averaged over the swept area.
    fn mean_wind(&self, onsets: &[Onset]) -> f64 {
        let (mut sum, mut area) = (0.0, 0.0);
        for (onset, element) in onsets.iter().zip(self.elements.iter().cycle()) {
            let ring = element.radius * element.width;
            sum += ring * onset.normal;
            area += ring;
        }
        sum / area
    }

    /// Load of element number `index` in the wind `onset`, turned by `pitch` (rad) beside its twist.
    pub(crate) fn load(
        &self,
        index: usize,
        onset: Onset,
        pitch: f64,
        sections: &mut impl Sections,
    ) -> Load {
        let element = &self.elements[index % self.elements.len()];
        let speed = onset.normal.hypot(onset.tangential);
        if speed == 0.0 {
            return Load::default();
        }
        let (sine, cosine) = (onset.normal / speed, onset.tangential / speed);
        let inflow_angle = onset.normal.atan2(onset.tangential);
        let angle_of_attack = inflow_angle - element.twist - pitch;
        let [lift_coefficient, drag_coefficient] =
            sections.coefficients(index, angle_of_attack, speed);
        let scale = 0.5 * self.air_density * speed * speed * element.chord;
        let (lift, drag) = (scale * lift_coefficient, scale * drag_coefficient);
        Load {
            normal: lift * cosine + drag * sine,
            tangential: lift * sine - drag * cosine,
            circulation: 0.5 * speed * element.chord * lift_coefficient,
        }
    }
}

impl Onset {
    /// The same with an induced velocity on top: axial, downwind, and tangential, along the rotation (m/s).
    pub(crate) fn with(self, [axial, tangential]: [f64; 2]) -> Self {
        Self { normal: self.normal + axial, tangential: self.tangential - tangential }
    }
}

impl Element {
    /// Its polar in `definition`: that of the stations on either side, blended.
    pub(crate) fn polar(&self, definition: &Definition) -> Polar {
        let [inner, outer] = self.polars.map(|polar| &definition.polars[polar]);
        if self.polars[0] == self.polars[1] {
            inner.clone()
        } else {
            Polar::between(inner, outer, self.share)
        }
    }

    /// Its middle, farm frame (m), on a blade at `azimuth` (rad) whose pitch axis is coned by `precone`
    /// (rad).
    pub fn position(&self, frame: &Frame, azimuth: f64, precone: f64) -> Vector3 {
        let axes = frame.blade(azimuth, precone);
        frame.hub + axes.span * self.span - axes.normal * self.prebend
    }
}

/// The blade at `span` (m) from its root, linear between `stations`; their two polars, and the share of the
/// second (–).
fn section(stations: &[BladeStation], span: f64) -> (BladeStation, [usize; 2], f64) {
    let next =
        stations.partition_point(|station| station.span <= span).clamp(1, stations.len() - 1);
    let (low, high) = (&stations[next - 1], &stations[next]);
    let share = (span - low.span) / (high.span - low.span);
    let between = |from: f64, to: f64| from + share * (to - from);
    let station = BladeStation {
        span,
        chord: between(low.chord, high.chord),
        twist: between(low.twist, high.twist),
        prebend: between(low.prebend, high.prebend),
        sweep: between(low.sweep, high.sweep),
        polar: low.polar,
    };
    (station, [low.polar, high.polar], share)
}
