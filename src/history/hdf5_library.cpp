#include "history/hdf5_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "history/table_file.hpp"

namespace monograin {
namespace {

/// @throws std::runtime_error with a remedy if the library is not installed
[[nodiscard]] void* opened_library() {
  if (void* const library = dlopen(MONOGRAIN_HDF5_LIBRARY, RTLD_NOW | RTLD_LOCAL)) return library;
  throw std::runtime_error(
      fmt::format("HDF5 cannot be used: {}; install the library (on Debian: apt-get install libhdf5-103-1), or use the "
                  "format csv",
                  dlerror()));
}

/// The library, loaded by the first call and kept.
[[nodiscard]] const Hdf5Library& loaded_library() {
  static const Hdf5Library library;
  return library;
}

std::mutex in_use;

/// Keeps the description of the first, innermost error of the library's stack.
herr_t take_first(unsigned /*n*/, const H5E_error2_t* error, void* text) {
  *static_cast<std::string*>(text) = error->desc == nullptr ? "" : error->desc;
  return 1;  // ends the walk
}

}  // namespace

Hdf5Library::Hdf5Library() : library_(opened_library()) {}

Hdf5Library::Symbol Hdf5Library::symbol(const char* name) const {
  void* const address = dlsym(library_, name);
  if (address == nullptr) throw std::runtime_error(fmt::format("HDF5 cannot be used: {}", dlerror()));
  return {address};
}

void expect_hdf5() { static_cast<void>(loaded_library()); }

Hdf5Calls::Hdf5Calls(std::filesystem::path file, std::string_view problem)
    : library(loaded_library()), lock_(in_use), file_(std::move(file)), problem_(problem) {
  library.H5open();
  library.H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // nothing is printed by the library
}

Hdf5Object Hdf5Calls::text_type(std::size_t bytes) const { return text_type(bytes, H5T_STR_NULLPAD); }

Hdf5Object Hdf5Calls::variable_text_type() const { return text_type(H5T_VARIABLE, H5T_STR_NULLTERM); }

Hdf5Object Hdf5Calls::text_type(std::size_t bytes, H5T_str_t padding) const {
  Hdf5Object type = object(library.H5Tcopy(*library.text));
  check(library.H5Tset_size(type, bytes));
  check(library.H5Tset_cset(type, H5T_CSET_UTF8));
  check(library.H5Tset_strpad(type, padding));
  return type;
}

void Hdf5Calls::add_text(hid_t owner, const char* name, const std::string& text) const {
  const Hdf5Object type = variable_text_type();
  const Hdf5Object space = object(library.H5Screate(H5S_SCALAR));
  const Hdf5Object attribute = object(library.H5Acreate2(owner, name, type, space, H5P_DEFAULT, H5P_DEFAULT));
  const char* const begin = text.c_str();
  check(library.H5Awrite(attribute, type, &begin));
}

std::string Hdf5Calls::text_at(hid_t owner, const char* name) const {
  const Hdf5Object attribute = object(library.H5Aopen(owner, name, H5P_DEFAULT));
  const Hdf5Object space = object(library.H5Aget_space(attribute));
  if (library.H5Sget_simple_extent_npoints(space) != 1) fail(fmt::format("attribute {} is not one text", name));
  const Hdf5Object type = variable_text_type();
  char* begin = nullptr;
  check(library.H5Aread(attribute, type, &begin));
  std::string text(begin == nullptr ? "" : begin);
  library.H5free_memory(begin);
  return text;
}

void Hdf5Calls::fail(std::string_view reason) const {
  throw std::runtime_error(fmt::format("{}: {}: {}", file_.string(), problem_, reason));
}

std::string Hdf5Calls::reason() const {
  std::string text;
  library.H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &text);
  // Errors of the system: only the text of errno.
  constexpr std::string_view k_before = "error message = '";
  const std::size_t begin = text.find(k_before);
  if (begin == std::string::npos) return text.empty() ? "the library of HDF5 gives no reason" : text;
  text.erase(0, begin + k_before.size());
  return text.substr(0, text.find('\''));
}

}  // namespace monograin
