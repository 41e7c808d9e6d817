/// Common parts of all figures: page, frames of panels, and files.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "figure/panels.hpp"

namespace monograin::figure {

enum class Format { svg, pdf, png };  ///< in the order of k_formats

struct Axis {
  std::string label;
  AxisRange range{};
  bool is_logarithmic = false;       ///< tics at powers of ten, whatever the range's tic step
  std::vector<std::string> names{};  ///< gnuplot's enhanced texts at 1, 2, ... in place of numbers; empty: numbers
  bool keeps_unit = false;           ///< large numbers get a power of ten and not another unit
};

/// First part of a script: terminal and settings of the page. Sets the gnuplot variable `data` to the data file.
/// @param figure_name, data_name  files in the script's own folder
/// If the gnuplot variable `output` is already set, the figure goes to that file instead of figure_name.
[[nodiscard]] std::string page_head(Format format, const Layout& layout, const std::string& figure_name,
                                    const std::string& data_name);

/// Axes and labels of a panel, with its letter if there are several panels; a `plot` command has to follow.
/// @param place  index of the panel in the layout
[[nodiscard]] std::string frame_text(const Layout& layout, std::size_t place, const Axis& x, const Axis& y);

/// Width [cm] of the space above a panel beside its letter.
[[nodiscard]] double note_room(const Layout& layout, std::size_t place);

/// gnuplot's enhanced text, quoted for a label. Blanks are such that no renderer drops them beside a change of font;
/// hyphens that begin a number or stand between terms become minus signs.
[[nodiscard]] std::string label_string(std::string_view enhanced);

/// A number in the SI unit of its quantity, with a prefix that makes it short: "20 MPa".
/// @param unit  empty for a pure number
[[nodiscard]] std::string number_with_unit(double value, const std::string& unit);

/// A name as gnuplot's enhanced text, with all its characters shown as they are.
[[nodiscard]] std::string verbatim_text(std::string_view name);

/// A name as gnuplot's enhanced text. A long one loses its middle, because names often differ at their ends.
/// @param room  characters, by default as many as a panel's note has room for
[[nodiscard]] std::string short_text(const std::string& name, std::size_t room = 28);

/// Last part of a script.
inline constexpr const char* k_page_foot = "unset multiplot\nunset output\n";

/// Refuses to replace a figure that the program has not drawn: no script of the program stands beside it.
/// @throws std::runtime_error for a figure of the user
void expect_own_figure(const std::filesystem::path& figure);

/// Removes the figure that a script of the program draws, with the script and its data. Files beside it stay, such as
/// the user's own copy of the figure in another format.
void remove_own_figure(const std::filesystem::path& script);

/// A figure with its script and its data in files beside it: the same name with the endings .gp and .dat.
class FigureFiles {
 public:
  /// @param output  the figure; its extension picks the format
  /// @throws FigureError if the format is unknown, gnuplot is missing, or a file of the user stands beside the figure;
  ///                     no file has been written then
  explicit FigureFiles(std::filesystem::path output);

  [[nodiscard]] Format format() const noexcept { return format_; }
  [[nodiscard]] const std::filesystem::path& figure() const noexcept { return figure_; }
  [[nodiscard]] std::string figure_name() const { return figure_.filename().string(); }
  [[nodiscard]] std::string data_name() const { return figure_.filename().replace_extension(".dat").string(); }

  /// Writes all three files, or none. @throws FigureError if gnuplot draws nothing
  /// @throws std::runtime_error if a file cannot be written
  void write(const std::string& data, const std::string& script) const;

 private:
  std::filesystem::path figure_;
  std::filesystem::path gnuplot_;
  Format format_;
};

}  // namespace monograin::figure
