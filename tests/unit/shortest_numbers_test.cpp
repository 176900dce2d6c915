// Requirement: the effective scene shows numbers as a person would write them, and reads back to the same bits.
#include "dem/base/toml/shortest_numbers.h"

#include <gtest/gtest.h>

namespace granrad {
namespace {

TEST(ShortestNumbers, FewestDigitsThatReadBack) {
  EXPECT_EQ(with_shortest_numbers("a = 0.0040000000000000001\n"), "a = 0.004\n");
  EXPECT_EQ(with_shortest_numbers("a = [ 0.01, 1.0000000000000001e-05, -2.5000000000000000 ]"),
            "a = [ 0.01, 1e-05, -2.5 ]");
  EXPECT_EQ(with_shortest_numbers("a = 33.0"), "a = 33.0");
  EXPECT_EQ(with_shortest_numbers("a = 0.1234567890123456789"), "a = 0.12345678901234568");
}

TEST(ShortestNumbers, LeavesTheRestAlone) {
  for (const char* text : {"name = 'bed 0.0040000000000000001'", "file = \"x 1.50\"", "n = 10000",
                           "on = true", "day = 2024-05-01", "[walls.x_min]\nrole = 'open'"})
    EXPECT_EQ(with_shortest_numbers(text), text);
}

}  // namespace
}  // namespace granrad
