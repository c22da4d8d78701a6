//! Reader of what a recording says of itself.

use super::schema;
use crate::files::{self, FileError};
use mcap::read::{LinearReader, Options};
use mcap::records::Record;
use std::path::Path;

/// The experiment that an .mcap of ours shows, as YAML, of a torn file too; None where there is none in it.
///
/// # Errors
/// The file cannot be read.
pub fn experiment_of(path: &Path) -> Result<Option<String>, FileError> {
    let bytes = files::read(path)?;
    let Ok(reader) = LinearReader::new_with_options(&bytes, Options::IgnoreEndMagic.into()) else { return Ok(None) };
    let config = reader.map_while(Result::ok).find_map(|record| match record {
        Record::Attachment { header, data, .. } if header.name == schema::CONFIG_FILE => Some(data.into_owned()),
        _ => None,
    });
    Ok(config.and_then(|text| String::from_utf8(text).ok()))
}
