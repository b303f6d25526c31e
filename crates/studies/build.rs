//! Tells the program which commit it is built from, for the manifests of runs and studies.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=../../.git/HEAD");
    println!("cargo::rerun-if-changed=../../.git/refs/heads");
    let output = Command::new("git").args(["rev-parse", "--short=12", "HEAD"]).output();
    let commit = output.ok().filter(|o| o.status.success()).and_then(|o| String::from_utf8(o.stdout).ok());
    // Built from an archive there is no commit; the program then leaves it out.
    if let Some(commit) = commit {
        println!("cargo::rustc-env=ECHELON_COMMIT={}", commit.trim());
    }
}
