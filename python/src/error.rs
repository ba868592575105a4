//! Exceptions of the Python half, raised from here.

use std::fmt::Display;

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

/// Ctrl-C, during work without the interpreter.
pub(crate) fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}
