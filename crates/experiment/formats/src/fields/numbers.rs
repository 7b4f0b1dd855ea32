//! Numbers as they lie in a file, made velocities in single precision.

use netcdf_reader::masked::MaskParams;
use netcdf_reader::unpack::{SignParams, UnpackParams};
use netcdf_reader::{NcType, NcVariable};

/// How numbers lie in a file, and what they mean.
pub(super) struct Coding {
    kind: Kind,
    is_little: bool,
    /// None where single precision means what it says.
    meaning: Option<Meaning>,
}

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// What numbers mean: fill values and packed numbers as the conventions have them.
struct Meaning {
    sign: Option<SignParams>,
    mask: Option<MaskParams>,
    packing: Option<UnpackParams>,
    /// Metres a second of one.
    scale: f64,
}

impl Meaning {
    fn of(&self, stored: f64) -> f32 {
        let value = self.sign.map_or(stored, |sign| sign.reinterpret(stored));
        if self.mask.as_ref().is_some_and(|mask| is_masked(mask, value)) {
            return f32::NAN;
        }
        let value = self.packing.map_or(value, |packing| {
            let is_plain = packing.scale_factor == 1.0 && packing.add_offset == 0.0;
            if is_plain { value } else { value * packing.scale_factor + packing.add_offset }
        });
        (self.scale * value) as f32
    }
}

/// Whether `value` stands for none.
fn is_masked(mask: &MaskParams, value: f64) -> bool {
    mask.fill_value == Some(value)
        || mask.missing_values.contains(&value)
        || mask.valid_min.is_some_and(|least| value < least)
        || mask.valid_max.is_some_and(|most| value > most)
}

impl Coding {
    /// Numbers of `kind`, metres a second as they stand.
    pub(super) fn plain(kind: Kind, is_little: bool) -> Self {
        let meaning = Meaning { sign: None, mask: None, packing: None, scale: 1.0 };
        Self { kind, is_little, meaning: (kind != Kind::F32).then_some(meaning) }
    }

    /// Those of `variable`, whose unit is `scale` (m/s); none of text.
    pub(super) fn of(variable: &NcVariable, scale: f64) -> Option<Self> {
        let kind = match variable.dtype() {
            NcType::Byte => Kind::I8,
            NcType::UByte => Kind::U8,
            NcType::Short => Kind::I16,
            NcType::UShort => Kind::U16,
            NcType::Int => Kind::I32,
            NcType::UInt => Kind::U32,
            NcType::Int64 => Kind::I64,
            NcType::UInt64 => Kind::U64,
            NcType::Float => Kind::F32,
            NcType::Double => Kind::F64,
            _ => return None,
        };
        let meaning = Meaning {
            sign: SignParams::from_variable(variable),
            mask: MaskParams::from_variable(variable),
            packing: UnpackParams::from_variable(variable),
            scale,
        };
        let is_plain = kind == Kind::F32
            && meaning.mask.is_none()
            && meaning.packing.is_none()
            && scale == 1.0;
        Some(Self { kind, is_little: false, meaning: (!is_plain).then_some(meaning) })
    }

    /// Bytes of a number.
    pub(super) fn n_bytes(&self) -> usize {
        match self.kind {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::I64 | Kind::U64 | Kind::F64 => 8,
        }
    }

    /// On return `values` are the numbers in `bytes`, as many as there are values.
    pub(super) fn decode(&self, bytes: &[u8], values: &mut [f32]) {
        let Some(meaning) = &self.meaning else {
            return match self.is_little {
                true => each(bytes, values, f32::from_le_bytes),
                false => each(bytes, values, f32::from_be_bytes),
            };
        };
        macro_rules! through {
            ($number:ty) => {
                match self.is_little {
                    true => {
                        each(bytes, values, |own| meaning.of(<$number>::from_le_bytes(own) as f64))
                    }
                    false => {
                        each(bytes, values, |own| meaning.of(<$number>::from_be_bytes(own) as f64))
                    }
                }
            };
        }
        match self.kind {
            Kind::I8 => through!(i8),
            Kind::U8 => through!(u8),
            Kind::I16 => through!(i16),
            Kind::U16 => through!(u16),
            Kind::I32 => through!(i32),
            Kind::U32 => through!(u32),
            Kind::I64 => through!(i64),
            Kind::U64 => through!(u64),
            Kind::F32 => through!(f32),
            Kind::F64 => through!(f64),
        }
    }
}

/// Makes `values` of `bytes`, `N` of them each.
fn each<const N: usize>(bytes: &[u8], values: &mut [f32], number: impl Fn([u8; N]) -> f32) {
    for (value, own) in values.iter_mut().zip(bytes.as_chunks::<N>().0) {
        *value = number(*own);
    }
}
