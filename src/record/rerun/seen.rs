//! What a recording has seen when it ends: how far the bodies came, along which ways, and between which values the
//! plots lie. Bounded memory, whatever the length.

use crate::record::sample::{Header, Sample, norm};

/// Most boxes in time, and most points of a way; when they are full, two become one.
const MOST_BOXES: usize = 512;
const MOST_POINTS: usize = 1024;
/// Most bodies whose ways are drawn: more are a tangle.
const MOST_WAYS: usize = 24;

/// Least part of the energy at the start that has a logarithm on the plot.
const LEAST_PART: f64 = 1e-6;

/// Decimal logarithm of an energy as a part of the start's.
pub fn log_part(energy_j: f64, start_j: Option<f64>) -> Option<f64> {
    let part = energy_j / start_j?;
    part.is_finite().then(|| libm::log10(part.max(LEAST_PART)))
}

/// Smallest and largest value; the first is larger than the second where there is none.
#[derive(Clone, Copy, Debug)]
pub struct Between {
    pub least: f64,
    pub most: f64,
}

impl Between {
    const NOTHING: Between = Between { least: f64::INFINITY, most: f64::NEG_INFINITY };

    fn add(&mut self, x: f64) {
        if x.is_finite() {
            self.least = self.least.min(x);
            self.most = self.most.max(x);
        }
    }

    pub fn is_empty(self) -> bool {
        self.least > self.most
    }
}

/// Room that is taken in a stretch of time.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    from_s: f64,
    pub low: [f64; 3],
    pub high: [f64; 3],
}

impl Room {
    pub fn with(self, other: Room) -> Room {
        Room {
            from_s: self.from_s.min(other.from_s),
            low: std::array::from_fn(|i| self.low[i].min(other.low[i])),
            high: std::array::from_fn(|i| self.high[i].max(other.high[i])),
        }
    }
}

/// What was seen so far.
pub struct Seen {
    radii_m: Vec<f64>,
    rooms: Vec<Room>,
    /// Number of samples in a full room, and in the last one.
    in_a_room: usize,
    in_the_last: usize,
    ways: Vec<Vec<[f32; 3]>>,
    /// Number of samples from one point of a way to the next, and since the last.
    stride: usize,
    since: usize,
    pub samples: usize,
    /// Total energy of the first sample and of the last.
    totals_j: [f64; 2],
    /// Of kinetic, potential and total energy, and of the total alone.
    pub energy_j: Between,
    pub total_j: Between,
    pub log_energy: Between,
    pub contacts: Between,
    pub force_n: Between,
    pub friction_use: Between,
    pub penetration_m: Between,
}

impl Seen {
    pub fn new(header: &Header) -> Self {
        let ways = if header.bodies.len() <= MOST_WAYS { header.bodies.len() } else { 0 };
        Seen {
            radii_m: header.bodies.iter().map(|body| body.bounding_radius_m).collect(),
            rooms: Vec::new(),
            in_a_room: 1,
            in_the_last: 0,
            ways: vec![Vec::new(); ways],
            stride: 1,
            since: 0,
            samples: 0,
            totals_j: [0.0; 2],
            energy_j: Between::NOTHING,
            total_j: Between::NOTHING,
            log_energy: Between::NOTHING,
            contacts: Between::NOTHING,
            force_n: Between::NOTHING,
            friction_use: Between::NOTHING,
            penetration_m: Between::NOTHING,
        }
    }

    pub fn look(&mut self, sample: &Sample<'_>, log_energy: Option<f64>) {
        self.samples += 1;
        self.place(sample);
        self.contacts.add(sample.contacts.len() as f64);
        self.force_n.add(sample.contacts.iter().map(|contact| norm(contact.force_n)).sum());
        for contact in sample.contacts {
            self.friction_use.add(contact.friction_use);
        }
        if let Some(energy) = sample.energy {
            for x in [energy.kinetic_j, energy.potential_j, energy.total_j] {
                self.energy_j.add(x);
            }
            self.total_j.add(energy.total_j);
            self.penetration_m.add(energy.penetration_m);
            if self.samples == 1 {
                self.totals_j[0] = energy.total_j;
            }
            self.totals_j[1] = energy.total_j;
        }
        if let Some(x) = log_energy {
            self.log_energy.add(x);
        }
    }

    /// Whether there is less energy at the end than at the start.
    pub fn falls(&self) -> bool {
        self.totals_j[1] < self.totals_j[0]
    }

    /// Room that the bodies take up to a time, from the start on.
    pub fn room_until(&self, time_s: f64) -> Option<Room> {
        let first = self.rooms.first().copied();
        self.rooms
            .iter()
            .skip(1)
            .filter(|room| room.from_s <= time_s)
            .fold(first, |all, room| Some(all.map_or(*room, |all| all.with(*room))))
    }

    /// The ways of the centres of mass; none of a body that has not moved by more than a part of its size.
    pub fn ways(&self) -> impl Iterator<Item = (usize, &[[f32; 3]])> {
        self.ways.iter().map(Vec::as_slice).enumerate().filter(|(i, way)| {
            let far = |p: &&[f32; 3]| {
                norm(std::array::from_fn(|k| f64::from(p[k]) - f64::from(way[0][k]))) > 0.2 * self.radii_m[*i]
            };
            way.len() > 1 && way.iter().any(|p| far(&p))
        })
    }

    fn place(&mut self, sample: &Sample<'_>) {
        let of_body = |(body, &r): (&crate::rows::BodyRow, &f64)| {
            let p = body.position_m;
            p.iter().all(|x| x.is_finite()).then(|| Room {
                from_s: sample.time_s,
                low: p.map(|x| x - r),
                high: p.map(|x| x + r),
            })
        };
        let all = sample.bodies.iter().zip(&self.radii_m).filter_map(of_body).reduce(Room::with);
        if let Some(room) = all {
            match self.rooms.last_mut().filter(|_| self.in_the_last < self.in_a_room && self.samples > 2) {
                Some(last) => *last = last.with(room),
                None => {
                    self.rooms.push(room);
                    self.in_the_last = 0;
                }
            }
            self.in_the_last += 1;
            if self.rooms.len() > MOST_BOXES {
                let joined = |pair: &[Room]| pair.iter().copied().reduce(Room::with);
                self.rooms = self.rooms.chunks(2).filter_map(joined).collect();
                self.in_a_room *= 2;
            }
        }
        self.since += 1;
        if self.since >= self.stride {
            self.since = 0;
            for (way, body) in self.ways.iter_mut().zip(sample.bodies) {
                if body.position_m.iter().all(|x| x.is_finite()) {
                    way.push(body.position_m.map(|x| x as f32));
                }
            }
            if self.ways.iter().any(|way| way.len() > MOST_POINTS) {
                for way in &mut self.ways {
                    let mut keep = false;
                    way.retain(|_| {
                        keep = !keep;
                        keep
                    });
                }
                self.stride *= 2;
            }
        }
    }
}
