// Takes the place of the files that use HDF5 in a build without its header.

#include <stdexcept>

#include "history/table_file.hpp"

namespace monograin {

void expect_hdf5() {
  throw std::runtime_error(
      "this build of monograin has no HDF5; build it again where libhdf5-dev is installed, or use the format csv");
}

void write_hdf5(const std::filesystem::path& /*file*/, const Hdf5Frame& /*frame*/, const TableLines& /*lines*/) {
  expect_hdf5();
}

Table read_hdf5(const std::filesystem::path& file) {
  throw std::runtime_error(file.string() +
                           ": this build of monograin has no HDF5; build it again where libhdf5-dev is installed");
}

}  // namespace monograin
