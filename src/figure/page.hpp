/// What every figure has, whatever it shows: a page, frames of panels, and the files it leaves.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "figure/panels.hpp"

namespace monograin::figure {

enum class Format { svg, pdf, png };

struct Axis {
  std::string label;
  AxisRange range{};
  bool is_logarithmic = false;       ///< tics at powers of ten, whatever the range's tic step
  std::vector<std::string> names{};  ///< gnuplot's enhanced texts at 1, 2, ... in the place of numbers; empty: numbers
};

/// First part of a script: terminal and settings of the page. Sets the gnuplot variable `data` to the data file.
/// @param figure_name, data_name  files in the script's own folder
/// A figure name set before as the gnuplot variable `output` wins over figure_name.
[[nodiscard]] std::string page_head(Format format, const Layout& layout, const std::string& figure_name,
                                    const std::string& data_name);

/// Axes and labels of a panel, with its letter where there are several; the `plot` command is to follow.
/// @param place  of the panel in the layout
[[nodiscard]] std::string frame_text(const Layout& layout, std::size_t place, const Axis& x, const Axis& y);

/// Gnuplot's enhanced text, quoted, as a label wants it: blanks that no renderer drops beside a change of font, and
/// minus signs instead of hyphens where a hyphen begins a number or stands between terms.
[[nodiscard]] std::string label_string(std::string_view enhanced);

/// A name that is to appear as it is, as gnuplot's enhanced text.
[[nodiscard]] std::string verbatim_text(std::string_view name);

/// A name as it is, cut where a panel or a legend has no more room.
[[nodiscard]] std::string short_text(const std::string& name);

/// Last part of a script.
inline constexpr const char* k_page_foot = "unset multiplot\nunset output\n";

/// Writes the whole file or leaves what was there. @throws FigureError naming the file
void write_whole(const std::filesystem::path& file, const std::string& text);

/// A figure with its script and its data beside it, which bear its name and the endings .gp and .dat.
class FigureFiles {
 public:
  /// @param output  the figure; its extension picks the format
  /// @throws FigureError when the format is unknown or gnuplot is missing; nothing has been written then
  explicit FigureFiles(std::filesystem::path output);

  [[nodiscard]] Format format() const noexcept { return format_; }
  [[nodiscard]] const std::filesystem::path& figure() const noexcept { return figure_; }
  [[nodiscard]] std::string figure_name() const { return figure_.filename().string(); }
  [[nodiscard]] std::string data_name() const { return data_.filename().string(); }

  /// Writes all three. @throws FigureError; the older figure then stays
  void write(const std::string& data, const std::string& script) const;

 private:
  std::filesystem::path figure_;
  std::filesystem::path script_;
  std::filesystem::path data_;
  std::filesystem::path gnuplot_;
  Format format_;
};

}  // namespace monograin::figure
