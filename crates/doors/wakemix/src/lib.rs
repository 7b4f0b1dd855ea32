//! Wind-farm wake mixing, from wind to report: the rooms under one roof.
//!
//! Each module is a room of the house; ARCHITECTURE.md in the repository says what belongs where. This page
//! is a way through them for who writes a program of his own; docs/library.md tells it at length, and six
//! programs in `examples/` run it.
//!
//! # A case, in memory
//!
//! A study goes through stages, each a type that is whole when it exists:
//! [`Case`](farm::case::Case) → [`Prepared`](study::Prepared) → [`Ready`](study::Ready) →
//! [`RunResult`](study::RunResult).
//!
//! ```
//! use wakemix::formats::case;
//! use wakemix::study::Prepared;
//!
//! let text = r#"
//! name = "first"
//! [wind]
//! speed = 9.0
//! turbulence_intensity = 0.0
//! [flow]
//! solver = "uniform"
//! [time]
//! spin_up = 5.0
//! duration = 20.0
//! [[turbine]]
//! name = "T1"
//! model = "nrel-5mw"
//! position_diameters = [0.0, 0.0]
//! structure = "rigid"
//! [[run]]
//! name = "baseline"
//! "#;
//! let mut case = case::parse("first", text, &[])?;
//! case.wind.speed = 8.0; // plain data: change what you like
//!
//! let prepared = Prepared::of(case)?; // checked, turbines loaded, domain laid out
//! let ready = prepared.ready()?; // pitch responses identified, turbulence made
//! let result = ready.run("baseline")?; // series, planes, summary
//! let powers = result.series.column("T1.GenPwr").ok_or("a channel")?;
//! assert!(powers.last().is_some_and(|power| *power > 1e5)); // W
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | to … | call |
//! | --- | --- |
//! | make a case from text | [`formats::case::parse`] |
//! | run it without files | [`Prepared::of`](study::Prepared::of), [`run_all`](study::Ready::run_all) |
//! | spin up an atmosphere and record its wind | [`study::precursor::precursor`] |
//! | run a case file in a folder | [`study::run`], then [`postprocessing::report`] |
//! | observe it, or stop it | [`study::Observer`], the flag that [`study::run`] takes |
//! | step a farm by hand | [`study::Ready::farm`], [`farm::Farm::advance`] |
//! | take down what you want of each step | [`farm::Recorder`] |
//! | control turbines yourself | [`control::Controller`] |
//! | write an output of your own | [`study::outputs::Output`], [`farm::outputs::OUTPUTS`] |
//! | ask for the wind anywhere | [`flow::WindField::sample`] on [`farm::Farm::flow`] |
//! | load a turbine | [`formats::library::load`] |
//! | make its steady curve | [`turbine::steady::SteadyRotor`] |
//! | count the fatigue of a record | [`analysis::fatigue::damage_equivalent_load`] |
//! | ask records of runs | [`postprocessing::ANALYSES`] |
//!
//! Everything is in SI units and radians; only names with a suffix, such as `amplitude_deg`, are not. x
//! points downwind, y to the left looking downwind, z up; pitch is positive to feather. The same case gives
//! the same bits.

pub use analysis;
pub use basis;
pub use control;
pub use estimation;
pub use farm;
pub use flow;
pub use formats;
pub use postprocessing;
pub use report;
pub use sensing;
pub use study;
pub use turbine;
