//! Vortices followed from bin to bin, and where one passes another.

use super::{BLADES, Found, PAIR, is_of_a_tip};
use crate::PostprocessingError;
use crate::analyses::Request;
use crate::wake_fields::settings;
use analysis::vortices::{
    Blades, Leapfrog, Pairs, SineFit, Track, Tracking, blades_of, follow, leapfrogs, sine_fit,
};
use basis::angle::{wrap_to_half_turn, wrap_to_turn};
use std::f64::consts::TAU;

/// How far a vortex may be from where it is expected (rotor diameters).
const GATE: f64 = 0.08;
/// Length in which vortices are taken as new (rotor diameters).
const BIRTH: f64 = 0.15;
/// Revolutions for which a vortex is followed at least (–).
const REVOLUTIONS: f64 = 8.0;

/// A vortex that passed another.
pub(super) struct Passed {
    /// Which pair of the revolution, from 1, where blades are told.
    pub(super) pair: Option<usize>,
    /// Side of the hub: the name of the side to which the plane's second axis points, or of the other.
    pub(super) side: &'static str,
    /// Azimuth of the helix (rad), where there is a helix.
    pub(super) azimuth: Option<f64>,
    pub(super) one: Leapfrog,
}

/// The sine through the places of a pair on one side of the hub over the azimuth of the helix, which meets
/// the sides half a turn apart.
pub(super) struct Fitted {
    pub(super) pair: Option<usize>,
    pub(super) side: &'static str,
    pub(super) sine: SineFit,
}

/// Names of the sides of the hub along the plane's second axis, that to which it points first.
fn sides(found: &Found) -> [&'static str; 2] {
    match found.cut.grid.spanned()[1] {
        1 => ["left", "right"],
        _ => ["above", "below"],
    }
}

/// The side on which track number `id` was seen first.
fn side(found: &Found, id: usize) -> &'static str {
    let [ahead, behind] = sides(found);
    let hub = found.averaged.setting.hub[found.cut.grid.spanned()[1]];
    let track = found.tracks.iter().find(|track| track.id == id);
    let is_ahead = track.is_none_or(|track| track.sightings[0].vortex.position[1] >= hub);
    if is_ahead { ahead } else { behind }
}

/// The tracks of vortices of the blades' tips: those of roots come at the same times, and would be taken for
/// their neighbours.
pub(super) fn tips(found: &Found) -> Vec<Track> {
    let is_tip = |track: &&Track| {
        is_of_a_tip(&found.averaged, &found.cut, track.sightings[0].vortex.position)
    };
    found.tracks.iter().filter(is_tip).cloned().collect()
}

/// Follows the vortices that were `found` from bin to bin, behind a rotor of this `frequency` (Hz), and looks
/// where they leapfrog.
pub(super) fn follow_all(
    request: &Request,
    found: &mut Found,
    frequency: f64,
) -> Result<(), PostprocessingError> {
    let setting = &found.averaged.setting;
    let in_turn = TAU / found.averaged.head.rotor_width;
    let start = found.search(found.least).within[0][0];
    let rounds = (REVOLUTIONS * in_turn / found.frames.len() as f64).ceil() as usize + 1;
    let birth = start + BIRTH * setting.diameter + found.cut.grid.spacing[0];
    let tracking = Tracking {
        interval: 1.0 / (frequency * in_turn),
        gate: GATE * setting.diameter,
        n_rounds: if found.frames.len() > 1 { rounds } else { 1 },
        birth,
        most_missed: 1,
    };
    found.tracks = follow(&found.frames, &tracking);
    let tips = tips(found);
    if request.text(BLADES.name).is_none() {
        found.leapfrogs = passed(found, &tips, None, Pairs::All);
        found.fits = fits(found);
        return Ok(());
    }
    let n = settings::whole(request, &BLADES, 1, 3)?;
    let pair = settings::whole(request, &PAIR, 1, 1)?;
    if pair > n {
        return Err(PostprocessingError::Setting {
            setting: PAIR.name,
            given: pair.to_string(),
            expected: "a number up to that of the blades is expected",
            fix: "write such as 1",
        });
    }
    let blades = Blades { n, per_revolution: in_turn.round() as usize, line: birth };
    found.blades = blades_of(&tips, &blades);
    found.pair = Some(pair);
    let of_all = |found: &Found, later| -> Vec<Passed> {
        let of_one =
            |pair| passed(found, &tips, Some(pair), Pairs::Of { blades, first: pair - 1, later });
        (1..=n).flat_map(of_one).collect()
    };
    found.leapfrogs = of_all(found, 1);
    found.later = of_all(found, 2);
    found.fits = fits(found);
    Ok(())
}

/// Where `pairs` of the tracks `tips` leapfrog, which are pair number `pair` of a revolution.
fn passed(found: &Found, tips: &[Track], pair: Option<usize>, pairs: Pairs) -> Vec<Passed> {
    let bins = &found.averaged.head.bins;
    let told = |one: Leapfrog| {
        let [bin, next] = [0, 1].map(|ahead| &bins[(one.step as usize + ahead) % bins.len()]);
        // The helix goes on between bins, by as much as from this one to the next.
        let azimuth = bin
            .helix
            .zip(next.helix)
            .map(|(a, b)| wrap_to_turn(a + one.step.fract() * wrap_to_half_turn(b - a)));
        Passed { pair, side: side(found, one.ids[0]), azimuth, one }
    };
    leapfrogs(tips, pairs).into_iter().map(told).collect()
}

/// The sines through the places that were `found`, pair by pair and side by side.
fn fits(found: &Found) -> Vec<Fitted> {
    let hub = found.averaged.setting.hub[0];
    let window = found.averaged.head.helix_width.unwrap_or(0.0);
    let mut pairs: Vec<Option<usize>> = found.leapfrogs.iter().map(|one| one.pair).collect();
    pairs.dedup();
    let mut fits = Vec::new();
    for (pair, side) in pairs.into_iter().flat_map(|pair| sides(found).map(|side| (pair, side))) {
        let own = found.leapfrogs.iter().filter(|one| one.pair == pair && one.side == side);
        let (angles, places): (Vec<f64>, Vec<f64>) =
            own.filter_map(|one| Some((one.azimuth?, one.one.place - hub))).unzip();
        // Too few, or all at one azimuth: no sine.
        let sine = sine_fit(&angles, &places, window).ok();
        fits.extend(sine.map(|sine| Fitted { pair, side, sine }));
    }
    fits
}
