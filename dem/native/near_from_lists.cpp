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

/// x, y, z and radius of each row in the box; those of the idle rows that pad lists stay 0.
AlignedVector<double> places_in_box(const Bed& bed, const Rows& rows, int threads) {
  AlignedVector<double> place(rows.position.size());
#pragma omp parallel for num_threads(threads) schedule(static)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const Vec3 p = wrapped_into_box(bed, rows.position_of(i));
    for (int a = 0; a < 3; ++a) place[4 * i + a] = p[a];
    place[4 * i + 3] = rows.radius[i];
  }
  return place;
}

/// The pairs of one list at a time, behind those in `pairs`.
class Reader {
 public:
  Reader(const Bed& bed, const Rows& rows, const Kernels& kernels, const AlignedVector<double>& place,
         double max_gap_m)
      : rows_(rows), kernels_(kernels), images_(bed), place_(place), gap_m_(max_gap_m) {
    for (const bool p : bed.periodic) periodic_ |= p;
  }

  void read(const PairList& list, bool twins, std::vector<NearPair>& pairs) {
    for (std::int64_t begin = 0; begin < list.near_count(); begin += block) {
      const std::int64_t count = std::min(block, list.near_count() - begin);
      const std::int32_t *first = list.near_firsts() + begin, *second = list.near_seconds() + begin;
      const std::int64_t found =
          periodic_ ? find_images(first, second, count)
                    : kernels_.find_near(place_.data(), gap_m_, first, second, count, number_, distance_m_);
      for (std::int64_t k = 0; k < found; ++k) {
        const auto a = first[number_[k]], b = second[number_[k]];
        if (twins && a > b) continue;
        const auto i = rows_.bed_index[a], j = rows_.bed_index[b];
        pairs.push_back({std::min(i, j), std::max(i, j), distance_m_[k]});
      }
    }
  }

 private:
  static constexpr std::int64_t block = 512;  // their rows stay in the first caches

  Vec3 place(std::int32_t row) const {
    const double* p = place_.data() + 4 * std::int64_t(row);
    return {p[0], p[1], p[2]};
  }
  std::int64_t find_images(const std::int32_t* first, const std::int32_t* second, std::int64_t count) {
    std::int64_t found = 0;
    for (std::int64_t k = 0; k < count; ++k) {
      const Vec3 apart = images_.nearest(place(second[k]) - place(first[k]));
      const double squared = dot(apart, apart),
                   reach = (rows_.radius[first[k]] + rows_.radius[second[k]]) + gap_m_;
      number_[found] = static_cast<std::int32_t>(k), distance_m_[found] = std::sqrt(squared);
      found += (squared <= reach * reach) & (reach >= 0);  // no branch to guess
    }
    return found;
  }

  const Rows& rows_;
  const Kernels& kernels_;
  Images images_;
  const AlignedVector<double>& place_;
  double gap_m_;
  bool periodic_ = false;
  std::int32_t number_[block + 8];
  double distance_m_[block + 8];
};

}  // namespace

std::vector<NearPair> near_particles(const Bed& bed, const Rows& rows, const ContactLists& lists,
                                     const Kernels& kernels, double max_gap_m) {
  const auto& shares = lists.shares();
  const auto threads = static_cast<int>(shares.size());
  const auto place = places_in_box(bed, rows, threads);
  std::vector<std::vector<NearPair>> parts(shares.size());
#pragma omp parallel num_threads(threads)
  {
    const int t = omp_get_thread_num();
    parts[t].reserve(shares[t].own.near_count() + shares[t].cross.near_count());
    Reader reader(bed, rows, kernels, place, max_gap_m);
    reader.read(shares[t].own, false, parts[t]);
    reader.read(shares[t].cross, true, parts[t]);
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
