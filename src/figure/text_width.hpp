/// Widths of texts in a figure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace monograin::figure {

/// Width [cm] of an enhanced text in DejaVu Sans, the widest of the fonts that figures are commonly shown in; the font
/// itself depends on the reader's machine.
[[nodiscard]] double text_width(std::string_view enhanced);

/// Enhanced texts that fit into a width [cm]; those that fit already are unchanged. Letters become smaller down to 7
/// pt; beyond that a text loses a part of its middle, but not where it differs from another of the texts.
[[nodiscard]] std::vector<std::string> fitted_texts(const std::vector<std::string>& enhanced, double width_cm);

/// One text that fits into a width [cm].
[[nodiscard]] std::string fitted_text(const std::string& enhanced, double width_cm);

}  // namespace monograin::figure
