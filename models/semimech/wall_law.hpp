/// Contact of a particle of model `semimech` with a wall. In a die it leads the lateral contacts.
#pragma once

#include <optional>
#include <vector>

#include "plastic/wall_law.hpp"
#include "semimech/lateral.hpp"

namespace monograin::semimech {

class WallLaw : public plastic::WallLaw<Law> {
  using Base = plastic::WallLaw<Law>;

 public:
  struct Branch : Base::Branch {
    std::size_t next_lateral = 0;  ///< boundary ahead of the lateral contacts
  };

  /// @param out_of_range  properties of the material to which the law was not fitted
  WallLaw(const Law& law, const plastic::Settings& settings, std::vector<OutOfRange> out_of_range);

  [[nodiscard]] contacts::Boundary next(const Branch& b) const;
  void pass(Branch& b) const;
  [[nodiscard]] contacts::VisibleContact follower(const Branch& leader, bool touches, double x);
  [[nodiscard]] std::vector<Diagnostic> warnings(double walls) const;

 private:
  /// Boundary of the lateral contacts, if it is the next one of all; else none.
  [[nodiscard]] const Boundary* lateral_ahead(const Branch& b) const;

  std::vector<OutOfRange> out_of_range_;
  std::optional<LateralLaw> lateral_law_{};
  Boundaries lateral_boundaries_{};
};

}  // namespace monograin::semimech
