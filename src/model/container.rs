//! Containers: faces that bodies hit, normals inward (L18). Coplanar triangles of a wall are one face.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// Half-space n·x ≥ offset, which is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// Unit normal, inward.
    pub normal: Vector3<f64>,
    pub offset_m: f64,
}

impl Face {
    /// Gap of a point, the slide's n·(u_c − u_p): negative outside.
    pub fn gap_m(&self, point: &Vector3<f64>) -> f64 {
        self.normal.dot(point) - self.offset_m
    }
}

/// Faces in the order of the contacts: for a box floor, ceiling, then the walls.
#[derive(Clone, Debug, PartialEq)]
pub struct Container {
    pub faces: Vec<Face>,
}

impl Container {
    pub fn new_box(size_m: [f64; 3], center_m: [f64; 3]) -> Self {
        let face = |axis: usize, sign: f64| Face {
            normal: Vector3::ith(axis, sign),
            offset_m: sign * center_m[axis] - size_m[axis] / 2.0,
        };
        Container { faces: [1, 0, 2].into_iter().flat_map(|axis| [face(axis, 1.0), face(axis, -1.0)]).collect() }
    }

    /// The face whose normal is most upward, the first of equals.
    pub fn floor(&self, up: &Vector3<f64>) -> Option<&Face> {
        self.faces.iter().reduce(|best, face| if face.normal.dot(up) > best.normal.dot(up) { face } else { best })
    }

    /// Least value of up·x inside, if the container is closed below.
    ///
    /// A linear programme, solved by its dual: the largest Σ λᵢ offsetᵢ over the λ ≥ 0 of at most three faces with
    /// up = Σ λᵢ nᵢ.
    pub fn lowest_m(&self, up: &Vector3<f64>) -> Option<f64> {
        let n = self.faces.len();
        let mut best: Option<f64> = None;
        let mut consider = |faces: &[usize]| {
            if let Some(height) = self.height_held_by(faces, up) {
                best = Some(best.map_or(height, |b| b.max(height)));
            }
        };
        for i in 0..n {
            consider(&[i]);
            for j in i + 1..n {
                consider(&[i, j]);
                for k in j + 1..n {
                    consider(&[i, j, k]);
                }
            }
        }
        best
    }

    /// Σ λᵢ offsetᵢ, if up is a non-negative combination of just these normals.
    fn height_held_by(&self, faces: &[usize], up: &Vector3<f64>) -> Option<f64> {
        let normal = |i: usize| self.faces[faces[i]].normal;
        let weights: Vec<f64> = match faces.len() {
            1 => vec![normal(0).dot(up)],
            2 => {
                let c = normal(0).dot(&normal(1));
                let rhs = Vector2::new(normal(0).dot(up), normal(1).dot(up));
                let w = Matrix2::new(1.0, c, c, 1.0).try_inverse()? * rhs;
                vec![w.x, w.y]
            }
            _ => {
                let w = Matrix3::from_columns(&[normal(0), normal(1), normal(2)]).try_inverse()? * up;
                vec![w.x, w.y, w.z]
            }
        };
        let rounding = 1e-12;
        let sum: Vector3<f64> = weights.iter().enumerate().map(|(i, w)| normal(i) * *w).sum();
        let holds = weights.iter().all(|w| *w >= -rounding) && (sum - up).norm() <= rounding * up.norm().max(1.0);
        holds.then(|| weights.iter().zip(faces).map(|(w, &f)| w * self.faces[f].offset_m).sum())
    }
}
