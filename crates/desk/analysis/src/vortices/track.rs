//! Vortices followed from one instant, or one bin of phase, to the next.

use super::Vortex;

/// Sightings that tell how strong a vortex is at first (–).
const AT_FIRST: usize = 3;

/// How vortices are followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracking {
    /// Time between frames (s).
    pub interval: f64,
    /// How far a vortex may be from where it was expected (m).
    pub gate: f64,
    /// How often vortices are followed through all frames (–): once, or more often where the first frame
    /// follows the last, as bins of phase do.
    pub n_rounds: usize,
    /// Position along the first axis below which a vortex is taken as new (m).
    pub birth: f64,
    /// Frames that a vortex may be missing from (–).
    pub most_missed: usize,
}

/// A vortex in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    /// Steps since the first frame (–); in a cycle the frame is this, modulo their number.
    pub step: usize,
    /// The vortex.
    pub vortex: Vortex,
}

/// A vortex through many frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Its number, from 0 in the order of first sightings.
    pub id: usize,
    /// Where it was seen, in the order of time.
    pub sightings: Vec<Sighting>,
    /// Whether it was first seen upstream of [`Tracking::birth`], rather than on its way.
    pub is_born: bool,
}

impl Track {
    /// Position along the first axis (m) at `step`, linear between sightings; none outside them.
    pub fn first_axis_at(&self, step: usize) -> Option<f64> {
        let after = self.sightings.partition_point(|one| one.step < step);
        let later = self.sightings.get(after)?;
        if later.step == step {
            return Some(later.vortex.position[0]);
        }
        let before = &self.sightings[after.checked_sub(1)?];
        let share = (step - before.step) as f64 / (later.step - before.step) as f64;
        let [a, b] = [before, later].map(|one| one.vortex.position[0]);
        Some(a + share * (b - a))
    }

    /// Position along the first axis (m) where the vorticity in its middle first falls to half of what it
    /// was, the mean of its first three sightings; linear between sightings. None where it does not as long
    /// as it is followed.
    pub fn half_strength_at(&self) -> Option<f64> {
        let strength = |one: &Sighting| one.vortex.peak_vorticity().abs();
        let (first, rest) = self.sightings.split_at_checked(AT_FIRST)?;
        let half = 0.5 * first.iter().map(strength).sum::<f64>() / AT_FIRST as f64;
        let after = AT_FIRST + rest.iter().position(|one| strength(one) <= half)?;
        let [before, after] = [after - 1, after].map(|place| &self.sightings[place]);
        let share = (strength(before) - half) / (strength(before) - strength(after));
        let [a, b] = [before, after].map(|one| one.vortex.position[0]);
        // Where the first three fall steeply the last of them may be below the half already.
        Some(a + share.clamp(0.0, 1.0) * (b - a))
    }

    /// Where it is expected at `step` (m): as far on as it went last, or as the air about it goes.
    fn expected(&self, step: usize, interval: f64) -> [f64; 2] {
        let last = &self.sightings[self.sightings.len() - 1];
        let velocity = match self.sightings.len().checked_sub(2) {
            Some(before) => {
                let before = &self.sightings[before];
                let time = interval * (last.step - before.step) as f64;
                [0, 1]
                    .map(|axis| (last.vortex.position[axis] - before.vortex.position[axis]) / time)
            }
            None => last.vortex.drift,
        };
        let time = interval * (step - last.step) as f64;
        [0, 1].map(|axis| last.vortex.position[axis] + velocity[axis] * time)
    }
}

/// Follows the vortices of `frames`, which come one after another.
///
/// Of all pairs of a track and a vortex of its sign that is within the gate of where it is expected, the
/// nearest goes first. What no track takes begins one of its own; in further rounds it does not.
pub fn follow(frames: &[Vec<Vortex>], tracking: &Tracking) -> Vec<Track> {
    let n_steps = tracking.n_rounds.max(1) * frames.len();
    let mut tracks: Vec<Track> = Vec::new();
    for step in 0..n_steps {
        let frame = &frames[step % frames.len()];
        let mut taken = vec![false; frame.len()];
        let mut moved = vec![false; tracks.len()];
        for (_, track, place) in candidates(&tracks, frame, step, tracking) {
            if !moved[track] && !taken[place] {
                (moved[track], taken[place]) = (true, true);
                tracks[track].sightings.push(Sighting { step, vortex: frame[place] });
            }
        }
        if step < frames.len() {
            for (vortex, _) in frame.iter().zip(&taken).filter(|(_, taken)| !**taken) {
                tracks.push(Track {
                    id: tracks.len(),
                    sightings: vec![Sighting { step, vortex: *vortex }],
                    is_born: vortex.position[0] <= tracking.birth,
                });
            }
        }
    }
    tracks
}

/// Pairs of tracks and vortices of `frame` that may belong together, with their distance (m), the nearest
/// first.
fn candidates(
    tracks: &[Track],
    frame: &[Vortex],
    step: usize,
    tracking: &Tracking,
) -> Vec<(f64, usize, usize)> {
    let mut pairs = Vec::new();
    for (number, track) in tracks.iter().enumerate() {
        let last = &track.sightings[track.sightings.len() - 1];
        if step - last.step > tracking.most_missed + 1 {
            continue;
        }
        let expected = track.expected(step, tracking.interval);
        for (place, vortex) in frame.iter().enumerate() {
            let away = [0, 1].map(|axis| vortex.position[axis] - expected[axis]);
            let distance = away[0].hypot(away[1]);
            if distance <= tracking.gate && vortex.circulation * last.vortex.circulation > 0.0 {
                pairs.push((distance, number, place));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    pairs
}
