/// The round-off of the rates in a segment, as `direct` learns it from the series of its pieces.
#pragma once

#include <algorithm>
#include <optional>

#include "numerics/legendre_series.hpp"

namespace monograin {

/// Learns the round-off of the rates from pieces whose series end in terms above the tolerance, and are therefore
/// refused. A later piece from the same beginning, at most half as long, shows round-off if its last terms have not
/// become smaller: halving a piece multiplies them by 0.7 next to a square root (length to the power 1/2), and by 0.5
/// next to a kink. A kink just inside the refused piece can imitate round-off, but not several times: round-off counts
/// as known after three such observations. Once it is known, pieces may show it: pieces short enough to avoid it would
/// let it add up in their states.
class RateRoundOff {
 public:
  /// Largest terms observed to be round-off; 0 if the round-off is not known.
  [[nodiscard]] double known() const noexcept { return count_ < k_often ? 0.0 : largest_; }

  /// Reports a piece. Pieces have to be reported in the order in which they are tried.
  /// @param rate    series of the rates over the piece
  /// @param begin   of the piece (step coordinate), >= 0
  /// @param length  of the piece, > 0
  void report(const LegendreSeries& rate, double begin, double length, bool is_refused) noexcept {
    const double tail = rate.tail();
    if (!refused_ || begin != refused_->begin) {
      if (is_refused) refused_ = {begin, length, tail};
      return;
    }
    if (length > k_shorter * refused_->length || tail < k_as_large * refused_->tail) return;
    if (refused_->tail > k_most * rate.largest()) return;
    largest_ = std::max(largest_, refused_->tail);
    ++count_;
    refused_.reset();
  }

 private:
  static constexpr double k_shorter = 0.5;    // largest length of the later piece, over that of the refused one
  static constexpr double k_as_large = 0.75;  // least ratio of the last terms: just above that of a square root
  static constexpr double k_most = 1e-6;      // largest round-off, over the largest term of the rates
  static constexpr int k_often = 3;           // observations that make it known

  struct RefusedPiece {
    double begin = 0.0;
    double length = 0.0;
    double tail = 0.0;  ///< last terms of its series
  };

  std::optional<RefusedPiece> refused_;  ///< the first one from the present beginning; empty after it has been used
  int count_ = 0;
  double largest_ = 0.0;  ///< of the observations
};

}  // namespace monograin
