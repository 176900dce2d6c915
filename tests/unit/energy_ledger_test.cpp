// Requirement: the ledger finds energy that was made or lost, keeps its sums exact over many steps, and
// survives a restart to the bit. Planted, seen to fail: heat through the gas left out of the books
// (ClosesOverManySteps).
#include "coupling/heat/energy_ledger.h"

#include <gtest/gtest.h>

#include "dem/base/error.h"
#include "dem/base/random.h"

namespace granrad {
namespace {

Bed hot_walled_bed(int count) {
  Bed bed;
  Material m;
  m.density_kg_m3 = 3984;
  m.specific_heat_J_kgK = 755;
  bed.materials = {m};
  bed.box = {{0, 0, 0}, {0.01, 0.01, 0.01}};
  for (auto wall : box_walls(bed.box)) {
    wall.role = WallRole::isothermal;
    wall.temperature_K = 1000;
    bed.walls.push_back(wall);
  }
  for (int i = 0; i < count; ++i) bed.add({1e-3 * i, 0, 0}, {}, 4e-4, 300 + i % 11);
  return bed;
}

Conductances chain(int count) {
  Conductances g;
  for (int i = 0; i + 1 < count; ++i) g.particles.push_back({i, i + 1, 1e-3, 2e-3});
  g.walls = {{0, 0, 1e-3, 1e-4}, {count - 1, 1, 2e-3, 5e-4}};
  return g;
}

TEST(EnergyLedger, ClosesOverManySteps) {
  const int count = 200;
  Bed bed = hot_walled_bed(count);
  const auto g = chain(count);
  EnergyLedger ledger;
  ledger.start(bed);
  for (int k = 0; k < 50000; ++k) {
    for (int i = 0; i < count; ++i) bed.radiative_heat_W[i] = random_uniform2(1, k, i)[0] - 0.45;
    ledger.receive(advance_temperatures(bed, g, 1e-3 * 0.1));
  }
  EXPECT_GT(ledger.received_J().solid, 0);
  EXPECT_GT(ledger.received_J().gas, 0);
  EXPECT_LT(ledger.relative_defect(bed, 0, 0), 1e-11);
}

TEST(EnergyLedger, FindsAJouleInAMillion) {
  Bed bed = hot_walled_bed(10);
  EnergyLedger ledger;
  ledger.start(bed);
  bed.radiative_heat_W.assign(10, 0.5);
  for (int k = 0; k < 100; ++k) ledger.receive(advance_temperatures(bed, {}, 1e-3));
  EXPECT_LT(ledger.relative_defect(bed, 0, 0), 1e-10);
  ledger.miss(1e-6 * ledger.received_J().total());
  EXPECT_NEAR(ledger.relative_defect(bed, 0, 0), 1e-6, 1e-9);
}

TEST(EnergyLedger, CountsWhatTheFeedBringsAndTakes) {
  Bed bed = hot_walled_bed(10);
  EnergyLedger ledger;
  ledger.start(bed);
  const double before = thermal_energy_J(bed);
  bed.add({0, 0, 0}, {}, 4e-4, 350);
  const double in = thermal_energy_J(bed) - before;
  bed.radiative_heat_W.assign(11, 0.2);
  ledger.receive(advance_temperatures(bed, {}, 0.1));
  EXPECT_LT(ledger.relative_defect(bed, in, 0), 1e-10);
  const double with_it = thermal_energy_J(bed);
  std::vector<char> keep(11, 1);
  keep[4] = 0;
  bed.remove_unless(keep);
  EXPECT_LT(ledger.relative_defect(bed, in, with_it - thermal_energy_J(bed)), 1e-10);
  EXPECT_GT(ledger.relative_defect(bed, in, 0), 1e-3);
}

TEST(EnergyLedger, OfABedThatGetsNothingHasNoDefect) {
  Bed bed = hot_walled_bed(10);
  EnergyLedger ledger;
  ledger.start(bed);
  EXPECT_EQ(ledger.relative_defect(bed, 0, 0), 0);
  Conductances inside = chain(10);
  inside.walls.clear();
  for (int k = 0; k < 1000; ++k) ledger.receive(advance_temperatures(bed, inside, 1e-3));
  EXPECT_LT(ledger.relative_defect(bed, 0, 0), 1e-13);
}

// Planted, seen: relative to what was received, however little (rounding of temperatures became a defect of 10).
TEST(EnergyLedger, OfABedThatGetsHardlyAnythingIsNotRounding) {
  Bed bed = hot_walled_bed(10);
  for (int i = 0; i < 10; ++i) bed.temperature_K[i] = 300 + 37.1 * i;
  EnergyLedger ledger;
  ledger.start(bed);
  Conductances inside = chain(10);
  inside.walls.clear();
  bed.radiative_heat_W.assign(10, 1e-11);
  for (int k = 0; k < 1000; ++k) ledger.receive(advance_temperatures(bed, inside, 1e-3));
  EXPECT_LT(ledger.relative_defect(bed, 0, 0), 1e-9);
}

// What walls exchange among themselves is missed by a rounding; 0 J cannot measure it (it was written as
// inf).
TEST(EnergyLedger, OfAnEmptyBedHasNoDefect) {
  const Bed bed = hot_walled_bed(0);
  EnergyLedger ledger;
  ledger.start(bed);
  ledger.miss(1e-9);
  EXPECT_EQ(ledger.relative_defect(bed, 0, 0), 0);
}

TEST(EnergyLedger, SurvivesARestartToTheBit) {
  Bed bed = hot_walled_bed(20);
  const auto g = chain(20);
  EnergyLedger ledger;
  ledger.start(bed);
  const auto run = [&](EnergyLedger& books) {
    for (int k = 0; k < 100; ++k) books.receive(advance_temperatures(bed, g, 1e-3)), books.miss(1e-9);
  };
  run(ledger);
  EnergyLedger resumed;
  resumed.load(ledger.save());
  const Bed saved = bed;
  run(ledger);
  bed = saved;
  run(resumed);
  EXPECT_EQ(ledger.save().reals, resumed.save().reals);
  EXPECT_THROW(resumed.load({}), InputError);
}

TEST(CompensatedSum, KeepsWhatRoundingTakes) {
  CompensatedSum sum;
  for (double term : {1e100, 1.0, -1e100, 1e-30}) sum.add(term);
  EXPECT_EQ(sum.value(), 1.0);
}

}  // namespace
}  // namespace granrad
