#include "scenario/text_encoding.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <optional>

namespace monograin {
namespace {

constexpr std::size_t k_looked_at = 4096;  // bytes in which zeros are counted
constexpr std::string_view k_zip_archive = "PK\x03\x04";

/// Owns a converter to UTF-8, and closes it.
class Converter {
 public:
  explicit Converter(const char* from) : handle_(iconv_open("UTF-8", from)) {}
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;
  ~Converter() {
    if (is_open()) iconv_close(handle_);
  }

  /// @return none if the bytes are no text of that encoding, or the system does not know it
  [[nodiscard]] std::optional<std::string> convert(std::string_view bytes) const {
    if (!is_open()) return std::nullopt;
    std::string text;
    std::array<char, 65536> chunk{};
    char* in = const_cast<char*>(bytes.data());  // iconv does not write to it
    std::size_t left = bytes.size();
    while (left > 0) {
      char* out = chunk.data();
      std::size_t room = chunk.size();
      const std::size_t before = left;
      iconv(handle_, &in, &left, &out, &room);
      text.append(chunk.data(), chunk.size() - room);
      if (left == before) return std::nullopt;
    }
    return text;
  }

 private:
  [[nodiscard]] bool is_open() const noexcept { return handle_ != reinterpret_cast<iconv_t>(-1); }

  iconv_t handle_;
};

std::optional<std::string> converted(std::string_view bytes, const char* from) {
  return Converter(from).convert(bytes);
}

struct Mark {
  std::string_view bytes;
  const char* encoding;
};

constexpr std::array k_marks{Mark{{"\xFF\xFE\x00\x00", 4}, "UTF-32LE"}, Mark{"\xEF\xBB\xBF", "UTF-8"},
                             Mark{"\xFF\xFE", "UTF-16LE"}, Mark{"\xFE\xFF", "UTF-16BE"}};

/// Finds UTF-16 without a mark: most characters of a table have one zero byte, always in the same half of their unit.
const char* wide_encoding(std::string_view bytes) {
  std::array<std::size_t, 2> zeros{};
  const std::size_t looked_at = std::min(bytes.size(), k_looked_at);
  for (std::size_t k = 0; k < looked_at; ++k) {
    if (bytes[k] == '\0') ++zeros[k % 2];
  }
  const std::size_t many = looked_at / 4;
  if (zeros[1] > many && zeros[0] == 0) return "UTF-16LE";
  if (zeros[0] > many && zeros[1] == 0) return "UTF-16BE";
  return nullptr;
}

DecodedText decoded(std::string_view bytes) {
  for (const Mark& mark : k_marks) {
    if (!bytes.starts_with(mark.bytes)) continue;
    if (auto text = converted(bytes.substr(mark.bytes.size()), mark.encoding)) {
      const bool is_utf_8 = std::string_view(mark.encoding) == "UTF-8";
      return {std::move(*text), is_utf_8 ? "UTF-8 with BOM" : mark.encoding, {}};
    }
    return {{}, {}, fmt::format("it begins as {} and is not: it may be cut off", mark.encoding)};
  }
  if (const char* wide = wide_encoding(bytes)) {
    if (auto text = converted(bytes, wide)) return {std::move(*text), wide, {}};
  }
  if (auto text = converted(bytes, "UTF-8")) return {std::move(*text), "UTF-8", {}};
  if (auto text = converted(bytes, "WINDOWS-1252")) return {std::move(*text), "Windows-1252", {}};
  if (auto text = converted(bytes, "ISO-8859-1")) return {std::move(*text), "Latin-1", {}};
  return {{}, {}, "it is in an encoding that is not known"};
}

}  // namespace

DecodedText decode_text(std::string_view bytes) {
  if (bytes.starts_with(k_zip_archive)) {
    return {{}, {}, "this is a spreadsheet or an archive, not a text; expected the sheet exported as CSV"};
  }
  DecodedText made = decoded(bytes);
  if (made.problem.empty() && made.text.find('\0') != std::string::npos) {
    return {{}, {}, "it holds zero bytes, as no text does; expected the table exported as text, for example as CSV"};
  }
  if (made.text.find('\n') == std::string::npos) std::ranges::replace(made.text, '\r', '\n');
  return made;
}

bool has_wide_mark(std::string_view bytes) noexcept {
  return std::ranges::any_of(k_marks, [bytes](const Mark& mark) {
    return bytes.starts_with(mark.bytes) && std::string_view(mark.encoding) != "UTF-8";
  });
}

}  // namespace monograin
