#include "plastic/law.hpp"

#include <type_traits>

namespace monograin::plastic {
namespace {

template <class... Calls>
struct Overloaded : Calls... {
  using Calls::operator()...;
};
template <class... Calls>
Overloaded(Calls...) -> Overloaded<Calls...>;

}  // namespace

Regime first_regime(const Law& law) noexcept { return begins_elastic(law) ? Regime::elastic : Regime::fully_plastic; }

Boundaries boundaries(const Law& law) {
  return std::visit(Overloaded{[](const SimilarityLaw&) { return Boundaries(); },
                               [](const auto& other) { return boundaries(other); }},
                    law);
}

ContactState state_in(const Law& law, Regime regime, double x) {
  return std::visit(Overloaded{[&](const SimilarityLaw& similarity) { return contact_of(similarity, x); },
                               [&](const auto& other) { return state_in(other, regime, x); }},
                    law);
}

double approach_under(const Law& law, double force, double near) {
  const auto under = [&](const auto& any) {
    // The similarity law needs no guess.
    if constexpr (std::is_same_v<std::decay_t<decltype(any)>, SimilarityLaw>)
      return approach_under(any, force);
    else
      return approach_under(any, force, near);
  };
  return std::visit(under, law);
}

double work_per_wall(const Law& law, double x) {
  return std::visit(Overloaded{[&](const SimilarityLaw& similarity) { return work_per_wall(similarity, x); },
                               [&](const auto& other) { return work(other, x) / moving_walls(other.configuration); }},
                    law);
}

double work_in(const Law& law, Regime regime, double x) {
  return std::visit(Overloaded{[&](const SimilarityLaw& similarity) { return work_per_wall(similarity, x); },
                               [&](const auto& other) { return work_in(other, regime, x); }},
                    law);
}

double limit(const Law& law) noexcept {
  return std::visit(Overloaded{[](const SimilarityLaw&) { return k_similarity_limit; },
                               [](const auto& other) { return other.limit; }},
                    law);
}

double calibrated_end(const Law& law) noexcept {
  return std::visit(Overloaded{[](const SimilarityLaw&) { return k_similarity_calibrated_end; },
                               [](const auto& other) { return other.calibrated_end; }},
                    law);
}

double first_power(const Law& law) noexcept {
  return std::visit(
      Overloaded{[](const SemimechLaw&) { return 1.5; }, [](const auto& rigid) { return 1.0 + 0.5 * rigid.exponent; }},
      law);
}

bool begins_elastic(const Law& law) noexcept { return std::holds_alternative<SemimechLaw>(law); }

std::optional<double> impingement(const Law& law) {
  return std::visit(Overloaded{[](const SimilarityLaw&) { return std::optional<double>(); },
                               [](const auto& other) {
                                 const bool is_enclosed = other.configuration != Configuration::simple;
                                 return is_enclosed ? std::optional(impingement_approach(other)) : std::nullopt;
                               }},
                    law);
}

}  // namespace monograin::plastic
