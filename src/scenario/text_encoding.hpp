/// Encoding of text files from other programs.
#pragma once

#include <string>
#include <string_view>

namespace monograin {

/// Text of a file in UTF-8, with its original encoding.
struct DecodedText {
  std::string text;      ///< without a byte order mark; lines end with "\n" or "\r\n"
  std::string encoding;  ///< "UTF-8", "UTF-8 with BOM", "UTF-16LE", "UTF-16BE", "Windows-1252"
  std::string problem;   ///< why the file is no text; empty: it is one
};

/// Finds the encoding: by the byte order mark, else UTF-16 by the positions of zero bytes, else UTF-8 if the bytes are
/// valid UTF-8, else Windows-1252, a superset of Latin-1.
///
/// A lone "\r" ends a line in files without "\n". iconv (POSIX) converts the text.
[[nodiscard]] DecodedText decode_text(std::string_view bytes);

/// True if a byte order mark shows an encoding with more than one byte for each letter: UTF-16 or UTF-32.
[[nodiscard]] bool has_wide_mark(std::string_view bytes) noexcept;

}  // namespace monograin
