// Reads tables from HDF5.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <unordered_map>

#include "history/hdf5_library.hpp"
#include "history/table_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// Part of a column that is read at once [bytes].
constexpr std::size_t k_bytes_of_block = std::size_t{1} << 17U;
// Bounds of files that are read, which may claim any size: cells, and bytes of a word.
constexpr std::size_t k_most_stored_cells = 1'000'000'000;
constexpr std::size_t k_longest_word = std::size_t{1} << 20U;

/// A dataset of a column. Words are read at once, numbers block by block.
class ColumnReader {
 public:
  ColumnReader(const Hdf5Calls& calls, Hdf5Object dataset) : calls_(&calls), dataset_(std::move(dataset)) {
    const Hdf5Library& hdf5 = calls.library;
    const Hdf5Object space = calls.object(hdf5.H5Dget_space(dataset_));
    if (hdf5.H5Sget_simple_extent_ndims(space) != 1) calls.fail("a dataset has not one dimension");
    rows_ = static_cast<std::size_t>(calls.check(hdf5.H5Sget_simple_extent_npoints(space)));
    column_ = {.name = calls.text_at(dataset_, "name"), .unit = calls.text_at(dataset_, "unit")};
  }

  /// To be called first; apart, so that the size of the whole table is known before.
  void read_words() {
    const Hdf5Library& hdf5 = calls_->library;
    const Hdf5Object type = calls_->object(hdf5.H5Dget_type(dataset_));
    if (hdf5.H5Tget_class(type) == H5T_STRING) read_words(hdf5.H5Tget_size(type));
  }

  [[nodiscard]] const Column& column() const noexcept { return column_; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }

  /// Values of some rows; of words their indices.
  void read(std::size_t first, std::vector<double>& values) const {
    if (column_.holds_words()) {
      std::copy_n(words_.begin() + static_cast<std::ptrdiff_t>(first), values.size(), values.begin());
    } else {
      read_cells(first, values.size(), *calls_->library.own_double, values.data());
    }
  }

 private:
  void read_cells(std::size_t first, hsize_t count, hid_t type, void* cells) const {
    const Hdf5Library& hdf5 = calls_->library;
    const hsize_t begin = first;
    const Hdf5Object space = calls_->object(hdf5.H5Dget_space(dataset_));
    calls_->check(hdf5.H5Sselect_hyperslab(space, H5S_SELECT_SET, &begin, nullptr, &count, nullptr));
    const Hdf5Object memory = calls_->object(hdf5.H5Screate_simple(1, &count, nullptr));
    calls_->check(hdf5.H5Dread(dataset_, type, memory, space, H5P_DEFAULT, cells));
  }

  void read_words(std::size_t bytes) {
    if (bytes == 0 || bytes > k_longest_word) calls_->fail("a dataset has other words than of 1 byte to 1 MiB");
    const Hdf5Object type = calls_->text_type(bytes);
    const std::size_t rows_of_block = std::max<std::size_t>(k_bytes_of_block / bytes, 1);
    std::unordered_map<std::string, std::size_t> indices;
    std::string block;
    for (std::size_t first = 0; first < rows_; first += rows_of_block) {
      const std::size_t count = std::min(rows_of_block, rows_ - first);
      block.resize(count * bytes);
      read_cells(first, count, type, block.data());
      for (std::size_t k = 0; k < count; ++k) {
        const char* const cell = block.data() + k * bytes;
        const auto [entry, is_new] = indices.try_emplace(std::string(cell, strnlen(cell, bytes)), indices.size());
        if (is_new) column_.labels.push_back(entry->first);
        words_.push_back(static_cast<double>(entry->second));
      }
    }
    // A column without rows is one of words, too.
    if (column_.labels.empty()) column_.labels.emplace_back();
  }

  const Hdf5Calls* calls_;
  Hdf5Object dataset_;
  Column column_{};
  std::size_t rows_ = 0;
  std::vector<double> words_{};
};

/// Adds the datasets of a file and its groups, in the order in which they were written.
/// @param is_top  false in a group, which has no groups
void add_columns(const Hdf5Calls& calls, hid_t group, bool is_top, std::vector<ColumnReader>& columns) {
  const Hdf5Library& hdf5 = calls.library;
  H5G_info_t info{};
  calls.check(hdf5.H5Gget_info(group, &info));
  for (hsize_t k = 0; k < info.nlinks; ++k) {
    Hdf5Object object = calls.object(hdf5.H5Oopen_by_idx(group, ".", H5_INDEX_CRT_ORDER, H5_ITER_INC, k, H5P_DEFAULT));
    if (is_top && hdf5.H5Iget_type(object) == H5I_GROUP) {
      add_columns(calls, object, false, columns);
    } else {
      columns.emplace_back(calls, std::move(object));
    }
  }
}

/// Header lines at the beginning of a file.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> header_of(const fs::path& file) {
  std::vector<std::pair<std::string, std::string>> header;
  std::ifstream in(file, std::ios::binary);
  for (std::string line; in.peek() == '#' && std::getline(in, line);) header.push_back(parsed_header_line(line));
  return header;
}

}  // namespace

Table read_hdf5(const fs::path& file, std::string_view only) {
  const Hdf5Calls calls(file, "cannot be read as a table in HDF5");
  const Hdf5Object access = calls.object(calls.library.H5Pcreate(*calls.library.file_access));
  calls.check(calls.library.H5Pset_file_locking(access, false, true));  // some network file systems refuse a lock
  const Hdf5Object whole = calls.object(calls.library.H5Fopen(file.c_str(), H5F_ACC_RDONLY, access));
  std::vector<ColumnReader> columns;
  add_columns(calls, whole, true, columns);
  if (!only.empty()) std::erase_if(columns, [&](const ColumnReader& column) { return column.column().name != only; });
  if (columns.empty()) calls.fail("it has no dataset");
  const std::size_t rows = columns.front().rows();
  if (rows > k_most_stored_cells / columns.size()) calls.fail("it is too large; expected at most 1000 million cells");
  std::vector<Column> descriptions;
  for (ColumnReader& column : columns) {
    if (column.rows() != rows) calls.fail("its datasets have different lengths");
    column.read_words();
    descriptions.push_back(column.column());
  }
  Table table(std::move(descriptions));
  table.header = header_of(file);
  table.reserve_rows(rows);
  std::vector<std::vector<double>> block(columns.size());
  std::vector<double> row(columns.size());
  constexpr std::size_t k_rows_of_block = k_bytes_of_block / sizeof(double);
  for (std::size_t first = 0; first < rows; first += k_rows_of_block) {
    const std::size_t count = std::min(k_rows_of_block, rows - first);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      block[k].resize(count);
      columns[k].read(first, block[k]);
    }
    for (std::size_t r = 0; r < count; ++r) {
      for (std::size_t k = 0; k < columns.size(); ++k) row[k] = block[k][r];
      table.append(row);
    }
  }
  return table;
}

}  // namespace monograin
