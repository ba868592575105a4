//! The extension module of the Python package `toposlam`. `toposlam/_core.pyi` describes what is in it. The
//! classes that people use are in its Python modules.

mod comparison;
mod conformance;
mod counterexample;
mod error;
mod exploration;
mod explorer_run;
mod log;
mod long_work;
mod own_marker;
mod percept;
mod play;
mod robot;
mod starts;
mod trail;
mod world;

/// The module `toposlam._core`.
#[pyo3::pymodule]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::comparison::compare;
    #[pymodule_export]
    use super::conformance::conform;
    #[pymodule_export]
    use super::counterexample::counterexample;
    #[pymodule_export]
    use super::exploration::{certificate, explore};
    #[pymodule_export]
    use super::explorer_run::{explorer_run, other_world};
    #[pymodule_export]
    use super::log::{LogReader, log_picture};
    #[pymodule_export]
    use super::percept::Percept;
    #[pymodule_export]
    use super::play::{random_page, random_world, world_page};
    #[pymodule_export]
    use super::robot::Robot;
    #[pymodule_export]
    use super::starts::{Start, Starts, count_starts};
    #[pymodule_export]
    use super::trail::Trail;
    #[pymodule_export]
    use super::world::{CoreWorld, is_name};

    /// No panic prints a text: it becomes an `InternalError`.
    #[pymodule_init]
    #[expect(clippy::unnecessary_wraps, reason = "PyO3 asks for a result")]
    fn init(_module: &Bound<'_, PyModule>) -> PyResult<()> {
        std::panic::set_hook(Box::new(|_| {}));
        Ok(())
    }
}
