// A table gives the printed formula in its own convention, stays within the physical bounds, interpolates
// between its solid fractions and refuses to leave them.
#include "fit/correlation/correlation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "dem/base/error.h"
#include "dem/base/random.h"
#include "raytrace/exact.h"
#include "raytrace/unobstructed_pair.h"
#include "tests/source_dir.h"

namespace granrad {
namespace {

CorrelationTable printed() {
  return read_correlation(granrad::source_dir() + "/data/correlations/li_2024_printed.toml");
}

CorrelationTable transmittance() {
  CorrelationTable table;
  table.form = CorrelationForm::transmittance;
  table.rows = {{0.2, {0.2, 1.7}, {0.97, 0.6, 1.0}, {}}, {0.4, {0.7, 2.2}, {0.82, 1.5, 1.2}, {}}};
  return table;
}

TEST(PrintedTable, HasEveryDigitOfThePaper) {
  const auto table = printed();
  ASSERT_EQ(table.rows.size(), 8u);
  EXPECT_EQ(table.pw_distance, WallDistance::h_plus_r_over_d);
  // Computed by hand from the printed digits: F_pp(2), F_pp(4) and F_pw at (h + r)/d = 2, that is h/d = 1.5.
  EXPECT_NEAR(raw_pp(table, table.rows[0], 2), -1.1e-5 - 0.0006 + 0.0145 + 0.002, 1e-15);
  EXPECT_NEAR(raw_pp(table, table.rows[1], 4), 2.6e-4 - 0.002 + 0.0044375 + 0.000171875, 1e-15);
  EXPECT_NEAR(raw_pp(table, table.rows[7], 2), 1.3e-5 + 0.0015 - 0.011 + 0.015, 1e-15);
  EXPECT_NEAR(raw_pw(table, table.rows[3], 1.5, 0), 0.018 - 0.18 + 0.45 - 0.1375, 1e-15);
  EXPECT_NEAR(raw_pw(table, table.rows[6], 0.5, 0), 0.017 - 0.28 + 0.93 - 0.33, 1e-15);
  EXPECT_NEAR(raw_pw(table, table.rows[0], 0.5, 0), 0.61, 1e-12);
}

TEST(PrintedTable, IsHeldWithinTheBounds) {
  const auto table = printed();
  for (const auto& row : table.rows) {
    const Correlation c(table, row.solid_fraction);
    for (double d = 0.98; d < 12; d += 0.01) {
      EXPECT_GE(c.pp(d), 0);
      EXPECT_LE(c.pp(d), exact_two_sphere(0.5, 0.5, d) + 1e-6);
      EXPECT_GE(c.pw(d, 0.5), 0);
      EXPECT_LE(c.pw(d, 0.5), 0.5);
    }
    EXPECT_EQ(c.pp(10), 0);
    EXPECT_EQ(c.pw(9.5, 0.5), 0);  // (h + r)/d = 10
  }
  EXPECT_EQ(Correlation(table, 0.02).pw(0.5, 0.5), 0.5);  // printed: 0.61
  EXPECT_EQ(Correlation(table, 0.25).pw(0.6, 0.2), 0.2);  // printed: .43; this wall cannot hold more than .2
  EXPECT_EQ(Correlation(table, 0.43).pp(6), 0);           // printed: negative
}

// Planted error: h/d put in where (h + r)/d belongs -> 0.537 instead of 0.337 at contact.
TEST(WallConvention, MovesContactFromHalfToOne) {
  auto table = printed();
  const double at_contact = raw_pw(table, table.rows[6], 0.5, 0);
  EXPECT_NEAR(at_contact, 0.337, 1e-12);
  table.pw_distance = WallDistance::centre_to_plane_over_d;
  EXPECT_NEAR(raw_pw(table, table.rows[6], 1.0, 0), at_contact, 1e-15);
}

TEST(Transmittance, IsTheExactFactorTimesWhatGetsThrough) {
  const auto table = transmittance();
  EXPECT_NEAR(raw_pp(table, table.rows[0], 3),
              exact_two_sphere(0.5, 0.5, 3) * std::exp(-0.2 * std::pow(2, 1.7)), 1e-9);
  EXPECT_NEAR(raw_pw(table, table.rows[1], 2.5, 0.3), 0.3 * 0.82 * std::exp(-1.5 * std::pow(2, 1.2)), 1e-9);
  EXPECT_NEAR(raw_pp(table, table.rows[0], 1), exact_two_sphere(0.5, 0.5, 1), 1e-12);
}

TEST(Correlation, TabulatesItsPairFunction) {
  for (const auto& table : {printed(), transmittance()})
    for (const auto& row : table.rows) {
      const Correlation c(table, row.solid_fraction);
      for (double d = 1; d < table.pp_cutoff; d += 0.00137) {
        const double held = std::clamp(raw_pp(table, row, d), 0.0, exact_two_sphere(0.5, 0.5, d));
        ASSERT_NEAR(c.pp(d), held, 3e-5) << row.solid_fraction << " " << d;
      }
    }
}

TEST(UnobstructedPair, FollowsTheExactFactor) {
  for (double d = 1; d < 40; d *= 1.0007) {
    const double exact = exact_two_sphere(0.5, 0.5, d);
    ASSERT_NEAR(unobstructed_pair(d) / exact, 1, 1e-6) << d;
  }
}

TEST(Correlation, OverlappingSpheresTakeTheValueAtContact) {
  const Correlation c(transmittance(), 0.2);
  EXPECT_EQ(c.pp(0.95), c.pp(1));
  EXPECT_EQ(c.pw(0.45, 0.5), c.pw(0.5, 0.5));
}

TEST(Correlation, InterpolatesCubicsLinearly) {
  const auto table = printed();
  const Correlation low(table, 0.25), middle(table, 0.28), high(table, 0.31);
  for (const double d : {1.0, 1.3, 2.0}) EXPECT_NEAR(middle.pp(d), 0.5 * (low.pp(d) + high.pp(d)), 1e-12);
  EXPECT_NEAR(middle.pw(1.2, 0.45), 0.5 * (low.pw(1.2, 0.45) + high.pw(1.2, 0.45)), 1e-12);
  EXPECT_NEAR(low.pp(1.7), Correlation(table, 0.25 + 1e-9).pp(1.7), 1e-9);
}

// ln a and b linear in logit(phi): by hand at the middle of 0.2 and 0.4. Planted error: linear in phi.
TEST(Correlation, InterpolatesTransmittancesInTheLogit) {
  const auto table = transmittance();
  const auto logit = [](double p) { return std::log(p / (1 - p)); };
  const double t = (logit(0.3) - logit(0.2)) / (logit(0.4) - logit(0.2));
  const double a = std::exp(std::log(0.2) + t * std::log(0.7 / 0.2)), b = 1.7 + t * 0.5;
  const double t0 = 0.97 * std::pow(0.82 / 0.97, t), c = 0.6 * std::pow(1.5 / 0.6, t);
  const Correlation middle(table, 0.3);
  EXPECT_NEAR(middle.pp(3), exact_two_sphere(0.5, 0.5, 3) * std::exp(-a * std::pow(2, b)), 1e-7);
  EXPECT_NEAR(middle.pw(1.5, 0.3), 0.3 * t0 * std::exp(-c), 1e-9);
}

// Below the first row: the empty box at 0, the row at its own solid fraction, continuous and falling between.
// Planted error: the first row held below itself.
TEST(Correlation, GoesToTheExactFactorsBelowTheFirstRow) {
  for (const auto& table : {printed(), transmittance()}) {
    const double first = table.rows[0].solid_fraction;
    const Correlation empty(table, 0), dilute(table, 0.5 * first), row(table, first);
    for (const double d : {1.0, 1.5, 2.0, 4.0, 8.0}) {
      EXPECT_NEAR(empty.pp(d), unobstructed_pair(d), 1e-6);
      EXPECT_LE(dilute.pp(d), empty.pp(d) * (1 + 1e-12));
      EXPECT_GE(dilute.pp(d), std::min(row.pp(d), empty.pp(d)) * (1 - 1e-12));
      EXPECT_NEAR(Correlation(table, first * (1 - 1e-9)).pp(d), row.pp(d), 1e-8);
    }
    EXPECT_NEAR(empty.pw(1.3, 0.37), 0.37, 1e-12);
    EXPECT_NEAR(Correlation(table, first * (1 - 1e-9)).pw(1.3, 0.37), row.pw(1.3, 0.37), 1e-8);
  }
}

TEST(Correlation, RefusesToExtrapolateAndStatesItsBounds) {
  const auto table = printed();
  for (const double phi : {-0.1, 0.505, 0.6, std::nan("")}) {
    try {
      Correlation(table, phi);
      ADD_FAILURE() << phi << " accepted";
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find("0.02 to 0.48"), std::string::npos) << text;
      EXPECT_NE(text.find("li_2024_printed.toml"), std::string::npos) << text;
      EXPECT_NE(text.find("vfgen generate"), std::string::npos) << text;
    }
  }
}

TEST(Correlation, ServesFivePercentBeyondItsEndWithTheLastRow) {
  const auto table = printed();
  EXPECT_EQ(Correlation(table, 0.503).pp(2), Correlation(table, 0.48).pp(2));
}

std::vector<CorrelationTable> shipped() {
  std::vector<CorrelationTable> tables;
  for (const auto& entry : std::filesystem::directory_iterator(granrad::source_dir() + "/data/correlations"))
    if (entry.path().string().find(".generate.") == std::string::npos)
      tables.push_back(read_correlation(entry.path()));
  return tables;
}

// A million random arguments, every shipped table and solid fraction: nothing beyond the bounds. Planted error: the
// bound of the wall 1/2 instead of its own factor.
TEST(Correlation, StaysWithinTheBoundsOfEveryArgument) {
  int beyond = 0;
  std::uint64_t k = 0;
  auto tables = shipped();
  ASSERT_GE(tables.size(), 6u);
  tables.push_back(transmittance());
  for (const auto& table : tables)
    for (int level = 0; level < 50; ++level) {
      const Correlation c(table, table.rows.back().solid_fraction * level / 49.0);
      for (int i = 0; i < 3000; ++i, ++k) {
        const auto u = random_uniform2(5, 1, k);
        const double d = 0.95 + 11 * u[0], exact = 0.5 * u[1];
        const double pp = c.pp(d), pw = c.pw(0.4 + 10 * u[0], exact);
        beyond += !(pp >= 0 && pp <= unobstructed_pair(d) + 1e-6) + !(pw >= 0 && pw <= exact);
      }
    }
  EXPECT_GE(k, 1000000u);
  EXPECT_EQ(beyond, 0);
}

}  // namespace
}  // namespace granrad
