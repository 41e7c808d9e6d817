/// The gnuplot program: how it is found on the PATH and run on a script, without a shell.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace monograin::figure {

/// The gnuplot program on the PATH. @throws FigureError that says how to install it
[[nodiscard]] std::filesystem::path find_gnuplot();

/// Runs a script in its own folder, and moves the figure to its final name once it is complete. The script writes its
/// figure to the file that the gnuplot variable `output` names. gnuplot never reads either name as a command.
///
/// @param figure  in the script's folder
/// @throws FigureError with the script's name and gnuplot's messages if there is no figure; an older figure stays
void run_gnuplot(const std::filesystem::path& gnuplot, const std::filesystem::path& script,
                 const std::filesystem::path& figure);

/// A text on one line: control characters become spaces, and what is not UTF-8 the replacement character.
[[nodiscard]] std::string plain_text(std::string_view text);

/// A text that a figure shows, as a gnuplot string.
[[nodiscard]] std::string gnuplot_string(std::string_view text);

/// A file in the script's folder, as a gnuplot string that holds exactly its name. The leading `./` keeps gnuplot from
/// reading a name that begins with `<`, `|`, `~`, `$`, `-` or `+` as anything but a file.
[[nodiscard]] std::string gnuplot_file(const std::string& name);

}  // namespace monograin::figure
