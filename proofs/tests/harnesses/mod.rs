//! The harnesses for Kani, where there is no Kani: that they compile against a stand-in for its
//! library, that they are those of the table, and that the scripts accept Kani's result only where it
//! proves something. Nothing here says that a lemma holds.

mod scripts;
mod types;

use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use toposlam_proofs::lemmas;

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// A folder of ours under the target directory.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("harnesses").join(name);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The harnesses of the table, as Kani names them, each with its unwinding.
fn table() -> BTreeMap<&'static str, u32> {
    let harnesses = lemmas::all().filter_map(|lemma| lemma.kani.as_ref());
    harnesses.map(|kani| (within(kani.harness), kani.unwind)).collect()
}

/// A path within the crate: Kani leaves its name out.
fn within(path: &str) -> &str {
    path.strip_prefix("toposlam_proofs::").expect("it is in this crate")
}
