#include "coupling/validate/update_cost.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

#include "coupling/simulation/heat_model.h"

namespace granrad {

namespace {

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

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
    const double cpu_begin = cpu_seconds(), wall_begin = wall_seconds();
    heat.draw_radiation(bed, draw);
    cpu.push_back(cpu_seconds() - cpu_begin);
    wall.push_back(wall_seconds() - wall_begin);
    if (cpu.front() > long_s) break;
  }
  return {median(cpu), median(wall)};
}

}  // namespace granrad
