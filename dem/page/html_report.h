#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dem/base/vec3.h"

namespace granrad {

/// One series of a chart. `error` (one sigma) draws bars at markers and a band along a line.
struct Series {
  std::string label;
  std::vector<double> x, y, error{};
  bool points = false;  ///< markers instead of a line
  bool joined = false;  ///< markers on a thin line
  bool steps = false;   ///< each value holds until the next x
  bool filled = false;  ///< the area below is shaded
  int colour = -1;      ///< number of its colour, so that one thing has one colour everywhere; -1: its place
};

struct Chart {
  std::string title, x_label, y_label;  ///< labels carry units
  std::vector<Series> series{};
  bool log_x = false, log_y = false;
  std::optional<std::pair<double, double>> window{};  ///< shaded from, to: what means are taken over
};

/// A number people look for first.
struct Tile {
  std::string label, value, error{},
      unit{};  ///< error: one standard error with the digits of the value, or ""
};
/// With two digits of the error (stated_number.h).
Tile tile(const std::string& label, const std::string& unit, double value, double error);

/// A bed to turn and slice.
struct BedPicture {
  std::vector<Vec3> position_m;
  std::vector<double> radius_m;
  std::vector<std::pair<std::string, std::vector<double>>> columns;  ///< to colour by; labels carry units
  std::vector<std::vector<Vec3>> walls;                              ///< outlines
  Vec3 low, high;                                                    ///< corners of what is shown
};

/// A self-contained HTML page, light, dark and printed: what draws is inside it (dem/page/assets), nothing is loaded.
class HtmlReport {
 public:
  explicit HtmlReport(std::string title);
  void heading(const std::string& text);
  void paragraph(const std::string& text);
  /// The first sentence: what it came to, and whether that can be trusted.
  void verdict(const std::string& text, bool good);
  void tiles(const std::vector<Tile>& tiles);
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// A table with a list of the values of each of these columns above it, and a search over all, to show some rows.
  void filtered_table(const std::vector<std::string>& header,
                      const std::vector<std::vector<std::string>>& rows, const std::vector<std::size_t>& by);
  /// Charts that follow each other stand side by side where there is room.
  void chart(const Chart& chart);
  /// Charts as histograms of equal bins over the joint range, normalised to unit area.
  void histogram(const std::string& title, const std::string& x_label,
                 const std::vector<std::pair<std::string, std::vector<double>>>& samples, int bins = 40);
  void bed(const std::string& title, const BedPicture& picture);
  /// Last lines: where the numbers come from ("command", "granrun run ..."; "threads", "2").
  void provenance(const std::vector<std::pair<std::string, std::string>>& lines);
  /// The same of this process: command, host, date, threads.
  void provenance_of_this_process();
  void write(const std::filesystem::path& file) const;  ///< temporary name, then rename; throws IoError

 private:
  void end_charts();
  std::string title_, body_, provenance_;
  bool in_charts_ = false, has_figures_ = false, has_filters_ = false;
};

}  // namespace granrad
