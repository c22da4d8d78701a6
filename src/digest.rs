//! SHA-256, in lower-case hexadecimal; JSON that says whether it is whole.

use serde::Serialize;
use sha2::{Digest, Sha256};
use std::io::{self, BufRead};

/// The first bytes of a content's digest, in hexadecimal.
pub fn sha256(content: impl AsRef<[u8]>, bytes: usize) -> String {
    hex(&Sha256::digest(content)[..bytes])
}

/// Length and digest of a content, part by part.
#[derive(Clone, Default)]
pub struct Sha256Sum {
    hash: Sha256,
    bytes: u64,
}

impl Sha256Sum {
    pub fn add(&mut self, part: &[u8]) {
        self.hash.update(part);
        self.bytes += part.len() as u64;
    }

    /// Length and digest of all so far.
    pub fn get(&self) -> (u64, String) {
        (self.bytes, hex(&self.hash.clone().finalize()))
    }
}

/// Length and digest of all that is left to read.
///
/// # Errors
/// The reader's.
pub fn sha256_of(mut content: impl BufRead) -> io::Result<(u64, String)> {
    let mut sum = Sha256Sum::default();
    loop {
        let part = content.fill_buf()?;
        if part.is_empty() {
            return Ok(sum.get());
        }
        let len = part.len();
        sum.add(part);
        content.consume(len);
    }
}

/// Text between what a sealed object says and its checksum.
const SEAL: &str = ",\"sum\":\"";
/// Number of bytes of the checksum.
const SEAL_BYTES: usize = 8;

/// A JSON object with one more member, 64 bits of the SHA-256 of all before it.
pub fn sealed(object: &impl Serialize) -> String {
    let mut text = serde_json::to_vec(object).unwrap_or_default();
    text.pop();
    String::from_utf8(seal(text)).unwrap_or_default()
}

/// What a JSON object says, without its last brace, sealed and closed.
pub fn seal(mut said: Vec<u8>) -> Vec<u8> {
    let sum = sha256(&said, SEAL_BYTES);
    for part in [SEAL, &sum, "\"}"] {
        said.extend_from_slice(part.as_bytes());
    }
    said
}

/// Text of a sealed object without its seal; None where it is not what was written. (The end of a line may have been
/// translated.)
pub fn unsealed(text: &[u8]) -> Option<String> {
    let (said, sum) = std::str::from_utf8(text).ok()?.trim_end_matches(['\r', '\n']).rsplit_once(SEAL)?;
    let is_whole = sum.strip_suffix("\"}")? == sha256(said, SEAL_BYTES);
    is_whole.then(|| format!("{said}}}"))
}

pub fn hex(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    let digits = |byte: &u8| [byte >> 4, byte & 15].map(|digit| char::from(DIGITS[usize::from(digit)]));
    bytes.iter().flat_map(digits).collect()
}
