//! Sensing with a laser scanner.

pub mod scan;
