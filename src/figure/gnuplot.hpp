/// The gnuplot program: found on the PATH, fed through a pipe, and watched for what it leaves behind.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace monograin::figure {

/// The gnuplot program on the PATH. @throws FigureError that says how to install it
[[nodiscard]] std::filesystem::path find_gnuplot();

/// Loads a script in its own folder and puts the figure in its place once it is whole. The script writes its figure to
/// the file the gnuplot variable `output` names.
///
/// @throws FigureError naming the script, with what gnuplot said, when no figure comes out; an older figure stays
void run_gnuplot(const std::filesystem::path& gnuplot, const std::filesystem::path& script,
                 const std::filesystem::path& figure);

/// A text as a gnuplot string in single quotes. Line breaks become spaces: a gnuplot string has none.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

}  // namespace monograin::figure
