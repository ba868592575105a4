//! The written argument, the other pages, the lemmas and the theorems belong together.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use toposlam_proofs::{lemmas, theorems};

const ARGUMENT: &str = include_str!("../README.md");

#[test]
fn the_argument_names_every_lemma_and_beside_them_only_theorems() {
    // Names in backquotes that read like a lemma's: words with more than one line between them.
    let named: BTreeSet<_> = ARGUMENT
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|word| word.bytes().all(|b| b.is_ascii_lowercase() || b"_1".contains(&b)))
        .filter(|word| word.matches('_').count() > 1)
        .collect();
    let lemmas: BTreeSet<_> = lemmas::all().map(|lemma| lemma.name).collect();
    // Harnesses of the symbolic engine for what is no lemma.
    let harnesses = include_str!("../symbolic/faults.toml").lines();
    let harnesses = harnesses.filter_map(|line| line.strip_prefix('[')?.strip_suffix(']'));
    let theorems = theorems::all().map(|theorem| theorem.name);
    let others: BTreeSet<_> =
        harnesses.chain(theorems).filter(|name| !lemmas.contains(name)).collect();
    assert_eq!(&named - &others, lemmas);
}

/// A table of sentences and theorems, and what `check` prints.
#[test]
fn the_page_on_the_theorems_names_each_of_them() {
    let page = include_str!("../coq/README.md");
    let sentences: Vec<_> = page.lines().filter_map(|line| line.strip_suffix("` |")).collect();
    let named: Vec<_> = sentences
        .iter()
        .filter_map(|line| line.rsplit_once(". | `"))
        .map(|(_, name)| name)
        .collect();
    let closed: Vec<_> = page.lines().filter_map(|line| line.strip_suffix(" closed")).collect();
    let theorems: Vec<_> = theorems::all().map(|theorem| theorem.name).collect();
    assert_eq!(named, theorems);
    assert_eq!(closed.iter().map(|name| name.trim_end()).collect::<Vec<_>>(), theorems);
    assert!(page.contains(&format!("\nholds: {} theorems, ", theorems.len())));
}

/// The pages of a folder of the repository, and of the folders in it if they are asked for.
fn add_pages(folder: &Path, with_folders: bool, pages: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && with_folders {
            add_pages(&path, true, pages);
        } else if path.extension().is_some_and(|kind| kind == "md") {
            pages.push(path);
        }
    }
}

/// The paragraphs, list items and rows of a page.
fn blocks(page: &str) -> Vec<String> {
    let mut blocks = vec![String::new()];
    for line in page.lines() {
        if line.is_empty() || ["|", "- ", "* "].iter().any(|first| line.starts_with(first)) {
            blocks.push(String::new());
        }
        let block = blocks.last_mut().unwrap();
        block.push_str(line);
        block.push(' ');
    }
    blocks
}

/// What stands in backquotes.
fn quoted(block: &str) -> impl Iterator<Item = &str> {
    block.split('`').skip(1).step_by(2)
}

/// The names that the files of Coq define.
fn definitions(folder: &Path) -> BTreeSet<String> {
    let mut definitions = BTreeSet::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|kind| kind == "v") {
            let text = fs::read_to_string(path).unwrap();
            let defined = text.lines().filter_map(|line| line.strip_prefix("Definition "));
            let names = defined.filter_map(|line| line.split_whitespace().next());
            definitions.extend(names.map(str::to_owned));
        }
    }
    definitions
}

/// Where a page speaks of Coq or of theorems, each name with a line in it is that of a theorem, a lemma or a
/// definition; and each file of Coq is there.
#[test]
fn the_pages_name_theorems_and_files_that_exist() {
    // A function of the model, in a paragraph that also names a page on Coq.
    const OTHERS: [&str; 1] = ["first_alike"];
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut pages = Vec::new();
    for (folder, with_folders) in
        [("", false), ("docs", true), ("worlds", true), ("proofs", false), ("proofs/coq", false)]
    {
        add_pages(&root.join(folder), with_folders, &mut pages);
    }
    let names: BTreeSet<_> = theorems::all()
        .map(|theorem| theorem.name)
        .chain(lemmas::all().map(|lemma| lemma.name))
        .chain(OTHERS)
        .collect();
    let definitions = definitions(&root.join("proofs/coq"));
    let mut cited = BTreeSet::new();
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        let is_atlas = page.ends_with("worlds/atlas/README.md");
        for block in blocks(&text) {
            for file in quoted(&block).filter(|word| is_coq_file(word)) {
                let file = file.rsplit('/').next().unwrap();
                assert!(root.join("proofs/coq").join(file).is_file(), "{file}: {}", page.display());
            }
            if !is_atlas && !block.contains("Coq") && !block.contains("theorem") {
                continue;
            }
            for name in quoted(&block).filter(|word| word.contains('_')) {
                let is_name = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
                    && name.starts_with(|first: char| first.is_ascii_lowercase());
                if is_name {
                    let is_known = names.contains(name) || definitions.contains(name);
                    assert!(is_known, "{name}: {}", page.display());
                    cited.insert(name.to_owned());
                }
            }
        }
    }
    // The names are read.
    assert!(cited.contains("certificate_needed") && cited.contains("directed_edge_suffices"));
}

/// Whether a word is the name of a file of the development.
fn is_coq_file(word: &str) -> bool {
    Path::new(word).extension().is_some_and(|extension| extension == "v")
}
