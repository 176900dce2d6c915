// Requirement: the time that is left follows the pace of the work itself: neither set-up before it nor what an earlier
// run had done counts.
// Planted, seen to fail: the pace since the start of the program.
#include <gtest/gtest.h>

#include <cmath>

#include "dem/base/program.h"

using granrad::remaining_seconds;

TEST(RemainingTime, IsThatOfThePaceSinceTheFirstLook) {
  EXPECT_DOUBLE_EQ(remaining_seconds(0, 2, 2, 10), 8);     // one second a piece, whatever came before
  EXPECT_DOUBLE_EQ(remaining_seconds(90, 2, 95, 100), 2);  // gone on at 90
  EXPECT_DOUBLE_EQ(remaining_seconds(0, 7, 10, 10), 0);
  EXPECT_TRUE(std::isinf(remaining_seconds(3, 1, 3, 10)));
}
