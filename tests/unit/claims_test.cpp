// Requirement: bias and scatter of a quantity are those of the FDS Validation Guide.
#include "coupling/study/claims.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace granrad;

namespace {

Judgement ratio(const std::string& quantity, double r, double uncertainty) {
  Judgement j;
  j.claim.quantity = quantity;
  j.claim.reference = 2;
  j.claim.uncertainty = 2 * uncertainty;
  j.ours = {2 * r, 0};
  j.difference_pct = 100 * (r - 1);
  return j;
}

}  // namespace

// Planted: 1 / n instead of 1 / (n - 1); the scatter of the references left in.
TEST(Claims, BiasAndScatterAreThoseOfTheLogarithms) {
  // ln r = .1, .2, .3: mean .2, variance .01; references .06 each: model variance .0064.
  const auto all = biases({ratio("h", std::exp(0.1), 0.06), ratio("h", std::exp(0.2), 0.06),
                           ratio("h", std::exp(0.3), 0.06), ratio("one", 1.05, 0)});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].count, 3u);
  EXPECT_NEAR(all[0].sigma_pct, 8, 1e-9);
  EXPECT_NEAR(all[0].reference_pct, 6, 1e-9);
  EXPECT_NEAR(all[0].bias_pct, 100 * (std::exp(0.2 + (0.0064 - 0.0036) / 2) - 1), 1e-9);
  EXPECT_NEAR(all[1].bias_pct, 5, 1e-9);
  EXPECT_TRUE(std::isnan(all[1].sigma_pct)) << "one number has no scatter";
}

TEST(Claims, ReferencesThatScatterMoreThanOursLeaveNoSigmaAndUnknownOnesAllOfIt) {
  const auto noisy = biases({ratio("h", 0.99, 0.2), ratio("h", 1.01, 0.2)});
  EXPECT_EQ(noisy[0].sigma_pct, 0);
  const auto unknown =
      biases({ratio("h", std::exp(0.1), std::nan("")), ratio("h", std::exp(-0.1), std::nan(""))});
  EXPECT_NEAR(unknown[0].sigma_pct, 100 * std::sqrt(0.02), 1e-9);
  EXPECT_TRUE(std::isnan(unknown[0].reference_pct));
}
