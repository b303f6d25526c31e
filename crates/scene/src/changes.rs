//! Changes while a run goes: each is put on top of what held before, and the robots are resolved and checked again.

use crate::{
    Change, Override, Robot, Role, Scene,
    document::{Document, GroupKeys, LeaderKeys, MOST_ROBOTS, MemberKeys, RobotKeys},
    overrides::Origin,
    resolve::resolve_robots,
    sets::{ParameterDifference, refusal},
    text::{Form, Keys, Node, Reporter, Span, Value, keys::Mark, table},
};

/// Most robots times changes: each is a whole robot in memory.
const MOST_STATES: usize = 20 * MOST_ROBOTS;
/// The changes that `root` has, in the order of time, each with the scene that holds after it; `scene` is the one at the
/// start. Notes stand at the text of the change.
pub(crate) fn changes(root: &Node, scene: &Scene, reporter: &mut Reporter) -> Vec<Change> {
    let items = root.items("changes");
    if items.len() * scene.robots.len() > MOST_STATES {
        let message = format!(
            "{} changes of {} robots are too many: at most {MOST_STATES} changes times robots",
            items.len(),
            scene.robots.len()
        );
        reporter.report(items[0].span.first(), message);
        return vec![];
    }
    let at = |item: &Node| item.get("at").and_then(Node::as_number).unwrap_or(0.0);
    let mut ordered: Vec<_> = items.iter().map(|item| (at(item), item)).collect();
    ordered.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut tree = of_robots(root);
    let mut changes: Vec<Change> = Vec::with_capacity(items.len());
    for (at, item) in ordered {
        let before = changes.last().map_or(scene, |change| &change.then);
        let mut next = tree.clone();
        // A change at fault is left out, so that later ones are judged by themselves.
        if let Some(change) = change(at, item, &mut next, before, reporter) {
            changes.push(change);
            tree = next;
        }
        if reporter.is_full() {
            break;
        }
    }
    changes
}

/// The tree without what robots do not depend on once they run, starts included.
fn of_robots(root: &Node) -> Node {
    let entries = root.as_table().unwrap_or_default();
    let kept = entries.iter().filter(|entry| !has::<Document>(&entry.key, Mark::Apart)).cloned();
    let mut tree = Node { span: root.span, value: Value::Table(kept.collect()) };
    for list in ["robots", "groups"] {
        tree.items_mut(list).iter_mut().for_each(|item| item.leave_out(&["speed"]));
    }
    tree
}

/// One change on top of `before`, whose tree is `tree`; `None` after reporting errors.
fn change(at: f64, item: &Node, tree: &mut Node, before: &Scene, reporter: &mut Reporter) -> Option<Change> {
    let first = reporter.notes();
    let span = item.get("set").map_or(item.span, |set| set.span);
    let sets = overrides(item, reporter);
    for set in &sets {
        set.put(tree, reporter);
    }
    let robots = if reporter.notes() == first { robots(tree, before, reporter) } else { None };
    // What is found elsewhere was right before this change.
    reporter.gather(first, span, &format!(", by the change at {at} s"));
    let robots = robots.filter(|_| reporter.notes() == first)?;
    let mut found = ParameterDifference::default();
    found.note_robots(&before.robots, &robots);
    // One robot speaks for all.
    if let Some(path) = found.obstacles.first() {
        let key = path.rsplit('.').next().unwrap_or(path);
        let set = sets.iter().find(|set| set.change.path().contains(&key));
        reporter.report(set.map_or(span, |set| set.span), refusal(path));
    }
    let then = Scene { robots, changes: vec![], ..shell(before) };
    found.obstacles.is_empty().then(|| Change { at, set: found.sets, then: Box::new(then) })
}

/// A scene without its robots and changes.
fn shell(scene: &Scene) -> Scene {
    Scene {
        title: scene.title.clone(),
        description: scene.description.clone(),
        ground: scene.ground.clone(),
        props: scene.props.clone(),
        robots: vec![],
        changes: vec![],
        views: scene.views.clone(),
        film: scene.film.clone(),
        events: scene.events.clone(),
        ..*scene
    }
}

/// The robots of a changed tree; where they start, and how fast, is past.
fn robots(tree: &Node, before: &Scene, reporter: &mut Reporter) -> Option<Vec<Robot>> {
    let document = table::<Document>().read(tree, reporter)?;
    let mut robots = resolve_robots(&document, tree, reporter)?;
    for (robot, before) in robots.iter_mut().zip(&before.robots) {
        robot.pose = before.pose;
        if let (Role::Follow(follow), Role::Follow(before)) = (&mut robot.role, &before.role) {
            follow.speed = before.speed;
        }
    }
    Some(robots)
}

/// An override in a file.
struct Set {
    change: Override,
    origin: Origin,
    span: Span,
}

/// The overrides of a change; reports texts that are not overrides.
fn overrides(item: &Node, reporter: &mut Reporter) -> Vec<Set> {
    let mut sets = vec![];
    for node in item.items("set") {
        let Some(text) = node.as_text() else { continue };
        match text.parse::<Override>() {
            Ok(change) => {
                let span = node.span;
                // Without escapes in it, every character has its place between the quotes.
                let shown = reporter.shown(span);
                let plain = shown.len() == text.len() + 2 && shown.get(1..=text.len()) == Some(text);
                let whole = (!plain).then_some(span);
                let origin = Origin { source: span.source, offset: span.start + 1, whole };
                sets.push(Set { change, origin, span });
            }
            Err(error) => reporter.report(node.span, error.to_string()),
        }
    }
    sets
}

impl Set {
    fn put(&self, tree: &mut Node, reporter: &mut Reporter) {
        let path = self.change.path();
        if is_fixed(&path) {
            reporter.report(self.span, refusal(&path.join(".")));
        } else {
            self.change.apply_at(self.origin, tree, reporter);
        }
    }
}

/// Whether what `path` leads to is known not to change while a run goes. Unknown keys are reported where they are read.
fn is_fixed(path: &[&str]) -> bool {
    let fixed = |marks: Option<&[Mark]>| marks.is_some_and(|marks| !marks.contains(&Mark::Live));
    match path {
        ["robots" | "groups"]
        | ["robots" | "groups", _]
        | ["robots", _, "leaders"]
        | ["robots", _, "leaders", _] => true,
        ["groups", _, "members", _, key, ..] => fixed(MemberKeys::marks(key)),
        ["robots", _, "leaders", _, key, ..] => fixed(LeaderKeys::marks(key)),
        ["robots", _, key, ..] => fixed(RobotKeys::marks(key)),
        ["groups", _, key, ..] => fixed(GroupKeys::marks(key)),
        [key, ..] => fixed(Document::marks(key)),
        [] => false,
    }
}

/// Whether a key of the table whose keys are `K` has a mark.
fn has<K: Keys>(key: &str, mark: Mark) -> bool {
    K::marks(key).is_some_and(|marks| marks.contains(&mark))
}
