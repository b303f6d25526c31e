//! A run that is changed while it goes: branches, their past, what will come, and the text of the scene. No window here.

pub mod branches;
pub mod checked_scene;
pub mod draft;
pub mod forecast;
pub mod history;
pub mod orders;
pub mod runner;
