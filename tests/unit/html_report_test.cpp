// A report is one whole self-contained file whose data a browser can read, and never shows what is not a number.
#include "dem/page/html_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "dem/base/error.h"
#include "dem/page/page_data.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Chart, IsDataABrowserReads) {
  Chart chart{.title = "t", .x_label = "x, m", .y_label = "y, W", .log_y = true, .window = {{1, 2}}};
  chart.series.push_back(
      {.label = "</script><b>", .x = {1, 2, 3}, .y = {1, std::nan(""), 1e300 * 1e10}, .points = true});
  const std::string text = chart_json(chart);
  EXPECT_EQ(text.find("</"), std::string::npos) << "the label would end the script element";
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["series"][0]["label"], "</script><b>");
  EXPECT_TRUE(json["series"][0]["y"][1].is_null());
  EXPECT_TRUE(json["series"][0]["y"][2].is_null());
  EXPECT_EQ(json["window"], nlohmann::json({1, 2}));
}

TEST(Chart, KeepsSixDigits) {
  Chart chart{.title = "t", .x_label = "x", .y_label = "y"};
  chart.series.push_back({.label = "s", .x = {123456.789, -1.23456789e-7, 0}, .y = {1, 2, 3}});
  const auto x = nlohmann::json::parse(chart_json(chart))["series"][0]["x"];
  EXPECT_DOUBLE_EQ(x[0].get<double>(), 123457);
  EXPECT_DOUBLE_EQ(x[1].get<double>(), -1.23457e-7);
  EXPECT_EQ(x[2].get<double>(), 0);
}

TEST(Bed, IsDataABrowserReads) {
  BedPicture bed{.position_m = {{0, 1, 2}, {3, 4, 5}},
                 .radius_m = {0.5, 0.25},
                 .columns = {{"T, K", {300, std::nan("")}}},
                 .walls = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
                 .low = {0, 0, 0},
                 .high = {3, 4, 5}};
  const auto json = nlohmann::json::parse(bed_json(bed));
  EXPECT_EQ(json["z"], nlohmann::json({2.0, 5.0}));
  EXPECT_TRUE(json["columns"][0]["values"][1].is_null());
  EXPECT_EQ(json["walls"][0].size(), 3u);
}

TEST(HtmlReport, IsOneSelfContainedFile) {
  const TemporaryFolder folder;
  HtmlReport report("Heat <of> the bed");
  report.heading("Numbers & units");
  report.verdict("all's well", true);
  report.tiles({{"h", "108", "1", "W/m²K"}});
  report.table({"a", "b"}, {{"1", "<2>"}});
  report.histogram("T", "temperature, K", {{"traced", {1, 2, 2, 3}}, {"none", {}}});
  report.write(folder / "page.html");
  const auto text = text_of(folder / "page.html");
  EXPECT_NE(text.find("Heat &lt;of&gt; the bed"), std::string::npos);
  EXPECT_NE(text.find("&lt;2&gt;"), std::string::npos);
  EXPECT_NE(text.find("prefers-color-scheme: dark"), std::string::npos);
  for (const char* outside : {"src=", "@import", "url(", "<link", "fetch("})
    EXPECT_EQ(text.find(outside), std::string::npos) << outside;
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++files;
  EXPECT_EQ(files, 1u);  // no temporary left behind
}

// Planted, seen to fail: whatever begins with a digit taken for a number.
TEST(HtmlReport, ColumnsOfNumbersStandAtTheRightWithTheirWords) {
  const TemporaryFolder folder;
  HtmlReport report("t");
  report.table({"value", "unit", "formula", "until"}, {{"12.3 ± 0.4", "1/m", "48 * x^2", "1.6e-3"},
                                                       {"-1e-3", "m", "2 + x", "never"},
                                                       {"+1.2 %", "", "3 d", ""}});
  report.write(folder / "page.html");
  const auto text = text_of(folder / "page.html");
  for (const char* right :
       {"<th class='n'>value</th>", "<td class='n'>12.3 ± 0.4</td>", "<td class='n'>+1.2 %</td>",
        "<th class='n'>until</th>", "<td class='n'>never</td>"})
    EXPECT_NE(text.find(right), std::string::npos) << right;
  for (const char* left : {"<td>1/m</td>", "<td>48 * x^2</td>", "<td>3 d</td>", "<th>unit</th>"})
    EXPECT_NE(text.find(left), std::string::npos) << left;
}

TEST(HtmlReport, WithoutFiguresCarriesNoScript) {
  const TemporaryFolder folder;
  HtmlReport report("t");
  report.paragraph("p");
  report.write(folder / "page.html");
  EXPECT_EQ(text_of(folder / "page.html").find("<script"), std::string::npos);
}

TEST(HtmlReport, SaysWhyItCannotWrite) {
  EXPECT_THROW(HtmlReport("t").write("/proc/granrad/page.html"), IoError);
}

}  // namespace
}  // namespace granrad
