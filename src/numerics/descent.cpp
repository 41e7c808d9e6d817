#include "numerics/descent.hpp"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_multifit_nlinear.h>
#include <gsl/gsl_multimin.h>

#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <new>
#include <vector>

namespace monograin {
namespace {

constexpr int k_refinements = 3;
constexpr double k_round_off_of_cost = 1e-12;  // over the cost
constexpr double k_nearly_exact = 1e-9;        // step in z below which a minimum has converged
constexpr double k_kinked = 1e-5;              // fall of the cost predicted at a smooth minimum, over the cost, at most
constexpr double k_margin_of_noise = 1e3;
constexpr double k_longest_step = 0.1;       // side of the first simplex, in z
constexpr std::size_t k_simplex_steps = 60;  // for each parameter
constexpr double k_simplex_end = 1e-3;       // size of the last simplex, in standard errors

template <auto Free>
struct Deleter {
  template <class T>
  void operator()(T* handle) const noexcept {
    Free(handle);
  }
};
using Vector = std::unique_ptr<gsl_vector, Deleter<gsl_vector_free>>;
using Solver = std::unique_ptr<gsl_multifit_nlinear_workspace, Deleter<gsl_multifit_nlinear_free>>;
using Simplex = std::unique_ptr<gsl_multimin_fminimizer, Deleter<gsl_multimin_fminimizer_free>>;

using ConstVectorMap = Eigen::Map<const Eigen::VectorXd>;
ConstVectorMap map_of(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

std::vector<double> values_of(const gsl_vector& vector) {
  std::vector<double> values(vector.size);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = gsl_vector_get(&vector, i);
  return values;
}

void copy(const std::vector<double>& values, gsl_vector& vector) {
  for (std::size_t i = 0; i < values.size(); ++i) gsl_vector_set(&vector, i, values[i]);
}

double nearly_exact(const SearchBox& box) { return std::max(k_nearly_exact, box.problem().noise); }

/// What GSL's solver asks for in the course of a descent. Exceptions do not cross C.
struct Linearisation {
  SearchBox& box;
  bool is_central = false;
  Place trial{};
  std::vector<double> values;      ///< residuals at the last point
  std::vector<double> before_z{};  ///< point of the last derivatives
  std::vector<double> before{};    ///< residuals at that point
  std::size_t trials = 0;          ///< residuals evaluated since then
  Eigen::MatrixXd jacobian{};
  std::exception_ptr pending{};

  void evaluate(const gsl_vector& z, gsl_vector& f) {
    trial.z = values_of(z);
    ++trials;
    // GSL refuses a step to a higher cost, and tries a shorter one.
    if (!box.evaluate(trial, values)) {
      std::ranges::fill(values, std::sqrt(box.beyond_all_costs() / static_cast<double>(values.size())));
    }
    copy(values, f);
  }

  /// Computes the derivatives at the point of the last residuals.
  void differentiate(const gsl_vector& z, gsl_matrix& result) {
    trial.z = values_of(z);
    // A step that was not accepted at once shows that the derivatives are too old for an update.
    if (is_central || before.empty() || trials > 1 || !update()) {
      jacobian = box.derivatives(trial, values, is_central);
    }
    before_z = trial.z;
    before = values;
    trials = 0;
    for (std::size_t i = 0; i < result.size1; ++i) {
      for (std::size_t k = 0; k < result.size2; ++k) {
        gsl_matrix_set(&result, i, k, jacobian(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)));
      }
    }
  }

  /// Updates the derivatives by the last step (Broyden (1965), the first method).
  /// @return false if there was no step
  bool update() {
    const Eigen::VectorXd step = map_of(trial.z) - map_of(before_z);
    if (step.squaredNorm() == 0.0) return false;
    jacobian += (map_of(values) - map_of(before) - jacobian * step) * step.transpose() / step.squaredNorm();
    return true;
  }

  template <class Call>
  static int guarded(void* self, Call call) noexcept {
    auto& linearisation = *static_cast<Linearisation*>(self);
    try {
      call(linearisation);
      return GSL_SUCCESS;
    } catch (...) {
      linearisation.pending = std::current_exception();
      return GSL_EFAILED;
    }
  }
};

int residuals_callback(const gsl_vector* z, void* self, gsl_vector* f) noexcept {
  return Linearisation::guarded(self, [&](Linearisation& linearisation) { linearisation.evaluate(*z, *f); });
}

int jacobian_callback(const gsl_vector* z, void* self, gsl_matrix* jacobian) noexcept {
  return Linearisation::guarded(self,
                                [&](Linearisation& linearisation) { linearisation.differentiate(*z, *jacobian); });
}

/// Refines a minimum by Gauss-Newton steps. These do not minimise the cost itself, whose round-off hides the last half
/// of the parameters' digits.
Place refined(SearchBox& box, Place place) {
  std::vector<double> values(box.problem().residual_count);
  if (values.size() < box.size()) return place;
  for (int round = 0; round < k_refinements && box.evaluate(place, values); ++round) {
    const Eigen::MatrixXd jacobian = box.derivatives(place, values, true);
    const Eigen::VectorXd step = jacobian.completeOrthogonalDecomposition().solve(-map_of(values));
    Place next = place;
    for (std::size_t k = 0; k < box.size(); ++k) next.z[k] = folded(place.z[k] + step[static_cast<Eigen::Index>(k)]);
    next.cost = box.cost_at(next);
    if (!(next.cost <= place.cost * (1.0 + k_round_off_of_cost))) break;
    place = std::move(next);
    place.has_converged = step.norm() <= nearly_exact(box);
    if (place.has_converged) break;
  }
  return place;
}

/// The cost along given directions from a place, for GSL's simplex.
struct CostAlong {
  SearchBox& box;
  const Place& from;
  Eigen::MatrixXd directions;
  Place best;
  std::exception_ptr pending{};

  double operator()(const gsl_vector& u) {
    const Eigen::VectorXd z = map_of(from.z) + directions * map_of(values_of(u));
    Place place;
    for (const double value : z) place.z.push_back(folded(value));
    place.cost = box.cost_at(place);
    if (place.cost < best.cost) best = place;
    return place.cost < k_no_cost ? place.cost : box.beyond_all_costs();
  }
};

double cost_callback(const gsl_vector* u, void* self) noexcept {
  auto& cost = *static_cast<CostAlong*>(self);
  try {
    return cost(*u);
  } catch (...) {
    cost.pending = std::current_exception();
    return GSL_NAN;
  }
}

}  // namespace

Place descend(SearchBox& box, const Place& start, const Effort& effort, std::span<const Place> known) {
  if (box.problem().residual_count < box.size()) return start;
  Linearisation linearisation{
      .box = box, .is_central = effort.is_central, .values = std::vector<double>(box.problem().residual_count)};
  gsl_multifit_nlinear_fdf fdf{};
  fdf.f = residuals_callback;
  fdf.df = jacobian_callback;
  fdf.n = box.problem().residual_count;
  fdf.p = box.size();
  fdf.params = &linearisation;
  const gsl_multifit_nlinear_parameters settings = gsl_multifit_nlinear_default_parameters();
  const Solver solver(gsl_multifit_nlinear_alloc(gsl_multifit_nlinear_trust, &settings, fdf.n, fdf.p));
  const Vector z(gsl_vector_alloc(fdf.p));
  if (!solver || !z) throw std::bad_alloc();
  copy(start.z, *z);

  int status = gsl_multifit_nlinear_init(z.get(), &fdf, solver.get());
  bool has_converged = false;
  double step_before = 0.0;
  for (std::size_t count = 0; status == GSL_SUCCESS && count < effort.iterations && !has_converged; ++count) {
    status = gsl_multifit_nlinear_iterate(solver.get());
    const double step = gsl_blas_dnrm2(solver->dx);
    const double rate = step < step_before ? step / step_before : 1.0;
    has_converged = step * rate <= effort.step;
    step_before = step;
    const auto here = values_of(*gsl_multifit_nlinear_position(solver.get()));
    if (std::ranges::any_of(known, [&](const Place& place) { return is_near(place.z, here, k_near_place); })) break;
  }
  if (linearisation.pending) std::rethrow_exception(linearisation.pending);

  Place end;
  for (const double value : values_of(*gsl_multifit_nlinear_position(solver.get()))) end.z.push_back(folded(value));
  const double norm = gsl_blas_dnrm2(gsl_multifit_nlinear_residual(solver.get()));
  end.cost = norm * norm;
  end.has_converged = has_converged;
  return end;
}

Place descend_to_round_off(SearchBox& box, Place place) {
  place.has_converged = false;
  place = refined(box, std::move(place));
  if (place.has_converged) return place;
  return descend(box, place, {.iterations = 100, .step = nearly_exact(box), .is_central = true});
}

Place descend_over_kinks(SearchBox& box, const Place& place) {
  std::vector<double> values(box.problem().residual_count);
  if (values.size() <= box.size() || !(place.cost > 0.0) || !box.evaluate(place, values)) return place;
  const Eigen::MatrixXd jacobian = box.derivatives(place, values, true);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobian, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const double predicted = (svd.matrixU().transpose() * map_of(values)).squaredNorm();
  const double round_off = k_margin_of_noise * box.problem().noise * jacobian.norm();
  if (predicted <= k_kinked * place.cost || place.cost <= round_off * round_off) return place;

  const double s = std::sqrt(place.cost / static_cast<double>(values.size() - box.size()));
  CostAlong cost{.box = box, .from = place, .directions = svd.matrixV(), .best = place};
  for (Eigen::Index j = 0; j < svd.singularValues().size(); ++j) {
    cost.directions.col(j) *= std::min(s / svd.singularValues()[j], k_longest_step);
  }
  gsl_multimin_function function{cost_callback, box.size(), &cost};
  const Simplex simplex(gsl_multimin_fminimizer_alloc(gsl_multimin_fminimizer_nmsimplex2, box.size()));
  const Vector start(gsl_vector_calloc(box.size()));
  const Vector steps(gsl_vector_alloc(box.size()));
  if (!simplex || !start || !steps) throw std::bad_alloc();
  gsl_vector_set_all(steps.get(), 1.0);
  int status = gsl_multimin_fminimizer_set(simplex.get(), &function, start.get(), steps.get());
  for (std::size_t step = 0; status == GSL_SUCCESS && step < k_simplex_steps * box.size(); ++step) {
    status = gsl_multimin_fminimizer_iterate(simplex.get());
    if (gsl_multimin_fminimizer_size(simplex.get()) < k_simplex_end) break;
  }
  if (cost.pending) std::rethrow_exception(cost.pending);
  if (!(cost.best.cost < place.cost)) return place;
  cost.best.has_converged = gsl_multimin_fminimizer_size(simplex.get()) < k_simplex_end;
  return cost.best;
}

}  // namespace monograin
