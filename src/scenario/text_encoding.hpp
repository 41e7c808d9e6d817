/// The encoding of text files that other programs have written.
#pragma once

#include <string>
#include <string_view>

namespace monograin {

/// A file's text in UTF-8, and how the file has it.
struct DecodedText {
  std::string text;      ///< without a byte order mark; lines end with "\n" or "\r\n"
  std::string encoding;  ///< "UTF-8", "UTF-8 with BOM", "UTF-16LE", "UTF-16BE", "Windows-1252"
  std::string problem;   ///< why it is no text; empty: it is one
};

/// Finds the encoding by the byte order mark, else by the places of zero bytes (UTF-16), else UTF-8 where the bytes are
/// valid UTF-8, else Windows-1252, which is Latin-1 with a few signs more.
///
/// A lone "\r" ends a line in files without "\n". The conversion is that of iconv (POSIX).
[[nodiscard]] DecodedText decode_text(std::string_view bytes);

}  // namespace monograin
