#pragma once

#include <cmath>

#include "systems/contact/normal_share.h"

namespace flinch {

/// What has been found of one class: a sum of likelihoods, and of its largest term where it is touched, how
/// hard and how fast. Terms are multiples of exp(`unit`): numbers that are neither too large nor too small.
struct TouchTally {
  static constexpr double negligible = 18.0;  ///< ln of how much smaller what adds nothing to a sum is

  double unit = 0.0;
  double of_none = 1.0;  ///< exp(-unit)
  double sum = 0.0;
  double largest = 0.0;    ///< of the terms
  double marked = 0.0;     ///< one of the terms, at least half as large
  double top = -1e300;     ///< its logarithm
  double explained = 0.0;  ///< of the squared size of the whitened wrench, by the contact that does best
  double location = 0.0, force = 0.0, approach = 0.0;  ///< of the largest term

  bool is_negligible(double logarithm) const { return logarithm < top - negligible; }

  /// So that terms of this logarithm are no large numbers.
  void make_room(double logarithm) {
    if (logarithm < unit + 5.0) return;
    const double smaller = std::exp(unit - logarithm);
    sum *= smaller;
    largest *= smaller;
    marked *= smaller;
    unit = logarithm;
    of_none = std::exp(-unit);
  }

  /// exp(x^2 / 2) times the share of a normal distribution below x.
  double likelihood(double x) const {
    if (x < 0.0) return x > -farthest_normal ? of_none * normal_tail(-x) : 0.0;
    const double pushed = std::exp(0.5 * x * x - unit);
    return x < farthest_normal ? pushed - of_none * normal_tail(x) : pushed;
  }

  void add(double term, double fraction, double newtons, double speed) {
    sum += term;
    if (term <= largest) return;
    largest = term;
    if (term > 2.0 * marked) {
      marked = term;
      top = unit + std::log(term);
    }
    location = fraction;
    force = newtons;
    approach = speed;
  }
};

}  // namespace flinch
