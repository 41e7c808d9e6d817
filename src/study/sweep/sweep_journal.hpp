/// Journal of the finished runs of a sweep, from which an interrupted sweep continues.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
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

/// Waits for the lock of an open file or folder, until its descriptor is closed.
/// @param shown  its path in messages
/// @param waits  false: another process that has the lock is an error
/// @throws std::runtime_error naming the path: that another process has the lock, or why there is none, with a remedy
void lock(int descriptor, const std::filesystem::path& shown, bool waits);

/// Result of one run. Texts are as in the results: cells with commas between them, nothing quoted.
struct SweepRow {
  std::size_t run = 0;     ///< from 1
  std::string status;      ///< complete, stopped, failed, refused
  std::string reason;      ///< why it is not complete
  std::size_t layout = 0;  ///< index of the layout
  std::string cells;
};

/// Columns that the cells of rows belong to.
struct SweepLayout {
  std::string headings;
  std::size_t first_run = std::numeric_limits<std::size_t>::max();  ///< least number of a run with these columns

  [[nodiscard]] bool has_rows() const noexcept { return first_run != std::numeric_limits<std::size_t>::max(); }
};

/// An existing journal: the positions of its rows, which themselves stay in the file.
class SweepRecord {
 public:
  /// Reads a journal up to its first incomplete line.
  /// @throws std::runtime_error for the journal of another sweep, and for another file, with a remedy
  SweepRecord(const std::filesystem::path& file, const std::string& digest);

  struct Place {
    std::uint32_t run = 0;  ///< from 1
    bool is_complete = false;
    std::uint64_t begin = 0;
  };
  [[nodiscard]] const std::vector<Place>& rows() const noexcept { return rows_; }
  [[nodiscard]] const std::vector<SweepLayout>& layouts() const noexcept { return layouts_; }
  /// Number of bytes in complete lines; the rest of the file was cut off during writing.
  [[nodiscard]] std::uint64_t length() const noexcept { return length_; }

  /// @throws std::runtime_error where it cannot be read
  [[nodiscard]] SweepRow row(std::uint64_t begin);

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  std::vector<SweepLayout> layouts_;
  std::vector<Place> rows_;
  std::uint64_t length_ = 0;
  std::uint64_t position_ = 0;  ///< in the stream
};

/// A journal to which rows are appended. Every line begins with its own digest, by which an incomplete line is
/// recognized. Rows are gathered for a tenth of a second; a process that is killed loses no more than these.
class SweepJournal {
 public:
  /// Begins a journal or continues one, without its incomplete end.
  /// @throws std::runtime_error as SweepRecord, and if another process uses the journal
  SweepJournal(std::filesystem::path file, const std::string& digest);
  ~SweepJournal();  ///< flushes, but reports no error
  SweepJournal(const SweepJournal&) = delete;
  SweepJournal& operator=(const SweepJournal&) = delete;

  /// @param columns  headings of the row's cells; row.layout is ignored
  /// @throws std::runtime_error where rows cannot be written
  void append(const SweepRow& row, const std::string& columns);
  /// Writes the gathered rows. @throws std::runtime_error where they cannot be written
  void flush();

 private:
  void add_line(const std::string& payload);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::unordered_map<std::string, std::size_t> layouts_;
  std::string gathered_;  ///< complete lines
  std::chrono::steady_clock::time_point last_flush_{};
};

}  // namespace monograin
