//! Validations of the loop that a lidar closes, and of how long its desk work takes.

use crate::{Cost, Validation, control_times, lidar_loop};

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
