//! The module `echelon` for Python: scenes, runs and simulations, their tables and pictures.
//!
//! This crate makes the extension `echelon._echelon`; the package around it, with documentation and types for users, is in
//! `python/echelon`. The interpreter is released while the core works, and a [`watch::Watch`] looks after signals meanwhile.

mod arguments;
mod cameras;
mod copies;
mod error;
mod law;
mod numbers;
mod picture_cache;
mod pictures;
mod program;
mod run;
mod scene;
mod simulation;
mod study;
mod table;
mod values;
mod watch;

use pyo3::pymodule;

/// The extension behind the package `echelon`.
#[pymodule]
mod _echelon {
    #[pymodule_export]
    use crate::copies::PyCopies;
    #[pymodule_export]
    use crate::program::program;
    #[pymodule_export]
    use crate::run::PyRun;
    #[pymodule_export]
    use crate::scene::{PyScene, scenes};
    #[pymodule_export]
    use crate::simulation::PySimulation;
    #[pymodule_export]
    use crate::study::PyStudy;
    #[pymodule_export]
    use crate::table::PyTable;

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("ROBOT_COLUMNS", recording::robot_columns())?;
        module.add("EDGE_COLUMNS", recording::edge_columns())?;
        module.add("SIGNALS", studies::copies::SIGNALS.to_vec())?;
        module.add("INPUTS", crate::law::inputs())?;
        module.add("KNOWLEDGE", crate::law::KNOWLEDGE.map(|(word, _)| word).to_vec())
    }
}
