#include "system/limit.hpp"

#include <array>

#include "system/number_text.hpp"

namespace monograin {
namespace {

struct Words {
  Limit limit;
  std::string_view code;
  std::string_view sentence;
};

constexpr std::array k_words{
    Words{Limit::free_surface_used_up, "free-surface-used-up",
          "the free surface of the particle is used up: the apparent radius would grow without bound"},
    Words{Limit::half_volume, "half-volume", "the particle is compressed elastically to half its volume"},
    Words{Limit::wall_at_centre, "wall-at-centre", "a wall has reached the centre of the particle"},
    Words{Limit::walls_meet, "walls-meet", "the walls meet"},
    Words{Limit::cell_filled, "cell-filled", "the particle fills its cell, where its pressure would be infinite"},
    Words{Limit::contact_as_wide_as_particle, "contact-as-wide-as-particle", "a contact is as wide as the particle"},
    Words{Limit::surface_covered, "surface-covered",
          "the contacts cover so much of the surface that the law's coverage factor ends"},
    Words{Limit::overlap_of_diameter, "overlap-of-diameter", "an overlap is twice the apparent radius"},
    Words{Limit::caps_intersect, "caps-intersect",
          "contact caps intersect, the source's limit of validity (strict = true)"},
    Words{Limit::greatest_force, "greatest-force",
          "the force is next to the largest that a plastic contact bears: the wider it is, the softer it becomes"},
    Words{Limit::wall_would_pull, "wall-would-pull", "a wall would have to pull, and the contact does not adhere"},
    Words{Limit::no_unloading_law, "no-unloading-law", "the law has no branch for unloading"},
    Words{Limit::applicability, "applicability",
          "limit of applicability: the stiffness becomes infinite and the path would turn back"},
    Words{Limit::source_data_end, "source-data-end",
          "the law ends where the source's data do, at a displacement of half the radius"},
    Words{Limit::pressure_table_end, "pressure-table-end", "the pressure table ends"},
    Words{Limit::no_consistent_regimes, "no-consistent-regimes",
          "no set of regimes is consistent: in each, the branch of some contact disagrees with its motion"},
    Words{Limit::centre_not_held, "centre-not-held", "no contact holds the free centre of the particle"},
    Words{Limit::centre_driven_away, "centre-driven-away",
          "no contact holds the free centre of the particle against the forces on it"},
    Words{Limit::centre_fold, "centre-fold",
          "the free centre has come to a fold: beyond it no position balances the forces of the contacts"},
    Words{Limit::centre_softening, "centre-softening",
          "the contacts have passed their greatest force: the position of the free centre is not determined"},
    Words{Limit::pores_closed, "pores-closed", "no pores are left"},
    Words{Limit::cap_centre_at_zero_pressure, "cap-centre-at-zero-pressure",
          "the cap's centre has reached zero pressure, beyond which the segments of the yield surface overlap"},
    Words{Limit::cap_axis_ratio_zero, "cap-axis-ratio-zero",
          "the linear law of the cap's axis ratio ends: the cap has shrunk to a line"},
    Words{Limit::cap_arc_too_wide, "cap-arc-too-wide", "transition_width is too large"},
    Words{Limit::poisson_half, "poisson-half",
          "the linear law of Poisson's ratio ends: the material cannot be compressed elastically"},
    Words{Limit::too_stiff, "too-stiff",
          "the material has become too stiff for its strength: stresses are lost in the round-off of strains"},
    Words{Limit::loss_of_uniqueness, "loss-of-uniqueness", "the program no longer determines one plastic strain"},
    Words{Limit::greatest_strain, "greatest-strain", "the packing's strain does not grow any further"},
    Words{Limit::greatest_stress, "greatest-stress", "the packing's stress does not grow any further"},
    Words{Limit::infinite_stress, "infinite-stress",
          "the particles are compressed as much as the packing: its stress is infinite"},
    Words{Limit::no_solution, "no-solution", "no state was found"},
    Words{Limit::unequal_durations, "unequal-durations", "steps end together; give equal durations"},
};

constexpr bool stand_in_order() {
  for (std::size_t k = 0; k < k_words.size(); ++k) {
    if (k_words[k].limit != static_cast<Limit>(k)) return false;
  }
  return true;
}
static_assert(stand_in_order() && k_words.back().limit == Limit::unequal_durations);

const Words& words_of(Limit limit) noexcept { return k_words[static_cast<std::size_t>(limit)]; }

}  // namespace

std::string_view code(Limit limit) noexcept { return words_of(limit).code; }

std::string_view sentence(Limit limit) noexcept { return words_of(limit).sentence; }

std::string text_of(const LimitPoint& point, std::string_view remark) {
  std::string text(sentence(point.limit));
  if (!remark.empty()) text.append("; ").append(remark);
  if (point.quantity.empty()) return text;
  return text.append(" (").append(point.quantity).append(" = ").append(number_text(point.value, 9)).append(")");
}

DomainError::DomainError(const LimitPoint& point) : std::domain_error(text_of(point)), point_(point) {}

DomainError::DomainError(const LimitPoint& point, std::string_view remark)
    : std::domain_error(text_of(point, remark)), point_(point) {}

DomainError::DomainError(Limit limit, const std::string& message)
    : std::domain_error(message), point_{.limit = limit} {}

DomainError as_domain_error(const std::domain_error& error) {
  const auto* known = dynamic_cast<const DomainError*>(&error);
  return known == nullptr ? DomainError(Limit::no_solution, error.what()) : *known;
}

}  // namespace monograin
