//! A run that is changed while it goes: branches, their past, what will come, and the text of the scene. No window here.

pub mod branches;
pub mod checked_scene;
pub mod history;
pub mod prediction;
pub mod run_event;
pub mod run_request;
pub mod runner;
pub mod scene_draft;
