//! The page of any layout, and of wind without wakes; how the page is laid out.

use crate::synthetic::layouts;
use crate::{assert_well_formed, page, synthetic};
use basis::Sense;
use basis::records::ControlSummary;

/// The drawing called `name` on `page`.
fn drawing<'a>(page: &'a str, name: &str) -> &'a str {
    let start = page.find(&format!("<figure id=\"{name}\"")).unwrap_or_else(|| panic!("no {name}"));
    let end = page[start..].find("</figure>").expect("it ends");
    &page[start..start + end]
}

#[test]
fn a_staggered_row_has_planes_through_each_line_of_rotors_with_their_names() {
    let page = page(&layouts::staggered());
    assert_well_formed(&page);
    let side = drawing(&page, "mean-streamwise");
    for line in ["through T1 and T4", "through T3", "through T2 and T5"] {
        for run in ["baseline", "helix-ccw"] {
            let title = format!(">{run}, {line}</text>");
            assert_eq!(side.matches(&title).count(), 1, "`{title}`");
        }
    }
    let above = drawing(&page, "mean-hub-height");
    let profiles = drawing(&page, "profiles");
    for turbine in ["T1", "T2", "T3", "T4", "T5"] {
        // Once in each run.
        assert_eq!(above.matches(&format!(">{turbine}</text>")).count(), 2, "{turbine}");
    }
    assert!(profiles.contains(">T2</text>") && profiles.contains(">T3</text>"));
    let recovery = drawing(&page, "recovery");
    assert!(recovery.contains(">through T2 and T5: on the axis</text>"));
    for words in ["3 × iea-15mw, 2 × nrel-5mw", "D = 240.0 m of T1, others 126.0 m"] {
        assert!(page.contains(words), "`{words}` is missing");
    }
}

#[test]
fn a_long_row_is_told_in_few_words_and_its_fields_say_that_they_are_stretched() {
    let page = page(&layouts::long_row());
    assert_well_formed(&page);
    for words in [
        "cost T1 2.0 %, T6 2.0 % and T11 2.0 % of their power and gave twelve turbines 3.0 % to 11.0 % more: \
         +5.3 % ± 1.2 % for the 15 together.",
        "<thead><tr><th>Run</th><th class=\"n\">All</th></tr></thead>",
        "Heights on the sheet are stretched 2.1 times.",
        "spacing 5.0 D ·",
    ] {
        assert!(page.contains(words), "`{words}` is missing");
    }
    assert!(drawing(&page, "mean-crosswind").contains(">T1, T2</text>"));
}

#[test]
fn an_interval_that_leaves_its_axes_has_an_arrow_with_its_number() {
    let study = layouts::staggered();
    let power = study.runs[0].summary.turbines[2].power;
    let end = (power.mean + power.half_width_95.expect("an interval")) / 1e6;
    let page = page(&study);
    let power = drawing(&page, "power");
    assert!(power.contains(&format!(">{end:.2}</text>")), "no arrow says {end:.2}");
    // The others' axes are made for their own intervals.
    let gains = drawing(&page, "gains");
    assert!(!gains.contains(">100</text>") && gains.contains("+6.0 % ± 130.0 %"));
}

#[test]
fn in_wind_without_wakes_nothing_is_added_up() {
    let mut study = layouts::without_wakes();
    let told = page(&study);
    for words in [
        "A counter-clockwise helix of 4.0° on T1 cost T1 2.1 % ± 0.4 % of its power and gave T2 14.2 % ± 2.1 % more.",
        "flow solver uniform, no wakes",
    ] {
        assert!(told.contains(words), "`{words}` is missing");
    }
    let body = |page: &str| page.split("<script").next().expect("a body").to_owned();
    for absent in ["together", ">All<", "cells per diameter"] {
        assert!(!body(&told).contains(absent), "`{absent}` is on the page");
    }
    study.runs.truncate(1);
    assert!(page(&study).contains("T1 made 9.10 ± 0.18 MW and T2 made 4.30 ± 0.17 MW in the run"));
    // An older record does not name its solver.
    study.runs[0].summary.flow = None;
    let older = page(&study);
    assert!(older.contains("prescribed wind, no wakes") && !body(&older).contains("together"));
}

#[test]
fn a_pitch_of_a_kind_of_its_own_is_called_by_that_kind() {
    let mut study = synthetic::two_runs();
    for sense in [None, Some(Sense::Clockwise)] {
        let control = &mut study.runs[1].summary.turbines[0].control;
        let excitation =
            control.excitation.map(|set| basis::records::PitchExcitation { sense, ..set });
        *control = ControlSummary { excitation, ..ControlSummary::plain("wobble", "wobbling") };
        let page = page(&study);
        for words in [
            "A periodic pitch of 4.0° under “wobble” on T1 cost T1",
            "wobble on T1, 4.0° target",
            "<td>wobbling</td>",
        ] {
            assert!(page.contains(words), "`{words}` is missing");
        }
        assert!(!page.contains("ulse of 4.0°") && !page.contains("elix of 4.0°"));
    }
}

#[test]
fn the_page_leads_with_pictures_and_a_short_table_and_folds_the_rest() {
    let page = page(&synthetic::two_runs());
    let at = |what: &str| page.find(what).unwrap_or_else(|| panic!("`{what}` is missing"));
    let order = [
        "class=\"headline\"",
        "class=\"contents\"",
        "<table class=\"glance\"",
        "<figure id=\"mean-hub-height\"",
        "<figure id=\"gains\"",
        "<h2>Power</h2>",
        "<h2>Conditions</h2>",
        "<table class=\"results\"",
        "<h2>Case file</h2>",
    ];
    assert!(order.windows(2).all(|pair| at(pair[0]) < at(pair[1])));
    let before = &page[..at("<table class=\"results\"")];
    let opened = before.matches("<details").count() - before.matches("</details>").count();
    assert_eq!(opened, 1, "the long table is not folded away");
    assert!(
        page.contains("<td class=\"n\">13.8 MW<small class=\"good\">+5.3 % ± 1.2 %</small></td>")
    );
    // Every entry of the contents leads somewhere.
    let links: Vec<&str> =
        page.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert!(links.len() > 8, "{links:?}");
    for link in links {
        assert_eq!(page.matches(&format!(" id=\"{link}\"")).count(), 1, "{link}");
    }
}

#[test]
fn the_page_may_not_reach_a_network_and_names_the_licences_of_what_it_holds() {
    let page = page(&synthetic::two_runs());
    assert!(page.contains("content=\"default-src 'none'; img-src data:;"));
    for words in ["d3-zoom 3.0.0 (ISC)", "d3-ease 3.0.2 (BSD-3-Clause)", "Permission to use, copy"]
    {
        assert!(page.contains(words), "`{words}` is missing");
    }
    // What is enlarged and read is marked for the script.
    for name in ["mean-hub-height", "power", "profiles", "gains", "mean-crosswind", "pitch"] {
        let drawing = drawing(&page, name);
        assert!(drawing.contains("data-panel=") && drawing.contains("data-ticks=\"x\""), "{name}");
    }
}
