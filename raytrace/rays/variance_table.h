#pragma once
#include <array>
#include <vector>

#include "raytrace/rays/hit_tally.h"

namespace granrad {

/// The variance of counts relative to binomial, found from how replicates scatter, by the size of the count;
/// every count weighs the same.
class VarianceTable {
 public:
  void add(const HitEntry& entry, std::int64_t launched, int replicates);

  /// [b] for counts in [2^b, 2^(b+1)), the last one also beyond. Neighbouring sizes are pooled until a group
  /// has enough degrees of freedom; empty when there are too few in all.
  std::vector<double> factors() const;

 private:
  struct Bin {
    double ratio = 0,
           freedom = 0;  ///< variance over binomial of each count, summed by its degrees of freedom
  };
  std::array<Bin, 48> bins_{};
};

/// The variance of the particles' sums over the stated walls relative to binomial, from replicates; each
/// counts as it does in the error of the merged sums.
class SumVariance {
 public:
  void add(const HitEntry& stated, std::int64_t launched, int replicates, double share) {
    if (stated.hits == 0 || stated.hits == launched) return;
    const double k = static_cast<double>(stated.hits), n = static_cast<double>(launched), r = replicates;
    const double weight = share * share / (n * n);
    found_ += weight * r / (r - 1) * (stated.replicate_square_sum - k * k / r);
    binomial_ += weight * k * (1 - k / n);
  }
  double factor() const { return binomial_ > 0 ? found_ / binomial_ : 1; }

 private:
  double found_ = 0, binomial_ = 0;
};

}  // namespace granrad
