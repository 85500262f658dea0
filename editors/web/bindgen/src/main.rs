//! `pydslrep-bindgen INPUT.wasm OUTPUT_FOLDER`: the JavaScript module, the WebAssembly and the types.
//!
//! It is what `wasm-bindgen --target web` does, without the servers and clients that the tool around it brings along.

use std::env;
use std::process::ExitCode;

use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let [input, folder] = arguments.as_slice() else {
        eprintln!("usage: pydslrep-bindgen INPUT.wasm OUTPUT_FOLDER");
        return ExitCode::from(2);
    };
    match generate(input, folder) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:?}");
            ExitCode::FAILURE
        }
    }
}

fn generate(input: &str, folder: &str) -> Result<(), Box<dyn std::error::Error>> {
    let mut bindgen = Bindgen::new();
    bindgen.input_path(input).out_name("pydslrep").web(true)?.typescript(true);
    // Who loads it says where it is; and nobody debugs a release.
    bindgen.omit_default_module_path(true).remove_name_section(true).remove_producers_section(true);
    bindgen.generate(folder)?;
    Ok(())
}
