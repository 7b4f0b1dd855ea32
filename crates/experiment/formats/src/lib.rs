//! Every file that is read or written, and nothing but.
//!
//! Files appear whole or not at all ([`atomic`]); an error names the file, what was being done, and the fix.

pub mod atomic;
mod beside;
pub mod case;
pub mod checkpoint;
pub mod clock;
pub mod fields;
pub mod leftovers;
pub mod library;
pub mod linear_model;
pub mod lock;
pub mod machine;
pub mod netcdf;
pub mod openfast;
pub mod openfast_output;
pub mod records;
pub mod rosco;
pub mod shipped;
pub mod surrogate_model;
pub mod table;
mod tecplot;
pub mod tracks;
pub mod turbine_file;
pub mod turbulence_box;
pub mod vtk;
pub mod wind_table;
pub mod windio;

pub use atomic::FileError;

#[cfg(test)]
mod fuzz;
