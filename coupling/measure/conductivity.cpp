#include "coupling/measure/conductivity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "dem/bed/near_pairs.h"

namespace granrad {

namespace {

/// The bed with the two walls across the axis as plates and all others adiabatic.
Bed between_plates(Bed bed, int axis) {
  std::vector<std::string> problems;
  for (Wall& wall : bed.walls) {
    const bool plate = wall.name.size() == 5 && wall.name.front() == "xyz"[axis] && wall.name[1] == '_';
    if (!plate && (wall.role == WallRole::open || wall.role == WallRole::excluded))
      problems.push_back(
          fmt::format("wall {} is {}; between two plates the others must be adiabatic or periodic", wall.name,
                      to_string(wall.role)));
    wall.role = plate ? WallRole::isothermal : WallRole::adiabatic;
  }
  if (!problems.empty()) throw InputError(problems);
  return bed;
}

/// Links of each path: solid, gas, radiation (exchange areas, m^2).
using Paths = std::array<std::vector<Link>, 3>;

void add_conduction(const Bed& bed, const Slab& slab, const ConductionSettings& settings, Paths& paths) {
  if (!settings.solid && !settings.gas) return;
  const double largest = *std::max_element(bed.radius_m.begin(), bed.radius_m.end());
  const auto found = conductances(bed, near_pairs(bed, lens_cutoff_gap_m(settings, largest)), settings);
  std::vector<std::int32_t> node(bed.size(), -1);
  for (std::size_t k = 0; k < slab.spheres(); ++k)
    node[slab.enclosure.particle[k]] = static_cast<std::int32_t>(k);
  const auto n = static_cast<std::int32_t>(slab.spheres());
  const auto add = [&](std::int32_t a, std::int32_t b, double solid, double gas) {
    if (a < 0 || b < 0) return;
    if (solid > 0) paths[0].push_back({a, b, solid});
    if (gas > 0) paths[1].push_back({a, b, gas});
  };
  for (const auto& p : found.particles) add(node[p.i], node[p.j], p.solid_W_K, p.gas_W_K);
  for (const auto& w : found.walls)
    for (int side = 0; side < 2; ++side)
      if (w.wall == slab.enclosure.wall[slab.plate[side] - n])
        add(node[w.i], n + side, w.solid_W_K, w.gas_W_K);
}

/// By surface number; 0 reflects everything: adiabatic walls.
std::vector<double> emissivities(const Bed& bed, const Slab& slab) {
  std::vector<double> emissivity(slab.enclosure.surface_count(), 0.0);
  for (std::size_t k = 0; k < slab.spheres(); ++k)
    emissivity[k] = bed.materials.at(slab.enclosure.material[k]).emissivity;
  for (const auto plate : slab.plate)
    emissivity[plate] = slab.enclosure.walls[plate - slab.spheres()].emissivity;
  return emissivity;
}

/// One replicate of the rays.
struct Replicate {
  std::array<double, 3> k{};
  double total = 0, overall = 0, hot_resistance = 0, cold_resistance = 0, bed_error = 0;
  SlabRadiation radiation;
};

/// Whether links lead from plate to plate: a heap that touches its floor alone has no conductivity between plates.
bool joins_plates(const Slab& slab, const Paths& paths) {
  std::vector<std::size_t> root(slab.spheres() + 2);
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t k) {
    while (root[k] != k) k = root[k] = root[root[k]];
    return k;
  };
  for (const auto& links : paths)
    for (const Link& link : links)
      root[find(static_cast<std::size_t>(link.a))] = find(static_cast<std::size_t>(link.b));
  return find(slab.spheres()) == find(slab.spheres() + 1);
}

void layer_means(const Slab& slab, const std::vector<double>& u, ConductivityResult& result) {
  const auto layers =
      static_cast<std::size_t>(std::max(1.0, std::round(slab.distance_m() / (0.5 * slab.diameter_m))));
  const double thickness = slab.distance_m() / static_cast<double>(layers);
  std::vector<double> sum(layers, 0.0), count(layers, 0.0);
  for (std::size_t k = 0; k < slab.spheres(); ++k) {
    if (!std::isfinite(u[k])) continue;
    const auto at = std::clamp(static_cast<long>((slab.z_m[k] - slab.low_m) / thickness), 0L,
                               static_cast<long>(layers) - 1);
    sum[at] += u[k];
    count[at] += 1;
  }
  result.layer_m.clear();
  result.layer_temperature.clear();
  for (std::size_t k = 0; k < layers; ++k) {
    if (count[k] == 0) continue;
    result.layer_m.push_back((static_cast<double>(k) + 0.5) * thickness);
    result.layer_temperature.push_back(sum[k] / count[k]);
  }
}

Replicate evaluate(const Slab& slab, const Paths& paths, double radiation_W_m2K, ConductivityResult& result) {
  std::vector<Link> all;
  for (int path = 0; path < 3; ++path)
    for (Link link : paths[path]) {
      if (path == 2) link.conductance *= radiation_W_m2K;
      all.push_back(link);
    }
  const auto u = slab_potentials(slab, all);
  const BulkLine line = bulk_line(slab, u);
  Replicate r;
  for (int path = 0; path < 3; ++path)
    r.k[path] = (path == 2 ? radiation_W_m2K : 1) * flux(slab, paths[path], u, slab.from_m(), slab.to_m()) /
                -line.slope_per_m;
  r.total = r.k[0] + r.k[1] + r.k[2];
  const double q = flux(slab, all, u, slab.low_m, slab.high_m);
  r.overall = q * slab.distance_m();
  r.hot_resistance = (1 - line.at_low) / q;
  r.cold_resistance = line.at_high / q;
  r.bed_error = std::abs(line.slope_error_per_m / line.slope_per_m);
  if (!paths[2].empty()) r.radiation = radiation_between_plates(slab, paths[2]);
  result.line_at_hot = line.at_low;
  result.line_at_cold = line.at_high;
  result.isolated =
      static_cast<std::size_t>(std::count_if(u.begin(), u.end(), [](double x) { return !std::isfinite(x); }));
  layer_means(slab, u, result);
  return r;
}

/// Mean over replicates; error: their scatter, and `relative` of the value for the bed.
template <class Get>
Estimate mean(const std::vector<Replicate>& all, Get get, double relative) {
  Estimate e;
  const auto n = static_cast<double>(all.size());
  for (const auto& r : all) e.value += get(r) / n;
  double squares = 0;
  for (const auto& r : all) squares += std::pow(get(r) - e.value, 2);
  e.error = std::hypot(n > 1 ? std::sqrt(squares / (n * (n - 1))) : 0, relative * e.value);
  return e;
}

void summarise(const std::vector<Replicate>& all, ConductivityResult& result) {
  double bed = 0, factor_bed = 0;
  for (const auto& r : all) {
    bed += r.bed_error / static_cast<double>(all.size());
    factor_bed += r.radiation.factor_bed_error / static_cast<double>(all.size());
  }
  result.total = mean(
      all, [](const auto& r) { return r.total; }, bed);
  result.solid = mean(
      all, [](const auto& r) { return r.k[0]; }, bed);
  result.gas = mean(
      all, [](const auto& r) { return r.k[1]; }, bed);
  result.radiation = mean(
      all, [](const auto& r) { return r.k[2]; }, bed);
  result.overall = mean(
      all, [](const auto& r) { return r.overall; }, 0);
  result.wall_resistance_m2K_W = mean(
      all, [](const auto& r) { return 0.5 * (r.hot_resistance + r.cold_resistance); }, 0);
  result.hot_resistance_m2K_W = mean(
      all, [](const auto& r) { return r.hot_resistance; }, 0);
  result.cold_resistance_m2K_W = mean(
      all, [](const auto& r) { return r.cold_resistance; }, 0);
  result.exchange_factor = mean(
      all, [](const auto& r) { return r.radiation.exchange_factor; }, factor_bed);
  result.radiative_flux = mean(
      all, [](const auto& r) { return r.radiation.flux; }, 0);
}

}  // namespace

ConductivityResult measure_conductivity(const Bed& given, const ConductionSettings& settings,
                                        const ConductivityRequest& request) {
  const Bed bed = between_plates(given, request.axis);
  const Slab slab = make_slab(make_enclosure(bed, bed.box), request.axis);
  ConductivityResult result;
  result.particles = slab.spheres();
  result.temperature_K = request.temperature_K;
  result.diameter_m = slab.diameter_m;
  result.distance_m = slab.distance_m();
  result.solid_fraction = slab.solid_fraction();
  Paths paths;
  add_conduction(bed, slab, settings, paths);
  if (!request.radiation && paths[0].empty() && paths[1].empty())
    throw InputError(advised("nothing conducts between these particles", "add [gas], contacts or radiation"));
  const auto emissivity = emissivities(bed, slab);
  const double radiation_W_m2K = 4 * stefan_boltzmann * std::pow(request.temperature_K, 3);
  std::vector<Replicate> all;
  for (int k = 0; k < (request.radiation ? request.replicates : 1); ++k) {
    TraceOptions options;
    options.rays_per_particle = request.rays_per_particle;
    options.seed = request.seed + 7919 * static_cast<std::uint64_t>(k);
    options.threads = request.threads;
    if (request.radiation) paths[2] = radiation_links(slab, emissivity, options, result.rays);
    all.push_back(evaluate(slab, paths, radiation_W_m2K, result));
    if (result.isolated == result.particles)
      throw InputError(
          advised("no particle touches a plate, or exchanges heat with one",
                  "set contact = true for the plates (the ends of a plug do not touch by themselves), or "
                  "add [radiation]"));
    if (!joins_plates(slab, paths))
      throw InputError(advised("no heat passes from plate to plate: the bed does not reach both",
                               "move a plate to the bed (box.size_m), or add [gas] or [radiation]"));
  }
  summarise(all, result);
  return result;
}

}  // namespace granrad
