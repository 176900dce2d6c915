#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace granrad {

/// One series of a chart. `error` (one sigma) draws bars where given.
struct Series {
  std::string label;
  std::vector<double> x, y, error;
  bool points = false;  ///< markers instead of a line
};

struct Chart {
  std::string title, x_label, y_label;  ///< labels carry units
  std::vector<Series> series;
  bool log_x = false, log_y = false;
};

/// A self-contained HTML page (inline SVG and CSS, no scripts from elsewhere, light and dark).
class HtmlReport {
 public:
  explicit HtmlReport(std::string title);
  void heading(const std::string& text);
  void paragraph(const std::string& text);
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  void chart(const Chart& chart);
  /// Charts as histograms of equal bins over the joint range, normalised to unit area.
  void histogram(const std::string& title, const std::string& x_label,
                 const std::vector<std::pair<std::string, std::vector<double>>>& samples, int bins = 40);
  void write(const std::filesystem::path& file) const;  ///< temporary name, then rename; throws IoError

 private:
  std::string title_, body_;
};

}  // namespace granrad
