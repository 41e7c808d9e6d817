/// Journal of the finished runs of a sweep, from which an interrupted sweep continues.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace monograin {

/// Digest of lines, in the order in which they are added.
class LinesDigest {
 public:
  static constexpr std::size_t k_digits = 16;  ///< of word()

  void add(std::string_view line) noexcept;
  [[nodiscard]] std::string word() const;

 private:
  std::uint64_t value_ = 0;
};

/// True for a journal of the sweep with this digest, whatever its rows; false for another file, and for none.
[[nodiscard]] bool is_journal_of(const std::filesystem::path& file, const std::string& digest);

/// Result of one run. Texts are as in the results: cells with commas between them, nothing quoted.
struct SweepRow {
  std::size_t run = 0;     ///< from 1
  std::string status;      ///< complete, stopped, failed, refused
  std::string reason;      ///< why it is not complete
  std::size_t layout = 0;  ///< index of the columns that the cells belong to
  std::string cells;
};

/// An existing journal: the positions of its rows, which themselves stay in the file.
class SweepRecord {
 public:
  /// Reads a journal up to its first incomplete line.
  /// @throws std::runtime_error for the journal of another sweep, and for another file, with a remedy
  SweepRecord(const std::filesystem::path& file, const std::string& digest);

  struct Place {
    std::size_t run = 0;  ///< from 1
    std::uint64_t begin = 0;
  };
  [[nodiscard]] const std::vector<Place>& rows() const noexcept { return rows_; }
  /// Headings of columns.
  [[nodiscard]] const std::vector<std::string>& layouts() const noexcept { return layouts_; }
  /// Number of bytes in complete lines; the rest of the file was cut off during writing.
  [[nodiscard]] std::uint64_t length() const noexcept { return length_; }

  /// @throws std::runtime_error where it cannot be read
  [[nodiscard]] SweepRow row(std::uint64_t begin);

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::vector<std::string> layouts_;
  std::vector<Place> rows_;
  std::uint64_t length_ = 0;
};

/// A journal to which rows are appended. Every line begins with its own digest, by which an incomplete line is
/// recognized. When append() has returned, the row survives the end of the process.
class SweepJournal {
 public:
  /// Begins a journal or continues one, without its incomplete end.
  /// @throws std::runtime_error as SweepRecord, and if another process uses the journal
  SweepJournal(std::filesystem::path file, const std::string& digest);
  ~SweepJournal();
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;

  /// @param columns  headings of the row's cells; row.layout is ignored
  /// @throws std::runtime_error where the row cannot be written
  void append(const SweepRow& row, const std::string& columns);

 private:
  void write(const std::string& payload);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::unordered_map<std::string, std::size_t> layouts_;
};

}  // namespace monograin
