//! Vortices of wakes as VTK polydata (`.vtp`) for ParaView, written, and read back from the program's own
//! files.

use crate::FileError;
use crate::atomic::AtomicFile;
use basis::records::{Filaments, Piece, PieceKind};
use std::fs;
use std::io::{self, Write};
use std::path::Path;

const WHAT: &str = "vortices of wakes (VTK)";
/// What stands before the numbers, each of which counts its bytes.
const MARK: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
/// Bytes of a count before the numbers of an array.
const COUNT: usize = size_of::<u64>();

/// Numbers of four bytes; a node has three, a piece two or one.
const WIDTH: usize = 4;
/// Arrays of the file in their order: name, VTK's type, components, bytes of a component. The first is of the
/// nodes, the others of the pieces.
const ARRAYS: [(&str, &str, usize, usize); 10] = [
    ("Points", "Float32", 3, WIDTH),
    ("connectivity", "Int32", 2, WIDTH),
    ("offsets", "Int32", 1, WIDTH),
    ("circulation", "Float32", 1, WIDTH),
    ("core_radius", "Float32", 1, WIDTH),
    ("age", "Float32", 1, WIDTH),
    ("span", "Float32", 1, WIDTH),
    ("turbine", "Int32", 1, WIDTH),
    ("blade", "Int32", 1, WIDTH),
    ("kind", "UInt8", 1, 1),
];

/// Bytes of a node in the file, and of a piece.
pub fn filament_bytes() -> [u64; 2] {
    let of = |arrays: &[(&str, &str, usize, usize)]| {
        arrays.iter().map(|(_, _, n, width)| (n * width) as u64).sum()
    };
    [of(&ARRAYS[..1]), of(&ARRAYS[1..])]
}

/// Writes `filaments` to `path`: each piece a line with `circulation` (m²/s), `core_radius` (m), `age` (s),
/// `span` (distance from the blade's root over its length, –), `turbine` and `blade` (from 1) and `kind` (0
/// trailing, 1 shed, 2 bound), and the instant (s) as ParaView's time.
///
/// # Errors
/// [`FileError::System`].
pub fn write_filaments(path: &Path, filaments: &Filaments) -> Result<(), FileError> {
    let mut file = AtomicFile::create(path, WHAT)?;
    write_to(&mut file, filaments)
        .map_err(|source| FileError::system("write", WHAT, path, source))?;
    file.commit()
}

fn write_to(writer: &mut impl Write, filaments: &Filaments) -> io::Result<()> {
    let counts = [filaments.nodes.len(), filaments.pieces.len()];
    writeln!(
        writer,
        r#"<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PolyData>
<FieldData><DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{}</DataArray></FieldData>
<Piece NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="{}" NumberOfStrips="0" NumberOfPolys="0">"#,
        filaments.time, counts[0], counts[1]
    )?;
    let mut offset = 0;
    for (index, (name, kind, n, width)) in ARRAYS.into_iter().enumerate() {
        match index {
            0 => writeln!(writer, "<Points>")?,
            1 => writeln!(writer, "</Points>\n<Lines>")?,
            3 => writeln!(writer, "</Lines>\n<CellData Scalars=\"circulation\">")?,
            _ => {}
        }
        // Points have three components by their nature; ends of lines are a list without any.
        let components = if index == 0 { " NumberOfComponents=\"3\"" } else { "" };
        writeln!(
            writer,
            r#"<DataArray type="{kind}" Name="{name}"{components} format="appended" offset="{offset}"/>"#
        )?;
        offset += COUNT + counts[index.min(1)] * n * width;
    }
    writeln!(writer, "</CellData>\n</Piece>\n</PolyData>")?;
    writer.write_all(MARK)?;
    let mut bytes = Vec::new();
    for index in 0..ARRAYS.len() {
        bytes.clear();
        put(index, filaments, &mut bytes);
        writer.write_all(&(bytes.len() as u64).to_le_bytes())?;
        writer.write_all(&bytes)?;
    }
    writer.write_all(b"\n</AppendedData>\n</VTKFile>\n")
}

/// Adds the numbers of array number `index` to `bytes`.
fn put(index: usize, filaments: &Filaments, bytes: &mut Vec<u8>) {
    if index == 0 {
        let values = filaments.nodes.iter().flatten();
        return bytes.extend(values.flat_map(|value| value.to_le_bytes()));
    }
    for (place, piece) in filaments.pieces.iter().enumerate() {
        match index {
            1 => bytes.extend(piece.ends.iter().flat_map(|end| end.to_le_bytes())),
            2 => bytes.extend((2 * (place as u32 + 1)).to_le_bytes()),
            3 => bytes.extend(piece.circulation.to_le_bytes()),
            4 => bytes.extend(piece.core_radius.to_le_bytes()),
            5 => bytes.extend(piece.age.to_le_bytes()),
            6 => bytes.extend(piece.span.to_le_bytes()),
            7 => bytes.extend((piece.turbine + 1).to_le_bytes()),
            8 => bytes.extend((piece.blade + 1).to_le_bytes()),
            _ => bytes.push(piece.kind.number()),
        }
    }
}

/// Reads what [`write_filaments`] wrote to `path`.
///
/// # Errors
/// [`FileError::System`], and [`FileError::Content`] when it is something else.
pub fn read_filaments(path: &Path) -> Result<Filaments, FileError> {
    let bytes = fs::read(path).map_err(|source| FileError::system("read", WHAT, path, source))?;
    parsed(&bytes).map_err(|problem| {
        let fix = "make the run again, or take the file away: the report is then made without it";
        FileError::content(WHAT, path, problem, fix)
    })
}

fn parsed(bytes: &[u8]) -> Result<Filaments, String> {
    let place = bytes.windows(MARK.len()).position(|window| window == MARK);
    let place = place.ok_or("it has no appended numbers")?;
    let header = std::str::from_utf8(&bytes[..place]).map_err(|error| error.to_string())?;
    let between = |before: &str, after: &str| {
        let (_, rest) = header.split_once(before)?;
        Some(rest.split_once(after)?.0)
    };
    let count = |name: &str| {
        let text = between(&format!("{name}=\""), "\"").ok_or(format!("{name} is missing"))?;
        text.parse::<usize>().map_err(|_| format!("{name} is \"{text}\""))
    };
    let counts = [count("NumberOfPoints")?, count("NumberOfLines")?];
    let time = between("NumberOfTuples=\"1\" format=\"ascii\">", "<").unwrap_or_default();
    let time = time.parse::<f64>().ok().filter(|time| time.is_finite());
    let mut rest = &bytes[place + MARK.len()..];
    let mut arrays = Vec::with_capacity(ARRAYS.len());
    for (index, (name, _, n, width)) in ARRAYS.into_iter().enumerate() {
        let expected = counts[index.min(1)].checked_mul(n * width);
        let length = rest.split_first_chunk::<COUNT>().map(|(count, after)| {
            rest = after;
            u64::from_le_bytes(*count)
        });
        let array = expected.filter(|&expected| length == Some(expected as u64));
        let array = array.and_then(|expected| rest.split_at_checked(expected));
        let (array, after) = array.ok_or(format!("{name} has another length than it should"))?;
        arrays.push(array);
        rest = after;
    }
    let time = time.ok_or("TimeValue is no number")?;
    Ok(Filaments { time, nodes: nodes(arrays[0])?, pieces: pieces(&arrays, counts[0])? })
}

/// The number of four bytes at place `index` of `array`.
fn word(array: &[u8], index: usize) -> [u8; WIDTH] {
    std::array::from_fn(|byte| array[WIDTH * index + byte])
}

fn finite(array: &[u8], index: usize) -> Result<f32, String> {
    let value = f32::from_le_bytes(word(array, index));
    if value.is_finite() { Ok(value) } else { Err("it holds a number that is not finite".into()) }
}

fn nodes(array: &[u8]) -> Result<Vec<[f32; 3]>, String> {
    let node = |index: usize| {
        let value = |axis: usize| finite(array, 3 * index + axis);
        Ok([value(0)?, value(1)?, value(2)?])
    };
    (0..array.len() / (3 * WIDTH)).map(node).collect()
}

/// The pieces in `arrays`, between `n_nodes` nodes.
fn pieces(arrays: &[&[u8]], n_nodes: usize) -> Result<Vec<Piece>, String> {
    let piece = |index: usize| {
        let whole = |array: usize, place: usize| u32::from_le_bytes(word(arrays[array], place));
        let ends = [whole(1, 2 * index), whole(1, 2 * index + 1)];
        let kind = PieceKind::ALL.get(usize::from(arrays[9][index]));
        let from_one = [whole(7, index), whole(8, index)].map(|place| place.checked_sub(1));
        match (kind, from_one) {
            (Some(&kind), [Some(turbine), Some(blade)])
                if ends.iter().all(|&end| (end as usize) < n_nodes) =>
            {
                Ok(Piece {
                    ends,
                    kind,
                    turbine,
                    blade,
                    span: finite(arrays[6], index)?,
                    age: finite(arrays[5], index)?,
                    circulation: finite(arrays[3], index)?,
                    core_radius: finite(arrays[4], index)?,
                })
            }
            _ => Err(format!("line {index} is none of a wake")),
        }
    };
    (0..arrays[9].len()).map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filaments() -> Filaments {
        let piece = |k: u32| Piece {
            ends: [k, k + 1],
            kind: PieceKind::ALL[k as usize % 3],
            turbine: k / 2,
            blade: k % 2,
            span: 0.25 * k as f32,
            age: 1.5 * k as f32,
            circulation: -30.0 + k as f32,
            core_radius: 0.5,
        };
        let nodes = (0..4).map(|k| [100.0 * k as f32, -1.0, 90.5]).collect();
        Filaments { time: 12.5, nodes, pieces: (0..3).map(piece).collect() }
    }

    fn written(filaments: &Filaments) -> Vec<u8> {
        let mut bytes = Vec::new();
        write_to(&mut bytes, filaments).unwrap();
        bytes
    }

    #[test]
    fn vortices_come_back_as_they_were_written() {
        for filaments in [filaments(), Filaments::default()] {
            assert_eq!(parsed(&written(&filaments)), Ok(filaments));
        }
    }

    #[test]
    fn arrays_stand_where_the_header_has_them() {
        let bytes = written(&filaments());
        let place = bytes.windows(MARK.len()).position(|window| window == MARK).unwrap();
        let header = std::str::from_utf8(&bytes[..place]).unwrap();
        let data = &bytes[place + MARK.len()..];
        let counts = [4_usize, 3];
        for (index, (name, _, n, width)) in ARRAYS.into_iter().enumerate() {
            let (_, rest) = header.split_once(&format!("Name=\"{name}\"")).unwrap();
            let offset = rest.split_once("offset=\"").unwrap().1.split_once('"').unwrap().0;
            let offset: usize = offset.parse().unwrap();
            let length = (counts[index.min(1)] * n * width) as u64;
            assert_eq!(data[offset..offset + COUNT], length.to_le_bytes(), "{name}");
        }
        let [node, piece] = filament_bytes();
        let end = b"\n</AppendedData>\n</VTKFile>\n".len();
        assert_eq!(data.len() - end, 10 * COUNT + 4 * node as usize + 3 * piece as usize);
    }

    #[test]
    fn damaged_files_are_refused() {
        let whole = written(&filaments());
        let end = b"\n</AppendedData>\n</VTKFile>\n".len();
        for length in 0..whole.len() - end {
            assert!(parsed(&whole[..length]).is_err(), "{length}");
        }
        let mut wrong = filaments();
        wrong.pieces[1].ends[1] = 4;
        assert_eq!(parsed(&written(&wrong)), Err("line 1 is none of a wake".into()));
        let mut wrong = filaments();
        wrong.nodes[2][1] = f32::NAN;
        assert!(parsed(&written(&wrong)).is_err_and(|problem| problem.contains("not finite")));
    }
}
