/// The finished runs of a sweep that is under way, kept so that a killed sweep goes on where it was.
#pragma once

#include <cstddef>
#include <filesystem>
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

/// What a journal holds.
struct SweepRecord {
  std::vector<std::string> layouts;  ///< headings of columns
  std::vector<SweepRow> rows;
  std::size_t length = 0;  ///< bytes of whole lines; what follows was cut off in writing
};

/// Reads a journal up to its first line that is not whole.
/// @throws std::runtime_error where it is the journal of another sweep, or none at all, saying what to do
[[nodiscard]] SweepRecord read_journal(const std::filesystem::path& file, const std::string& digest);

/// A journal that rows are appended to. Every line begins with its own digest, so that a torn one is known. A row that
/// append() has returned from outlives the process.
class SweepJournal {
 public:
  /// Begins a journal or goes on with one, without its torn end.
  /// @throws std::runtime_error as read_journal does, and where another process is at work on it
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
