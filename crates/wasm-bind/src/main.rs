//! Makes WebAssembly callable from JavaScript: `wasm-bind FILE FOLDER`. It is the library of wasm-bindgen's
//! own program, which takes longer to compile.

use std::env;

use anyhow::{Result, bail};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<()> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    let [wasm, folder] = arguments.as_slice() else {
        bail!("arguments: needed a file of WebAssembly and a folder, found {}", arguments.len());
    };
    let mut bindgen = Bindgen::new();
    bindgen.web(true)?.typescript(false).remove_name_section(true).input_path(wasm).generate(folder)
}
