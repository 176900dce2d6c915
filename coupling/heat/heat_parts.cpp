#include "coupling/heat/heat_parts.h"

#include <fmt/format.h>

#include <cmath>

#include "coupling/heat/energy_ledger.h"
#include "dem/base/error.h"

namespace granrad {

namespace {

constexpr double most_parts = 1e5;
constexpr double straight =
    0.1;  ///< of the limit: steps so short are right to 0.2 % with the heats of their start
constexpr double rounding = 1e-12;  // a part must not be longer than the limit

std::int64_t parts_of(double dt_s, double limit_s) {
  if (dt_s <= limit_s) return 1;
  const double parts = std::ceil(dt_s / limit_s * (1 + rounding));
  if (parts > most_parts)
    throw NumericalError(advised(
        fmt::format("a heat step of {:.4g} s would take {:.3g} conduction steps of {:.4g} s", dt_s, parts,
                    limit_s),
        "shorten it: conduction.every_steps in a moving bed, output.every_s in a frozen one; or leave out the smallest "
        "particles"));
  return static_cast<std::int64_t>(parts);
}

void add_wall_heats(const Bed& bed, const Conductances& conductances, double dt_s,
                    const std::vector<double>& from_K, std::vector<HeatPaths>& given_J) {
  for (const auto& g : conductances.walls) {
    const double heat_K_s = (bed.walls[g.wall].temperature_K - from_K[g.i]) * dt_s;
    given_J[g.wall].solid += g.solid_W_K * heat_K_s;
    given_J[g.wall].gas += g.gas_W_K * heat_K_s;
  }
}

}  // namespace

HeatPaths advance_in_parts(Bed& bed, const Conductances& conductances, double dt_s,
                           std::vector<HeatPaths>& from_walls_J) {
  const double limit_s = conduction_step_limit_s(bed, conductances);
  const std::int64_t parts = parts_of(dt_s, limit_s);
  const double part_s = dt_s / static_cast<double>(parts);
  const bool by_middle = part_s > straight * limit_s;
  from_walls_J.assign(bed.walls.size(), {});
  PathSums sums;
  for (std::int64_t k = 0; k < parts; ++k) {
    const auto from_K = by_middle ? mid_step_temperatures_K(bed, conductances, part_s) : bed.temperature_K;
    add_wall_heats(bed, conductances, part_s, from_K, from_walls_J);
    sums.add(advance_temperatures(bed, conductances, part_s, from_K));
  }
  return sums.values();
}

}  // namespace granrad
