//! The group `controller` of a turbine file as text.

use super::document::{Controller, TowerDamping};
use super::text::{Text, number, numbers, quoted};

pub(super) fn controller(out: &mut Text, controller: &Controller) {
    out.text("source", &controller.source);
    out.line("# Low-speed side; gains act on measured minus reference rotor speed (rad/s).");
    out.number("rated_power_kw", controller.rated_power_kw, "electrical");
    out.number("rated_rotor_speed_rpm", controller.rated_rotor_speed_rpm, "");
    out.number("minimum_rotor_speed_rpm", controller.minimum_rotor_speed_rpm, "");
    out.number("optimal_tip_speed_ratio", controller.optimal_tip_speed_ratio, "");
    out.number(
        "torque_gain",
        controller.torque_gain,
        "torque over rotor speed squared below rated, N m s^2",
    );
    out.number("rated_torque", controller.rated_torque, "");
    out.number("minimum_torque", controller.minimum_torque, "");
    out.number("maximum_torque", controller.maximum_torque, "");
    out.number("maximum_torque_rate", controller.maximum_torque_rate, "N m/s");
    out.line(&format!("constant_power = {}  # above rated", controller.constant_power));
    out.number("torque_proportional", controller.torque_proportional, "N m s");
    out.number("torque_integral", controller.torque_integral, "N m");
    out.number("fine_pitch_deg", controller.fine_pitch_deg, "");
    out.number("maximum_pitch_deg", controller.maximum_pitch_deg, "");
    out.number("maximum_pitch_rate_deg_s", controller.maximum_pitch_rate_deg_s, "");
    out.number("speed_filter_corner", controller.speed_filter_corner, "rad/s");
    optional(out, controller);
    let smoothing = &controller.set_point_smoothing;
    let shifts = [smoothing.torque_shift, smoothing.pitch_shift, smoothing.filter_corner];
    let [torque, pitch, corner] =
        shifts.map(|value| if value.is_finite() { number(value) } else { "?".to_owned() });
    let text =
        format!("{{ torque_shift = {torque}, pitch_shift = {pitch}, filter_corner = {corner} }}");
    if shifts.iter().all(|value| value.is_finite()) {
        out.line(&format!("set_point_smoothing = {text}"));
    } else {
        out.missing("set_point_smoothing", &text);
    }
    let rows = controller.minimum_pitch.iter().map(numbers);
    out.table("minimum_pitch", &["wind_speed", "pitch_deg"], rows);
    let columns = ["pitch_deg", "proportional_s", "integral"];
    out.table("pitch_gains", &columns, controller.pitch_gains.iter().map(numbers));
}

/// The keys that a controller can do without.
fn optional(out: &mut Text, controller: &Controller) {
    if let Some(damping) = controller.speed_filter_damping {
        out.number("speed_filter_damping", damping, "of second order");
    }
    if let Some(kind) = controller.torque_control {
        out.text("torque_control", kind.name());
    }
    if let Some(corner) = controller.wind_speed_filter_corner {
        out.number("wind_speed_filter_corner", corner, "rad/s");
    }
    if let Some(TowerDamping { gain, high_pass_corner, limit_deg }) = &controller.tower_damping {
        let [gain, corner, limit] = [gain, high_pass_corner, limit_deg].map(|value| number(*value));
        out.line(&format!(
            "tower_damping = {{ gain = {gain}, high_pass_corner = {corner}, limit_deg = {limit} }}"
        ));
    }
    if let Some(individual) = &controller.individual_pitch {
        let figures = [
            individual.proportional,
            individual.integral,
            individual.limit_deg,
            individual.ramp[0],
            individual.ramp[1],
        ];
        let [proportional, integral, limit, start, full] = figures.map(number);
        let offset = individual.azimuth_offset_deg.map(number);
        let offset =
            offset.map_or_else(String::new, |offset| format!("azimuth_offset_deg = {offset}, "));
        let floor = quoted(individual.floor.name());
        out.line(&format!(
            "individual_pitch = {{ proportional = {proportional}, integral = {integral}, {offset}limit_deg = {limit}, ramp = [{start}, {full}], floor = {floor} }}"
        ));
    }
    if !controller.speed_notches.is_empty() {
        let columns = ["frequency", "numerator_damping", "denominator_damping"];
        out.table("speed_notches", &columns, controller.speed_notches.iter().map(numbers));
    }
}
