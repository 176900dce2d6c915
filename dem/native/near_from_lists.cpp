#include "dem/native/near_from_lists.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

namespace granrad::native {
namespace {

/// nearest_image without its divisions for bodies that are nowhere near half a period apart.
class Images {
 public:
  explicit Images(const Bed& bed) : bed_(bed) {
    for (int a = 0; a < 3; ++a)
      if (bed.periodic[a]) near_[a] = 0.49 * bed.box.size()[a];
  }
  Vec3 nearest(const Vec3& apart) const {
    const bool unchanged =
        std::abs(apart.x) < near_[0] && std::abs(apart.y) < near_[1] && std::abs(apart.z) < near_[2];
    return unchanged ? apart : nearest_image(bed_, apart);
  }

 private:
  const Bed& bed_;
  double near_[3]{1e300, 1e300, 1e300};
};

std::vector<Vec3> wrapped_rows(const Bed& bed, const Rows& rows, int threads) {
  std::vector<Vec3> wrapped(rows.count);
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::int64_t i = 0; i < rows.count; ++i) wrapped[i] = wrapped_into_box(bed, rows.position_of(i));
  return wrapped;
}

}  // namespace

std::vector<NearPair> near_particles(const Bed& bed, const Rows& rows, const ContactLists& lists,
                                     double max_gap_m) {
  const auto& shares = lists.shares();
  const auto threads = static_cast<int>(shares.size());
  const std::vector<Vec3> points = wrapped_rows(bed, rows, threads);
  const Images images(bed);
  std::vector<std::vector<NearPair>> parts(shares.size());
#pragma omp parallel num_threads(threads)
  {
    const int t = omp_get_thread_num();
    auto& part = parts[t];
    part.resize(shares[t].own.near_count() + shares[t].cross.near_count());
    std::size_t found = 0;
    const auto collect = [&](const PairList& list, bool twins) {
      for (std::int64_t k = 0; k < list.near_count(); ++k) {
        const auto a = list.near_first(k), b = list.near_second(k);
        const Vec3 apart = images.nearest(points[b] - points[a]);
        const double squared = dot(apart, apart), reach = (rows.radius[a] + rows.radius[b]) + max_gap_m;
        const auto i = rows.bed_index[a], j = rows.bed_index[b];
        part[found] = {std::min(i, j), std::max(i, j), std::sqrt(squared)};
        found += (squared <= reach * reach) & (reach >= 0) & !(twins && a > b);  // no branch to guess
      }
    };
    collect(shares[t].own, false);
    collect(shares[t].cross, true);
    part.resize(found);
  }
  return sorted_by_rows(parts, bed.size());
}

std::vector<std::int32_t> particles_at_walls(const ContactLists& lists, const Rows& rows) {
  std::vector<std::int32_t> particles;
  for (const Share& share : lists.shares())
    for (const auto& near : share.walls.near()) particles.push_back(rows.bed_index[near.row]);
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  return particles;
}

std::vector<NearWall> near_walls(const ContactLists& lists, const Rows& rows, const WallSurface& surface,
                                 double max_gap_m) {
  std::vector<NearWall> found;
  std::vector<std::int32_t> facets;
  for (const Share& share : lists.shares()) {
    const auto& near = share.walls.near();
    for (std::size_t k = 0; k < near.size();) {
      const auto row = near[k].row;
      const Vec3 p = rows.position_of(row);
      const double most = rows.radius[row] + max_gap_m;
      facets.clear();
      for (; k < near.size() && near[k].row == row; ++k) {
        const auto f = near[k].facet;
        if (surface.stands(f) && std::abs(surface.height(f, p)) < most && surface.distance(f, p) < most)
          facets.push_back(f);
      }
      if (!facets.empty())
        append_near_walls(surface, rows.bed_index[row], p, rows.radius[row], max_gap_m, facets.data(),
                          facets.data() + facets.size(), found);
    }
  }
  sort_by_rows(found);
  return found;
}

}  // namespace granrad::native
