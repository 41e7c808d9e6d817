#include "cel/guards.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace monograin::cel {
namespace {

/// Value of the yield function at which its guard fires; more than round-off of a contact that just stopped flowing.
constexpr double k_beyond_yield = 1e-12;
/// Margin to a fold (Motion::margin()) at which a run ends: the stiffness is infinite at the fold.
constexpr double k_least_margin = 1e-5;
/// Largest coverage to which the law is fitted: half the contact area over pi R0^2, which is 2 for the whole surface.
constexpr double k_most_coverage = 1.7;

/// Names and directions of the guards, in the order of their kinds.
struct Kind {
  std::string_view name;
  int direction;
};
constexpr std::array<Kind, 6> k_kinds{
    {{"contact-made", 1}, {"contact-lost", -1}, {"yield", 1}, {"load-reversal", -1}, {"limit", -1}, {"limit", -1}}};

/// Distance of a state from a limit; zero or less where it is met.
double limit_value(int kind, const Particle& p, const Motion& motion) noexcept {
  return kind == k_fold ? motion.margin() - k_least_margin : k_most_coverage - p.coverage().Om;
}

}  // namespace

Guard& GuardSet::add(int kind, int index) {
  const Kind& of = k_kinds[static_cast<std::size_t>(kind)];
  list_.push_back({.kind = kind, .index = index, .direction = of.direction, .name = of.name});
  return list_.back();
}

void GuardSet::arm(const Particle& p) {
  list_.clear();
  if (p.is_at_rest()) return;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const int index = static_cast<int>(i);
    const ClassState& c = p.classes[i];
    if (!c.takes_force()) {
      add(c.touches ? k_lost : k_made, index).is_silent = c.gives_way;
    } else if (c.drive.end() < 0.0) {
      Guard& lost = add(k_lost, index);
      lost.is_exact = lost.is_monotone = true;
    }
    if (c.touches) add(c.flows ? k_reversal : k_yield, index);
  }
  add(k_fold, -1);
  add(k_coverage, -1);
}

void GuardSet::values(const Particle& p, const Motion& motion, double xi, std::span<double> values) const {
  for (std::size_t g = 0; g < list_.size(); ++g) {
    const auto i = static_cast<std::size_t>(std::max(0, list_[g].index));
    const ClassState& c = p.classes[i];
    switch (list_[g].kind) {
      case k_made:
        values[g] = (c.contact.u - p.slack(i)) / p.depth();
        break;
      case k_lost:
        values[g] = c.takes_force() ? c.drive.value(xi) / c.drive.size() : (c.contact.u + p.slack(i)) / p.depth();
        break;
      case k_yield:
        values[g] = c.yield.f - k_beyond_yield;
        break;
      case k_reversal: {
        const double rate = motion.rates()[p.layout().dent(i)];
        values[g] = rate / (std::abs(rate) + std::abs(c.drive.rate()) + p.depth());
        break;
      }
      default:
        values[g] = limit_value(list_[g].kind, p, motion);
        break;
    }
  }
}

DomainEnd end_at(int kind, const Particle& p, double xi) {
  const Event event{k_kinds[static_cast<std::size_t>(kind)].name};
  if (kind == k_coverage) return {event, {Limit::surface_covered, -1, "coverage", p.coverage().Om}};
  double largest = 0.0;
  for (const ClassState& c : p.classes) largest = std::max(largest, c.position(xi));
  return {event, {Limit::applicability, -1, "largest displacement/R0", largest}};
}

std::optional<DomainEnd> limit_met(const Particle& p, const Motion& motion, double xi) {
  for (const int kind : {k_fold, k_coverage}) {
    if (limit_value(kind, p, motion) <= 0.0) return end_at(kind, p, xi);
  }
  return std::nullopt;
}

}  // namespace monograin::cel
