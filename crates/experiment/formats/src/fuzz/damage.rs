//! What can happen to a file.

use proptest::prelude::*;
use proptest::sample::{Index, select};

/// Bytes that a damaged file has at most.
pub(super) const LONGEST: usize = 1 << 17;

/// Words and figures that tend to be taken for granted not to come.
const WORDS: [&str; 48] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "0.5",
    "-0.5",
    "1e-300",
    "1e-30",
    "1e-9",
    "1e9",
    "1e30",
    "1e300",
    "1e999",
    "-1e999",
    "+inf",
    "-inf",
    "inf",
    ".inf",
    "nan",
    "NaN",
    ".nan",
    "-nan",
    "1D400",
    "255",
    "65536",
    "999999",
    "1000000",
    "2147483647",
    "2147483648",
    "-2147483648",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551616",
    "true",
    "\"\"",
    "''",
    "\"",
    "'",
    "[",
    "{}",
    "[]",
    "~",
    "é\u{301}漢",
    "*a",
    "&a",
    ",",
];
const INTEGERS: [i64; 16] = [
    0,
    1,
    -1,
    2,
    127,
    128,
    255,
    256,
    32_767,
    32_768,
    65_535,
    0xff_ffff,
    i32::MAX as i64,
    i32::MIN as i64,
    i64::MAX,
    i64::MIN,
];
const REALS: [f64; 12] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1e-300,
    1e-38,
    1e-6,
    1e6,
    1e38,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

/// One thing that happens to bytes; places are shares of their length.
#[derive(Clone, Debug)]
pub(super) enum Damage {
    Flip(Index, u8),
    Put(Index, u8),
    Cut(Index),
    Behead(Index),
    Remove(Index, usize),
    Insert(Index, Vec<u8>),
    Repeat(Index, usize, usize),
    Copy(Index, usize, Index),
    Integer(Index, i64, usize),
    Real(Index, f64, bool),
    /// Bytes at a place counted from the front.
    Early(usize, Vec<u8>),
    /// A word of the text becomes another one.
    Word(Index, &'static str),
    /// Two words change places.
    SwapWords(Index, Index),
    /// A line goes, comes twice, or changes places with another one.
    DropLine(Index),
    DoubleLine(Index),
    SwapLines(Index, Index),
    Anything(Vec<u8>),
}

/// A few of them.
pub(super) fn damages() -> impl Strategy<Value = Vec<Damage>> {
    let place = any::<Index>;
    let bytes = |most: usize| prop::collection::vec(any::<u8>(), 0..most);
    let word = prop_oneof![
        6 => (place(), select(&WORDS[..])).prop_map(|(at, word)| Damage::Word(at, word)),
        2 => (place(), place()).prop_map(|(one, other)| Damage::SwapWords(one, other)),
        1 => place().prop_map(Damage::DropLine),
        1 => place().prop_map(Damage::DoubleLine),
        1 => (place(), place()).prop_map(|(one, other)| Damage::SwapLines(one, other)),
    ];
    let binary = prop_oneof![
        (place(), select(&INTEGERS[..]), select(&[1, 2, 4, 8][..]))
            .prop_map(|(at, value, width)| Damage::Integer(at, value, width)),
        (place(), select(&REALS[..]), any::<bool>())
            .prop_map(|(at, value, double)| Damage::Real(at, value, double)),
    ];
    // The first bytes of a binary file are the ones that count.
    let early = (0_usize..160, select(&INTEGERS[..]), select(&[1, 2, 4, 8][..]))
        .prop_map(|(at, value, width)| Damage::Early(at, value.to_le_bytes()[..width].to_vec()));
    let one = prop_oneof![
        12 => word,
        6 => binary,
        6 => early,
        4 => (place(), 0..8_u8).prop_map(|(at, bit)| Damage::Flip(at, bit)),
        4 => (place(), any::<u8>()).prop_map(|(at, byte)| Damage::Put(at, byte)),
        2 => place().prop_map(Damage::Cut),
        1 => place().prop_map(Damage::Behead),
        2 => (place(), 1_usize..64).prop_map(|(at, length)| Damage::Remove(at, length)),
        2 => (place(), bytes(24)).prop_map(|(at, bytes)| Damage::Insert(at, bytes)),
        2 => (place(), 1_usize..24, 2_usize..5000)
            .prop_map(|(at, length, times)| Damage::Repeat(at, length, times)),
        2 => (place(), 1_usize..400, place())
            .prop_map(|(from, length, to)| Damage::Copy(from, length, to)),
        1 => bytes(600).prop_map(Damage::Anything),
    ];
    prop::collection::vec(one, 1..6)
}

/// `whole` after `damages`, at most [`LONGEST`] bytes of it.
pub(super) fn damaged(whole: &[u8], damages: &[Damage]) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for damage in damages {
        damage.befall(&mut bytes);
        bytes.truncate(LONGEST);
    }
    bytes
}

impl Damage {
    fn befall(&self, bytes: &mut Vec<u8>) {
        let end = bytes.len();
        let at = |index: &Index| index.index(end + 1);
        let span = |index: &Index, length: usize| at(index)..(at(index) + length).min(end);
        match self {
            Self::Flip(index, bit) => {
                if let Some(byte) = bytes.get_mut(at(index)) {
                    *byte ^= 1 << bit;
                }
            }
            Self::Put(index, value) => overwrite(bytes, at(index), &[*value]),
            Self::Cut(index) => bytes.truncate(at(index)),
            Self::Behead(index) => drop(bytes.drain(..at(index))),
            Self::Remove(index, length) => drop(bytes.drain(span(index, *length))),
            Self::Insert(index, new) => {
                let place = at(index);
                bytes.splice(place..place, new.iter().copied());
            }
            Self::Repeat(index, length, times) => {
                let span = span(index, *length);
                let again = bytes[span.clone()].repeat((*times).min(LONGEST / length));
                bytes.splice(span, again);
            }
            Self::Copy(from, length, to) => {
                let (copy, place) = (bytes[span(from, *length)].to_vec(), at(to));
                bytes.splice(place..place, copy);
            }
            Self::Integer(index, value, width) => {
                overwrite(bytes, at(index), &value.to_le_bytes()[..*width]);
            }
            Self::Real(index, value, true) => overwrite(bytes, at(index), &value.to_le_bytes()),
            Self::Real(index, value, false) => {
                overwrite(bytes, at(index), &(*value as f32).to_le_bytes());
            }
            Self::Early(place, new) => overwrite(bytes, *place, new),
            Self::Word(index, word) => {
                let words = pieces(bytes, is_between_words);
                if let Some(span) = pick(&words, index) {
                    bytes.splice(span, word.bytes());
                }
            }
            Self::SwapWords(one, other) => {
                swap(bytes, &pieces(bytes, is_between_words), one, other)
            }
            Self::DropLine(index) => {
                if let Some(span) = pick(&pieces(bytes, is_line_end), index) {
                    bytes.drain(span);
                }
            }
            Self::DoubleLine(index) => {
                if let Some(span) = pick(&pieces(bytes, is_line_end), index) {
                    let mut line = vec![b'\n'];
                    line.extend_from_slice(&bytes[span.clone()]);
                    bytes.splice(span.end..span.end, line);
                }
            }
            Self::SwapLines(one, other) => swap(bytes, &pieces(bytes, is_line_end), one, other),
            Self::Anything(all) => bytes.clone_from(all),
        }
    }
}

type Span = std::ops::Range<usize>;

fn overwrite(bytes: &mut [u8], place: usize, new: &[u8]) {
    for (byte, value) in bytes.iter_mut().skip(place).zip(new) {
        *byte = *value;
    }
}

fn is_between_words(byte: u8) -> bool {
    byte.is_ascii_whitespace() || b",;:=[]{}()\"'".contains(&byte)
}

fn is_line_end(byte: u8) -> bool {
    byte == b'\n'
}

/// Where the pieces between separators are.
fn pieces(bytes: &[u8], separates: impl Fn(u8) -> bool) -> Vec<Span> {
    let mut start = 0;
    let mut pieces = Vec::new();
    for end in (0..=bytes.len()).filter(|end| *end == bytes.len() || separates(bytes[*end])) {
        if end > start {
            pieces.push(start..end);
        }
        start = end + 1;
    }
    pieces
}

fn pick(pieces: &[Span], index: &Index) -> Option<Span> {
    if pieces.is_empty() { None } else { Some(index.get(pieces).clone()) }
}

fn swap(bytes: &mut Vec<u8>, pieces: &[Span], one: &Index, other: &Index) {
    let (Some(one), Some(other)) = (pick(pieces, one), pick(pieces, other)) else { return };
    let (first, second) = if one.start <= other.start { (one, other) } else { (other, one) };
    if first.start == second.start {
        return;
    }
    let (early, late) = (bytes[first.clone()].to_vec(), bytes[second.clone()].to_vec());
    bytes.splice(second, early);
    bytes.splice(first, late);
}
