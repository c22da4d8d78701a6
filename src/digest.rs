//! SHA-256, in lower-case hexadecimal.

use sha2::{Digest, Sha256};

/// The first bytes of a content's digest.
pub fn sha256(content: impl AsRef<[u8]>, bytes: usize) -> String {
    hex(&Sha256::digest(content)[..bytes])
}

pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
