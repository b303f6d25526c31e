//! What happened to the formation lately, in words over the clock.

use crate::annotation::labels::{Ink, LabelPlacer};
use crate::picture_context::PictureContext;
use crate::picture_plan::Area;

/// An event is shown for the first of these times, and fades over the second, s.
const SHOWN: [f64; 2] = [5.0, 1.0];
/// Most events at once.
const MOST: usize = 3;
/// Size of the letters at scale 1, pixels.
const LETTERS: f32 = 15.0;

/// Writes what happened lately, the last event lowest, over the rectangle `clock`.
pub(crate) fn events(words: &mut LabelPlacer<'_>, context: &PictureContext<'_>, clock: Option<Area>) {
    let Some([x, y, ..]) = clock.filter(|_| context.style.events) else { return };
    let now = context.record.snapshot.time;
    let step = words.scaled(1.45 * LETTERS);
    let lately = context.trail.events.iter().rev().take(MOST);
    for (row, (time, event)) in lately.enumerate() {
        let age = now - time;
        if !(0.0..SHOWN[0] + SHOWN[1]).contains(&age) {
            continue;
        }
        let alpha = ((SHOWN[0] + SHOWN[1] - age) / SHOWN[1]).clamp(0.0, 1.0) as f32;
        let ink = if event.happened() { Ink::LIGHT } else { Ink::ALARM };
        let at = [x, y - step * (row as f32 + 0.6)];
        words.write(event.words(context.fleet), at, LETTERS, true, ink.faded(alpha));
    }
}
