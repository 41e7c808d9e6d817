#include "figure/run_curves.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "catalogue.hpp"
#include "figure/figure.hpp"
#include "history/table_file.hpp"
#include "scenario/hidden_path.hpp"
#include "system/resolution.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_displacement = ".displacement";
constexpr std::string_view k_events_table = "events.csv";

/// A positive number of the header, by which values are divided.
[[nodiscard]] std::optional<double> header_scale(const Table& table, std::string_view key) {
  const auto value = table.header_number(key);
  return value && *value > 0.0 ? value : std::nullopt;
}

/// Names of the contact classes, which precede ".displacement", in the order of the columns.
[[nodiscard]] std::vector<std::string> contact_classes(const Table& history) {
  std::vector<std::string> names;
  for (const Column& column : history.columns()) {
    if (!column.name.ends_with(k_displacement)) continue;
    names.push_back(column.name.substr(0, column.name.size() - k_displacement.size()));
  }
  return names;
}

/// Column of the contact radius; of the deformed particle, if the model tells it apart.
[[nodiscard]] std::optional<std::size_t> radius_of(const Table& table, const std::string& contact) {
  const auto deformed = table.find(contact + ".contact_radius_deformed");
  return deformed ? deformed : table.find(contact + ".contact_radius");
}

/// Finds the columns of one contact once, to read its state from any row of a history or of an events table.
class StateReader {
 public:
  StateReader(const Table& table, const std::string& driven, const std::string& contact)
      : table_(table),
        displacement_(table.find(driven + std::string(k_displacement))),
        force_(table.find(contact + ".force")),
        pressure_(table.find(contact + ".pressure")),
        contact_radius_(radius_of(table, contact)),
        apparent_radius_(table.find("apparent_radius")) {}

  [[nodiscard]] ContactState at(std::size_t row) const {
    const double a = cell(row, contact_radius_);
    return {.displacement = cell(row, displacement_),
            .values = {cell(row, force_), cell(row, pressure_), std::numbers::pi * a * a, cell(row, apparent_radius_)}};
  }

 private:
  [[nodiscard]] double cell(std::size_t row, std::optional<std::size_t> column) const {
    return column ? table_.at(row, *column) : k_nan;
  }

  const Table& table_;
  std::optional<std::size_t> displacement_, force_, pressure_, contact_radius_, apparent_radius_;
};

[[nodiscard]] ContactCurve contact_curve(const Table& history, const std::string& driven, const std::string& contact) {
  const StateReader reader(history, driven, contact);
  ContactCurve curve{.name = contact};
  curve.states.reserve(history.row_count());
  for (std::size_t row = 0; row < history.row_count(); ++row) curve.states.push_back(reader.at(row));
  curve.is_ever_made = std::ranges::any_of(curve.states, [](const ContactState& state) {
    return std::isfinite(state[Quantity::force]) && state[Quantity::force] != 0.0;
  });
  return curve;
}

[[nodiscard]] std::vector<EventMark> event_marks(const fs::path& folder, const std::string& driven) {
  const Table events = read_events(folder);
  const auto name = events.find("event");
  const auto contact_class = events.find("class");
  std::vector<EventMark> marks;
  if (events.row_count() == 0) return marks;
  if (!name || !events.columns()[*name].holds_words() || !contact_class) {
    throw FigureError(fmt::format("{}: it has no columns 'class' and 'event'", (folder / k_events_table).string()));
  }
  const bool names_classes = events.columns()[*contact_class].holds_words();
  for (std::size_t row = 0; row < events.row_count(); ++row) {
    const std::string_view event = events.word(row, *name);
    if (is_of_program(event)) continue;
    for (const std::string& contact : classes_of_event(names_classes ? events.word(row, *contact_class) : "")) {
      marks.push_back({std::string(event), contact, StateReader(events, driven, contact).at(row)});
    }
  }
  return marks;
}

/// True if two curves hide each other: they differ by less than the width of a line.
[[nodiscard]] bool hide_each_other(std::span<const double> a, std::span<const double> b) {
  constexpr double k_line = 0.003;  // of the greatest value
  double greatest = 0.0;
  double difference = 0.0;
  for (std::size_t row = 0; row < a.size(); ++row) {
    if (std::isfinite(a[row]) != std::isfinite(b[row])) return false;
    if (!std::isfinite(a[row])) continue;
    greatest = std::max(greatest, std::abs(a[row]));
    difference = std::max(difference, std::abs(a[row] - b[row]));
  }
  return difference <= k_line * greatest;
}

[[nodiscard]] std::vector<double> values_of(const ContactCurve& contact, Quantity quantity) {
  std::vector<double> values;
  for (const ContactState& state : contact.states) values.push_back(state[quantity]);
  return values;
}

[[nodiscard]] bool coincide(const ContactCurve& a, const ContactCurve& b) {
  return std::ranges::all_of(
      k_quantities, [&](Quantity quantity) { return hide_each_other(values_of(a, quantity), values_of(b, quantity)); });
}

/// Values of a contact in the rows of unloading, and those of loading at the same displacements.
struct BothWays {
  std::vector<double> unloading;
  std::vector<double> loading;
};

[[nodiscard]] BothWays both_ways(const ContactCurve& contact, const std::vector<Phase>& phases, Quantity quantity) {
  std::vector<ContactState> loading{contact.states.front()};
  for (std::size_t row = 1; row < phases.size(); ++row) {
    if (phases[row] == Phase::loading) loading.push_back(contact.states[row]);
  }
  BothWays values;
  for (std::size_t row = 1; row < phases.size(); ++row) {
    const ContactState& state = contact.states[row];
    const auto next = std::ranges::lower_bound(loading, state.displacement, {}, &ContactState::displacement);
    if (phases[row] != Phase::unloading || next == loading.begin() || next == loading.end()) continue;
    const auto last = std::prev(next);
    const double share = (state.displacement - last->displacement) / (next->displacement - last->displacement);
    values.unloading.push_back(state[quantity]);
    values.loading.push_back(std::lerp((*last)[quantity], (*next)[quantity], share));
  }
  return values;
}

[[nodiscard]] bool unloads_as_it_loads(const RunCurves& run) {
  bool has_both = false;
  for (const ContactCurve& contact : run.contacts) {
    for (const Quantity quantity : k_quantities) {
      const BothWays values = both_ways(contact, run.phases, quantity);
      if (!hide_each_other(values.unloading, values.loading)) return false;
      has_both = has_both || !values.unloading.empty();
    }
  }
  return has_both;
}

[[nodiscard]] std::vector<ContactCurve>::iterator contact_named(RunCurves& run, const std::string& name) {
  return std::ranges::find(run.contacts, name, &ContactCurve::name);
}

/// Makes one contact of two in all runs that have them, if their curves lie on each other there.
/// @param first, second  copies, because the names change. @return whether it did
bool join(std::vector<RunCurves>& runs, std::string first, std::string second) {
  const bool are_alike = std::ranges::all_of(runs, [&](RunCurves& run) {
    const auto a = contact_named(run, first);
    const auto b = contact_named(run, second);
    if (a == run.contacts.end() || b == run.contacts.end()) return a == b;
    return coincide(*a, *b);
  });
  if (!are_alike) return false;
  for (RunCurves& run : runs) {
    const auto b = contact_named(run, second);
    if (b == run.contacts.end()) continue;
    run.contacts.erase(b);
    contact_named(run, first)->name += " = " + second;
  }
  return true;
}

void join_contacts(std::vector<RunCurves>& runs) {
  for (const RunCurves& run : runs) {
    for (std::size_t a = 0; a < run.contacts.size(); ++a) {
      for (std::size_t b = a + 1; b < run.contacts.size();) {
        if (!join(runs, run.contacts[a].name, run.contacts[b].name)) ++b;
      }
    }
  }
}

}  // namespace

Table read_table(const fs::path& file) {
  try {
    return read_table_file(file, FileKind::regular);
  } catch (const std::runtime_error& fault) {
    throw FigureError(fault.what());
  }
}

fs::path folder_of(const fs::path& file) { return fs::absolute(file).lexically_normal().parent_path(); }

Table read_events(const fs::path& folder) {
  std::error_code error;  // a file whose status is not available cannot be read either; read_table() reports that
  const bool is_missing = !fs::exists(folder / k_events_table, error) && !error;
  return is_missing ? Table{} : read_table(folder / k_events_table);
}

std::vector<std::string> references_of(const Table& history) {
  const Model* model = find_model(history.header_value("model"));
  return model == nullptr ? std::vector<std::string>{} : reference_texts(*model);
}

std::vector<std::string> classes_of_event(std::string_view cell) {
  std::vector<std::string> names;
  for (std::size_t slash = cell.find('/'); slash != std::string_view::npos; slash = cell.find('/')) {
    names.emplace_back(cell.substr(0, slash));
    cell.remove_prefix(slash + 1);
  }
  names.emplace_back(cell);
  return names;
}

std::optional<std::string> driven_class(const Table& history) {
  const std::vector<std::string> classes = contact_classes(history);
  if (classes.empty()) return std::nullopt;
  const auto moves = [&](const std::string& name) {
    const auto displacement = history.column(name + std::string(k_displacement));
    return std::ranges::adjacent_find(displacement, std::ranges::not_equal_to{}) != displacement.end();
  };
  const auto found = std::ranges::find_if(classes, moves);
  return found == classes.end() ? classes.front() : *found;
}

bool is_of_program(std::string_view event) { return event == "step-end" || event == "until-met"; }

std::vector<Phase> phases_along(std::span<const double> displacements) {
  std::vector<Phase> phases(displacements.size(), Phase::loading);
  if (displacements.empty()) return phases;
  double largest = displacements.front();
  for (std::size_t row = 1; row < displacements.size(); ++row) {
    const double step = displacements[row] - displacements[row - 1];
    const double round_off = k_same_value * std::abs(largest);
    if (std::abs(step) <= round_off)
      phases[row] = phases[row - 1];
    else if (step < 0.0)
      phases[row] = Phase::unloading;
    else
      phases[row] = displacements[row] > largest + round_off ? Phase::loading : Phase::reloading;
    largest = std::max(largest, displacements[row]);
  }
  return phases;
}

bool ContactCurve::has(Quantity quantity) const {
  return std::ranges::any_of(states, [=](const ContactState& state) {
    return std::isfinite(state.displacement) && std::isfinite(state[quantity]);
  });
}

bool RunCurves::has(Quantity quantity) const {
  return std::ranges::any_of(contacts, [=](const ContactCurve& contact) { return contact.has(quantity); });
}

RunCurves read_run(const fs::path& run) {
  std::error_code ignored;
  const fs::path file = fs::is_directory(run, ignored) ? run / "history.csv" : run;
  const fs::path folder = folder_of(file);
  const Table history = read_table(file);
  if (!history.find("time")) {
    throw FigureError(
        fmt::format("{}: has no column 'time'; expected the folder or the history.csv of a run", file.string()));
  }
  const auto classes = contact_classes(history);
  if (classes.empty()) {
    throw FigureError(fmt::format("{}: no contacts to draw (no column ending in '{}')", file.string(), k_displacement));
  }
  if (history.row_count() < 2) {
    throw FigureError(
        fmt::format("{}: a curve needs two rows, the history has {}", file.string(), history.row_count()));
  }

  const std::string driven = *driven_class(history);
  RunCurves curves{.name = shown_path(folder).filename().string(),
                   .references = references_of(history),
                   .radius = header_scale(history, "R0"),
                   .youngs_modulus = header_scale(history, "E"),
                   .yield_stress = header_scale(history, "Y"),
                   .events = event_marks(folder, driven)};
  for (const std::string& name : classes) curves.contacts.push_back(contact_curve(history, driven, name));
  if (std::ranges::none_of(k_quantities, [&](Quantity quantity) { return curves.has(quantity); })) {
    throw FigureError(fmt::format("{}: all values are undefined", file.string()));
  }
  std::vector<double> displacements;
  for (const ContactState& state : curves.contacts.front().states) displacements.push_back(state.displacement);
  curves.phases = phases_along(displacements);
  curves.unloads_as_it_loads = unloads_as_it_loads(curves);
  return curves;
}

std::vector<RunCurves> read_runs(const std::vector<fs::path>& runs) {
  std::vector<RunCurves> curves;
  std::vector<std::string> names;
  curves.reserve(runs.size());
  names.reserve(runs.size());
  for (const fs::path& run : runs) names.push_back(curves.emplace_back(read_run(run)).name);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (std::ranges::count(names, names[k]) > 1) curves[k].name = runs[k].generic_string();
  }
  join_contacts(curves);
  return curves;
}

}  // namespace monograin::figure
