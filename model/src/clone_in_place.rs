//! Values that are cloned into the memory of others.

/// Implements `Clone` for a struct with these fields, which must be all of them, so that `clone_from` reuses the
/// memory of each field. The derived one drops all and clones.
macro_rules! clone_in_place {
    ($type:ident { $($field:ident),* $(,)? }) => {
        impl Clone for $type {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone()),* }
            }

            #[inline]
            fn clone_from(&mut self, source: &Self) {
                let Self { $($field),* } = source;
                $(self.$field.clone_from($field);)*
            }
        }
    };
}

pub(crate) use clone_in_place;
