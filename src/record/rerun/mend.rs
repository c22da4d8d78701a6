//! Mends an .rrd that was cut: its messages, and the end that a whole file has.

use crate::record::RecordError;
use ::rerun::external::re_build_info::CrateVersion;
use ::rerun::external::re_log_encoding::{Decoder, Encoder, EncodingOptions};
use ::rerun::log::LogMsg;
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::Path;

/// Writes what is whole of an .rrd into a new file; returns the number of messages. None: it is no .rrd.
///
/// # Errors
/// A file cannot be read or written.
pub fn mend_rrd(torn: &Path, mended: &Path) -> Result<Option<u64>, RecordError> {
    let file = File::open(torn).map_err(|error| RecordError::unread(torn, &error))?;
    let Ok(messages) = Decoder::<LogMsg>::decode_eager(BufReader::new(file)) else { return Ok(None) };
    // A file that ends early gives its complete messages, then one error.
    let mut messages = messages.map_while(Result::ok).peekable();
    if messages.peek().is_none() {
        return Ok(None);
    }
    write(messages, mended).map(Some).map_err(|error| RecordError::caused(mended, error.as_ref()))
}

fn write(messages: impl Iterator<Item = LogMsg>, mended: &Path) -> Result<u64, Box<dyn Error>> {
    let file = BufWriter::new(File::create(mended)?);
    let mut encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file)?;
    let mut count = 0;
    for message in messages {
        encoder.append(&message)?;
        count += 1;
    }
    encoder.finish()?;
    encoder.flush_blocking()?;
    Ok(count)
}
