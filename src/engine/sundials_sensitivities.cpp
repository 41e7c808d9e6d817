#include "engine/sundials_sensitivities.hpp"

#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>

namespace monograin {

using sundials_boundary::NVector;
using sundials_boundary::view;

namespace {

// Tolerances of s over those of a step: as large as 1e-6 of the derivatives allows, also after several cycles in a
// column that is a small difference of others. With tighter ones, steps become shorter, and s next to a singularity has
// errors of round-off that no step removes. IDAS gains nothing from tighter ones: round-off of its residuals is larger.
constexpr double k_coarser = 20.0;
constexpr double k_coarser_of_adams = 30.0;
constexpr double k_coarser_of_ida = 100.0;
constexpr double k_round_off_of_residuals = 2.0 * k_epsilon;  // over the size of an unknown

/// Raw handles for the library's functions.
std::vector<N_Vector> handles(const std::vector<NVector>& vectors) {
  std::vector<N_Vector> result;
  for (const NVector& vector : vectors) result.push_back(vector.get());
  return result;
}

void copy(const std::vector<NVector>& from, const std::vector<NVector>& to) {
  for (std::size_t k = 0; k < from.size(); ++k) N_VScale(1.0, from[k].get(), to[k].get());
}

}  // namespace

template <class Library>
SundialsSensitivities<Library>::SundialsSensitivities(ForwardSensitivities& of, double rtol, N_Vector atol,
                                                      bool has_fixed_point, SUNContext context)
    : of_(of), has_fixed_point_(has_fixed_point), context_(context) {
  const double of_newton = Library::is_implicit ? k_coarser_of_ida : k_coarser;
  const double coarser = has_fixed_point ? k_coarser_of_adams : of_newton;
  rtol_ = coarser * rtol;
  for (std::size_t k = 0; k < of.count(); ++k) {
    for (auto* vectors : {&s_, &begin_, &between_, &ds_, &begin_rates_}) {
      N_VConst(0.0, vectors->emplace_back(N_VClone(atol)).get());
    }
    N_VScale(coarser / of.magnitude(k), atol, atol_.emplace_back(N_VClone(atol)).get());
    magnitudes_.push_back(of.magnitude(k));
  }
}

/// Raises the tolerances of s above the round-off in the difference of the neighbours' residuals, which no corrector
/// removes. It counts where s is zero. IDAS takes a correction as the last one if it is below 0.0033 of the tolerance.
template <class Library>
void SundialsSensitivities<Library>::raise_tolerances(std::size_t number, std::span<const double> y) {
  const auto atol = view(atol_[number].get());
  for (std::size_t i = 0; i < atol.size(); ++i) {
    const double size = std::max(of_.scale(i), std::abs(y[i]));
    atol[i] = std::max(atol[i], k_round_off_of_residuals / 0.0033 * size / of_.step(number));
  }
}

template <class Library>
void SundialsSensitivities<Library>::take_state(double xi, std::span<const double> y) {
  for (std::size_t k = 0; k < s_.size(); ++k) {
    const auto begin = view(begin_[k].get());
    std::ranges::copy(of_.state(k).first(begin.size()), begin.begin());
    if (Library::is_implicit) raise_tolerances(k, y);
  }
  correct_begin(xi, y);
  restore();
}

template <class Library>
void SundialsSensitivities<Library>::keep() {
  copy(s_, begin_);
  copy(ds_, begin_rates_);
}

template <class Library>
void SundialsSensitivities<Library>::restore() {
  copy(begin_, s_);
  copy(begin_rates_, ds_);
}

template <class Library>
void SundialsSensitivities<Library>::correct_begin(double xi, std::span<const double> y) {
  if constexpr (Library::is_implicit) {
    if (!of_.is_active()) return;
    for (std::size_t k = 0; k < s_.size(); ++k) {
      of_.complete(k, xi, y, view(begin_[k].get()), view(begin_rates_[k].get()));
    }
  }
}

template <class Library>
int SundialsSensitivities<Library>::start(void* memory, typename Library::Function function) {
  if (!of_.is_active()) return initialized_ == memory ? Library::switch_off(memory) : 0;
  std::vector<N_Vector> s = handles(s_);
  std::vector<N_Vector> ds = handles(ds_);
  if (initialized_ == memory) {
    const int flag = Library::reinit(memory, s.data(), ds.data());
    const bool has_new_tolerances = Library::is_implicit;
    return flag == 0 && has_new_tolerances ? Library::set_tolerances(memory, rtol_, handles(atol_).data()) : flag;
  }
  const int count = static_cast<int>(s.size());
  int flag = Library::init(memory, count, function, s.data(), ds.data());
  if (flag == 0) flag = Library::set_parameters(memory, nullptr, magnitudes_.data(), nullptr);
  if (flag == 0) flag = Library::set_tolerances(memory, rtol_, handles(atol_).data());
  if (flag == 0) flag = Library::set_error_control(memory, SUNTRUE);
  if (flag == 0 && has_fixed_point_) {
    nonlinear_.reset(SUNNonlinSol_FixedPointSens(count + 1, s_.front().get(), 0, context_));
    flag = Library::set_corrector(memory, nonlinear_.get());
  }
  initialized_ = memory;
  return flag;
}

template <class Library>
int SundialsSensitivities<Library>::get(void* memory, double end) {
  if (!of_.is_active()) return 0;
  int flag = Library::derivative(memory, end, 0, handles(s_).data());
  if (Library::is_implicit && flag == 0) flag = Library::derivative(memory, end, 1, handles(ds_).data());
  return flag;
}

template <class Library>
int SundialsSensitivities<Library>::put(void* memory, double xi, double end) {
  int flag = 0;
  if (xi != end) {
    flag = Library::derivative(memory, xi, 0, handles(between_).data());
  }
  const auto& vectors = xi == end ? s_ : between_;
  for (std::size_t k = 0; k < vectors.size(); ++k) std::ranges::copy(view(vectors[k].get()), of_.state(k).begin());
  return flag;
}

template class SundialsSensitivities<CvodesCalls>;
template class SundialsSensitivities<IdasCalls>;

}  // namespace monograin
