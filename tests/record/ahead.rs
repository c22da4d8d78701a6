//! What is recorded stands in the files soon after it happened, whenever its batch is written; what stands ahead leaves
//! no trace.

use super::synthetic::{self as s, ALL};
use crate::cli::run;
use crate::scratch;
use gotai::record::sample::Header;
use gotai::record::writer::{Target, Writer, open};
use std::path::Path;
use std::time::{Duration, Instant};

/// Of so many bodies, all at one place: an .rrd of more than 64 is written less often.
fn header(bodies: usize) -> Header {
    let mut header = s::header(ALL);
    let body = header.bodies[0].clone();
    header.bodies =
        (0..bodies).map(|i| gotai::record::sample::BodyHeader { name: format!("cube[{i}]"), ..body.clone() }).collect();
    header
}

fn fill(writer: &mut Writer, samples: std::ops::Range<u64>, bodies: usize) {
    for i in samples {
        writer.fill(|batch| {
            s::push(batch, i, ALL);
            batch.bodies.extend(std::iter::repeat_n(s::body(i), bodies - 1));
        });
    }
}

/// Time at which a file ends that is cut here and now; None of one with nothing in it.
fn ends_at(partial: &Path) -> Option<f64> {
    let folder = scratch::folder();
    let copy = folder.path().join(partial.file_name().unwrap());
    std::fs::copy(partial, &copy).unwrap();
    let (code, out, err) = run(&["repair", copy.to_str().unwrap()]);
    let said = format!("{out}{err}");
    let time = said.split("ends at t = ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok());
    assert!(code == 0 || time.is_none(), "{said}");
    time
}

fn soon(partial: &Path, time_s: f64) {
    let since = Instant::now();
    while ends_at(partial) != Some(time_s) {
        // Measured: 0.15 s, of which the clock is all; a busy machine takes longer to read the file.
        assert!(since.elapsed() < Duration::from_secs(20), "{}: {:?}", partial.display(), ends_at(partial));
    }
}

/// Three batches; after each and in the midst of the last one it is looked at what a kill would leave.
fn written(dir: &Path, bodies: usize, is_looked_at: bool) {
    let header = header(bodies);
    let mut writer = open(Target::AVAILABLE, dir, None, &header).unwrap();
    let look = |until: u64| {
        for target in Target::AVAILABLE.iter().filter(|_| is_looked_at) {
            soon(&dir.join(format!("{}.partial.{}", header.case, target.extension())), s::time_s(until));
        }
    };
    fill(&mut writer, 0..1, bodies);
    writer.flush();
    look(0);
    fill(&mut writer, 1..8, bodies);
    writer.flush();
    look(7);
    fill(&mut writer, 8..31, bodies);
    look(30);
    fill(&mut writer, 31..40, bodies);
    look(39);
    fill(&mut writer, 40..50, bodies);
    writer.finish(s::ending()).unwrap();
}

#[test]
fn what_is_being_filled_is_in_the_files_soon_and_leaves_no_trace() {
    for bodies in [1, 130] {
        let [looked_at, alone] = [true, false].map(|is_looked_at| {
            let folder = scratch::folder();
            written(folder.path(), bodies, is_looked_at);
            folder
        });
        let of = |folder: &scratch::Folder, target: Target| target.path(folder.path(), s::NAME);
        let bytes = |folder| std::fs::read(of(folder, Target::Mcap)).unwrap();
        assert!(bytes(&looked_at) == bytes(&alone), "{bodies}: the same bytes");
        #[cfg(feature = "rerun")]
        {
            let rows = |folder| super::rerun::whole(&of(folder, Target::Rerun));
            assert_eq!(rows(&looked_at), rows(&alone), "{bodies}");
        }
    }
}

/// A batch that is larger than the room before what stands ahead.
#[test]
fn a_large_batch_takes_the_place_of_what_stands_ahead() {
    // Encoded, more than 16 MB.
    const CONTACTS: usize = 300_000;
    let written = |is_looked_at: bool| {
        let folder = scratch::folder();
        let header = Header { most_bytes: 1 << 40, ..header(1) };
        let mut writer = open(&[Target::Mcap], folder.path(), None, &header).unwrap();
        let partial = folder.path().join(format!("{}.partial.mcap", header.case));
        fill(&mut writer, 0..1, 1);
        writer.flush();
        fill(&mut writer, 1..2, 1);
        if is_looked_at {
            soon(&partial, s::time_s(1));
            assert!(std::fs::metadata(&partial).unwrap().len() > 16 << 20, "behind room");
        }
        writer.fill(|batch| {
            s::push(batch, 2, ALL);
            let contact = s::contacts(0)[0];
            let noise = |i: usize, k: usize| libm::sin((12 * i + k) as f64 * 12.9898) * 43758.5453;
            batch.contacts.extend((0..CONTACTS).map(|i| gotai::record::sample::ContactSample {
                point_m: [0, 1, 2].map(|k| noise(i, k)),
                normal: [3, 4, 5].map(|k| noise(i, k)),
                force_n: [6, 7, 8].map(|k| noise(i, k)),
                ..contact
            }));
            if let Some(count) = batch.contacts_len.last_mut() {
                *count += CONTACTS as u32;
            }
        });
        if is_looked_at {
            soon(&partial, s::time_s(2));
        }
        writer.finish(s::ending()).unwrap();
        std::fs::read(Target::Mcap.path(folder.path(), s::NAME)).unwrap()
    };
    let (looked_at, alone) = (written(true), written(false));
    assert!(looked_at.len() > 16 << 20 && looked_at == alone, "{}", looked_at.len());
}

/// An .rrd has its layout while its run goes on, and one of its own at the end.
#[cfg(feature = "rerun")]
#[test]
fn a_recording_is_laid_out_whenever_it_is_cut() {
    let folder = scratch::folder();
    let header = header(1);
    let mut writer = open(&[Target::Rerun], folder.path(), None, &header).unwrap();
    let partial = folder.path().join(format!("{}.partial.rrd", header.case));
    let layouts = |path: &Path| super::rerun::layouts(path);
    fill(&mut writer, 0..1, 1);
    writer.flush();
    soon(&partial, 0.0);
    let since = Instant::now();
    while layouts(&partial) != 1 {
        assert!(since.elapsed() < Duration::from_secs(20), "ahead: {}", layouts(&partial));
    }
    for i in 1..5 {
        fill(&mut writer, i..i + 1, 1);
        writer.flush();
    }
    soon(&partial, s::time_s(4));
    let since = Instant::now();
    while layouts(&partial) != 1 {
        assert!(since.elapsed() < Duration::from_secs(20), "written: {}", layouts(&partial));
    }
    writer.finish(s::ending()).unwrap();
    assert_eq!(layouts(&Target::Rerun.path(folder.path(), s::NAME)), 2);
}
