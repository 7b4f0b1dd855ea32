//! Writes the reports of made-up studies, to look at: `cargo run -p wakemix-report --example
//! synthetic -- FOLDER`.

#[path = "../tests/synthetic/mod.rs"]
mod synthetic;

use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name a folder")?);
    report::write(&synthetic::two_runs(), &folder.join("two-runs"))?;
    report::write(&synthetic::nine_runs(), &folder.join("nine-runs"))?;
    report::write(&synthetic::layouts::staggered(), &folder.join("staggered"))?;
    report::write(&synthetic::layouts::long_row(), &folder.join("long-row"))?;
    report::write(&synthetic::layouts::without_wakes(), &folder.join("without-wakes"))?;
    Ok(())
}
