#include "dem/page/html_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"
#include "dem/base/program.h"
#include "dem/base/text_file.h"
#include "dem/page/svg_chart.h"

namespace granrad {

namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --page: #ffffff; --ink: #1c1e21; --soft: #5c636b; --rule: #e3e6ea;
  --panel: #f7f8fa; --c0: #1f6fc4; --c1: #d2570b; --c2: #1e8a55; --c3: #8a42b5; --c4: #a97a00; --c5: #c22f5b;
  --c6: #0f8391; --c7: #6b6f76; }
@media (prefers-color-scheme: dark) { :root { --page: #15171a; --ink: #e7e9ec; --soft: #9aa2ab; --rule: #2d3238;
  --panel: #1c1f23; --c0: #62a5ee; --c1: #f28b46; --c2: #4fc48b; --c3: #c08ae6; --c4: #dcb13c; --c5: #f0789b;
  --c6: #4cc0cd; --c7: #a4a9b0; } }
body { background: var(--page); color: var(--ink); margin: 0 auto; max-width: 60rem; padding: 2rem 1.25rem 4rem;
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.2; margin: 0 0 1rem; }
h2 { font-size: 1.2rem; margin: 2.4rem 0 .6rem; padding-top: .8rem; border-top: 1px solid var(--rule); }
p { max-width: 46rem; }
.scroll { overflow-x: auto; margin: 1rem 0; }
table { border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
th, td { padding: .3rem .8rem; text-align: right; border-bottom: 1px solid var(--rule); white-space: nowrap; }
th { color: var(--soft); font-weight: 600; } th:first-child, td:first-child { text-align: left; padding-left: 0; }
figure { margin: 1.4rem 0; padding: 1rem; background: var(--panel); border-radius: 10px; }
figcaption { font-weight: 600; margin-bottom: .4rem; }
figure > svg { width: 100%; height: auto; display: block; }
.legend { display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; font-size: .87rem; color: var(--soft); margin: .2rem 0 .5rem; }
.legend span { display: inline-flex; align-items: center; gap: .4rem; }
.grid { stroke: var(--rule); } .axis { stroke: var(--soft); }
.tick { font-size: 12px; fill: var(--soft); } .label { font-size: 13px; fill: var(--ink); }
.line path { fill: none; stroke: var(--c); stroke-width: 2; stroke-linejoin: round; }
.line .area { stroke: none; fill: var(--c); fill-opacity: .14; }
.points { fill: var(--c); stroke: none; } .many { fill-opacity: .35; }
.bar, .line .bar { stroke: var(--c); stroke-width: 1.2; fill: none; opacity: .7; }
.dash1 path { stroke-dasharray: 7 4; } .dash2 path { stroke-dasharray: 2 4; }
.s0 { --c: var(--c0); } .s1 { --c: var(--c1); } .s2 { --c: var(--c2); } .s3 { --c: var(--c3); }
.s4 { --c: var(--c4); } .s5 { --c: var(--c5); } .s6 { --c: var(--c6); } .s7 { --c: var(--c7); }
footer { color: var(--soft); font-size: .8rem; margin-top: 3rem; }
)";

std::string cells(const std::vector<std::string>& row, const char* tag) {
  std::string out = "<tr>";
  for (const auto& cell : row) out += fmt::format("<{0}>{1}</{0}>", tag, escape_html(cell));
  return out + "</tr>\n";
}

/// Outline of a histogram: up and down at every bin border.
Series stairs(const std::string& label, const std::vector<double>& values, double low, double high,
              int bins) {
  std::vector<double> count(bins, 0.0);
  std::size_t total = 0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    count[std::clamp(static_cast<int>((v - low) / (high - low) * bins), 0, bins - 1)] += 1;
    ++total;
  }
  const double step = (high - low) / bins;
  Series s{.label = label, .x = {low}, .y = {0}, .error = {}};
  for (int b = 0; b < bins; ++b) {
    const double density = total ? count[b] / (static_cast<double>(total) * step) : 0;
    s.x.insert(s.x.end(), {low + b * step, low + (b + 1) * step});
    s.y.insert(s.y.end(), {density, density});
  }
  s.x.push_back(high);
  s.y.push_back(0);
  return s;
}

}  // namespace

HtmlReport::HtmlReport(std::string title) : title_(std::move(title)) {}

void HtmlReport::heading(const std::string& text) {
  body_ += fmt::format("<h2>{}</h2>\n", escape_html(text));
}

void HtmlReport::paragraph(const std::string& text) {
  body_ += fmt::format("<p>{}</p>\n", escape_html(text));
}

void HtmlReport::table(const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows) {
  body_ += "<div class='scroll'><table>\n<thead>" + cells(header, "th") + "</thead>\n<tbody>\n";
  for (const auto& row : rows) body_ += cells(row, "td");
  body_ += "</tbody></table></div>\n";
}

void HtmlReport::chart(const Chart& chart) {
  body_ += svg_chart(chart);
}

void HtmlReport::histogram(const std::string& title, const std::string& x_label,
                           const std::vector<std::pair<std::string, std::vector<double>>>& samples,
                           int bins) {
  double low = infinity, high = -low;
  for (const auto& [label, values] : samples)
    for (const double v : values)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (low > high) low = 0, high = 1;
  if (low == high) low -= 0.5, high += 0.5;
  Chart chart{.title = title, .x_label = x_label, .y_label = "probability density", .series = {}};
  for (const auto& [label, values] : samples)
    chart.series.push_back(stairs(label, values, low, high, std::max(1, bins)));
  body_ += svg_chart(chart, true);
}

void HtmlReport::write(const std::filesystem::path& file) const {
  write_text_file(file,
                  fmt::format("<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
                              "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
                              "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}"
                              "<footer>granrad {3}, {4}</footer>\n</body>\n</html>\n",
                              escape_html(title_), style, body_, program_version(), program_git_sha()));
}

}  // namespace granrad
