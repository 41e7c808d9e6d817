/// Recorder of a run: rows of the history at output points and around events, and a row for every event.
#pragma once

#include <string>
#include <vector>

#include "engine/drive.hpp"
#include "history/table.hpp"
#include "system/hybrid_system.hpp"

namespace monograin {

/// Indices of the rows of a history at output points.
[[nodiscard]] std::vector<std::size_t> output_rows(const Table& history);

/// Records what a drive reports as two tables, history and events.
class Recorder final : public HistorySink {
 public:
  /// @param system  system whose observables are recorded; must outlive the recorder
  /// @param derivatives  columns after those of the observables, filled by take_derivatives()
  explicit Recorder(HybridSystem& system, const std::vector<Column>& derivatives = {});

  void reserve_rows(std::size_t count) { history_.reserve_rows(count); }

  void observe(double time, int step, double xi, std::span<const double> y) override;
  void take_derivatives(std::span<const double> derivatives) override;
  void append(RowSide side) override;
  void event(const Event& event) override;

  [[nodiscard]] Table take_history() { return std::move(history_); }
  [[nodiscard]] Table take_events() const;

 private:
  struct Entry {
    double contact_class = 0.0;  ///< index into class_words_
    double name = 0.0;           ///< index into event_words_
    std::vector<double> state;   ///< row of the history at the event
  };

  HybridSystem& system_;
  std::vector<Column> derivatives_;
  Table history_;
  std::vector<double> row_;
  std::vector<Entry> events_;
  std::vector<std::string> class_words_;
  std::vector<std::string> event_words_;
};

}  // namespace monograin
