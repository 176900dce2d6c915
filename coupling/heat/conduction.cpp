#include "coupling/heat/conduction.h"

#include <fmt/format.h>

#include <algorithm>

#include "coupling/heat/contact_conductance.h"
#include "coupling/heat/gas_lens.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"

namespace granrad {

double lens_cutoff_gap_m(const ConductionSettings& settings, double max_radius_m) {
  return settings.gas ? (settings.gas->lens_radius_ratio - 1) * max_radius_m : 0;
}

namespace {

void require_contact_properties(const std::vector<Material>& materials) {
  std::vector<std::string> problems;
  for (const auto& m : materials) {
    const auto need = [&](const char* what, double value) {
      if (!(value > 0))
        problems.push_back(fmt::format("{}.{} = {} (must be positive for conduction through contacts)",
                                       m.name, what, value));
    };
    need("conductivity_W_mK", m.conductivity_W_mK);
    need("youngs_modulus_Pa", m.youngs_modulus_Pa);
    need("real_youngs_modulus_Pa", m.real_youngs_modulus_Pa);
  }
  if (!problems.empty()) throw InputError(problems);
}

/// Contact conductivities of every two materials, W/(m K).
class ContactTable {
 public:
  ContactTable(const std::vector<Material>& materials, const ConductionSettings& settings)
      : count_(materials.size()), value_(count_ * count_, 0.0) {
    if (!settings.solid) return;
    require_contact_properties(materials);
    for (std::size_t a = 0; a < count_; ++a)
      for (std::size_t b = 0; b < count_; ++b)
        value_[a * count_ + b] =
            contact_conductivity_W_mK(materials[a], materials[b], settings.modulus_exponent);
  }
  double operator()(std::int32_t a, std::int32_t b) const { return value_[a * count_ + b]; }

 private:
  std::size_t count_;
  std::vector<double> value_;
};

double gas_conductance(const std::optional<GasLens>& gas, double ri, double rj, double distance) {
  if (!gas) return 0;
  if (ri != rj)
    return gas->conductivity_W_mK * lens_m(ri, rj, distance, gas->minimum_gap_m, gas->lens_radius_ratio);
  const double half_overlap = (ri - distance / 2) / ri, half_gap = gas->minimum_gap_m / (2 * ri);
  return gas->conductivity_W_mK * ri * pair_lens(half_overlap, half_gap, gas->lens_radius_ratio);
}

double gas_conductance_to_wall(const std::optional<GasLens>& gas, double radius, double distance) {
  if (!gas) return 0;
  return gas->conductivity_W_mK * radius *
         wall_lens((radius - distance) / radius, gas->minimum_gap_m / radius, gas->lens_radius_ratio);
}

/// Of softened spheres that carry a load at rest: the load from the flow's modulus and disc, the disc of the real one.
/// The lens that overlapping spheres cut out is twice Hertz's disc, a^2 = R delta.
double rough_conductance(const ConductionSettings& settings, const Material& a, const Material& b,
                         double radius, double area_m2) {
  if (!(area_m2 > 0)) return 0;
  const auto plane_strain = [](double ya, double na, double yb, double nb) {
    return 1 / ((1 - na * na) / ya + (1 - nb * nb) / yb);
  };
  const double soft =
      plane_strain(a.youngs_modulus_Pa, a.poisson_ratio, b.youngs_modulus_Pa, b.poisson_ratio);
  const double real =
      plane_strain(a.real_youngs_modulus_Pa, a.poisson_ratio, b.real_youngs_modulus_Pa, b.poisson_ratio);
  const double disc = std::sqrt(area_m2 / (2 * pi));
  const double k =
      2 * a.conductivity_W_mK * b.conductivity_W_mK / (a.conductivity_W_mK + b.conductivity_W_mK);
  return rough_contact_conductance(*settings.rough, k, settings.gas ? settings.gas->conductivity_W_mK : 0,
                                   hertz_force_N(soft, radius, disc), disc * std::cbrt(soft / real));
}

template <class Entry>
void drop_empty(std::vector<Entry>& entries) {
  std::erase_if(entries, [](const Entry& e) { return e.solid_W_K == 0 && e.gas_W_K == 0; });
}

/// The solid path of touches: into the entry of the same pair where there is one, else behind all.
template <class Inside>
void add_touches(const Bed& bed, const Touches& touches, const ContactTable& contact, Inside inside,
                 Conductances& result) {
  const auto solid = [&](std::int32_t i, std::int32_t j, double root_area_m) {
    return contact(bed.material[i], bed.material[j]) * root_area_m;
  };
  const std::size_t near = result.particles.size();
  std::size_t k = 0;
  for (const PairTouch& touch : touches.particles) {
    const std::int32_t i = touch.i, j = touch.j;
    if (!inside(i) || !inside(j)) continue;
    const auto before = [&](const PairConductance& g) { return g.i != i ? g.i < i : g.j < j; };
    while (k < near && before(result.particles[k])) ++k;
    if (k < near && result.particles[k].i == i && result.particles[k].j == j)
      result.particles[k].solid_W_K = solid(i, j, touch.root_area_m);
    else
      result.particles.push_back({i, j, solid(i, j, touch.root_area_m), 0});
  }
  for (const auto& [i, wall, root_area_m] : touches.walls)
    if (inside(i) && conducts(bed.walls[wall]))
      result.walls.push_back({i, wall, solid(i, i, root_area_m), 0});
  drop_empty(result.particles), drop_empty(result.walls);
}

}  // namespace

Conductances conductances(const Bed& bed, const NearPairs& pairs, const ConductionSettings& settings,
                          const std::vector<char>& in_region, const Touches* touches) {
  const ContactTable contact(bed.materials, settings);
  const bool solid = settings.solid && !touches;
  const auto inside = [&](std::int32_t i) { return in_region.empty() || in_region[i]; };

  Conductances result;
  result.particles.resize(pairs.particles.size());
#pragma omp parallel for schedule(static) if (pairs.particles.size() >= 1000)
  for (std::size_t k = 0; k < pairs.particles.size(); ++k) {
    const auto [i, j, distance] = pairs.particles[k];
    PairConductance& g = result.particles[k] = {i, j, 0, 0};
    if (!inside(i) || !inside(j)) continue;
    const double ri = bed.radius_m[i], rj = bed.radius_m[j];
    const double disc_m2 = solid ? contact_area_m2(ri, rj, distance) : 0;
    if (disc_m2 > 0)
      g.solid_W_K = settings.rough
                        ? rough_conductance(settings, bed.materials[bed.material[i]],
                                            bed.materials[bed.material[j]], ri * rj / (ri + rj), disc_m2)
                        : contact(bed.material[i], bed.material[j]) * std::sqrt(disc_m2);
    g.gas_W_K = gas_conductance(settings.gas, ri, rj, distance);
  }
  drop_empty(result.particles);

  result.walls.resize(pairs.walls.size());
  for (std::size_t k = 0; k < pairs.walls.size(); ++k) {
    const auto [i, wall, distance, gas_share] = pairs.walls[k];
    WallConductance& g = result.walls[k] = {i, wall, 0, 0};
    if (!inside(i) || !conducts(bed.walls[wall])) continue;
    const double r = bed.radius_m[i];
    const double disc_m2 = solid ? wall_contact_area_m2(r, distance) : 0;
    const Material& material = bed.materials[bed.material[i]];
    if (disc_m2 > 0)
      g.solid_W_K = settings.rough ? rough_conductance(settings, material, material, r, disc_m2)
                                   : contact(bed.material[i], bed.material[i]) * std::sqrt(disc_m2);
    g.gas_W_K = gas_share * gas_conductance_to_wall(settings.gas, r, distance);
  }
  drop_empty(result.walls);
  if (touches) add_touches(bed, *touches, contact, inside, result);
  return result;
}

}  // namespace granrad
