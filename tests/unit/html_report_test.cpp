// A report is one whole self-contained file, readable on any scale, and never shows NaN or a point off its
// axis.
#include "dem/page/html_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "dem/base/error.h"
#include "dem/page/svg_chart.h"

namespace granrad {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(LinearTicks, AreRoundAndInside) {
  const auto unit = linear_ticks(0, 1);
  ASSERT_EQ(unit.size(), 6u);
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(unit[k], 0.2 * k, 1e-12);
  for (const auto& [low, high] : {std::pair{-3.7, 12.1}, {1e-7, 9e-7}, {293.1, 293.2}, {-5e5, -1e5}}) {
    const auto ticks = linear_ticks(low, high);
    EXPECT_GE(ticks.size(), 3u);
    EXPECT_LE(ticks.size(), 12u);
    for (const double t : ticks) EXPECT_NEAR(std::clamp(t, low, high), t, 1e-9 * (high - low));
  }
}

TEST(LogTicks, AreDecades) {
  EXPECT_EQ(log_ticks(0.9, 1100).size(), 4u);
  EXPECT_EQ(log_ticks(1, 10).size(), 4u);  // 1, 2, 5, 10
  EXPECT_LE(log_ticks(1e-30, 1e30).size(), 10u);
}

TEST(TickLabel, ReadsAsPeopleWrite) {
  EXPECT_EQ(tick_label(0), "0");
  EXPECT_EQ(tick_label(0.25), "0.25");
  EXPECT_EQ(tick_label(-1200), "-1200");
  EXPECT_EQ(tick_label(1e-4), "10⁻⁴");
  EXPECT_EQ(tick_label(3e-5), "3×10⁻⁵");
  EXPECT_EQ(tick_label(-2.5e12), "-2.5×10¹²");
}

TEST(Chart, LeavesOutWhatAnAxisCannotShow) {
  Chart chart{.title = "t", .x_label = "x, m", .y_label = "y, W", .series = {}, .log_y = true};
  chart.series.push_back(
      {.label = "s", .x = {1, 2, 3, 4}, .y = {1, 0, std::nan(""), 10}, .error = {}, .points = true});
  const auto svg = svg_chart(chart);
  EXPECT_EQ(count_of(svg, "<circle"), 2u + 1u);  // two points and the legend
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find("x, m"), std::string::npos);
  EXPECT_NE(svg.find("y, W"), std::string::npos);
}

TEST(Chart, SurvivesEmptyAndConstantSeries) {
  for (const bool log : {false, true}) {
    Chart chart{.title = "t", .x_label = "x", .y_label = "y", .series = {}, .log_x = log, .log_y = log};
    EXPECT_EQ(svg_chart(chart).find("nan"), std::string::npos);
    chart.series.push_back({.label = "one", .x = {5}, .y = {5}, .error = {0.1}, .points = true});
    EXPECT_EQ(svg_chart(chart).find("nan"), std::string::npos);
    EXPECT_EQ(svg_chart(chart).find("inf"), std::string::npos);
  }
}

TEST(HtmlReport, IsOneSelfContainedFile) {
  const std::filesystem::path folder = testing::TempDir() + "/granrad_html_report";
  std::filesystem::remove_all(folder);
  HtmlReport report("Heat <of> the bed");
  report.heading("Numbers & units");
  report.table({"a", "b"}, {{"1", "<2>"}});
  report.histogram("T", "temperature, K", {{"traced", {1, 2, 2, 3}}, {"none", {}}});
  report.write(folder / "page.html");
  const auto text = text_of(folder / "page.html");
  EXPECT_NE(text.find("Heat &lt;of&gt; the bed"), std::string::npos);
  EXPECT_NE(text.find("&lt;2&gt;"), std::string::npos);
  EXPECT_NE(text.find("prefers-color-scheme: dark"), std::string::npos);
  for (const char* outside : {"http:", "https:", "<script", "@import", "url("})
    EXPECT_EQ(text.find(outside), std::string::npos) << outside;
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++files;
  EXPECT_EQ(files, 1u);  // no temporary left behind
}

TEST(HtmlReport, SaysWhyItCannotWrite) {
  EXPECT_THROW(HtmlReport("t").write("/proc/granrad/page.html"), IoError);
}

}  // namespace
}  // namespace granrad
