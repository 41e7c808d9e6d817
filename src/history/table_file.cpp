#include "history/table_file.hpp"

namespace monograin {

Table read_table_file(const std::filesystem::path& file, FileKind kind) {
  return file.extension() == k_hdf5_extension ? read_hdf5(file) : read_csv(file, kind);
}

}  // namespace monograin
