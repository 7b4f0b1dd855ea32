//! Where one vortex passes the one before it.

use super::Track;

/// Which vortices are taken together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pairs {
    /// Each with the one that came next.
    All,
    /// Of each `n_blades` vortices that follow one another the first two, counted from the `first` on.
    OfBlades {
        /// Vortices a revolution (–).
        n_blades: usize,
        /// Which of them is the first of a pair, from 0 (–).
        first: usize,
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

/// Where of each pair of `tracks` that were born in the plane, one after the other and of one sign, the
/// second first gets as far along the first axis as the first: when the pair has turned by 90°.
///
/// Linear between frames. Source: van der Hoek et al. (2024), §3.4, after Lignarolo et al. (2015), J. Fluid
/// Mech. 781.
pub fn leapfrogs(tracks: &[Track], pairs: Pairs) -> Vec<Leapfrog> {
    let mut found = Vec::new();
    for sign in [1.0, -1.0] {
        let is_one =
            |track: &&Track| track.is_born && track.sightings[0].vortex.circulation * sign > 0.0;
        let mut born: Vec<&Track> = tracks.iter().filter(is_one).collect();
        born.sort_by_key(|track| (track.sightings[0].step, track.id));
        for (number, pair) in born.windows(2).enumerate() {
            let counts = match pairs {
                Pairs::All => true,
                Pairs::OfBlades { n_blades, first } => number % n_blades.max(1) == first,
            };
            if counts {
                found.extend(passing(pair[0], pair[1]));
            }
        }
    }
    found
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
