/// The gnuplot program: how it is found on the PATH and run on a script, without a shell.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace monograin::figure {

/// Resolution of PNG figures, which the files state: 300 dots per inch.
inline constexpr double k_png_per_cm = 118.11;

/// The gnuplot program on the PATH. @throws FigureError that says how to install it
[[nodiscard]] std::filesystem::path find_gnuplot();

/// Draws a figure, and puts its script and its data beside it, with the endings .gp and .dat: all three or none. The
/// script writes its figure to the file that the gnuplot variable `output` names, and reads the data by their name.
///
/// @throws FigureError with gnuplot's messages if it draws nothing; for PDF and PNG if no installed font has a letter
/// of the script, where pango would draw a box of its own over the whole figure
/// @throws std::runtime_error if a file cannot be written
void draw_with_gnuplot(const std::filesystem::path& gnuplot, const std::filesystem::path& figure,
                       const std::string& script, const std::string& data);

/// A text on one line: control characters become spaces, and what is not UTF-8 the replacement character.
[[nodiscard]] std::string plain_text(std::string_view text);

/// A text that a figure shows, as a gnuplot string.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

/// A file in the script's folder, as a gnuplot string that holds exactly its name. The leading `./` keeps gnuplot from
/// reading a name that begins with `<`, `|`, `~`, `$`, `-` or `+` as anything but a file.
[[nodiscard]] std::string gnuplot_file(const std::string& name);

}  // namespace monograin::figure
