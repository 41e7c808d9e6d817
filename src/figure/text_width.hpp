/// Widths of texts in a figure.
#pragma once

#include <string>
#include <string_view>

namespace monograin::figure {

/// Width [cm] of an enhanced text in DejaVu Sans, the widest of the fonts that figures are commonly shown in; the font
/// itself depends on the reader's machine.
[[nodiscard]] double text_width(std::string_view enhanced);

/// An enhanced text in letters so small that it fits into a width [cm]; unchanged if it fits already.
[[nodiscard]] std::string fitted_text(const std::string& enhanced, double width_cm);

}  // namespace monograin::figure
