//! What both sides of the wall speak: frames, angles, signals, point forces, records.
//!
//! Conventions, stated once:
//!
//! ```text
//!        z up                    looking downwind (along +x), the rotor turns clockwise
//!        |   x downwind
//!        |  /                         blade 1 up: azimuth 0
//!        | /                                |   ⟳ azimuth grows
//!  y ----+        y left looking            |
//!  origin on the ground below         y ----o---- -y   (azimuth 90° is blade 1 at −y)
//!  the first turbine
//! ```
//!
//! SI and radians everywhere; pitch is positive to feather.

pub mod angle;
pub mod blades;
pub mod channels;
pub mod force;
mod helix_frame;
pub mod keys;
pub mod mbc;
mod mixed;
pub mod records;
pub mod registry;
pub mod scan;
mod sense;
pub mod signals;

pub use blades::PerBlade;
pub use channels::{Channel, Unit};
pub use force::{Answer, BoundVortex, PointForce};
pub use glam::{DMat3 as Matrix3, DVec3 as Vector3};
pub use helix_frame::HelixFrame;
pub use mbc::FixedFrame;
pub use mixed::mixed;
pub use sense::Sense;
pub use signals::{Commands, Measurements, Reading, Truth};
