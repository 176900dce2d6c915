#include "dem/page/svg_chart.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace granrad {

namespace {

constexpr double width = 720, height = 400, left = 78, right = 16, top = 12, bottom = 52;
constexpr int colour_count = 8;

/// Maps data to pixels along one axis.
struct Axis {
  double low = 0, high = 1, pixel_low = 0, pixel_high = 1;
  bool log = false;

  bool shows(double v) const { return std::isfinite(v) && (!log || v > 0); }
  double scaled(double v) const { return log ? std::log10(v) : v; }
  double pixel(double v) const {
    const double part = (scaled(v) - scaled(low)) / (scaled(high) - scaled(low));
    return pixel_low + std::clamp(part, 0.0, 1.0) * (pixel_high - pixel_low);
  }
  std::vector<double> ticks() const { return log ? log_ticks(low, high) : linear_ticks(low, high); }
};

void widen(Axis& axis, double v, double& low, double& high) {
  if (!axis.shows(v)) return;
  low = std::min(low, v);
  high = std::max(high, v);
}

/// Range that holds every value, with a little air; never empty.
void set_range(Axis& axis, double low, double high, bool from_zero) {
  if (low > high) low = axis.log ? 0.1 : 0, high = 1;
  if (axis.log) {
    const double air = low == high ? 0.5 : 0.03 * std::log10(high / low);
    axis.low = low * std::pow(10, -air), axis.high = high * std::pow(10, air);
    return;
  }
  const double air = low == high ? (low == 0 ? 1 : 0.1 * std::abs(low)) : 0.04 * (high - low);
  axis.low = from_zero && low >= 0 && low < 0.25 * high ? 0 : low - air;
  axis.high = high + air;
}

void fit_axes(const Chart& chart, Axis& x, Axis& y) {
  const double inf = std::numeric_limits<double>::infinity();
  double x_low = inf, x_high = -inf, y_low = inf, y_high = -inf;
  for (const auto& s : chart.series)
    for (std::size_t k = 0; k < std::min(s.x.size(), s.y.size()); ++k) {
      if (!x.shows(s.x[k]) || !y.shows(s.y[k])) continue;
      const double e = k < s.error.size() && std::isfinite(s.error[k]) ? s.error[k] : 0;
      widen(x, s.x[k], x_low, x_high);
      widen(y, s.y[k], y_low, y_high);
      widen(y, s.y[k] + e, y_low, y_high);
      if (!y.log) widen(y, s.y[k] - e, y_low, y_high);
    }
  set_range(x, x_low, x_high, false);
  set_range(y, y_low, y_high, true);
}

std::string grid_and_ticks(const Axis& x, const Axis& y) {
  std::string out;
  for (const double t : x.ticks())
    out += fmt::format(
        "<line class='grid' x1='{0:.1f}' x2='{0:.1f}' y1='{1}' y2='{2}'/>"
        "<text class='tick' x='{0:.1f}' y='{3}' text-anchor='middle'>{4}</text>\n",
        x.pixel(t), top, height - bottom, height - bottom + 18, tick_label(t));
  for (const double t : y.ticks())
    out += fmt::format(
        "<line class='grid' x1='{1}' x2='{2}' y1='{0:.1f}' y2='{0:.1f}'/>"
        "<text class='tick' x='{3}' y='{4:.1f}' text-anchor='end'>{5}</text>\n",
        y.pixel(t), left, width - right, left - 8, y.pixel(t) + 4, tick_label(t));
  return out;
}

std::string axis_labels(const Chart& chart) {
  const double middle_x = 0.5 * (left + width - right), middle_y = 0.5 * (top + height - bottom);
  return fmt::format(
      "<line class='axis' x1='{0}' x2='{1}' y1='{2}' y2='{2}'/><line class='axis' x1='{0}' x2='{0}' y1='{3}' "
      "y2='{2}'/>\n<text class='label' x='{4}' y='{5}' text-anchor='middle'>{6}</text>"
      "<text class='label' transform='translate(16,{7}) rotate(-90)' text-anchor='middle'>{8}</text>\n",
      left, width - right, height - bottom, top, middle_x, height - 10, escape_html(chart.x_label), middle_y,
      escape_html(chart.y_label));
}

/// Marker shapes differ as well as colours, so that the chart reads without colour.
std::string marker(int series, double x, double y, double size) {
  switch (series % 4) {
    case 1:
      return fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}'/>", x - size, y - size,
                         2 * size, 2 * size);
    case 2:
      return fmt::format("<path d='M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z'/>", x, y - 1.2 * size, 1.15 * size,
                         2 * size, -2.3 * size);
    case 3:
      return fmt::format("<path d='M{:.1f} {:.1f}l{s:.1f} {s:.1f}l-{s:.1f} {s:.1f}l-{s:.1f} -{s:.1f}z'/>", x,
                         y - 1.3 * size, fmt::arg("s", 1.3 * size));
    default:
      return fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='{:.1f}'/>", x, y, size);
  }
}

std::string error_bar(const Axis& y, double px, double value, double error) {
  const double high = y.pixel(value + error);
  const double low = y.shows(value - error) ? y.pixel(value - error) : y.pixel_low;
  return fmt::format("<path class='bar' d='M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}h6M{3:.1f} {2:.1f}h6'/>",
                     px, low, high, px - 3);
}

std::string draw_points(const Series& s, int number, const Axis& x, const Axis& y) {
  const std::size_t count = std::min(s.x.size(), s.y.size());
  const double size = count > 400 ? 1.6 : count > 80 ? 2.4 : 3.6;
  std::string out;
  for (std::size_t k = 0; k < count; ++k) {
    if (!x.shows(s.x[k]) || !y.shows(s.y[k])) continue;
    const double px = x.pixel(s.x[k]), py = y.pixel(s.y[k]);
    if (k < s.error.size() && s.error[k] > 0) out += error_bar(y, px, s.y[k], s.error[k]);
    if (count > 400)
      out += marker(number, px, py, size);
    else
      out += fmt::format("<g><title>{}: {:.6g}, {:.6g}</title>{}</g>", escape_html(s.label), s.x[k], s.y[k],
                         marker(number, px, py, size));
  }
  return fmt::format("<g class='points s{}{}'>{}</g>\n", number % colour_count, count > 400 ? " many" : "",
                     out);
}

std::string draw_line(const Series& s, int number, const Axis& x, const Axis& y, bool filled) {
  std::string path, bars;
  bool pen_down = false;
  double first_x = 0, last_x = 0;
  for (std::size_t k = 0; k < std::min(s.x.size(), s.y.size()); ++k) {
    if (!x.shows(s.x[k]) || !y.shows(s.y[k])) {
      pen_down = false;
      continue;
    }
    const double px = x.pixel(s.x[k]), py = y.pixel(s.y[k]);
    if (path.empty()) first_x = px;
    last_x = px;
    path += fmt::format("{}{:.1f} {:.1f}", pen_down ? "L" : "M", px, py);
    pen_down = true;
    if (k < s.error.size() && s.error[k] > 0) bars += error_bar(y, px, s.y[k], s.error[k]);
  }
  if (path.empty()) return "";
  std::string area;
  if (filled)
    area = fmt::format("<path class='area' d='{}L{:.1f} {:.1f}L{:.1f} {:.1f}z'/>", path, last_x, y.pixel_low,
                       first_x, y.pixel_low);
  return fmt::format("<g class='line s{} dash{}'><title>{}</title>{}{}<path d='{}'/></g>\n",
                     number % colour_count, number / colour_count % 3, escape_html(s.label), area, bars,
                     path);
}

std::string legend(const Chart& chart) {
  if (chart.series.size() == 1 && chart.series[0].label.empty()) return "";
  std::string out = "<div class='legend'>";
  int number = 0;
  for (const auto& s : chart.series) {
    const std::string mark = s.points ? marker(number, 12, 7, 4) : "<path d='M1 7H23'/>";
    out += fmt::format("<span><svg width='24' height='14'><g class='{} s{} dash{}'>{}</g></svg>{}</span>",
                       s.points ? "points" : "line", number % colour_count, number / colour_count % 3, mark,
                       escape_html(s.label));
    ++number;
  }
  return out + "</div>\n";
}

}  // namespace

std::vector<double> linear_ticks(double low, double high, int wanted) {
  const double rough = (high - low) / std::max(1, wanted);
  if (!(rough > 0) || !std::isfinite(rough)) return {low};
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * decade;
  for (const double m : {5.0, 2.0, 1.0})
    if (m * decade >= rough * 0.999) step = m * decade;
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k * step + 0.0);
  return ticks;
}

std::vector<double> log_ticks(double low, double high) {
  const double decades = std::log10(high / low);
  if (decades < 0.7) return linear_ticks(low, high);
  const int every = std::max(1, static_cast<int>(std::ceil(decades / 9)));
  std::vector<double> ticks;
  for (int e = static_cast<int>(std::floor(std::log10(low))); e <= std::ceil(std::log10(high)); ++e) {
    if (e % every) continue;
    for (const double m : {1.0, 2.0, 5.0}) {
      const double t = m * std::pow(10.0, e);
      if ((m == 1.0 || decades < 2) && t >= low * (1 - 1e-9) && t <= high * (1 + 1e-9)) ticks.push_back(t);
    }
  }
  return ticks;
}

std::string tick_label(double value) {
  const double size = std::abs(value);
  if (size == 0 || (size >= 9.9e-4 && size < 99999.5)) return fmt::format("{:.4g}", value);
  const int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  const std::string mantissa = fmt::format("{:.3g}", value / std::pow(10.0, exponent));
  static const char* const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string power;
  for (const char c : fmt::format("{}", exponent)) power += c == '-' ? "⁻" : digits[c - '0'];
  return (mantissa == "1" ? "" : mantissa == "-1" ? "-" : mantissa + "×") + "10" + power;
}

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out += c;
  }
  return out;
}

std::string svg_chart(const Chart& chart, bool filled) {
  Axis x, y;
  x.log = chart.log_x, y.log = chart.log_y;
  x.pixel_low = left, x.pixel_high = width - right;
  y.pixel_low = height - bottom, y.pixel_high = top;
  fit_axes(chart, x, y);
  std::string body;
  int number = 0;
  for (const auto& s : chart.series) {
    body += s.points ? draw_points(s, number, x, y) : draw_line(s, number, x, y, filled);
    ++number;
  }
  return fmt::format(
      "<figure>\n<figcaption>{}</figcaption>\n{}<svg viewBox='0 0 {} {}' role='img' "
      "aria-label='{}'>\n{}{}{}</svg>\n</figure>\n",
      escape_html(chart.title), legend(chart), width, height, escape_html(chart.title), grid_and_ticks(x, y),
      body, axis_labels(chart));
}

}  // namespace granrad
