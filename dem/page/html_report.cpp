#include "dem/page/html_report.h"

#include <fmt/core.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <regex>

#include "dem/base/constants.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/base/stated_number.h"
#include "dem/page/page_assets.h"
#include "dem/page/page_data.h"

namespace granrad {

namespace {

/// "12.3 ± 0.4", "+1.2 %", "1e-3", but not "1/m" or "2 * x": what stays on one line, at the right.
bool is_number(const std::string& cell) {
  static const std::regex number(R"([-+]?\d+(\.\d+)?([eE][-+]?\d+)?( ± [\d.eE+-]+)?( %)?)");
  return std::regex_match(cell, number);
}

using Rows = std::vector<std::vector<std::string>>;

/// Columns of numbers, with at most short words between them ("never").
std::vector<bool> number_columns(std::size_t columns, const Rows& rows) {
  constexpr std::size_t short_word = 8;
  std::vector<bool> numeric(columns, false);
  for (std::size_t k = 0; k < columns; ++k) {
    bool some = false, all = true;
    for (const auto& row : rows) {
      if (k >= row.size()) continue;
      some = some || is_number(row[k]);
      all = all && (is_number(row[k]) || row[k].size() <= short_word);
    }
    numeric[k] = some && all;
  }
  return numeric;
}

/// A long name may be broken behind its parts.
std::string breakable(const std::string& text) {
  constexpr std::size_t short_name = 12;
  std::string out;
  for (const char c : escape_html(text)) {
    out += c;
    if (c == '_' && text.size() > short_name) out += "<wbr>";
  }
  return out;
}

/// Numbers stand at the right, on one line, and the head of their column above them.
std::string cells(const std::vector<std::string>& row, const char* tag, const std::vector<bool>& numeric) {
  std::string out = "<tr>";
  for (std::size_t k = 0; k < row.size(); ++k)
    out += fmt::format("<{0}{1}>{2}</{0}>", tag, k < numeric.size() && numeric[k] ? " class='n'" : "",
                       is_number(row[k]) ? escape_html(row[k]) : breakable(row[k]));
  return fmt::format("{}</tr>\n", out);
}

/// The words of this process as a shell would read them.
std::string own_command() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::string words((std::istreambuf_iterator<char>(in)), {}), line, word;
  for (const char c : words) {
    if (c != '\0') {
      word += c;
      continue;
    }
    const bool plain =
        !word.empty() && word.find_first_of(" '\"\\$[]{}*?;&|<>()#!~`\t\n") == std::string::npos;
    if (line.empty()) word = std::filesystem::path(word).filename().string();
    line += fmt::format("{}{}", line.empty() ? "" : " ", plain ? word : fmt::format("'{}'", word));
    word.clear();
  }
  return line;
}

/// A histogram as steps: the density of each bin from its lower border, 0 from the last border on.
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
  Series s{.label = label, .x = {}, .y = {}, .steps = true, .filled = true};
  for (int b = 0; b < bins; ++b) {
    s.x.push_back(low + b * step);
    s.y.push_back(total ? count[b] / (static_cast<double>(total) * step) : 0);
  }
  s.x.push_back(high);
  s.y.push_back(0);
  return s;
}

std::string figure(const std::string& title, const char* kind, const std::string& json) {
  return fmt::format(
      "<figure class='{}'><figcaption>{}</figcaption><script type='application/json' data-kind='{}'>{}</script></figure>\n",
      kind, escape_html(title), kind, json);
}

}  // namespace

Tile tile(const std::string& label, const std::string& unit, double value, double error) {
  const StatedNumber number = stated(value, error);
  return {label, number.value, number.error, unit};
}

HtmlReport::HtmlReport(std::string title) : title_(std::move(title)) {}

void HtmlReport::end_charts() {
  if (in_charts_) body_ += "</div>\n";
  in_charts_ = false;
}

void HtmlReport::heading(const std::string& text) {
  end_charts();
  body_ += fmt::format("<h2>{}</h2>\n", escape_html(text));
}

void HtmlReport::paragraph(const std::string& text) {
  end_charts();
  body_ += fmt::format("<p>{}</p>\n", escape_html(text));
}

void HtmlReport::verdict(const std::string& text, bool good) {
  end_charts();
  body_ += fmt::format("<p class='verdict{}'>{}</p>\n", good ? "" : " bad", escape_html(text));
}

void HtmlReport::tiles(const std::vector<Tile>& tiles) {
  end_charts();
  body_ += "<div class='tiles'>\n";
  for (const Tile& tile : tiles)
    body_ += fmt::format("<div class='tile'><b>{}{}</b><span>{}{}</span></div>\n", escape_html(tile.value),
                         tile.error.empty() ? "" : fmt::format(" <i>± {}</i>", escape_html(tile.error)),
                         escape_html(tile.label),
                         tile.unit.empty() ? "" : fmt::format(", {}", escape_html(tile.unit)));
  body_ += "</div>\n";
}

void HtmlReport::table(const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows) {
  end_charts();
  const auto numeric = number_columns(header.size(), rows);
  body_ +=
      fmt::format("<div class='scroll'><table>\n<thead>{}</thead>\n<tbody>\n", cells(header, "th", numeric));
  for (const auto& row : rows) body_ += cells(row, "td", numeric);
  body_ += "</tbody></table></div>\n";
}

void HtmlReport::filtered_table(const std::vector<std::string>& header,
                                const std::vector<std::vector<std::string>>& rows,
                                const std::vector<std::size_t>& by) {
  has_filters_ = true;
  std::string columns;
  for (const auto column : by) columns += fmt::format("{}{}", columns.empty() ? "" : " ", column);
  const auto begin = body_.size();
  table(header, rows);
  body_.replace(body_.find("<table>", begin), 7, fmt::format("<table data-filter='{}'>", columns));
}

void HtmlReport::chart(const Chart& chart) {
  if (!in_charts_) body_ += "<div class='charts'>\n";
  in_charts_ = has_figures_ = true;
  body_ += figure(chart.title, "chart", chart_json(chart));
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
  Chart all{.title = title, .x_label = x_label, .y_label = "probability density"};
  for (const auto& [label, values] : samples)
    all.series.push_back(stairs(label, values, low, high, std::max(1, bins)));
  chart(all);
}

void HtmlReport::bed(const std::string& title, const BedPicture& picture) {
  end_charts();
  has_figures_ = true;
  body_ += figure(title, "bed", bed_json(picture));
}

void HtmlReport::provenance(const std::vector<std::pair<std::string, std::string>>& lines) {
  for (const auto& [what, text] : lines)
    if (!text.empty()) provenance_ += fmt::format("<br>{}: {}", escape_html(what), escape_html(text));
}

void HtmlReport::provenance_of_this_process() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  provenance({{"command", own_command()},
              {"host", host},
              {"date", date_of_now()},
              {"threads", fmt::format("{}", omp_get_max_threads())}});
}

void HtmlReport::write(const std::filesystem::path& file) const {
  std::string page = fmt::format(
      "<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
      "<meta name='viewport' content='width=device-width, initial-scale=1'>\n<title>{0}</title>\n"
      "<style>{1}{2}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{3}{4}<footer>granrad {5}, {6}{7}</footer>\n",
      escape_html(title_), has_figures_ ? page_asset_uplot_css() : "", page_asset_page_css(), body_,
      in_charts_ ? "</div>\n" : "", program_version(), program_git_sha(), provenance_);
  if (has_figures_)
    page += fmt::format("<script>/*\n{}*/\n{}</script>\n<script>{}</script>\n", page_asset_uplot_license(),
                        page_asset_uplot_js(), page_asset_page_js());
  if (has_filters_) page += fmt::format("<script>{}</script>\n", page_asset_filter_js());
  write_text_file(file, page + "</body>\n</html>\n");
}

}  // namespace granrad
