//! Copied into each package under test: which mutant is on. The environment selects one, or has the reached ones
//! recorded.

use std::io::Write as _;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

const NOT_READ: u32 = u32::MAX;
const RECORD: u32 = u32::MAX - 1;
const NONE: u32 = u32::MAX - 2;

static SELECTED: AtomicU32 = AtomicU32::new(NOT_READ);
static REACHED: [AtomicBool; COUNT] = [const { AtomicBool::new(false) }; COUNT];

#[inline(always)]
pub(crate) fn is_on(mutant: u32) -> bool {
    let selected = SELECTED.load(Relaxed);
    selected == mutant || selected >= RECORD && slowly(mutant)
}

#[cold]
fn slowly(mutant: u32) -> bool {
    if SELECTED.load(Relaxed) == NOT_READ {
        let selected = std::env::var("MUTANT").ok().and_then(|number| number.parse().ok());
        let record = std::env::var_os("MUTANTS_REACHED").is_some();
        SELECTED.store(if record { RECORD } else { selected.unwrap_or(NONE) }, Relaxed);
    }
    if SELECTED.load(Relaxed) == RECORD {
        if !REACHED[mutant as usize].swap(true, Relaxed) {
            let path = std::env::var_os("MUTANTS_REACHED").unwrap_or_default();
            let file = std::fs::OpenOptions::new().create(true).append(true).open(path);
            let written = file.and_then(|mut file| file.write_all(format!("{mutant}\n").as_bytes()));
            if let Err(error) = written {
                // Without it the mutant would seem to be reached by no test.
                eprintln!("MUTANTS_REACHED: {error}");
                std::process::exit(2);
            }
        }
        return false;
    }
    SELECTED.load(Relaxed) == mutant
}
