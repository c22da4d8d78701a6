//! Mends recordings that were cut: all that is whole goes into a file that every reader takes.

use super::RecordError;
use mcap::read::{LinearReader, Options};
use mcap::records::Record;
use mcap::{Attachment, Compression, MessageStream, WriteOptions};
use std::borrow::Cow;
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes what is whole of an .mcap into a new file; returns the number of messages. None: it is no .mcap.
///
/// # Errors
/// A file cannot be read or written.
pub fn mend_mcap(torn: &Path, mended: &Path) -> Result<Option<u64>, RecordError> {
    let bytes = std::fs::read(torn).map_err(|error| RecordError::unread(torn, &error))?;
    if !bytes.starts_with(mcap::MAGIC) {
        return Ok(None);
    }
    try_mend_mcap(&bytes, mended).map(Some).map_err(|error| RecordError::caused(mended, error.as_ref()))
}

fn try_mend_mcap(bytes: &[u8], mended: &Path) -> Result<u64, Box<dyn Error>> {
    let options = || Options::IgnoreEndMagic.into();
    let mut writer = WriteOptions::new()
        .compression(Some(Compression::Zstd))
        .compression_threads(0)
        .create(BufWriter::new(File::create(mended)?))?;
    for record in LinearReader::new_with_options(bytes, options())?.map_while(Result::ok) {
        match record {
            Record::Attachment { header, data, .. } => writer.attach(&Attachment {
                log_time: header.log_time,
                create_time: header.create_time,
                name: header.name.clone(),
                media_type: header.media_type.clone(),
                data: Cow::Borrowed(&data),
            })?,
            Record::Metadata(metadata) => writer.write_metadata(&metadata)?,
            _ => {}
        }
    }
    let mut count = 0;
    for message in MessageStream::new_with_options(bytes, options())?.map_while(Result::ok) {
        writer.write(&message)?;
        count += 1;
    }
    writer.finish()?;
    writer.into_inner().flush()?;
    Ok(count)
}
