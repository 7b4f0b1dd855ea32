//! Validations of the loop that a lidar closes.

use crate::{Cost, Validation, lidar_loop};

pub(super) const LIDAR_LOOP: Validation = Validation {
    name: "lidar-loop",
    about: "a model of a free wake's answer to its helix, a controller for it, and the loop that a lidar closes, beside a published study",
    cost: Cost::Minutes(8),
    run: lidar_loop::lidar_loop,
    pictures: None,
    page: "control-design",
    recorded: include_str!("../../recorded/lidar-loop.toml"),
};
