#pragma once
#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/bench/trace_case.h"

namespace granrad::trace_bench {

struct Point {
  double seconds, error;
  std::string method;
};

/// The table of a run, its comparisons and its figure.
class Book {
 public:
  explicit Book(const std::string& folder)
      : folder_(folder), csv_(fmt::output_file(folder + "/trace_bench.csv")) {
    csv_.print(
        "case,method,rays,cpu_seconds,rays_per_second,build_seconds,peak_MiB,error_near_pairs,error_wall_"
        "sums,"
        "error_particle_flux,error_wall_heat\n");
    fmt::print("{:<24} {:<14} {:>9} {:>8} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "case", "method",
               "rays", "cpu s", "Mray/s", "build s", "MiB", "near", "wall sum", "flux", "heat");
  }
  void add(const Case& c, const std::string& method, const Result& r, const std::optional<Errors>& e) {
    const Errors none{NAN, NAN, NAN, NAN}, x = e.value_or(none);
    fmt::print(
        "{:<24} {:<14} {:>9.2e} {:>8.3f} {:>9.2f} {:>8.3f} {:>9.1f} {:>9.2e} {:>9.2e} {:>9.2e} {:>9.2e}\n",
        c.name(), method, r.rays, r.seconds, 1e-6 * r.rays / r.seconds, r.build_s, r.memory_MiB, x.near,
        x.wall_sum, x.flux, x.heat);
    std::fflush(stdout);
    csv_.print("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4g},{:.4g},{:.4g},{:.4g}\n", c.name(), method,
               r.rays, r.seconds, r.rays / r.seconds, r.build_s, r.memory_MiB, x.near, x.wall_sum, x.flux,
               x.heat);
    csv_.flush();
  }
  void versus(const std::string& what, double ours, const std::string& peer, double theirs,
              const std::string& unit, bool less_is_better) {
    lines_.push_back(fmt::format("{} ours {:.4g} {} {} {:.4g} {} ratio {:.3g}", what, ours, unit, peer,
                                 theirs, unit, less_is_better ? theirs / ours : ours / theirs));
  }
  void note(const std::string& line) { lines_.push_back(line); }
  void point(const std::string& method, double seconds_per_particle, double error) {
    points_.push_back({seconds_per_particle, error, method});
  }
  void finish() {
    auto file = fmt::output_file(folder_ + "/trace_bench.txt");
    fmt::print("\n");
    for (const auto& line : lines_) fmt::print("{}\n", line), file.print("{}\n", line);
    draw();
  }

 private:
  /// Error of the particle fluxes against CPU time per particle, both logarithmic.
  void draw() {
    double x_low = 1e300, x_high = 0, y_low = 1e300, y_high = 0;
    for (const auto& p : points_) {
      x_low = std::min(x_low, p.seconds), x_high = std::max(x_high, p.seconds);
      y_low = std::min(y_low, p.error), y_high = std::max(y_high, p.error);
    }
    const auto decade = [](double v, bool up) {
      return up ? std::ceil(std::log10(v)) : std::floor(std::log10(v));
    };
    const double x0 = decade(x_low, false), x1 = decade(x_high, true), y0 = decade(y_low, false),
                 y1 = decade(y_high, true);
    const auto at_x = [&](double v) { return 70 + 560 * (std::log10(v) - x0) / (x1 - x0); };
    const auto at_y = [&](double v) { return 430 - 390 * (std::log10(v) - y0) / (y1 - y0); };
    auto svg = fmt::output_file(folder_ + "/trace_bench.svg");
    svg.print(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"660\" height=\"490\" font-family=\"sans-serif\" "
        "font-size=\"12\">\n"
        "<rect width=\"660\" height=\"490\" fill=\"white\"/>\n");
    for (double d = x0; d <= x1; ++d)
      svg.print(
          "<path d=\"M{0} 40V430\" stroke=\"#ddd\"/><text x=\"{0}\" y=\"448\" "
          "text-anchor=\"middle\">1e{1:.0f}</text>\n",
          at_x(std::pow(10, d)), d);
    for (double d = y0; d <= y1; ++d)
      svg.print(
          "<path d=\"M70 {0}H630\" stroke=\"#ddd\"/><text x=\"62\" y=\"{0}\" "
          "text-anchor=\"end\">1e{1:.0f}</text>\n",
          at_y(std::pow(10, d)), d);
    svg.print(
        "<text x=\"350\" y=\"472\" text-anchor=\"middle\">CPU seconds per particle</text>\n"
        "<text x=\"70\" y=\"24\">rms relative error of the particle fluxes, wall-heated bed</text>\n");
    const std::pair<const char*, const char*> colours[] = {{"bare embree", "#c0392b"},
                                                           {"embree sobol", "#e08e0b"},
                                                           {"lines matrix", "#2471a3"},
                                                           {"lines heat", "#1e8449"}};
    double legend = 56;
    for (const auto& [method, colour] : colours) {
      svg.print("<circle cx=\"520\" cy=\"{}\" r=\"5\" fill=\"{}\"/><text x=\"532\" y=\"{}\">{}</text>\n",
                legend, colour, legend + 4, method);
      legend += 18;
      for (const auto& p : points_)
        if (p.method == method)
          svg.print("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\" fill-opacity=\"0.8\"/>\n",
                    at_x(p.seconds), at_y(p.error), colour);
    }
    svg.print("</svg>\n");
  }

  std::string folder_;
  fmt::ostream csv_;
  std::vector<std::string> lines_;
  std::vector<Point> points_;
};

}  // namespace granrad::trace_bench
