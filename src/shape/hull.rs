//! Convex polyhedra from their vertices.
//!
//! Every plane through three vertices that has all others on one side is a face, with all vertices on it: O(n³) planes,
//! most of them refuted after a few vertices. Slow beside incremental hulls and free of their degenerate cases:
//! coplanar triangles are one polygon from the start.

use nalgebra::Vector3;

/// Distance of vertices from a plane that they lie on, of the size, as far as a file's numbers can say.
const COPLANAR: f64 = 1e-9;
/// Most vertices: the number of planes grows with their cube.
pub const MOST_VERTICES: usize = 400;

#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    pub vertices: Vec<Vector3<f64>>,
    pub faces: Vec<Polygon>,
    /// Directions of the edges, unit, parallel ones once.
    pub edge_directions: Vec<Vector3<f64>>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Unit normal, outward.
    pub normal: Vector3<f64>,
    /// Vertex numbers, counter-clockwise seen from outside.
    pub corners: Vec<u32>,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HullError {
    #[error("{0} vertices")]
    Few(usize),
    #[error("{0} vertices")]
    Many(usize),
    #[error("vertices in one plane")]
    Flat,
    /// Vertex inside, on an edge or a face, or given twice.
    #[error("vertex {0} is no corner of the convex hull")]
    NotConvex(usize),
}

impl Hull {
    /// Hull of vertices, every one of which must be a corner of it.
    ///
    /// # Errors
    /// Too few or too many vertices, all in one plane, or one that is no corner.
    pub fn new(vertices: Vec<Vector3<f64>>) -> Result<Self, HullError> {
        match vertices.len() {
            n if n < 4 => return Err(HullError::Few(n)),
            n if n > MOST_VERTICES => return Err(HullError::Many(n)),
            _ => {}
        }
        let centre = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
        let size = vertices.iter().map(|v| (v - centre).norm()).fold(0.0, f64::max);
        let rounding = COPLANAR * size;
        let faces = faces(&vertices, rounding)?;
        let is_again = |i: &usize| vertices[..*i].iter().any(|v| (v - vertices[*i]).norm() <= rounding);
        if let Some(again) = (0..vertices.len()).find(is_again) {
            return Err(HullError::NotConvex(again));
        }
        let is_corner = |i: usize| faces.iter().any(|face| face.corners.contains(&(i as u32)));
        if let Some(inner) = (0..vertices.len()).find(|i| !is_corner(*i)) {
            return Err(HullError::NotConvex(inner));
        }
        let edge_directions = edge_directions(&vertices, &faces);
        Ok(Hull { vertices, faces, edge_directions })
    }

    /// Hull of triangles that are known to be its surface, counter-clockwise seen from outside.
    pub fn of_triangles(mut vertices: Vec<Vector3<f64>>, triangles: &[[u32; 3]]) -> Self {
        let used = triangles.iter().flatten().max().map_or(0, |last| *last as usize + 1);
        vertices.truncate(used);
        let face = |corners: &[u32; 3]| Polygon {
            normal: area_vector(&vertices, corners).normalize(),
            corners: corners.to_vec(),
        };
        let faces: Vec<_> = triangles.iter().map(face).collect();
        let once = triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).filter(|(a, b)| a < b);
        let along = |(a, b): (u32, u32)| (vertices[b as usize] - vertices[a as usize]).normalize();
        let edge_directions = once.map(along).collect();
        Hull { vertices, faces, edge_directions }
    }

    pub fn area_m2(&self) -> f64 {
        self.faces.iter().map(|face| 0.5 * self.area_vector(face).norm()).sum()
    }

    fn area_vector(&self, face: &Polygon) -> Vector3<f64> {
        area_vector(&self.vertices, &face.corners)
    }
}

/// Twice the area along the normal.
fn area_vector(vertices: &[Vector3<f64>], corners: &[u32]) -> Vector3<f64> {
    let at = |i: usize| vertices[corners[i] as usize];
    (1..corners.len() - 1).map(|i| (at(i) - at(0)).cross(&(at(i + 1) - at(0)))).sum()
}

fn faces(vertices: &[Vector3<f64>], rounding: f64) -> Result<Vec<Polygon>, HullError> {
    let mut faces: Vec<(Vec<usize>, Polygon)> = Vec::new();
    let n = vertices.len();
    for i in 0..n {
        for j in i + 1..n {
            for k in j + 1..n {
                let Some(normal) = outward(vertices, [i, j, k], rounding) else { continue };
                if faces.iter().any(|(on, _)| [i, j, k].iter().all(|v| on.contains(v))) {
                    continue;
                }
                let on: Vec<usize> =
                    (0..n).filter(|v| normal.dot(&(vertices[*v] - vertices[i])).abs() <= rounding).collect();
                if on.len() == n {
                    return Err(HullError::Flat);
                }
                let corners = polygon(vertices, &on, &normal, rounding);
                let normal = area_vector(vertices, &corners).normalize();
                faces.push((on, Polygon { normal, corners }));
            }
        }
    }
    if faces.is_empty() {
        return Err(HullError::Flat);
    }
    Ok(faces.into_iter().map(|(_, face)| face).collect())
}

/// Normal of the plane through three vertices, away from all others, if they are all on one side.
fn outward(vertices: &[Vector3<f64>], [i, j, k]: [usize; 3], rounding: f64) -> Option<Vector3<f64>> {
    let (u, v) = (vertices[j] - vertices[i], vertices[k] - vertices[i]);
    let across = u.cross(&v);
    let length = across.norm();
    // Vertices in a line span no plane.
    if length <= rounding * u.norm().max(v.norm()) {
        return None;
    }
    let normal = across / length;
    let (mut above, mut below) = (false, false);
    for vertex in vertices {
        let height = normal.dot(&(vertex - vertices[i]));
        above |= height > rounding;
        below |= height < -rounding;
        if above && below {
            return None;
        }
    }
    Some(if above { -normal } else { normal })
}

/// Corners of the convex hull of coplanar vertices, counter-clockwise about the normal (A. M. Andrew, Inf. Proc. Lett.
/// 9 (1979) 216).
fn polygon(vertices: &[Vector3<f64>], on: &[usize], normal: &Vector3<f64>, rounding: f64) -> Vec<u32> {
    let t1 = Vector3::ith(normal.iamin(), 1.0).cross(normal).normalize();
    let t2 = normal.cross(&t1);
    let flat = |i: usize| (t1.dot(&vertices[i]), t2.dot(&vertices[i]));
    let mut sorted = on.to_vec();
    sorted.sort_by(|a, b| {
        let (a, b) = (flat(*a), flat(*b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let bends = |a: usize, b: usize, c: usize| {
        let ((ax, ay), (bx, by), (cx, cy)) = (flat(a), flat(b), flat(c));
        let (ux, uy, vx, vy) = (bx - ax, by - ay, cx - ax, cy - ay);
        ux * vy - uy * vx > rounding * (vx * vx + vy * vy).sqrt()
    };
    let half = |order: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for next in order {
            while chain.len() > 1 && !bends(chain[chain.len() - 2], chain[chain.len() - 1], next) {
                chain.pop();
            }
            chain.push(next);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut sorted.iter().copied());
    let upper = half(&mut sorted.iter().rev().copied());
    let mut corners: Vec<usize> = lower.into_iter().chain(upper).collect();
    // The ends of the chains were corners by their place in the order, which on an edge along t2 is rounding's.
    let count = corners.len();
    let is_corner: Vec<bool> =
        (0..count).map(|i| bends(corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count])).collect();
    let mut is_corner = is_corner.into_iter();
    corners.retain(|_| is_corner.next() == Some(true));
    corners.into_iter().map(|i| i as u32).collect()
}

fn edge_directions(vertices: &[Vector3<f64>], faces: &[Polygon]) -> Vec<Vector3<f64>> {
    let mut directions: Vec<Vector3<f64>> = Vec::new();
    for face in faces {
        for (i, from) in face.corners.iter().enumerate() {
            let to = face.corners[(i + 1) % face.corners.len()];
            let along = (vertices[to as usize] - vertices[*from as usize]).normalize();
            if directions.iter().all(|known| known.cross(&along).norm() > COPLANAR) {
                directions.push(along);
            }
        }
    }
    directions
}
