/// Standard output and standard error. Writing never throws: a stream that is closed or full does not end a run.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace monograin {

/// Keeps descriptors 0 to 2 for the standard streams: no file that is opened later can take the place of a closed one,
/// and reading or writing a closed one fails. Also turns SIGPIPE into a failed write. To be called first.
void prepare_standard_streams() noexcept;

/// False if anything that was printed has not reached standard output. Flushes it.
[[nodiscard]] bool is_output_written() noexcept;

/// Writes a text as it is; a failure only sets the error state of the stream.
void write_stream(std::FILE* stream, std::string_view text) noexcept;

/// Prints data on standard output.
template <class... Args>
void print_data(fmt::format_string<Args...> format, Args&&... args) {
  write_stream(stdout, fmt::format(format, std::forward<Args>(args)...));
}

/// Prints messages on standard error.
template <class... Args>
void say(fmt::format_string<Args...> format, Args&&... args) {
  write_stream(stderr, fmt::format(format, std::forward<Args>(args)...));
}

/// An entry of a list: a head, and a text in lines of at most 80 characters that all begin at a column. The text begins
/// on a new line if the head reaches that column.
/// @param text  not empty
[[nodiscard]] std::string list_entry(std::string_view head, std::size_t column, std::string_view text);

/// Prints warnings about a file or a run, a line each.
void say_warnings(std::string_view name, std::span<const std::string> warnings);

}  // namespace monograin
