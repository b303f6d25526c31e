//! What somebody outside a formation decides for a follower.

use vocabulary::Command;

/// What somebody outside decides for a follower at a sample. Like what a law asks for, it is cut by limits and by whatever else
/// the follower has beside its law: standing, hand-over, safety filter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum AgentAction {
    /// In place of its law.
    Instead(Command),
    /// On top of what its law asks for.
    Added(Command),
}

impl AgentAction {
    /// What is asked for; `law` tells what the follower's law asks for, `None` where it has broken off.
    pub(crate) fn applied_to(self, law: impl FnOnce() -> Option<Command>) -> Option<Command> {
        match self {
            Self::Instead(command) => Some(command),
            Self::Added(more) => law().map(|asked| Command {
                acceleration: asked.acceleration + more.acceleration,
                turn_rate: asked.turn_rate + more.turn_rate,
            }),
        }
    }
}
