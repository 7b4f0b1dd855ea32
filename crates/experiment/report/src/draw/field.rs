//! Planes of values as pictures with a palette.

use super::colour::{self, Map};

/// Pixels that point into the palette of a map.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Picture {
    /// Pixels in a row.
    pub(crate) width: usize,
    /// Rows, first at the top.
    pub(crate) height: usize,
    /// `height × width` indices into the palette.
    pub(crate) indices: Vec<u8>,
    /// Which palette.
    pub(crate) map: Map,
}

impl Picture {
    /// `width × height` pixels with the values that `value` gives for a column and a row, `low` to
    /// `high` spread over `map`.
    pub(crate) fn new(
        [width, height]: [usize; 2],
        map: Map,
        [low, high]: [f64; 2],
        value: impl Fn(usize, usize) -> f64,
    ) -> Self {
        let mut indices = Vec::with_capacity(width * height);
        for row in 0..height {
            for column in 0..width {
                let share = (value(column, row) - low) / (high - low);
                indices.push((255.0 * share.clamp(0.0, 1.0)).round() as u8);
            }
        }
        Self { width, height, indices, map }
    }

    /// The picture as a PNG file with a palette.
    pub(crate) fn to_png(&self) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_palette(colour::palette(self.map).concat());
        encoder.set_compression(png::Compression::Balanced);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.indices)?;
        writer.finish()?;
        Ok(bytes)
    }
}

/// `bytes` in base 64 (RFC 4648, section 4).
pub(crate) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = chunk
            .iter()
            .enumerate()
            .fold(0, |word, (index, &byte)| word | u32::from(byte) << (16 - 8 * index));
        for index in 0..4 {
            if index <= chunk.len() {
                text.push(char::from(LETTERS[(word >> (18 - 6 * index)) as usize & 63]));
            } else {
                text.push('=');
            }
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_follows_the_examples_of_the_standard() {
        for (plain, coded) in
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")]
        {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn a_picture_survives_its_file() {
        let picture = Picture::new([5, 3], Map::Sequential, [0.0, 14.0], |column, row| {
            (column + 5 * row) as f64
        });
        assert_eq!((picture.indices[0], picture.indices[14]), (0, 255));
        let bytes = picture.to_png().expect("encodes");
        let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        let mut reader = decoder.read_info().expect("header");
        let mut pixels = vec![0; reader.output_buffer_size().expect("size")];
        reader.next_frame(&mut pixels).expect("pixels");
        assert_eq!(&pixels[..15], &picture.indices[..]);
    }
}
