#include "fuzz/readers.hpp"

#include <array>
#include <stdexcept>
#include <string>

#include "history/table.hpp"
#include "scenario/curve_file.hpp"
#include "scenario/measured_data.hpp"
#include "scenario/scenario.hpp"
#include "support/temporary_folder.hpp"
#include "support/text_file.hpp"

namespace monograin {
namespace {

constexpr std::string_view k_csv = "# csv\n";

void read_table(std::string_view text) {
  static const TemporaryFolder folder;
  const auto file = folder.path() / "table.csv";
  write_text(file, std::string(text));
  try {
    static_cast<void>(read_csv(file));
  } catch (const std::runtime_error&) {
    return;
  }
}

template <class Reader>
void read_with_faults(Reader&& reader) {
  FaultList faults;
  reader(faults);
  try {
    faults.throw_if_any();
  } catch (const ScenarioError&) {
    return;
  }
}

}  // namespace

void read_any(std::string_view text) {
  if (!text.starts_with(k_csv)) {
    try {
      static_cast<void>(parse_scenario(text, "fuzz.toml"));
    } catch (const ScenarioError&) {
      return;
    }
    return;
  }
  text.remove_prefix(k_csv.size());
  read_table(text);
  read_with_faults([&](FaultList& faults) { static_cast<void>(parse_curve(text, "fuzz.csv", faults)); });
  const std::array<QuantityKey, 3> columns{QuantityKey{"x", "", Dimension::none, {}, {}, false},
                                           QuantityKey{"y", "", Dimension::none, {}, {}, false},
                                           QuantityKey{"z", "", Dimension::none, {}, {}, false}};
  read_with_faults([&](FaultList& faults) {
    static_cast<void>(parse_columns(text, "fuzz.csv", columns, {"fuzz.toml"}, "table = \"fuzz.csv\"", faults));
  });
  read_with_faults([&](FaultList& faults) {
    static_cast<void>(parse_measured(text, "fuzz.csv",
                                     {{"x", {"fuzz.toml"}, "x = \"x\""}, {"y", {"fuzz.toml"}, "y = \"y\""}}, faults));
  });
}

}  // namespace monograin
