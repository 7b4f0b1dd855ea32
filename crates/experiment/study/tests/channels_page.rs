//! The page of channels names every channel that the program declares, with its unit.

use basis::Channel;
use basis::channels::{
    BLADE_LOADS, LINES, LOOP_WIND, OPERATION, OPERATION_OF_BLADES, PREVIEW_LAG, PREVIEW_SHARE,
    PREVIEW_TIME, TIME, TURBINE_LOADS, WIND, of_lidar_loop, of_meandering, of_phase_sync,
    span_moment,
};

#[test]
fn the_page_names_every_channel_with_its_unit() {
    let page = include_str!("../../../../docs/reference/channels.md");
    let of_blade = OPERATION_OF_BLADES.iter().chain(&BLADE_LOADS).map(|stem| stem.of_blade(1));
    let declared: Vec<Channel> = std::iter::once(TIME)
        .chain(WIND)
        .chain(OPERATION)
        .chain(of_blade)
        .chain(TURBINE_LOADS)
        .chain(['x', 'y'].map(|axis| span_moment(1, axis, 1)))
        .chain(of_phase_sync())
        .chain(of_meandering())
        .chain(of_lidar_loop())
        .chain([LOOP_WIND, PREVIEW_SHARE, PREVIEW_TIME, PREVIEW_LAG])
        .chain(LINES)
        .collect();
    for Channel { name, unit } in declared {
        let is_row = |line: &&str| {
            let mut cells = line.split('|').skip(1).map(str::trim);
            let names = cells.next().unwrap_or_default();
            let named = names.split(", ").any(|cell| cell == format!("`{name}`"));
            named && cells.next() == Some(unit.symbol())
        };
        assert_eq!(page.lines().filter(is_row).count(), 1, "{name} in {}", unit.symbol());
    }
}
