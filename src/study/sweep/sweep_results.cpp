#include "study/sweep/sweep_results.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <fstream>
#include <istream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "catalogue.hpp"
#include "history/run.hpp"
#include "history/run_files.hpp"
#include "scenario/words.hpp"
#include "study/sweep/sweep_journal.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_digest_line = "# sweep_digest: ";
constexpr std::string_view k_rows_digest_line = "# rows_digest: ";
constexpr std::array k_formats{ResultsFormat::csv, ResultsFormat::hdf5};
constexpr std::size_t k_least_user_block = 512;  // [bytes], of the format HDF5

/// Lines at the beginning of both formats.
[[nodiscard]] std::string header_of(const Sweep& sweep, std::string_view rows_digest) {
  return fmt::format("# program: monograin {}\n# sweep: {}\n{}{}\n# design: {}\n# scenario: {}\n{}{}\n", version(),
                     sweep.name, k_digest_line, sweep.digest, sweep.design, sweep.scenario_name, k_rows_digest_line,
                     rows_digest);
}

/// The digests in the lines at the beginning of a file; empty where there are none.
struct Digests {
  std::string sweep{};
  std::string rows{};  ///< of all that follows these lines
};

[[nodiscard]] Digests skip_header(std::istream& in) {
  Digests found;
  std::string line;
  while (in.peek() == '#' && std::getline(in, line)) {
    if (line.starts_with(k_digest_line)) found.sweep = line.substr(k_digest_line.size());
    if (line.starts_with(k_rows_digest_line)) {
      found.rows = line.substr(k_rows_digest_line.size(), LinesDigest::k_digits);
    }
  }
  return found;
}

/// Digest of the rest, split at line feeds, also in binary files.
[[nodiscard]] std::string digest_of_rest(std::istream& in) {
  LinesDigest digest;
  for (std::string line; std::getline(in, line);) digest.add(line);
  return digest.word();
}

/// Digest of the sweep whose results a file has; empty if the program has not written it.
[[nodiscard]] std::string sweep_digest_in(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return skip_header(in).sweep;
}

/// True if a file has results of this sweep.
/// @throws std::runtime_error if it has results, of this or another sweep, that were changed after they were written
[[nodiscard]] bool has_results(const Sweep& sweep, const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const Digests digests = skip_header(in);
  const bool is_own = digests.sweep == sweep.digest;
  if (digests.rows.empty() && !is_own) return false;
  if (digest_of_rest(in) == digests.rows) return is_own;
  throw std::runtime_error(
      fmt::format("{}: is damaged or edited: its rows do not match its rows_digest; remove or rename it to run the "
                  "sweep again",
                  file.string()));
}

void expect_written(const std::ostream& stream, const fs::path& file) {
  if (stream) return;
  throw std::runtime_error(
      fmt::format("{}: cannot be written: {}", file.string(), std::generic_category().message(errno)));
}

/// The digest of the rows, which stands before them, is known after the last row, and has the same length as any other.
void write_as_csv(const Sweep& sweep, const fs::path& file, const TableLines& lines) {
  write_file_by_name(file, [&](const fs::path& hidden) {
    std::ofstream stream(hidden, std::ios::binary);
    LinesDigest digest;
    stream << header_of(sweep, digest.word());
    lines([&](std::string_view line) {
      digest.add(line);
      stream << line << '\n';
      expect_written(stream, file);
    });
    stream.seekp(0);
    stream << header_of(sweep, digest.word()) << std::flush;
    expect_written(stream, file);
  });
}

/// Texts that describe a sweep, as attributes of its file.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> attributes_of(const Sweep& sweep) {
  std::vector<std::pair<std::string, std::string>> attributes{{"program", fmt::format("monograin {}", version())},
                                                              {"sweep", sweep.name},
                                                              {"sweep_digest", sweep.digest},
                                                              {"design", sweep.design}};
  if (sweep.seed) attributes.emplace_back("seed", fmt::format("{}", *sweep.seed));
  attributes.emplace_back("sweep_text", sweep.text);
  attributes.emplace_back("scenario", sweep.scenario_name);
  const auto scenario = std::ranges::find(sweep.files, "scenario", &FileKey::path);
  if (scenario != sweep.files.end()) attributes.emplace_back("scenario_text", scenario->text);
  return attributes;
}

/// What repeats a sweep.
[[nodiscard]] nlohmann::ordered_json record_json(const Sweep& sweep) {
  using Json = nlohmann::ordered_json;
  Json files = Json::array();
  for (const auto& [key, name, text] : sweep.files) files.push_back({{"key", key}, {"name", name}, {"text", text}});
  Json citation = Json::object();
  for (const std::string& model : sweep.models) citation[model] = reference_texts(*find_model(model));
  return {{"program", "monograin"},
          {"sweep", sweep.name},
          {"title", sweep.title},
          {"digest", sweep.digest},
          {"design", sweep.design},
          {"seed", sweep.seed ? Json(*sweep.seed) : Json()},
          {"citation", std::move(citation)},
          {"versions", versions_json()},
          {"text", sweep.text},
          {"files", std::move(files)}};
}

[[nodiscard]] std::string group_of(const Sweep& sweep, const Column& column) {
  constexpr std::array<std::string_view, 3> k_of_run{"run", "status", "reason"};
  if (std::ranges::find(k_of_run, column.name) != k_of_run.end()) return {};
  return std::ranges::find(sweep.factors, column.name, &SweepFactor::key) == sweep.factors.end() ? "outputs" : "inputs";
}

/// The lines of the header take the part of the file that the format leaves to its user.
void write_as_hdf5(const Sweep& sweep, const fs::path& file, const TableLines& lines) {
  const std::size_t length = header_of(sweep, LinesDigest().word()).size();
  const std::size_t block = std::max(k_least_user_block, std::bit_ceil(length));
  write_file_by_name(file, [&](const fs::path& hidden) {
    write_hdf5(hidden,
               {.shown_as = file,
                .free_bytes = block,
                .attributes = attributes_of(sweep),
                .group_of = [&sweep](const Column& column) { return group_of(sweep, column); }},
               lines);
    std::fstream stream(hidden, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(length));
    stream << std::string(block - length, '\n');
    stream.seekg(static_cast<std::streamoff>(length));
    const std::string digest = digest_of_rest(stream);
    if (!stream.bad()) stream.clear();  // of the end
    stream.seekp(0);
    stream << header_of(sweep, digest) << std::flush;
    expect_written(stream, file);
  });
}

/// The lines of a file of results.
[[nodiscard]] TableLines lines_of(const fs::path& file) {
  if (file.extension() != k_hdf5_extension) {
    return [file](const TextSink& sink) {
      std::ifstream in(file, std::ios::binary);
      static_cast<void>(skip_header(in));
      for (std::string line; std::getline(in, line);) sink(line);
    };
  }
  Table table = read_hdf5(file);
  table.header.clear();
  return [table = std::move(table)](const TextSink& sink) {
    for_each_csv_part(table, [&sink](std::string_view part) { sink(part.substr(0, part.size() - 1)); });
  };
}

}  // namespace

std::optional<ResultsFormat> results_format(std::string_view name) {
  if (name.empty()) return std::nullopt;
  const auto found = std::ranges::find(k_results_formats, name);
  if (found == k_results_formats.end()) {
    throw std::invalid_argument(
        fmt::format("format = {}: expected one of {}", shown(name), fmt::join(k_results_formats, ", ")));
  }
  return static_cast<ResultsFormat>(found - k_results_formats.begin());
}

fs::path results_file(const fs::path& folder, ResultsFormat format) {
  return folder / (format == ResultsFormat::csv ? k_csv_results : k_hdf5_results);
}

ResultsFormat format_in(const fs::path& folder) {
  const auto found = std::ranges::find_if(
      k_formats, [&](ResultsFormat format) { return !sweep_digest_in(results_file(folder, format)).empty(); });
  return found == k_formats.end() ? ResultsFormat::csv : *found;
}

std::optional<fs::path> found_results(const Sweep& sweep, const fs::path& folder, std::optional<ResultsFormat> wanted) {
  std::optional<fs::path> found;
  for (const ResultsFormat format : k_formats) {
    const fs::path file = results_file(folder, format);
    if (has_results(sweep, file) && (!found || format == wanted)) found = file;
  }
  if (!found || !wanted || *found == results_file(folder, *wanted)) return found;
  return write_results(sweep, folder, *wanted, lines_of(*found));
}

fs::path write_results(const Sweep& sweep, const fs::path& folder, ResultsFormat format, const TableLines& lines) {
  const fs::path file = results_file(folder, format);
  remove_partial_files(folder);
  (format == ResultsFormat::csv ? write_as_csv : write_as_hdf5)(sweep, file, lines);
  sync_to_disk(file);
  sync_to_disk(folder);
  return file;
}

std::size_t count_ended_early(const fs::path& results) {
  const std::string_view complete = to_string(RunStatus::complete);
  std::size_t count = 0;
  if (results.extension() == k_hdf5_extension) {
    const Table table = read_hdf5(results, "status");
    for (std::size_t row = 0; row < table.row_count(); ++row) count += table.word(row, 0) == complete ? 0U : 1U;
    return count;
  }
  std::ifstream in(results, std::ios::binary);
  static_cast<void>(skip_header(in));
  std::string line;
  std::getline(in, line);
  const auto status = std::ranges::count(line.substr(0, line.find(",status,")), ',') + 1;
  while (std::getline(in, line)) {
    std::string_view rest = line;
    for (auto k = status; k > 0; --k) rest.remove_prefix(rest.find(',') + 1);
    count += rest.substr(0, rest.find(',')) == complete ? 0U : 1U;
  }
  return count;
}

void write_sweep_record(const Sweep& sweep, const fs::path& folder) {
  write_text_file(folder / k_sweep_record, record_text(record_json(sweep)));
}

void remove_other_results(const Sweep& sweep, const fs::path& folder) {
  for (const ResultsFormat format : k_formats) {
    const fs::path file = results_file(folder, format);
    const std::string digest = sweep_digest_in(file);
    if (!digest.empty() && digest != sweep.digest) fs::remove(file);
  }
}

std::string design_text(const Sweep& sweep) {
  std::vector<std::string> cells;
  for (const SweepFactor& factor : sweep.factors) cells.push_back(factor.heading());
  std::string text = fmt::format("# program: monograin {}\n# sweep: {}\n# design: {}\n{}\n", version(), sweep.name,
                                 sweep.design, fmt::join(cells, ","));
  for (std::size_t run = 0; run < sweep.runs.size(); ++run) {
    std::ranges::transform(sweep.runs[run], cells.begin(), cell_of);
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

}  // namespace monograin
