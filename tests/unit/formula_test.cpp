// Requirement: formulas of columns are evaluated with their errors, and wrong ones are named.
#include "coupling/study/formula.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/error.h"

using namespace granrad;

TEST(Formula, ErrorsAddInSquares) {
  const Quantities q = {{"a", {3, 0.3}}, {"feed.b", {4, 0.4}}, {"c", {5, 0}}};
  const auto sum = evaluate("a + 2 * feed.b + c", q);
  EXPECT_DOUBLE_EQ(sum.value, 16);
  EXPECT_NEAR(sum.error, std::hypot(0.3, 0.8), 1e-12);
  // Of a square, half the change between both sides: exact at second order, (9 + 1.8) where |dy/dx| e is 1.8.
  EXPECT_NEAR(evaluate("a ^ 2", q).error, 1.8, 1e-12);
  EXPECT_NEAR(evaluate("a - a", q).error, 0, 1e-12) << "a quantity is not independent of itself";
}

TEST(Formula, SyntaxAndUnknownNamesAreInputErrors) {
  EXPECT_THROW(evaluate("1 +", {}), InputError);
  EXPECT_THROW(evaluate("nothing", {}), InputError);
  EXPECT_TRUE(std::isnan(evaluate("x", {{"x", {std::nan(""), 0}}}).value));
  const auto unknown = evaluate("x + y", {{"x", {1, std::nan("")}}, {"y", {2, 0.1}}});
  EXPECT_EQ(unknown.value, 3);
  EXPECT_TRUE(std::isnan(unknown.error)) << "not 0: that would be certain";
}

TEST(Formula, BracesNameWhatIsNoWord) {
  const auto find = [](const std::string& name) {
    if (name != "a case-1:h") throw InputError("unknown " + name);
    return Measured{2, 0.1};
  };
  EXPECT_DOUBLE_EQ(evaluate_with_braces("3 * {a case-1:h}", find).value, 6);
  EXPECT_THROW(evaluate_with_braces("{b}", find), InputError);
}

TEST(Formula, ManyQuantitiesOfOneFormulaKeepTheirErrors) {
  const auto find = [](const std::string& name) { return Measured{std::stod(name), 0.5}; };
  const auto sum = evaluate_with_braces("33 * erfc(0) + (4 * {1} - {2}) / 3 + {3} + {4} + {5}", find);
  EXPECT_DOUBLE_EQ(sum.value, 33 + 2.0 / 3 + 12);
  EXPECT_NEAR(sum.error, 0.5 * std::sqrt(16.0 / 9 + 1.0 / 9 + 3), 1e-12);
}
