//! Random numbers that belong to wave numbers: the same for any box, thread or order.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rustfft::num_complex::Complex64;

/// Gives two complex normal numbers, of unit variance each, per signed wave index (m₁, m₂, m₃).
#[derive(Clone, Debug)]
pub(crate) struct Noise {
    seeded: ChaCha8Rng,
    bytes: Vec<u8>,
}

/// Bytes of one wave index: two complex numbers from four 32-bit words.
const BYTES: usize = 16;

/// Signed index on the natural numbers: 0, 1, −1, 2, −2, … → 0, 1, 2, 3, 4, ….
fn natural(index: i64) -> u64 {
    if index > 0 { 2 * index as u64 - 1 } else { 2 * index.unsigned_abs() }
}

impl Noise {
    /// The numbers of `seed`.
    pub(crate) fn new(seed: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..24].copy_from_slice(b"wakemix inflow 1");
        Self { seeded: ChaCha8Rng::from_seed(key), bytes: Vec::new() }
    }

    /// On return `numbers` holds those of (m₁, m₂, m₃) for all |m₂| ≤ `largest`; see [`Pencil::at`].
    pub(crate) fn pencil(&mut self, m1: i64, m3: i64, largest: usize) -> Pencil<'_> {
        let mut stream = self.seeded.clone();
        stream.set_stream(natural(m1) << 32 | natural(m3));
        stream.set_word_pos(0);
        self.bytes.resize((2 * largest + 1) * BYTES, 0);
        stream.fill_bytes(&mut self.bytes);
        Pencil { bytes: &self.bytes }
    }
}

/// Random numbers of all m₂ at one (m₁, m₃).
pub(crate) struct Pencil<'a> {
    bytes: &'a [u8],
}

impl Pencil<'_> {
    /// Two independent complex normal numbers with E|n|² = 1, of wave index m₂.
    pub(crate) fn at(&self, m2: i64) -> [Complex64; 2] {
        let start = natural(m2) as usize * BYTES;
        let uniform = |word: usize| {
            let place = start + 4 * word;
            let bytes = [0, 1, 2, 3].map(|byte| self.bytes[place + byte]);
            (f64::from(u32::from_le_bytes(bytes)) + 0.5) / 4_294_967_296.0
        };
        // Box and Muller: the modulus of a complex normal number is Rayleigh, its angle uniform.
        [0, 2].map(|word| {
            Complex64::from_polar(
                (-uniform(word).ln()).sqrt(),
                std::f64::consts::TAU * uniform(word + 1),
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wave_keeps_its_numbers_in_every_box() {
        let mut noise = Noise::new(7);
        let small = noise.pencil(3, -2, 8).at(-5);
        let large = noise.pencil(3, -2, 500).at(-5);
        assert_eq!(small, large);
        assert_ne!(small, noise.pencil(3, 2, 8).at(-5));
        assert_ne!(small, noise.pencil(2, -2, 8).at(-5));
        assert_ne!(small, Noise::new(8).pencil(3, -2, 8).at(-5));
    }

    #[test]
    fn is_normal_of_unit_variance() {
        let mut noise = Noise::new(1);
        let pencil = noise.pencil(1, 1, 50_000);
        let numbers: Vec<_> = (-50_000..=50_000).flat_map(|m2| pencil.at(m2)).collect();
        let n = numbers.len() as f64;
        let moment = |power: i32| numbers.iter().map(|z| z.re.powi(power)).sum::<f64>() / n;
        // Four standard errors of each sample moment.
        assert!(moment(1).abs() < 4.0 * (0.5 / n).sqrt());
        assert!((moment(2) - 0.5).abs() < 4.0 * (0.5 / n).sqrt());
        assert!((moment(4) - 0.75).abs() < 4.0 * (6.0 / n).sqrt());
        let mixed = numbers.iter().map(|z| z.re * z.im).sum::<f64>() / n;
        assert!(mixed.abs() < 4.0 * 0.5 / n.sqrt());
    }
}
