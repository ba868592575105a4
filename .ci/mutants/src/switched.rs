//! The text of a file with all of its changes, each behind `is_on(NUMBER)`.

use std::ops::Range;

use crate::site::{Site, Switch};

/// A change of a site, and where it is in the text.
pub struct Placed {
    pub site: usize,
    /// The index among the site's changes; none for the switch itself.
    pub change: Option<usize>,
    pub range: Range<usize>,
}

/// Text that replaces a range of the file.
struct Edit {
    range: Range<usize>,
    /// At the same place, ends come before starts, inner ends before outer ones and outer starts before inner ones.
    order: (bool, isize),
    site: usize,
    pieces: Vec<Piece>,
}

enum Piece {
    Text(String),
    Change(usize, String),
}

/// The text, and where the changes are. `number` returns the number of a change, if it is to be in.
pub fn switched(
    source: &str,
    sites: &[Site],
    number: impl Fn(usize, usize) -> Option<u32>,
) -> (String, Vec<Placed>) {
    let mut edits = Vec::new();
    for (site, at) in sites.iter().enumerate() {
        let changes: Vec<_> = (0..at.changes.len())
            .filter_map(|change| Some((change, number(site, change)?)))
            .collect();
        if !changes.is_empty() {
            edits_of(source, site, at, &changes, &mut edits);
        }
    }
    edits.sort_by_key(|edit| (edit.range.start, edit.order));
    let (mut text, mut placed, mut position) = (String::new(), Vec::<Placed>::new(), 0);
    let mut open: Vec<(usize, usize)> = Vec::new();
    for edit in edits {
        text.push_str(&source[position..edit.range.start]);
        position = edit.range.end;
        let start = text.len();
        for piece in edit.pieces {
            match piece {
                Piece::Text(piece) => text.push_str(&piece),
                Piece::Change(change, piece) => {
                    let start = text.len();
                    text.push_str(&piece);
                    placed.push(Placed {
                        site: edit.site,
                        change: Some(change),
                        range: start..text.len(),
                    });
                }
            }
        }
        // A switch goes from its first edit to its last.
        if let Some(&(_, first)) = open.iter().rev().find(|(site, _)| *site == edit.site) {
            placed[first].range.end = text.len();
        } else {
            open.push((edit.site, placed.len()));
            placed.push(Placed { site: edit.site, change: None, range: start..text.len() });
        }
    }
    text.push_str(&source[position..]);
    (text, placed)
}

fn is_on(number: u32) -> String {
    format!("crate::mutant_switch::is_on({number})")
}

fn edits_of(source: &str, site: usize, at: &Site, changes: &[(usize, u32)], edits: &mut Vec<Edit>) {
    let text = |text: &str| Piece::Text(text.to_owned());
    let mut edit =
        |range: Range<usize>, order, pieces| edits.push(Edit { range, order, site, pieces });
    // Longer expressions are around shorter ones that begin or end at the same place.
    let start = |whole: &Range<usize>| (whole.start..whole.start, (true, -(whole.len() as isize)));
    let end = |whole: &Range<usize>| (whole.end..whole.end, (false, whole.len() as isize));
    // `if is_on(1) { a - b } else { a + b }`
    let choice = |expression: &dyn Fn(&str) -> String, original: &str| {
        let mut pieces = Vec::new();
        for &(change, number) in changes {
            pieces.push(Piece::Text(format!("if {} {{ ", is_on(number))));
            pieces.push(Piece::Change(change, expression(&at.changes[change].with)));
            pieces.push(text(" } else "));
        }
        pieces.push(Piece::Text(format!("{{ {} }}", expression(original))));
        pieces
    };
    match &at.switch {
        Switch::Body(byte) => {
            let mut pieces = Vec::new();
            for &(change, number) in changes {
                pieces.push(Piece::Text(format!(" if {} {{ return ", is_on(number))));
                pieces.push(Piece::Change(change, at.changes[change].with.clone()));
                pieces.push(text("; }"));
            }
            edit(*byte..*byte, (true, isize::MIN), pieces);
        }
        Switch::Arithmetic { whole, operator } => {
            let (range, order) = start(whole);
            edit(range, order, vec![text("(match (")]);
            edit(operator.clone(), (true, 0), vec![text(",")]);
            let mut pieces = vec![text(") { (left, right) => ")];
            pieces.extend(choice(&|with| format!("left {with} right"), &source[operator.clone()]));
            pieces.push(text(" })"));
            let (range, order) = end(whole);
            edit(range, order, pieces);
        }
        Switch::Comparison { whole, operator } => {
            let (range, order) = start(whole);
            edit(range, order, vec![text("(match (&(")]);
            edit(operator.clone(), (true, 0), vec![text("), &(")]);
            let mut pieces = vec![text(")) { (left, right) => ")];
            pieces
                .extend(choice(&|with| format!("*left {with} *right"), &source[operator.clone()]));
            pieces.push(text(" })"));
            let (range, order) = end(whole);
            edit(range, order, pieces);
        }
        Switch::Logic { whole, operator, is_and } => {
            let (change, number) = changes[0];
            let (range, order) = start(whole);
            edit(range, order, vec![text("(match (")]);
            let same = if *is_and { "!=" } else { "==" };
            let condition = format!(") {{ left => if left {same} {} {{ ", is_on(number));
            edit(operator.clone(), (true, 0), vec![Piece::Text(condition)]);
            let (range, order) = end(whole);
            edit(
                range,
                order,
                vec![text(" } else { left } "), Piece::Change(change, String::from("})"))],
            );
        }
        Switch::Unary { whole, operator } => {
            // The operator comes first, so the expression begins there.
            let (_, order) = start(whole);
            edit(operator.clone(), order, vec![text("(match (")]);
            let operator = &source[operator.clone()];
            let mut pieces = vec![text(") { value => ")];
            pieces.extend(choice(&|with| format!("{with}value"), operator));
            pieces.push(text(" })"));
            let (range, order) = end(whole);
            edit(range, order, pieces);
        }
        Switch::Assignment { whole, place, operator } => {
            let place = &source[place.clone()];
            edit(whole.start..operator.end, start(whole).1, vec![text("{ match (")]);
            let mut pieces = vec![text(") { right => ")];
            pieces
                .extend(choice(&|with| format!("{place} {with} right"), &source[operator.clone()]));
            pieces.push(text(" } }"));
            let (range, order) = end(whole);
            edit(range, order, pieces);
        }
        Switch::Arm(byte) => {
            let (change, number) = changes[0];
            let guard = format!(" if !{}", is_on(number));
            edit(*byte..*byte, (false, isize::MAX), vec![Piece::Change(change, guard)]);
        }
        Switch::Guard(guard) => {
            let (mut first, mut last) = (String::new(), String::from(")"));
            for &(change, number) in changes {
                if at.changes[change].with == "true" {
                    first = format!("({} || {first}", is_on(number));
                    last.push(')');
                } else {
                    first = format!("{first}!{} && ", is_on(number));
                }
            }
            edit(start(guard).0, (true, isize::MIN), vec![Piece::Text(first + "(")]);
            edit(end(guard).0, (false, isize::MAX), vec![Piece::Text(last)]);
        }
    }
}
