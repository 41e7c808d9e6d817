/// The finished runs of a sweep that is under way, kept so that a killed sweep goes on where it was.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <unordered_map>
#include <vector>

namespace monograin {

/// What one run has come to. Texts are as in the results: cells with commas between them, nothing quoted.
struct SweepRow {
  std::size_t run = 0;     ///< from 1
  std::string status;      ///< complete, stopped, failed, refused
  std::string reason;      ///< why it is not complete
  std::size_t layout = 0;  ///< which columns the cells belong to
  std::string cells;
};

/// A journal as it is found: where its rows are, which themselves stay in the file.
class SweepRecord {
 public:
  /// Reads a journal up to its first line that is not whole.
  /// @throws std::runtime_error where it is the journal of another sweep, or none at all, saying what to do
  SweepRecord(const std::filesystem::path& file, const std::string& digest);

  struct Place {
    std::size_t run = 0;  ///< from 1
    std::uint64_t begin = 0;
  };
  [[nodiscard]] const std::vector<Place>& rows() const noexcept { return rows_; }
  /// Headings of columns.
  [[nodiscard]] const std::vector<std::string>& layouts() const noexcept { return layouts_; }
  /// Bytes of whole lines; what follows was cut off in writing.
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

/// A journal that rows are appended to. Every line begins with its own digest, so that a torn one is known. A row that
/// append() has returned from outlives the process.
class SweepJournal {
 public:
  /// Begins a journal or goes on with one, without its torn end.
  /// @throws std::runtime_error as SweepRecord does, and where another process is at work on it
  SweepJournal(std::filesystem::path file, const std::string& digest);
  ~SweepJournal();
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;

  /// @param columns  headings of the row's cells; its layout does not count
  /// @throws std::runtime_error where the row cannot be written
  void append(const SweepRow& row, const std::string& columns);

 private:
  void write(const std::string& payload);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::unordered_map<std::string, std::size_t> layouts_;
};

}  // namespace monograin
