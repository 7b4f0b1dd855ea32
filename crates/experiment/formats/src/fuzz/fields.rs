//! Fields and particles of other programs.

use super::survives;
use crate::fields::{FieldFile, Lengths};
use crate::netcdf::{InstantWriter, PlaneSetting};
use crate::tracks::each_particle;
use basis::Vector3;
use basis::records::{Plane, PlaneAxes};
use flow::lattice::Volume;
use netcdf_writer::{NcAttrValue, NcFileBuilder, NcWriteOptions};
use std::fs;
use std::path::Path;

fn read_all(path: &Path) -> Result<(), super::Refusal> {
    let mut file = FieldFile::open(path, Lengths::Metres)?;
    let mut field = file.empty();
    for index in 0..file.times().len().min(50) {
        file.read(index, &mut field)?;
    }
    Ok(())
}

#[test]
fn fields_in_netcdf() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.nc");
    let plane = Plane {
        name: "small".into(),
        axes: PlaneAxes::Horizontal,
        origin: [0.0, 0.0, 150.0],
        spacing: [15.0, 15.0],
        n_points: [2, 3],
        time: 1500.0,
        averaged: 0.0,
        velocity: [vec![9.0; 6], vec![0.0; 6], vec![0.1; 6]],
    };
    let mut writer = InstantWriter::create(&path, &PlaneSetting::example(), &plane).unwrap();
    writer.write(&plane).unwrap();
    writer.write(&Plane { time: 1501.0, ..plane }).unwrap();
    writer.finish().unwrap();
    let files = vec![("fields.nc", fs::read(path).unwrap())];
    survives(files, |folder| read_all(&folder.join("fields.nc")));
}

#[test]
fn fields_in_vtk() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("fields.vti");
    let volume = Volume {
        origin: Vector3::new(1.0, -1.0, 0.5),
        spacing: 0.25,
        n_points: [3, 2, 2],
        time: 4.0,
        velocity: [0.0, 100.0, 200.0].map(|add| (0..12).map(|i| add + i as f32).collect()),
        pressure: None,
    };
    crate::vtk::write_volume(&path, &volume).unwrap();
    let text = r#"<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 0 0 0" Origin="0 0 0" Spacing="1 1 1"><DataArray Name="velocity" NumberOfComponents="3" format="ascii">1 2 3 4 5 6</DataArray>"#;
    let files = vec![("fields.vti", fs::read(path).unwrap()), ("text.vti", text.into())];
    survives(files, |folder| {
        read_all(&folder.join("fields.vti"))?;
        read_all(&folder.join("text.vti"))
    });
}

const POINTS: &str = "TITLE = \"a\"\nVARIABLES = \"x [mm]\", \"y [mm]\", \"z [mm]\", \"u\", \"v\", \"w\"\nZONE T=\"1\", I=2, J=2, F=POINT, SOLUTIONTIME=1\n0 0 5 1 2 3\n10 0 5 4 5 6\n0 20 5 7 8 9\n10 20 5 1 1 1\n";
const BLOCK: &str =
    "VARIABLES = x y z u v w\nZONE I=2, DATAPACKING=BLOCK\n0 10\n0 0\n5 5\n1 4\n2 5\n3 6\n";

#[test]
fn fields_in_tecplot() {
    let files = vec![("points.dat", POINTS.into()), ("block.dat", BLOCK.into())];
    survives(files, |folder| {
        read_all(&folder.join("points.dat"))?;
        read_all(&folder.join("block.dat"))
    });
}

/// Particles in NetCDF, two of them.
fn particles() -> Vec<u8> {
    let mut file = NcFileBuilder::new();
    let over = file.add_dimension("particle", 2).unwrap();
    for name in ["time", "x", "y", "z", "u", "v", "w"] {
        let variable = file.add_variable::<f64>(name, &[over]).unwrap();
        if name == "x" || name == "y" || name == "z" {
            let unit = NcAttrValue::Chars("mm".to_owned());
            file.add_variable_attribute(variable, "units", unit).unwrap();
        }
        file.write_variable(variable, &[0.5, 1.5]).unwrap();
    }
    file.to_vec(NcWriteOptions::default()).unwrap().1
}

#[test]
fn particles_on_their_way() {
    let csv =
        "time [s],x [mm],y [mm],z [mm],u [m/s],v [m/s],w [m/s]\n0.5,1,2,3,5,0,0\n0.6,1,2,3,5,0,0\n";
    let files =
        vec![("tracks.csv", csv.into()), ("tracks.dat", POINTS.into()), ("tracks.nc", particles())];
    survives(files, |folder| {
        for name in ["tracks.csv", "tracks.dat", "tracks.nc"] {
            let seen = each_particle(&folder.join(name), Lengths::Metres, |_| ())?;
            assert!(seen.n < 1 << 20);
        }
        Ok(())
    });
}
