// Requirement: a second spectral band is a loop around a source. The loop stands here; a program would add its keys and
// its maker where the other sources have theirs.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "coupling/heat/radiosity_source.h"
#include "raytrace/rays/view_factors.h"
#include "tests/path_cases.h"

namespace granrad {
namespace {

/// Share of black emission below a wavelength: 15 / pi^4 of the sum over n of e^-nx (x^3 + 3 x^2/n + 6 x/n^2 + 6/n^3) / n
/// with x = c2 / (lambda T) (M. F. Modest, Radiative Heat Transfer, fractional function).
double share_below(double wavelength_m, double temperature_K) {
  constexpr double c2_m_K = 0.014387768775;
  const double x = c2_m_K / (wavelength_m * temperature_K);
  double sum = 0;
  for (int n = 1; n * x < 700 && n < 1000; ++n)
    sum += std::exp(-n * x) / n * (x * x * x + 3 * x * x / n + 6 * x / (n * n) + 6 / std::pow(n, 3));
  return 15 / std::pow(pi, 4) * sum;
}

/// Spheres have an emissivity below and one above the edge, by material; walls are as their state says.
class Banded final : public ExchangeSource {
 public:
  Banded(std::unique_ptr<ExchangeSource> grey, double edge_m, std::vector<std::array<double, 2>> emissivity)
      : grey_(std::move(grey)), edge_m_(edge_m), emissivity_(std::move(emissivity)) {}

  RadiativeHeat net_heat(const Enclosure& enclosure, const RadiativeState& state,
                         std::uint64_t update) override {
    RadiativeHeat sum;
    for (const std::size_t band : {0u, 1u}) {
      RadiativeState of_band = state;
      for (std::size_t s = 0; s < enclosure.material.size(); ++s)
        of_band.emissivity[s] = emissivity_.at(enclosure.material[s])[band];
      for (double& power : of_band.emissive_power_W_m2) {
        const double below = share_below(edge_m_, std::pow(power / stefan_boltzmann, 0.25));
        power *= band == 0 ? below : 1 - below;
      }
      RadiativeHeat heat = grey_->net_heat(enclosure, of_band, 2 * update + band);
      for (std::size_t s = 0; s < sum.heat_W.size(); ++s) heat.heat_W[s] += sum.heat_W[s];
      sum = std::move(heat);
    }
    return sum;
  }

 private:
  std::unique_ptr<ExchangeSource> grey_;
  double edge_m_;
  std::vector<std::array<double, 2>> emissivity_;
};

std::unique_ptr<ExchangeSource> paths() {
  PathOptions options;
  options.walks = 20000;
  options.threads = 1;
  return std::make_unique<PathSource>(options);
}

std::unique_ptr<ExchangeSource> embree() {
  return std::make_unique<RadiositySource>(
      RadiositySource::Estimate([](const Enclosure& enclosure, std::uint64_t update) {
        TraceOptions options;
        options.rays_per_particle = 20000;
        options.seed = 1 + update;
        options.threads = 1;
        const HitCounts counts = trace_view_factors(enclosure, options);
        return ExchangeEstimate(one_way_estimate(counts), replicate_samples(counts), counts.leaked);
      }),
      Closure::reciprocal);
}

TEST(SpectralBands, SharesOfBlackEmissionAreTheTables) {
  EXPECT_NEAR(share_below(2898e-6 / 1000, 1000), 0.25006, 2e-4);  // at Wien's maximum a quarter
  EXPECT_NEAR(share_below(4107e-6 / 1000, 1000), 0.5, 2e-4);      // half
}

/// Two spheres of two materials in a black room, one far from the other: Q = A sum over the bands of eps (E_room - E), less
/// what the other takes of the view (1e-4 of it). Planted: the bands' emissivities exchanged.
TEST(SpectralBands, SelectiveSphereInABlackRoomGetsTheHeatOfItsBands) {
  constexpr double edge_m = 3e-6, room_K = 1500, sphere_K = 400, radius = 1e-3;
  path_cases::Case c;
  c.add_box({{0, 0, 0}, {0.2, 0.2, 0.2}}, WallRole::isothermal, room_K, 1);
  c.add_sphere({0.05, 0.1, 0.1}, radius, sphere_K, 1);
  c.add_sphere({0.15, 0.1, 0.1}, radius, sphere_K, 1);
  c.enclosure.material = {0, 1};
  const std::vector<std::array<double, 2>> emissivity = {{0.9, 0.1}, {0.2, 0.7}};
  for (auto make : {paths, embree}) {
    Banded source(make(), edge_m, emissivity);
    const RadiativeHeat heat = source.net_heat(c.enclosure, c.state(), 3);
    for (const std::size_t s : {0u, 1u}) {
      double expected = 0;
      for (const std::size_t band : {0u, 1u}) {
        const auto exitance = [&](double t) {
          const double below = share_below(edge_m, t);
          return emissive_power(t) * (band == 0 ? below : 1 - below);
        };
        expected += emissivity[s][band] * (exitance(room_K) - exitance(sphere_K));
      }
      expected *= 4 * pi * radius * radius;
      EXPECT_NEAR(heat.heat_W[s], expected, 0.01 * expected) << s;
    }
  }
}

/// Bands of equal emissivity are grey exchange, adiabatic walls among them.
TEST(SpectralBands, EqualBandsAreGrey) {
  path_cases::Case c;
  c.add_box({{0, 0, 0}, {0.004, 0.004, 0.004}}, WallRole::adiabatic, 300, 0);
  c.wall(0).role = WallRole::isothermal, c.wall(0).temperature_K = 1200, c.wall(0).emissivity = 0.8;
  for (const double x : {1e-3, 2e-3, 3e-3}) c.add_sphere({x, 2e-3, 2e-3}, 4e-4, 300 + 1e5 * x, 0.4);
  c.enclosure.material = {0, 0, 0};
  const RadiativeHeat grey = embree()->net_heat(c.enclosure, c.state(), 0);
  Banded source(embree(), 4e-6, {{0.4, 0.4}});
  const RadiativeHeat banded = source.net_heat(c.enclosure, c.state(), 0);
  for (std::size_t s = 0; s < 3; ++s)
    EXPECT_NEAR(banded.heat_W[s], grey.heat_W[s], 0.02 * std::abs(grey.heat_W[s])) << s;
}

}  // namespace
}  // namespace granrad
