//! `echelon` alone: a helpful start.

use crate::print::say;

const TEXT: &str = "Echelon, a 3D laboratory for vehicle formations

A first film, and what the run showed:
  echelon film circle-three -o film.mp4
  echelon run circle-three

Pictures at 0, 5 and 15 s, from behind and from above:
  echelon capture seven-v --at 0,5,15 --view snake+top -o pictures

Change something:
  echelon run circle-three --set law.k=3 --set observer.epsilon=0.1

All scenes that come with the program, and one to start from:
  echelon scenes
  echelon scenes circle-three > mine.toml

More: `echelon --help`, `echelon film --help`, `echelon doctor` if drawing does not work.";

pub(crate) fn welcome() {
    say(TEXT);
}
