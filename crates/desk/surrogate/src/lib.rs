//! Surrogates: a few expensive results made into a curve with its uncertainty.
