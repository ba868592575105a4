//! World files, in TOML and JSON.
