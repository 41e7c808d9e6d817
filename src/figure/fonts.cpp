#include "figure/fonts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <vector>

#include "figure/figure.hpp"
#include "history/external_program.hpp"
#include "scenario/hidden_path.hpp"
#include "scenario/text_file.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

struct LetterRange {
  std::uint32_t first;
  std::uint32_t last;
};

/// Ranges of a list such as "20-7e a0".
[[nodiscard]] std::vector<LetterRange> ranges_of(std::string_view charsets) {
  constexpr int k_hexadecimal = 16;
  std::vector<LetterRange> ranges;
  const char* const end = charsets.data() + charsets.size();
  for (const char* at = charsets.data(); at < end;) {
    LetterRange range{};
    const auto first = std::from_chars(at, end, range.first, k_hexadecimal);
    if (first.ec != std::errc{}) {
      ++at;
      continue;
    }
    range.last = range.first;
    at = first.ptr;
    if (at < end && *at == '-') at = std::from_chars(at + 1, end, range.last, k_hexadecimal).ptr;
    ranges.push_back(range);
  }
  return ranges;
}

/// A text in which bytes by their numbers are bytes.
[[nodiscard]] std::string without_numbers(std::string_view text) {
  constexpr int k_octal = 8;
  constexpr std::size_t k_digits = 3;
  std::string bytes;
  for (std::size_t k = 0; k < text.size(); ++k) {
    unsigned value = 0;
    const char* const digits = text.data() + k + 1;
    const bool is_number = text[k] == '\\' && k + k_digits < text.size() &&
                           std::from_chars(digits, digits + k_digits, value, k_octal).ptr == digits + k_digits;
    bytes += is_number ? static_cast<char>(value) : text[k];
    if (is_number) k += k_digits;
  }
  return bytes;
}

/// Number of the letter that some bytes of UTF-8 are.
[[nodiscard]] std::uint32_t number_of(std::string_view letter) {
  const auto lead = static_cast<unsigned char>(letter.front());
  std::uint32_t number = letter.size() == 2 ? lead & 0x1FU : letter.size() == 3 ? lead & 0x0FU : lead & 0x07U;
  for (const char c : letter.substr(1)) number = (number << 6U) | (static_cast<unsigned char>(c) & 0x3FU);
  return number;
}

}  // namespace

std::string letters_without_font(const std::string& text, const std::string& charsets) {
  const std::vector<LetterRange> ranges = ranges_of(charsets);
  const std::string bytes = without_numbers(text);
  std::string missing;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    if (static_cast<unsigned char>(bytes[k]) < 0xC0U) continue;  // ASCII, or a later byte of a letter
    std::size_t end = k + 1;
    while (end < bytes.size() && (static_cast<unsigned char>(bytes[end]) & 0xC0U) == 0x80U) ++end;
    const std::string_view letter = std::string_view(bytes).substr(k, end - k);
    const std::uint32_t number = number_of(letter);
    const bool is_known = std::ranges::any_of(
        ranges, [=](const LetterRange& range) { return range.first <= number && number <= range.last; });
    if (!is_known && missing.find(letter) == std::string::npos) missing += letter;
  }
  return missing;
}

void expect_fonts(const std::string& script, const fs::path& figure, const fs::path& log) {
  const auto fc_list = find_program("fc-list");
  if (!fc_list) return;
  // The head of the script names files, which are not drawn.
  const std::string drawn = script.substr(std::min(script.size(), script.find("\nset encoding")));
  int code = 0;
  try {
    code = run_program(*fc_list, {"--format", "%{charset}\n"}, log.parent_path(), log);
  } catch (const std::runtime_error&) {
    return;
  }
  const FileText charsets = read_text_file(log, k_largest_text);
  std::error_code ignored;
  fs::remove(log, ignored);
  if (code != 0 || charsets.text.empty()) return;
  const std::string missing = letters_without_font(drawn, charsets.text);
  if (missing.empty()) return;
  throw FigureError(
      fmt::format("{}: no installed font has '{}'; install one that does (on Debian, for Chinese, Japanese and Korean: "
                  "apt-get install fonts-noto-cjk); an .svg takes the fonts of the machine that shows it",
                  shown_path(figure).string(), missing));
}

}  // namespace monograin::figure
