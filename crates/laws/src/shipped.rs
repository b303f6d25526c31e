//! The laws that come with the program.

/// A law that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShippedLaw {
    /// Its name: that of its file without the ending.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        /// All of them: those of the paper, then others.
        pub const SHIPPED_LAWS: &[ShippedLaw] = &[$(ShippedLaw {
            name: $name,
            text: include_str!(concat!("../../../laws/", $name, ".law")),
        }),*];
    };
}

shipped![
    "full-state",
    "robust-state",
    "output-feedback",
    "output-feedback-observer",
    "integral",
    "sliding-mode",
    "predictive",
    "two-distances",
];

/// The text with which a new law begins: it follows as it is, and shows every part of a law.
pub const TEMPLATE: &str = include_str!("template.law");

/// The law called `name` that comes with the program.
pub fn shipped(name: &str) -> Option<&'static ShippedLaw> {
    SHIPPED_LAWS.iter().find(|law| law.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CustomLaw, LawFile};
    use std::path::Path;

    #[test]
    fn every_law_of_the_folder_is_shipped() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../laws");
        let files = std::fs::read_dir(folder).expect("laws").flatten().map(|entry| entry.path());
        let mut names: Vec<String> = files
            .filter(|path| path.extension().is_some_and(|ending| ending == "law"))
            .filter_map(|path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()))
            .collect();
        names.sort();
        let mut listed: Vec<&str> = SHIPPED_LAWS.iter().map(|law| law.name).collect();
        listed.sort_unstable();
        assert_eq!(names, listed);
    }

    #[test]
    fn they_compile_and_say_what_they_are() {
        for law in SHIPPED_LAWS {
            let compiled = LawFile::compile(law.text).unwrap_or_else(|mistakes| {
                let lines: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
                panic!("{}:\n{}", law.name, lines.join("\n"))
            });
            let declaration = compiled.declaration();
            assert!(
                !declaration.title.is_empty() && declaration.parameters.iter().all(|p| !p.help.is_empty())
            );
            println!("{}: {} instructions at most", law.name, compiled.instructions());
        }
        assert_eq!(shipped("integral").map(|law| law.name), Some("integral"));
        assert_eq!(shipped("mine"), None);
    }
}
