//! SHA-256, in lower-case hexadecimal.

use sha2::{Digest, Sha256};
use std::io::{self, BufRead};

/// The first bytes of a content's digest.
pub fn sha256(content: impl AsRef<[u8]>, bytes: usize) -> String {
    hex(&Sha256::digest(content)[..bytes])
}

/// Length and digest of all that is left to read.
///
/// # Errors
/// The reader's.
pub fn sha256_of(mut content: impl BufRead) -> io::Result<(u64, String)> {
    let (mut hash, mut bytes) = (Sha256::new(), 0);
    loop {
        let part = content.fill_buf()?;
        if part.is_empty() {
            return Ok((bytes, hex(&hash.finalize())));
        }
        let len = part.len();
        hash.update(part);
        content.consume(len);
        bytes += len as u64;
    }
}

pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
