//! Files that a test writes and compares.

use std::{env, fs, path::Path};

/// Fails if a file of the repository differs from the text that it should have. If `TOPOSLAM_ACCEPT=1` is set,
/// writes the text instead: look at the difference, and commit it.
pub(crate) fn compare_or_accept(file: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    if env::var_os("TOPOSLAM_ACCEPT").is_some_and(|value| value == "1") {
        fs::write(&path, text).unwrap();
        return;
    }
    let found = fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    let differ = found.lines().zip(text.lines()).position(|(one, other)| one != other);
    let line = differ.unwrap_or_else(|| found.lines().count().min(text.lines().count()));
    assert!(
        found == text,
        "{file} is out of date from line {}; to write it again, set TOPOSLAM_ACCEPT=1\n  is:     {}\n  should: {}",
        line + 1,
        found.lines().nth(line).unwrap_or("(its end)"),
        text.lines().nth(line).unwrap_or("(its end)"),
    );
}
