//! The end of each verb's help: its exit codes.

use super::text::print_hanging;

/// Notes and examples, and after them the exit codes that a verb can return, each with its meaning for
/// this verb.
pub fn help_end(notes: &str, codes: &[(u8, &str)]) -> String {
    let mut text = notes.trim_end().as_bytes().to_vec();
    text.extend(b"\n\nExit codes:\n");
    for (code, meaning) in codes {
        // Writing to memory does not fail.
        let _ = print_hanging(&mut text, &format!("  {code}  "), meaning);
    }
    String::from_utf8_lossy(&text).trim_end().to_owned()
}
