/// The round-off of the rates in a segment, as `direct` learns it from the series of its pieces.
#pragma once

#include <algorithm>

#include "numerics/legendre_series.hpp"

namespace monograin {

/// Estimates the round-off of the rates from the series of pieces. A shorter piece from the beginning of a refused one
/// shows round-off if its last terms are as large as those of the refused piece. The last terms next to a square root
/// fall as the length to the power 1/2, those next to a kink as the length. A kink just inside the refused piece can
/// imitate round-off, but not with similar terms several times. Once round-off is known, pieces may show it: pieces
/// short enough to avoid it would let it add up in their states.
class RateRoundOff {
 public:
  [[nodiscard]] double known() const noexcept { return known_; }

  void see(const LegendreSeries& rate, double begin, double length, bool is_refused) noexcept {
    const double tail = rate.tail();
    if (begin != refused_at_) {
      if (!is_refused) return;
      refused_at_ = begin;
      refused_length_ = length;
      refused_tail_ = tail;
      return;
    }
    if (tail < k_as_large * refused_tail_ || length > k_shorter * refused_length_) return;
    if (refused_tail_ > k_most * rate.largest()) return;
    if (std::max(largest_, refused_tail_) > k_alike * std::min(largest_, refused_tail_)) {
      largest_ = 0.0;
      count_ = 0;
    }
    largest_ = std::max(largest_, refused_tail_);
    if (++count_ >= k_often) known_ = largest_;
    refused_at_ = -1.0;
  }

 private:
  static constexpr double k_shorter = 0.5;
  static constexpr double k_as_large = 0.75;
  static constexpr double k_most = 1e-6;  // over the largest term of the rates
  static constexpr double k_alike = 10.0;
  static constexpr int k_often = 3;

  double refused_at_ = -1.0;
  double refused_length_ = 0.0, refused_tail_ = 0.0;
  int count_ = 0;
  double largest_ = 0.0, known_ = 0.0;
};

}  // namespace monograin
