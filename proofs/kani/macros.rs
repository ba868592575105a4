//! The attributes of the stand-in for Kani: they refuse what Kani refuses, in its words, and leave
//! a mark in the harness, by which `tests/harnesses` recognises which harnesses were compiled and how
//! far they are unwound. They prove nothing.

use proc_macro::{Delimiter, Group, Span, TokenStream, TokenTree};

/// Marks a harness: a function without parameters, generic ones included.
#[proc_macro_attribute]
pub fn proof(arguments: TokenStream, item: TokenStream) -> TokenStream {
    if let Some(argument) = arguments.into_iter().next() {
        return error(argument.span(), "unexpected argument for `proof`");
    }
    let mut signature = item.clone().into_iter().skip_while(|token| token.to_string() != "fn");
    let parameters = signature.nth(2);
    match parameters {
        Some(TokenTree::Group(group))
            if group.delimiter() == Delimiter::Parenthesis && group.stream().is_empty() =>
        {
            let allowed: TokenStream = "#[allow(dead_code)]".parse().unwrap();
            allowed.into_iter().chain(marked(item, "kani::proof", "")).collect()
        }
        Some(TokenTree::Group(group)) => {
            error(group.span(), "functions used as harnesses cannot have any arguments")
        }
        Some(token) => {
            error(token.span(), "the `proof` attribute cannot be applied to generic functions")
        }
        None => error(Span::call_site(), "the `proof` attribute can only be applied to functions"),
    }
}

/// How often the loops of a harness are unwound: an integer literal.
#[proc_macro_attribute]
pub fn unwind(arguments: TokenStream, item: TokenStream) -> TokenStream {
    let written = arguments.to_string();
    match written.parse::<u32>() {
        Ok(times) => marked(item, "kani::unwind", &format!(" {times}")),
        Err(_) => {
            let first = arguments.into_iter().next();
            error(
                first.map_or_else(Span::call_site, |token| token.span()),
                "invalid argument for `unwind` attribute, expected an integer",
            )
        }
    }
}

/// The function with a mark in its body. Only the compiler knows the path of the function; it notes
/// the variables that it is asked for (`--emit dep-info`), and so is asked for one of that name.
fn marked(item: TokenStream, attribute: &str, value: &str) -> TokenStream {
    let name = item.clone().into_iter().skip_while(|token| token.to_string() != "fn").nth(1);
    let mut tokens: Vec<TokenTree> = item.into_iter().collect();
    if let (Some(name), Some(TokenTree::Group(body))) = (name, tokens.pop()) {
        let variable = format!(r#"concat!("{attribute} ", module_path!(), "::{name}{value}")"#);
        let mark = format!("const _: Option<&str> = option_env!({variable});");
        let mut marked: TokenStream = mark.parse().unwrap();
        marked.extend(body.stream());
        tokens.push(Group::new(body.delimiter(), marked).into());
    }
    tokens.into_iter().collect()
}

fn error(at: Span, message: &str) -> TokenStream {
    let error: TokenStream = format!("::core::compile_error! {{ {message:?} }}").parse().unwrap();
    error
        .into_iter()
        .map(|mut token| {
            token.set_span(at);
            token
        })
        .collect()
}
