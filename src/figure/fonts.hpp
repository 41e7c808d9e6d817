/// Fonts of this machine, from which PDF and PNG figures take their letters.
#pragma once

#include <filesystem>
#include <string>

namespace monograin::figure {

/// Letters of a text beyond ASCII that none of the fonts has, each once.
/// @param text      in UTF-8, or with bytes by their numbers (\\nnn) as gnuplot takes them
/// @param charsets  letters of the fonts, as fontconfig writes them: "20-7e a0 391-3a9", on any number of lines
[[nodiscard]] std::string letters_without_font(const std::string& text, const std::string& charsets);

/// Refuses a script with a letter that no installed font has. Without fontconfig's fc-list there is no check.
/// @param log  new file for what fc-list prints
/// @throws FigureError that names the letters and what to do
void expect_fonts(const std::string& script, const std::filesystem::path& figure, const std::filesystem::path& log);

}  // namespace monograin::figure
