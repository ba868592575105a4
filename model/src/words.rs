//! Enumerations whose values have names, as in options and JSON.

/// Declares enumerations: for each value its name. `ALL` has the values in their order, and `Display` prints the name.
///
/// ```
/// toposlam_model::words! {
///     /// The hand that follows a wall.
///     Hand { Left = "left", Right = "right" }
/// }
/// assert_eq!(Hand::ALL.map(Hand::name), ["left", "right"]);
/// assert_eq!(Hand::Left.to_string(), "left");
/// ```
#[macro_export]
macro_rules! words {
    ($($(#[$meta:meta])* $name:ident { $($(#[$doc:meta])* $value:ident = $word:literal),* $(,)? })*) => {$(
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum $name {
            $($(#[$doc])* $value,)*
        }

        impl $name {
            pub const ALL: [Self; [$($word),*].len()] = [$(Self::$value),*];

            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$value => $word,)*
                }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                out.pad(self.name())
            }
        }
    )*};
}
