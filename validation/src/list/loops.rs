//! Validations of the loop that a lidar closes, and of how long its desk work takes.

use crate::{
    Cost, Validation, control_times, lidar_family, lidar_loop, lidar_table, phase_estimator,
};

pub(super) const TIMES: Validation = Validation {
    name: "control-times",
    about: "wall time of an identification, of a synthesis, and of an instant of the lidar loop",
    cost: Cost::Minutes(1),
    run: control_times::control_times,
    pictures: None,
    page: "control-design",
    recorded: include_str!("../../recorded/control-times.toml"),
};

pub(super) const LIDAR_LOOP: Validation = Validation {
    name: "lidar-loop",
    about: "a model of a free wake's answer to its helix, a controller for it, and the loop that a lidar closes, beside a published study",
    cost: Cost::Minutes(8),
    run: lidar_loop::lidar_loop,
    pictures: None,
    page: "control-design",
    recorded: include_str!("../../recorded/lidar-loop.toml"),
};

pub(super) const LIDAR_LATTICE: Validation = Validation {
    name: "lidar-lattice",
    about: "the lidar's loop in resolved flow: a law of its own record, power and blade loads of two turbines in four winds by the closed over the open loop, beside a published table",
    cost: Cost::Minutes(55),
    run: lidar_table::lidar_lattice,
    pictures: None,
    page: "control-design",
    recorded: include_str!("../../recorded/lidar-lattice.toml"),
};

pub(super) const LIDAR_TABLE: Validation = Validation {
    name: "lidar-table",
    about: "power and blade loads of two turbines with free-vortex wakes in four winds, by the lidar's closed over the open loop, beside a published table",
    cost: Cost::Minutes(180),
    run: lidar_table::lidar_table,
    pictures: None,
    page: "control-design",
    recorded: include_str!("../../recorded/lidar-table.toml"),
};

pub(super) const LIDAR_FAMILY: Validation = Validation {
    name: "lidar-family",
    about: "laws of the lidar's loop made at three wind speeds, in a wind that rises from the first to the last: what they hold, beside one law alone",
    cost: Cost::Minutes(15),
    run: lidar_family::lidar_family,
    pictures: None,
    page: "control-design",
    recorded: include_str!("../../recorded/lidar-family.toml"),
};

pub(super) const PHASE_PREVIEW: Validation = Validation {
    name: "phase-preview",
    about: "the helix's phase at the second of two turbines in resolved flow, by blade loads and through a lidar that looks upwind",
    cost: Cost::Minutes(15),
    run: phase_estimator::phase_preview,
    pictures: None,
    page: "phase-estimator",
    recorded: include_str!("../../recorded/phase-preview.toml"),
};
