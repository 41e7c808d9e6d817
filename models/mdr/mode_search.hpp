/// Search for the mode of the MDR particle at an instant: branch of every contact and growth of the radius depend on
/// each other, so the search assumes a mode, evaluates it, corrects it, and repeats until it is consistent.
///
/// The search works on a copy of the particle, which the caller adopts if the search succeeds.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mdr/contact_caps.hpp"
#include "mdr/particle.hpp"
#include "system/observables.hpp"
#include "system/regimes.hpp"

namespace monograin::mdr {

/// Reason to stop when a wall has reached the centre of the particle.
[[nodiscard]] DomainEnd centre_reached(int contact_class);

class ModeSearch {
 public:
  explicit ModeSearch(const Particle& particle) : p_(particle) { begin(particle); }

  /// Begins another search, from the mode of a particle.
  void begin(const Particle& particle);
  /// The particle in the mode that was found; after an exception, in the one that was tried last.
  [[nodiscard]] Particle& particle() noexcept { return p_; }

  /// Applies the transitions of guards that have fired, and keeps what a growth guard decides for resolve().
  /// @return the reason to stop, if the equations end here
  std::optional<DomainEnd> apply(std::span<const Guard> fired, double xi, std::span<double> y, ContactCaps& caps,
                                 std::vector<Event>& log);
  /// Closes the nearest walls together with contact i, which a force begins to press. A loose particle moves to walls
  /// that support that force.
  void touch_under_force(std::size_t i, double xi, std::span<double> y, std::vector<Event>& log);
  /// Opens the contacts of the walls that a prescribed force pulls away, along the softest direction of the centre.
  /// @return false if there are none
  bool separate_pulling_walls(double xi, std::span<double> y, std::vector<Event>& log);
  /// Finds the consistent mode, and moves centre and walls to equilibrium in it.
  /// @throws std::domain_error if no mode is consistent, or the equations end here
  void resolve(double xi, std::span<double> y, std::vector<Event>& log);

  /// Warning about the first adhesive contact to unload in this search for which the model is not valid.
  [[nodiscard]] const std::optional<Diagnostic>& validity() const noexcept { return validity_; }

 private:
  /// Motion that a contact is about to begin.
  struct Tendency {
    bool is_pressed_by_growth = false;  ///< growth presses the contact, or is about to while its rate is still zero
    bool moves_in = false;
    bool retreats = false;    ///< leaves its largest overlap
    bool advances = false;    ///< towards its largest overlap, or beyond
    bool is_pressed = false;  ///< a prescribed force presses it
    bool closes = false;
    bool opens = false;
  };

  /// State from which a free centre snaps to another equilibrium.
  struct Snap {
    std::vector<ContactBranch> branches;
    std::vector<double> overlaps{};
    std::size_t log_size_before = 0;   ///< events of the log that are older than the snap
    std::size_t made_size_before = 0;  ///< events of made_ that are older than the snap
  };

  [[nodiscard]] bool is_void(const Guard& guard, const Motion& now) const;
  bool apply_transition(const Guard& guard, std::span<double> y, const Motion& now, std::vector<Event>& log);
  bool peel_or_set_back(std::size_t i, std::span<double> y, const Motion& now, std::vector<Event>& log);
  [[nodiscard]] std::optional<DomainEnd> end_of(const Guard& guard, ContactCaps& caps, std::vector<Event>& log);
  [[nodiscard]] bool is_extremum(const Guard& guard, const Motion& now) const;

  [[nodiscard]] bool settles(double xi, std::span<double> y, std::vector<Event>& log);
  [[nodiscard]] bool correct_once(double xi, std::span<double> y, std::vector<Event>& log);
  void freeze_mode(double xi, std::span<double> y);
  [[nodiscard]] bool wants_growth(double xi, std::span<double> y);
  void balance_anew(double xi, std::span<double> y, std::vector<Event>& log);
  [[nodiscard]] bool follow_snap(std::size_t i, double xi, std::span<double> y, std::vector<Event>& log);

  [[nodiscard]] Tendency tendency(std::size_t i, double xi, const Motion& now) const;
  bool resolve_contact(std::size_t i, double xi, std::span<double> y, const Motion& now, std::vector<Event>& log);
  bool resolve_elastic(std::size_t i, double xi, const Tendency& tends, std::vector<Event>& log);
  bool resolve_below_largest(std::size_t i, double xi, std::span<double> y, const Motion& now, const Tendency& tends,
                             std::vector<Event>& log);
  bool resolve_edge(std::size_t i, double xi, std::span<double> y, const Motion& now, bool is_pressed_by_growth,
                    std::vector<Event>& log);

  void start_unloading(std::size_t i, std::string_view why, std::vector<Event>& log);
  void stick(std::size_t i, std::vector<Event>& log);
  void start_peeling(std::size_t i, std::span<double> y, std::vector<Event>& log);
  void separate(std::size_t i, std::span<double> y, std::vector<Event>& log);
  /// Number of corrections after which the search concludes that no mode is consistent. At one instant each contact
  /// changes a few times at most, growth and centre once more; beyond that, contacts alternate.
  [[nodiscard]] std::size_t most_rounds() const noexcept { return 4 * p_.size() + 8; }

  Particle p_;
  // History of each contact at this instant. Neither resolve() nor a restart in it clears the first and the
  // third; loads_again_ can thus only grow while resolve() searches.
  std::vector<bool> has_turned_;   ///< started to unload at this instant, or its edge came to rest
  std::vector<bool> loads_again_;  ///< started to unload at this instant, then loaded on beyond its largest overlap
  std::vector<bool> is_left_;      ///< lost at this instant, because forces press the centre away from its wall
  std::vector<Edge> edges_before_;
  Snap snap_;
  std::vector<Event> made_;             ///< contacts made in the search, which are logged at its end
  std::optional<bool> decided_growth_;  ///< what a growth guard has just decided; none: the sign of the demand decides
  /// A force-controlled contact has just yielded: its force has jumped, and its wall has not moved yet. The search
  /// leaves centre and walls as they are, and freezes the volume balance in this state; when the wall moves the radius
  /// follows, and may fall a little.
  bool has_yielded_under_force_ = false;
  bool radius_diverges_ = false;  ///< the radius would run away in a mode tried in this search
  std::optional<Diagnostic> validity_;
};

}  // namespace monograin::mdr
