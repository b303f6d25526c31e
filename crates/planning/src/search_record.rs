//! What a search looked at, for pictures of it.

use crate::leg::Leg;

/// What a search looked at; empty unless its effort asks for it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SearchRecord {
    /// Where steps ended that were swept, m.
    pub tried: Vec<[f64; 2]>,
    /// Ways of the lead that were found and put aside for a better one, m.
    pub rejected: Vec<Vec<[f64; 2]>>,
}

/// Points of a way that is put aside are so far apart, m.
const SPACING: f64 = 0.25;

impl SearchRecord {
    /// Puts a way aside.
    pub(crate) fn reject(&mut self, legs: &[Leg]) {
        let track = legs.iter().flat_map(|leg| {
            let ends = leg.pieces(SPACING).map(|piece| [piece.end.x, piece.end.y]).collect::<Vec<_>>();
            std::iter::once([leg.start.x, leg.start.y]).chain(ends)
        });
        self.rejected.push(track.collect());
    }

    /// Adds what another search looked at.
    pub fn extend(&mut self, other: &Self) {
        self.tried.extend(&other.tried);
        self.rejected.extend(other.rejected.iter().cloned());
    }
}
