#[path = "random_buildings/totals.rs"]
#[allow(unused)]
mod totals;
fn main() {
    totals::aids();
}
