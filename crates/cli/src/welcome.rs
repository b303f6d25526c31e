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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Program;
    use clap::Parser;

    /// Every line of the start is a command, and its scene comes with the program.
    #[test]
    fn the_commands_of_the_start_are_taken() {
        let lines: Vec<&str> = TEXT.lines().filter(|line| line.starts_with("  echelon ")).collect();
        assert!(lines.len() >= 5, "{lines:?}");
        for line in lines {
            let command = line.split('>').next().unwrap_or(line).split_whitespace();
            let parsed = Program::try_parse_from(command.clone());
            assert!(parsed.is_ok(), "{line}: {:?}", parsed.err());
            let named = command.skip(2).take_while(|word| !word.starts_with('-'));
            for name in named {
                assert!(scene::shipped(name).is_some(), "{line}: no scene is called {name}");
            }
        }
    }
}
