//! Volumes as VTK image data (`.vti`) for ParaView: XML with the numbers appended raw.

use crate::FileError;
use crate::atomic::AtomicFile;
use flow::lattice::Volume;
use std::io::{self, Write};
use std::path::Path;

const WHAT: &str = "a volume of velocities (VTK)";
/// Points that are converted at a time.
const CHUNK: usize = 16 * 1024;

/// Writes `volume` to `path`: point data `velocity` (m/s, three components, single precision), and its
/// instant (s) as ParaView's time.
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
    writeln!(
        writer,
        r#"<?xml version="1.0"?>
<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<ImageData WholeExtent="{extent}" Origin="{x} {y} {z}" Spacing="{spacing} {spacing} {spacing}">
<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray></FieldData>
<Piece Extent="{extent}">
<PointData Vectors="velocity"><DataArray type="Float32" Name="velocity" NumberOfComponents="3" format="appended" offset="0"/></PointData>
</Piece>
</ImageData>
<AppendedData encoding="raw">"#,
        volume.time
    )?;
    let [u, v, w] = &volume.velocity;
    let n_points = volume.n_points.iter().product::<usize>();
    if [u, v, w].iter().any(|component| component.len() != n_points) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a component lacks points"));
    }
    writer.write_all(b"_")?;
    writer.write_all(&(n_points as u64 * 3 * size_of::<f32>() as u64).to_le_bytes())?;
    let mut bytes = Vec::with_capacity(CHUNK * 3 * size_of::<f32>());
    for ((u, v), w) in u.chunks(CHUNK).zip(v.chunks(CHUNK)).zip(w.chunks(CHUNK)) {
        bytes.clear();
        for ((u, v), w) in u.iter().zip(v).zip(w) {
            for value in [u, v, w] {
                bytes.extend_from_slice(&value.to_le_bytes());
            }
        }
        writer.write_all(&bytes)?;
    }
    writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")
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
        assert_eq!(&data[80..], b"\n</AppendedData>\n</VTKFile>\n");
    }
}
