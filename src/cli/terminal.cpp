#include "cli/terminal.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include "scenario/words.hpp"

namespace monograin {

void prepare_standard_streams() noexcept {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) != -1) continue;
    // open() takes the lowest free descriptor, which is this one. The opposite direction makes every use of it fail.
    static_cast<void>(open("/dev/null", descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY));
  }
  static_cast<void>(signal(SIGPIPE, SIG_IGN));
}

bool is_output_written() noexcept { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

void write_stream(std::FILE* stream, std::string_view text) noexcept {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stream));
}

std::string list_entry(std::string_view head, std::size_t column, std::string_view text) {
  constexpr std::size_t k_width = 80;
  std::string entry(head);
  std::size_t at = width_of(head);
  if (at > 0 && at >= column) {
    entry += '\n';
    at = 0;
  }
  for (const std::string& line : lines_of(text, k_width - column)) {
    entry.append(column - at, ' ').append(line) += '\n';
    at = 0;
  }
  return entry;
}

void say_warnings(std::string_view name, std::span<const std::string> warnings) {
  for (const std::string& warning : warnings) say("{}: warning: {}\n", name, warning);
}

}  // namespace monograin
