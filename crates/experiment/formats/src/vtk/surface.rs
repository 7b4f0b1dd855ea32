//! Surfaces as VTK polydata (`.vtp`) for ParaView.

use crate::FileError;
use crate::atomic::{self, AtomicFile};
use std::io::{self, Write};
use std::path::Path;

const WHAT: &str = "a surface (VTK)";

/// Writes the triangles whose corners are among `points` (m) to `path`, with `values`, each a name and a
/// number for each point, and the instant `time` (s), where it has one, as ParaView's time. Its folder is
/// made where there is none.
///
/// # Errors
/// [`FileError::System`].
pub fn write_surface(
    path: &Path,
    points: &[[f64; 3]],
    triangles: &[[u32; 3]],
    values: &[(&str, &[f64])],
    time: Option<f64>,
) -> Result<(), FileError> {
    atomic::create_folder(path.parent().unwrap_or(Path::new("")))?;
    let mut file = AtomicFile::create(path, WHAT)?;
    write_to(&mut file, points, triangles, values, time)
        .map_err(|source| FileError::system("write", WHAT, path, source))?;
    file.commit()
}

fn write_to(
    writer: &mut impl Write,
    points: &[[f64; 3]],
    triangles: &[[u32; 3]],
    values: &[(&str, &[f64])],
    time: Option<f64>,
) -> io::Result<()> {
    if values.iter().any(|(_, of)| of.len() != points.len()) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a point lacks a value"));
    }
    let number = |value: f64| (value as f32).to_le_bytes();
    let mut arrays: Vec<(String, Vec<u8>)> = Vec::new();
    for (name, of) in values {
        let tag = format!(r#"<DataArray type="Float32" Name="{name}""#);
        arrays.push((tag, of.iter().flat_map(|value| number(*value)).collect()));
    }
    let tag = r#"<DataArray type="Float32" Name="Points" NumberOfComponents="3""#;
    arrays.push((tag.to_owned(), points.iter().flatten().flat_map(|x| number(*x)).collect()));
    let corners = triangles.iter().flatten().flat_map(|corner| (*corner as i32).to_le_bytes());
    let tag = r#"<DataArray type="Int32" Name="connectivity""#;
    arrays.push((tag.to_owned(), corners.collect()));
    let ends = (1..=triangles.len()).flat_map(|end| (3 * end as i32).to_le_bytes());
    arrays.push((r#"<DataArray type="Int32" Name="offsets""#.to_owned(), ends.collect()));
    writeln!(
        writer,
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>"
    )?;
    if let Some(time) = time {
        writeln!(
            writer,
            r#"<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{time}</DataArray></FieldData>"#
        )?;
    }
    writeln!(
        writer,
        r#"<Piece NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{}">"#,
        points.len(),
        triangles.len()
    )?;
    let mut offset = 0;
    for (place, (tag, bytes)) in arrays.iter().enumerate() {
        // Values of points first, then points, then triangles.
        match place.checked_sub(values.len()) {
            None if place == 0 => writeln!(writer, "<PointData>")?,
            Some(0) if values.is_empty() => writeln!(writer, "<Points>")?,
            Some(0) => writeln!(writer, "</PointData>\n<Points>")?,
            Some(1) => writeln!(writer, "</Points>\n<Polys>")?,
            _ => {}
        }
        writeln!(writer, r#"{tag} format="appended" offset="{offset}"/>"#)?;
        offset += size_of::<u64>() + bytes.len();
    }
    writeln!(writer, "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">")?;
    writer.write_all(b"_")?;
    for (_, bytes) in &arrays {
        writer.write_all(&(bytes.len() as u64).to_le_bytes())?;
        writer.write_all(bytes)?;
    }
    writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_where_the_head_says() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
        let triangles = [[0, 1, 2], [0, 2, 3]];
        let u = [1.0, 2.0, 3.0, 4.0];
        let mut bytes = Vec::new();
        write_to(&mut bytes, &points, &triangles, &[("u", &u)], Some(1.5)).unwrap();
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let place = bytes.windows(mark.len()).position(|window| window == mark).unwrap();
        let head = std::str::from_utf8(&bytes[..place]).unwrap();
        assert!(head.contains(r#"NumberOfPoints="4""#) && head.contains(r#"NumberOfPolys="2""#));
        assert!(
            head.contains(r#"Name="Points" NumberOfComponents="3" format="appended" offset="24""#)
        );
        let data = &bytes[place + mark.len()..];
        assert_eq!(data[..8], 16_u64.to_le_bytes());
        assert_eq!(data[24..32], 48_u64.to_le_bytes());
        // The last number of the points, then 6 corners of 4 bytes.
        assert_eq!(data[76..80], 2.0_f32.to_le_bytes());
        assert_eq!(data[80..88], 24_u64.to_le_bytes());
        assert_eq!(data[108..112], 3_i32.to_le_bytes());
        assert_eq!(data[120..128], [3, 0, 0, 0, 6, 0, 0, 0]);
        let short = write_to(&mut Vec::new(), &points, &triangles, &[("u", &u[1..])], None);
        assert!(short.is_err());
    }
}
