//! Exceptions of the Python modules, raised from here.

use std::{
    fmt::Display,
    panic::{AssertUnwindSafe, catch_unwind},
};

use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*};

/// An exception of a class in `toposlam.errors`.
pub(crate) fn error(py: Python<'_>, class: &str, message: impl Display) -> PyErr {
    let classes = py.import("toposlam.errors");
    let raised = classes
        .and_then(|classes| classes.getattr(class))
        .and_then(|class| class.call1((message.to_string(),)));
    match raised {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

/// A bug in this package.
pub(crate) fn internal(py: Python<'_>) -> PyErr {
    let cause = "this is a bug in toposlam; please report it, with what you called";
    error(py, "InternalError", cause)
}

/// Does short work; a panic becomes an `InternalError`.
pub(crate) fn guarded<R>(py: Python<'_>, work: impl FnOnce() -> PyResult<R>) -> PyResult<R> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err(internal(py)))
}

/// Ctrl-C, during work without the interpreter.
pub(crate) fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}
