//! `echelon scenes`: what comes with the program.

use crate::Outcome;
use crate::failure::Failure;
use crate::print::{json, say, verbatim};
use clap::Args;
use scene::{SHIPPED, nearest_shipped, shipped};
use serde_json::json;

#[derive(Debug, Args)]
pub(crate) struct ScenesArgs {
    /// Print this scene, to start from: echelon scenes circle-three > mine.toml
    #[arg(value_name = "NAME")]
    name: Option<String>,
    /// Print names and titles as JSON
    #[arg(long, conflicts_with = "name")]
    json: bool,
}

pub(crate) fn scenes(args: &ScenesArgs) -> Outcome {
    if let Some(name) = &args.name {
        let Some(found) = shipped(name) else {
            let near =
                nearest_shipped(name).map_or_else(String::new, |near| format!(" (did you mean `{near}`?)"));
            let text =
                format!("no scene called `{name}` comes with the program{near}; `echelon scenes` lists them");
            return Err(Failure::Usage(text));
        };
        verbatim(found.text);
        return Ok(());
    }
    if args.json {
        let scene = |s: &scene::Shipped| json!({ "name": s.name, "title": s.title() });
        json(&SHIPPED.iter().map(scene).collect());
        return Ok(());
    }
    let widest = SHIPPED.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
    for scene in SHIPPED {
        say(&format!("{:widest$}  {}", scene.name, scene.title()));
    }
    Ok(())
}
