#include "dem/base/processors.h"
#include "dem/base/constants.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

namespace granrad {
namespace {

namespace fs = std::filesystem;
constexpr double unlimited = infinity;

std::string first_words(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

/// "200000 100000" or "max 100000"; unlimited where there is no such file.
double granted_in(const fs::path& group) {
  double quota = 0, period = 0;
  if (std::istringstream words(first_words(group / "cpu.max")); words >> quota >> period && period > 0)
    return quota / period;
  std::istringstream given(first_words(group / "cpu.cfs_quota_us")),
      each(first_words(group / "cpu.cfs_period_us"));
  return given >> quota && each >> period && quota > 0 && period > 0 ? quota / period : unlimited;
}

/// The least of a group and those above it, below `top`.
double granted_up_to(const fs::path& top, fs::path group) {
  double least = granted_in(top);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path())
    least = std::min(least, granted_in(top / group));
  return least;
}

}  // namespace

double granted_processors(const fs::path& groups, const fs::path& mount) {
  double least = unlimited;
  std::ifstream in(groups);
  for (std::string line; std::getline(in, line);) {  // number:controllers:path
    const auto first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string names = line.substr(first + 1, second - first - 1),
                      controllers = fmt::format(",{},", names);
    const fs::path path = line.substr(second + 1);
    if (controllers == ",,")
      least = std::min({least, granted_up_to(mount, path), granted_up_to(mount / "unified", path)});
    else if (controllers.find(",cpu,") != std::string::npos)
      least = std::min({least, granted_up_to(mount / "cpu", path), granted_up_to(mount / names, path)});
  }
  return least;
}

void respect_granted_processors() {
  if (std::getenv("OMP_NUM_THREADS")) return;
  const double granted = std::ceil(granted_processors());
  if (granted >= 1 && granted < omp_get_max_threads()) omp_set_num_threads(static_cast<int>(granted));
}

}  // namespace granrad
