//! What people look at: pictures of worlds and runs ([`picture`]), pages for a browser ([`page`]), the story of a mapping
//! run ([`story`]) and the steps of an explorer's run ([`explorer_run`]).

// Tests compare exact numbers.
#![cfg_attr(test, allow(clippy::float_cmp))]

pub mod explorer_run;
pub mod moment;
pub mod page;
pub mod picture;
pub mod run_page_data;
pub mod scene;
pub mod story;
pub mod text;
