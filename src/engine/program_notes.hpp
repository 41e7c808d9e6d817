/// Notes on demands of the load program that a run did not meet.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace monograin {

/// Collects notes on the steps of a program; steps to which the same words apply share one note.
class ProgramNotes {
 public:
  /// @param step     number of the step, from 1
  /// @param what     the note; steps with equal notes share it
  /// @param example  numbers that belong to this step; those of the first step are shown
  void add(std::size_t step, std::string what, std::string example = {});

  /// One text for each note, e.g. "steps 3, 6, 9, ... (42 times): until axial.force = 0 N was never met".
  [[nodiscard]] std::vector<std::string> texts() const;

 private:
  struct Note {
    std::string what;
    std::string example;
    std::vector<std::size_t> steps;
  };

  std::vector<Note> notes_;
};

}  // namespace monograin
