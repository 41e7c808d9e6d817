/// The MDR particle in one mode, under one step of a program: its contacts and their sums at a state, and their rates.
///
/// Lengths in R0, stresses in Y; growth = (R - R0)/R0. Source: Zunker and Kamrin (2024), stated as a continuous-time
/// model: the published time-step recipe is its first-order explicit scheme.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "contacts/wall_drive.hpp"
#include "mdr/setup.hpp"
#include "system/resolution.hpp"

namespace monograin::mdr {

/// One contact class at an instant.
struct Instant {
  double wall_displacement = 0.0;  ///< displacement of the wall, towards the initial position of the centre
  double approach = 0.0;           ///< delta_o, relative to the present centre: wall_displacement + n.x of the centre
  double overlap = 0.0;            ///< delta = approach + growth
  Contact contact;
  double rate_by_time = 0.0;    ///< rate of the approach with xi, at fixed R and centre
  double rate_by_growth = 0.0;  ///< derivative of the approach by R; 0 where the displacement is prescribed
};

/// All contacts at a state, and what they sum up to. Depends on the state, the program and the branches of the
/// contacts.
struct Evaluation {
  double growth = 0.0;   ///< (R - R0)/R0
  double longest = 1.0;  ///< largest of the lengths whose differences are overlaps: R0, path of the centre
  std::vector<Instant> contacts;
  VolumeBalance volume;
  FreeCentre centre;
  CentreVector volume_by_centre = CentreVector::Zero();  ///< derivative of the volume balance
  double power = 0.0;       ///< d(work)/dxi, less d(force times displacement) where the force is prescribed
  double force_work = 0.0;  ///< force times displacement of contacts whose force is prescribed
  /// Cached stored energy; only where both values of PlasticPart give the same.
  std::optional<double> energy{};
};

/// Rates of radius and centre with the step coordinate.
struct Motion {
  double demand = 0.0;       ///< rate with xi of the volume (over 4 pi R0^3) that growth has to take up
  double slope = 0.0;        ///< D_eff/(4 pi): derivative of the volume (over 4 pi R0^3) by the growth
  double growth_rate = 0.0;  ///< d(growth)/dxi = demand/slope; 0 while the radius is held
  CentreVector centre = CentreVector::Zero();

  /// Share of the particle's surface that is free for growth while walls under force and a free centre move so that
  /// forces balance: guard k_singular. VolumeBalance::free_surface_at_rest(), with walls and centre at rest, is that of
  /// k_covered.
  [[nodiscard]] double free_surface(double growth) const noexcept { return slope / ((1.0 + growth) * (1.0 + growth)); }
};

/// Equations that apply between two transitions.
struct Mode {
  bool is_growing = false;
  double held_growth = 0.0;                           ///< growth while the radius is held
  double frozen_balance = 0.0;                        ///< C, the volume balance while the radius grows
  CentreVector held_centre = CentreVector::Zero();    ///< position of a free centre where the mode began
  CentreMatrix unconstrained = CentreMatrix::Zero();  ///< projector on the directions in which no contact holds it
  /// Contacts that would start to unload at their largest overlap and at once load on: they stay on the loading branch.
  std::vector<bool> loads_on;
};

class Particle {
 public:
  explicit Particle(std::shared_ptr<const Setup> setup);
  /// Resets mode and branches to their state before the first step.
  void start();

  [[nodiscard]] const Setup& setup() const noexcept { return *setup_; }
  [[nodiscard]] const ContactLaw& law() const noexcept { return setup_->law; }
  [[nodiscard]] const FreeCentre& centre() const noexcept { return at_.centre; }
  [[nodiscard]] FreeCentre& centre() noexcept { return at_.centre; }
  [[nodiscard]] std::size_t size() const noexcept { return branches_.size(); }
  [[nodiscard]] double count(std::size_t i) const noexcept { return setup_->counts[i]; }

  // Program.

  void set_drives(std::span<const Ramp> ramps);
  [[nodiscard]] const contacts::WallDrive& drive(std::size_t i) const noexcept { return drives_[i]; }
  [[nodiscard]] bool is_force_controlled(std::size_t i) const noexcept { return drives_[i].is_force_controlled(); }
  /// Largest rate of a wall under displacement control; 1 where none moves.
  [[nodiscard]] double speed_scale() const noexcept;
  /// Prescribed displacement of a wall towards the initial position of the centre.
  [[nodiscard]] double prescribed_displacement(std::size_t i, double xi) const noexcept {
    // As exact as std::lerp, which takes longer than the rest of an evaluation.
    return xi == 1.0 ? drives_[i].end() : drives_[i].start() + xi * drives_[i].rate();
  }

  // Branches and mode.

  [[nodiscard]] const ContactBranch& branch(std::size_t i) const noexcept { return branches_[i]; }
  [[nodiscard]] const std::vector<ContactBranch>& branches() const noexcept { return branches_; }
  void set_branch(std::size_t i, const ContactBranch& branch);
  /// Opens a contact: its wall leaves the particle or its dent, and stays where it is.
  void lose(std::size_t i) { set_branch(i, branches_[i].lost(at_.contacts[i].approach)); }
  void set_branches(const std::vector<ContactBranch>& branches);
  [[nodiscard]] bool takes_part(std::size_t i) const noexcept {
    return mdr::takes_part(setup_->settings.radius_rule, branches_[i].regime);
  }

  Mode mode{};

  // Evaluation at a state. at() shows the last one, and is cached for its state from evaluate() or keep_trial() on,
  // until try_state() or a change of drives, branches, walls or single contacts.

  /// Evaluates all contacts at a state, and their sums, and caches the result.
  /// @throws std::domain_error where the volume of the particle is not defined
  const Evaluation& evaluate(double xi, std::span<const double> y);
  /// evaluate() for a trial state: without the check that the volume of the particle is defined, and not cached.
  const Evaluation& try_state(double xi, std::span<const double> y);
  /// Caches the result of try_state(), which has been called last and for this state.
  /// @throws std::domain_error where the volume of the particle is not defined
  void keep_trial(double xi, std::span<const double> y);
  /// The cached evaluation if it is for this state, or else evaluate().
  const Evaluation& at_state(double xi, std::span<const double> y);
  [[nodiscard]] const Evaluation& at() const noexcept { return at_; }
  [[nodiscard]] const Instant& contact(std::size_t i) const noexcept { return at_.contacts[i]; }
  /// Sum of force times displacement of the contacts whose force is prescribed. Outdates the cached evaluation.
  [[nodiscard]] double force_work(std::span<const double> y);
  /// Evaluates one contact at another approach and growth, without the sums. Outdates the cached evaluation.
  void evaluate_contact(std::size_t i, double approach, double growth);
  /// Sets the rate of a wall at fixed R, for a snap whose end is known. Outdates the cached evaluation.
  void assume_rate(std::size_t i, double rate) noexcept;
  [[nodiscard]] double energy(std::size_t i, PlasticPart part) const;
  [[nodiscard]] double energy(PlasticPart part);

  /// Rates at the state that was evaluated last.
  /// @param growing  false: the radius is held
  [[nodiscard]] Motion motion(bool growing) const;
  /// Rates while the radius grows.
  /// @throws std::domain_error where the free surface is used up
  [[nodiscard]] Motion growing_motion() const;

  /// Sum of the magnitudes of all wall forces.
  [[nodiscard]] double magnitude_of_forces() const noexcept;
  /// Largest net force on the centre that is round-off of forces that balance.
  [[nodiscard]] double force_round_off() const;

 private:
  void sum_up(double xi);
  void load_centre(std::size_t i);
  void set_rates_under_force(std::size_t i);
  /// Outdates cached results when drives, branches or walls change.
  void note_change() noexcept {
    ++revision_;
    force_round_off_.reset();
  }

  std::shared_ptr<const Setup> setup_;
  std::vector<contacts::WallDrive> drives_;
  std::vector<ContactBranch> branches_;
  std::uint64_t revision_ = 0;  ///< counts changes of all that an evaluation depends on beside the state
  Evaluation at_;
  double at_xi_ = k_nan;
  std::vector<double> at_y_;
  std::uint64_t at_revision_ = 0;
  mutable std::optional<double> force_round_off_{};  ///< cached, for the present contacts and branches
};

}  // namespace monograin::mdr
