//! The places of a source file at which it can be changed, and the changes: those of cargo-mutants.

use std::ops::Range;

use syn::spanned::Spanned as _;
use syn::visit::{self, Visit};
use syn::{Attribute, BinOp, Block, Expr, ImplItemFn, ReturnType, Type, UnOp};

/// A place, and how its text is switched between what it is and its changes.
pub struct Site {
    pub function: String,
    pub line: usize,
    pub switch: Switch,
    pub changes: Vec<Change>,
}

pub struct Change {
    /// For people, and for the list of equivalent mutants.
    pub name: String,
    /// What replaces the original: a value, an operator, or nothing, as the switch needs it.
    pub with: String,
}

/// Byte ranges are those of the file.
pub enum Switch {
    /// Returns a value at the beginning of the body, which is at this byte.
    Body(usize),
    /// Another operator on the same operands.
    Arithmetic { whole: Range<usize>, operator: Range<usize> },
    /// The same for a comparison, whose operands are not moved.
    Comparison { whole: Range<usize>, operator: Range<usize> },
    /// `&&` or `||`, each by the other.
    Logic { whole: Range<usize>, operator: Range<usize>, is_and: bool },
    /// Without its unary operator.
    Unary { whole: Range<usize>, operator: Range<usize> },
    /// Another operator of an assignment to the same place.
    Assignment { whole: Range<usize>, place: Range<usize>, operator: Range<usize> },
    /// An arm that is never taken; this byte is the end of its pattern.
    Arm(usize),
    /// A guard that is always or never true.
    Guard(Range<usize>),
}

/// All sites of a file.
///
/// # Errors
///
/// Returns an error if the file is not Rust.
pub fn sites(source: &str) -> syn::Result<Vec<Site>> {
    let file = syn::parse_file(source)?;
    let mut finder = Finder { source, scope: Vec::new(), sites: Vec::new() };
    finder.visit_file(&file);
    Ok(finder.sites)
}

/// The modules of a file that only tests contain.
pub fn test_modules(source: &str) -> Vec<String> {
    let items = syn::parse_file(source).map_or_else(|_| Vec::new(), |file| file.items);
    let mut names = Vec::new();
    for item in items {
        if let syn::Item::Mod(module) = item
            && module.content.is_none()
            && is_left_out(&module.attrs)
        {
            names.push(module.ident.to_string());
        }
    }
    names
}

struct Finder<'a> {
    source: &'a str,
    scope: Vec<String>,
    sites: Vec<Site>,
}

impl Finder<'_> {
    fn add(&mut self, at: proc_macro2::Span, switch: Switch, changes: Vec<Change>) {
        if !changes.is_empty() {
            let function = self.scope.join("::");
            self.sites.push(Site { function, line: at.start().line, switch, changes });
        }
    }

    fn text(&self, range: Range<usize>) -> String {
        let words: Vec<_> = self.source[range].split_whitespace().collect();
        words.join(" ")
    }

    /// The text of an expression, without its middle if it is long.
    fn short(&self, range: Range<usize>) -> String {
        let text: Vec<char> = self.text(range).chars().collect();
        if text.len() <= 60 {
            return text.into_iter().collect();
        }
        let (start, end) = (&text[..28], &text[text.len() - 28..]);
        start.iter().chain(&['…']).chain(end).collect()
    }

    fn body(&mut self, output: &ReturnType, block: &Block) {
        let values = match output {
            ReturnType::Default => vec!["()".to_owned()],
            ReturnType::Type(_, output) => values(output),
        };
        let body = block.span().byte_range();
        let original = self.text(body.start + 1..body.end - 1);
        let changes =
            values.into_iter().filter(|value| *value != original && !block.stmts.is_empty());
        let changes =
            changes.map(|with| Change { name: format!("returns {with}"), with }).collect();
        self.add(block.span(), Switch::Body(body.start + 1), changes);
    }

    fn in_scope(&mut self, name: String, visit: impl FnOnce(&mut Self)) {
        self.scope.push(name);
        visit(self);
        self.scope.pop();
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        if !is_left_out(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_fn(&mut self, function: &'ast syn::ItemFn) {
        if function.sig.constness.is_none() && !is_left_out(&function.attrs) {
            self.in_scope(function.sig.ident.to_string(), |finder| {
                finder.body(&function.sig.output, &function.block);
                finder.visit_block(&function.block);
            });
        }
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let of = item
            .trait_
            .as_ref()
            .and_then(|(_, path, _)| Some(path.segments.last()?.ident.to_string()));
        let name = match &*item.self_ty {
            Type::Path(path) => path.path.segments.last().map(|segment| segment.ident.to_string()),
            _ => None,
        };
        if !is_left_out(&item.attrs) && !matches!(of.as_deref(), Some("Debug" | "Default")) {
            self.in_scope(name.unwrap_or_default(), |finder| visit::visit_item_impl(finder, item));
        }
    }

    fn visit_item_trait(&mut self, item: &'ast syn::ItemTrait) {
        self.in_scope(item.ident.to_string(), |finder| visit::visit_item_trait(finder, item));
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        if function.sig.constness.is_none() && !is_left_out(&function.attrs) {
            self.in_scope(function.sig.ident.to_string(), |finder| {
                finder.body(&function.sig.output, &function.block);
                finder.visit_block(&function.block);
            });
        }
    }

    fn visit_trait_item_fn(&mut self, function: &'ast syn::TraitItemFn) {
        if let Some(block) = &function.default {
            self.in_scope(function.sig.ident.to_string(), |finder| {
                finder.body(&function.sig.output, block);
                finder.visit_block(block);
            });
        }
    }

    // What is computed when the program is compiled cannot be switched.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_trait_item_const(&mut self, _: &'ast syn::TraitItemConst) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_type(&mut self, _: &'ast Type) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_local(&mut self, local: &'ast syn::Local) {
        if let Some(init) = &local.init {
            visit::visit_local_init(self, init);
        }
    }

    fn visit_expr_binary(&mut self, binary: &'ast syn::ExprBinary) {
        let (whole, operator) = (binary.span().byte_range(), binary.op.span().byte_range());
        let text = self.text(operator.clone());
        let expression = format!(
            "{} {text} {}",
            self.short(whole.start..operator.start),
            self.short(operator.end..whole.end)
        );
        let others = others(&binary.op);
        let changes = others.iter().map(|with| Change {
            name: format!("{text} is {with} in `{expression}`"),
            with: (*with).to_owned(),
        });
        let changes = changes.collect();
        let switch = match &binary.op {
            BinOp::And(_) | BinOp::Or(_) if has_let(&binary.left) || has_let(&binary.right) => None,
            BinOp::And(_) | BinOp::Or(_) => {
                let is_and = matches!(binary.op, BinOp::And(_));
                Some(Switch::Logic { whole, operator, is_and })
            }
            BinOp::Eq(_)
            | BinOp::Ne(_)
            | BinOp::Lt(_)
            | BinOp::Le(_)
            | BinOp::Gt(_)
            | BinOp::Ge(_) => Some(Switch::Comparison { whole, operator }),
            BinOp::Add(_)
            | BinOp::Sub(_)
            | BinOp::Mul(_)
            | BinOp::Div(_)
            | BinOp::Rem(_)
            | BinOp::BitXor(_)
            | BinOp::BitAnd(_)
            | BinOp::BitOr(_)
            | BinOp::Shl(_)
            | BinOp::Shr(_) => Some(Switch::Arithmetic { whole, operator }),
            _ => {
                let place = binary.left.span().byte_range();
                Some(Switch::Assignment { whole, place, operator })
            }
        };
        // The place of an assignment is written out more than once, so nothing is switched in it.
        if !matches!(switch, Some(Switch::Assignment { .. })) {
            self.visit_expr(&binary.left);
        }
        if let Some(switch) = switch {
            self.add(binary.op.span(), switch, changes);
        }
        self.visit_expr(&binary.right);
    }

    fn visit_expr_unary(&mut self, unary: &'ast syn::ExprUnary) {
        let is_number = matches!(&*unary.expr, Expr::Lit(_));
        if matches!(unary.op, UnOp::Not(_)) || matches!(unary.op, UnOp::Neg(_)) && !is_number {
            let (whole, operator) = (unary.span().byte_range(), unary.op.span().byte_range());
            let name =
                format!("no {} in `{}`", self.text(operator.clone()), self.short(whole.clone()));
            let changes = vec![Change { name, with: String::new() }];
            self.add(unary.op.span(), Switch::Unary { whole, operator }, changes);
        }
        visit::visit_expr_unary(self, unary);
    }

    fn visit_expr_match(&mut self, matching: &'ast syn::ExprMatch) {
        let has_rest = matching
            .arms
            .iter()
            .any(|arm| matches!(arm.pat, syn::Pat::Wild(_)) && arm.guard.is_none());
        for arm in &matching.arms {
            let pattern = arm.pat.span().byte_range();
            let text = self.short(pattern.clone());
            if let Some((_, guard)) = &arm.guard {
                if !has_let(guard) {
                    let range = guard.span().byte_range();
                    let guard_text = self.short(range.clone());
                    let change = |value: &str| Change {
                        name: format!("guard `{guard_text}` is {value}"),
                        with: value.to_owned(),
                    };
                    self.add(
                        guard.span(),
                        Switch::Guard(range),
                        vec![change("true"), change("false")],
                    );
                }
            } else if has_rest && !matches!(arm.pat, syn::Pat::Wild(_)) {
                let changes =
                    vec![Change { name: format!("no arm `{text}`"), with: String::new() }];
                self.add(arm.pat.span(), Switch::Arm(pattern.end), changes);
            }
        }
        visit::visit_expr_match(self, matching);
    }
}

/// Whether an item is only part of tests.
fn is_left_out(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let path = attribute.path();
        path.is_ident("test")
            || path.is_ident("cfg")
                && attribute.meta.require_list().is_ok_and(|list| {
                    let text = list.tokens.to_string();
                    text.contains("test") && !text.contains("not") || text.contains("kani")
                })
    })
}

/// Whether a condition binds names, so that it cannot become an operand.
fn has_let(condition: &Expr) -> bool {
    match condition {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

/// The operators that replace an operator.
fn others(operator: &BinOp) -> &'static [&'static str] {
    match operator {
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::Lt(_) => &["==", ">", "<="],
        BinOp::Gt(_) => &["==", "<", ">="],
        BinOp::Le(_) => &[">"],
        BinOp::Ge(_) => &["<"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::Add(_) => &["-", "*"],
        BinOp::Sub(_) => &["+", "/"],
        BinOp::Mul(_) => &["+", "/"],
        BinOp::Div(_) => &["%", "*"],
        BinOp::Rem(_) => &["/", "+"],
        BinOp::Shl(_) => &[">>"],
        BinOp::Shr(_) => &["<<"],
        BinOp::BitAnd(_) => &["|", "^"],
        BinOp::BitOr(_) => &["&", "^"],
        BinOp::BitXor(_) => &["|", "&"],
        BinOp::AddAssign(_) => &["-=", "*="],
        BinOp::SubAssign(_) => &["+=", "/="],
        BinOp::MulAssign(_) => &["+=", "/="],
        BinOp::DivAssign(_) => &["%=", "*="],
        BinOp::RemAssign(_) => &["/=", "+="],
        BinOp::BitAndAssign(_) => &["|=", "^="],
        BinOp::BitOrAssign(_) => &["&=", "^="],
        BinOp::BitXorAssign(_) => &["|=", "&="],
        BinOp::ShlAssign(_) => &[">>="],
        BinOp::ShrAssign(_) => &["<<="],
        _ => &[],
    }
}

/// Values of a type that a function may return instead of what it computes. Those that the compiler does not accept
/// are dropped later.
fn values(of: &Type) -> Vec<String> {
    let list = |values: &[&str]| values.iter().map(|value| (*value).to_owned()).collect::<Vec<_>>();
    match of {
        Type::Tuple(tuple) => {
            let mut all = vec![String::from("(")];
            for element in &tuple.elems {
                let inner = values(element);
                all = all
                    .iter()
                    .flat_map(|start| inner.iter().map(move |value| format!("{start}{value}, ")))
                    .collect();
            }
            all.into_iter().map(|start| format!("{})", start.trim_end())).collect()
        }
        Type::Array(array) => {
            let inner = values(&array.elem);
            inner.into_iter().map(|value| format!("std::array::from_fn(|_| {value})")).collect()
        }
        Type::Reference(reference) => match &*reference.elem {
            Type::Slice(_) if reference.mutability.is_some() => list(&["&mut []"]),
            Type::Slice(_) => list(&["&[]"]),
            Type::Path(path) if path.path.is_ident("str") => list(&["\"\"", "\"xyzzy\""]),
            inner => {
                let inner = values(inner).into_iter();
                inner.map(|value| format!("Box::leak(Box::new({value}))")).collect()
            }
        },
        Type::Path(path) => {
            let Some(last) = path.path.segments.last() else { return Vec::new() };
            let inner = || match &last.arguments {
                syn::PathArguments::AngleBracketed(arguments) => {
                    arguments.args.iter().find_map(|argument| {
                        if let syn::GenericArgument::Type(inner) = argument {
                            Some(values(inner))
                        } else {
                            None
                        }
                    })
                }
                _ => None,
            };
            let wrapped = |start: &str, end: &str| {
                let inner = inner().unwrap_or_default().into_iter();
                inner.map(|value| format!("{start}{value}{end}")).collect::<Vec<_>>()
            };
            match &*last.ident.to_string() {
                "bool" => list(&["true", "false"]),
                "u8" | "u16" | "u32" | "u64" | "u128" | "usize" => list(&["0", "1"]),
                "i8" | "i16" | "i32" | "i64" | "i128" | "isize" => list(&["0", "1", "-1"]),
                "f32" | "f64" => list(&["0.0", "1.0", "-1.0"]),
                "String" => list(&["String::new()", "\"xyzzy\".into()"]),
                "Option" => [list(&["None"]), wrapped("Some(", ")")].concat(),
                "Vec" => [list(&["Vec::new()"]), wrapped("vec![", "]")].concat(),
                "Result" => wrapped("Ok(", ")"),
                "Box" => wrapped("Box::new(", ")"),
                _ => list(&["Default::default()"]),
            }
        }
        Type::Paren(inner) => values(&inner.elem),
        Type::Group(inner) => values(&inner.elem),
        _ => Vec::new(),
    }
}
