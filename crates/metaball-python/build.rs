//! Leaves Python's symbols to the interpreter that loads the module, where a linker has to be told so.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
