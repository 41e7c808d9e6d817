// Writes tables as HDF5.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "history/hdf5_output.hpp"
#include "history/table_file.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// Part of a column that is compressed and written at once [bytes].
constexpr std::size_t k_bytes_of_chunk = std::size_t{1} << 17U;
/// The fastest compression, after a shuffle of bytes, takes a million runs to 57 % of their size; the highest takes 1.4
/// times as long for 2 % less.
constexpr unsigned k_compression = 1;

/// Calls a function with the index and the text of each cell of a line.
/// @return number of cells
template <class Visit>
std::size_t for_each_cell(std::string_view line, Visit&& visit) {
  for (std::size_t k = 0;; ++k) {
    const std::size_t comma = line.find(',');
    visit(k, line.substr(0, comma));
    if (comma == std::string_view::npos) return k + 1;
    line.remove_prefix(comma + 1);
  }
}

/// A column and how its cells are stored.
struct StoredColumn {
  Column column;
  std::size_t bytes = 1;     ///< of the longest cell
  bool has_numbers = false;  ///< a cell without a unit is a number
  bool has_words = false;    ///< a cell without a unit is neither a number nor empty

  [[nodiscard]] bool holds_words() const { return column.unit.empty() && (has_words || !has_numbers); }
};

struct Layout {
  std::vector<StoredColumn> columns{};
  std::size_t rows = 0;
};

/// Reads all lines for what a file has to declare before its first row.
[[nodiscard]] Layout layout_of(const TableLines& lines) {
  Layout layout;
  std::vector<StoredColumn>& columns = layout.columns;
  const auto take_cell = [&](std::size_t k, std::string_view cell) {
    if (k >= columns.size() || !columns[k].column.unit.empty()) return;
    StoredColumn& own = columns[k];
    own.bytes = std::max(own.bytes, cell.size());
    if (own.has_words) return;
    const bool is_number = parsed_number(cell).has_value();
    own.has_numbers |= is_number;
    own.has_words = !is_number && !cell.empty();
  };
  bool has_headings = false;
  lines([&](std::string_view line) {
    if (!has_headings) {
      for_each_cell(line, [&](std::size_t, std::string_view heading) { columns.push_back({parsed_heading(heading)}); });
      has_headings = true;
      return;
    }
    ++layout.rows;
    const std::size_t cells = for_each_cell(line, take_cell);
    if (cells != columns.size()) {
      throw std::invalid_argument(fmt::format("row {} has {} cells; expected {}", layout.rows, cells, columns.size()));
    }
  });
  return layout;
}

/// A dataset that is written chunk by chunk.
class ColumnWriter {
 public:
  ColumnWriter(const Hdf5Calls& calls, hid_t group, const StoredColumn& stored, std::size_t rows)
      : calls_(&calls),
        column_(stored.column),
        holds_words_(stored.holds_words()),
        bytes_(holds_words_ ? stored.bytes : sizeof(double)),
        chunk_(std::clamp<std::size_t>(k_bytes_of_chunk / bytes_, 1, std::max<std::size_t>(rows, 1))),
        text_type_(holds_words_ ? calls.text_type(bytes_) : Hdf5Object(calls.library, H5I_INVALID_HID)),
        space_(space_of(rows)),
        dataset_(dataset_in(group)) {
    calls.add_text(dataset_, "name", column_.name);
    calls.add_text(dataset_, "unit", column_.unit);
  }

  void add(std::string_view cell) {
    if (holds_words_) {
      words_.append(cell);
      words_.resize(words_.size() + bytes_ - cell.size(), '\0');
    } else {
      numbers_.push_back(number_in(cell));
    }
    if (++waiting_ == chunk_) flush();
  }

  /// Writes the cells that wait for their chunk to be full.
  void flush() {
    if (waiting_ == 0) return;
    const Hdf5Library& hdf5 = calls_->library;
    const Hdf5Object memory = space_of(waiting_);
    calls_->check(hdf5.H5Sselect_hyperslab(space_, H5S_SELECT_SET, &written_, nullptr, &waiting_, nullptr));
    const void* cells = holds_words_ ? static_cast<const void*>(words_.data()) : numbers_.data();
    const hid_t type = holds_words_ ? static_cast<hid_t>(text_type_) : *hdf5.own_double;
    calls_->check(hdf5.H5Dwrite(dataset_, type, memory, space_, H5P_DEFAULT, cells));
    written_ += std::exchange(waiting_, 0);
    words_.clear();
    numbers_.clear();
  }

 private:
  [[nodiscard]] Hdf5Object space_of(hsize_t rows) const {
    return calls_->object(calls_->library.H5Screate_simple(1, &rows, nullptr));
  }

  /// An empty cell is undefined.
  [[nodiscard]] double number_in(std::string_view cell) const {
    if (cell.empty()) return k_nan;
    if (const std::optional<double> number = parsed_number(cell)) return *number;
    throw std::invalid_argument(fmt::format("'{}' in column {} is no number", cell, column_.heading()));
  }

  [[nodiscard]] Hdf5Object dataset_in(hid_t group) const {
    const Hdf5Library& hdf5 = calls_->library;
    const Hdf5Object creation = calls_->object(hdf5.H5Pcreate(*hdf5.dataset_creation));
    calls_->check(hdf5.H5Pset_chunk(creation, 1, &chunk_));
    calls_->check(hdf5.H5Pset_shuffle(creation));
    calls_->check(hdf5.H5Pset_deflate(creation, k_compression));
    calls_->check(hdf5.H5Pset_obj_track_times(creation, false));
    // Chunks are written whole: a cache would keep a copy of each.
    const Hdf5Object access = calls_->object(hdf5.H5Pcreate(*hdf5.dataset_access));
    calls_->check(hdf5.H5Pset_chunk_cache(access, 0, 0, 1.0));
    const hid_t stored_type = holds_words_ ? static_cast<hid_t>(text_type_) : *hdf5.stored_double;
    std::string name = column_.name;
    std::ranges::replace(name, '/', ':');
    return calls_->object(hdf5.H5Dcreate2(group, name.c_str(), stored_type, space_, H5P_DEFAULT, creation, access));
  }

  const Hdf5Calls* calls_;
  Column column_;
  bool holds_words_;
  std::size_t bytes_;     ///< of a cell
  hsize_t chunk_;         ///< rows
  Hdf5Object text_type_;  ///< none for numbers
  Hdf5Object space_;
  Hdf5Object dataset_;
  hsize_t written_ = 0;  ///< rows
  hsize_t waiting_ = 0;  ///< rows
  std::string words_{};
  std::vector<double> numbers_{};
};

/// Links of a file or a group keep the order in which they are made, and nothing has a time.
[[nodiscard]] Hdf5Object ordered(const Hdf5Calls& calls, hid_t kind) {
  Hdf5Object creation = calls.object(calls.library.H5Pcreate(kind));
  calls.check(calls.library.H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED));
  calls.check(calls.library.H5Pset_obj_track_times(creation, false));
  return creation;
}

}  // namespace

void write_hdf5(const fs::path& file, const Hdf5Frame& frame, const TableLines& lines) {
  const Layout layout = layout_of(lines);
  const Hdf5Calls calls(frame.shown_as.empty() ? file : frame.shown_as, "cannot be written");
  const Hdf5Library& hdf5 = calls.library;
  const Hdf5Object creation = ordered(calls, *hdf5.file_creation);
  calls.check(hdf5.H5Pset_userblock(creation, frame.free_bytes));
  const Hdf5Output output(calls);
  Hdf5Object whole(hdf5, hdf5.H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, output.access()));
  output.check();
  calls.check(static_cast<hid_t>(whole));
  for (const auto& [name, text] : frame.attributes) calls.add_text(whole, name.c_str(), text);
  {
    const Hdf5Object group_creation = ordered(calls, *hdf5.group_creation);
    std::map<std::string, Hdf5Object> groups;
    std::vector<ColumnWriter> columns;
    for (const StoredColumn& stored : layout.columns) {
      const std::string name = frame.group_of(stored.column);
      if (!name.empty() && !groups.contains(name)) {
        groups.emplace(name,
                       calls.object(hdf5.H5Gcreate2(whole, name.c_str(), H5P_DEFAULT, group_creation, H5P_DEFAULT)));
      }
      columns.emplace_back(calls, name.empty() ? static_cast<hid_t>(whole) : groups.at(name), stored, layout.rows);
    }
    bool has_headings = false;
    lines([&](std::string_view line) {
      if (!std::exchange(has_headings, true)) return;
      for_each_cell(line, [&](std::size_t k, std::string_view cell) { columns.at(k).add(cell); });
      output.check();
    });
    for (ColumnWriter& column : columns) column.flush();
  }
  // The last part of the content is written here.
  calls.check(hdf5.H5Fclose(whole.release()));
  output.check();
}

}  // namespace monograin
