// Requirement: contacts conduct by 2 k sqrt(A) (Y/Y_real)^p, temperatures follow the same explicit scheme as
// LIGGGHTS to 1e-6, and a step that is too long is refused with the largest allowed.
// Planted, seen to fail: A without the factor 1/4 (five tests); heat given to one end only (conservation and
// LIGGGHTS).
#include "coupling/heat/conduction.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "coupling/heat/contact_conductance.h"
#include "coupling/heat/gas_lens.h"
#include "coupling/heat/heat_parts.h"
#include "coupling/heat/heat_step.h"
#include "dem/base/constants.h"
#include "dem/base/error.h"
#include "tests/alumina.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

constexpr double radius = 4e-4;

Bed pair_at(double distance, double second_radius = radius) {
  Bed bed;
  bed.materials = {alumina()};
  bed.add({0, 0, 0}, {}, radius, 300);
  bed.add({distance, 0, 0}, {}, second_radius, 1000);
  return bed;
}

NearPairs touching(double distance) {
  return {{{0, 1, distance}}, {}};
}

TEST(Conduction, OfAContactIsTheFormula) {
  const double d = 2 * radius, distance = d - 5e-6;
  const auto g = conductances(pair_at(distance), touching(distance), {});
  ASSERT_EQ(g.particles.size(), 1u);
  const double area = pi / 4 * (d + distance) * (d - distance);
  EXPECT_NEAR(g.particles[0].solid_W_K / (2 * 33 * std::sqrt(area) * std::pow(5e6 / 414e9, 0.2)), 1, 1e-12);
  EXPECT_EQ(g.particles[0].gas_W_K, 0);
}

TEST(Conduction, AreaOfUnequalSpheresIsTheDiscOfTheirLens) {
  const double a = 4e-4, b = 1e-4, distance = 4.9e-4;
  const double x = (distance * distance + a * a - b * b) / (2 * distance);
  EXPECT_NEAR(contact_area_m2(a, b, distance) / (pi * (a * a - x * x)), 1, 1e-12);
  EXPECT_EQ(contact_area_m2(a, b, a + b), 0);
  EXPECT_NEAR(wall_contact_area_m2(a, 3.9e-4) / (pi * (a * a - 3.9e-4 * 3.9e-4)), 1, 1e-12);
}

TEST(Conduction, OfTwoMaterialsUsesHarmonicMeanAndModuliInSeries) {
  Material a = alumina(), b = alumina();
  b.conductivity_W_mK = 1;
  EXPECT_DOUBLE_EQ(contact_conductivity_W_mK(a, b, 0), 2 * (2 * 33.0 * 1 / 34.0));
  EXPECT_NEAR(contact_conductivity_W_mK(a, a, 0.2) / (66 * std::pow(5e6 / 414e9, 0.2)), 1, 1e-13);
  EXPECT_NEAR(contact_conductivity_W_mK(a, a, 0.2) / contact_conductivity_W_mK(a, a, 1.0 / 3), 4.5, 0.05)
      << "1/5 overstates conduction at rest 4.5 times";
}

struct Record {
  double time_s, temperature_K[2], heat_W;
};

std::vector<Record> liggghts(const std::string& name) {
  std::ifstream in(granrad::source_dir() + "/data/reference/liggghts/" + name);
  std::vector<Record> records;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 't') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    double t, x, y, z, temperature, heat;
    int id;
    fields >> t >> id >> x >> y >> z >> temperature >> heat;
    if (id == 1) records.push_back({t, {temperature, 0}, heat});
    if (id == 2) records.back().temperature_K[1] = temperature;
  }
  return records;
}

/// Advances with the deck's step of 1e-5 s and compares every record.
void compare_with_liggghts(const std::string& name, double distance, double exponent) {
  const auto records = liggghts(name);
  ASSERT_EQ(records.size(), 201u);
  Bed bed = pair_at(distance);
  ConductionSettings settings;
  settings.modulus_exponent = exponent;
  const auto g = conductances(bed, touching(distance), settings);
  for (std::size_t k = 1; k < records.size(); ++k) {
    for (int step = 0; step < 100; ++step) advance_temperatures(bed, g, 1e-5);
    for (int i = 0; i < 2; ++i)
      ASSERT_NEAR(bed.temperature_K[i] / records[k].temperature_K[i], 1, 1e-6) << "t " << records[k].time_s;
  }
}

TEST(Conduction, TemperaturesFollowLiggghts) {
  compare_with_liggghts("cond2_corr_no.csv", 7.95e-4, 0);
}

// With area_correction LIGGGHTS shrinks the overlap itself by (Y/Y_real)^(2/3) and takes the lens of that:
// our p = 1/3 to first order in overlap/d. The corrected overlap gives its temperatures to 1e-6; the formula
// of the paper, which corrects the conductance, differs by sqrt((2d - overlap)/(2d - corrected overlap)).
TEST(Conduction, TemperaturesFollowLiggghtsWithTheCorrectedOverlap) {
  const double corrected = 5e-6 * std::pow(5e6 / 414e9, 2.0 / 3);
  compare_with_liggghts("cond2_corr_yes.csv", 8e-4 - corrected, 0);
}

TEST(Conduction, ModulusExponentOneThirdIsTheAreaCorrectionOfLiggghts) {
  ConductionSettings settings;
  settings.modulus_exponent = 1.0 / 3;
  const auto g = conductances(pair_at(7.95e-4), touching(7.95e-4), settings);
  const auto first = liggghts("cond2_corr_yes.csv").at(1);
  const double theirs = first.heat_W / (first.temperature_K[1] - first.temperature_K[0]);
  const double corrected = 5e-6 * std::pow(5e6 / 414e9, 2.0 / 3);
  const double known = std::sqrt((1.6e-3 - 5e-6) / (1.6e-3 - corrected));
  EXPECT_NEAR(g.particles[0].solid_W_K / theirs, known, 1e-5);
}

// Planted, seen to fail: heats of the second particle added, not taken.
TEST(Conduction, HeatsByPathAreWhatMovesTheTemperature) {
  Bed bed = pair_at(7.95e-4);
  Wall wall;
  wall.temperature_K = 700;
  bed.walls = {wall};
  bed.radiative_heat_W = {3e-3, -1e-3};
  const Conductances g{{{0, 1, 2e-5, 5e-6}}, {{0, 0, 1e-5, 3e-5}}};
  const auto before = bed.temperature_K;
  constexpr double dt_s = 1e-4;
  advance_temperatures(bed, g, dt_s);
  EXPECT_DOUBLE_EQ(bed.solid_heat_W[0], 2e-5 * 700 + 1e-5 * 400);
  EXPECT_DOUBLE_EQ(bed.gas_heat_W[0], 5e-6 * 700 + 3e-5 * 400);
  EXPECT_DOUBLE_EQ(bed.solid_heat_W[1], -2e-5 * 700);
  EXPECT_DOUBLE_EQ(bed.gas_heat_W[1], -5e-6 * 700);
  for (std::size_t i = 0; i < 2; ++i) {
    const double received = heat_capacity_J_K(bed, i) * (bed.temperature_K[i] - before[i]) / dt_s;
    EXPECT_NEAR((bed.solid_heat_W[i] + bed.gas_heat_W[i] + bed.radiative_heat_W[i]) / received, 1, 1e-8);
  }
}

TEST(Conduction, ConservesEnergyToRoundOff) {
  Bed bed = pair_at(7.95e-4, 3.9e-4);
  const auto g = conductances(bed, touching(7.85e-4), {});
  const double before = thermal_energy_J(bed);
  for (int k = 0; k < 20000; ++k) advance_temperatures(bed, g, 2e-5);
  EXPECT_NEAR(thermal_energy_J(bed) / before, 1, 1e-13);
  EXPECT_GT(bed.temperature_K[0], 400) << "it must have exchanged heat at all";
}

Bed on_walls() {
  Bed bed;
  bed.materials = {alumina()};
  bed.box = {{0, 0, 0}, {0.01, 0.01, 0.01}};
  for (auto& wall : box_walls(bed.box)) bed.walls.push_back(wall);
  bed.walls[0].role = WallRole::isothermal;
  bed.walls[0].temperature_K = 1000;
  bed.add({3.95e-4, 3.95e-4, 0.005}, {}, radius, 300);
  return bed;
}

TEST(Conduction, OnlyIsothermalWallsConduct) {
  Bed bed = on_walls();
  ConductionSettings settings;
  settings.gas = GasLens{};
  const NearPairs pairs{{}, {{0, 0, 3.95e-4}, {0, 2, 3.95e-4}}};
  for (auto role : {WallRole::adiabatic, WallRole::open, WallRole::excluded}) {
    bed.walls[2].role = role;
    const auto g = conductances(bed, pairs, settings);
    ASSERT_EQ(g.walls.size(), 1u) << to_string(role);
    EXPECT_EQ(g.walls[0].wall, 0);
    EXPECT_NEAR(g.walls[0].solid_W_K,
                66 * std::sqrt(wall_contact_area_m2(radius, 3.95e-4)) * std::pow(5e6 / 414e9, 0.2), 1e-15);
    EXPECT_DOUBLE_EQ(g.walls[0].gas_W_K,
                     0.026 * radius * wall_lens((radius - 3.95e-4) / radius, 2.75e-8 / radius, 1.2));
  }
}

TEST(Conduction, StopsAtTheHeatRegion) {
  Bed bed = pair_at(7.95e-4);
  EXPECT_TRUE(conductances(bed, touching(7.95e-4), {}, {1, 0}).particles.empty());
  EXPECT_EQ(conductances(bed, touching(7.95e-4), {}, {1, 1}).particles.size(), 1u);
}

TEST(Conduction, AcrossAGapNeedsGasAndEndsAtTheCutoff) {
  ConductionSettings settings;
  EXPECT_EQ(lens_cutoff_gap_m(settings, radius), 0);
  EXPECT_TRUE(conductances(pair_at(8.1e-4), touching(8.1e-4), settings).particles.empty());
  settings.gas = GasLens{};
  const double cutoff = lens_cutoff_gap_m(settings, radius);
  EXPECT_NEAR(cutoff, 0.2 * radius, 1e-18);
  for (double part : {0.5, 0.999}) {
    const double distance = 2 * radius + part * cutoff;
    EXPECT_EQ(conductances(pair_at(distance), touching(distance), settings).particles.size(), 1u);
  }
  const double beyond = 2 * radius + 1.001 * cutoff;
  EXPECT_TRUE(conductances(pair_at(beyond), touching(beyond), settings).particles.empty());
}

TEST(Conduction, RefusesAStepBeyondTheLimitAndNamesIt) {
  Bed bed = pair_at(7.95e-4);
  const auto g = conductances(bed, touching(7.95e-4), {});
  const double limit = conduction_step_limit_s(bed, g);
  EXPECT_NEAR(limit * g.particles[0].solid_W_K / (mass_kg(bed, 0) * 755), 0.1, 1e-12);
  EXPECT_NO_THROW(advance_temperatures(bed, g, 0.999 * limit));
  try {
    advance_temperatures(bed, g, 1.001 * limit);
    FAIL() << "a step beyond the limit passed";
  } catch (const NumericalError& e) {
    EXPECT_NE(std::string(e.what()).find("largest allowed"), std::string::npos) << e.what();
  }
}

// Two equal spheres meet at the mean: T1 - T2 = D exp(-2 t G / (m c)). A step of 20 limits is 20 parts of it, each of
// second order: (1 - x + x^2 / 2)^20 of D is left with x = 2 0.1, never less than none.
// Planted: one part, which is refused; the heats of the last part alone, which leave the books open.
TEST(Conduction, StepsBeyondTheLimitAreDoneInPartsThatNeverOvershoot) {
  Bed bed = pair_at(7.95e-4);
  bed.temperature_K = {900, 300};
  const auto g = conductances(bed, touching(7.95e-4), {});
  const double limit = conduction_step_limit_s(bed, g);
  const double energy = thermal_energy_J(bed);
  std::vector<HeatPaths> from_walls_J;
  advance_in_parts(bed, g, 20 * limit * (1 - 1e-9), from_walls_J);
  EXPECT_NEAR((bed.temperature_K[0] - bed.temperature_K[1]) / 600, std::pow(1 - 0.2 + 0.02, 20), 1e-9);
  EXPECT_NEAR(thermal_energy_J(bed) / energy, 1, 1e-14);
  EXPECT_THROW(advance_in_parts(bed, g, 1e6 * limit, from_walls_J), NumericalError);
}

TEST(Conduction, RefusesMaterialsItCannotUse) {
  Bed bed = pair_at(7.95e-4);
  bed.materials[0].real_youngs_modulus_Pa = 0;
  EXPECT_THROW(conductances(bed, touching(7.95e-4), {}), InputError);
  ConductionSettings gas_only;
  gas_only.solid = false;
  gas_only.gas = GasLens{};
  EXPECT_NO_THROW(conductances(bed, touching(7.95e-4), gas_only));
}

// The longest steps that are allowed, against the closed form: the difference of a pair goes with exp(-2 G t / (m c)).
// Planted, seen: heats of the start of each step (28 K of 700 K off after a time constant).
TEST(Conduction, TheLargestStepsFollowTheExponential) {
  Bed bed = pair_at(7.95e-4);
  const auto g = conductances(bed, touching(7.95e-4), {});
  const double limit = conduction_step_limit_s(bed, g);
  std::vector<HeatPaths> from_walls_J;
  for (int k = 1; k <= 20; ++k) {
    advance_in_parts(bed, g, limit * (1 - 1e-9), from_walls_J);
    EXPECT_NEAR(bed.temperature_K[1] - bed.temperature_K[0], 700 * std::exp(-0.2 * k), 3.0) << k;
  }
}

}  // namespace
}  // namespace granrad
