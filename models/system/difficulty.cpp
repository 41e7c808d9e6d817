#include "system/difficulty.hpp"

#include "system/number_text.hpp"
#include "system/resolution.hpp"

namespace monograin {

std::string advice(Difficulty difficulty) {
  switch (difficulty) {
    case Difficulty::below_resolution:
      return "the program closes no contact by more than " + number_text(k_resolution) +
             " of the particle's radius, which is round-off; expected a deeper one, or integrator = \"direct\"";
    case Difficulty::stiff_material:
      return "the bulk modulus is above " + number_text(k_stiff_modulus) +
             " yield pressures, and stresses are lost in the round-off of strains; expected integrator = \"cvode-bdf\"";
    case Difficulty::hardly_unique:
      return "the program hardly determines the plastic strain, which shows round-off; expected integrator "
             "= \"cvode-bdf\"";
    case Difficulty::singular_balance:
      return "the balance of the free centre is singular, because nothing but idle contacts keeps it from moving; "
             "expected integrator = \"auto\"";
    case Difficulty::near_applicability_limit:
      return "the limit of applicability is so near that the stiffness magnifies the errors that are tolerated; "
             "expected a larger rtol, or integrator = \"direct\"";
    case Difficulty::soft_centre:
      return "the contacts hardly hold the free centre, and the fold nearby magnifies the errors that are tolerated; "
             "expected integrator = \"direct\"";
  }
  return {};
}

}  // namespace monograin
