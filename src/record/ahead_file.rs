//! File with an end that goes ahead: what is not yet due to be written stands there, until what is due takes its place.
//!
//! What is due goes by the run alone, so that two runs make the same file; what goes ahead goes by the clock, so that a
//! kill loses little. Of a file that is complete nothing is left of it.
//!
//! A kill finds a file that readers take at any moment. What stands ahead stands behind room that readers skip; what is
//! due is written into this room, where nobody sees it, and then becomes visible at once, with the few bytes of its
//! head, while what stood ahead becomes room. (The room is a hole: it takes no place on a disk.)

use crate::digest::Sha256Sum;
use std::fs::File;
use std::io::{Error, ErrorKind, Read, Result, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Room for what is due, in bytes: more than a batch takes. Of more that is due, what stands ahead moves on.
const ROOM: u64 = 16 << 20;

/// Bytes that let the readers of a format skip so many bytes behind them; as many, whatever they skip.
pub type SkipBytes = Box<dyn Fn(u64) -> Vec<u8> + Send>;

/// A file, for the encoder of its format and for who writes ahead of it.
#[derive(Clone)]
pub struct AheadFile(Arc<Mutex<Parts>>);

struct Parts {
    file: File,
    /// Length of what is due and written.
    whole: u64,
    /// Place of what stands ahead behind its room, and where it ends: both `whole` where nothing does.
    ahead: u64,
    end: u64,
    skip: Option<SkipBytes>,
    /// What is due and not written, and the encoder's place in it.
    due: Vec<u8>,
    at: usize,
    /// Of what is due and written.
    sum: Sha256Sum,
    /// Whether a write has failed: the file stays as it is, since what would follow would lack something before it.
    has_failed: bool,
}

impl AheadFile {
    /// A new file.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn create(path: &Path) -> Result<Self> {
        let file = File::options().read(true).write(true).create(true).truncate(true).open(path)?;
        Ok(AheadFile(Arc::new(Mutex::new(Parts {
            file,
            whole: 0,
            ahead: 0,
            end: 0,
            skip: None,
            due: Vec::new(),
            at: 0,
            sum: Sha256Sum::default(),
            has_failed: false,
        }))))
    }

    /// Says how readers of its format are made to skip something. Without that, nothing is written ahead.
    pub fn skip_by(&self, skip: SkipBytes) {
        self.parts().skip = Some(skip);
    }

    /// Writes something behind all that stands in the file, until the next flush.
    ///
    /// # Errors
    /// The machine failed; the file is as it was.
    pub fn ahead(&self, bytes: &[u8]) -> Result<()> {
        let mut parts = self.parts();
        if bytes.is_empty() || parts.has_failed {
            return Ok(());
        }
        let end = parts.end;
        parts.go_ahead(bytes).inspect_err(|_| {
            // The first error is the one to tell.
            let _ = parts.file.set_len(end);
        })
    }

    /// Bytes of the file that are due and written.
    pub fn whole(&self) -> u64 {
        self.parts().whole
    }

    /// Length and SHA-256 of what is due and written.
    pub fn sum(&self) -> (u64, String) {
        self.parts().sum.get()
    }

    fn parts(&self) -> MutexGuard<'_, Parts> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Parts {
    fn put(&mut self, place: u64, bytes: &[u8]) -> Result<()> {
        self.file.seek(SeekFrom::Start(place))?;
        self.file.write_all(bytes)
    }

    fn go_ahead(&mut self, bytes: &[u8]) -> Result<()> {
        if self.end > self.whole {
            self.put(self.end, bytes)?;
            self.end += bytes.len() as u64;
            return Ok(());
        }
        if self.skip.is_none() {
            return Ok(());
        }
        let room = self.skipped(ROOM);
        let place = self.whole + room.len() as u64 + ROOM;
        self.put(place, bytes)?;
        self.put(self.whole, &room)?;
        (self.ahead, self.end) = (place, place + bytes.len() as u64);
        Ok(())
    }

    /// Puts what is due in the place of what stands ahead.
    fn settle(&mut self) -> Result<()> {
        if self.has_failed {
            return Err(Error::other("a write before this one has failed"));
        }
        if self.due.is_empty() {
            return Ok(());
        }
        let due = std::mem::take(&mut self.due);
        self.at = 0;
        let written = if self.end > self.whole { self.put_into_room(&due) } else { self.put(self.whole, &due) };
        if let Err(error) = written {
            self.has_failed = true;
            // Of what is behind all else, the part that is written is of use; in the room nobody sees it.
            return Err(error);
        }
        self.whole += due.len() as u64;
        (self.ahead, self.end) = (self.whole, self.whole);
        self.sum.add(&due);
        self.due = due;
        self.due.clear();
        Ok(())
    }

    /// Bytes that let readers skip so many behind them.
    fn skipped(&self, bytes: u64) -> Vec<u8> {
        self.skip.as_ref().map_or(Vec::new(), |skip| skip(bytes))
    }

    /// Puts what is due before what stands ahead, and takes that away.
    fn put_into_room(&mut self, due: &[u8]) -> Result<()> {
        let head = self.skipped(0).len();
        let (from, settled) = (self.whole, self.whole + due.len() as u64);
        let needed = settled + head as u64;
        // No message is as short as that.
        let head = head.min(due.len());
        if needed > self.ahead {
            self.move_on(needed)?;
        }
        let rest = self.skipped(self.end - needed);
        self.put(from + head as u64, &[&due[head..], &rest].concat())?;
        // In one page of the machine's, or two: nobody sees a part of it.
        self.put(from, &due[..head])?;
        self.file.set_len(settled)
    }

    /// Moves what stands ahead, at least to a place.
    fn move_on(&mut self, least: u64) -> Result<()> {
        let mut bytes = Vec::new();
        self.file.seek(SeekFrom::Start(self.ahead))?;
        (&self.file).take(self.end - self.ahead).read_to_end(&mut bytes)?;
        let place = self.end.max(least);
        self.put(place, &bytes)?;
        let room = self.skipped(place - self.whole - self.skipped(0).len() as u64);
        self.put(self.whole, &room)?;
        (self.ahead, self.end) = (place, place + bytes.len() as u64);
        Ok(())
    }
}

impl Drop for Parts {
    fn drop(&mut self) {
        // Who wants to know of errors has flushed.
        if !self.has_failed {
            let _ = self.settle();
        }
    }
}

impl Write for AheadFile {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let mut parts = self.parts();
        if parts.has_failed {
            return Err(Error::other("a write before this one has failed"));
        }
        let at = parts.at;
        let over = bytes.len().min(parts.due.len() - at);
        parts.due[at..at + over].copy_from_slice(&bytes[..over]);
        parts.due.extend_from_slice(&bytes[over..]);
        parts.at += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<()> {
        self.parts().settle()
    }
}

impl Seek for AheadFile {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        let mut parts = self.parts();
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::End(by) => (parts.whole + parts.due.len() as u64).checked_add_signed(by),
            SeekFrom::Current(by) => (parts.whole + parts.at as u64).checked_add_signed(by),
        };
        let at = place.and_then(|place| place.checked_sub(parts.whole)).filter(|at| *at <= parts.due.len() as u64);
        match at {
            Some(at) => {
                parts.at = at as usize;
                Ok(parts.whole + at)
            }
            None => Err(Error::new(ErrorKind::InvalidInput, "what is written stays as it is")),
        }
    }
}
