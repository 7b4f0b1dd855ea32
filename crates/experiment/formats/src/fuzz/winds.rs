//! Turbulence boxes, read whole and plane by plane.

use super::{Refusal, survives};
use crate::turbulence_box::{self, tests::stored};
use std::fs;
use std::path::Path;

/// The box as its files, of which `name` is the one that names it.
fn files(name: &'static str, others: &[&'static str]) -> Vec<(&'static str, Vec<u8>)> {
    let folder = tempfile::tempdir().unwrap();
    turbulence_box::write(&folder.path().join(name), &stored([4, 3, 2])).unwrap();
    let read = |name: &&'static str| (*name, fs::read(folder.path().join(name)).unwrap());
    [name].iter().chain(others).map(read).collect()
}

fn read(path: &Path) -> Result<(), Refusal> {
    turbulence_box::read(path)?;
    let mut planes = turbulence_box::open(path)?;
    let grid = planes.grid();
    grid.check().expect("a box that was opened has a sound grid");
    let mut values = vec![[0.0; 3]; grid.n_y * grid.n_z];
    for step in 0..grid.n_steps {
        planes.read(step, &mut values).expect("a box that was read whole gives its planes");
    }
    Ok(())
}

#[test]
fn turbsim_fields() {
    survives(files("box.bts", &[]), |folder| read(&folder.join("box.bts")));
}

#[test]
fn bladed_fields() {
    survives(files("box.wnd", &["box.sum"]), |folder| read(&folder.join("box.wnd")));
}

/// The header of 16-bit integers, whose intensities the summary gives.
#[test]
fn old_bladed_fields() {
    let shorts: [i16; 19] =
        [-3, 9000, 7000, 2500, 2, 100, 0, 0, 0, 0, 0, 2000, 3000, 0, 0, 0, 0, 0, 0];
    let values = (0..72_i16).map(|value| 100 * value);
    let header = shorts.into_iter().chain(values).flat_map(i16::to_le_bytes).collect();
    let [_, (name, summary)] = <[_; 2]>::try_from(files("box.wnd", &["box.sum"])).unwrap();
    let files = vec![("box.wnd", header), (name, summary)];
    survives(files, |folder| read(&folder.join("box.wnd")));
}

#[test]
fn hawc_boxes() {
    let binaries = ["box_u.bin", "box_v.bin", "box_w.bin"];
    survives(files("box.toml", &binaries), |folder| read(&folder.join("box_v.bin")));
}

#[test]
fn tables_of_wind() {
    let rows = |path: &Path| Ok(crate::wind_table::read(path).map(drop)?);
    let openfast =
        b"! uniform wind\n0.0 9.0 0 0 0 0.1 0 0\n10.5 12.0 -30 1 0.1 0.2 -0.1 2\n".to_vec();
    survives(vec![("u.wnd", openfast)], |folder| rows(&folder.join("u.wnd")));
    let csv = b"time_s,speed_m_s,gust_m_s\n0,9,0\n10.5,12,2\n".to_vec();
    survives(vec![("u.csv", csv)], |folder| rows(&folder.join("u.csv")));
}
