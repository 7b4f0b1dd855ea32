//! Results as Parquet: one row group, a column each, units as the file's metadata `units` (JSON).

mod read;

pub(crate) use read::PARQUET;

use crate::column::{Column, Values};
use ::parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use ::parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use ::parquet::errors::Result;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use ::parquet::schema::types::{Type, TypePtr};
use std::collections::BTreeMap;
use std::sync::Arc;

/// `columns` as a file.
///
/// # Errors
/// What the library says.
pub(crate) fn bytes(columns: &[Column]) -> Result<Vec<u8>> {
    let fields = columns.iter().map(field).collect::<Result<Vec<TypePtr>>>()?;
    let schema = Arc::new(Type::group_type_builder("results").with_fields(fields).build()?);
    let units: BTreeMap<&str, &str> = columns
        .iter()
        .filter(|column| !column.unit.is_empty())
        .map(|column| (column.name.as_str(), column.unit.as_str()))
        .collect();
    let units = serde_json::to_string(&units)
        .map_err(|error| ::parquet::errors::ParquetError::External(Box::new(error)))?;
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(Some(vec![KeyValue::new("units".to_owned(), units)]))
        .build();
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for column in columns {
        match &column.values {
            Values::Whole(values) => write::<Int64Type>(&mut group, values)?,
            Values::Number(values) => write::<DoubleType>(&mut group, values)?,
            Values::Text(values) => {
                let texts = values.iter().map(|text| text.as_deref().map(ByteArray::from));
                write::<ByteArrayType>(&mut group, &texts.collect::<Vec<_>>())?;
            }
        }
    }
    group.close()?;
    file.close()?;
    Ok(bytes)
}

/// What the file says of `column`.
fn field(column: &Column) -> Result<TypePtr> {
    let (physical, logical) = match column.values {
        Values::Whole(_) => (Physical::INT64, None),
        Values::Number(_) => (Physical::DOUBLE, None),
        Values::Text(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(&column.name, physical)
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical);
    Ok(Arc::new(field.build()?))
}

/// Writes the next column of `group`.
fn write<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, &mut Vec<u8>>,
    values: &[Option<T::T>],
) -> Result<()> {
    let Some(mut column) = group.next_column()? else { return Ok(()) };
    let there: Vec<T::T> = values.iter().flatten().cloned().collect();
    let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
    column.typed::<T>().write_batch(&there, Some(&levels), None)?;
    column.close()
}
