#include "history/recorder.hpp"

#include <algorithm>

namespace monograin {
namespace {

constexpr std::size_t k_leading = 3;  // time, step, row

/// Joins columns in the order of a row: leading columns, observables of the system, derivatives.
std::vector<Column> with_observables(std::vector<Column> columns, const HybridSystem& system,
                                     const std::vector<Column>& derivatives) {
  for (const Observable& o : system.observables()) {
    columns.push_back({o.name, o.unit, std::vector<std::string>(o.words.begin(), o.words.end())});
  }
  columns.insert(columns.end(), derivatives.begin(), derivatives.end());
  return columns;
}

/// Index of a word in a list; appends a word that the list lacks.
double index_of(std::string_view word, std::vector<std::string>& words) {
  auto found = std::ranges::find(words, word);
  if (found == words.end()) found = words.insert(words.end(), std::string(word));
  return static_cast<double>(found - words.begin());
}

}  // namespace

std::vector<std::size_t> output_rows(const Table& history) {
  const std::size_t side = *history.find("row");
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < history.row_count(); ++row) {
    if (history.at(row, side) == static_cast<double>(RowSide::output)) rows.push_back(row);
  }
  return rows;
}

Recorder::Recorder(HybridSystem& system, const std::vector<Column>& derivatives)
    : system_(system),
      derivatives_(derivatives),
      history_(with_observables({{"time", "s", {}}, {"step", "", {}}, {"row", "", {}}}, system, derivatives)),
      row_(history_.columns().size()) {}

void Recorder::observe(double time, int step, double xi, std::span<const double> y) {
  row_[0] = time;
  row_[1] = step;
  system_.observe(xi, y, std::span(row_).subspan(k_leading, system_.observables().size()));
}

void Recorder::take_derivatives(std::span<const double> derivatives) {
  std::ranges::copy(derivatives, row_.end() - static_cast<std::ptrdiff_t>(derivatives_.size()));
}

void Recorder::append(RowSide side) {
  row_[2] = static_cast<double>(side);
  history_.append(row_);
}

void Recorder::event(const Event& event) {
  std::string name;
  if (event.contact_class >= 0) name = system_.classes()[static_cast<std::size_t>(event.contact_class)].name;
  if (event.other_class >= 0) name += "/" + system_.classes()[static_cast<std::size_t>(event.other_class)].name;
  events_.push_back({index_of(name, class_words_), index_of(event.name, event_words_), row_});
}

Table Recorder::take_events() const {
  // A column without labels holds numbers. Without events there are no words; an empty word keeps it a column of words.
  const auto or_empty_word = [](std::vector<std::string> words) {
    if (words.empty()) words.emplace_back();
    return words;
  };
  Table table(with_observables({{"time", "s", {}},
                                {"class", "", or_empty_word(class_words_)},
                                {"event", "", or_empty_word(event_words_)},
                                {"step", "", {}}},
                               system_, derivatives_));
  std::vector<double> values;
  for (const Entry& entry : events_) {
    values = {entry.state[0], entry.contact_class, entry.name, entry.state[1]};
    values.insert(values.end(), entry.state.begin() + k_leading, entry.state.end());
    table.append(values);
  }
  return table;
}

}  // namespace monograin
