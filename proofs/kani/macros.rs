//! The attributes of the stand-in for Kani. They prove nothing. `proof` leaves a mark in the harness, by which
//! `tests/harnesses` recognises which harnesses were compiled.

use proc_macro::{Group, TokenStream, TokenTree};

/// Marks a harness. Only the compiler knows its path; it notes the variables that it is asked for
/// (`--emit dep-info`), and so is asked for one of that name.
#[proc_macro_attribute]
pub fn proof(_: TokenStream, item: TokenStream) -> TokenStream {
    let name = item.clone().into_iter().skip_while(|token| token.to_string() != "fn").nth(1);
    let mut tokens: Vec<TokenTree> = item.into_iter().collect();
    if let (Some(name), Some(TokenTree::Group(body))) = (name, tokens.pop()) {
        let variable = format!(r#"concat!("kani::proof ", module_path!(), "::{name}")"#);
        let mark = format!("const _: Option<&str> = option_env!({variable});");
        let mut marked: TokenStream = mark.parse().unwrap();
        marked.extend(body.stream());
        tokens.push(Group::new(body.delimiter(), marked).into());
    }
    let allowed: TokenStream = "#[allow(dead_code)]".parse().unwrap();
    allowed.into_iter().chain(tokens).collect()
}

/// How often the loops of a harness are unwound.
#[proc_macro_attribute]
pub fn unwind(_: TokenStream, item: TokenStream) -> TokenStream {
    item
}
