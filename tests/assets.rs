//! What is vendored is what assets/README.md says it is.

use sha2::{Digest, Sha256};
use std::io::Read;
use std::path::Path;

const ASSETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/assets");

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn the_vendored_script_is_the_one_that_its_readme_names() {
    let readme = std::fs::read_to_string(format!("{ASSETS}/README.md")).unwrap();
    let documented = |file: &str| {
        let row = readme.lines().find(|line| line.starts_with(&format!("| `{file}` |"))).unwrap();
        row.split('`').nth_back(1).unwrap().to_owned()
    };
    let gz = std::fs::read(format!("{ASSETS}/plotly-cartesian.min.js.gz")).unwrap();
    assert_eq!(sha256(&gz), documented("plotly-cartesian.min.js.gz"));

    let mut js = String::new();
    flate2::read::GzDecoder::new(&gz[..]).read_to_string(&mut js).unwrap();
    assert_eq!(sha256(js.as_bytes()), documented("plotly-cartesian.min.js"));

    let version = readme.split("plotly.js-cartesian-dist-min@").nth(1).unwrap().lines().next().unwrap();
    let banner: String = js.lines().take(6).collect();
    assert!(banner.contains(&format!("plotly.js (cartesian - minified) v{version}")), "{banner}");
    assert!(banner.contains("Licensed under the MIT license"), "{banner}");
    assert!(std::fs::read_to_string(Path::new(ASSETS).join("LICENSE-plotly")).unwrap().contains("MIT License"));
}
