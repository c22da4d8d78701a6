//! Mends recordings that were cut: all that is whole goes into a file that every reader takes.

use super::{RecordError, schema};
use mcap::read::{LinearReader, Options};
use mcap::records::Record;
use mcap::{Attachment, Compression, MessageStream, WriteOptions};
use std::borrow::Cow;
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// What was whole of a recording that was cut.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Whole {
    pub messages: u64,
    /// Time of the last of them, if they have times.
    pub until_s: Option<f64>,
}

/// Writes what is whole of an .mcap into a new file; None, and no file, if nothing is.
///
/// # Errors
/// A file cannot be read or written.
pub fn mend_mcap(torn: &Path, mended: &Path) -> Result<Option<Whole>, RecordError> {
    let bytes = std::fs::read(torn).map_err(|error| RecordError::unread(torn, &error))?;
    // What the bodies look like stands in every head.
    let happens = |message: mcap::Message<'_>| message.channel.topic != schema::SCENE;
    let has_message = MessageStream::new_with_options(&bytes, Options::IgnoreEndMagic.into())
        .is_ok_and(|stream| stream.map_while(Result::ok).any(happens));
    if !has_message {
        return Ok(None);
    }
    try_mend_mcap(&bytes, mended).map(Some).map_err(|error| RecordError::caused(mended, error.as_ref()))
}

fn try_mend_mcap(bytes: &[u8], mended: &Path) -> Result<Whole, Box<dyn Error>> {
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
    let (mut messages, mut last_ns) = (0, 0);
    for message in MessageStream::new_with_options(bytes, options())?.map_while(Result::ok) {
        writer.write(&message)?;
        messages += 1;
        last_ns = last_ns.max(message.log_time);
    }
    writer.finish()?;
    writer.into_inner().flush()?;
    Ok(Whole { messages, until_s: Some(last_ns as f64 / 1e9) })
}
