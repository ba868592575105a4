//! What a program printed and wrote, for the tests of each program.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
    process::Output,
};

use jsonschema::Validator;
use serde_json::Value;
use toposlam_model::format::{named_world::NamedWorld, world_file};

pub(crate) fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub(crate) fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// The JSON objects of an output, one a line.
pub(crate) fn json_lines(text: &str) -> Vec<Value> {
    assert!(text.ends_with('\n'), "{text}");
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// An empty folder for a test.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tests").join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

pub(crate) fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.collect::<BTreeSet<_>>().into_iter().collect()
}

pub(crate) fn read_world(path: &Path) -> NamedWorld {
    world_file::read(&fs::read(path).unwrap()).unwrap()
}

/// A schema of `docs/schema`.
pub(crate) struct Schema {
    pub(crate) text: Value,
    pub(crate) validator: Validator,
}

impl Schema {
    pub(crate) fn read(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors();
        let folder = folder.map(|above| above.join("docs/schema")).find(|folder| folder.is_dir());
        let text = fs::read(folder.unwrap().join(name).with_extension("json")).unwrap();
        let text = serde_json::from_slice(&text).unwrap();
        Self { validator: jsonschema::validator_for(&text).unwrap(), text }
    }

    /// What does not fit, if something does not.
    pub(crate) fn misfit(&self, line: &Value) -> Option<String> {
        self.validator.validate(line).err().map(|error| error.to_string())
    }

    pub(crate) fn kinds(&self) -> BTreeSet<&str> {
        let lines = self.text["oneOf"].as_array().unwrap().iter();
        lines.map(|line| line["properties"]["kind"]["const"].as_str().unwrap()).collect()
    }
}
