// The compiled half of the package: what the program does, as classes and functions without defaults and documentation.
// The package's Python files add both.

#include "bindings.hpp"
#include "monograin/version.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace monograin::python;
  module.attr("__version__") = std::string(monograin::version());
  add_errors(module);
  add_history(module);
  add_scenario(module);
  add_prepared(module);
  add_studies(module);
  add_models(module);
  add_laws(module);
}
