#include "figure/text_width.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "system/resolution.hpp"

namespace monograin::figure {
namespace {

constexpr double k_em_cm = 0.353;       ///< of letters of 10 pt
constexpr double k_least_size = 0.72;   ///< of a text that is too wide, over that of others: 7 pt
constexpr double k_script = 0.8;        ///< size of subscripts and superscripts in gnuplot
constexpr double k_wide_letter = 0.84;  ///< em; a minus sign, and as wide as any Greek letter

constexpr std::string_view k_gap = "...";

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

/// Index behind the letter or group that begins at an index, with what belongs to it: backslash, script, braces.
[[nodiscard]] std::size_t end_of_piece(std::string_view text, std::size_t begin) {
  std::size_t k = begin;
  std::size_t depth = 0;
  do {
    const char c = text[k++];
    const bool joins_next = std::string_view("\\^_@&~").find(c) != std::string_view::npos;
    if (joins_next && k < text.size()) {
      k = c == '\\' ? k + 1 : end_of_piece(text, k);
    } else if (c == '{') {
      ++depth;
    } else if (c == '}' && depth > 0) {
      --depth;
    }
    while (k < text.size() && (static_cast<unsigned char>(text[k]) & 0xC0u) == 0x80u) ++k;
  } while (depth > 0 && k < text.size());
  return k;
}

/// An enhanced text that loses a part of its middle where it is too wide.
class LongText {
 public:
  LongText(std::string_view text, double room) : room_(room), is_short_(text_width(text) <= room) {
    for (std::size_t k = 0; k < text.size();) {
      const std::size_t end = end_of_piece(text, k);
      pieces_.emplace_back(text.substr(k, end - k));
      k = end;
    }
  }

  /// The text in its room, with a place that tells it from each of the texts that would lose the same part.
  [[nodiscard]] std::string apart_from(const std::vector<LongText>& others) const {
    std::optional<std::size_t> shown;
    std::string text = shortened(shown);
    for (const LongText& other : others) {
      if (other.pieces_ == pieces_ || other.shortened(shown) != text) continue;
      const auto differing = std::ranges::mismatch(pieces_, other.pieces_).in1;
      shown = std::max(shown.value_or(0), static_cast<std::size_t>(differing - pieces_.begin()));
      text = shortened(shown);
    }
    return text;
  }

 private:
  /// @param shown  index of a piece of the middle to keep; none: the beginning and the end have the whole room
  [[nodiscard]] std::string shortened(std::optional<std::size_t> shown) const {
    if (is_short_) return joined(0, pieces_.size());
    const double gap = text_width(k_gap);
    const double share = shown ? (room_ - 2.0 * gap) / 3.0 : (room_ - gap) / 2.0;
    const std::size_t head = fitting(0, pieces_.size(), share);
    std::size_t tail = pieces_.size();
    for (double left = share; tail > head && width_of(tail - 1) <= left; --tail) left -= width_of(tail - 1);
    std::string text = joined(0, head);
    std::size_t end = head;
    if (shown && *shown >= head && *shown < tail) {
      end = fitting(*shown, tail, share);
      if (*shown > head) text += k_gap;
      text += joined(*shown, end);
    }
    if (end < tail) text += k_gap;
    return text + joined(tail, pieces_.size());
  }

  [[nodiscard]] double width_of(std::size_t piece) const { return text_width(pieces_[piece]); }

  /// Index behind the pieces from `begin` on that a width has room for.
  [[nodiscard]] std::size_t fitting(std::size_t begin, std::size_t end, double width) const {
    std::size_t k = begin;
    for (; k < end && width_of(k) <= width; ++k) width -= width_of(k);
    return k;
  }

  [[nodiscard]] std::string joined(std::size_t begin, std::size_t end) const {
    std::string text;
    for (std::size_t k = begin; k < end; ++k) text += pieces_[k];
    return text;
  }

  double room_;  ///< [cm], for letters of the usual size
  bool is_short_;
  std::vector<std::string> pieces_;
};

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

std::vector<std::string> fitted_texts(const std::vector<std::string>& enhanced, double width_cm) {
  const double room = width_cm / k_least_size;
  std::vector<LongText> texts;
  texts.reserve(enhanced.size());
  for (const std::string& text : enhanced) texts.emplace_back(text, room);
  std::vector<std::string> fitted;
  for (const LongText& text : texts) {
    const std::string short_text = text.apart_from(texts);
    const double width = text_width(short_text);
    fitted.push_back(
        width <= width_cm
            ? short_text
            : fmt::format("{{/*{:.2f} {}}}", std::floor(100.0 * width_cm / width + k_same_number) / 100.0, short_text));
  }
  return fitted;
}

std::string fitted_text(const std::string& enhanced, double width_cm) {
  return fitted_texts({enhanced}, width_cm).front();
}

}  // namespace monograin::figure
