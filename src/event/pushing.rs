//! Of contacts that share forces the smallest ones, none of which pulls, if there are such: which of them press decides
//! how a slab that spins is slowed.
//!
//! They hold all that is to be held, those as well that press no more. Where there are none, the law is asked (`law`).

use super::forces::{CONSISTENT, Gathered, Rows, Solved, Unknown, matrix, right_side, solution, unknowns};
use crate::math::few::Few;
use crate::math::full_pivot::{Numbers, Selection, Square, amax};
use crate::math::not_negative::not_zero;
use crate::solve::Impulse;
use nalgebra::Vector3;

/// Unknowns of contacts that share bodies, of which none slides with friction: of more, this costs more than the law,
/// and how they share their forces does not matter to the motion.
const FEW: usize = 40;

impl Gathered {
    /// Of these rows, which all forces hold, by the contacts' alone that push. Each island by itself.
    pub(super) fn push_only(&self, rows: &[Rows], mut all: Solved, contacts: usize) -> Solved {
        if all.p.iter().take(contacts).all(|p| p.x >= 0.0) {
            return all;
        }
        let mut changed = false;
        for island in &self.islands {
            let own: Few<usize> = island.iter().copied().filter(|i| *i < contacts).collect();
            if own.iter().all(|i| all.p[*i].x >= 0.0) {
                continue;
            }
            let slides = |i: &usize| matches!(rows[*i], Rows::Normal(edge) if edge != Vector3::x());
            let unknowns = unknowns(island, rows);
            if (unknowns.len() <= FEW || own.iter().any(slides))
                && let Some(p) = self.push_only_of(&own, &unknowns)
            {
                island.iter().for_each(|i| all.p[*i] = p[*i]);
                changed = true;
            }
        }
        if changed { self.solved(all.p, true) } else { all }
    }

    /// None: the contacts cannot hold them so.
    fn push_only_of(&self, own: &[usize], unknowns: &[Unknown]) -> Option<Few<Impulse>> {
        let K = matrix(&self.problem, unknowns, self.deadline)?;
        let y = right_side(&self.problem, unknowns);
        let free: Few<bool> = unknowns.iter().map(|of| of.row > 0 || !own.contains(&of.block)).collect();
        let not_zero = not_zero(&K, &y, &free, self.deadline)?;
        let mut left_out: Few<usize> =
            unknowns.iter().zip(&not_zero).filter(|(_, is)| !**is).map(|(of, _)| of.block).collect();
        for _ in own {
            let mut p = self.no_forces();
            self.hold_without(&left_out, (unknowns, &K), &y, &mut p)?;
            let worst = own.iter().copied().min_by(|a, b| p[*a].x.total_cmp(&p[*b].x))?;
            if p[worst].x >= 0.0 {
                return Some(p);
            }
            left_out.push(worst);
        }
        None
    }

    /// Adds the smallest forces that take so much from every row, without those of some blocks. None: there are none.
    pub(super) fn hold_without(
        &self,
        left_out: &[usize],
        (unknowns, K): (&[Unknown], &Square),
        y: &Numbers,
        p: &mut [Impulse],
    ) -> Option<()> {
        let mut K = K.clone();
        for (c, _) in unknowns.iter().enumerate().filter(|(_, of)| left_out.contains(&of.block)) {
            K.clear(c);
        }
        let (x, missed) = solution(&K, y, Selection::Least, self.deadline)?;
        unknowns.iter().zip(&x).for_each(|(of, x)| p[of.block] += of.along * *x);
        let largest = p.iter().map(|p| p.amax()).fold(0.0, f64::max);
        let all = amax(&right_side(&self.problem, unknowns)) + K.amax() * largest.max(amax(&x));
        (missed <= CONSISTENT * all).then_some(())
    }
}
