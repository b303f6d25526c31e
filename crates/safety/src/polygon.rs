//! A convex polygon of commands whose edges know which constraint they are of.

use crate::half_plane::{HalfPlane, dot};

/// A corner, and the constraint of the edge that leads from it to the next corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Vertex {
    pub(crate) at: [f64; 2],
    /// Index of a constraint.
    pub(crate) edge: usize,
}

/// Corners counter-clockwise; a point and a segment have one and two.
#[derive(Debug, Clone, Default)]
pub(crate) struct Polygon {
    pub(crate) vertices: Vec<Vertex>,
    spare: Vec<Vertex>,
}

impl Polygon {
    /// A box [[a from, a to], [ω from, ω to]], its edges those of constraints 0 (a from), 1 (ω from), 2 (a to), 3 (ω to).
    pub(crate) fn set_box(&mut self, [[a0, a1], [w0, w1]]: [[f64; 2]; 2]) {
        self.vertices.clear();
        let corners = [([a0, w0], 1), ([a1, w0], 2), ([a1, w1], 3), ([a0, w1], 0)];
        self.vertices.extend(corners.map(|(at, edge)| Vertex { at, edge }));
    }

    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.vertices.clone_from(&other.vertices);
    }

    /// Leaves what `half_plane` allows once its bound is lowered by `relax`; its edge is that of constraint `index`. Where
    /// nothing would be left, the polygon stays, and the constraints of the two edges at its best corner are returned.
    pub(crate) fn cut(&mut self, half_plane: &HalfPlane, relax: f64, index: usize) -> Result<(), [usize; 2]> {
        let Self { vertices, spare } = self;
        let bound = half_plane.bound - relax;
        let side = |vertex: &Vertex| dot(half_plane.normal, vertex.at) - bound;
        let count = vertices.len();
        let best = (0..count).max_by(|a, b| side(&vertices[*a]).total_cmp(&side(&vertices[*b])));
        let Some(best) = best else { return Err([index; 2]) };
        if side(&vertices[best]) < 0.0 {
            return Err([vertices[best].edge, vertices[(best + count - 1) % count].edge]);
        }
        spare.clear();
        for (k, from) in vertices.iter().enumerate() {
            let to = &vertices[(k + 1) % count];
            let (s0, s1) = (side(from), side(to));
            if s0 >= 0.0 {
                spare.push(*from);
            }
            if (s0 >= 0.0) != (s1 >= 0.0) {
                let share = s0 / (s0 - s1);
                let at = [0, 1].map(|i| from.at[i] + share * (to.at[i] - from.at[i]));
                // Going out, the cut begins here; coming in, the rest of this edge does.
                spare.push(Vertex { at, edge: if s0 >= 0.0 { index } else { from.edge } });
            }
        }
        std::mem::swap(vertices, spare);
        Ok(())
    }

    /// The point nearest to `wish` where a difference in ω counts `weight` times one in a, its distance, and the edges
    /// that it lies on; no edges where the wish is inside.
    pub(crate) fn project(&self, wish: [f64; 2], weight: f64) -> ([f64; 2], f64, [Option<usize>; 2]) {
        let stretch = |p: [f64; 2]| [p[0], p[1] * weight];
        let (goal, count) = (stretch(wish), self.vertices.len());
        let mut inside = count > 2;
        let mut best = (f64::INFINITY, wish, [None; 2]);
        for (k, vertex) in self.vertices.iter().enumerate() {
            let next = &self.vertices[(k + 1) % count];
            let (from, to) = (stretch(vertex.at), stretch(next.at));
            let along = [to[0] - from[0], to[1] - from[1]];
            let off = [goal[0] - from[0], goal[1] - from[1]];
            inside &= crate::half_plane::cross(along, off) >= 0.0;
            let length = dot(along, along);
            let share = if length > 0.0 { (dot(off, along) / length).clamp(0.0, 1.0) } else { 0.0 };
            let miss = [off[0] - share * along[0], off[1] - share * along[1]];
            let distance = dot(miss, miss);
            if distance < best.0 {
                let at = [0, 1].map(|i| vertex.at[i] + share * (next.at[i] - vertex.at[i]));
                let other = match share {
                    s if s <= 0.0 => Some(self.vertices[(k + count - 1) % count].edge),
                    s if s >= 1.0 => Some(next.edge),
                    _ => None,
                };
                best = (distance, at, [Some(vertex.edge), other.filter(|edge| *edge != vertex.edge)]);
            }
        }
        if inside { (wish, 0.0, [None; 2]) } else { (best.1, best.0.sqrt(), best.2) }
    }
}
