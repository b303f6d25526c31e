//! Every shipped scene runs as it ran before: its digest is the one written down in `digests.txt`, on every machine.
//! `scripts/everywhere` holds other processors against the same file.

use digests::DigestRun;
use std::path::Path;

/// `UPDATE_DIGESTS=1` writes the file anew.
#[test]
fn shipped_scenes_run_as_before_on_every_machine() {
    let cases = digests::cases();
    let lines: Vec<String> = std::thread::scope(|scope| {
        let run = |part: &'static [DigestRun]| {
            scope.spawn(move || part.iter().map(|case| case.line().expect("it runs")).collect::<Vec<_>>())
        };
        let work: Vec<_> = cases.leak().chunks(16).map(run).collect();
        work.into_iter().flat_map(|thread| thread.join().expect("it ran")).collect()
    });
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/digests.txt");
    if std::env::var_os("UPDATE_DIGESTS").is_some() {
        std::fs::write(&path, lines.join("\n") + "\n").expect("digests.txt");
    }
    let written = std::fs::read_to_string(&path).expect("digests.txt");
    let written: Vec<&str> = written.lines().collect();
    assert_eq!(written.len(), lines.len(), "another number of scenes than in digests.txt");
    for (before, now) in written.iter().zip(&lines) {
        assert_eq!(before, now);
    }
}
