//! Crowds: what looks the same is one entity with many places, since an entity has a head in every batch.

use super::names::{BODIES, body_path};
use crate::record::sample::Header;
use crate::record::schema;
use ::rerun::EntityPath;
use std::collections::BTreeMap;

/// Most bodies whose edges are drawn, and which have an entity each.
pub const EDGED_BODIES: usize = 400;

/// An entity, and the bodies that it shows.
pub struct DrawnBodies {
    pub path: EntityPath,
    pub bodies: Vec<usize>,
    pub colour: schema::Rgb,
}

/// What a body looks like: places of its corners, triangles, number of its colour.
type Look<'a> = (Vec<[u64; 3]>, &'a [[u32; 3]], usize);

/// Entities of the bodies: one each, up to as many as have their edges drawn; of more, one for all of a shape and
/// colour.
pub fn drawn_as(header: &Header) -> Vec<DrawnBodies> {
    let colours = schema::BODY_COLOURS;
    let own = |(i, body): (usize, &crate::record::sample::BodyHeader)| DrawnBodies {
        path: body_path(&body.name),
        bodies: vec![i],
        colour: colours[i % colours.len()],
    };
    if header.bodies.len() <= EDGED_BODIES {
        return header.bodies.iter().enumerate().map(own).collect();
    }
    let mut alike: BTreeMap<Look<'_>, Vec<usize>> = BTreeMap::new();
    for (i, body) in header.bodies.iter().enumerate() {
        let surface = body.vertices_m.iter().map(|v| v.map(f64::to_bits)).collect();
        alike.entry((surface, &body.triangles, i % colours.len())).or_default().push(i);
    }
    let mut groups: Vec<Vec<usize>> = alike.into_values().collect();
    groups.sort();
    let drawn = groups.into_iter().map(|bodies| {
        let first = bodies[0];
        let colour = colours[first % colours.len()];
        if let [only] = bodies[..] {
            return own((only, &header.bodies[only]));
        }
        let name = format!("{} and {} more", header.bodies[first].name, bodies.len() - 1);
        DrawnBodies { path: EntityPath::from(BODIES).join(&EntityPath::from_single_string(name)), bodies, colour }
    });
    drawn.collect()
}
