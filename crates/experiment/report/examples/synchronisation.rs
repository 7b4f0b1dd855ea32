//! Draws a made-up phase synchronisation, to look at:
//! `cargo run -p wakemix-report --example synchronisation -- FOLDER`.

#[path = "../tests/synchronised/mod.rs"]
mod synchronised;

use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("name a folder")?);
    for name in report::write_synchronisation(&synchronised::all(), &folder)? {
        println!("{}", folder.join("figures").join(name).display());
    }
    Ok(())
}
