//! The floor plans in `worlds/`, compiled into the program.

use std::sync::Arc;

use toposlam_model::{
    floor_plan::FloorPlan,
    format::world_file::{self, WorldFileError},
};

pub type NamedPlan = (String, Arc<FloorPlan>);

/// The world files of `worlds/` that are floor plans.
const PLANS: [(&str, &[u8]); 4] = [
    ("building-12", include_bytes!("../../worlds/building-12.toml")),
    ("building-25", include_bytes!("../../worlds/building-25.toml")),
    ("shape-6", include_bytes!("../../worlds/shape-6.toml")),
    ("shape-8", include_bytes!("../../worlds/shape-8.toml")),
];

/// The floor plans of `worlds/`, with their names.
pub fn plans() -> Result<Vec<NamedPlan>, WorldFileError> {
    let mut plans = Vec::new();
    for (name, text) in PLANS {
        if let Some(plan) = world_file::read(text)?.plan {
            plans.push((name.to_owned(), Arc::new(plan)));
        }
    }
    Ok(plans)
}

/// The floor plan of `worlds/` with this name.
pub fn plan_named(name: &str) -> Option<Arc<FloorPlan>> {
    plans().ok()?.into_iter().find(|(known, _)| known == name).map(|(_, plan)| plan)
}

#[cfg(test)]
mod tests {
    use std::{fs, path::Path};

    use super::*;

    #[test]
    fn all_floor_plans_of_worlds_are_included() {
        let worlds = Path::new(env!("CARGO_MANIFEST_DIR")).join("../worlds");
        let files = fs::read_dir(worlds).unwrap().map(|entry| entry.unwrap().path());
        let mut names: Vec<_> = files
            .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
            .filter(|path| world_file::read(&fs::read(path).unwrap()).unwrap().plan.is_some())
            .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
            .collect();
        names.sort();
        let known: Vec<_> = plans().unwrap().into_iter().map(|(name, _)| name).collect();
        assert_eq!(known, names);
    }
}
