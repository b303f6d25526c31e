//! `echelon` alone: a helpful start.

use crate::print::say;

const TEXT: &str = "Echelon, a 3D laboratory for vehicle formations

A first film, and what the run showed:
  echelon film scenes/circle-three.toml -o film.mp4
  echelon run scenes/circle-three.toml

Pictures at 0, 5 and 15 s, from behind and from above:
  echelon capture scenes/seven-v.toml --at 0,5,15 --view snake+top -o pictures

Change something:
  echelon run scenes/circle-three.toml --set law.k=3 --set observer.epsilon=0.1

More: `echelon --help`, `echelon film --help`, `echelon doctor` if drawing does not work.";

pub(crate) fn welcome() {
    say(TEXT);
}
