// A table read back equals the table written, and a bad table is refused with every problem located.
#include <gtest/gtest.h>

#include "dem/base/error.h"
#include "fit/correlation/correlation.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

const std::string good = R"(format = "granrad.correlation"
version = 1
title = "test"
form = "cubic"
pp_distance = "centre_distance_over_d"
pw_distance = "centre_to_plane_over_d"
pp_cutoff = 10
pw_cutoff = 12
[[row]]
solid_fraction = 0.1
pp = [0, 0, 0.06, 0.01]
pw = [0, 0.2, 0, 0]
[[row]]
solid_fraction = 0.2
pp = [0, 0, 0.05, 0.02]
pw = [0, 0.2, 0, 0]
)";

std::string with(const std::string& what, const std::string& by) {
  auto text = good;
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(CorrelationFile, ReadsBackWhatWasWritten) {
  auto table = parse_correlation(good, "good.toml");
  table.title = "with \"quotes\" and\nlines \\";
  table.rows[0].pp = {1.0 / 3, -1e-17, 6.02e23, 0.1 + 0.2};
  table.rows[1].statistics.pp_rmse = 8.25e-4;
  table.rows[1].statistics.closure_mean = -0.0123;
  table.rows[1].statistics.pw_standard_error = {1e-3, 2e-3, 3e-3, 4e-3};
  table.provenance = {{"source", "a test"}, {"note", "none"}};
  const TemporaryFolder folder;
  write_correlation(folder / "t.toml", table);
  const auto back = read_correlation(folder / "t.toml");
  EXPECT_EQ(back.title, table.title);
  EXPECT_EQ(back.rows[0].pp, table.rows[0].pp);  // bit for bit
  EXPECT_EQ(back.rows[1].statistics.pp_rmse, 8.25e-4);
  EXPECT_EQ(back.rows[1].statistics.closure_mean, -0.0123);
  EXPECT_EQ(back.rows[1].statistics.pw_standard_error, table.rows[1].statistics.pw_standard_error);
  EXPECT_EQ(back.provenance, table.provenance);
  EXPECT_EQ(back.pw_cutoff, 12);
}

TEST(CorrelationFile, MissingFileIsAnIoError) {
  EXPECT_THROW(read_correlation("/nowhere/table.toml"), IoError);
}

struct BadTable {
  const char* name;
  std::string text;
  std::vector<std::string> says;
};

class BadTables : public testing::TestWithParam<BadTable> {};

TEST_P(BadTables, IsRefusedWithItsReason) {
  try {
    parse_correlation(GetParam().text, "bad.toml");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    for (const auto& part : GetParam().says)
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " in\n" << error.what();
  }
}

const BadTable bad_tables[] = {
    {"Empty", "", {"format", "form", "row"}},
    {"SyntaxError", "form = \"cubic", {"bad.toml:1"}},
    {"OtherFormat", with("granrad.correlation", "granrad.scene"), {"bad.toml:1", "granrad.correlation"}},
    {"FutureVersion", with("version = 1", "version = 2"), {"bad.toml:2", "version"}},
    {"UnknownForm", with("\"cubic\"", "\"cubik\""), {"bad.toml:4", "cubik", "cubic"}},
    {"UnknownPairConvention", with("centre_distance_over_d", "gap_over_d"), {"bad.toml:5", "gap_over_d"}},
    {"UnknownWallConvention", with("centre_to_plane_over_d", "distance"), {"bad.toml:6", "h_plus_r_over_d"}},
    {"NoWallConvention", with("pw_distance = \"centre_to_plane_over_d\"\n", ""), {"pw_distance"}},
    {"CutoffBelowContact", with("pp_cutoff = 10", "pp_cutoff = 0.9"), {"bad.toml:7", "pp_cutoff"}},
    {"CutoffTooFar", with("pp_cutoff = 10", "pp_cutoff = 100"), {"bad.toml:7", "pp_cutoff"}},
    {"CutoffNotANumber", with("pp_cutoff = 10", "pp_cutoff = nan"), {"bad.toml:7", "pp_cutoff"}},
    {"CutoffIsText", with("pp_cutoff = 10", "pp_cutoff = \"far\""), {"bad.toml:7", "pp_cutoff"}},
    {"NegativeClip", with("pw_cutoff = 12", "pw_cutoff = 12\nclip = -1"), {"bad.toml:9", "clip"}},
    {"ThreeCoefficients", with("[0, 0, 0.06, 0.01]", "[0, 0, 0.06]"), {"bad.toml:11", "3 coefficients", "4"}},
    {"FiveCoefficients", with("[0, 0.2, 0, 0]", "[0, 0.2, 0, 0, 1]"), {"bad.toml:12", "5 coefficients"}},
    {"InfiniteCoefficient", with("[0, 0, 0.06, 0.01]", "[0, 0, inf, 0.01]"), {"bad.toml:11", "inf"}},
    {"TextCoefficient", with("[0, 0, 0.06, 0.01]", "[0, 0, \"x\", 0.01]"), {"bad.toml:11"}},
    {"NoCoefficients", with("pp = [0, 0, 0.06, 0.01]\n", ""), {"pp"}},
    {"NoRows", good.substr(0, good.find("[[row]]")), {"row"}},
    {"FractionAboveDensest", with("= 0.2\n", "= 0.9\n"), {"bad.toml:14", "0.9", "0.7405"}},
    {"FractionZero", with("= 0.1\n", "= 0\n"), {"bad.toml:10", "solid_fraction"}},
    {"FractionsDescend", with("= 0.2\n", "= 0.05\n"), {"bad.toml:14", "ascend"}},
    {"FractionTwice", with("= 0.2\n", "= 0.1\n"), {"bad.toml:14", "ascend"}},
    {"UnknownKey", with("pp_cutoff", "pp_cutof"), {"bad.toml:7", "pp_cutof", "pp_cutoff"}},
    {"UnknownRowKey", with("pw = [0, 0.2, 0, 0]", "pw = [0, 0.2, 0, 0]\nqw = 1"), {"bad.toml:13", "qw"}},
    {"TransmittanceWithFourCoefficients",
     with("\"cubic\"", "\"transmittance\""),
     {"transmittance", "takes 2"}},
    {"TransmittanceWithPaperDistance",
     "format = \"granrad.correlation\"\nversion = 1\nform = \"transmittance\"\n"
     "pp_distance = \"centre_distance_over_d\"\npw_distance = \"h_plus_r_over_d\"\npp_cutoff = 10\npw_cutoff "
     "= 9\n"
     "[[row]]\nsolid_fraction = 0.1\npp = [-0.1, 1]\npw = [1, 0.1, 0]\n",
     {"bad.toml:5", "bad.toml:10", "bad.toml:11"}},
};

INSTANTIATE_TEST_SUITE_P(All, BadTables, testing::ValuesIn(bad_tables),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(CorrelationFile, ReportsAllProblemsAtOnce) {
  try {
    parse_correlation(with("= 0.1\n", "= -1\n") + "colour = 3\n", "bad.toml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_GE(error.problems().size(), 2u) << error.what();
  }
}

}  // namespace
}  // namespace granrad
