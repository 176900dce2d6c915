#include "coupling/heat/heat_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/heat/energy_ledger.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {

const std::vector<HeatPaths::Path>& HeatPaths::paths() {
  static const std::vector<Path> all{
      {"solid_J", &HeatPaths::solid}, {"gas_J", &HeatPaths::gas}, {"radiation_J", &HeatPaths::radiation}};
  return all;
}

double HeatPaths::total() const {
  double sum = 0;
  for (const Path& path : paths()) sum += this->*path.value;
  return sum;
}

double heat_capacity_J_K(const Bed& bed, std::size_t i) {
  return mass_kg(bed, i) * bed.materials[bed.material[i]].specific_heat_J_kgK;
}

namespace {

/// 4 eps sigma T^3 A, W/K.
double emission_slope(const Bed& bed, std::size_t i, double temperature_K) {
  const double area = 4 * pi * bed.radius_m[i] * bed.radius_m[i];
  return 4 * bed.materials[bed.material[i]].emissivity * emissive_power(temperature_K) / temperature_K * area;
}

/// Heat into every particle, W, and what walls give, with the particles at T.
HeatPaths collect_heats(const Bed& bed, const Conductances& conductances, const std::vector<double>& T,
                        std::vector<double>& heat_W) {
  add_conduction_W(bed, conductances, T, heat_W);
  CompensatedSum solid, gas, radiation;
  for (const auto& g : conductances.walls) {
    const double difference = bed.walls[g.wall].temperature_K - T[g.i];
    solid.add(g.solid_W_K * difference);
    gas.add(g.gas_W_K * difference);
  }
  for (std::size_t i = 0; i < bed.size(); ++i) {
    heat_W[i] += bed.radiative_heat_W[i];
    radiation.add(bed.radiative_heat_W[i]);
  }
  return {solid.value(), gas.value(), radiation.value()};
}

/// The parts of them by contacts and by gas, kept in the bed for those who look.
void keep_parts(Bed& bed, const Conductances& conductances, const std::vector<double>& T) {
  bed.solid_heat_W.assign(bed.size(), 0.0);
  bed.gas_heat_W.assign(bed.size(), 0.0);
  for (const auto& g : conductances.particles) {
    const double difference = T[g.j] - T[g.i];
    bed.solid_heat_W[g.i] += g.solid_W_K * difference;
    bed.solid_heat_W[g.j] -= g.solid_W_K * difference;
    bed.gas_heat_W[g.i] += g.gas_W_K * difference;
    bed.gas_heat_W[g.j] -= g.gas_W_K * difference;
  }
  for (const auto& g : conductances.walls) {
    const double difference = bed.walls[g.wall].temperature_K - T[g.i];
    bed.solid_heat_W[g.i] += g.solid_W_K * difference;
    bed.gas_heat_W[g.i] += g.gas_W_K * difference;
  }
}

}  // namespace

void add_conduction_W(const Bed& bed, const Conductances& conductances, const std::vector<double>& T,
                      std::vector<double>& heat_W) {
  for (const auto& g : conductances.particles) {
    const double q = (g.solid_W_K + g.gas_W_K) * (T[g.j] - T[g.i]);
    heat_W[g.i] += q;
    heat_W[g.j] -= q;
  }
  for (const auto& g : conductances.walls)
    heat_W[g.i] += (g.solid_W_K + g.gas_W_K) * (bed.walls[g.wall].temperature_K - T[g.i]);
}

double conduction_step_limit_s(const Bed& bed, const Conductances& conductances) {
  std::vector<double> sum(bed.size(), 0.0);
  for (const auto& g : conductances.particles) {
    sum[g.i] += g.solid_W_K + g.gas_W_K;
    sum[g.j] += g.solid_W_K + g.gas_W_K;
  }
  for (const auto& g : conductances.walls) sum[g.i] += g.solid_W_K + g.gas_W_K;
  double limit = infinity;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (sum[i] > 0) limit = std::min(limit, conduction_step_fraction * heat_capacity_J_K(bed, i) / sum[i]);
  return limit;
}

double radiation_time_constant_s(const Bed& bed, double hottest_K) {
  double hottest = hottest_K;
  for (double T : bed.temperature_K) hottest = std::max(hottest, T);
  for (const auto& wall : bed.walls)
    if (wall.role == WallRole::isothermal || wall.role == WallRole::open)
      hottest = std::max(hottest, wall.temperature_K);
  double shortest = infinity;
  for (std::size_t i = 0; i < bed.size(); ++i)
    shortest = std::min(shortest, heat_capacity_J_K(bed, i) / emission_slope(bed, i, hottest));
  return shortest;
}

std::vector<double> radiative_relaxation(const Bed& bed, const std::vector<double>& from_K, double hottest_K,
                                         double interval_s) {
  std::vector<double> k(bed.size());
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const double T = from_K[i], area = 4 * pi * bed.radius_m[i] * bed.radius_m[i];
    const double chord = stefan_boltzmann * (hottest_K * hottest_K + T * T) * (hottest_K + T);
    k[i] = bed.materials[bed.material[i]].emissivity * area * chord * interval_s / heat_capacity_J_K(bed, i);
  }
  return k;
}

std::vector<double> mid_step_temperatures_K(const Bed& bed, const Conductances& conductances, double dt_s) {
  std::vector<double> heat_W(bed.size(), 0.0), middle_K = bed.temperature_K;
  collect_heats(bed, conductances, bed.temperature_K, heat_W);
  for (std::size_t i = 0; i < bed.size(); ++i)
    middle_K[i] += 0.5 * dt_s * heat_W[i] / heat_capacity_J_K(bed, i);
  return middle_K;
}

HeatPaths advance_temperatures(Bed& bed, const Conductances& conductances, double dt_s) {
  return advance_temperatures(bed, conductances, dt_s, bed.temperature_K);
}

HeatPaths advance_temperatures(Bed& bed, const Conductances& conductances, double dt_s,
                               const std::vector<double>& from_K) {
  const double limit = conduction_step_limit_s(bed, conductances);
  if (dt_s > limit)
    throw NumericalError(advised(
        fmt::format("conduction step = {:.4g} s (dt sum(G)/(m c) beyond {})", dt_s, conduction_step_fraction),
        fmt::format("the largest allowed is {:.4g} s", limit)));
  std::vector<double> heat_W(bed.size(), 0.0);
  HeatPaths received = collect_heats(bed, conductances, from_K, heat_W);
  keep_parts(bed, conductances, from_K);
  for (std::size_t i = 0; i < bed.size(); ++i) {
    double& T = bed.temperature_K[i];
    T += dt_s * heat_W[i] / heat_capacity_J_K(bed, i);
    if (!(T > 0 && T < infinity))
      throw NumericalError(advised(
          fmt::format("temperature of particle {} = {} K after a heat step of {:.4g} s with {:.4g} W",
                      bed.id[i], T, dt_s, heat_W[i]),
          fmt::format(
              "shorten the radiation interval (time constant {:.4g} s)",
              heat_capacity_J_K(bed, i) / emission_slope(bed, i, std::max(1.0, bed.temperature_K[i])))));
  }
  for (const auto& path : HeatPaths::paths()) received.*path.value *= dt_s;
  return received;
}

std::vector<double> midway_temperatures_K(const Bed& bed, std::vector<double> conducted_K,
                                          double interval_s) {
  auto midway = std::move(conducted_K);
  for (std::size_t i = 0; i < bed.size(); ++i)
    midway[i] += bed.radiative_heat_W[i] * interval_s / (2 * heat_capacity_J_K(bed, i));
  return midway;
}

double thermal_energy_J(const Bed& bed) {
  CompensatedSum sum;
  for (std::size_t i = 0; i < bed.size(); ++i) sum.add(heat_capacity_J_K(bed, i) * bed.temperature_K[i]);
  return sum.value();
}

double mean_temperature_K(const Bed& bed, const std::vector<char>& in_region) {
  CompensatedSum sum;
  std::size_t count = 0;
  for (std::size_t i = 0; i < bed.size(); ++i)
    if (in_region.empty() || in_region[i]) sum.add(bed.temperature_K[i]), ++count;
  return count ? sum.value() / count : 0;
}

}  // namespace granrad
