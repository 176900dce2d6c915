#include <fmt/core.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/base/files/text_file.h"
#include "dem/base/program.h"
#include "dem/bed/wall_columns.h"
#include "dem/io/frame_layout.h"
#include "dem/io/snapshot.h"

namespace granrad {

namespace {

static_assert(sizeof(Vec3) == 3 * sizeof(double));

void write_values(Hdf5Writer& out, const std::string& name, const std::vector<Vec3>& values) {
  out.write(name, values.empty() ? nullptr : &values[0].x, values.size(), 3);
}
template <class T>
void write_values(Hdf5Writer& out, const std::string& name, const std::vector<T>& values) {
  out.write(name, values);
}

bool finite(double value) {
  return std::isfinite(value);
}
bool finite(const Vec3& value) {
  return is_finite(value);
}

/// Throws NumericalError: what is not finite must not leave the program.
void check(const std::filesystem::path& file, const Bed& bed,
           const std::map<std::string, std::vector<double>>& extra) {
  for_each_column([&](const auto& column) {
    const auto& values = bed.*column.values;
    for (std::size_t i = 0; i < bed.size(); ++i)
      if (!finite(values[i]))
        throw NumericalError(fmt::format("{}: {} of particle {} is not finite; nothing written",
                                         file.string(), column.name, bed.id[i]));
  });
  for (const auto& [name, column] : extra)
    if (column.size() != bed.size())
      throw NumericalError(fmt::format("{}: column {} has {} values for {} particles", file.string(), name,
                                       column.size(), bed.size()));
}

/// The particles as VTKHDF vertices, for viewers.
void write_vtk(Hdf5Writer& out, const Bed& bed, const std::map<std::string, std::vector<double>>& extra) {
  const std::int64_t n = static_cast<std::int64_t>(bed.size());
  constexpr std::uint8_t vtk_vertex = 1;
  std::vector<std::int64_t> index(n + 1);
  std::iota(index.begin(), index.end(), 0);
  out.group("/VTKHDF");
  out.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  out.fixed_text_attribute("/VTKHDF", "Type", "UnstructuredGrid");
  for (const char* count : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
    out.write(fmt::format("/VTKHDF/{}", count), std::vector<std::int64_t>{n});
  out.write("/VTKHDF/Connectivity", index.data(), bed.size());
  out.write("/VTKHDF/Offsets", index);
  out.write("/VTKHDF/Types", std::vector<std::uint8_t>(n, vtk_vertex));
  for_each_column([&](const auto& column) { write_values(out, view_path(column), bed.*column.values); });
  for (const auto& [name, column] : extra) out.write("/VTKHDF/PointData/" + name, column);
}

void write_contacts(Hdf5Writer& out, const std::vector<ContactMemory>& contacts) {
  std::vector<std::int64_t> first, second;
  std::vector<Vec3> displacement;
  for (const auto& c : contacts) {
    first.push_back(c.first);
    second.push_back(c.second);
    displacement.push_back(c.displacement_m);
  }
  out.write("/granrad/contacts/first", first);
  out.write("/granrad/contacts/second", second);
  write_values(out, "/granrad/contacts/displacement_m", displacement);
}

void write_materials(Hdf5Writer& out, const std::vector<Material>& materials) {
  std::vector<std::string> names;
  for (const auto& m : materials) names.push_back(m.name);
  out.write("/granrad/materials/name", names);
  for (const auto& number : material_numbers()) {
    std::vector<double> column;
    for (const auto& m : materials) column.push_back(m.*number.value);
    out.write(fmt::format("/granrad/materials/{}", number.key), column);
  }
}

void write_walls(Hdf5Writer& out, const std::vector<Wall>& walls) {
  const WallColumns c = columns_of(walls);
  const std::string at = "/granrad/walls/";
  out.write(at + "name", c.name);
  out.write(at + "role", c.role);
  out.write(at + "contact", c.contact);
  out.write(at + "temperature_K", c.temperature_K);
  out.write(at + "emissivity", c.emissivity);
  out.write(at + "opens_at_s", c.opens_at_s);
  write_values(out, at + "velocity_m_s", c.velocity_m_s);
  write_values(out, at + "vertices_m", c.vertices_m);
  out.write(at + "vertex_begin", c.vertex_begin);
  out.write(at + "triangles", c.triangles.data(), c.triangles.size() / 3, 3);
  out.write(at + "triangle_begin", c.triangle_begin);
}

void write_state(Hdf5Writer& out, const StateBlocks& state) {
  out.group("/granrad/state");
  for (const auto& [block, columns] : state) {
    out.group("/granrad/state/" + block);
    for (const auto& [name, values] : columns.integers)
      out.write(fmt::format("/granrad/state/{}/{}", block, name), values);
    for (const auto& [name, values] : columns.reals)
      out.write(fmt::format("/granrad/state/{}/{}", block, name), values);
  }
}

}  // namespace

void write_frame(const std::filesystem::path& file, const Bed& bed, const StateBlocks& state,
                 const std::map<std::string, std::vector<double>>& extra) {
  check(file, bed, extra);
  Hdf5Writer out(file);
  write_vtk(out, bed, extra);
  out.group("/granrad");
  out.attribute("/granrad", "format", frame_format);
  out.attribute("/granrad", "version", std::vector<std::int64_t>{frame_version});
  out.attribute("/granrad", "program_version", program_version());
  out.attribute("/granrad", "git_sha", program_git_sha());
  out.attribute("/granrad", "time_s", bed.time_s);
  out.attribute("/granrad", "step", std::vector<std::int64_t>{bed.step});
  out.attribute("/granrad", "next_id", std::vector<std::int64_t>{bed.next_id});
  for_each_column([&](const auto& column) {
    out.link(view_path(column), fmt::format("/granrad/particles/{}", column.name));
  });
  write_contacts(out, bed.contacts);
  write_materials(out, bed.materials);
  write_walls(out, bed.walls);
  write_values(out, "/granrad/box", {bed.box.min, bed.box.max});
  out.write("/granrad/periodic", std::vector<std::uint8_t>(bed.periodic.begin(), bed.periodic.end()));
  write_state(out, state);
  out.commit();
}

void write_series(const std::filesystem::path& series_file,
                  const std::vector<std::pair<std::filesystem::path, double>>& frames) {
  nlohmann::ordered_json series{{"file-series-version", "1.0"}, {"files", nlohmann::ordered_json::array()}};
  const auto folder = std::filesystem::absolute(series_file).parent_path();
  for (const auto& [file, time_s] : frames)
    series["files"].push_back(
        {{"name", std::filesystem::absolute(file).lexically_relative(folder).generic_string()},
         {"time", time_s}});
  write_text_file(series_file, series.dump(1) + "\n");
}

}  // namespace granrad
