// Requirement: spheres in bulk behave as in LIGGGHTS on the same scene and as old experiments say: the walls of a column
// carry most of its weight (Janssen 1895), and what stays on a ledge lies at its angle of repose. Both are for the
// validation book (data/studies/validation.toml); chaos makes single heaps differ, so each is the mean of several, and
// the bands are three standard errors of what was compared.
// Planted: friction of walls left out in the native engine (the column's walls carry nothing); rolling started at twice the spin.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "dem/base/constants.h"
#include "dem/engine_liggghts.h"
#include "dem/engine_native.h"
#include "dem/feed/feed.h"
#include "dem/scene/scene.h"
#include "tests/record.h"
#include "tests/scene_text.h"

namespace granrad {
namespace {

constexpr double d = 0.8e-3, step_s = 1e-5, g = 9.81;
enum class By { native, liggghts };

const std::string head = R"(
[scene]
end_time_s = 1
gravity_m_s2 = [0, 0, -9.81]
)" + scene_text::alumina +
                         R"([particles]
diameter_m = 0.8e-3
[radiation]
source = "none"
)";

/// A column of 5 x 5 mm. Walls that creep upwards rouse their friction everywhere, as Janssen takes it.
std::string column(int seed, int spheres, bool creeping) {
  std::string walls;
  for (const char* face : {"x_min", "x_max", "y_min", "y_max"})
    walls += std::string(face) + " = {role = \"adiabatic\"" +
             (creeping ? ", velocity_m_s = [0, 0, 0.002]}\n" : "}\n");
  return head + R"([box]
size_m = [5e-3, 5e-3, 80e-3]
[walls]
z_min = {role = "adiabatic"}
z_max = {role = "adiabatic", contact = false}
)" + walls +
         R"([feed]
kind = "hopper"
velocity_m_s = 0.1
remove_below_m = -1e-3
seed = )" +
         std::to_string(seed) + "\nparticle_count = " + std::to_string(spheres) + R"(
[feed.fill_region]
min_m = [0, 0, 0]
max_m = [5e-3, 5e-3, 80e-3]
)";
}

/// A ledge of 16 mm, periodic across, behind a gate.
std::string ledge(int seed) {
  return head + R"([box]
origin_m = [0, 0, -2e-3]
size_m = [24e-3, 4e-3, 22e-3]
periodic = ["y"]
[walls]
x_min = {role = "adiabatic"}
x_max = {role = "adiabatic", contact = false}
z_min = {role = "adiabatic", contact = false}
z_max = {role = "adiabatic", contact = false}
[[polygon]]
name = "ledge"
vertices_m = [[0, -1e-3, 0], [16e-3, -1e-3, 0], [16e-3, 5e-3, 0], [0, 5e-3, 0]]
role = "adiabatic"
[[polygon]]
name = "gate"
vertices_m = [[16e-3, -1e-3, -1e-3], [16e-3, 5e-3, -1e-3], [16e-3, 5e-3, 20e-3], [16e-3, -1e-3, 20e-3]]
role = "adiabatic"
opens_at_s = 0.15
[[remove]]
below_m = {axis = "z", value = -1e-3}
[feed]
kind = "hopper"
velocity_m_s = 0.1
particle_count = 1100
remove_below_m = -1e-3
seed = )" +
         std::to_string(seed) + R"(
[feed.fill_region]
min_m = [0, 0, 0]
max_m = [16e-3, 4e-3, 20e-3]
)";
}

/// Load on the floor z = 0 over the weight, by Hertz' law from the overlaps.
double floor_share(const Bed& bed) {
  const Material& m = bed.materials[0];
  const double modulus = m.youngs_modulus_Pa / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
  double load = 0, weight = 0;
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const double overlap = bed.radius_m[i] - bed.position_m[i].z;
    if (overlap > 0) load += 4.0 / 3 * modulus * std::sqrt(bed.radius_m[i]) * std::pow(overlap, 1.5);
    weight += mass_kg(bed, i) * g;
  }
  return load / weight;
}

/// Slope of the free surface: highest spheres of slices one diameter wide, by least squares, degrees. The two at the
/// wall and the two at the edge are left out.
double slope_deg(const Bed& bed) {
  std::vector<double> top(20, 0);
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const auto k = static_cast<std::size_t>(std::clamp(bed.position_m[i].x / d, 0.0, 19.0));
    top[k] = std::max(top[k], bed.position_m[i].z);
  }
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = 2; k < 18; ++k) {
    const double at = static_cast<double>(k) * d;
    n += 1, x += at, y += top[k], xx += at * at, xy += at * top[k];
  }
  return -std::atan((n * xy - x * y) / (n * xx - x * x)) * 180 / pi;
}

/// Fills, goes on without what the feed would give back, and averages `measure` over the last tenth of a second.
template <class Measure>
double run(const std::string& text, double until_s, By by, Measure measure) {
  auto document = TomlDocument::from_string(text, "bulk.toml");
  const Scene scene = read_scene(document);
  document.finish();
  Feed feed(scene);
  Bed bed = initial_bed(scene);
  feed.start(bed);
  const auto engine = by == By::native ? make_native_engine(bed, scene.gravity_m_s2, step_s, 1)
                                       : make_liggghts_engine(scene.gravity_m_s2, step_s);
  double sum = 0, samples = 0;
  while (bed.time_s < until_s - 0.5 * step_s) {
    engine->advance(bed, (static_cast<double>(bed.step + 100) - 0.5) * step_s);
    std::vector<char> keep(bed.size());
    for (std::size_t i = 0; i < bed.size(); ++i) keep[i] = bed.position_m[i].z > -1e-3;
    if (std::count(keep.begin(), keep.end(), 0) > 0) bed.remove_unless(keep);
    if (bed.time_s > until_s - 0.1) sum += measure(bed), samples += 1;
  }
  return sum / samples;
}

constexpr int seeds = 4;

struct Mean {
  double value = 0, error = 0;
};

/// Of single beds, seed by seed.
Mean mean_of(const std::function<double(int)>& one) {
  double sum = 0, squares = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const double value = one(seed);
    sum += value, squares += value * value;
  }
  return {sum / seeds, std::sqrt(std::max(0.0, squares / seeds - sum * sum / (seeds * seeds)) / (seeds - 1))};
}

Mean ratio(const Mean& a, const Mean& b) {
  return {a.value / b.value, a.value / b.value * std::hypot(a.error / a.value, b.error / b.value)};
}

void report(const char* name, const Mean& mean) {
  std::printf("%s %.4f +- %.4f\n", name, mean.value, mean.error);
  record(name, mean.value, mean.error);
}

double floor_of(int seed, int spheres, bool creeping, By by) {
  return run(column(seed, spheres, creeping), 0.3, by, floor_share);
}

/// share(h) = (1 - exp(-h / l)) l / h: the share of a column three times as deep as one with `shallow`.
double janssen(double shallow) {
  double low = 0.01, high = 100;  // of l over the height of the shallow column
  for (int n = 0; n < 60; ++n) {
    const double l = std::sqrt(low * high);
    (l * (1 - std::exp(-1 / l)) < shallow ? low : high) = l;
  }
  return low / 3 * (1 - std::exp(-3 / low));
}

TEST(BulkFlow, FloorOfAColumnAsInLiggghtsLong) {
  const Mean native = mean_of([](int seed) { return floor_of(seed, 1500, false, By::native); });
  const Mean peer = mean_of([](int seed) { return floor_of(seed, 1500, false, By::liggghts); });
  const Mean both = ratio(native, peer);
  report("floor_share_over_liggghts", both);
  EXPECT_NEAR(both.value, 1, 3 * both.error);
}

TEST(BulkFlow, WallsOfAColumnCarryItsWeightLong) {
  const auto over = [](int seed) {
    const double deep = floor_of(seed, 1500, true, By::native);
    EXPECT_LT(deep, 0.3) << "the walls carry";
    return deep / janssen(floor_of(seed, 500, true, By::native));
  };
  const Mean both = mean_of(over);
  report("floor_share_over_janssen", both);
  EXPECT_NEAR(both.value, 1, 0.1) << "his law is of a continuum, the column 6 spheres wide";
}

TEST(BulkFlow, HeapsLieAtTheirAngleOfReposeLong) {
  const Mean native = mean_of([](int seed) { return run(ledge(seed), 0.6, By::native, slope_deg); });
  const Mean peer = mean_of([](int seed) { return run(ledge(seed), 0.6, By::liggghts, slope_deg); });
  report("repose_deg", native);
  report("repose_over_liggghts", ratio(native, peer));
  EXPECT_GT(native.value, 5) << "a heap is left";
  EXPECT_NEAR(native.value, peer.value, 3 * std::hypot(native.error, peer.error));
}

}  // namespace
}  // namespace granrad
