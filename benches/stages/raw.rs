//! The same numbers by the libraries alone, as somebody would write them who records nothing else: what recordings are
//! measured against.

use gotai::record::sample::{Batch, Sample};
use gotai::record::schema::{self, Bodies, BodyState, Contact, Contacts, Energy};
use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions};
use prost::Message;
use rerun::{Arrows3D, Color, Points3D, RecordingStreamBuilder, Scalars, TimeColumn, Transform3D};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// Messages of our schema in chunks of zstd, no pictures.
pub fn mcap(path: &Path, batches: &[Batch]) {
    let options = WriteOptions::new().compression(Some(Compression::Zstd)).compression_level(1).compression_threads(0);
    let options = options.chunk_size(Some(256 * 1024));
    let mut writer = options.create(BufWriter::new(File::create(path).unwrap())).unwrap();
    let set = schema::descriptor_set();
    let channels = ["Bodies", "Contacts", "Energy"].map(|name| {
        let id = writer.add_schema(&format!("gotai.{name}"), "protobuf", &set).unwrap();
        writer.add_channel(id, name, "protobuf", &BTreeMap::new()).unwrap()
    });
    let mut buffer = Vec::new();
    let mut send = |channel_id: u16, sample: &Sample<'_>, message: &dyn Fn(&mut Vec<u8>)| {
        buffer.clear();
        message(&mut buffer);
        let time_ns = schema::time_ns(sample.time_s);
        let header =
            MessageHeader { channel_id, sequence: sample.step as u32, log_time: time_ns, publish_time: time_ns };
        writer.write_to_known_channel(&header, &buffer).unwrap();
    };
    for sample in batches.iter().flat_map(Batch::samples) {
        let (time_s, step) = (sample.time_s, sample.step);
        let of_body = |body: &gotai::rows::BodyRow| BodyState {
            name: "cube[0]".to_owned(),
            position_m: body.position_m.to_vec(),
            orientation_xyzw: body.orientation_xyzw.to_vec(),
            velocity_m_s: body.velocity_m_s.to_vec(),
            angular_velocity_rad_s: body.angular_velocity_rad_s.to_vec(),
        };
        let bodies = Bodies { time_s, step, bodies: sample.bodies.iter().map(of_body).collect() };
        send(channels[0], &sample, &|to| bodies.encode_raw(to));
        let of_contact = |contact: &gotai::record::sample::ContactSample| Contact {
            body: "cube[0]".to_owned(),
            other: "container".to_owned(),
            point_m: contact.point_m.to_vec(),
            normal: contact.normal.to_vec(),
            force_n: contact.force_n.to_vec(),
            gap_m: contact.gap_m,
            friction_use: contact.friction_use,
            mode: contact.mode.name().to_owned(),
        };
        let contacts: Vec<Contact> = sample.contacts.iter().map(of_contact).collect();
        let count = contacts.len() as u64;
        let contacts = Contacts { time_s, step, contacts, acted_s: sample.acted_s, acted: Vec::new(), count };
        send(channels[1], &sample, &|to| contacts.encode_raw(to));
        if let Some(e) = sample.energy {
            let (kinetic_j, potential_j, total_j) = (e.kinetic_j, e.potential_j, e.total_j);
            let energy = Energy { time_s, step, kinetic_j, potential_j, total_j, penetration_m: e.penetration_m };
            send(channels[2], &sample, &|to| energy.encode_raw(to));
        }
    }
    writer.finish().unwrap();
}

/// Columns of a thousand samples: pose, points, arrows, and the eight series.
pub fn rerun(path: &Path, batches: &[Batch]) {
    let stream = RecordingStreamBuilder::new("raw").save(path).unwrap();
    for batch in batches {
        let times = || {
            [
                TimeColumn::new_duration_nanos("sim_time", batch.time_s.iter().map(|&t| schema::time_ns(t) as i64)),
                TimeColumn::new_sequence("step", batch.step.iter().map(|&step| step as i64)),
            ]
        };
        let poses = Transform3D::update_fields()
            .with_many_translation(batch.bodies.iter().map(|body| body.position_m))
            .with_many_quaternion(batch.bodies.iter().map(|body| body.orientation_xyzw.map(|q| q as f32)));
        stream.send_columns("body", times(), poses.columns_of_unit_batches().unwrap()).unwrap();
        let lengths = || batch.contacts_len.iter().map(|&len| len as usize);
        let colours = batch.contacts.iter().map(|contact| schema::mode_colour(contact.mode));
        let points = Points3D::update_fields()
            .with_positions(batch.contacts.iter().map(|contact| contact.point_m))
            .with_colors(colours.map(|[r, g, b]| Color::from_rgb(r, g, b)));
        stream.send_columns("points", times(), points.columns(lengths()).unwrap()).unwrap();
        let both = batch.contacts.iter().flat_map(|contact| [1.0, -1.0].map(|sign| contact.force_n.map(|f| sign * f)));
        let arrows = Arrows3D::update_fields()
            .with_vectors(both)
            .with_origins(batch.contacts.iter().flat_map(|contact| [contact.point_m; 2]));
        stream.send_columns("arrows", times(), arrows.columns(lengths().map(|len| 2 * len)).unwrap()).unwrap();
        let series = |name: &str, values: Vec<f64>| {
            let scalars = Scalars::update_fields().with_scalars(values).columns_of_unit_batches().unwrap();
            stream.send_columns(name, times(), scalars).unwrap();
        };
        for of in schema::ENERGY_SERIES {
            series(of.name, batch.energy.iter().map(of.value).collect());
        }
        series("log", batch.energy.iter().map(|energy| energy.total_j.ln()).collect());
        series("count", batch.contacts_len.iter().map(|&len| f64::from(len)).collect());
        series("force", batch.samples().map(|sample| sample.contacts.iter().map(|c| c.force_n[1]).sum()).collect());
        series("use", batch.samples().map(|sample| sample.contacts[0].friction_use).collect());
    }
    stream.flush_blocking().unwrap();
}
