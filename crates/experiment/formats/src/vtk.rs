//! Volumes, surfaces and lines in VTK's formats for ParaView: XML with the numbers appended raw.

mod filaments;
mod surface;

pub use filaments::{filament_bytes, read_filaments, write_filaments};
pub use surface::write_surface;

use crate::FileError;
use crate::atomic::AtomicFile;
use flow::lattice::Volume;
use std::io::{self, Write};
use std::path::Path;

const WHAT: &str = "a volume of velocities (VTK)";
/// Points that are converted at a time.
const CHUNK: usize = 16 * 1024;

/// Writes `volume` to `path`: point data `velocity` (m/s) and `vorticity` (1/s), three components each in
/// single precision, and its instant (s) as ParaView's time.
///
/// The vorticity is the curl of what is written: by central differences between the volume's points,
/// one-sided at its faces, and without the slopes along an axis that has one point. Vortices thinner than the
/// points' distance are smeared over it.
///
/// # Errors
/// [`FileError::System`].
pub fn write_volume(path: &Path, volume: &Volume) -> Result<(), FileError> {
    let mut file = AtomicFile::create(path, WHAT)?;
    write_to(&mut file, volume).map_err(|source| FileError::system("write", WHAT, path, source))?;
    file.commit()
}

fn write_to(writer: &mut impl Write, volume: &Volume) -> io::Result<()> {
    let [last_x, last_y, last_z] = volume.n_points.map(|count| count.saturating_sub(1));
    let extent = format!("0 {last_x} 0 {last_y} 0 {last_z}");
    let [x, y, z] = volume.origin.to_array();
    let spacing = volume.spacing;
    let n_points = volume.n_points.iter().product::<usize>();
    let n_bytes = n_points as u64 * 3 * size_of::<f32>() as u64;
    let second = size_of::<u64>() as u64 + n_bytes;
    writeln!(
        writer,
        r#"<?xml version="1.0"?>
<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<ImageData WholeExtent="{extent}" Origin="{x} {y} {z}" Spacing="{spacing} {spacing} {spacing}">
<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray></FieldData>
<Piece Extent="{extent}">
<PointData Vectors="velocity">
<DataArray type="Float32" Name="velocity" NumberOfComponents="3" format="appended" offset="0"/>
<DataArray type="Float32" Name="vorticity" NumberOfComponents="3" format="appended" offset="{second}"/>
</PointData>
</Piece>
</ImageData>
<AppendedData encoding="raw">"#,
        volume.time
    )?;
    if volume.velocity.iter().any(|component| component.len() != n_points) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a component lacks points"));
    }
    let velocity = |index: usize| [0, 1, 2].map(|axis| volume.velocity[axis][index]);
    writer.write_all(b"_")?;
    for of_point in [&velocity as &dyn Fn(usize) -> [f32; 3], &|index| vorticity(volume, index)] {
        writer.write_all(&n_bytes.to_le_bytes())?;
        let mut bytes = Vec::with_capacity(CHUNK * 3 * size_of::<f32>());
        for first in (0..n_points).step_by(CHUNK) {
            bytes.clear();
            for index in first..n_points.min(first + CHUNK) {
                bytes.extend(of_point(index).iter().flat_map(|value| value.to_le_bytes()));
            }
            writer.write_all(&bytes)?;
        }
    }
    writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

/// Vorticity (1/s) at point number `index` of `volume`.
fn vorticity(volume: &Volume, index: usize) -> [f32; 3] {
    let [n_x, n_y, _] = volume.n_points;
    let strides = [1, n_x, n_x * n_y];
    let place = [index % n_x, index / n_x % n_y, index / (n_x * n_y)];
    let slope = |component: usize, axis: usize| {
        let before = usize::from(place[axis] > 0);
        let after = usize::from(place[axis] + 1 < volume.n_points[axis]);
        if before + after == 0 {
            return 0.0;
        }
        let at = |index: usize| f64::from(volume.velocity[component][index]);
        let change = at(index + after * strides[axis]) - at(index - before * strides[axis]);
        change / ((before + after) as f64 * volume.spacing)
    };
    let curl = [[2, 1], [0, 2], [1, 0]].map(|[a, b]| slope(a, b) - slope(b, a));
    curl.map(|value| value as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use basis::Vector3;

    #[test]
    fn header_and_numbers_stand_where_vtk_expects_them() {
        let volume = Volume {
            origin: Vector3::new(-720.0, -1.5, 7.5),
            spacing: 30.0,
            n_points: [2, 3, 1],
            time: 12.5,
            velocity: [0.0, 100.0, 200.0].map(|start| (0..6).map(|i| start + i as f32).collect()),
            pressure: None,
        };
        let mut bytes = Vec::new();
        write_to(&mut bytes, &volume).unwrap();
        let mark = br#"<AppendedData encoding="raw">"#;
        let place = bytes.windows(mark.len()).position(|window| window == mark).unwrap();
        let header = std::str::from_utf8(&bytes[..place]).unwrap();
        assert!(
            header
                .contains(r#"WholeExtent="0 1 0 2 0 0" Origin="-720 -1.5 7.5" Spacing="30 30 30""#)
        );
        assert!(header.contains(">12.5</DataArray>"));
        // A line break after the tag, then the underscore.
        let data = &bytes[place + mark.len() + 2..];
        assert_eq!(bytes[place + mark.len() + 1], b'_');
        assert_eq!(data[..8], 72_u64.to_le_bytes());
        let numbers: Vec<f32> = data[8..80]
            .chunks_exact(4)
            .map(|bytes| f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]))
            .collect();
        assert_eq!(numbers[..6], [0.0, 100.0, 200.0, 1.0, 101.0, 201.0]);
        assert!(
            header.contains(
                r#"Name="vorticity" NumberOfComponents="3" format="appended" offset="80""#
            )
        );
        assert_eq!(data[80..88], 72_u64.to_le_bytes());
        assert_eq!(&data[160..], b"\n</AppendedData>\n</VTKFile>\n");
    }

    #[test]
    fn the_vorticity_of_a_linear_field_is_exact_everywhere() {
        // u = A x, whose curl is what A has beside its symmetric part; spacing and slopes are powers of two.
        let slopes = [[0.5, -1.0, 2.0], [4.0, 0.25, -0.5], [1.0, 8.0, -0.75]];
        let n_points = [3, 4, 5];
        let place = |index: usize| [index % 3, index / 3 % 4, index / 12];
        let component = |row: [f64; 3]| {
            let value = |index: usize| {
                let [x, y, z] = place(index).map(|steps| 2.0 * steps as f64);
                (row[0] * x + row[1] * y + row[2] * z) as f32
            };
            (0..60).map(value).collect::<Vec<f32>>()
        };
        let velocity = slopes.map(component);
        let volume = Volume {
            origin: Vector3::ZERO,
            spacing: 2.0,
            n_points,
            time: 0.0,
            velocity,
            pressure: None,
        };
        for index in 0..60 {
            assert_eq!(vorticity(&volume, index), [8.5, 1.0, 5.0], "{index}");
        }
        // A volume that is one point thick along z knows no slopes along it.
        let thin = volume.velocity.map(|values| values[..12].to_vec());
        let thin = Volume { n_points: [3, 4, 1], velocity: thin, ..volume };
        assert_eq!(vorticity(&thin, 5), [8.0, -1.0, 5.0]);
    }
}
