#include "figure/text_width.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace monograin::figure {
namespace {

constexpr double k_em_cm = 0.353;       ///< of letters of 10 pt
constexpr double k_script = 0.8;        ///< size of subscripts and superscripts in gnuplot
constexpr double k_wide_letter = 0.84;  ///< em; a minus sign, and as wide as any Greek letter

/// Widths of the letters of ASCII from the blank on, in hundredths of an em.
constexpr std::array<unsigned char, 95> k_letters{
    32, 41, 46, 84, 64, 96, 78, 28, 40,  40, 50, 84, 32, 37, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64,
    64, 64, 34, 34, 84, 84, 84, 54, 100, 69, 69, 70, 78, 64, 58, 78, 76, 30, 30, 66, 56, 87, 75, 79,
    61, 79, 70, 64, 62, 74, 69, 99, 69,  62, 69, 40, 34, 40, 84, 50, 50, 62, 64, 55, 64, 62, 36, 64,
    64, 28, 28, 58, 28, 98, 64, 62, 64,  64, 42, 53, 40, 64, 60, 82, 60, 60, 53, 64, 34, 64, 84};

/// Width [em] of the letter that a byte begins; 0 for a later byte of a letter.
[[nodiscard]] double letter_width(char c) noexcept {
  const auto byte = static_cast<unsigned char>(c);
  if ((byte & 0xC0u) == 0x80u) return 0.0;
  const std::size_t place = byte - std::size_t{' '};
  return byte >= ' ' && place < k_letters.size() ? 0.01 * k_letters[place] : k_wide_letter;
}

}  // namespace

double text_width(std::string_view enhanced) {
  std::vector<double> sizes{1.0};  // of the text, and of the groups that enclose a letter
  double next = 1.0;               // factor of the next letter or group
  double width = 0.0;
  for (std::size_t k = 0; k < enhanced.size(); ++k) {
    const char c = enhanced[k];
    switch (c) {
      case '{':
        sizes.push_back(sizes.back() * next);
        next = 1.0;
        if (enhanced.substr(k + 1).starts_with('/')) {  // a font, up to a blank
          k = std::min(enhanced.find_first_of(" }", k), enhanced.size());
          if (k < enhanced.size() && enhanced[k] == '}') --k;
        }
        break;
      case '}':
        if (sizes.size() > 1) sizes.pop_back();
        break;
      case '^':
      case '_':
        next = k_script;
        break;
      case '@':
      case '&':
      case '~':
        break;
      default:
        if (c == '\\' && k + 1 < enhanced.size()) ++k;
        width += letter_width(enhanced[k]) * sizes.back() * next;
        if (k + 1 == enhanced.size() || letter_width(enhanced[k + 1]) > 0.0) next = 1.0;
    }
  }
  return k_em_cm * width;
}

std::string fitted_text(const std::string& enhanced, double width_cm) {
  const double width = text_width(enhanced);
  return width <= width_cm ? enhanced
                           : fmt::format("{{/*{:.2f} {}}}", std::floor(100.0 * width_cm / width) / 100.0, enhanced);
}

}  // namespace monograin::figure
