/// Materials for the tests of model `semimech`.
#pragma once

#include <ostream>
#include <vector>

#include "models/plastic/cases.hpp"
#include "semimech/law.hpp"

namespace monograin::semimech {

struct Steel {
  double youngs_modulus, poisson_ratio, yield_stress;

  [[nodiscard]] Law law(Configuration configuration) const {
    return make_law(make_material(youngs_modulus, poisson_ratio, yield_stress), configuration);
  }
};

inline std::ostream& operator<<(std::ostream& out, const Steel& steel) {
  return out << "E = " << steel.youngs_modulus << ", nu = " << steel.poisson_ratio << ", Y = " << steel.yield_stress;
}

inline Steel steel_of(const Table& table, std::size_t row) {
  using plastic::number;
  return {number(table, row, "E"), number(table, row, "nu"), number(table, row, "sigma_y")};
}

/// All materials of the source's calculations.
inline std::vector<Steel> steels_of_the_source() {
  const Table table = plastic::reference("semimech", "table_A1");
  std::vector<Steel> steels;
  for (std::size_t row = 0; row < table.row_count(); ++row) steels.push_back(steel_of(table, row));
  return steels;
}

}  // namespace monograin::semimech
