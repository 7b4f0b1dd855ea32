//! One value per blade, without allocation.

use serde::{Deserialize, Serialize};
use std::ops::{Deref, DerefMut};

/// Most blades a rotor may have.
pub const MAXIMUM_BLADES: usize = 6;

/// One value for each blade of a rotor, blade 1 first; dereferences to a slice.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PerBlade<T> {
    values: [T; MAXIMUM_BLADES],
    n_blades: usize,
}

impl<T: Copy + Default> PerBlade<T> {
    /// The value of `of(blade)` for each of `n_blades` blades.
    ///
    /// # Panics
    /// When `n_blades` exceeds [`MAXIMUM_BLADES`]; turbine files are checked against it on reading.
    pub fn from_fn(n_blades: usize, mut of: impl FnMut(usize) -> T) -> Self {
        assert!(n_blades <= MAXIMUM_BLADES, "a rotor has at most {MAXIMUM_BLADES} blades");
        let mut values = [T::default(); MAXIMUM_BLADES];
        for (blade, value) in values.iter_mut().enumerate().take(n_blades) {
            *value = of(blade);
        }
        Self { values, n_blades }
    }

    /// The same value for each of `n_blades` blades.
    pub fn splat(n_blades: usize, value: T) -> Self {
        Self::from_fn(n_blades, |_| value)
    }

    /// Each blade's value put through `of`.
    pub fn map<U: Copy + Default>(&self, mut of: impl FnMut(T) -> U) -> PerBlade<U> {
        PerBlade::from_fn(self.n_blades, |blade| of(self.values[blade]))
    }
}

impl PerBlade<f64> {
    /// Mean over the blades.
    pub fn mean(&self) -> f64 {
        self.iter().sum::<f64>() / self.n_blades as f64
    }
}

impl<T> Deref for PerBlade<T> {
    type Target = [T];
    fn deref(&self) -> &[T] {
        &self.values[..self.n_blades]
    }
}

impl<T> DerefMut for PerBlade<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.values[..self.n_blades]
    }
}
