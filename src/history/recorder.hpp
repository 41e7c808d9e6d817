/// Records a run: rows of the history at output points and around events, and a row for every event.
#pragma once

#include <string>
#include <vector>

#include "history/table.hpp"
#include "hybrid_system.hpp"

namespace monograin {

/// Where a row of the history stands: at an output point, or just before or after an event or corner.
enum class RowSide : signed char { before = -1, output = 0, after = 1 };

class Recorder {
 public:
  explicit Recorder(HybridSystem& system);

  void reserve_rows(std::size_t count) { history_.reserve_rows(count); }

  /// Evaluates the observables. @param step  number of the program's step, from 1
  void observe(double time, int step, double xi, std::span<const double> y);
  /// Appends what was observed last as a row of the history.
  void append(RowSide side);
  /// An event, with the state observed last.
  void event(const Event& event);

  [[nodiscard]] Table take_history() { return std::move(history_); }
  [[nodiscard]] Table take_events() const;

 private:
  struct Entry {
    double contact_class = 0.0;
    double name = 0.0;
    std::vector<double> state;  ///< the row of the history
  };

  HybridSystem& system_;
  Table history_;
  std::vector<double> row_;
  std::vector<Entry> events_;
  std::vector<std::string> class_words_;
  std::vector<std::string> event_words_;
};

}  // namespace monograin
