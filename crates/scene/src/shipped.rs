//! The scenes that come with the program.

use std::path::Path;

/// A scene that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Its name, which stands for it wherever a scene file is asked for.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl Shipped {
    /// The title in its text.
    pub fn title(&self) -> &'static str {
        let line = self.text.lines().find_map(|line| line.strip_prefix("title"));
        line.and_then(|rest| rest.split('"').nth(1)).unwrap_or("")
    }
}

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        /// All of them, the simplest first.
        pub const SHIPPED: &[Shipped] = &[$(Shipped {
            name: $name,
            text: include_str!(concat!("../../../scenes/", $name, ".toml")),
        }),*];
    };
}

shipped![
    "circle-three",
    "line-three",
    "seven-v",
    "figure-eight-seven",
    "moving-set-point",
    "peaking",
    "hundred",
    "change-places",
    "crossing",
    "tangled",
    "pillar",
    "gate-4",
    "gate-2",
    "gate-1.5",
    "gate-1.2",
    "maze-three",
    "warehouse-seven",
    "moving-obstacle",
    "dead-end",
    "two-formations",
    "chain-twenty",
    "stop-and-go",
    "stop-and-go-curve",
    "hand-over",
    "lost-robot",
    "merge-two-columns",
    "join",
    "two-leaders",
    "law-full-state",
    "law-robust-state",
    "law-output-feedback",
    "law-integral",
    "law-sliding-mode",
    "law-predictive",
    "cars-line-three",
    "cars-circle-three",
    "cars-seven-v",
    "cars-stop-and-go",
    "cars-stop-and-go-curve",
    "cars-slalom",
    "cars-yard",
    "cars-ramp",
    "cars-rough",
    "cars-crash",
    "cars-mixed",
    "cars-full-size",
    "cars-crossing",
    "cars-tangled",
    "cars-pillar",
    "cars-gate-4",
    "cars-gate-2",
    "cars-gate-1.5",
    "cars-gate-1.2",
    "cars-limit-cycle",
    "cars-hundred",
    "vision-line-three",
    "vision-circle-three",
    "vision-cars-line-three",
    "vision-cars-circle-three",
    "vision-seven-v",
    "vision-gate-three",
    "vision-gate-seven",
    "vision-occlusion",
    "vision-dropout",
    "vision-epsilon",
];

/// The shipped scene called `name`.
pub fn shipped(name: &str) -> Option<&'static Shipped> {
    SHIPPED.iter().find(|shipped| shipped.name == name)
}

/// What a scene is called by its path: the name of one that is shipped, or the name of its file without the ending.
pub fn scene_name(path: &Path) -> String {
    // Names of shipped scenes have no ending, but may have a point.
    let shipped = path.to_str().filter(|name| shipped(name).is_some()).map(str::to_owned);
    let stem = || path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    shipped.or_else(stem).unwrap_or_else(|| "scene".to_owned())
}

/// The name nearest to `given`, where one may be meant.
pub fn nearest_shipped(given: &str) -> Option<&'static str> {
    let scored = SHIPPED.iter().map(|shipped| (strsim::jaro_winkler(given, shipped.name), shipped.name));
    scored.filter(|(score, _)| *score > 0.85).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_of_the_folder_is_shipped_and_has_a_title() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
        let files = std::fs::read_dir(folder).expect("scenes").flatten().map(|entry| entry.path());
        let mut names: Vec<String> = files
            .filter_map(|path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()))
            .collect();
        names.sort();
        let mut listed: Vec<&str> = SHIPPED.iter().map(|shipped| shipped.name).collect();
        listed.sort_unstable();
        assert_eq!(names, listed);
        assert!(SHIPPED.iter().all(|shipped| !shipped.title().is_empty()));
    }

    #[test]
    fn a_scene_has_the_name_of_its_file_or_its_own() {
        for (path, name) in [
            ("gate-1.2", "gate-1.2"),
            ("a/gate-1.2.toml", "gate-1.2"),
            ("mine.toml", "mine"),
            ("..", "scene"),
        ] {
            assert_eq!(scene_name(Path::new(path)), name);
        }
    }

    #[test]
    fn a_name_that_is_nearly_one_is_found() {
        assert_eq!(nearest_shipped("circle-tree"), Some("circle-three"));
        assert_eq!(nearest_shipped("my-thesis"), None);
    }
}
