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

}  // namespace granrad
