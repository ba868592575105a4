//! The structure of the crates, read from their source: no circles of modules, the order of modules that the documents
//! state, no public type name twice.
//!
//! A module is a file. It depends on the files that its `use` items and its paths name; a name that a
//! module only re-exports counts for the file that defines it. A file is part of its ancestors, so that
//! what it takes from them is no dependency. Test code (`#[cfg(test)]`) may import anything.

use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// The crates: name, and folder of the source. Cargo enforces which of them use which.
const CRATES: [(&str, &str); 12] = [
    ("toposlam_model", "model/src"),
    ("toposlam_vision", "vision/src"),
    ("toposlam_logs", "logs/src"),
    ("toposlam_robot", "robot/src"),
    ("toposlam_conform", "conform/src"),
    ("toposlam_simulator", "simulator/src"),
    ("toposlam_draw", "draw/src"),
    ("toposlam_terminal", "terminal/src"),
    ("toposlam_proofs", "proofs/src"),
    ("toposlam_cluster", "cluster/src"),
    ("toposlam", "src"),
    // The extension module of the Python package, a workspace of its own.
    ("_core", "python/src"),
];

/// A token of Rust source; of literals only that there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Token {
    Name(String),
    /// `::`
    Path,
    Mark(char),
    Literal,
}

impl Token {
    fn name(&self) -> Option<&str> {
        if let Self::Name(name) = self { Some(name) } else { None }
    }

    fn is(&self, mark: char) -> bool {
        *self == Self::Mark(mark)
    }
}

/// The tokens of a source file, without comments.
fn tokens(source: &str) -> Vec<Token> {
    let text: Vec<char> = source.chars().collect();
    let at = |place: usize| text.get(place).copied().unwrap_or('\0');
    let is_name = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut tokens = Vec::new();
    let mut here = 0;
    while here < text.len() {
        let begin = here;
        match at(here) {
            '/' if at(here + 1) == '/' => {
                while here < text.len() && at(here) != '\n' {
                    here += 1;
                }
            }
            '/' if at(here + 1) == '*' => {
                let mut depth = 0;
                while here < text.len() {
                    match (at(here), at(here + 1)) {
                        ('/', '*') => (depth, here) = (depth + 1, here + 2),
                        ('*', '/') => (depth, here) = (depth - 1, here + 2),
                        _ => here += 1,
                    }
                    if depth == 0 {
                        break;
                    }
                }
            }
            '"' => {
                here = after_string(&text, here);
                tokens.push(Token::Literal);
            }
            // A character, unless it is a lifetime or a label.
            '\'' if at(here + 1) == '\\' || at(here + 2) == '\'' => {
                here += if at(here + 1) == '\\' { 3 } else { 2 };
                while here < text.len() && at(here) != '\'' {
                    here += 1;
                }
                here += 1;
                tokens.push(Token::Literal);
            }
            ':' if at(here + 1) == ':' => {
                here += 2;
                tokens.push(Token::Path);
            }
            letter if is_name(letter) => {
                while is_name(at(here)) {
                    here += 1;
                }
                let name: String = text[begin..here].iter().collect();
                let is_raw = matches!(name.as_str(), "r" | "br" | "cr");
                if is_raw
                    && (at(here) == '"' || at(here) == '#' && matches!(at(here + 1), '#' | '"'))
                {
                    here = after_raw_string(&text, here);
                    tokens.push(Token::Literal);
                } else if matches!(name.as_str(), "b" | "c") && at(here) == '"' {
                    here = after_string(&text, here);
                    tokens.push(Token::Literal);
                } else {
                    tokens.push(Token::Name(name));
                }
            }
            letter if letter.is_whitespace() => here += 1,
            letter => {
                here += 1;
                tokens.push(Token::Mark(letter));
            }
        }
    }
    tokens
}

/// The place after a string that begins here.
fn after_string(text: &[char], begin: usize) -> usize {
    let mut here = begin + 1;
    while here < text.len() && text[here] != '"' {
        here += if text[here] == '\\' { 2 } else { 1 };
    }
    here + 1
}

/// The place after a raw string whose hashes or quote begin here.
fn after_raw_string(text: &[char], begin: usize) -> usize {
    let hashes = text[begin..].iter().take_while(|&&letter| letter == '#').count();
    let mut here = begin + hashes + 1;
    while here < text.len() {
        let closed = text[here] == '"'
            && text[here + 1..].iter().take(hashes).filter(|&&letter| letter == '#').count()
                == hashes;
        here += 1;
        if closed {
            return here + hashes;
        }
    }
    here
}

/// The tokens without the items that are compiled for tests only, and the names of the modules in
/// other files among these.
fn without_tests(tokens: &[Token]) -> (Vec<Token>, Vec<String>) {
    let (mut kept, mut test_modules) = (Vec::new(), Vec::new());
    let mut here = 0;
    while here < tokens.len() {
        let is_attribute = tokens[here].is('#') && tokens.get(here + 1).is_some_and(|t| t.is('['));
        if !is_attribute {
            kept.push(tokens[here].clone());
            here += 1;
            continue;
        }
        let end = closing(tokens, here + 1);
        let names: Vec<_> = tokens[here..end].iter().filter_map(Token::name).collect();
        let for_tests =
            names.starts_with(&["cfg"]) && names.contains(&"test") && !names.contains(&"not");
        here = end;
        if for_tests {
            let item = here;
            // An item ends with its first semicolon or closed brace outside of brackets.
            while here < tokens.len() && !tokens[here].is(';') && !tokens[here].is('{') {
                here = if tokens[here].is('(') || tokens[here].is('[') {
                    closing(tokens, here)
                } else {
                    here + 1
                };
            }
            here = match tokens.get(here) {
                Some(token) if token.is('{') => closing(tokens, here),
                _ => here + 1,
            };
            let names: Vec<_> =
                tokens[item..here.min(tokens.len())].iter().filter_map(Token::name).collect();
            if let ["mod", name] = names[..] {
                test_modules.push(name.to_owned());
            }
        }
    }
    (kept, test_modules)
}

/// The place after the bracket that closes the one here.
fn closing(tokens: &[Token], begin: usize) -> usize {
    let mut depth = 0;
    for (here, token) in tokens.iter().enumerate().skip(begin) {
        match token {
            Token::Mark('(' | '[' | '{') => depth += 1,
            Token::Mark(')' | ']' | '}') => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return here + 1;
        }
    }
    tokens.len()
}

/// A path in a `use` item: its segments, and the name that it has here; `*` for all names.
type Used = (Vec<String>, String);

/// The paths of the `use` tree that begins here, and the place after it.
fn use_tree(tokens: &[Token], begin: usize, prefix: &[String], used: &mut Vec<Used>) -> usize {
    let mut path = prefix.to_vec();
    let mut here = begin;
    while let Some(token) = tokens.get(here) {
        match token {
            Token::Name(name) if name == "as" => {
                if let Some(name) = tokens.get(here + 1).and_then(Token::name) {
                    used.push((path, name.to_owned()));
                    return here + 2;
                }
            }
            Token::Name(name) if name == "self" && !path.is_empty() => {}
            Token::Name(name) => path.push(name.clone()),
            Token::Mark('*') => {
                used.push((path, "*".to_owned()));
                return here + 1;
            }
            Token::Mark('{') => {
                here += 1;
                while tokens.get(here).is_some_and(|token| !token.is('}')) {
                    here = use_tree(tokens, here, &path, used);
                    if tokens.get(here).is_some_and(|token| token.is(',')) {
                        here += 1;
                    }
                }
                return here + 1;
            }
            Token::Path => {}
            _ => break,
        }
        here += 1;
    }
    if let Some(last) = path.last().cloned() {
        used.push((path, last));
    }
    here
}

/// A source file that is a module.
struct Module {
    file: PathBuf,
    /// Its `use` items.
    uses: Vec<Used>,
    /// Other paths in its code.
    paths: Vec<Vec<String>>,
    /// The names of its public types.
    types: Vec<String>,
}

impl Module {
    fn new(file: PathBuf, tokens: &[Token]) -> Self {
        let (mut uses, mut paths, mut types) = (Vec::new(), Vec::new(), Vec::new());
        let mut here = 0;
        while here < tokens.len() {
            let after_path = here > 0 && tokens[here - 1] == Token::Path;
            match &tokens[here] {
                // Not the bounds of a captured lifetime, `use<'a>`.
                Token::Name(name) if name == "use" && !tokens[here + 1].is('<') => {
                    here = use_tree(tokens, here + 1, &[], &mut uses);
                    continue;
                }
                Token::Name(name) if name == "pub" => {
                    let item = match tokens.get(here + 1) {
                        Some(token) if token.is('(') => closing(tokens, here + 1),
                        _ => here + 1,
                    };
                    let next = |place: usize| tokens.get(place).and_then(Token::name);
                    if let (Some("struct" | "enum" | "trait" | "type" | "union"), Some(name)) =
                        (next(item), next(item + 1))
                    {
                        types.push(name.to_owned());
                    }
                }
                Token::Name(name) if !after_path && tokens.get(here + 1) == Some(&Token::Path) => {
                    let mut path = vec![name.clone()];
                    while let (Some(Token::Path), Some(Token::Name(next))) =
                        (tokens.get(here + 1), tokens.get(here + 2))
                    {
                        path.push(next.clone());
                        here += 2;
                    }
                    paths.push(path);
                }
                _ => {}
            }
            here += 1;
        }
        Self { file, uses, paths, types }
    }
}

/// The modules of a crate by their paths; the root's is empty. A program beside a library shares it.
struct Crate {
    name: &'static str,
    modules: BTreeMap<Vec<String>, Module>,
}

type Edges<'c> = BTreeMap<&'c [String], BTreeSet<&'c [String]>>;

impl Crate {
    fn read(name: &'static str, folder: &Path) -> Self {
        let mut files = Vec::new();
        source_files(folder, &mut files);
        let mut found = BTreeMap::new();
        let mut only_tests = BTreeSet::new();
        for file in files {
            let source = fs::read_to_string(&file).unwrap();
            let path = module_path(file.strip_prefix(folder).unwrap());
            let (kept, test_modules) = without_tests(&tokens(&source));
            only_tests.extend(test_modules.into_iter().map(|name| [&path[..], &[name]].concat()));
            let module = Module::new(file, &kept);
            found
                .entry(path)
                .and_modify(|root: &mut Module| {
                    root.uses.extend(module.uses.iter().cloned());
                    root.paths.extend(module.paths.iter().cloned());
                    root.types.extend(module.types.iter().cloned());
                })
                .or_insert(module);
        }
        found.retain(|path, _| !(1..=path.len()).any(|end| only_tests.contains(&path[..end])));
        Self { name, modules: found }
    }

    /// The module in which what a path names is defined; `None` for a path of another crate or of a
    /// name that is no module.
    fn definition(&self, from: &[String], path: &[String], hops: usize) -> Option<&[String]> {
        let mut here = from.to_vec();
        let mut rest = path;
        match rest.first().map(String::as_str)? {
            "crate" => (here, rest) = (Vec::new(), &rest[1..]),
            name if name == self.name => (here, rest) = (Vec::new(), &rest[1..]),
            "self" => rest = &rest[1..],
            "super" => {
                while rest.first().is_some_and(|name| name == "super") {
                    here.pop();
                    rest = &rest[1..];
                }
            }
            child if self.modules.contains_key(&[&here[..], &[child.to_owned()]].concat()) => {}
            _ => return None,
        }
        while let Some(name) = rest.first() {
            let child = [&here[..], std::slice::from_ref(name)].concat();
            if !self.modules.contains_key(&child) {
                break;
            }
            (here, rest) = (child, &rest[1..]);
        }
        let (key, module) = self.modules.get_key_value(&here)?;
        if let Some(name) = rest.first().filter(|_| hops > 0) {
            let handed_on = module.uses.iter().filter(|(_, known)| known == name);
            for (path, _) in handed_on {
                if let Some(found) = self.definition(&here, path, hops - 1) {
                    return Some(found);
                }
            }
        }
        Some(key)
    }

    /// The modules that each module depends on.
    fn edges(&self) -> Edges<'_> {
        let mut edges = Edges::new();
        for (from, module) in &self.modules {
            let used = module.uses.iter().map(|(path, _)| path);
            for path in used.chain(&module.paths) {
                if let Some(to) = self.definition(from, path, 8)
                    && !from.starts_with(to)
                {
                    edges.entry(from).or_default().insert(to);
                }
            }
        }
        edges
    }

    fn file(&self, module: &[String]) -> String {
        relative(&self.modules[module].file)
    }
}

/// A file's path in the workspace.
fn relative(file: &Path) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    file.strip_prefix(root).unwrap_or(file).display().to_string()
}

fn source_files(folder: &Path, files: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for entry in entries {
        if entry.is_dir() {
            source_files(&entry, files);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            files.push(entry);
        }
    }
}

fn module_path(file: &Path) -> Vec<String> {
    let mut path: Vec<String> =
        file.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if path.last().is_some_and(|last| matches!(last.as_str(), "mod" | "lib" | "main")) {
        path.pop();
    }
    path
}

fn crates() -> Vec<Crate> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    CRATES.iter().map(|&(name, folder)| Crate::read(name, &root.join(folder))).collect()
}

/// All that can be reached from a module.
fn reached<'c>(edges: &Edges<'c>, from: &'c [String]) -> BTreeSet<&'c [String]> {
    let mut found = BTreeSet::new();
    let mut open = vec![from];
    while let Some(here) = open.pop() {
        let next = edges.get(here).into_iter().flatten();
        open.extend(next.filter(|&&next| found.insert(next)));
    }
    found
}

#[test]
fn no_modules_depend_on_each_other() {
    let mut circles = BTreeSet::new();
    for krate in &crates() {
        let edges = krate.edges();
        assert!(edges.len() * 2 > krate.modules.len(), "{}: imports were not found", krate.name);
        for &module in edges.keys() {
            let below = reached(&edges, module);
            if below.contains(module) {
                let back = |other: &&&[String]| reached(&edges, other).contains(module);
                let circle: Vec<_> =
                    below.iter().filter(back).map(|other| krate.file(other)).collect();
                circles.insert(circle.join(", "));
            }
        }
    }
    let circles: Vec<_> = circles.into_iter().collect();
    assert!(circles.is_empty(), "circles of imports:\n{}", circles.join("\n"));
}

#[test]
fn no_folders_depend_on_each_other() {
    for krate in &crates() {
        let mut below: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
        for (from, targets) in krate.edges() {
            let Some(from) = from.first() else { continue };
            let others = targets.iter().filter_map(|to| to.first()).filter(|to| *to != from);
            below.entry(from).or_default().extend(others.map(String::as_str));
        }
        let mut left: BTreeSet<&str> = below.keys().copied().collect();
        loop {
            let is_used = |name: &&str| below[name].iter().any(|other| left.contains(other));
            let stay: BTreeSet<&str> = left.iter().copied().filter(is_used).collect();
            if stay.len() == left.len() {
                break;
            }
            left = stay;
        }
        assert!(left.is_empty(), "{}: these modules depend on each other: {left:?}", krate.name);
    }
}

/// The modules that the documentation of a crate lists, in its order.
fn listed_modules(source: &str) -> Vec<&str> {
    let listed = source.lines().filter_map(|line| line.strip_prefix("//! * [`"));
    listed.filter_map(|line| line.split('`').next()).collect()
}

#[test]
fn the_modules_of_the_model_import_only_from_those_that_are_listed_before_them() {
    let crates = crates();
    let model = crates.iter().find(|krate| krate.name == "toposlam_model").unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let source = fs::read_to_string(root.join("model/src/lib.rs")).unwrap();
    let order = listed_modules(&source);
    let public: BTreeSet<_> = source
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'))
        .collect();
    assert_eq!(order.iter().copied().collect::<BTreeSet<_>>(), public, "model/src/lib.rs");
    // What is not listed is private, and below all others.
    let place = |module: &[String]| {
        let name = module.first()?;
        Some(order.iter().position(|listed| listed == name).map_or(0, |place| place + 1))
    };
    for (from, targets) in model.edges() {
        for to in targets {
            if from.first() != to.first() && place(from).is_some() {
                let (file, other) = (model.file(from), model.file(to));
                assert!(place(to) <= place(from), "{file} uses {other}, which is listed after it");
            }
        }
    }

    let text = fs::read_to_string(root.join("CONTRIBUTING.md")).unwrap();
    let (_, text) = text.split_once("The modules of `model/src`, bottom up:").unwrap();
    let (list, _) = text.split_once('.').unwrap();
    let named: Vec<_> = list.split('`').skip(1).step_by(2).collect();
    assert_eq!(named, order, "CONTRIBUTING.md");
}

#[test]
fn no_public_type_name_is_used_twice() {
    let crates = crates();
    let mut places: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    // The classes of Python have the names of what they wrap.
    let rust = crates.iter().filter(|krate| krate.name != "_core");
    for module in rust.flat_map(|krate| krate.modules.values()) {
        for name in &module.types {
            places.entry(name).or_default().push(relative(&module.file));
        }
    }
    assert!(places.len() > 300, "types were not found");
    let twice: Vec<_> = places
        .iter()
        .filter(|(_, places)| places.len() > 1)
        .map(|(name, places)| format!("{name}: {}", places.join(", ")))
        .collect();
    assert!(twice.is_empty(), "one name for several types:\n{}", twice.join("\n"));
}

#[test]
fn source_is_read_without_comments_literals_and_tests() {
    let source = r##"
        //! use crate::nothing;
        use super::{one::{self, Two as Other}, three::*}; /* use crate::no /* use crate::no */ */
        pub(crate) struct Found<'a>(&'a str, char);
        fn f() -> Four { let s = "use crate::no;"; let r = r#"pub struct No"#; ('"', '\'', crate::four::g()) }
        #[cfg(test)]
        mod tests { use crate::no; pub struct No; }
        #[cfg(test)]
        mod other;
    "##;
    let (kept, test_modules) = without_tests(&tokens(source));
    let module = Module::new(PathBuf::new(), &kept);
    let uses: Vec<_> =
        module.uses.iter().map(|(path, name)| format!("{} {name}", path.join("::"))).collect();
    assert_eq!(uses, ["super::one one", "super::one::Two Other", "super::three *"]);
    assert_eq!(module.paths, [["crate", "four", "g"].map(str::to_owned)]);
    assert_eq!((module.types, test_modules), (vec!["Found".to_owned()], vec!["other".to_owned()]));
}

/// The profile of a release build in a manifest: its settings, and those of each package.
fn release_profile(manifest: &str) -> [toml::Table; 2] {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(manifest);
    let mut manifest: toml::Table = fs::read_to_string(path).unwrap().parse().unwrap();
    let profile = manifest["profile"].as_table_mut().unwrap().remove("release").unwrap();
    let toml::Value::Table(mut profile) = profile else { panic!("not a table") };
    let Some(toml::Value::Table(packages)) = profile.remove("package") else { panic!("no table") };
    [profile, packages]
}

/// So it is as fast, and what both need is compiled once.
#[test]
fn the_python_package_is_optimised_as_the_program_is() {
    let [[python, its_packages], [program, packages]] =
        ["python/Cargo.toml", "Cargo.toml"].map(release_profile);
    assert_eq!(python, program);
    for (name, settings) in its_packages {
        assert_eq!(Some(&settings), packages.get(&name), "{name}");
    }
}
