//! Mends an .rrd that was cut: its messages, and the end that a whole file has.

use super::names::{APPLICATION, SIM_TIME, STRETCH};
use crate::record::RecordError;
use crate::record::mend::Whole;
use ::rerun::external::re_build_info::CrateVersion;
use ::rerun::external::re_log_encoding::{Decoder, Encoder, EncodingOptions};
use ::rerun::log::{Chunk, LogMsg};
use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, SeekFrom};
use std::path::Path;

/// What stands near the end of a whole file, and how near.
const FOOTER: &[u8] = b"RRF2FOOT";
const FOOTER_BYTES: u64 = 64;

/// Whether an .rrd is a recording of ours, by what it says of itself at its head.
///
/// # Errors
/// The file cannot be read.
pub fn is_recording(path: &Path) -> Result<bool, RecordError> {
    let Some(mut messages) = messages(path)? else { return Ok(false) };
    let application = messages.find_map(|message| match message {
        LogMsg::SetStoreInfo(about) => Some(about.info.application_id().as_str().starts_with(APPLICATION)),
        _ => None,
    });
    Ok(application.unwrap_or(false))
}

/// Whether an .rrd lacks its end.
///
/// # Errors
/// The file cannot be read.
pub fn is_cut(path: &Path) -> Result<bool, RecordError> {
    let last = || -> std::io::Result<Vec<u8>> {
        let mut file = File::open(path)?;
        let bytes = file.metadata()?.len();
        file.seek(SeekFrom::Start(bytes.saturating_sub(FOOTER_BYTES)))?;
        let mut last = Vec::new();
        file.read_to_end(&mut last)?;
        Ok(last)
    };
    let last = last().map_err(|error| RecordError::unread(path, &error))?;
    Ok(!last.windows(FOOTER.len()).any(|part| part == FOOTER))
}

/// What is whole of an .rrd; None: nothing that has a time, or it is no .rrd.
///
/// # Errors
/// The file cannot be read.
pub fn whole_of(path: &Path) -> Result<Option<Whole>, RecordError> {
    let Some(messages) = messages(path)? else { return Ok(None) };
    let (mut whole, mut has_samples) = (Whole::default(), false);
    for message in messages {
        whole.messages += 1;
        let LogMsg::ArrowMsg(_, message) = &message else { continue };
        // The layout has a time of its own, that of the machine.
        let Ok(chunk) = Chunk::from_arrow_msg(message) else { continue };
        let timeline = chunk.timelines().values().find(|column| column.timeline().name().as_str() == SIM_TIME);
        if let Some(times) = timeline {
            has_samples = true;
            let last_s = times.time_range().max().as_i64() as f64 / 1e9;
            whole.until_s = Some(whole.until_s.map_or(last_s, |until_s| until_s.max(last_s)));
        }
    }
    Ok(has_samples.then_some(whole))
}

/// The stretch that an .rrd plays; None where it says none.
///
/// # Errors
/// The file cannot be read.
pub fn stretch_of(path: &Path) -> Result<Option<[f64; 2]>, RecordError> {
    let Some(messages) = messages(path)? else { return Ok(None) };
    let mut found = None;
    for message in messages {
        let LogMsg::ArrowMsg(_, message) = &message else { continue };
        let Ok(chunk) = Chunk::from_arrow_msg(message) else { continue };
        let Some(component) = chunk.components_identifiers().find(|name| name.as_str() == STRETCH) else { continue };
        for row in chunk.iter_slices::<f64>(component) {
            if let [from_s, to_s] = row {
                found = Some([*from_s, *to_s]);
            }
        }
    }
    Ok(found)
}

/// Writes what is whole of an .rrd into a new file; None, and no file, if no sample is.
///
/// # Errors
/// A file cannot be read or written.
pub fn mend_rrd(torn: &Path, mended: &Path) -> Result<Option<Whole>, RecordError> {
    let (Some(whole), Some(messages)) = (whole_of(torn)?, messages(torn)?) else { return Ok(None) };
    write(messages, mended).map_err(|error| RecordError::caused(mended, error.as_ref()))?;
    Ok(Some(whole))
}

/// Messages of an .rrd; of a file that ends early, those that are complete.
pub(super) fn messages(path: &Path) -> Result<Option<impl Iterator<Item = LogMsg>>, RecordError> {
    let file = File::open(path).map_err(|error| RecordError::unread(path, &error))?;
    let decoded = Decoder::<LogMsg>::decode_eager(BufReader::new(file));
    Ok(decoded.ok().map(|messages| messages.map_while(Result::ok)))
}

fn write(messages: impl Iterator<Item = LogMsg>, mended: &Path) -> Result<(), Box<dyn Error>> {
    let file = BufWriter::new(File::create(mended)?);
    let mut encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file)?;
    for message in messages {
        encoder.append(&message)?;
    }
    encoder.finish()?;
    Ok(encoder.flush_blocking()?)
}
