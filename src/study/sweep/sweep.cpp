#include "study/sweep/sweep.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

#include "figure/page.hpp"
#include "history/run.hpp"
#include "history/staged_folder.hpp"
#include "numerics/parallel.hpp"
#include "scenario/text_file.hpp"
#include "scenario/words.hpp"
#include "study/sweep/bands.hpp"
#include "study/sweep/sensitivity.hpp"
#include "study/sweep/sweep_journal.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_journal_extension = ".journal";
constexpr const char* k_refused = "refused";  // status of a run whose scenario has faults
/// Tables that are made from the results, each with a figure of the same name.
constexpr std::array k_made_from_results{k_bands_file, k_sensitivities_file};

// --- one run

/// A row and the headings of its cells.
struct Outcome {
  SweepRow row;
  std::string columns;
  std::vector<std::string> warnings{};
};

/// Replaces the characters that a cell cannot contain.
[[nodiscard]] std::string plain(std::string text) {
  for (char& c : text) {
    if (c == ',') c = ';';
    if (c == '"') c = '\'';
    if (static_cast<unsigned char>(c) < 0x20U) c = ' ';
  }
  return text;
}

/// The larger or the smaller of two numbers, std::fmax or std::fmin, which pass over undefined ones.
using Extreme = double (*)(double, double);

/// A value of a history that becomes a cell of the results.
struct Result {
  std::size_t column = 0;
  Extreme extreme = nullptr;  ///< of all values of the column; null: its final value
};

/// The values of a history that become cells, and their headings: final values, then extreme ones.
struct Layout {
  std::vector<Column> columns;  ///< of the history
  std::vector<Result> results{};
  std::string headings{};
};

/// @param wanted  results such as max.axial.force; empty: all final and largest values
[[nodiscard]] Layout layout_of(const std::vector<Column>& columns, const std::vector<std::string>& wanted) {
  Layout layout{.columns = columns};
  std::vector<std::string> headings;
  const auto add = [&](std::string_view prefix, Extreme extreme) {
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const std::string name = fmt::format("{}.{}", prefix, columns[k].name);
      const bool is_wanted = wanted.empty() || std::ranges::find(wanted, name) != wanted.end();
      const bool is_possible = extreme == nullptr || !columns[k].holds_words();
      if (is_counter(columns[k]) || !is_possible || !is_wanted) continue;
      layout.results.push_back({k, extreme});
      headings.push_back(fmt::format("{}.{}", prefix, columns[k].heading()));
    }
  };
  add("end", nullptr);
  add("max", std::fmax);
  if (!wanted.empty()) add("min", std::fmin);
  layout.headings = fmt::format("{}", fmt::join(headings, ","));
  return layout;
}

/// Collects the final and extreme values of a history's columns.
/// @param wanted  as for layout_of()
/// @param layout  cache: that of the last history, whose columns are mostly the same
void summarise(const Table& history, const std::vector<std::string>& wanted, Layout& layout, Outcome& outcome) {
  if (history.row_count() == 0) return;
  if (layout.columns != history.columns()) layout = layout_of(history.columns(), wanted);
  outcome.columns = layout.headings;
  const std::size_t last = history.row_count() - 1;
  std::string& cells = outcome.row.cells;
  for (const auto& [column, extreme] : layout.results) {
    if (!cells.empty()) cells += ',';
    if (layout.columns[column].holds_words()) {
      cells += history.word(last, column);
      continue;
    }
    double value = history.at(last, column);
    for (std::size_t row = 0; extreme != nullptr && row < last; ++row) value = extreme(value, history.at(row, column));
    append_csv_number(cells, value);
  }
}

/// Parts of a history that the wanted results do not depend on.
[[nodiscard]] LeftOut not_needed_by(const std::vector<std::string>& wanted) {
  if (wanted.empty()) return {};
  return {.energies = std::ranges::none_of(wanted, [](std::string_view name) { return is_energy(name.substr(4)); }),
          .rows = std::ranges::all_of(wanted, [](std::string_view name) { return name.starts_with("end."); })};
}

[[nodiscard]] std::string messages_of(const ScenarioError& error) {
  std::vector<std::string_view> messages;
  for (const Fault& fault : error.faults()) messages.emplace_back(fault.message);
  return fmt::format("{}", fmt::join(messages, "; "));
}

/// @param histories  folder for the run's history; empty: it is not kept
/// @param left_out   parts of the run that the results do not depend on
[[nodiscard]] Outcome run_one(const Sweep& sweep, std::size_t index, const fs::path& histories, const LeftOut& left_out,
                              Layout& layout) {
  Outcome outcome;
  outcome.row.run = index + 1;
  std::optional<RunRecord> record;
  try {
    const CheckedScenario scenario = scenario_of(sweep, index);
    record = histories.empty() ? record_run(scenario, left_out) : run_scenario(scenario).record;
  } catch (const ScenarioError& error) {
    outcome.row.status = k_refused;
    outcome.row.reason = plain(messages_of(error));
  } catch (const std::bad_alloc&) {  // says nothing about this run: the next call of the sweep computes it
    throw;
  } catch (const std::exception& error) {  // a bug of the program costs this run, not the sweep
    outcome.row.status = to_string(RunStatus::failed);
    outcome.row.reason = plain(in_own_words(error));
  }
  if (!record) return outcome;
  outcome.row.status = to_string(record->status);
  outcome.row.reason = plain(record->message);
  outcome.warnings = std::move(record->warnings);
  summarise(record->history, sweep.columns, layout, outcome);
  if (!histories.empty()) write_csv(histories / fmt::format("{}.csv", index + 1), record->history);
  return outcome;
}

// --- the results

/// Cells of a line.
[[nodiscard]] std::vector<std::string_view> split(std::string_view text) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    cells.push_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  return cells;
}

/// Headings of the cells that precede those of a run's results.
[[nodiscard]] std::string leading_headings(const Sweep& sweep) {
  std::string headings = "run";
  for (const SweepFactor& factor : sweep.factors) headings += ',' + factor.heading();
  return headings + ",status,reason";
}

/// The number of a run and its values, each with a comma after it.
[[nodiscard]] std::string leading_cells(const Sweep& sweep, std::size_t run) {
  std::string cells = fmt::format("{},", run + 1);
  for (const SweepValue& value : sweep.runs[run]) cells += cell_of(value) + ',';
  return cells;
}

// --- the folder

[[nodiscard]] fs::path journal_file(const SweepOptions& options) {
  const auto [index, count] = options.shard;
  return options.folder / (count == 1 ? fmt::format("sweep{}", k_journal_extension)
                                      : fmt::format("sweep-{}-of-{}{}", index, count, k_journal_extension));
}

[[nodiscard]] std::vector<fs::path> journals_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == k_journal_extension) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// @param results        the file that is to be written
/// @param figure_format  of the figure that is to be drawn from it
void prepare(const fs::path& folder, const fs::path& results, std::string_view figure_format) {
  if (fs::exists(folder / k_run_marker) || fs::exists(folder / k_written_files)) {
    throw std::runtime_error(
        fmt::format("{}: holds the result of another command; choose another folder", folder.string()));
  }
  expect_own_file(results, results);
  expect_own_file(folder / k_sweep_record, folder / k_sweep_record);
  for (const char* name : k_made_from_results) {
    expect_own_file(folder / name, folder / name);
    figure::expect_own_figure((folder / name).replace_extension(figure_format));
  }
  if (fs::is_directory(folder / "histories")) {
    for (const auto& entry : fs::directory_iterator(folder / "histories")) {
      if (entry.path().extension() == ".csv") expect_own_file(entry.path(), entry.path());
    }
  }
  prepare_folder(folder);
}

/// Removes what an earlier sweep of other content has left beside its results: percentiles, indices, figures,
/// histories. prepare() has found them to be the program's own.
void remove_leftovers(const Sweep& sweep, const fs::path& folder) {
  for (const char* name : k_made_from_results) {
    fs::remove(folder / name);
    figure::remove_own_figure((folder / name).replace_extension(".gp"));
  }
  const fs::path histories = folder / "histories";
  if (!fs::is_directory(histories)) return;
  remove_partial_files(histories);
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(histories)) {
    const std::string name = entry.path().stem().string();
    std::size_t run = 0;
    const auto read = std::from_chars(name.data(), name.data() + name.size(), run);
    const bool is_own = entry.path().extension() == ".csv" && read.ptr == name.data() + name.size();
    if (is_own && (!sweep.keeps_histories || run > sweep.runs.size())) left.push_back(entry.path());
  }
  for (const fs::path& file : left) fs::remove(file);
  if (!sweep.keeps_histories && fs::is_empty(histories)) fs::remove(histories);
}

/// Writes the record beside the results of a sweep, and removes what these make superfluous: files of an earlier sweep,
/// and the journals. These are removed last: where one is left, the process was killed in between, and the next call
/// does the rest.
void complete(const Sweep& sweep, const fs::path& folder) {
  std::vector<fs::path> journals = journals_in(folder);
  std::erase_if(journals, [&](const fs::path& file) { return !is_journal_of(file, sweep.digest); });
  if (journals.empty()) return;
  remove_other_results(sweep, folder);
  remove_leftovers(sweep, folder);
  write_sweep_record(sweep, folder);
  for (const fs::path& file : journals) fs::remove(file);
}

/// Lock of the process that writes the results of a folder, so that no two do.
class FolderLock {
 public:
  /// @throws std::runtime_error where the file system has no locks
  explicit FolderLock(const fs::path& folder) : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    try {
      lock(descriptor_, folder, true);
    } catch (...) {
      close(descriptor_);
      throw;
    }
  }
  ~FolderLock() { close(descriptor_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

// --- all runs

/// The finished runs of all journals.
class Rows {
 public:
  Rows(const Sweep& sweep, const fs::path& folder) : sweep_(sweep), places_(sweep.runs.size()) {
    for (const fs::path& file : journals_in(folder)) {
      records_.emplace_back(file, sweep.digest);
      for (const auto& [run, is_complete, begin] : records_.back().rows()) {
        Place& place = places_.at(run - 1);
        if (!place.is_there) place = {true, is_complete, static_cast<std::uint32_t>(records_.size() - 1), begin};
      }
    }
  }

  [[nodiscard]] bool has(std::size_t run) const { return places_[run].is_there; }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(std::ranges::count(places_, true, &Place::is_there));
  }
  /// Number of runs that were refused, stopped or failed.
  [[nodiscard]] std::size_t count_ended_early() const {
    return count() - static_cast<std::size_t>(std::ranges::count(places_, true, &Place::is_complete));
  }

  /// Passes the line of headings and then that of each run to a sink. All runs have to be finished.
  void for_each_line(const TextSink& sink) {
    const std::vector<std::string> columns = all_columns();
    std::string line = leading_headings(sweep_);
    for (const std::string& column : columns) (line += ',') += column;
    sink(line);
    std::unordered_map<std::string, std::vector<std::size_t>> targets;  // columns of each layout's cells
    std::vector<std::string_view> cells;
    for (std::size_t run = 0; run < places_.size(); ++run) {
      const SweepRow row = row_of(run);
      const std::string& layout = layout_of(run, row);
      const auto [target, is_new] = targets.try_emplace(layout);
      if (is_new) {
        for (const std::string_view heading : split(layout)) {
          target->second.push_back(static_cast<std::size_t>(std::ranges::find(columns, heading) - columns.begin()));
        }
      }
      cells.assign(columns.size(), "nan");
      const std::vector<std::string_view> own = split(row.cells);
      for (std::size_t k = 0; k < own.size(); ++k) cells[target->second[k]] = own[k];
      line = fmt::format("{}{},{}", leading_cells(sweep_, run), row.status, row.reason);
      for (const std::string_view cell : cells) (line += ',') += cell;
      sink(line);
    }
  }

 private:
  struct Place {
    bool is_there = false;
    bool is_complete = false;
    std::uint32_t record = 0;
    std::uint64_t begin = 0;  ///< of the row in its journal
  };

  [[nodiscard]] SweepRow row_of(std::size_t run) { return records_[places_[run].record].row(places_[run].begin); }
  [[nodiscard]] const std::string& layout_of(std::size_t run, const SweepRow& row) const {
    return records_[places_[run].record].layouts().at(row.layout).headings;
  }

  /// Columns of all runs in the order of the runs, final values before extremes.
  [[nodiscard]] std::vector<std::string> all_columns() const {
    std::vector<SweepLayout> layouts;
    for (const SweepRecord& record : records_) {
      std::ranges::copy_if(record.layouts(), std::back_inserter(layouts), &SweepLayout::has_rows);
    }
    std::ranges::sort(layouts, {}, &SweepLayout::first_run);
    std::vector<std::string> columns;
    for (const SweepLayout& layout : layouts) {
      for (const std::string_view heading : split(layout.headings)) {
        if (std::ranges::find(columns, heading) == columns.end()) columns.emplace_back(heading);
      }
    }
    std::stable_partition(columns.begin(), columns.end(),
                          [](const std::string& column) { return column.starts_with("end."); });
    return columns;
  }

  const Sweep& sweep_;
  std::vector<SweepRecord> records_;
  std::vector<Place> places_;  ///< of every run
};

/// Does runs of a sweep.
[[nodiscard]] SweepOutcome run_all(const Sweep& sweep, const SweepOptions& options,
                                   const std::vector<std::size_t>& runs, SweepJournal& journal) {
  const fs::path histories = sweep.keeps_histories ? options.folder / "histories" : fs::path();
  if (!histories.empty()) fs::create_directories(histories);
  const LeftOut left_out = not_needed_by(sweep.columns);
  const std::size_t threads = thread_count(options.threads);
  std::vector<Layout> layouts(threads);
  std::mutex mutex;
  SweepOutcome all;
  std::size_t with_warnings = 0;
  std::size_t first = sweep.runs.size() + 1;  // number of the first of them
  std::vector<std::string> of_first;
  for_each_index(runs.size(), threads, [&](std::size_t i, std::size_t thread) {
    Outcome outcome = run_one(sweep, runs[i], histories, left_out, layouts[thread]);
    const std::scoped_lock lock(mutex);
    journal.append(outcome.row, outcome.columns);
    ++all.runs_now;
    if (!outcome.warnings.empty()) {
      ++with_warnings;
      if (outcome.row.run < first) {
        first = outcome.row.run;
        of_first = std::move(outcome.warnings);
      }
    }
    if (options.progress) options.progress(all.runs_now, runs.size());
  });
  journal.flush();
  if (with_warnings > 0) {
    all.warnings.push_back(
        fmt::format("{} of {} runs warn; run {}: {}", with_warnings, all.runs_now, first, fmt::join(of_first, "; ")));
  }
  return all;
}

}  // namespace

fs::path folder_of(const Sweep& sweep, const fs::path& chosen) {
  return chosen.empty() ? fs::path("runs") / sweep.name : chosen;
}

std::string early_ends_text(const Sweep& sweep, const SweepOutcome& outcome) {
  if (outcome.runs_ended_early == 0) return {};
  return fmt::format("{} of {} runs refused, stopped or failed (columns status and reason)", outcome.runs_ended_early,
                     sweep.runs.size() - outcome.runs_missing);
}

SweepOutcome run_sweep(const Sweep& sweep, const SweepOptions& options) {
  const ResultsFormat format = options.format.value_or(format_in(options.folder));
  if (format == ResultsFormat::hdf5) expect_hdf5();
  prepare(options.folder, results_file(options.folder, format), options.figure_format);
  SweepOutcome outcome;
  {
    std::optional<SweepJournal> journal;
    std::vector<std::size_t> runs;
    std::size_t before = 0;
    {
      const FolderLock lock(options.folder);
      if (const auto found = found_results(sweep, options.folder, options.format)) {
        complete(sweep, options.folder);
        return {.runs_before = sweep.runs.size(), .runs_ended_early = count_ended_early(*found), .results = *found};
      }
      const Rows rows(sweep, options.folder);  // a journal of another sweep is refused before this one has its own
      journal.emplace(journal_file(options), sweep.digest);
      before = rows.count();
      for (std::size_t run = options.shard.index - 1; run < sweep.runs.size(); run += options.shard.count) {
        if (!rows.has(run)) runs.push_back(run);
      }
    }
    outcome = run_all(sweep, options, runs, *journal);
    outcome.runs_before = before;
  }
  const FolderLock lock(options.folder);
  if (const auto found = found_results(sweep, options.folder, options.format)) {  // another shard has written them
    outcome.results = *found;
    outcome.runs_ended_early = count_ended_early(*found);
  } else {
    Rows rows(sweep, options.folder);
    outcome.runs_ended_early = rows.count_ended_early();
    outcome.runs_missing = sweep.runs.size() - rows.count();
    if (outcome.runs_missing > 0) return outcome;
    outcome.results =
        write_results(sweep, options.folder, format, [&rows](const TextSink& sink) { rows.for_each_line(sink); });
  }
  complete(sweep, options.folder);
  return outcome;
}

}  // namespace monograin
