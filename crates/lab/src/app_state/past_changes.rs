//! Writes those changes of a scene that are past at some time into its values: an edit during a run continues from the
//! current values, not from the initial ones.

use scene::{EditError, Scene, SceneText};

/// Changes that are past.
pub(crate) struct PastChanges {
    set: Vec<String>,
    time: f64,
}

impl PastChanges {
    /// The changes of `scene` that hold at `time`, s.
    pub(crate) fn of(scene: &Scene, time: f64) -> Self {
        let due = scene.changes.iter().filter(|change| change.at <= time + 1e-9);
        Self { set: due.flat_map(|change| change.set.iter().cloned()).collect(), time }
    }

    /// Writes them as initial values and removes them from the changes.
    ///
    /// # Errors
    /// Why the text cannot be edited.
    pub(crate) fn settle(&self, text: &mut SceneText) -> Result<(), EditError> {
        if self.set.is_empty() {
            return Ok(());
        }
        for set in &self.set {
            let (path, value) = set.split_once('=').unwrap_or((set, ""));
            text.set(path, value)?;
        }
        for item in (0..text.count("changes")).rev() {
            let at = text.get(&format!("changes.{item}.at")).and_then(|at| at.parse::<f64>().ok());
            if at.is_some_and(|at| at <= self.time + 1e-9) {
                text.remove_item("changes", &item.to_string())?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_past_is_written_where_it_holds_and_what_is_to_come_stays() {
        let text = "schema = 1\ntitle = \"t\"\n[time]\nduration = 9.0\n[[robots]]\nname = \"a\"\npose = [0, 0, 0]\n\
            path = { kind = \"constant\", speed = 1.0 }\n[[robots]]\nname = \"b\"\npose = [-2, -1, 0]\nleader = \"a\"\n\
            distance = 2.0 # mine\nbearing = \"-135 deg\"\n\
            [[changes]]\nat = 2.0\nset = [\"robots.b.distance=1.5\"]\n\
            [[changes]]\nat = 4.0\nset = [\"robots.b.distance=3.0\"]\n";
        let scene = Scene::parse(text, "past.toml", &[]).expect("a scene").scene;
        let mut edited = SceneText::parse(text).expect("text");
        PastChanges::of(&scene, 2.5).settle(&mut edited).expect("settled");
        let text = edited.text();
        assert!(text.contains("distance = 1.5 # mine") && !text.contains("at = 2.0"), "{text}");
        let scene = Scene::parse(&text, "past.toml", &[]).expect("still a scene").scene;
        assert_eq!(scene.changes.len(), 1);
    }
}
