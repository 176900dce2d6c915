#include <fmt/core.h>
#include <sys/wait.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/simulation/case_folder.h"
#include "coupling/study/child_process.h"
#include "coupling/study/claims.h"
#include "dem/base/error.h"
#include "dem/base/files/text_file.h"

namespace granrad {

namespace fs = std::filesystem;

namespace {

struct Point {
  Measured x, y;
};

std::vector<Point> points_of(const StudyFit& fit, const std::vector<StudyRow>& rows) {
  std::vector<Point> points;
  for (const auto& row : rows) {
    if (row.of->group != fit.group) continue;
    const auto x = row.quantity.find(fit.x), y = row.quantity.find(fit.y);
    if (x == row.quantity.end() || y == row.quantity.end() || !std::isfinite(y->second.value)) continue;
    if (fit.x_min < fit.x_max && (x->second.value < fit.x_min || x->second.value > fit.x_max)) continue;
    points.push_back({x->second, y->second});
  }
  return points;
}

void read_result(const fs::path& file, FittedCurve& curve) {
  const auto json = nlohmann::json::parse(read_text_file(file), nullptr, false);
  if (!json.is_object()) throw IoError(fmt::format("{}: is no JSON object", file.string()));
  curve.formula = json.value("formula", "");
  for (const auto& [name, one] : json.at("coefficients").items())
    curve.coefficient[name] = {one.at("value").get<double>(), one.at("standard_error").get<double>()};
  curve.coefficient["R2"] = {json.value("R2", 0.0), 0};
}

FittedCurve fit_curve(const StudyFit& fit, const std::vector<StudyRow>& rows, const fs::path& folder) {
  FittedCurve curve{fit, "", {}, 0, ""};
  const auto points = points_of(fit, rows);
  curve.points = points.size();
  std::string data = "x,y\n";
  for (const auto& p : points) data += fmt::format("{:.12g},{:.12g}\n", p.x.value, p.y.value);
  const fs::path in = folder / (fit.name + ".csv"), out = folder / (fit.name + ".json"),
                 log = folder / (fit.name + ".log");
  write_text_file(in, data);
  fs::remove(out);
  fs::remove(log);
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "vfgen";
  const pid_t child = start_child({fs::exists(beside) ? beside.string() : "vfgen", "curve", in.string(),
                                   "--form", fit.form, "-o", out.string(), "-q"},
                                  open_case_log(log));
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    read_result(out, curve);
  else
    curve.problem = read_text_file(log);
  return curve;
}

}  // namespace

std::vector<FittedCurve> fit_curves(const Study& study, const std::vector<StudyRow>& rows,
                                    const fs::path& folder) {
  std::vector<FittedCurve> curves;
  for (const auto& fit : study.fits) curves.push_back(fit_curve(fit, rows, folder / "fits"));
  return curves;
}

}  // namespace granrad
