#include "study/sweep/sweep_journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "history/run.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

// Kinds of lines, which stand before the first comma.
constexpr std::string_view k_journal = "monograin-sweep";
constexpr std::string_view k_columns = "columns";
constexpr std::string_view k_row = "row";

constexpr std::chrono::milliseconds k_longest_gathering{100};

[[noreturn]] void fail(const fs::path& file, std::string_view problem) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), problem));
}

[[nodiscard]] std::string line_digest(std::string_view payload) {
  LinesDigest digest;
  digest.add(payload);
  return digest.word();
}

/// Content of a line without its digest; none if the line was not written completely.
[[nodiscard]] std::optional<std::string_view> payload_of(std::string_view line) {
  constexpr std::size_t k_digits = LinesDigest::k_digits;
  if (line.size() <= k_digits || line[k_digits] != ' ') return std::nullopt;
  const std::string_view payload = line.substr(k_digits + 1);
  return line.substr(0, k_digits) == line_digest(payload) ? std::optional(payload) : std::nullopt;
}

/// Removes the first cell, up to the next comma, from the text and returns it.
std::string_view take_cell(std::string_view& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::string_view cell = text.substr(0, comma);
  text.remove_prefix(std::min(comma + 1, text.size()));
  return cell;
}

/// Number of rows in the complete lines that follow in a journal.
[[nodiscard]] std::size_t count_rows(std::istream& journal) {
  std::size_t count = 0;
  for (std::string line; std::getline(journal, line) && !journal.eof();) {
    const std::optional<std::string_view> payload = payload_of(line);
    if (!payload) break;
    if (payload->starts_with(k_row) && payload->substr(k_row.size()).starts_with(',')) ++count;
  }
  return count;
}

[[nodiscard]] std::size_t to_count(std::string_view cell) {
  std::size_t count = 0;
  std::from_chars(cell.data(), cell.data() + cell.size(), count);
  return count;
}

/// @param text  of a line, after its kind
[[nodiscard]] SweepRow row_of(std::string_view text) {
  SweepRow row;
  row.run = to_count(take_cell(text));
  row.status = take_cell(text);
  row.reason = take_cell(text);
  row.layout = to_count(take_cell(text));
  row.cells = text;
  return row;
}

}  // namespace

void LinesDigest::add(std::string_view line) noexcept {
  value_ = XXH3_64bits_withSeed(line.data(), line.size(), value_);
}

std::string LinesDigest::word() const { return fmt::format("{:0{}x}", value_, k_digits); }

void lock(int descriptor, const fs::path& shown, bool waits) {
  while (flock(descriptor, waits ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
    if (errno == EINTR) continue;
    if (errno == EWOULDBLOCK) fail(shown, "another process is at work on this sweep");
    fail(shown,
         fmt::format("cannot be locked: {}; choose a folder on a local disk, and move the journals of all shards "
                     "into one folder to merge them",
                     std::strerror(errno)));
  }
}

bool is_journal_of(const fs::path& file, const std::string& digest) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  std::getline(stream, line);
  return payload_of(line) == fmt::format("{},{}", k_journal, digest);
}

SweepRecord::SweepRecord(const fs::path& file, const std::string& digest)
    : file_(file), stream_(file, std::ios::binary) {
  if (!stream_.is_open()) fail(file, "cannot be read");
  for (std::string line; std::getline(stream_, line) && !stream_.eof();) {
    const std::optional<std::string_view> payload = payload_of(line);
    const bool is_first = length_ == 0;
    if (!payload && is_first) fail(file, "is not the journal of a sweep; remove it, or choose another folder");
    if (!payload) break;
    std::string_view cells = *payload;
    const std::string_view kind = take_cell(cells);
    if (is_first && (kind != k_journal || cells != digest)) {
      const std::size_t count = count_rows(stream_);
      fail(file, fmt::format("is the journal of another sweep, or of this one before its sweep file, its scenario, a "
                             "table or the program changed, and holds {} finished run{}; remove it to begin anew, or "
                             "choose another folder",
                             count, count == 1 ? "" : "s"));
    }
    if (kind == k_columns) layouts_.push_back({std::string(cells)});
    if (kind == k_row) {
      const SweepRow row = row_of(cells);
      rows_.push_back({static_cast<std::uint32_t>(row.run), row.status == to_string(RunStatus::complete), length_});
      std::size_t& first = layouts_.at(row.layout).first_run;
      first = std::min(first, row.run);
    }
    length_ += line.size() + 1;
  }
  stream_.clear();
  stream_.seekg(0);
}

SweepRow SweepRecord::row(std::uint64_t begin) {
  std::string line;
  if (begin != position_) stream_.seekg(static_cast<std::streamoff>(begin));
  std::getline(stream_, line);
  position_ = begin + line.size() + 1;
  const std::optional<std::string_view> payload = payload_of(line);
  if (!payload) fail(file_, "cannot be read again: another program has changed it");
  std::string_view cells = *payload;
  take_cell(cells);
  return row_of(cells);
}

SweepJournal::SweepJournal(fs::path file, const std::string& digest) : file_(std::move(file)) {
  descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail(file_, fmt::format("cannot be written: {}", std::strerror(errno)));
  try {
    lock(descriptor_, file_, false);
    const SweepRecord record(file_, digest);
    if (ftruncate(descriptor_, static_cast<off_t>(record.length())) != 0) {
      fail(file_, fmt::format("cannot be written: {}", std::strerror(errno)));
    }
    for (const SweepLayout& layout : record.layouts()) layouts_.emplace(layout.headings, layouts_.size());
    if (record.length() == 0) add_line(fmt::format("{},{}", k_journal, digest));
    flush();
  } catch (...) {
    close(descriptor_);
    throw;
  }
}

SweepJournal::~SweepJournal() {
  try {
    flush();
  } catch (const std::exception&) {  // the next call of the sweep computes these runs again
  }
  close(descriptor_);
}

void SweepJournal::append(const SweepRow& row, const std::string& columns) {
  const auto [layout, is_new] = layouts_.emplace(columns, layouts_.size());
  if (is_new) add_line(fmt::format("{},{}", k_columns, columns));
  add_line(fmt::format("{},{},{},{},{},{}", k_row, row.run, row.status, row.reason, layout->second, row.cells));
  if (std::chrono::steady_clock::now() - last_flush_ > k_longest_gathering) flush();
}

void SweepJournal::add_line(const std::string& payload) {
  gathered_.append(line_digest(payload)).append(" ").append(payload).append("\n");
}

void SweepJournal::flush() {
  last_flush_ = std::chrono::steady_clock::now();
  while (!gathered_.empty()) {
    const ssize_t written = write(descriptor_, gathered_.data(), gathered_.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(file_, fmt::format("cannot be written: {}", std::strerror(errno)));
    gathered_.erase(0, static_cast<std::size_t>(written));
  }
}

}  // namespace monograin
