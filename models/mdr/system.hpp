/// The MDR particle between rigid walls as a hybrid system.
///
/// Unknowns: r = (R - R0)/R0, the work of the walls, with a free centre its displacement along the directions in which
/// the walls can move it, and the displacement of every wall whose force is prescribed at some time. Where a force is
/// prescribed, the work is counted less force times displacement, -int delta_o dF: unlike int F d(delta_o) it has no
/// singularity where a contact is made or snaps off. Lengths in R0; stresses in the yield stress (in E* where nothing
/// yields). Source: 002_000df8fc37500451.txt, stated as a continuous-time model: the published time-step recipe is its
/// first-order explicit scheme. While the radius grows, the explicit form is the rate that keeps the volume balance
///   V_geo,Q(R, delta_o) - V_Q(R, delta_o) = C
/// and the implicit and direct forms are the balance itself, with C frozen at every transition.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "mdr/contact_branch.hpp"
#include "system/hybrid_system.hpp"
#include "system/undefined.hpp"

namespace monograin::mdr {

/// Which contacts make the apparent radius grow, and when.
enum class RadiusRule {
  gated,    ///< all touching contacts; only while a contact at its largest overlap is driven inwards
  yielded,  ///< yielded contacts at their largest overlap; only while one of them is driven inwards
  seed,     ///< all touching contacts; always (eq. 37 to the letter)
  fixed     ///< R = R0 for ever (model hertz)
};

struct Settings {
  double initial_radius = 0.0;                                    ///< R0 [m], > 0
  double youngs_modulus = 0.0;                                    ///< E [Pa], > 0
  double poisson_ratio = 0.0;                                     ///< in (-1, 0.5]
  double yield_stress = std::numeric_limits<double>::infinity();  ///< Y [Pa], > 0; infinity: elastic throughout
  double surface_energy = 0.0;                                    ///< dg of the particle-wall contact [J/m2], >= 0
  ElasticProfile elastic_profile = ElasticProfile::ellipse;
  RadiusRule radius_rule = RadiusRule::yielded;
  DeltaMaxRule delta_max_rule = DeltaMaxRule::running_maximum;
  std::shared_ptr<const PressureCurve> pressure_curve{};  ///< p_Y/Y over delta/R; null: the source's exponential
  bool stops_at_cap_intersection = false;
  bool centre_is_free = false;  ///< the centre moves so that the wall forces balance
  /// Largest displacement [m] and force [N] the program asks of a wall: how large the unknowns become, which absolute
  /// tolerances are relative to. 0: not said.
  double largest_displacement = 0.0;
  double largest_force = 0.0;
};

class System final : public HybridSystem {
 public:
  System(const Settings& settings, std::vector<ContactClass> classes);

  [[nodiscard]] std::span<const Unknown> unknowns() const noexcept override { return unknowns_; }
  [[nodiscard]] std::span<const ContactClass> classes() const noexcept override { return classes_; }
  void start(std::span<double> y) override;
  void begin_step(std::span<const Ramp> ramps, std::span<double> y, std::vector<Event>& log) override;
  [[nodiscard]] std::function<void()> checkpoint() override {
    return [this, then = *this] { *this = then; };
  }
  void complete(double xi, std::span<double> y) override;
  void rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void all_rates(double xi, std::span<const double> y, std::span<double> dy) override;
  void residual(double xi, std::span<const double> y, std::span<const double> dy, std::span<double> res) override;
  void solve(double xi, std::span<double> y) override;
  [[nodiscard]] std::optional<double> closed_quadrature(double xi, std::span<const double> y) override;
  [[nodiscard]] std::span<const Guard> guards() const noexcept override { return guards_; }
  void guard_values(double xi, std::span<const double> y, std::span<double> values) override;
  std::optional<DomainEnd> fire(std::span<const std::size_t> fired, double xi, std::span<double> y,
                                std::vector<Event>& log) override;
  [[nodiscard]] std::span<const Observable> observables() const noexcept override { return observables_; }
  void observe(double xi, std::span<const double> y, std::span<double> values) override;
  [[nodiscard]] double quantity(Quantity quantity, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] double controlled(Control control, int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<SurfacePoint> surface(int contact_class, double xi, std::span<const double> y) override;
  [[nodiscard]] bool is_open(int contact_class) const noexcept override;
  [[nodiscard]] bool contacts_adhere() const noexcept override { return adheres(); }
  [[nodiscard]] std::optional<Difficulty> difficulty(double xi, std::span<const double> y) override;
  [[nodiscard]] std::vector<Diagnostic> warnings() const override;

  /// Volume balance V_geo,Q - V_Q - C over 4 pi R0^3, the drift of an integrated solution; 0 while the radius is held.
  [[nodiscard]] double balance_residual(double xi, std::span<const double> y);

 private:
  // Places of the unknowns in y.
  static constexpr std::size_t k_radius = 0;
  static constexpr std::size_t k_work = 1;
  static constexpr std::size_t k_centre = 2;
  [[nodiscard]] static constexpr std::size_t centre_place(int k) noexcept {
    return k_centre + static_cast<std::size_t>(k);
  }
  /// Smallest mean normal of a contact class, along the free directions of the centre, that counts. The stiffness along
  /// them goes with its square, and is round-off below this.
  static constexpr double k_no_direction = 1e-6;
  /// Firmness by which contacts hold a free centre so little that they are at a fold: a search for the balance of
  /// forces ends there with a force that is least, and not zero, and rates of the centre change sign through infinity.
  static constexpr double k_at_fold = 1e-2;
  /// Firmness below which a fold is so near that errors are magnified.
  static constexpr double k_soft_centre = 0.1;
  /// Share of the forces on a free centre that is rounding in their balance.
  static constexpr double k_no_force = 1e-9;
  /// Vectors and matrices along the free directions of the centre; entries beyond their number are zero.
  using Small = Eigen::Vector3d;
  using SmallMatrix = Eigen::Matrix3d;

  /// One contact class at an instant.
  struct Instant {
    double displacement = 0.0;  ///< of the wall relative to the centre, wherever that is, over R0
    double position = 0.0;      ///< of the wall itself, towards the place where the centre started, over R0
    double overlap = 0.0;
    Contact contact;
    double rate_by_time = 0.0;    ///< of the displacement, at fixed R and centre, with xi
    double rate_by_growth = 0.0;  ///< and with R, where the force is prescribed
  };

  /// Sums over the contacts at an instant; the volume balance is divided by 4 pi R0^3.
  struct Sums {
    double relative_compression = 0.0;  ///< w of all contacts: 1 - 4w > 0 while the volume is defined
    double under_root = 0.0;            ///< 1 - 4w of those in Q
    double balance = 0.0;               ///< V_geo,Q - V_Q
    double by_radius = 0.0;             ///< its partial derivatives, walls under force moving as that asks for
    double by_radius_at_rest = 0.0;     ///< by_radius where every wall stands still
    double by_time = 0.0;
    Small by_centre = Small::Zero();
    double power = 0.0;           ///< d(work)/dxi, less d(force times displacement) where the force is prescribed
    double force_work = 0.0;      ///< force times displacement of those contacts
    Small force = Small::Zero();  ///< net force along the free directions, and its derivative by the centre
    SmallMatrix stiffness = SmallMatrix::Zero();
    double time_scale = 0.0;  ///< sum of the magnitudes in by_time
    /// Stored energy where no part of it is open to question, once it has been asked for.
    std::optional<double> energy{};
  };

  /// Walls that face each other, or the same way, push a free centre along one line. What they do is summed up there
  /// before it is resolved: the rounding of large forces that nearly cancel would otherwise act across the line, where
  /// a soft contact may be all that holds the centre.
  struct Line {
    Small direction = Small::Zero();
    double force = 0.0;  ///< net force, and its partial derivatives
    double force_by_time = 0.0;
    double force_by_radius = 0.0;
    double stiffness = 0.0;
    double tangent_stiffness = 0.0;
    double last_stiffness = 0.0;  ///< of the last step towards the balance
    double held = 0.0;            ///< work space: tangent stiffness of the centre along the line; and
    double unsoftened = 0.0;      ///< what it would be if no edge peeled and no contact were softened past its peak
  };

  /// Mean normal of a class as a multiple of the direction of a line.
  struct OnLine {
    std::size_t line = 0;
    double along = 0.0;
  };

  struct Motion {
    double demand = 0.0;           ///< rate of volume that wants to become growth
    double slope = 0.0;            ///< D_eff/(4 pi): growth rate = demand/slope
    double growth = 0.0;           ///< dr/dxi
    Small centre = Small::Zero();  ///< velocity of the centre
  };

  /// Tangent stiffness of a free centre in its softest direction, over what it would be if no edge peeled and no
  /// contact were softened past its peak.
  struct CentreStiffness {
    double value = 0.0;
    Small direction = Small::Zero();
  };

  /// A wall that can only drive a free centre out of its way.
  struct Drive {
    std::size_t contact = 0;
    double rate = 0.0;  ///< of its overlap, where none of them does
  };

  struct CapPair {
    int first = 0;
    int second = 0;
    double half_sine = 0.0;  ///< sine of half the smallest angle between two of their normals
    bool have_met = false;   ///< and not parted since
  };

  /// Whether a contact takes part in the growth of the apparent radius.
  [[nodiscard]] bool is_member(const ContactBranch& memory) const noexcept {
    switch (settings_.radius_rule) {
      case RadiusRule::gated:
      case RadiusRule::seed:
        return touches(memory.regime);
      case RadiusRule::yielded:
        return memory.regime == Regime::fully_plastic;
      case RadiusRule::fixed:
        return false;
    }
    return false;
  }
  [[nodiscard]] double inward_rate(std::size_t i, const Motion& motion) const noexcept;
  [[nodiscard]] double prescribed_force(std::size_t i, double xi) const noexcept;
  void set_rates_under_force(std::size_t i, double r);
  [[nodiscard]] double prescribed_position(std::size_t i, double xi) const noexcept;
  [[nodiscard]] double carried_by_centre(std::size_t i, std::span<const double> y) const noexcept;
  void place(double xi, std::span<double> y);
  void move_walls(double xi, std::span<double> y);
  void note_walls(double xi, std::span<double> y) const noexcept;

  void evaluate(double xi, std::span<const double> y);
  void evaluate_forces(double xi, std::span<const double> y);
  void keep_evaluation(double xi, std::span<const double> y);
  void evaluate_cached(double xi, std::span<const double> y);
  void drop_evaluation() noexcept { seen_xi_ = k_nan; }
  [[nodiscard]] Contact visible_contact(std::size_t i) const;
  void evaluate_contact(std::size_t i, double displacement, double r);
  [[nodiscard]] double force_work(std::span<const double> y);
  void sum_up(double xi, double r);
  void push_line(std::size_t i, double r);
  void find_lines();
  [[nodiscard]] SmallMatrix stiffest_directions(double Line::*stiffness) const;
  [[nodiscard]] static Small components(const SmallMatrix& basis, const Line& line);
  [[nodiscard]] Small balance_step(double Line::*stiffness, double Line::*force) const;
  [[nodiscard]] Motion motion(bool growing) const;
  [[nodiscard]] Motion growing_motion() const;
  /// Share of the particle's surface that growth has for itself while the program moves the walls.
  [[nodiscard]] static double free_surface(const Motion& motion, double r) noexcept {
    return motion.slope / ((1.0 + r) * (1.0 + r));
  }
  /// Share of the particle's surface that growth has for itself between walls that stand still, whatever prescribes
  /// where they do: the model ends where it is used up, under every control.
  [[nodiscard]] double free_surface_at_rest(double r) const noexcept {
    return sums_.by_radius_at_rest / ((1.0 + r) * (1.0 + r));
  }
  /// True for a plastic contact under a prescribed force: at a given radius it bears no more than a largest one.
  [[nodiscard]] bool has_greatest_force(std::size_t i) const noexcept {
    return is_loaded(i) && branches_[i].regime == Regime::fully_plastic;
  }
  /// Stiffness of a contact over that of a shallow plastic one.
  [[nodiscard]] double stiffness_left(std::size_t i) const noexcept {
    return now_[i].contact.by_overlap / law_.plastic_stiffness();
  }
  [[nodiscard]] double magnitude_of_forces() const noexcept;
  [[nodiscard]] double rounding_of_forces() const noexcept;
  [[nodiscard]] double shallow() const noexcept;
  [[nodiscard]] bool is_shallow(double overlap) const noexcept;
  [[nodiscard]] std::optional<std::size_t> contact_beyond_pull_off(double r);
  void move_centre(double xi, std::span<double> y);
  void find_balance(double xi, std::span<double> y);
  void check_hold() const;
  bool leave_saddle(double xi, std::span<double> y, bool is_balanced);
  bool approach_balance(double xi, std::span<double> y);
  void grow(double xi, std::span<double> y);

  // Modes (modes.cpp) and transitions (transitions.cpp).
  void resolve_mode(double xi, std::span<double> y, std::optional<bool> growth, std::vector<Event>& log,
                    bool has_jumped = false);
  void balance_anew(double xi, std::span<double> y, std::vector<Event>& log, std::vector<Event>& made);
  [[noreturn]] void throw_unsettled();
  /// After which a mode is taken to have none that agrees with it.
  [[nodiscard]] std::size_t most_rounds() const noexcept { return 4 * branches_.size() + 8; }
  [[nodiscard]] bool wants_growth(double xi, std::span<double> y);
  [[nodiscard]] double growth_drive(const Motion& now) const noexcept;
  [[nodiscard]] SmallMatrix unheld_directions();
  void hold_centre(std::span<const double> y);
  bool resolve_contact(std::size_t i, double xi, std::span<double> y, const Motion& now, std::vector<Event>& log,
                       std::vector<Event>& made);
  bool resolve_edge(std::size_t i, double xi, std::span<double> y, const Motion& now, bool is_carried,
                    std::vector<Event>& log);
  [[nodiscard]] bool gate_is_open(const Motion& now) const noexcept;
  [[nodiscard]] double speed_scale() const noexcept;
  [[nodiscard]] double wall_rate(std::size_t i, const Motion& now) const noexcept;
  [[nodiscard]] double overlap_rate(std::size_t i, const Motion& now) const noexcept;
  [[nodiscard]] double primary_branch_rate(std::size_t i, const Motion& now) const noexcept;
  [[nodiscard]] double rate_if_turned(std::size_t i, double xi, std::span<const double> y);
  [[nodiscard]] double edge_rate(std::size_t i, double r, const Motion& now);
  [[nodiscard]] double loaded_rate(double loading, double by_radius, double growth) const noexcept;
  [[nodiscard]] bool is_supported(std::size_t i, double side = 1.0);
  [[nodiscard]] bool leave_behind(double xi, std::span<const double> y, std::vector<Event>& log);
  [[nodiscard]] bool leave_what_is_not_pressed(std::span<const Drive> drives, double xi, std::vector<Event>& log);
  [[nodiscard]] bool touches_have_to_bear(double xi) const;
  [[nodiscard]] Small prescribed_push(double xi) const noexcept;
  [[nodiscard]] double largest_prescribed_force() const noexcept;
  [[nodiscard]] double largest_force(std::size_t contact) const noexcept;
  void find_slight_forces();
  [[nodiscard]] bool is_slight(std::size_t contact);
  [[nodiscard]] std::optional<Small> velocity_of(std::span<Drive> drives, double xi, std::span<const double> y);
  bool drive_out(std::span<const Drive> drives, const SmallMatrix& along, Small& velocity) const;
  [[nodiscard]] bool is_idle_contact(std::size_t i) const;
  void check_support();
  void start_unloading(std::size_t i, double r, std::string_view why, std::vector<Event>& log);
  void stick(std::size_t i, std::vector<Event>& log);
  [[nodiscard]] std::optional<std::size_t> weakest_contact() const noexcept;
  [[nodiscard]] bool is_any_softened() const noexcept;
  [[nodiscard]] CentreStiffness centre_stiffness();
  [[nodiscard]] double round_off_of(const CentreStiffness& softest, double r);
  [[nodiscard]] double centre_stiffness_guard(double r);
  [[nodiscard]] double least_centre_stiffness() { return centre_stiffness().value; }
  void check_adhesion(std::size_t i, double r);
  void start_peeling(std::size_t i, double r, std::span<double> y, std::vector<Event>& log);
  void separate(std::size_t i, double r, std::span<double> y, std::vector<Event>& log);
  [[nodiscard]] double nearness_of_yield(std::size_t i) const noexcept;
  void meet_balanced(std::size_t i, bool is_made, double r, std::vector<Event>& log);
  [[nodiscard]] double way_to_touch(std::size_t i, double r);
  [[nodiscard]] bool may_be_backed(std::size_t i, double r);
  void arm_guards(double xi, std::span<const double> y);
  [[nodiscard]] bool goes_one_way(double r, const Motion& now) const;
  void arm_contact_guards(std::size_t i, double r, const Motion& now);
  [[nodiscard]] double force_rate(std::size_t i, const Motion& now) const noexcept;
  [[nodiscard]] bool is_extremum(int kind, std::size_t i, const Motion& now) const noexcept;
  void watch_tension(std::size_t i, const Motion& now, bool may_go_out, bool may_turn);
  void watch_edge(std::size_t i, double r, bool may_come_in, bool may_go_out, bool may_turn);
  [[nodiscard]] double contact_guard(int kind, std::size_t i, double xi, double overlap, double r);
  [[nodiscard]] double edge_guard(int kind, std::size_t i, double xi, double overlap, double r);
  [[nodiscard]] double rounding_of_edge(std::size_t i, double r);
  std::optional<DomainEnd> meet_caps(CapPair& pair, double r, std::vector<Event>& log);
  [[nodiscard]] std::optional<DomainEnd> meet_caps_at_once(double xi, std::span<const double> y,
                                                           std::vector<Event>& log);
  [[nodiscard]] static DomainEnd centre_reached(int contact_class);
  [[nodiscard]] std::optional<DomainEnd> reach_centre_at_once(double xi, std::span<const double> y);
  [[nodiscard]] double cap_guard(const CapPair& pair, double r) const;

  [[nodiscard]] double energy(double r, PlasticPart plastic_part);
  [[nodiscard]] bool adheres() const noexcept { return law_.adheres(); }
  [[nodiscard]] bool is_loaded(std::size_t i) const noexcept { return ramps_[i].control == Control::force; }
  [[nodiscard]] double largest_overlap_expected() const;
  [[nodiscard]] double growth_scale(double displacement) const noexcept;
  [[nodiscard]] double work_scale(double displacement) const noexcept;

  Settings settings_;
  ContactLaw law_;  ///< stresses over the stress unit, lengths over R0
  double stress_unit_ = 1.0;
  std::vector<ContactClass> classes_;
  std::vector<double> counts_;  ///< walls of each class
  std::vector<Unknown> unknowns_;
  std::vector<Observable> observables_;
  std::vector<Small> directions_;  ///< mean normal of each class along the free directions of the centre
  std::vector<Line> lines_;        ///< in which they lie
  std::vector<OnLine> on_lines_;   ///< where each class is
  bool takes_forces_ = false;      ///< whether any class ever does
  int free_count_ = 0;             ///< free directions of the centre, 0 to 3
  Eigen::Matrix3d free_directions_ = Eigen::Matrix3d::Zero();  ///< their orthonormal basis, in the first columns
  std::vector<CapPair> cap_pairs_;
  std::vector<std::size_t> wall_places_;  ///< in y, of the displacement of each class that takes a force; else 0

  std::vector<Ramp> ramps_;  ///< displacements over R0, forces over the stress unit and R0^2
  bool has_begun_ = false;
  std::vector<ContactBranch> branches_;
  bool is_growing_ = false;
  double held_radius_ = 0.0;                  ///< r while it is held
  double frozen_balance_ = 0.0;               ///< C while it grows
  Small held_centre_ = Small::Zero();         ///< of a free centre, where the present mode began
  SmallMatrix unheld_ = SmallMatrix::Zero();  ///< projector on the directions in which nothing holds it
  std::vector<bool> bears_;                   ///< whether a contact can be anything but a touch in the present mode
  std::vector<bool> may_be_slight_;           ///< a force within the step that is rounding beside the others
  std::vector<Guard> guards_;

  // Work space, so that nothing is allocated while integrating.
  std::vector<double> trial_;
  std::vector<Instant> now_;
  std::vector<Small> backing_;  ///< directions of what may back a contact
  double longest_ = 1.0;        ///< of the lengths, over R0, that overlaps are differences of
  double seen_xi_ = k_nan;      ///< where evaluate() was last
  std::vector<double> seen_;
  double evaluated_radius_ = 0.0;  ///< r where the forces were evaluated last
  std::vector<Edge> edges_before_;
  std::vector<bool> has_turned_;   ///< started to unload at the instant at which a mode is decided
  std::vector<bool> has_resumed_;  ///< and gone on beyond its largest overlap at that instant
  std::vector<bool> goes_on_;      ///< taken to do so from the first, because no mode agrees otherwise
  std::vector<bool> is_left_;      ///< left, at that instant, by a centre that forces press elsewhere
  std::vector<double> overlaps_before_;
  std::vector<ContactBranch> branches_before_;
  Sums sums_;
  std::optional<Diagnostic> validity_;  ///< of the first adhesive contact to unload for which the model is not valid
  bool caps_have_met_ = false;
  double radius_at_caps_ = 0.0;
};

}  // namespace monograin::mdr
