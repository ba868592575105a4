//! Values that are cloned into the memory of others.

/// Implements `Clone` for a struct with these fields, which must be all of them, so that `clone_from` reuses the
/// memory of each field. The derived one drops all and clones. Fields after `scratch` have no meaning between two
/// calls: they are not copied, and `clear` is called on each.
macro_rules! clone_in_place {
    ($type:ident { $($field:ident),* $(; scratch $($scratch:ident),*)? $(,)? }) => {
        impl Clone for $type {
            fn clone(&self) -> Self {
                Self { $($field: self.$field.clone()),* $(, $($scratch: Default::default()),*)? }
            }

            #[inline]
            fn clone_from(&mut self, source: &Self) {
                let Self { $($field),* $(, $($scratch: _),*)? } = source;
                $(self.$field.clone_from($field);)*
                $($(self.$scratch.clear();)*)?
            }
        }
    };
}

pub(crate) use clone_in_place;
