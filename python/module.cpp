// Compiled module of the Python package: classes and functions without default arguments and documentation. The Python
// files of the package add both.

#include "bindings.hpp"
#include "interruptible.hpp"
#include "monograin/version.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace monograin::python;
  main_thread() = py::module_::import("threading").attr("main_thread")().attr("ident").cast<unsigned long>();
  module.attr("__version__") = std::string(monograin::version());
  add_errors(module);
  add_history(module);
  add_scenario(module);
  add_continuum(module);
  add_prepared(module);
  add_studies(module);
  add_models(module);
  add_laws(module);
}
