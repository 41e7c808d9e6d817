#include "figure/page.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "figure/figure.hpp"
#include "figure/gnuplot.hpp"
#include "figure/text_width.hpp"
#include "scenario/cells.hpp"
#include "scenario/text_file.hpp"

namespace monograin::figure {
namespace {

namespace fs = std::filesystem;

constexpr double k_x_label_cm = 1.05;  // from an axis down to the middle of its label
// A logarithmic axis with more decades leaves out some labels. Labels side by side run into each other sooner than
// labels above each other.
constexpr double k_most_decades_along = 5.0;
constexpr double k_most_decades_up = 6.0;

[[nodiscard]] Format format_of(const fs::path& output) {
  const std::string extension = output.extension().string();
  for (std::size_t k = 0; k < k_formats.size(); ++k) {
    if (extension.starts_with('.') && extension.substr(1) == k_formats[k]) return static_cast<Format>(k);
  }
  throw FigureError(
      fmt::format("{}: unknown figure format '{}'; expected .svg, .pdf or .png", output.string(), extension));
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  if (!folder.empty()) fs::create_directories(folder, failure);
  if (failure) throw FigureError(fmt::format("{} cannot be made: {}", folder.string(), failure.message()));
}

/// Beginning of the script that draws a figure.
[[nodiscard]] std::string first_words(const std::string& figure_name) {
  return fmt::format("# Draws {}. ", gnuplot_file(figure_name));
}

[[nodiscard]] std::string terminal(Format format, const Layout& layout) {
  constexpr double k_svg_per_cm = 37.8;  // CSS: 96 px to the inch
  constexpr double k_png_scale = k_png_per_cm / k_svg_per_cm;
  const auto pixels = [](double cm, double per_cm) { return std::lround(cm * per_cm); };
  switch (format) {
    case Format::svg:
      return fmt::format("svg enhanced size {},{} font 'Helvetica,Arial,sans-serif,13' background 'white'",
                         pixels(layout.width, k_svg_per_cm), pixels(layout.height, k_svg_per_cm));
    case Format::pdf:
      // The default scale of fonts is 0.5, with which they have two thirds of their size.
      return fmt::format(
          "pdfcairo enhanced size {}cm,{:.4g}cm font 'Helvetica,10' fontscale 0.75 linewidth 1.5 pointscale 1.2 "
          "dashlength 1.6",
          layout.width, layout.height);
    case Format::png:
      return fmt::format(
          "pngcairo enhanced size {},{} font 'Helvetica,10' fontscale {:.4g} linewidth {:.4g} pointscale {:.4g} "
          "dashlength 1.8",
          pixels(layout.width, k_png_per_cm), pixels(layout.height, k_png_per_cm), k_png_scale, 0.95 * k_png_scale,
          1.23 * k_png_scale);
  }
  return {};
}

[[nodiscard]] int power_of_ten(double value) { return static_cast<int>(std::floor(std::log10(value))); }

/// Power of ten by which the numbers of a range are divided if they are too long for the room beside it; else 0.
[[nodiscard]] int shared_power(const AxisRange& range) {
  constexpr int k_least = -3;  // of the tics' distance, too: 0.0002 is too long
  constexpr int k_most = 4;
  const int power = power_of_ten(std::max(std::abs(range.lowest), std::abs(range.highest)));
  const bool is_fine = range.tic_step > 0.0 && power_of_ten(range.tic_step) < k_least;
  return power < k_least || power > k_most || is_fine ? power : 0;
}

/// Label of an axis, and the power of ten by which its numbers are divided.
struct Numbers {
  std::string label;
  int power = 0;
  bool is_in_label = false;  ///< the label's unit has a prefix for the power
};

struct Prefix {
  std::string_view symbol;
  int power;  ///< of ten
};

/// Prefix of SI with which numbers of a power of ten become short; none if the unit takes none.
[[nodiscard]] std::optional<Prefix> prefix_of(std::string_view unit, int power) {
  constexpr std::array<std::string_view, 9> k_prefixes{"p", "n", "µ", "m", "", "k", "M", "G", "T"};
  constexpr std::array<std::string_view, 5> k_units{"Pa", "N", "m", "J", "s"};
  const int thousands = (power >= 0 ? power : power - 2) / 3;
  const int prefix = 4 + thousands;
  if (std::ranges::find(k_units, unit) == k_units.end() || prefix < 0 || prefix >= static_cast<int>(k_prefixes.size()))
    return std::nullopt;
  return Prefix{k_prefixes[static_cast<std::size_t>(prefix)], 3 * thousands};
}

/// Numbers with units of SI, such as Pa, become shorter by a prefix: MPa.
[[nodiscard]] Numbers numbers_of(const Axis& axis) {
  if (axis.is_logarithmic || !axis.names.empty()) return {axis.label};
  const int power = shared_power(axis.range);
  if (axis.keeps_unit) return {axis.label, power};
  const std::size_t begin = axis.label.rfind(" [");
  if (begin == std::string::npos || !axis.label.ends_with(']')) return {axis.label, power};
  const auto prefix = prefix_of(std::string_view(axis.label).substr(begin + 2, axis.label.size() - begin - 3), power);
  if (!prefix || prefix->power == 0) return {axis.label, power};
  std::string label = axis.label;
  label.insert(begin + 2, prefix->symbol);
  return {label, prefix->power, true};
}

/// Tics with numbers that are divided by a power of ten.
[[nodiscard]] std::string tics_over_power(const AxisRange& range, int power) {
  std::string tics;
  const double first = std::ceil(range.lowest / range.tic_step) + 0.0;  // no zero with a sign
  for (double k = first; k * range.tic_step <= range.highest; k += 1.0) {
    const double place = k * range.tic_step;
    tics += fmt::format("{}{} {:.6g}", tics.empty() ? "" : ", ",
                        label_string(fmt::format("{:.6g}", place / std::pow(10.0, power))), place);
  }
  return fmt::format("({})", tics);
}

/// Tics with names at 1, 2, ...
[[nodiscard]] std::string tics_of(const std::vector<std::string>& names) {
  std::string tics;
  for (std::size_t k = 0; k < names.size(); ++k) {
    tics += fmt::format("{}{} {}", k > 0 ? ", " : "", label_string(names[k]), k + 1);
  }
  return fmt::format("({})", tics);
}

[[nodiscard]] std::string axis_text(char name, const Axis& axis) {
  const auto& [lowest, highest, tic_step] = axis.range;
  if (axis.is_logarithmic) {
    const double decades = std::log10(highest / lowest);
    const double most = name == 'x' ? k_most_decades_along : k_most_decades_up;
    const std::string tics = decades > most ? fmt::format("1e{:.0f}", std::ceil(decades / most)) : "autofreq";
    return fmt::format(
        "set logscale {0}; set {0}range [{1:.6g}:{2:.6g}]; set {0}tics {3}; "
        "set format {0} '10^{{%T}}'\n",
        name, lowest, highest, tics);
  }
  if (!axis.names.empty()) {
    return fmt::format("set {0}range [{1:.6g}:{2:.6g}]; set {0}tics {3}\n", name, lowest, highest, tics_of(axis.names));
  }
  const int power = numbers_of(axis).power;
  return fmt::format("set {0}range [{1:.6g}:{2:.6g}]; set {0}tics {3}\n", name, lowest, highest,
                     power == 0 ? fmt::format("{:.6g}", tic_step) : tics_over_power(axis.range, power));
}

/// Power of ten of an axis's numbers, as a text; empty if they have none beside their label.
[[nodiscard]] std::string power_of(const Numbers& numbers) {
  return numbers.power == 0 || numbers.is_in_label ? std::string() : fmt::format("10^{{{}}}", numbers.power);
}

/// Text at the end of an axis that gives the power of ten of its numbers.
[[nodiscard]] std::string power_text(int label, const std::string& power, const std::string& place) {
  if (power.empty()) return fmt::format("unset label {}\n", label);
  return fmt::format("set label {} {} at {} right\n", label, label_string("×" + power), place);
}

}  // namespace

std::string page_head(Format format, const Layout& layout, const std::string& figure_name,
                      const std::string& data_name) {
  return fmt::format(
      "{3}To be run in its own folder, as gnuplot ./NAME.gp\n"
      "if (!exists(\"output\")) output = {0}\n"
      "data = {1}\n\n"
      "set encoding utf8\n"
      "set minussign\n"
      "set terminal {2}\n"
      "set output output\n"
      "set border 3 lw 0.8\n"
      "set tics nomirror out scale 0.6\n"
      "set xtics offset 0, 0.3\n"
      "set format '%g'\n"
      "set xlabel offset 0, 0.5\n"
      "unset key\n"
      "set multiplot\n",
      gnuplot_file(figure_name), gnuplot_file(data_name), terminal(format, layout), first_words(figure_name));
}

std::string frame_text(const Layout& layout, std::size_t place, const Axis& x, const Axis& y) {
  const Panel& panel = layout.panels[place];
  const Box& axes = panel.axes;
  // Below an axis the power would meet the label; it joins the unit there, or stands in its place.
  const Numbers along = numbers_of(x);
  const Numbers up = numbers_of(y);
  std::string x_label = along.label;
  std::string x_power = power_of(along);
  if (!x_power.empty() && !x_label.empty()) {
    const std::size_t unit = x_label.rfind(" [");
    if (unit != std::string::npos && x_label.ends_with(']'))
      x_label.insert(unit + 2, x_power + " ");
    else
      x_label += fmt::format(" [{}]", x_power);
    x_power.clear();
  }
  const std::string letter =
      layout.panels.size() > 1 ? fmt::format("({})", static_cast<char>('a' + place % 26)) : std::string();
  return fmt::format(
      "\nset lmargin at screen {:.4f}; set rmargin at screen {:.4f}\n"
      "set bmargin at screen {:.4f}; set tmargin at screen {:.4f}\n"
      "{}{}"
      "set xlabel {}\n"
      "set label 1 '{}' at graph 0.02, 1.06 left\n"
      "set label 2 {} at screen {:.4f}, {:.4f} center rotate by 90\n"
      "{}{}",
      axes.left / layout.width, axes.right() / layout.width, axes.bottom / layout.height, axes.top() / layout.height,
      axis_text('x', x), axis_text('y', y), label_string(fitted_text(x_label, axes.width + 2.0 * k_right_cm)), letter,
      label_string(fitted_text(up.label, axes.height + 2.0 * k_top_cm)), panel.y_label_left / layout.width,
      (axes.bottom + 0.5 * axes.height) / layout.height,
      power_text(3, x_power, fmt::format("graph 1, screen {:.4f}", (axes.bottom - k_x_label_cm) / layout.height)),
      power_text(4, power_of(up), "graph -0.01, 1.06"));
}

double note_room(const Layout& layout, std::size_t place) {
  constexpr double k_share = 0.96;  // of the panel's width, between letter and note's end
  const double letter = layout.panels.size() > 1 ? text_width("(m) ") : 0.0;
  return k_share * layout.panels[place].axes.width - letter;
}

std::string label_string(std::string_view enhanced) {
  constexpr std::string_view k_before_a_minus = " ({=";
  // gnuplot asks SVG renderers to keep the blanks of a text only if it has two in a row; otherwise some renderers drop
  // blanks beside a change of font. These two blanks are one point high.
  constexpr std::string_view k_keep_blanks = "{/=1   }";
  std::string text;
  char before = ' ';
  for (const char c : enhanced) {
    const bool is_minus = c == '-' && k_before_a_minus.find(before) != std::string_view::npos;
    text += is_minus ? k_minus_sign : std::string_view(&c, 1);
    before = c;
  }
  const bool changes_font = text.find_first_of("{^_") != std::string::npos;
  if (changes_font && text.find(' ') != std::string::npos) text += k_keep_blanks;
  return gnuplot_string(text);
}

std::string number_with_unit(double value, const std::string& unit) {
  if (unit.empty()) return fmt::format("{:.4g}", value);
  const auto prefix = value == 0.0 ? std::nullopt : prefix_of(unit, power_of_ten(std::abs(value)));
  if (!prefix) return fmt::format("{:.4g} {}", value, unit);
  return fmt::format("{:.4g} {}{}", value / std::pow(10.0, prefix->power), prefix->symbol, unit);
}

std::string verbatim_text(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (std::string_view("\\{}^_@&~").find(c) != std::string_view::npos) text += '\\';
    text += c;
  }
  return text;
}

std::string short_text(const std::string& name, std::size_t room) {
  constexpr std::string_view k_gap = "...";
  // Positions of the characters of UTF-8.
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < name.size(); ++k) {
    if ((static_cast<unsigned char>(name[k]) & 0xC0U) != 0x80U) begins.push_back(k);
  }
  if (begins.size() <= room) return verbatim_text(name);
  const std::size_t head = (room - k_gap.size() + 1) / 2;
  const std::size_t tail = room - k_gap.size() - head;
  return verbatim_text(name.substr(0, begins[head]) + std::string(k_gap) + name.substr(begins[begins.size() - tail]));
}

void expect_own_figure(const fs::path& figure) {
  const fs::path script = fs::path(figure).replace_extension(".gp");
  for (const fs::path& file : {figure, script, fs::path(figure).replace_extension(".dat")})
    expect_own_file(file, script);
}

void remove_own_figure(const fs::path& script) {
  constexpr std::size_t k_first_line = 4096;
  const std::string text = read_text_file(script, k_first_line).text;
  for (const std::string_view format : k_formats) {
    const fs::path figure = fs::path(script).replace_extension(format);
    if (!text.starts_with(first_words(figure.filename().string()))) continue;
    for (const fs::path& file : {figure, script, fs::path(script).replace_extension(".dat")}) fs::remove(file);
  }
}

FigureFiles::FigureFiles(fs::path output) : figure_(std::move(output)), format_(format_of(figure_)) {
  gnuplot_ = find_gnuplot();
  try {
    const fs::path script = fs::path(figure_).replace_extension(".gp");
    for (const fs::path& file : {script, fs::path(figure_).replace_extension(".dat")}) expect_own_file(file, script);
  } catch (const std::runtime_error& error) {
    throw FigureError(error.what());
  }
}

void FigureFiles::write(const std::string& data, const std::string& script) const {
  make_folder(figure_.parent_path());
  draw_with_gnuplot(gnuplot_, figure_, script, data);
}

}  // namespace monograin::figure
