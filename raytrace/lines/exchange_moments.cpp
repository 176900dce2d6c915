#include "raytrace/lines/exchange_moments.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "dem/base/error.h"
#include "raytrace/line_pass/line_geometry.h"
#include "raytrace/line_pass/line_pass.h"
#include "raytrace/lines/line_plan.h"
#include "raytrace/lines/sphere_harmonics.h"

namespace granrad {

namespace {

/// One end of a line: the element and its functions there.
struct End {
  std::int32_t element;
  double psi[harmonic_count(highest_harmonic_order)];
};

/// Where the block of a row and a column begins: open addressing, a power of two of slots.
class BlockTable {
 public:
  /// Of column j; `at` where there was none.
  std::int64_t find_or_add(std::int32_t j, std::int64_t at) {
    if (4 * (used_ + 1) > 3 * slots_.size()) grow();
    Slot& slot = place(j);
    if (slot.column == j) return slot.at;
    ++used_;
    slot = {j, at};
    return at;
  }

 private:
  struct Slot {
    std::int32_t column = -1;
    std::int64_t at = 0;
  };
  Slot& place(std::int32_t j) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t k = (static_cast<std::uint32_t>(j) * 0x9e3779b1u >> 8) & mask;
    while (slots_[k].column != j && slots_[k].column >= 0) k = (k + 1) & mask;
    return slots_[k];
  }
  void grow() {
    const auto old = std::exchange(slots_, std::vector<Slot>(std::max<std::size_t>(8, 2 * slots_.size())));
    for (const Slot& s : old)
      if (s.column >= 0) place(s.column) = s;
  }
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

class Assembly {
 public:
  Assembly(const Enclosure& enclosure, const LineScene& scene, int order, const WallPatches& patches,
           std::size_t limit_bytes)
      : scene_(scene), patches_(patches), order_(order), limit_(limit_bytes / sizeof(double)) {
    const auto spheres = static_cast<std::int32_t>(enclosure.sphere_count());
    for (std::int32_t i = 0; i < spheres; ++i) add_element(i, harmonic_count(order));
    for (std::int32_t p = 0; p < patches.count(); ++p) add_element(spheres + patches.wall(p), 1);
    add_element(scene.open_surface, 1);
    result_.mass.assign(result_.mass_at.back(), 0);
    known_.resize(result_.surface.size());
  }

  void add_direction(LinePass& pass) {
    const LineGeometry geometry{pass};
    pass.visit_all_ends([&](std::int32_t surface, std::int64_t cell, std::int32_t from) {
      add_pair(end_on(geometry, surface, cell, -1), end_on(geometry, from, cell, 1));
    });
  }

  ExchangeMoments finish(double unit_m2) {
    result_.unit_m2 = unit_m2;
    std::sort(result_.blocks.begin(), result_.blocks.end(),
              [](const auto& a, const auto& b) { return a.i != b.i ? a.i < b.i : a.j < b.j; });
    return std::move(result_);
  }

 private:
  void add_element(std::int32_t surface, int functions) {
    if (result_.first.empty()) result_.first = {0}, result_.mass_at = {0};
    result_.surface.push_back(surface);
    result_.first.push_back(result_.first.back() + functions);
    result_.mass_at.push_back(result_.mass_at.back() + functions * functions);
  }

  End end_on(const LineGeometry& geometry, std::int32_t surface, std::int64_t cell, int side) const {
    End end;
    const auto spheres = static_cast<std::int32_t>(scene_.x.size());
    if (surface < spheres) {
      end.element = surface;
      const LineBall ball = geometry.pass.ball(surface);
      const Vec3 point = geometry.point(cell, geometry.depth(surface, cell, side));
      sphere_harmonics(order_, (1 / ball.radius) * (point - ball.centre), end.psi);
      return end;
    }
    end.psi[0] = 1;
    end.element = result_.element_count() - 1;
    if (surface == scene_.open_surface) return end;
    const auto wall = surface - spheres;
    const Vec3 point = geometry.point(cell, geometry.depth(surface, cell, side)) + scene_.middle;
    end.element = spheres + patches_.at(wall, point, point);
    return end;
  }

  void add_mass(const End& e) {
    double* m = result_.mass.data() + result_.mass_at[e.element];
    const int n = result_.size(e.element);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) m[a * n + b] += e.psi[a] * e.psi[b];
  }

  void add_pair(const End& p, const End& q) {
    if (p.element == q.element) return;
    add_mass(p), add_mass(q);
    const End &i = p.element < q.element ? p : q, &j = p.element < q.element ? q : p;
    const int n = result_.size(i.element), m = result_.size(j.element);
    const std::int64_t at = block(i.element, j.element, n * m);
    double* k = result_.values.data() + at;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < m; ++b) k[a * m + b] += i.psi[a] * j.psi[b];
  }

  std::int64_t block(std::int32_t i, std::int32_t j, int entries) {
    const auto at = static_cast<std::int64_t>(result_.values.size());
    if (const auto known = known_[i].find_or_add(j, at); known != at) return known;
    if (result_.values.size() + entries > limit_)
      throw InputError(advised(fmt::format("radiation.order = {} (its matrix grows beyond {:.1f} GiB)",
                                           order_, static_cast<double>(limit_ * sizeof(double)) / (1 << 30)),
                               "lower order or rays, or use source = \"paths\""));
    result_.values.resize(result_.values.size() + entries, 0);
    result_.blocks.push_back({i, j, at});
    return at;
  }

  const LineScene& scene_;
  const WallPatches& patches_;
  int order_;
  std::size_t limit_;
  ExchangeMoments result_;
  std::vector<BlockTable> known_;  ///< [elements] of the blocks of each row
};

}  // namespace

ExchangeMoments sweep_exchange_moments(const Enclosure& enclosure, const LineOptions& options, int order,
                                       const WallPatches& patches, int replicate) {
  check_line_options(options);
  const LineScene scene(enclosure, options.lines_per_disc);
  refuse_wasted_lines(scene, options, options.directions);
  if (scene.is_periodic())
    throw InputError(
        advised("radiation.order > 0 (the box is periodic)", "use order = 0, or source = \"paths\""));
  Assembly assembly(enclosure, scene, order, patches, options.memory_limit_bytes);
  LinePass pass(scene);
  for (int k = 0; k < options.directions; ++k) {
    pass.aim(line_frame(options.seed, replicate, k, options.directions));
    assembly.add_direction(pass);
  }
  return assembly.finish(2 * scene.spacing * scene.spacing / options.directions);
}

}  // namespace granrad
