#include "dem/liggghts/parts.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace granrad::liggghts {

namespace {

constexpr int bins = 1024, blocks = 8;  // of the domain along an axis: to count in, to round extents to
constexpr double steps_of_a_slab = 16;

/// How many places lie in each bin along one axis.
class Profile {
 public:
  Profile(const Box& domain, const std::vector<Vec3>& places, int axis) : count_(bins, 0) {
    const double low = domain.min[axis], per_bin = domain.size()[axis] / bins;
    for (const Vec3& p : places)
      ++count_[static_cast<std::size_t>(std::clamp(std::floor((p[axis] - low) / per_bin), 0.0, bins - 1.0))];
    const auto filled = [](std::int64_t n) { return n > 0; };
    first_ = static_cast<int>(std::find_if(count_.begin(), count_.end(), filled) - count_.begin());
    last_ = static_cast<int>(count_.rend() - std::find_if(count_.rbegin(), count_.rend(), filled));
  }
  /// The part of the domain that holds them, in whole blocks.
  double extent() const {
    constexpr int per_block = bins / blocks;
    const int from = first_ / per_block, to = (last_ + per_block - 1) / per_block;
    return static_cast<double>(to - from) / blocks;
  }
  /// Where slabs begin that hold about as many each.
  std::vector<double> split(int slabs) const {
    const double step = extent() / (steps_of_a_slab * slabs);
    const double all = static_cast<double>(std::accumulate(count_.begin(), count_.end(), std::int64_t{0}));
    std::vector<double> at = {0};
    double before = 0;
    std::size_t bin = 0;
    for (int slab = 1; slab < slabs; ++slab) {
      const double wanted = all * slab / slabs;
      while (bin < bins && before + static_cast<double>(count_[bin]) < wanted)
        before += static_cast<double>(count_[bin++]);
      const double in_bin = (wanted - before) / static_cast<double>(count_[bin]);
      const double quantile = (static_cast<double>(bin) + in_bin) / bins;
      at.push_back(std::max(std::round(quantile / step) * step, at.back() + step));
    }
    at.push_back(1);
    for (auto slab = at.size() - 1; slab-- > 1;) at[slab] = std::min(at[slab], at[slab + 1] - step);
    return at;
  }

 private:
  std::vector<std::int64_t> count_;
  int first_, last_;
};

/// The numbers of slabs with the least surface between them; fewer along x at equal surface.
std::array<int, 3> least_surface(const Vec3& extent, int ranks) {
  std::array<int, 3> best{1, 1, ranks};
  double least = std::numeric_limits<double>::infinity();
  for (int x = 1; x <= ranks; ++x)
    for (int y = 1; x * y <= ranks; ++y) {
      if (ranks % (x * y) != 0) continue;
      const int z = ranks / (x * y);
      const double surface =
          (x - 1) * extent.y * extent.z + (y - 1) * extent.z * extent.x + (z - 1) * extent.x * extent.y;
      if (surface < least * (1 - 1e-9)) least = surface, best = {x, y, z};
    }
  return best;
}

}  // namespace

Parts parts_of(const Box& domain, const std::vector<Vec3>& places, int ranks) {
  if (ranks == 1 || places.empty()) return {};
  const std::array<Profile, 3> profile{Profile(domain, places, 0), Profile(domain, places, 1),
                                       Profile(domain, places, 2)};
  Vec3 extent = domain.size();
  for (int a = 0; a < 3; ++a) extent[a] *= profile[a].extent();
  Parts parts{least_surface(extent, ranks), {}};
  for (int a = 0; a < 3; ++a) parts.split[a] = profile[a].split(parts.count[a]);
  return parts;
}

}  // namespace granrad::liggghts
