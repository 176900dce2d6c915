#include "dem/page/page_data.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace granrad {

namespace {

using Json = nlohmann::json;

/// Six significant digits: what a picture can show, in half the bytes.
double rounded(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 5 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(scale) && scale > 0 ? std::round(value * scale) / scale : value;
}

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double v : values) list.push_back(std::isfinite(v) ? Json(rounded(v)) : Json());
  return list;
}

/// "</script" cannot end the element early.
std::string inside_script(const Json& json) {
  std::string text = json.dump(), out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '/' && k > 0 && text[k - 1] == '<') out += '\\';
    out += text[k];
  }
  return out;
}

}  // namespace

std::string escape_html(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string chart_json(const Chart& chart) {
  Json series = Json::array();
  for (const Series& s : chart.series)
    series.push_back({{"label", s.label},
                      {"x", numbers(s.x)},
                      {"y", numbers(s.y)},
                      {"error", numbers(s.error)},
                      {"points", s.points},
                      {"joined", s.joined},
                      {"steps", s.steps},
                      {"filled", s.filled},
                      {"colour", s.colour}});
  Json json{{"title", chart.title}, {"x_label", chart.x_label}, {"y_label", chart.y_label},
            {"log_x", chart.log_x}, {"log_y", chart.log_y},     {"series", series}};
  if (chart.window) json["window"] = {chart.window->first, chart.window->second};
  return inside_script(json);
}

std::string bed_json(const BedPicture& bed) {
  Json columns = Json::array(), walls = Json::array();
  for (const auto& [label, values] : bed.columns)
    columns.push_back({{"label", label}, {"values", numbers(values)}});
  for (const auto& wall : bed.walls) {
    Json corners = Json::array();
    for (const Vec3& v : wall) corners.push_back(numbers({v.x, v.y, v.z}));
    walls.push_back(corners);
  }
  std::vector<double> x, y, z;
  for (const Vec3& p : bed.position_m) x.push_back(p.x), y.push_back(p.y), z.push_back(p.z);
  return inside_script(
      {{"x", numbers(x)},
       {"y", numbers(y)},
       {"z", numbers(z)},
       {"r", numbers(bed.radius_m)},
       {"columns", columns},
       {"walls", walls},
       {"box", {numbers({bed.low.x, bed.low.y, bed.low.z}), numbers({bed.high.x, bed.high.y, bed.high.z})}}});
}

}  // namespace granrad
