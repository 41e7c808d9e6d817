/// Words in messages: suggestions for misspelt words, lists, lines of text, and safe output of a user's text.
#pragma once

#include <cstddef>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace monograin {

/// Magnitude from which on a whole number is written with an exponent; its text then is no integer.
inline constexpr double k_end_of_integers = 1e15;

/// The candidate nearest to `word`, if it takes at most two insertions, deletions, replacements or swaps of neighbours
/// and fewer than the word has letters; otherwise an empty view. Capital and small letters count as equal.
[[nodiscard]] std::string_view nearest_word(std::string_view word, std::span<const std::string_view> candidates);

/// `; did you mean 'x'?`, or an empty text if no candidate is near.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// The words with commas between them.
[[nodiscard]] std::string listed(std::span<const std::string_view> words);

/// The text without blanks at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view blanks = " \t") noexcept;

/// The text with its control characters replaced, so that it cannot break a message's line.
[[nodiscard]] std::string on_one_line(std::string_view text);

/// The text with its control characters replaced, shortened if it is long.
[[nodiscard]] std::string shown(std::string_view text);

/// Number of characters of a text in UTF-8.
[[nodiscard]] std::size_t width_of(std::string_view text) noexcept;

/// A text in lines of at most `width` characters, broken between words; a longer word has a line of its own.
[[nodiscard]] std::vector<std::string> lines_of(std::string_view text, std::size_t width);

/// Message of an exception. For exceptions of a library, in words of this program: a path with the system's reason, or
/// a lack of memory.
[[nodiscard]] std::string in_own_words(const std::exception& error);

}  // namespace monograin
