//! What each robot knows of its leader.
