#include "exchange/lammps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "catalogue.hpp"
#include "scenario/model_input.hpp"
#include "system/lammps_law.hpp"
#include "system/resolution.hpp"

namespace monograin {
namespace {

/// Largest deviation of the walls from the run, over R0.
constexpr double k_deviation = 1e-7;
/// Largest motion of a wall in one step, over R0. Steps of 1e-3 R0 make errors of a few per cent while an mdr contact
/// unloads.
constexpr double k_largest_step = 1e-5;
/// Steps between two rows of the CSV file. Every piece has a multiple of it, so that its end is a row.
constexpr long k_steps_per_row = 100;
/// Density [kg/m3]. The particle does not move, so that no result depends on it.
constexpr double k_density = 1000.0;

constexpr std::array k_axes{'x', 'y', 'z'};

/// Name in letters, digits and underscores, as LAMMPS takes it: `axial-z+` becomes `axial_zp`.
std::string plain_name(std::string_view name) {
  std::string plain;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool is_last = i + 1 == name.size();
    if (std::isalnum(static_cast<unsigned char>(name[i])) != 0) {
      plain += name[i];
    } else if (is_last && (name[i] == '+' || name[i] == '-')) {
      plain += name[i] == '+' ? 'p' : 'm';
    } else {
      plain += '_';
    }
  }
  return plain;
}

/// Text for a comment. LAMMPS joins lines at an ampersand and at quotes, also in comments.
std::string comment_text(std::string text) {
  for (char& c : text) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0 || c == '&' || c == '"') c = ' ';
  }
  return text;
}

/// Plain names that differ from each other.
std::vector<std::string> plain_names(const std::vector<std::string>& names) {
  std::vector<std::string> plain;
  for (const std::string& name : names) {
    std::string candidate = plain_name(name);
    while (std::ranges::find(plain, candidate) != plain.end()) candidate += '_';
    plain.push_back(std::move(candidate));
  }
  return plain;
}

/// Writes the input file part by part.
class LammpsInput {
 public:
  LammpsInput(const CheckedScenario& scenario, const Motion& motion, const LammpsLaw& law)
      : scenario_(scenario), motion_(motion), law_(law), classes_(plain_names(motion.classes)) {
    std::vector<std::string> names;
    for (const MovingWall& wall : motion.walls) names.push_back("wall_" + wall.name);
    walls_ = plain_names(names);
    for (const std::string& name : classes_) variables_.push_back("d_" + name);
    if (!scenario.loading.centre_is_free) return;
    for (const char axis : k_axes) variables_.push_back(fmt::format("centre_{}", axis));
  }

  std::string text() {
    head();
    particle();
    for (std::size_t i = 0; i < walls_.size(); ++i) wall(i);
    output();
    pieces();
    return std::move(text_);
  }

 private:
  template <class... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...) + '\n';
  }

  void head() {
    constexpr std::array k_shown{"program", "title", "scenario", "scenario_digest", "status", "model"};
    for (const auto& [key, value] : motion_.header) {
      if (std::ranges::find(k_shown, key) != k_shown.end()) line("# {}: {}", key, comment_text(value));
    }
    line("# A test in LAMMPS with its package GRANULAR, without friction and damping.");
    line("# The particle does not move. The time step has no meaning: a step moves no wall by more than {} R0.",
         k_largest_step);
    if (scenario_.loading.centre_is_free) line("# The centre is free: walls move as seen from the centre.");
    for (const std::string& difference : law_.differences) line("# {}", difference);
  }

  void particle() {
    const double half = 4.0 * scenario_.radius;
    line("\nunits si\natom_style sphere 1\natom_modify map array\ncomm_modify vel yes\nnewton off\nboundary f f f");
    line("region box block {0} {1} {0} {1} {0} {1}", -half, half);
    line("create_box 1 box\ncreate_atoms 1 single 0 0 0");
    line("set group all diameter {} density {}", 2.0 * scenario_.radius, k_density);
    line("neighbor {} bin\ntimestep 1\n", 0.2 * scenario_.radius);
    line("# contact of two particles of the material");
    line("pair_style granular\npair_coeff * * {}\n", law_.pair);
    line("# displacement of the walls of each contact class, inward [m]");
    const std::vector<double> start = positions(motion_.instants.front());
    for (std::size_t i = 0; i < variables_.size(); ++i) line("variable {} equal {}", variables_[i], start[i]);
  }

  void wall(std::size_t index) {
    const MovingWall& wall = motion_.walls[index];
    const std::string& name = walls_[index];
    // Differences from zero, which give 0 where a change of sign gives -0.
    const Eigen::Vector3d inward = Eigen::Vector3d::Zero() - wall.normal;
    const Eigen::Vector3d at = Eigen::Vector3d::Zero() - scenario_.radius * inward;
    std::array<std::string, 3> motion;
    line("");
    for (std::size_t k = 0; k < k_axes.size(); ++k) {
      const double component = inward[static_cast<Eigen::Index>(k)];
      const std::string by_class =
          component == 0.0 ? "" : fmt::format("{}*v_{}", component, variables_[wall.contact_class]);
      const std::string by_centre = scenario_.loading.centre_is_free ? fmt::format("-v_centre_{}", k_axes[k]) : "";
      motion[k] = "NULL";
      if (by_class.empty() && by_centre.empty()) continue;
      line("variable m_{}_{} equal {}{}", name, k_axes[k], by_class, by_centre);
      motion[k] = fmt::format("v_m_{}_{}", name, k_axes[k]);
    }
    line("region {} plane {} {} {} {} {} {} side in move {}", name, at.x(), at.y(), at.z(), inward.x(), inward.y(),
         inward.z(), fmt::join(motion, " "));
    line("fix {0} all wall/gran/region granular {1} region {0} contacts", name, law_.wall);
  }

  /// Writes displacement and force of the first wall of each class to the CSV file.
  void output() {
    std::vector<std::string> headings;
    std::vector<std::string> values;
    line("\n# force of one wall of each contact class, positive in compression [N]");
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      const auto first = std::ranges::find(motion_.walls, i, &MovingWall::contact_class);
      const std::string& name = walls_[static_cast<std::size_t>(first - motion_.walls.begin())];
      const Eigen::Vector3d inward = Eigen::Vector3d::Zero() - first->normal;
      line("compute {0} all reduce sum f_{0}[2] f_{0}[3] f_{0}[4]", name);
      line("variable F_{0} equal {2}*c_{1}[1]+{3}*c_{1}[2]+{4}*c_{1}[3]", classes_[i], name, inward.x(), inward.y(),
           inward.z());
      headings.push_back(fmt::format("{0}.displacement[m],{0}.force[N]", motion_.classes[i]));
      values.push_back(fmt::format("$(v_d_{0}:%.15g),$(v_F_{0}:%.15g)", classes_[i]));
    }
    line("fix rows all print {} \"{}\" file {}.lammps.csv title \"{}\" screen no", k_steps_per_row,
         fmt::join(values, ","), plain_name(scenario_.name), fmt::join(headings, ","));
    line("thermo 0");
  }

  /// One run for each piece in which all walls move at constant velocity.
  void pieces() {
    std::vector<std::vector<double>> path;
    for (const MotionInstant& instant : motion_.instants) path.push_back(positions(instant));
    for (std::size_t begin = 0; begin + 1 < path.size();) {
      const std::size_t end = end_of_piece(path, begin);
      piece(path[begin], path[end]);
      begin = end;
    }
    if (!has_run_) line("\nrun 0");
  }

  /// Last instant to which a motion at constant velocity deviates by no more than k_deviation from the run. Each
  /// instant bounds the velocities of all later ones.
  [[nodiscard]] std::size_t end_of_piece(const std::vector<std::vector<double>>& path, std::size_t begin) const {
    std::vector<double> least(variables_.size(), -k_infinity);
    std::vector<double> most(variables_.size(), k_infinity);
    for (std::size_t end = begin + 1; end < path.size(); ++end) {
      const double duration = motion_.instants[end].time - motion_.instants[begin].time;
      const double slack = k_deviation * scenario_.radius / duration;
      for (std::size_t k = 0; k < variables_.size(); ++k) {
        const double velocity = (path[end][k] - path[begin][k]) / duration;
        if (velocity < least[k] || velocity > most[k]) return end - 1;
        least[k] = std::max(least[k], velocity - slack);
        most[k] = std::min(most[k], velocity + slack);
      }
    }
    return path.size() - 1;
  }

  void piece(const std::vector<double>& from, const std::vector<double>& to) {
    double largest = 0.0;
    for (std::size_t k = 0; k < from.size(); ++k) largest = std::max(largest, std::abs(to[k] - from[k]));
    const double row = k_largest_step * static_cast<double>(k_steps_per_row) * scenario_.radius;
    const long steps = k_steps_per_row * static_cast<long>(std::ceil((1.0 - k_same_number) * largest / row));
    if (steps == 0) return;
    line("");
    for (std::size_t k = 0; k < from.size(); ++k) {
      const double change = to[k] - from[k];
      const std::string moving = change == 0.0 ? "" : fmt::format("{:+}*elapsed/{}", change, steps);
      line("variable {} equal {}{}", variables_[k], from[k], moving);
    }
    line("run {}", steps);
    has_run_ = true;
  }

  /// Values of the variables at an instant.
  [[nodiscard]] std::vector<double> positions(const MotionInstant& instant) const {
    std::vector<double> values;
    for (const ContactInstant& contact : instant.contacts) values.push_back(contact.displacement);
    if (scenario_.loading.centre_is_free) {
      values.insert(values.end(), instant.centre.begin(), instant.centre.end());
    }
    return values;
  }

  const CheckedScenario& scenario_;
  const Motion& motion_;
  const LammpsLaw& law_;
  std::vector<std::string> classes_;  ///< names of contact classes and walls as LAMMPS takes them
  std::vector<std::string> walls_{};
  std::vector<std::string> variables_{};  ///< names of variables: displacements of classes, position of the centre
  bool has_run_ = false;
  std::string text_{};
};

}  // namespace

LammpsLaw lammps_law_of(const CheckedScenario& scenario) {
  const Model& model = *find_model(scenario.model);
  if (model.lammps_law != nullptr) return model.lammps_law(model_input(scenario));
  const auto names = names_of_models([](const Model& other) { return other.lammps_law != nullptr; });
  throw std::invalid_argument(fmt::format("LAMMPS has no contact law with the equations of model {}, only of {}",
                                          scenario.model, fmt::join(names, " and ")));
}

std::string lammps_input(const CheckedScenario& scenario, const Motion& motion, const LammpsLaw& law) {
  return LammpsInput(scenario, motion, law).text();
}

}  // namespace monograin
