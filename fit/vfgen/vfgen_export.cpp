#include <fmt/format.h>

#include <iterator>
#include <optional>

#include "dem/base/error.h"
#include "dem/base/files/csv.h"
#include "dem/base/files/npz_file.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/bed/wall_shape.h"
#include "fit/vfgen/vfgen_commands.h"
#include "raytrace/rays/view_factor_file.h"

namespace granrad {

namespace {

namespace fs = std::filesystem;

std::vector<std::string> surface_names(const Enclosure& e) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < e.sphere_count(); ++i) names.push_back(fmt::format("particle_{}", i));
  for (const Wall& wall : e.walls) names.push_back(wall.name);
  names.emplace_back("open");
  return names;
}

/// Of the pairs that have a distance: centres (of the nearest periodic image), or the centre and the plane of a wall.
class Distances {
 public:
  explicit Distances(const Enclosure& e) : enclosure_(e) {
    periods_.periodic = e.periodic;
    periods_.box = e.box;
    for (const Wall& wall : e.walls) planes_.push_back(plane_of(wall));
  }
  std::optional<double> between(std::size_t i, std::size_t j) const {
    const std::size_t spheres = enclosure_.sphere_count();
    if (i > j) std::swap(i, j);
    if (i >= spheres || j == enclosure_.open_surface()) return {};
    if (j < spheres) return norm(nearest_image(periods_, enclosure_.centre_m[j] - enclosure_.centre_m[i]));
    const auto& plane = planes_[j - spheres];
    if (!plane) return {};
    return plane->height(enclosure_.centre_m[i]);
  }

 private:
  const Enclosure& enclosure_;
  Bed periods_;
  std::vector<std::optional<WallPlane>> planes_;
};

template <class Visit>  // (row, column, place)
void for_each_entry(const SparsePattern& pattern, Visit&& visit) {
  for (std::size_t i = 0; i + 1 < pattern.row_begin.size(); ++i)
    for (auto k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k)
      visit(i, static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(k)]),
            static_cast<std::size_t>(k));
}

std::string csv_of(const ViewFactorFile& traced, const ClosedFactors& factors) {
  const auto names = surface_names(traced.enclosure);
  const Distances distances(traced.enclosure);
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "from,to,from_name,to_name,factor,standard_error,distance_m\n");
  for_each_entry(traced.closed.pattern, [&](std::size_t i, std::size_t j, std::size_t k) {
    const auto distance = distances.between(i, j);
    fmt::format_to(out, "{},{},{},{},{},{},{}\n", i, j, text_cell(names[i]), text_cell(names[j]),
                   factors.value[k], factors.standard_error[k],
                   distance ? fmt::format("{}", *distance) : std::string());
  });
  return fmt::to_string(text);
}

std::string matrix_market(const SparsePattern& pattern, const std::vector<double>& values,
                          const std::string& what) {
  const std::size_t surfaces = pattern.row_begin.size() - 1;
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "%%MatrixMarket matrix coordinate real general\n% {}\n{} {} {}\n", what, surfaces,
                 surfaces, values.size());
  for_each_entry(pattern, [&](std::size_t i, std::size_t j, std::size_t k) {
    fmt::format_to(out, "{} {} {}\n", i + 1, j + 1, values[k]);
  });
  return fmt::to_string(text);
}

/// What scipy.sparse.load_npz reads, and more arrays beside it.
void write_npz(const ViewFactorFile& traced, const ClosedFactors& factors, const fs::path& file) {
  const Enclosure& e = traced.enclosure;
  const auto surfaces = static_cast<std::int64_t>(e.surface_count());
  const std::vector<std::int64_t> shape = {surfaces, surfaces};
  const auto bound = zero_hit_bound(traced.counts);
  const std::vector<double> black(e.surface_count(), 1);
  NpzWriter npz;
  npz.add_scalar("format", "csr");
  npz.add("shape", shape);
  npz.add("indptr", traced.closed.pattern.row_begin);
  npz.add("indices", traced.closed.pattern.column);
  npz.add("data", factors.value);
  npz.add("standard_error", factors.standard_error);
  npz.add("zero_hit_bound", bound);
  npz.add("area_m2", traced.closed.area_m2);
  npz.add("emissivity", traced.emissivity.empty() ? black : traced.emissivity);
  npz.add("name", surface_names(e));
  npz.add("centre_m", e.centre_m);
  npz.add("radius_m", e.radius_m);
  npz.write(file);
}

fs::path beside(const fs::path& file, const std::string& ending) {
  fs::path target = file;
  return target.replace_extension(ending);
}

}  // namespace

int run_export(const ExportCommand& command, Verbosity verbosity) {
  if (command.format == "aspherix")
    throw InputError(advised("--to aspherix (the format of its tables of view factors is not published)",
                             "use csv: distance_m and factor are the columns of such a table"));
  const ViewFactorFile traced = read_view_factors(command.file);
  const ClosedFactors factors = closed_factors(traced.closed);
  const fs::path target =
      command.output.empty() ? beside(command.file, "." + command.format) : command.output;
  std::vector<fs::path> written = {target};
  const std::string what = traced.emissivity.empty() ? "view factors F_ij" : "total exchange factors D_ij";
  if (command.format == "csv") {
    write_text_file(target, csv_of(traced, factors));
  } else if (command.format == "npz") {
    write_npz(traced, factors, target);
  } else {
    written.push_back(beside(target, ".standard_error.mtx"));
    write_text_file(target, matrix_market(traced.closed.pattern, factors.value, what));
    write_text_file(written[1], matrix_market(traced.closed.pattern, factors.standard_error,
                                              "standard errors of the " + what));
  }
  if (verbosity != Verbosity::quiet)
    for (const auto& file : written) fmt::print("{}\n", file.string());
  return exit_ok;
}

}  // namespace granrad
