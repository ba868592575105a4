//! DOT (Graphviz): the positions of nodes are their attributes `pos`, as `neato` and `toposlam draw` write them.

use std::{collections::BTreeMap, iter::Peekable, str::Chars};

use super::{PlacedEdge, PlacedGraph, PlacedGraphError, PlacedNode, shown};

#[derive(Clone, Debug, PartialEq, Eq)]
enum Token {
    Name(String),
    /// `{`, `}`, `[`, `]`, `;`, `,`, `=` or `:`.
    Mark(char),
    /// `--` or `->`.
    Edge,
}

/// Tokens, each with its line, the place of the next one, and the numbers of the nodes that were read, by their names.
struct Tokens {
    all: Vec<(usize, Token)>,
    next: usize,
    nodes: BTreeMap<String, usize>,
}

/// Graphs in graphs are read as one up to this depth.
const DEPTH: usize = 32;

/// Reads the first graph of a file.
pub(crate) fn read(text: &str) -> Result<PlacedGraph, PlacedGraphError> {
    let mut tokens = Tokens { all: tokens(text)?, next: 0, nodes: BTreeMap::new() };
    let mut graph = PlacedGraph::default();
    tokens.skip_word("strict");
    let is_directed = tokens.skip_word("digraph");
    if !is_directed && !tokens.skip_word("graph") {
        return Err(tokens.expected("graph or digraph"));
    }
    if let Some(name) = tokens.name() {
        graph.name = name;
    }
    tokens.statements(&mut graph, is_directed, 0)?;
    Ok(graph)
}

impl Tokens {
    fn peek(&self) -> Option<&Token> {
        self.all.get(self.next).map(|(_, token)| token)
    }

    fn expected(&self, what: &str) -> PlacedGraphError {
        let last = self.all.get(self.next).or(self.all.last());
        let line = last.map_or(1, |(line, _)| *line);
        PlacedGraphError::Syntax { line, message: format!("expected {what}") }
    }

    fn name(&mut self) -> Option<String> {
        let Some(Token::Name(name)) = self.peek() else { return None };
        let name = name.clone();
        self.next += 1;
        Some(name)
    }

    fn skip(&mut self, token: &Token) -> bool {
        let is_next = self.peek() == Some(token);
        self.next += usize::from(is_next);
        is_next
    }

    fn skip_word(&mut self, word: &str) -> bool {
        let is_next =
            matches!(self.peek(), Some(Token::Name(name)) if name.eq_ignore_ascii_case(word));
        self.next += usize::from(is_next);
        is_next
    }

    /// The statements of a graph between braces.
    fn statements(
        &mut self,
        graph: &mut PlacedGraph,
        is_directed: bool,
        depth: usize,
    ) -> Result<(), PlacedGraphError> {
        if depth > DEPTH || !self.skip(&Token::Mark('{')) {
            return Err(self.expected("{"));
        }
        while !self.skip(&Token::Mark('}')) {
            if self.skip(&Token::Mark(';')) {
                continue;
            }
            if self.skip_word("subgraph") {
                self.name();
            }
            if self.peek() == Some(&Token::Mark('{')) {
                self.statements(graph, is_directed, depth + 1)?;
                if self.peek() == Some(&Token::Edge) {
                    return Err(self.expected("no edge of a whole subgraph"));
                }
                continue;
            }
            let Some(name) = self.name() else { return Err(self.expected("a node")) };
            if self.skip(&Token::Mark('=')) {
                self.name().ok_or_else(|| self.expected("a value"))?;
                continue;
            }
            let is_default =
                ["graph", "node", "edge"].iter().any(|word| name.eq_ignore_ascii_case(word));
            if is_default && self.peek() == Some(&Token::Mark('[')) {
                self.attributes()?;
                continue;
            }
            self.edges(graph, name, is_directed)?;
        }
        Ok(())
    }

    /// A node, or the edges along a chain of nodes.
    fn edges(
        &mut self,
        graph: &mut PlacedGraph,
        first: String,
        is_directed: bool,
    ) -> Result<(), PlacedGraphError> {
        let mut nodes = vec![first];
        self.port()?;
        while self.skip(&Token::Edge) {
            nodes.push(self.name().ok_or_else(|| self.expected("a node"))?);
            self.port()?;
        }
        let position = self.attributes()?;
        for name in &nodes {
            if !self.nodes.contains_key(name) {
                self.nodes.insert(name.clone(), graph.nodes.len());
                graph.nodes.push(PlacedNode { name: name.clone(), position: None });
            }
        }
        for two in nodes.windows(2) {
            let ends = [two[0].clone(), two[1].clone()];
            graph.edges.push(PlacedEdge { ends, is_directed });
        }
        if let ([name], Some(_)) = (&nodes[..], position) {
            graph.nodes[self.nodes[name]].position = position;
        }
        Ok(())
    }

    /// The side of a node at which an edge is drawn, as in `a:n`.
    fn port(&mut self) -> Result<(), PlacedGraphError> {
        while self.skip(&Token::Mark(':')) {
            self.name().ok_or_else(|| self.expected("a port"))?;
        }
        Ok(())
    }

    /// Attributes in brackets, if there are any. Returns the position among them.
    fn attributes(&mut self) -> Result<Option<[f64; 2]>, PlacedGraphError> {
        let mut position = None;
        while self.skip(&Token::Mark('[')) {
            while !self.skip(&Token::Mark(']')) {
                let key = self.name().ok_or_else(|| self.expected("an attribute"))?;
                if self.skip(&Token::Mark('=')) {
                    let value = self.name().ok_or_else(|| self.expected("a value"))?;
                    if key == "pos" {
                        position = Some(self::position(&value));
                    }
                }
                let _ = self.skip(&Token::Mark(',')) || self.skip(&Token::Mark(';'));
            }
        }
        Ok(position)
    }
}

/// The position in an attribute such as `1.5,2` or `1.5,2!`.
fn position(text: &str) -> [f64; 2] {
    let mut numbers = text.trim_end_matches('!').split([',', ' ']).filter(|part| !part.is_empty());
    [(); 2].map(|()| numbers.next().and_then(|part| part.parse().ok()).unwrap_or(f64::NAN))
}

fn tokens(text: &str) -> Result<Vec<(usize, Token)>, PlacedGraphError> {
    let mut tokens = Vec::new();
    let mut rest = text.trim_start_matches('\u{feff}').chars().peekable();
    let mut line = 1;
    let wrong =
        |line, message: &str| Err(PlacedGraphError::Syntax { line, message: message.to_owned() });
    let mut begins_line = true;
    while let Some(letter) = rest.next() {
        let is_first = std::mem::replace(&mut begins_line, letter == '\n');
        let at = line;
        let token = match (letter, rest.peek()) {
            ('\n', _) => {
                line += 1;
                continue;
            }
            ('#', _) if is_first => {
                skip_line(&mut rest);
                continue;
            }
            ('/', Some('/')) => {
                skip_line(&mut rest);
                continue;
            }
            ('/', Some('*')) => {
                let mut last = ' ';
                for letter in rest.by_ref() {
                    line += usize::from(letter == '\n');
                    if (last, letter) == ('*', '/') {
                        break;
                    }
                    last = letter;
                }
                continue;
            }
            ('-', Some('-' | '>')) => {
                rest.next();
                Token::Edge
            }
            ('"', _) => {
                let Some(name) = quoted(&mut rest, &mut line) else {
                    return wrong(at, "the text in quotes does not end");
                };
                Token::Name(name)
            }
            ('{' | '}' | '[' | ']' | ';' | ',' | '=' | ':', _) => Token::Mark(letter),
            (space, _) if space.is_whitespace() => continue,
            (letter, _) if is_part(letter) => {
                let mut name = String::from(letter);
                while let Some(next) = rest.next_if(|next| is_part(*next) && *next != '-') {
                    name.push(next);
                }
                Token::Name(name)
            }
            ('<', _) => return wrong(at, "texts in HTML are not read"),
            _ => return wrong(at, &format!("`{}` is not expected", shown(letter.to_string()))),
        };
        tokens.push((at, token));
    }
    Ok(tokens)
}

/// Whether a letter is part of a name or a number without quotes.
fn is_part(letter: char) -> bool {
    letter.is_alphanumeric() || "_.-".contains(letter)
}

fn skip_line(rest: &mut Peekable<Chars<'_>>) {
    while rest.next_if(|letter| *letter != '\n').is_some() {}
}

/// The text up to the next quotation mark; `None` if there is none.
fn quoted(rest: &mut Peekable<Chars<'_>>, line: &mut usize) -> Option<String> {
    let mut text = String::new();
    loop {
        match rest.next()? {
            '"' => return Some(text.replace("&amp;", "&")),
            '\\' => match rest.next()? {
                '\n' => *line += 1,
                escaped @ ('"' | '\\') => text.push(escaped),
                other => text.extend(['\\', other]),
            },
            letter => {
                *line += usize::from(letter == '\n');
                text.push(letter);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use toposlam_model::format::{dot, world_file};

    use super::*;

    #[test]
    fn what_draw_writes_of_a_floor_plan_is_the_same_world() {
        for name in ["shape-6", "building-12"] {
            let file = format!("{}/../worlds/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            let plan = world_file::read(&std::fs::read(file).unwrap()).unwrap();
            let read = read(&dot::write(&plan)).unwrap().world().unwrap().unwrap();
            assert_eq!((read.name, &read.vertex_names), (plan.name, &plan.vertex_names));
            assert_eq!(read.graph, plan.graph, "{name}");
        }
    }

    #[test]
    fn chains_comments_and_quotes_are_read() {
        let text = "# by hand\nstrict graph \"G\" { // a crossing\n node [shape=circle, label=\"\\N\"];\n rankdir = LR\n\
                    x [pos=\"0,0!\"]; n [pos=\"0,2\"] e [label=\"a ; -- {\" pos=\"2,0\"]\n\
                    w [pos=\"-2,0\"]; /* two\n lines */ w -- x -- n [len=2]; { x:s -- e } }";
        let world = read(text).unwrap().world().unwrap().unwrap();
        let around = world.graph.darts_of(world.vertex_named("x").unwrap());
        let names: Vec<_> =
            around.map(|dart| world.at_text(world.graph.opposite(dart)).to_owned()).collect();
        assert_eq!((names, &*world.name), (["n", "e", "w"].map(str::to_owned).to_vec(), "G"));
    }

    #[test]
    fn what_is_no_graph_is_an_error_with_its_line() {
        for (text, error) in [
            ("", "line 1: expected graph or digraph"),
            ("graph G\n{ a -- \n }", "line 3: expected a node"),
            ("graph {\n a [pos", "line 2: expected an attribute"),
            ("graph { a -- b", "line 1: expected a node"),
            ("graph { \"a", "line 1: the text in quotes does not end"),
            ("graph { a [label=<b>] }", "line 1: texts in HTML"),
            ("graph { {a b} -- c }", "line 1: expected no edge of a whole subgraph"),
        ] {
            let found = read(text).unwrap_err().to_string();
            assert!(found.starts_with(error), "{text}: {found}");
        }
        let deep = format!("graph {}", "{".repeat(100));
        assert_eq!(read(&deep).unwrap_err().to_string(), "line 1: expected {");
        let nowhere = read("graph { a [pos=\"left\"]; a -- b }").unwrap().world().unwrap_err();
        assert_eq!(nowhere.to_string(), "the position of node `a` is not a number");
    }
}
