#include "continuum/continuum.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "catalogue.hpp"
#include "continuum/calculix.hpp"
#include "continuum/contact_area.hpp"
#include "continuum/sector.hpp"
#include "continuum/sector_mesh.hpp"
#include "scenario/model_input.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Motion of a wall and change of a force between two instants that are computed.
constexpr double k_largest_motion = 0.01;        ///< over R0
constexpr double k_largest_force_change = 0.04;  ///< over the largest force of the class
/// Poisson's ratio from which on bricks of eight nodes lock.
constexpr double k_largest_poisson_ratio = 0.49;
/// Bulk modulus over the flow stress at a typical plastic strain, from which on bricks of eight nodes become too stiff.
constexpr double k_locking_ratio = 170.0;
constexpr double k_typical_strain = 0.2;
/// Motion of a wall between two computed instants, over R0, from which on the path is coarse.
constexpr double k_coarse_motion = 0.02;

/// Meshes between two walls and under more. The first only serves to state the error of the coarsest that a user may
/// ask for; the others are in the order of k_continuum_meshes.
constexpr std::array k_wedge_meshes{SectorMeshSize{24, 1, 2.5}, SectorMeshSize{40, 1, 2.5}, SectorMeshSize{80, 1, 2.5},
                                    SectorMeshSize{160, 1, 2.5}};
constexpr std::array k_sector_meshes{SectorMeshSize{16, 4, 1.0}, SectorMeshSize{24, 6, 1.0}, SectorMeshSize{32, 8, 1.0},
                                     SectorMeshSize{48, 12, 1.0}};

double sphere_volume(double radius) { return 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3); }

/// Stress of a flow curve at a plastic strain, of the last point before it.
double flow_stress(const ContinuumMaterial& material, double strain) {
  double stress = 0.0;
  for (const FlowPoint& point : material.flow) {
    if (point.plastic_strain <= strain) stress = point.stress;
  }
  return stress;
}

/// State of a contact class by finite elements [SI].
struct ClassState {
  double force = 0.0;
  double area = 0.0;

  [[nodiscard]] double radius() const { return std::sqrt(area / std::numbers::pi); }
  [[nodiscard]] double pressure() const { return force == 0.0 ? 0.0 : force / area; }
};

/// State of the particle at an instant [SI].
struct ParticleState {
  double volume = 0.0;
  std::vector<ClassState> classes{};
};

/// Largest force of each contact class.
std::vector<double> largest_forces(const Motion& motion) {
  std::vector<double> largest(motion.classes.size(), 0.0);
  for (const MotionInstant& instant : motion.instants) {
    for (std::size_t c = 0; c < largest.size(); ++c) {
      largest[c] = std::fmax(largest[c], std::abs(instant.contacts[c].force));
    }
  }
  return largest;
}

/// True if a wall moves between two instants, or its force changes, by more than two computed ones may differ.
bool are_far_apart(const Motion& motion, const std::vector<double>& largest_force, const MotionInstant& from,
                   const MotionInstant& to) {
  for (std::size_t c = 0; c < largest_force.size(); ++c) {
    const double distance = to.contacts[c].displacement - from.contacts[c].displacement;
    if (std::abs(distance) > k_largest_motion * motion.initial_radius) return true;
    const double change = std::abs(to.contacts[c].force - from.contacts[c].force);
    if (change > k_largest_force_change * largest_force[c]) return true;
  }
  return false;
}

/// True if a wall begins, stops or turns at an instant that is neither the first nor the last.
bool has_turn(const Motion& motion, std::size_t i) {
  const auto direction = [&](std::size_t from, std::size_t c) {
    const double distance =
        motion.instants[from + 1].contacts[c].displacement - motion.instants[from].contacts[c].displacement;
    return std::abs(distance) <= k_same_number * motion.initial_radius ? 0 : (distance > 0.0 ? 1 : -1);
  };
  for (std::size_t c = 0; c < motion.classes.size(); ++c) {
    if (direction(i - 1, c) != direction(i, c)) return true;
  }
  return false;
}

/// Indices of the instants that finite elements compute.
std::vector<std::size_t> chosen_instants(const Motion& motion) {
  const std::vector<double> forces = largest_forces(motion);
  std::vector<std::size_t> chosen;
  std::size_t last = 0;
  for (std::size_t i = 1; i < motion.instants.size(); ++i) {
    const bool is_end = i + 1 == motion.instants.size();
    if (!is_end && !has_turn(motion, i) &&
        !are_far_apart(motion, forces, motion.instants[last], motion.instants[i + 1])) {
      continue;
    }
    chosen.push_back(i);
    last = i;
  }
  return chosen;
}

std::vector<Column> columns_of(const Motion& motion) {
  std::vector<Column> columns{{"time", "s"}, {"volume", "m3"}, {"work", "J"}};
  for (const std::string& name : motion.classes) {
    columns.push_back({name + ".displacement", "m"});
    columns.push_back({name + ".overlap", "m"});
    columns.push_back({name + ".force", "N"});
    columns.push_back({name + ".contact_radius", "m"});
    columns.push_back({name + ".pressure", "Pa"});
  }
  return columns;
}

/// Computes the motion of a run on one mesh.
class ParticleElements {
 public:
  ParticleElements(const Motion& motion, const Sector& sector, const ContinuumMaterial& material,
                   const std::vector<std::size_t>& instants, const SectorMeshSize& size)
      : motion_(motion), problem_{.sector = sector, .mesh = {}, .material = material, .instants = {}} {
    problem_.mesh = sector_mesh(size, problem_.sector.angle);
    for (const std::size_t i : instants) {
      WallOverlaps& overlaps = problem_.instants.emplace_back();
      for (const SectorWall& wall : problem_.sector.walls) {
        overlaps.push_back(motion.overlap(motion.walls[wall.wall], motion.instants[i]) / motion.initial_radius);
      }
    }
    wall_of_class_.assign(motion.classes.size(), problem_.sector.walls.size());
    for (std::size_t w = 0; w < motion.walls.size(); ++w) {
      std::size_t& wall = wall_of_class_[motion.walls[w].contact_class];
      wall = std::min(wall, problem_.sector.sector_wall_of[w]);
    }
    std::vector<Eigen::Vector3d> nodes;
    for (const std::size_t node : problem_.mesh.surface_nodes()) nodes.push_back(problem_.mesh.nodes[node]);
    initial_volume_ = volume_below(surface_of(nodes));
  }

  [[nodiscard]] std::size_t element_count() const noexcept { return problem_.mesh.bricks.size(); }

  /// States at the instants, up to where CalculiX ends.
  std::vector<ParticleState> solve(const ElementOptions& options, const std::string& name, std::string& failure) const {
    std::function<void(std::size_t)> progress;
    if (options.progress) progress = [&](std::size_t done) { options.progress(done, problem_.instants.size()); };
    const SectorSolution solution = run_calculix(problem_, options.ccx, options.folder, name, progress);
    failure = solution.failure;
    std::vector<ParticleState> states;
    for (std::size_t i = 0; i < solution.states.size(); ++i) {
      states.push_back(state_of(solution.states[i], problem_.instants[i]));
    }
    return states;
  }

 private:
  [[nodiscard]] SectorSurface surface_of(const std::vector<Eigen::Vector3d>& nodes) const {
    return {.nodes = nodes, .longitudes = problem_.mesh.surface.size()};
  }

  [[nodiscard]] ParticleState state_of(const SectorState& sector, const WallOverlaps& overlaps) const {
    const double radius = motion_.initial_radius;
    const SectorSurface surface = surface_of(sector.surface);
    ParticleState state{.volume = sphere_volume(radius) * volume_below(surface) / initial_volume_,
                        .classes = std::vector<ClassState>(motion_.classes.size())};
    std::vector<ClassState> contacts;
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
      const SectorWall& wall = problem_.sector.walls[i];
      const double scale = wall.multiplicity * radius * radius;
      contacts.push_back({.force = scale * problem_.material.youngs_modulus * sector.forces[i],
                          .area = scale * contact_area(surface, wall.axis, 1.0 - overlaps[i])});
    }
    for (std::size_t c = 0; c < state.classes.size(); ++c) state.classes[c] = contacts[wall_of_class_[c]];
    return state;
  }

  const Motion& motion_;
  SectorProblem problem_;
  /// Wall of the sector that stands for each contact class: the first of several, which is nearest to the pole.
  std::vector<std::size_t> wall_of_class_;
  double initial_volume_ = 0.0;
};

/// History of the states after the undeformed one, and the work of the walls by the trapezoidal rule.
Table history_of(const Motion& motion, const std::vector<std::size_t>& instants, std::vector<ParticleState> states) {
  std::vector<const MotionInstant*> rows{&motion.instants.front()};
  for (const std::size_t i : instants) rows.push_back(&motion.instants[i]);
  states.insert(states.begin(), {.volume = sphere_volume(motion.initial_radius),
                                 .classes = std::vector<ClassState>(motion.classes.size())});
  Table history(columns_of(motion));
  double work = 0.0;
  for (std::size_t row = 0; row < states.size(); ++row) {
    const std::size_t before = row == 0 ? 0 : row - 1;
    for (const MovingWall& wall : motion.walls) {
      const std::size_t c = wall.contact_class;
      work += 0.5 * (states[row].classes[c].force + states[before].classes[c].force) *
              (rows[row]->contacts[c].displacement - rows[before]->contacts[c].displacement);
    }
    std::vector<double> cells{rows[row]->time, states[row].volume, work};
    for (std::size_t c = 0; c < motion.classes.size(); ++c) {
      const auto wall = std::ranges::find(motion.walls, c, &MovingWall::contact_class);
      const ClassState& contact = states[row].classes[c];
      cells.insert(cells.end(), {rows[row]->contacts[c].displacement, motion.overlap(*wall, *rows[row]), contact.force,
                                 contact.radius(), contact.pressure()});
    }
    history.append(cells);
  }
  return history;
}

/// Largest motion of a wall between computed instants, over R0.
double largest_motion(const Motion& motion, const std::vector<std::size_t>& instants) {
  double largest = 0.0;
  for (std::size_t i = 0; i < instants.size(); ++i) {
    const MotionInstant& before = motion.instants[i == 0 ? 0 : instants[i - 1]];
    for (std::size_t c = 0; c < motion.classes.size(); ++c) {
      const double distance = motion.instants[instants[i]].contacts[c].displacement - before.contacts[c].displacement;
      largest = std::fmax(largest, std::abs(distance) / motion.initial_radius);
    }
  }
  return largest;
}

/// The first contact class that moves at all; the last if none does.
std::size_t driven_class(const Motion& motion) {
  for (std::size_t c = 0; c + 1 < motion.classes.size(); ++c) {
    if (motion.moves(c)) return c;
  }
  return motion.classes.size() - 1;
}

/// True for each computed instant at which the driven class is as deep as ever before, or deeper.
std::vector<bool> loading_instants(const Motion& motion, const std::vector<std::size_t>& instants) {
  const std::size_t driven = driven_class(motion);
  std::vector<bool> loads;
  double deepest = motion.instants.front().contacts[driven].displacement;
  for (const std::size_t i : instants) {
    const double displacement = motion.instants[i].contacts[driven].displacement;
    loads.push_back(displacement >= deepest);
    deepest = std::fmax(deepest, displacement);
  }
  return loads;
}

/// Largest difference between two series at some of the instants, over the largest value of the reference; NaN if there
/// is none.
template <class Counts>
double largest_difference(const std::vector<double>& values, const std::vector<double>& reference, Counts&& counts) {
  double difference = k_nan;
  double largest = 0.0;
  for (std::size_t i = 0; i < std::min(values.size(), reference.size()); ++i) {
    largest = std::fmax(largest, std::abs(reference[i]));
    if (counts(i)) difference = std::fmax(difference, std::abs(values[i] - reference[i]));
  }
  return largest > 0.0 ? difference / largest : k_nan;
}

/// @param coarse  states on the coarser mesh; empty: no estimate of the error
/// @param ratio   length of its elements over that of the mesh
std::vector<ContinuumDifference> differences_of(const Motion& motion, const std::vector<std::size_t>& instants,
                                                const std::vector<ParticleState>& states,
                                                const std::vector<ParticleState>& coarse, double ratio) {
  const std::vector<bool> loads = loading_instants(motion, instants);
  std::vector<ContinuumDifference> list;
  const auto add = [&](const std::string& column, std::size_t c, auto&& of_law, auto&& of_elements) {
    std::vector<double> law;
    for (const std::size_t i : instants) law.push_back(of_law(motion.instants[i].contacts[c]));
    const auto series = [&](const std::vector<ParticleState>& of) {
      std::vector<double> values;
      for (const ParticleState& state : of) values.push_back(of_elements(state.classes[c]));
      return values;
    };
    const std::vector<double> elements = series(states);
    // The error falls in proportion to the length of the elements, or faster.
    const double of_mesh =
        largest_difference(series(coarse), elements, [](std::size_t) { return true; }) / (ratio - 1.0);
    list.push_back({motion.classes[c] + column,
                    largest_difference(law, elements, [&](std::size_t i) { return loads[i]; }),
                    largest_difference(law, elements, [&](std::size_t i) { return !loads[i]; }), of_mesh});
  };
  for (std::size_t c = 0; c < motion.classes.size(); ++c) {
    add(
        ".force", c, [](const ContactInstant& law) { return law.force; },
        [](const ClassState& state) { return state.force; });
    add(
        ".contact_radius", c, [](const ContactInstant& law) { return law.radius; },
        [](const ClassState& state) { return state.radius(); });
  }
  return list;
}

/// Header of the law's history, as that of finite elements.
std::vector<std::pair<std::string, std::string>> header_of(const Run& law, RunStatus status,
                                                           const RunElements& elements) {
  std::vector<std::pair<std::string, std::string>> header;
  for (const auto& [key, value] : law.record.history.header) {
    if (key == "rtol" || key == "atol" || key == "reference") continue;
    header.emplace_back(key, value);
    if (key == "status") header.back().second = to_string(status);
    if (key == "model") header.back().second = "continuum";
    if (key == "integrator") {
      header.back().second = fmt::format("{}, mesh {}, {} elements", elements.solver, elements.mesh, elements.count);
    }
  }
  return header;
}

}  // namespace

ContinuumMaterial continuum_material_of(const CheckedScenario& scenario) {
  const Model& model = *find_model(scenario.model);
  if (model.continuum_material == nullptr) {
    const auto names = names_of_models([](const Model& other) { return other.continuum_material != nullptr; });
    throw std::invalid_argument(fmt::format("model {} has no material for finite elements; expected one of {}",
                                            scenario.model, fmt::join(names, ", ")));
  }
  ContinuumMaterial material = model.continuum_material(model_input(scenario));
  const double poisson_ratio = material.poisson_ratio;
  if (poisson_ratio > k_largest_poisson_ratio) {
    throw std::invalid_argument(
        fmt::format("finite elements of this kind lock for material.poisson_ratio = {:g}; expected at most {:g}",
                    poisson_ratio, k_largest_poisson_ratio));
  }
  if (!material.flow.empty()) {
    const double bulk_modulus = material.youngs_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio));
    const double ratio = bulk_modulus / flow_stress(material, k_typical_strain);
    if (ratio > k_locking_ratio) {
      material.differences.push_back(
          fmt::format("the bulk modulus is {:.0f} times the flow stress: bricks of eight nodes are then too stiff, for "
                      "1700 times by up to 10 % in force and 40 % in pressure",
                      ratio));
    }
  }
  return material;
}

Run run_continuum(const Run& law, const ElementOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const ContinuumMaterial material = continuum_material_of(law.scenario);
  const auto mesh = std::ranges::find(k_continuum_meshes, options.mesh);
  if (mesh == k_continuum_meshes.end()) {
    throw std::invalid_argument(
        fmt::format("mesh = '{}': expected one of {}", options.mesh, fmt::join(k_continuum_meshes, ", ")));
  }
  if (law.elements) throw std::invalid_argument("the run is of finite elements; expected the run of a law");
  const Motion motion = motion_of(law.scenario, law.record.history);
  const std::vector<std::size_t> instants = chosen_instants(motion);
  if (instants.empty()) throw std::invalid_argument("the run of the law ended where it began: " + law.record.message);
  const Sector sector = sector_of(motion);
  const auto& meshes = sector.is_axisymmetric ? k_wedge_meshes : k_sector_meshes;
  const auto asked = static_cast<std::size_t>(mesh - k_continuum_meshes.begin());
  const SectorMeshSize& coarse_size = meshes.at(asked);
  const SectorMeshSize& size = meshes.at(asked + 1);
  Run result{.scenario = law.scenario,
             .record = {},
             .integrator = {},
             .classes = law.classes,
             .skipped = {},
             .sensitivities = {},
             .timings = {}};
  RunElements& summary = result.elements.emplace();
  summary.mesh = options.mesh;
  summary.solver = calculix_version(options.ccx, options.folder);
  result.integrator.used = summary.solver;
  RunRecord& record = result.record;
  record.warnings = material.differences;
  if (const double apart = largest_motion(motion, instants); apart > k_coarse_motion) {
    record.warnings.push_back(
        fmt::format("rows of the run are up to {:.2g} R0 apart, and the walls move straight between "
                    "them; a larger output.points makes the path exact",
                    apart));
  }

  const ParticleElements elements(motion, sector, material, instants, size);
  summary.count = elements.element_count();
  std::string failure;
  const std::vector<ParticleState> states = elements.solve(options, "continuum", failure);
  record.status = failure.empty() ? law.record.status : RunStatus::failed;
  record.message = failure.empty() ? law.record.message : failure;
  if (failure.empty()) record.limit = law.record.limit;
  std::vector<ParticleState> coarse;
  if (options.estimates_error && failure.empty()) {
    const ParticleElements coarser(motion, sector, material, instants, coarse_size);
    coarse = coarser.solve(options, "coarser", failure);
    if (!failure.empty()) record.warnings.push_back("the coarser mesh: " + failure);
  }
  summary.differences =
      differences_of(motion, instants, states, coarse, static_cast<double>(size.meridian) / coarse_size.meridian);
  record.history = history_of(motion, instants, states);
  record.history.header = header_of(law, record.status, summary);
  record.events = Table(law.record.events.columns());
  record.events.header = record.history.header;
  result.timings.integration = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace monograin
