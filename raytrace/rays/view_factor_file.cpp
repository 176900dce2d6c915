#include "raytrace/rays/view_factor_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/base/program.h"
#include "dem/bed/wall_columns.h"

namespace granrad {

namespace {

constexpr const char* format_name = "granrad.view_factors";
constexpr const char* periodic_name[3] = {"periodic_x", "periodic_y", "periodic_z"};
/// In the order of pair_kind.
constexpr std::array<const char*, 4> pair_kind_names = {"particle_particle", "particle_wall", "wall_particle",
                                                        "wall_wall"};
constexpr std::int32_t kind_particle = 0, kind_wall = 1, kind_open = 2;

template <class T>
void write_some(Hdf5Writer& out, const std::string& name, const std::vector<T>& values) {
  if (!values.empty()) out.write(name, values);
}

template <class T>
std::vector<T> read_some(const Hdf5Reader& in, const std::string& name, std::size_t columns = 1) {
  return in.has(name) ? in.read<T>(name, columns) : std::vector<T>{};
}

void write_points(Hdf5Writer& out, const std::string& name, const std::vector<Vec3>& points) {
  if (!points.empty()) out.write(name, &points[0].x, points.size(), 3);
}

std::vector<Vec3> read_points(const Hdf5Reader& in, const std::string& name) {
  const auto flat = read_some<double>(in, name, 3);
  std::vector<Vec3> points;
  for (std::size_t k = 0; k + 2 < flat.size(); k += 3) points.push_back({flat[k], flat[k + 1], flat[k + 2]});
  return points;
}

void write_surfaces(Hdf5Writer& out, const ViewFactorFile& content, const std::vector<double>& area_m2) {
  const Enclosure& e = content.enclosure;
  std::vector<std::int32_t> kind(e.sphere_count(), kind_particle);
  std::vector<std::string> name;
  for (std::size_t i = 0; i < e.sphere_count(); ++i) name.push_back(fmt::format("particle_{}", i));
  for (const Wall& wall : e.walls) {
    kind.push_back(kind_wall);
    name.push_back(wall.name);
  }
  kind.push_back(kind_open);
  name.push_back("open");
  out.write("/surfaces/kind", kind);
  out.write("/surfaces/area", area_m2);
  out.write("/surfaces/name", name);
  const std::vector<double> black(area_m2.size(), 1);
  out.write("/surfaces/emissivity", content.emissivity.empty() ? black : content.emissivity);
}

void write_factors(Hdf5Writer& out, const ExchangeAreas& closed, const std::vector<double>& bound) {
  const auto [value, error] = closed_factors(closed);
  out.write("/view_factors/row_begin", closed.pattern.row_begin);
  write_some(out, "/view_factors/column", closed.pattern.column);
  write_some(out, "/view_factors/value", value);
  write_some(out, "/view_factors/standard_error", error);
  out.write("/view_factors/zero_hit_bound", bound);
}

void write_rays(Hdf5Writer& out, const HitCounts& counts) {
  out.write("/rays/launched", counts.launched);
  out.write("/rays/row_begin", counts.pattern.row_begin);
  write_some(out, "/rays/column", counts.pattern.column);
  write_some(out, "/rays/hits", counts.hits);
  for (std::size_t kind = 0; kind < pair_kind_names.size(); ++kind)
    write_some(out, fmt::format("/rays/variance_factor/{}", pair_kind_names[kind]),
               counts.variance_factor[kind]);
  write_some(out, "/rays/variance_factor/each_wall_wall", counts.wall_variance_factor);
  out.attribute("/rays", "leaked", std::vector<std::int64_t>{counts.leaked});
  out.attribute("/rays", "thinning_unit", std::vector<std::int64_t>{counts.thinning_unit});
  if (counts.directions > 0)
    out.attribute("/rays", "directions", std::vector<std::int64_t>{counts.directions});
  out.attribute("/rays", "sum_variance_factor", counts.sum_variance_factor);
  out.attribute("/rays", "mean_chord_m", counts.mean_chord_m);
  out.attribute("/rays", "mean_chord_error_m", counts.mean_chord_error_m);
}

void write_snapshot(Hdf5Writer& out, const ViewFactorFile& content) {
  const Enclosure& e = content.enclosure;
  out.group("/snapshot");
  write_points(out, "/snapshot/centre", e.centre_m);
  write_some(out, "/snapshot/radius", e.radius_m);
  write_some(out, "/snapshot/particle", e.particle);
  const WallColumns walls = columns_of(e.walls);
  write_points(out, "/snapshot/wall_vertex", walls.vertices_m);
  out.write("/snapshot/wall_vertex_begin", walls.vertex_begin);
  if (!walls.triangles.empty())
    out.write("/snapshot/wall_triangle", walls.triangles.data(), walls.triangles.size() / 3, 3);
  out.write("/snapshot/wall_triangle_begin", walls.triangle_begin);
  std::vector<std::string> role;
  for (const Wall& wall : e.walls) role.emplace_back(to_string(wall.role));
  if (!role.empty()) out.write("/snapshot/wall_role", role);
  write_some(out, "/snapshot/wall_temperature", walls.temperature_K);
  write_some(out, "/snapshot/wall_emissivity", walls.emissivity);
  write_points(out, "/snapshot/box", {e.box.min, e.box.max});
  for (int axis = 0; axis < 3; ++axis)
    out.attribute("/snapshot", periodic_name[axis], std::vector<std::int64_t>{e.periodic[axis]});
  out.attribute("/snapshot", "origin", content.origin);
  if (e.solid_fraction > 0) out.attribute("/snapshot", "solid_fraction", e.solid_fraction);
}

void write_origin(Hdf5Writer& out, const ViewFactorFile& content) {
  out.variable_text_attribute("/", "format", std::string(format_name));
  out.attribute("/", "version", std::vector<std::int64_t>{view_factor_version});
  out.variable_text_attribute("/", "method", content.method);
  out.attribute("/", "seed", std::vector<std::int64_t>{static_cast<std::int64_t>(content.seed)});
  out.variable_text_attribute("/", "closure",
                              std::string(content.closure == Closure::reciprocal ? "reciprocal" : "row_sum"));
  out.attribute("/", "closure_correction_max", content.closure_correction_max);
  out.attribute("/", "emissivity", content.emissivity.empty() ? 1.0 : content.emissivity.front());
  out.variable_text_attribute("/", "git_sha", std::string(program_git_sha()));
  out.attribute("/", "closure_defect", content.check.closure_defect);
  out.attribute("/", "reciprocity_chi2", content.check.reciprocity_chi2);
  out.attribute("/", "mean_chord_ratio", content.check.mean_chord_ratio);
  out.variable_text_attribute("/", "failed", content.check.failed);
}

void write_spent(Hdf5Writer& out, const ViewFactorFile& content) {
  out.group("/spent");
  out.attribute("/spent", "sampling", content.sampling);
  out.attribute("/spent", "rays", std::vector<std::int64_t>{content.spent.rays});
  out.attribute("/spent", "rounds", std::vector<std::int64_t>{content.spent.rounds});
  out.attribute("/spent", "stated",
                std::string(content.hot_walls.empty() ? "particle_wall_sums" : "particle_fluxes"));
  out.attribute("/spent", "hot_walls", content.hot_walls);
  out.attribute("/spent", "error", content.spent.error);
  out.attribute("/spent", "error_target", content.error_target);
}

void read_spent(const Hdf5Reader& in, ViewFactorFile& content) {
  content.sampling = in.text_attribute("/spent", "sampling");
  content.spent.rays = in.integer_attribute("/spent", "rays");
  content.spent.rounds = static_cast<int>(in.integer_attribute("/spent", "rounds"));
  content.spent.error = in.real_attribute("/spent", "error");
  content.error_target = in.real_attribute("/spent", "error_target");
  content.hot_walls = in.text_attribute("/spent", "hot_walls");
}

/// What is read may be anything: no index, length or offset is used before it is known to be sound.
void sound(bool holds, const char* what) {
  if (!holds) throw IoError(fmt::format("{} is inconsistent (the file is damaged)", what));
}

bool all_finite(const std::vector<double>& values, double least) {
  return std::all_of(values.begin(), values.end(), [&](double v) { return std::isfinite(v) && v >= least; });
}

/// Rises from 0 to `total` in `count` parts.
bool are_parts(const std::vector<std::int64_t>& begin, std::size_t count, std::size_t total) {
  return begin.size() == count + 1 && begin.front() == 0 && std::is_sorted(begin.begin(), begin.end()) &&
         begin.back() == static_cast<std::int64_t>(total);
}

/// Rows of `surfaces` columns, in rising order.
void refuse_unsound(const SparsePattern& pattern, std::size_t surfaces, const char* what) {
  sound(are_parts(pattern.row_begin, surfaces, pattern.column.size()), what);
  for (std::size_t i = 0; i < surfaces; ++i)
    for (auto k = pattern.row_begin[i]; k < pattern.row_begin[i + 1]; ++k) {
      const auto column = pattern.column[static_cast<std::size_t>(k)];
      sound(column >= 0 && column < static_cast<std::int64_t>(surfaces) &&
                (k == pattern.row_begin[i] || pattern.column[static_cast<std::size_t>(k) - 1] < column),
            what);
    }
}

std::int32_t role_number(const std::string& text) {
  if (const auto role = wall_roles.value(text)) return static_cast<std::int32_t>(*role);
  throw IoError(advised(fmt::format("wall_role = '{}' (not a role)", text), "trace the snapshot again"));
}

void read_walls(const Hdf5Reader& in, Enclosure& e, const std::vector<std::string>& surface_names) {
  WallColumns c;
  c.vertex_begin = in.read<std::int64_t>("/snapshot/wall_vertex_begin");
  if (c.vertex_begin.size() < 2) return;
  c.vertices_m = read_points(in, "/snapshot/wall_vertex");
  c.triangles = read_some<std::int32_t>(in, "/snapshot/wall_triangle", 3);
  c.triangle_begin = in.read<std::int64_t>("/snapshot/wall_triangle_begin");
  for (const auto& role : in.read_texts("/snapshot/wall_role")) c.role.push_back(role_number(role));
  c.temperature_K = in.read<double>("/snapshot/wall_temperature");
  c.emissivity = in.read<double>("/snapshot/wall_emissivity");
  for (std::size_t w = 0; w + 1 < c.vertex_begin.size(); ++w)
    c.name.push_back(surface_names.at(e.sphere_count() + w));
  try {
    e.walls = walls_from(c);
  } catch (const InputError& error) {
    throw IoError(fmt::format("/snapshot: {} is inconsistent (the file is damaged)", error.what()));
  }
  for (std::size_t w = 0; w < e.walls.size(); ++w) e.wall.push_back(static_cast<std::int32_t>(w));
}

Enclosure read_enclosure(const Hdf5Reader& in) {
  Enclosure e;
  e.centre_m = read_points(in, "/snapshot/centre");
  e.radius_m = read_some<double>(in, "/snapshot/radius");
  e.particle = read_some<std::int32_t>(in, "/snapshot/particle");
  sound(e.radius_m.size() == e.centre_m.size() && e.particle.size() == e.centre_m.size() &&
            all_finite(e.radius_m, std::numeric_limits<double>::min()) &&
            std::all_of(e.centre_m.begin(), e.centre_m.end(), [](const Vec3& c) { return is_finite(c); }) &&
            std::all_of(e.particle.begin(), e.particle.end(), [](std::int32_t p) { return p >= 0; }),
        "/snapshot (spheres)");
  const auto names = in.read_texts("/surfaces/name");
  const auto walls = in.read<std::int64_t>("/snapshot/wall_vertex_begin");
  sound(names.size() == e.sphere_count() + std::max<std::size_t>(walls.size(), 1), "/surfaces/name");
  read_walls(in, e, names);
  const auto box = read_points(in, "/snapshot/box");
  sound(box.size() == 2 && is_finite(box[0]) && is_finite(box[1]), "/snapshot/box");
  e.box = {box.at(0), box.at(1)};
  for (int axis = 0; axis < 3; ++axis)
    e.periodic[axis] = in.integer_attribute("/snapshot", periodic_name[axis]) != 0;
  if (in.has_attribute("/snapshot", "solid_fraction"))
    e.solid_fraction = in.real_attribute("/snapshot", "solid_fraction");
  return e;
}

HitCounts read_rays(const Hdf5Reader& in, std::size_t surfaces) {
  HitCounts counts;
  counts.launched = in.read<std::int64_t>("/rays/launched");
  counts.pattern.row_begin = in.read<std::int64_t>("/rays/row_begin");
  counts.pattern.column = read_some<std::int32_t>(in, "/rays/column");
  counts.hits = read_some<std::int64_t>(in, "/rays/hits");
  const auto not_negative = [](std::int64_t count) { return count >= 0; };
  sound(counts.launched.size() == surfaces && counts.hits.size() == counts.pattern.column.size() &&
            std::all_of(counts.launched.begin(), counts.launched.end(), not_negative) &&
            std::all_of(counts.hits.begin(), counts.hits.end(), not_negative),
        "/rays");
  refuse_unsound(counts.pattern, surfaces, "/rays");
  for (std::size_t kind = 0; kind < pair_kind_names.size(); ++kind)
    counts.variance_factor[kind] =
        read_some<double>(in, fmt::format("/rays/variance_factor/{}", pair_kind_names[kind]));
  counts.wall_variance_factor = read_some<double>(in, "/rays/variance_factor/each_wall_wall");
  counts.leaked = in.integer_attribute("/rays", "leaked");
  counts.thinning_unit = in.integer_attribute("/rays", "thinning_unit");
  if (in.has_attribute("/rays", "directions"))
    counts.directions = in.integer_attribute("/rays", "directions");
  counts.sum_variance_factor = in.real_attribute("/rays", "sum_variance_factor");
  counts.mean_chord_m = in.real_attribute("/rays", "mean_chord_m");
  counts.mean_chord_error_m = in.real_attribute("/rays", "mean_chord_error_m");
  return counts;
}

ExchangeAreas read_closed(const Hdf5Reader& in, const std::vector<double>& area_m2) {
  ExchangeAreas closed;
  closed.area_m2 = area_m2;
  closed.pattern.row_begin = in.read<std::int64_t>("/view_factors/row_begin");
  closed.pattern.column = read_some<std::int32_t>(in, "/view_factors/column");
  closed.value = read_some<double>(in, "/view_factors/value");
  const auto error = read_some<double>(in, "/view_factors/standard_error");
  refuse_unsound(closed.pattern, area_m2.size(), "/view_factors");
  sound(closed.value.size() == closed.pattern.column.size() && error.size() == closed.value.size() &&
            all_finite(closed.value, 0) && all_finite(error, 0),
        "/view_factors");
  for (std::size_t i = 0; i < area_m2.size(); ++i)
    for (auto k = closed.pattern.row_begin[i]; k < closed.pattern.row_begin[i + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      closed.value[at] *= area_m2[i];
      closed.variance.push_back(error[at] * error[at] * area_m2[i] * area_m2[i]);
    }
  return closed;
}

void check_format(const Hdf5Reader& in, const std::string& file) {
  if (!in.has_attribute("/", "format") || in.text_attribute("/", "format") != format_name)
    throw InputError(fmt::format("{}: not a view-factor file (no format = \"{}\"); make one with vfgen trace",
                                 file, format_name));
  if (const auto version = in.integer_attribute("/", "version"); version != view_factor_version)
    throw InputError(
        fmt::format("{}: version = {} (this program reads {}); {}", file, version, view_factor_version,
                    version > view_factor_version ? "use a newer program" : "trace the snapshot again"));
}

ViewFactorFile read_content(const Hdf5Reader& in) {
  ViewFactorFile content;
  content.enclosure = read_enclosure(in);
  content.emissivity = in.read<double>("/surfaces/emissivity");
  const std::size_t surfaces = content.enclosure.surface_count();
  content.counts = read_rays(in, surfaces);
  const std::size_t walls = surfaces - content.enclosure.sphere_count();
  const auto& of_walls = content.counts.wall_variance_factor;
  sound(of_walls.empty() || (of_walls.size() == walls * walls && all_finite(of_walls, 0)),
        "/rays/variance_factor");
  auto area = in.read<double>("/surfaces/area");
  sound(area.size() == surfaces && content.emissivity.size() == surfaces && all_finite(area, 0) &&
            all_finite(content.emissivity, 0) &&
            *std::max_element(content.emissivity.begin(), content.emissivity.end()) <= 1,
        "/surfaces");
  for (std::size_t i = 0; i < area.size(); ++i) area[i] *= content.emissivity[i];
  content.closed = read_closed(in, area);
  content.counts.area_m2 = area;
  content.counts.spheres = static_cast<std::int32_t>(content.enclosure.sphere_count());
  content.counts.area_m2.back() = 0;
  content.method = in.text_attribute("/", "method");
  content.seed = static_cast<std::uint64_t>(in.integer_attribute("/", "seed"));
  content.closure = in.text_attribute("/", "closure") == "row_sum" ? Closure::row_sum : Closure::reciprocal;
  content.closure_correction_max = in.real_attribute("/", "closure_correction_max");
  content.origin = in.text_attribute("/snapshot", "origin");
  content.check.closure_defect = in.real_attribute("/", "closure_defect");
  content.check.reciprocity_chi2 = in.real_attribute("/", "reciprocity_chi2");
  content.check.mean_chord_ratio = in.real_attribute("/", "mean_chord_ratio");
  content.check.failed = in.text_attribute("/", "failed");
  content.check.leaked = content.counts.leaked;
  read_spent(in, content);
  return content;
}

}  // namespace

ClosedFactors closed_factors(const ExchangeAreas& closed) {
  ClosedFactors factors{std::vector<double>(closed.value.size(), 0),
                        std::vector<double>(closed.value.size(), 0)};
  for (std::size_t i = 0; i < closed.area_m2.size(); ++i)
    for (auto k = closed.pattern.row_begin[i]; k < closed.pattern.row_begin[i + 1]; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!(closed.area_m2[i] > 0)) continue;
      factors.value[at] = closed.value[at] / closed.area_m2[i];
      if (!closed.variance.empty())
        factors.standard_error[at] = std::sqrt(closed.variance[at]) / closed.area_m2[i];
    }
  return factors;
}

void write_view_factors(const std::filesystem::path& file, const ViewFactorFile& content) {
  std::vector<double> area = surface_areas(content.enclosure);
  area.back() = content.closed.area_m2.back();
  Hdf5Writer out(file);
  write_surfaces(out, content, area);
  write_factors(out, content.closed, zero_hit_bound(content.counts));
  write_rays(out, content.counts);
  write_snapshot(out, content);
  write_origin(out, content);
  write_spent(out, content);
  out.commit();
}

ViewFactorFile read_view_factors(const std::filesystem::path& file) {
  const Hdf5Reader in(file);
  check_format(in, file.string());
  try {
    return read_content(in);
  } catch (const Error& error) {  // whatever is missing or wrong inside: the file is not as it was written
    const std::string what = error.what();
    throw IoError(what.starts_with(file.string()) ? what : fmt::format("{}: {}", file.string(), what));
  }
}

}  // namespace granrad
