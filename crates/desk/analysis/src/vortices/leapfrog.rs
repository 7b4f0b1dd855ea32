//! Where one vortex passes the one before it.

use super::Track;
use std::f64::consts::TAU;

/// The blades that vortices come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blades {
    /// Blades (–).
    pub n: usize,
    /// Steps of a revolution (–).
    pub per_revolution: usize,
    /// Place along the first axis by which it is told when a vortex came (m).
    pub line: f64,
}

/// Which vortices are taken together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pairs {
    /// Each with the one that came next.
    All,
    /// That of one blade with that of the next one.
    Of {
        /// All blades.
        blades: Blades,
        /// The blade whose vortex is the first of a pair, from 0, in the order in which vortices come after
        /// the first step (–).
        first: usize,
        /// How many vortices later the one came that passes (–): the next when 1.
        later: usize,
    },
}

/// A vortex that passes another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leapfrog {
    /// The one that is passed, and the one that came after it and passes: numbers of tracks.
    pub ids: [usize; 2],
    /// Where along the first axis (m).
    pub place: f64,
    /// When, in steps since the first frame (–), between frames too.
    pub step: f64,
}

/// Where of each pair of `tracks` that were born in the plane and are of one sign the one that came later
/// first gets as far along the first axis as the other: when the pair has turned by 90°.
///
/// Linear between frames. Source: van der Hoek et al. (2024), §3.4, after Lignarolo et al. (2015), J. Fluid
/// Mech. 781.
pub fn leapfrogs(tracks: &[Track], pairs: Pairs) -> Vec<Leapfrog> {
    let mut found = Vec::new();
    let born = born(tracks);
    let numbers = match pairs {
        Pairs::All => born.each_ref().map(|side| vec![None; side.len()]),
        Pairs::Of { blades, .. } => numbers(&born, &blades),
    };
    for (born, numbers) in born.iter().zip(&numbers) {
        for (place, track) in born.iter().enumerate() {
            let partner = match pairs {
                Pairs::All => born.get(place + 1),
                Pairs::Of { blades, first, later } => numbers[place]
                    .filter(|number| blades.of(*number) == first)
                    // A vortex that was missed breaks its pairs alone.
                    .and_then(|number| {
                        numbers.iter().position(|other| *other == Some(number + later as i64))
                    })
                    .map(|place| &born[place]),
            };
            found.extend(partner.and_then(|partner| passing(track, partner)));
        }
    }
    found
}

/// The blade, from 0, that each of the `tracks` comes from which were born in the plane: number of the track,
/// and the blade in the order in which vortices come after the first step.
pub fn blades_of(tracks: &[Track], blades: &Blades) -> Vec<(usize, usize)> {
    let born = born(tracks);
    let numbers = numbers(&born, blades);
    let pairs = born.iter().flatten().map(|track| track.id).zip(numbers.into_iter().flatten());
    pairs.filter_map(|(id, number)| Some((id, blades.of(number?)))).collect()
}

/// The tracks that were born in the plane, of either sign, in the order in which they came.
fn born(tracks: &[Track]) -> [Vec<&Track>; 2] {
    [1.0, -1.0].map(|sign| {
        let is_one =
            |track: &&Track| track.is_born && track.sightings[0].vortex.circulation * sign > 0.0;
        let mut born: Vec<&Track> = tracks.iter().filter(is_one).collect();
        born.sort_by_key(|track| (track.sightings[0].step, track.id));
        born
    })
}

impl Blades {
    /// The blade of vortex `number`.
    fn of(&self, number: i64) -> usize {
        number.rem_euclid(self.n.max(1) as i64) as usize
    }
}

/// Number of each of the tracks that were `born` of either sign, in the order in which blades pass, whether
/// all were seen or not; none of one that was seen once.
///
/// Blades pass at even intervals, after a time that the mean over all of them tells. They pass the other side
/// of the rotor half a turn later, where vortices turn the other way: one blade has one number on both.
fn numbers(born: &[Vec<&Track>; 2], blades: &Blades) -> [Vec<Option<i64>>; 2] {
    let period = blades.per_revolution as f64 / blades.n.max(1) as f64;
    let first =
        |side: &Vec<&Track>| side.first().map_or(usize::MAX, |track| track.sightings[0].step);
    let is_second_first = first(&born[1]) < first(&born[0]);
    let half_turn = 0.5 * blades.per_revolution as f64;
    let delays = if is_second_first { [half_turn, 0.0] } else { [0.0, half_turn] };
    let came: [Vec<Option<f64>>; 2] = std::array::from_fn(|side| {
        let at = |track: &&Track| came_at(track, blades.line).map(|step| step - delays[side]);
        born[side].iter().map(at).collect()
    });
    let angles = came.iter().flatten().flatten().map(|step| TAU * step / period);
    let (sine, cosine) =
        angles.fold((0.0, 0.0), |(s, c), angle| (s + angle.sin(), c + angle.cos()));
    let offset = f64::atan2(sine, cosine).rem_euclid(TAU) / TAU;
    let number = |step: f64| (step / period - offset).round() as i64;
    came.map(|side| side.into_iter().map(|step| step.map(number)).collect())
}

/// The step at which `track` is at `line` along the first axis (m), straight through its first two sightings.
fn came_at(track: &Track, line: f64) -> Option<f64> {
    let [a, b] = track.sightings.first_chunk::<2>()?;
    let [x, y] = [a, b].map(|one| one.vortex.position[0]);
    let steps = (b.step - a.step) as f64;
    let step = a.step as f64 + steps * (line - x) / (y - x);
    step.is_finite().then_some(step)
}

/// Where `second` passes `first`.
fn passing(first: &Track, second: &Track) -> Option<Leapfrog> {
    let start = second.sightings[0].step;
    let end = second.sightings[second.sightings.len() - 1].step;
    let ahead = |step: usize| {
        let own = first.first_axis_at(step)?;
        Some((own, second.first_axis_at(step)? - own))
    };
    let (mut before, mut ahead_before) = ahead(start)?;
    if ahead_before >= 0.0 {
        return None;
    }
    for step in start + 1..=end {
        let (now, ahead_now) = ahead(step)?;
        if ahead_now >= 0.0 {
            let share = ahead_before / (ahead_before - ahead_now);
            return Some(Leapfrog {
                ids: [first.id, second.id],
                place: before + share * (now - before),
                step: (step - 1) as f64 + share,
            });
        }
        (before, ahead_before) = (now, ahead_now);
    }
    None
}
