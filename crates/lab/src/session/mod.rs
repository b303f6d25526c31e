//! A run that is edited while it is simulated: branches, history, prediction and the scene's text. No window here.

pub mod branches;
pub mod checked_scene;
pub mod history;
pub mod prediction;
pub mod run_event;
pub mod run_request;
pub mod runner;
pub mod scene_draft;
pub mod sweep_job;
pub mod sweeper;
