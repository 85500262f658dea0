//! Recompiles the crate when the Python package that it embeds changes, which includes new files.

fn main() {
    println!("cargo::rerun-if-changed=../../python/pydslrep_runtime");
}
