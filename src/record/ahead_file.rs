//! File with an end that goes ahead: what is not yet due to be written stands there, until what is due takes its place.
//!
//! What is due goes by the run alone, so that two runs make the same file; what goes ahead goes by the clock, so that a
//! kill loses little. Of a file that is complete nothing is left of it.

use crate::digest::Sha256Sum;
use std::fs::File;
use std::io::{Error, ErrorKind, Result, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A file, for the encoder of its format and for who writes ahead of it.
#[derive(Clone)]
pub struct AheadFile(Arc<Mutex<Parts>>);

struct Parts {
    file: File,
    /// Length of what is due and written.
    whole: u64,
    /// Length with what stands ahead behind it.
    end: u64,
    /// What is due and not written, and the encoder's place in it.
    due: Vec<u8>,
    at: usize,
    /// Of what is due and written.
    sum: Sha256Sum,
}

impl AheadFile {
    /// A new file.
    ///
    /// # Errors
    /// The file cannot be made.
    pub fn create(path: &Path) -> Result<Self> {
        let file = File::create(path)?;
        let parts = Parts { file, whole: 0, end: 0, due: Vec::new(), at: 0, sum: Sha256Sum::default() };
        Ok(AheadFile(Arc::new(Mutex::new(parts))))
    }

    /// Writes something behind all that stands in the file, until the next flush.
    ///
    /// # Errors
    /// The machine failed; the file is as it was.
    pub fn ahead(&self, bytes: &[u8]) -> Result<()> {
        let mut parts = self.parts();
        let end = parts.end;
        parts.file.seek(SeekFrom::Start(end))?;
        match parts.file.write_all(bytes) {
            Ok(()) => parts.end += bytes.len() as u64,
            Err(error) => {
                parts.file.set_len(end)?;
                return Err(error);
            }
        }
        Ok(())
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
    /// Puts what is due in the place of what stands ahead. (One write: a kill within it loses what stood there.)
    fn settle(&mut self) -> Result<()> {
        if self.due.is_empty() && self.end == self.whole {
            return Ok(());
        }
        let due = std::mem::take(&mut self.due);
        self.at = 0;
        let settled = self.whole + due.len() as u64;
        let longest = self.end.max(settled);
        self.file.seek(SeekFrom::Start(self.whole))?;
        // What is half written is written over by who tries again, and cut.
        self.end = longest;
        self.file.write_all(&due)?;
        if longest > settled {
            self.file.set_len(settled)?;
        }
        (self.whole, self.end) = (settled, settled);
        self.sum.add(&due);
        self.due = due;
        self.due.clear();
        Ok(())
    }
}

impl Drop for Parts {
    fn drop(&mut self) {
        // Who wants to know of errors has flushed.
        let _ = self.settle();
    }
}

impl Write for AheadFile {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        let mut parts = self.parts();
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
