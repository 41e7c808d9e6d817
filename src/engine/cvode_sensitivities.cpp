#include "engine/cvode_sensitivities.hpp"

#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>

namespace monograin {

using sundials_boundary::NVector;
using sundials_boundary::view;

namespace {

// Tolerances of s over those of a step: its errors are no larger then than those of the curves, and steps are about as
// long as without it.
constexpr double k_coarser = 10.0;

/// The handles as the library's functions want them.
std::vector<N_Vector> handles(const std::vector<NVector>& vectors) {
  std::vector<N_Vector> result;
  for (const NVector& vector : vectors) result.push_back(vector.get());
  return result;
}

void copy(const std::vector<NVector>& from, const std::vector<NVector>& to) {
  for (std::size_t k = 0; k < from.size(); ++k) N_VScale(1.0, from[k].get(), to[k].get());
}

}  // namespace

CvodeSensitivities::CvodeSensitivities(ForwardSensitivities& of, double rtol, N_Vector atol, bool has_fixed_point,
                                       SUNContext context)
    : of_(of), has_fixed_point_(has_fixed_point), context_(context), rtol_(k_coarser * rtol) {
  for (std::size_t k = 0; k < of.count(); ++k) {
    for (auto* vectors : {&s_, &begin_, &between_}) vectors->emplace_back(N_VClone(atol));
    N_VScale(k_coarser / of.magnitude(k), atol, atol_.emplace_back(N_VClone(atol)).get());
    magnitudes_.push_back(of.magnitude(k));
  }
}

void CvodeSensitivities::take_state() {
  for (std::size_t k = 0; k < s_.size(); ++k) std::ranges::copy(of_.state(k), view(s_[k].get()).begin());
}

void CvodeSensitivities::keep() { copy(s_, begin_); }

void CvodeSensitivities::restore() { copy(begin_, s_); }

int CvodeSensitivities::start(void* memory, CVSensRhs1Fn function) {
  if (!of_.is_active()) return initialized_ == memory ? CVodeSensToggleOff(memory) : CV_SUCCESS;
  std::vector<N_Vector> s = handles(s_);
  if (initialized_ == memory) return CVodeSensReInit(memory, CV_SIMULTANEOUS, s.data());
  const int count = static_cast<int>(s.size());
  int flag = CVodeSensInit1(memory, count, CV_SIMULTANEOUS, function, s.data());
  if (flag == CV_SUCCESS) flag = CVodeSetSensParams(memory, nullptr, magnitudes_.data(), nullptr);
  if (flag == CV_SUCCESS) flag = CVodeSensSVtolerances(memory, rtol_, handles(atol_).data());
  if (flag == CV_SUCCESS) flag = CVodeSetSensErrCon(memory, SUNTRUE);
  if (flag == CV_SUCCESS && has_fixed_point_) {
    nonlinear_.reset(SUNNonlinSol_FixedPointSens(count + 1, s_.front().get(), 0, context_));
    flag = CVodeSetNonlinearSolverSensSim(memory, nonlinear_.get());
  }
  initialized_ = memory;
  return flag;
}

int CvodeSensitivities::get(void* memory, double end) {
  if (!of_.is_active()) return CV_SUCCESS;
  std::vector<N_Vector> s = handles(s_);
  return CVodeGetSensDky(memory, end, 0, s.data());
}

int CvodeSensitivities::put(void* memory, double xi, double end) {
  int flag = CV_SUCCESS;
  if (xi != end) {
    std::vector<N_Vector> between = handles(between_);
    flag = CVodeGetSensDky(memory, xi, 0, between.data());
  }
  const auto& vectors = xi == end ? s_ : between_;
  for (std::size_t k = 0; k < vectors.size(); ++k) std::ranges::copy(view(vectors[k].get()), of_.state(k).begin());
  return flag;
}

}  // namespace monograin
