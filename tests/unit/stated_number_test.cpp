// A number is shown with two digits of its error and to the same place. Planted: digits of the error by floor(log10) alone
// ("0.0999" became "0.100" beside "1.234").
#include "dem/base/stated_number.h"

#include <gtest/gtest.h>

#include <limits>

namespace granrad {
namespace {

TEST(StatedNumber, HasTwoDigitsOfItsError) {
  EXPECT_EQ(stated(107.934, 0.5178).text(), "107.93 ± 0.52");
  EXPECT_EQ(stated(1.23456, 0.0999).text(), "1.23 ± 0.10");
  EXPECT_EQ(stated(1234.4, 56).text(), "1234 ± 56");
  EXPECT_EQ(stated(1234.4, 561).text(), "1230 ± 560");
  EXPECT_EQ(stated(-0.43383, 0.0007).text(), "-0.43383 ± 0.00070");
  EXPECT_EQ(stated(3, 12).text(" +- "), "3 +- 12");
}

TEST(StatedNumber, SmallOnesHaveAnExponent) {
  EXPECT_EQ(stated(1.23456e-5, 3.4e-8).text(), "1.2346e-05 ± 3.4e-08");
  EXPECT_EQ(stated(0, 3.4e-8).text(), "0.0e+00 ± 3.4e-08");
}

TEST(StatedNumber, WithoutAnErrorStandsAlone) {
  EXPECT_EQ(stated(0.123456, 0).text(), "0.1235");
  EXPECT_EQ(stated(0.20106192983, 8e-17).text(), "0.2011");
  EXPECT_EQ(stated(2, std::numeric_limits<double>::quiet_NaN()).text(), "2");
  EXPECT_EQ(stated(std::numeric_limits<double>::infinity(), 1).text(), "");
}

}  // namespace
}  // namespace granrad
