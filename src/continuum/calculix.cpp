#include "continuum/calculix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include <Eigen/Geometry>

#include "history/external_program.hpp"
#include "scenario/text_file.hpp"

namespace monograin {
namespace {

namespace fs = std::filesystem;

/// The computation's own units: R0 and E in them.
constexpr double k_radius = 10.0;
constexpr double k_modulus = 1000.0;
/// Distance of the far end of a contact spring over R0: the spring stays normal to its wall.
constexpr double k_far = 1e4;
/// Stiffness of the contact springs over E/R0, per area: nodes enter the wall by less than 3e-4 R0 between two walls,
/// and by at most twice as much under more, where softer springs save iterations.
constexpr double k_penalty = 2000.0;
constexpr double k_penalty_of_sectors = 1000.0;
/// Height over R0 below which nodes have no spring, since they never reach the wall.
constexpr double k_least_height = 0.1;
/// Yield stress over E that stands for an elastic material.
constexpr double k_elastic_yield = 10.0;
/// CalculiX accepts a solution whose residual is below this part of the mean force; its own 5e-3 is too coarse for
/// contacts that just begin.
constexpr std::string_view k_controls =
    "*CONTROLS, PARAMETERS=TIME INCREMENTATION\n8,14,9,20,14,4,,8,,\n0.25,0.5,0.75,0.85,,,2.0,\n"
    "*CONTROLS, PARAMETERS=FIELD\n1e-5,1e-2\n";
/// Motion of the walls in the first increment of a step, over the length of an element on the surface. CalculiX divides
/// a step until few new nodes touch; to begin with a small part saves these trials, a third of the time on 80 elements.
constexpr double k_first_increment = 0.05;
/// Most increments of a step; as frequency of printing it leaves only the last one.
constexpr int k_most_increments = 1000;

std::string wall_set(std::size_t wall) { return fmt::format("WALL{}", wall); }

/// Area of the surface that each surface node carries, over R0^2, for each longitude from pole to equator.
std::vector<std::vector<double>> node_areas(const SectorMesh& mesh) {
  std::vector<std::vector<double>> areas;
  for (const auto& line : mesh.surface) areas.emplace_back(line.size(), 0.0);
  const auto node = [&](std::size_t k, std::size_t j) -> const Eigen::Vector3d& {
    return mesh.nodes[mesh.surface[k][j]];
  };
  for (std::size_t k = 0; k + 1 < areas.size(); ++k) {
    for (std::size_t j = 0; j + 1 < areas[k].size(); ++j) {
      const Eigen::Vector3d one = node(k + 1, j + 1) - node(k, j);
      const Eigen::Vector3d other = node(k + 1, j) - node(k, j + 1);
      const double quarter = 0.125 * one.cross(other).norm();
      for (const std::size_t a : {k, k + 1}) {
        for (const std::size_t b : {j, j + 1}) areas[a][b] += quarter;
      }
    }
  }
  // The pole is one node for all longitudes.
  for (std::size_t k = 1; k < areas.size(); ++k) {
    areas[0][0] += areas[k][0];
    areas[k][0] = 0.0;
  }
  return areas;
}

/// Writes the input file part by part. Node and element numbers begin at 1.
class CalculixInput {
 public:
  explicit CalculixInput(const SectorProblem& problem) : problem_(problem), mesh_(problem.mesh) {}

  std::string text() {
    add_body();
    add_material();
    const std::vector<std::vector<double>> areas = node_areas(mesh_);
    for (std::size_t i = 0; i < problem_.sector.walls.size(); ++i) add_wall(i, areas);
    add_symmetry();
    WallOverlaps last(problem_.sector.walls.size(), 0.0);
    for (const WallOverlaps& overlaps : problem_.instants) {
      add_step(last, overlaps);
      last = overlaps;
    }
    return std::move(text_);
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }
  void add_node(std::size_t number, const Eigen::Vector3d& position) {
    add("{},{:.12g},{:.12g},{:.12g}", number, position.x(), position.y(), position.z());
  }
  void add_equation(std::size_t node, int direction, std::size_t other, int other_direction, double factor) {
    add("*EQUATION\n2\n{},{},1.,{},{},{:.15g}", node + 1, direction, other + 1, other_direction, factor);
  }

  void add_body() {
    add("*NODE, NSET=BODY");
    for (std::size_t i = 0; i < mesh_.nodes.size(); ++i) add_node(i + 1, k_radius * mesh_.nodes[i]);
    add("*ELEMENT, TYPE=C3D8, ELSET=BODY");
    for (std::size_t i = 0; i < mesh_.bricks.size(); ++i) {
      std::string line = fmt::format("{}", i + 1);
      for (const std::size_t node : mesh_.bricks[i]) line += fmt::format(",{}", node + 1);
      add("{}", line);
    }
    next_node_ = mesh_.nodes.size() + 1;
    next_element_ = mesh_.bricks.size() + 1;
    add("*NSET, NSET=SURFACE");
    for (const auto& line : mesh_.surface) {
      for (const std::size_t node : line) add("{},", node + 1);
    }
  }

  void add_material() {
    const ContinuumMaterial& material = problem_.material;
    const double unit = k_modulus / material.youngs_modulus;
    add("*MATERIAL, NAME=PARTICLE\n*ELASTIC\n{:.12g},{:.12g}\n*PLASTIC", k_modulus, material.poisson_ratio);
    const double highest = k_elastic_yield * k_modulus;
    if (material.flow.empty()) add("{:.12g},0.", highest);
    for (const auto& [strain, stress] : material.flow) {
      add("{:.12g},{:.12g}", std::fmin(stress * unit, highest), strain);
    }
    add("*SOLID SECTION, ELSET=BODY, MATERIAL=PARTICLE");
  }

  /// A spring from each surface node to a node far beyond the wall, which moves with the wall. It presses once the node
  /// has come up to the wall.
  void add_wall(std::size_t index, const std::vector<std::vector<double>>& areas) {
    const int axis = problem_.sector.walls[index].axis;
    const double penalty = problem_.sector.is_axisymmetric ? k_penalty : k_penalty_of_sectors;
    add("*NODE, NSET={}", wall_set(index));
    std::string springs;
    for (std::size_t k = 0; k < areas.size(); ++k) {
      for (std::size_t j = 0; j < areas[k].size(); ++j) {
        const std::size_t node = mesh_.surface[k][j];
        const double height = mesh_.nodes[node][axis];
        if (areas[k][j] == 0.0 || height < k_least_height) continue;
        Eigen::Vector3d far_end = k_radius * mesh_.nodes[node];
        far_end[axis] = k_radius * (1.0 + k_far);
        add_node(next_node_, far_end);
        const double stiffness = penalty * k_modulus * k_radius * areas[k][j];
        const double gap = k_radius * (1.0 - height);
        springs += fmt::format(
            "*ELEMENT, TYPE=SPRINGA, ELSET=SPRING{0}\n{0},{1},{2}\n*SPRING, ELSET=SPRING{0}, NONLINEAR\n"
            "{3:.12g},{4:.12g}\n0.,{5:.12g}\n0.,{6:.6g}\n",
            next_element_, node + 1, next_node_, -stiffness * k_radius, -gap - k_radius, -gap, 100.0 * k_radius);
        ++next_node_;
        ++next_element_;
      }
    }
    text_ += springs;
  }

  void add_symmetry() {
    const std::size_t longitudes = mesh_.longitudes.size();
    const double angle = mesh_.longitudes.back();
    std::string fixed = "*BOUNDARY\n";
    const auto fix = [&fixed](std::size_t node, int first, int last) {
      fixed += fmt::format("{},{},{}\n", node + 1, first, last);
    };
    for (std::size_t k = 0; k < longitudes; ++k) {
      const std::size_t here = k * mesh_.per_longitude;
      for (const std::size_t node : mesh_.equator) fix(here + node, 3, 3);
      fix(here + mesh_.centre, 1, 3);
      for (const std::size_t node : mesh_.axis) {
        fix(here + node, 1, 2);
        if (k > 0) add_equation(here + node, 3, node, 3, -1.0);
      }
    }
    // Other nodes of the first and the last longitude stay in their plane.
    const std::size_t last = (longitudes - 1) * mesh_.per_longitude;
    for (std::size_t i = 0; i < mesh_.per_longitude; ++i) {
      if (mesh_.nodes[i].x() == 0.0) continue;
      fix(i, 2, 2);
      if (angle < 0.49 * std::numbers::pi) {
        add_equation(last + i, 2, last + i, 1, -std::tan(angle));
      } else {
        fix(last + i, 1, 1);
      }
    }
    for (std::size_t i = 0; i < problem_.sector.walls.size(); ++i) {
      for (int direction = 1; direction <= 3; ++direction) {
        if (direction == problem_.sector.walls[i].axis + 1) continue;
        fixed += fmt::format("{},{},{}\n", wall_set(i), direction, direction);
      }
    }
    text_ += fixed;
  }

  void add_step(const WallOverlaps& before, const WallOverlaps& overlaps) {
    double motion = 0.0;
    for (std::size_t i = 0; i < overlaps.size(); ++i) motion = std::fmax(motion, std::abs(overlaps[i] - before[i]));
    const double element = 0.5 * std::numbers::pi / static_cast<double>(mesh_.surface.front().size() - 1);
    const double first = motion > 0.0 ? std::fmin(k_first_increment * element / motion, 1.0) : 1.0;
    add("*STEP, NLGEOM, INC={}\n*STATIC, SOLVER=SPOOLES\n{:.6g},1.,1e-6,1.", k_most_increments, first);
    text_ += k_controls;
    add("*BOUNDARY");
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
      const int direction = problem_.sector.walls[i].axis + 1;
      add("{},{},{},{:.12g}", wall_set(i), direction, direction, -k_radius * overlaps[i]);
    }
    add("*NODE PRINT, NSET=SURFACE, FREQUENCY={}\nU", k_most_increments);
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
      add("*NODE PRINT, NSET={}, TOTALS=ONLY, FREQUENCY={}\nRF", wall_set(i), k_most_increments);
    }
    add("*END STEP");
  }

  const SectorProblem& problem_;
  const SectorMesh& mesh_;
  std::string text_;
  std::size_t next_node_ = 0;
  std::size_t next_element_ = 0;
};

/// All of a file that CalculiX has written.
std::string contents(const fs::path& file) { return read_text_file(file, std::string::npos).text; }

/// Number of instants that CalculiX has completed, from its file of increments.
std::size_t completed_steps(const fs::path& file) {
  std::ifstream in(file);
  std::size_t completed = 0;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::size_t step = 0;
    if (words >> step && step > 0) completed = step - 1;
  }
  return completed;
}

/// Last error that CalculiX has printed; its last line if it printed none.
std::string failure_in(const std::string& log) {
  std::istringstream lines(log);
  std::string line;
  std::string last;
  std::string failure;
  while (std::getline(lines, line)) {
    const std::size_t begin = line.find_first_not_of(" *");
    if (begin == std::string::npos) continue;
    last = line.substr(begin);
    const std::size_t error = line.find("*ERROR");
    if (error != std::string::npos) failure = line.substr(error + 1);
  }
  return failure.empty() ? last : failure;
}

}  // namespace

std::string calculix_input(const SectorProblem& problem) { return CalculixInput(problem).text(); }

std::vector<SectorState> read_states(const std::string& text, const SectorProblem& problem) {
  const std::vector<std::size_t> nodes = problem.mesh.surface_nodes();
  const std::size_t node_count = nodes.size();
  std::vector<std::size_t> place(problem.mesh.nodes.size(), node_count);
  for (std::size_t i = 0; i < node_count; ++i) place[nodes[i]] = i;
  std::vector<Eigen::Vector3d> undeformed;
  for (const std::size_t node : nodes) undeformed.push_back(problem.mesh.nodes[node]);
  std::vector<SectorState> states;
  SectorState state;
  bool in_displacements = false;
  bool in_total = false;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    if (line.find("displacements") != std::string::npos) {
      state = {.surface = undeformed, .forces = {}};
      in_displacements = true;
      in_total = false;
      continue;
    }
    if (line.find("total force") != std::string::npos) {
      in_displacements = false;
      in_total = true;
      continue;
    }
    std::istringstream words(line);
    Eigen::Vector3d vector;
    if (in_displacements) {
      std::size_t node = 0;
      if (!(words >> node >> vector.x() >> vector.y() >> vector.z()) || node == 0 || node > place.size()) continue;
      if (place[node - 1] == node_count) continue;
      state.surface[place[node - 1]] = problem.mesh.nodes[node - 1] + vector / k_radius;
    } else if (in_total && words >> vector.x() >> vector.y() >> vector.z()) {
      in_total = false;
      const SectorWall& wall = problem.sector.walls[state.forces.size()];
      state.forces.push_back(std::abs(vector[wall.axis]) / (k_modulus * k_radius * k_radius));
      if (state.forces.size() == problem.sector.walls.size()) states.push_back(std::move(state));
    }
  }
  return states;
}

std::string calculix_version(const fs::path& ccx, const fs::path& folder) {
  const fs::path log = folder / "version.log";
  static_cast<void>(run_program(ccx, {"-v"}, folder, log));
  const std::string text = contents(log);
  fs::remove(log);
  constexpr std::string_view k_word = "Version ";
  const std::size_t begin = text.find(k_word);
  if (begin == std::string::npos) return "CalculiX";
  const std::size_t number = begin + k_word.size();
  return "CalculiX " + text.substr(number, text.find_first_of(" \n", number) - number);
}

SectorSolution run_calculix(const SectorProblem& problem, const fs::path& ccx, const fs::path& folder,
                            const std::string& name, const std::function<void(std::size_t)>& progress) {
  write_text_file(folder / (name + ".inp"), calculix_input(problem));
  const fs::path log = folder / (name + ".log");
  const std::function<void()> meanwhile =
      progress ? [&] { progress(completed_steps(folder / (name + ".sta"))); } : std::function<void()>();
  const int code = run_program(ccx, {name}, folder, log, meanwhile);
  SectorSolution solution{.states = read_states(contents(folder / (name + ".dat")), problem), .failure = {}};
  if (solution.states.size() < problem.instants.size()) {
    const std::string reason = failure_in(contents(log));
    const std::string end = code < 0 ? fmt::format("was ended by signal {} ({})", -code, strsignal(-code))
                                     : fmt::format("ended with code {}", code);
    solution.failure = fmt::format("CalculiX {}{}{}", end, reason.empty() ? "" : "; its last words: ", reason);
  }
  return solution;
}

}  // namespace monograin
