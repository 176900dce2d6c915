#include "coupling/validate/update_cost.h"

#include <algorithm>
#include <vector>

#include "coupling/simulation/heat_model.h"
#include "dem/base/clock.h"

namespace granrad {

namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

UpdateCost update_cost(const Case& c, const Bed& bed, int threads) {
  if (c.heat.radiation.kind == RadiationKind::none || bed.size() == 0) return {};
  constexpr double long_s = 0.2;
  std::vector<double> cpu, wall;
  for (std::uint64_t draw = 0; draw < 3; ++draw) {
    HeatModel heat(c, threads);
    heat.start(bed);
    const double cpu_begin = cpu_s(), wall_begin = monotonic_s();
    heat.draw_radiation(bed, draw);
    cpu.push_back(cpu_s() - cpu_begin);
    wall.push_back(monotonic_s() - wall_begin);
    if (cpu.front() > long_s) break;
  }
  return {median(cpu), median(wall)};
}

}  // namespace granrad
