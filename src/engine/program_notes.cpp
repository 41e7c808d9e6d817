#include "engine/program_notes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <utility>

namespace monograin {
namespace {

std::string text_of_steps(std::span<const std::size_t> steps) {
  constexpr std::size_t k_most_named = 3;
  const std::size_t count = steps.size();
  return fmt::format("step{} {}{}", count > 1 ? "s" : "", fmt::join(steps.first(std::min(count, k_most_named)), ", "),
                     count > k_most_named ? fmt::format(", ... ({} times)", count) : "");
}

}  // namespace

void ProgramNotes::add(std::size_t step, std::string what, std::string example) {
  auto note = std::ranges::find(notes_, what, &Note::what);
  if (note == notes_.end()) note = notes_.insert(notes_.end(), {std::move(what), std::move(example), {}});
  if (note->steps.empty() || note->steps.back() != step) note->steps.push_back(step);
}

std::vector<std::string> ProgramNotes::texts() const {
  std::vector<std::string> result;
  for (const Note& note : notes_) {
    result.push_back(fmt::format("{}: {}{}", text_of_steps(note.steps), note.what, note.example));
  }
  return result;
}

}  // namespace monograin
