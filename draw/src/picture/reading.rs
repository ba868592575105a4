//! Reads pictures, for tests.

use resvg::usvg::roxmltree::{Document, Node};

/// The elements of a class.
pub(super) fn of_class<'a, 'i>(document: &'a Document<'i>, class: &str) -> Vec<Node<'a, 'i>> {
    let is = |node: &Node| node.attribute("class") == Some(class);
    document.descendants().filter(is).collect()
}

pub(super) fn number(node: Node, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

/// The numbers in a list such as `1,2 3,4`, or in path data such as `M1 2L3 4Z`.
pub(super) fn numbers(list: &str) -> Vec<f64> {
    list.split(|letter: char| letter.is_alphabetic() || [' ', ','].contains(&letter))
        .filter(|number| !number.is_empty())
        .map(|number| number.parse().unwrap())
        .collect()
}
