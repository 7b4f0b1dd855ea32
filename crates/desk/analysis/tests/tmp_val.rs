#![allow(dead_code, unreachable_pub, missing_docs)]
#[path = "../../../../validation/src/folds.rs"]
mod folds;
#[path = "../../../../validation/src/random.rs"]
mod random;
#[path = "../../../../validation/src/row.rs"]
mod row;
#[path = "../../../../validation/src/wake_analysis.rs"]
mod wake_analysis;
use row::Row;
#[test]
fn all() {
    for row in wake_analysis::wake_analysis() {
        println!("{} | {} | {} | {:?} | {} {}", row.passes(), row.measured, row.expected, row.tolerance, row.unit, row.what);
    }
}
