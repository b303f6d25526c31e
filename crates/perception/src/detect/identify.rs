//! Which of the tags found are faces of a shell.

use super::Tag;
use crate::pose::{SeenFace, area};
use vocabulary::{FACES, Shell, math};

/// Sides shorter than this, pixels, cannot have been read: eight cells of a pixel.
const SHORTEST_SIDE: f64 = 8.0;

/// The longest side of a tag's picture is at most so many times the shortest: beyond 75° there is nothing to read.
const MOST_SLANTED: f64 = 6.0;

/// Robots stand upright: a tag's left side points down in the picture, within this angle (its cosine is 0.5).
const UPRIGHT: f64 = 0.5;

/// The tags that are faces of `shell`, by face: upright, convex, of a sensible size, and neighbours of one another. Of a
/// face that is seen twice, and of faces that are no neighbours, the larger picture counts.
pub fn identify(tags: &[Tag], shell: &Shell) -> Vec<SeenFace> {
    let mut best: [Option<SeenFace>; FACES] = [None; FACES];
    for tag in tags.iter().filter(|tag| sensible(&tag.corners)) {
        let Some(face) = shell.face_of(tag.id) else { continue };
        let Some(slot) = best.get_mut(face) else { continue };
        if slot.is_none_or(|known: SeenFace| area(&known.corners) < area(&tag.corners)) {
            *slot = Some(SeenFace { face, corners: tag.corners, deviation: tag.deviation });
        }
    }
    // Runs of neighbours: the faces' row has ends, for the front of the octagon is cut away.
    let runs = best.split(Option::is_none).map(|run| run.iter().flatten().copied().collect::<Vec<_>>());
    let weight = |run: &[SeenFace]| run.iter().map(|seen| area(&seen.corners)).sum::<f64>();
    let run = runs.max_by(|a, b| a.len().cmp(&b.len()).then(weight(a).total_cmp(&weight(b))));
    run.unwrap_or_default()
}

fn sensible(corners: &[[f64; 2]; 4]) -> bool {
    let side = |k: usize| {
        let ([a, b], [c, d]) = (corners[k % 4], corners[(k + 1) % 4]);
        [c - a, d - b]
    };
    let lengths = [0, 1, 2, 3].map(|k| math::hypot(side(k)[0], side(k)[1]));
    let (short, long) =
        lengths.iter().fold((f64::INFINITY, 0.0_f64), |(short, long), l| (short.min(*l), long.max(*l)));
    let convex = (0..4).all(|k| {
        let ([a, b], [c, d]) = (side(k), side(k + 1));
        a * d - b * c > 0.0
    });
    // From the bottom left corner up to the top left one.
    let upright = -side(3)[1] > UPRIGHT * lengths[3];
    convex && upright && short >= SHORTEST_SIDE && long <= MOST_SLANTED * short
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tag(id: u16, x: f64, size: f64) -> Tag {
        let corners = [[x, 10.0], [x + size, 10.0], [x + size, 10.0 + size], [x, 10.0 + size]];
        Tag { id, corners, deviation: 0.0 }
    }

    fn faces(tags: &[Tag]) -> Vec<usize> {
        identify(tags, &Shell::PAPER.tagged(2)).iter().map(|seen| seen.face).collect()
    }

    #[test]
    fn only_the_shells_own_faces_count() {
        assert_eq!(faces(&[tag(11, 0.0, 20.0), tag(12, 30.0, 20.0), tag(15, 60.0, 20.0)]), [1, 2]);
        assert!(identify(&[tag(11, 0.0, 20.0)], &Shell::PAPER).is_empty());
    }

    #[test]
    fn a_face_that_is_no_neighbour_is_dropped() {
        assert_eq!(faces(&[tag(10, 0.0, 20.0), tag(12, 30.0, 20.0), tag(13, 60.0, 20.0)]), [2, 3]);
        assert_eq!(faces(&[tag(10, 0.0, 20.0), tag(14, 30.0, 24.0)]), [4]);
        assert_eq!(faces(&[tag(10, 0.0, 20.0), tag(10, 30.0, 24.0)]), [0]);
    }

    #[test]
    fn tags_stand_upright_and_are_squares_of_some_size() {
        let mut turned = tag(11, 0.0, 20.0);
        turned.corners.rotate_left(1);
        let mut mirrored = tag(11, 0.0, 20.0);
        mirrored.corners.reverse();
        let broken =
            Tag { corners: [[f64::NAN, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]], ..tag(11, 0.0, 20.0) };
        let bent =
            Tag { corners: [[15.0, 15.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0]], ..tag(11, 0.0, 20.0) };
        for tag in [turned, mirrored, broken, bent, tag(11, 0.0, 5.0)] {
            assert!(faces(&[tag]).is_empty(), "{tag:?}");
        }
    }
}
