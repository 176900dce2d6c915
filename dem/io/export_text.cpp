#include "dem/io/export_text.h"

#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "dem/bed/columns.h"

namespace granrad {

namespace {

using Text = fmt::memory_buffer;

/// The bed as it leaves: positions inside the periods.
Bed wrapped(Bed bed) {
  for (Vec3& p : bed.position_m) p = wrapped_into_box(bed, p);
  return bed;
}

template <class T>
void append(Text& out, const T& value, char separator) {
  fmt::format_to(std::back_inserter(out), "{}{}", value, separator);
}
void append(Text& out, const Vec3& v, char separator) {
  fmt::format_to(std::back_inserter(out), "{1}{0}{2}{0}{3}{0}", separator, v.x, v.y, v.z);
}

/// Replaces the separator at the end of a row.
void end_row(Text& out) {
  out[out.size() - 1] = '\n';
}

/// One column as texts see it; dumps count types from 1 where the Bed counts materials from 0.
struct Numbering {
  bool types = false;
  template <class T>
  bool is_type(const BedColumn<T>& column) const {
    return types && column.name == std::string_view("material");
  }
};

void append_names(Text& out, char separator, Numbering numbering) {
  for_each_column([&](const auto& column) {
    if (numbering.is_type(column))
      append(out, "type", separator);
    else
      for (int k = 0; k < column.components; ++k) append(out, column.text[k], separator);
  });
  end_row(out);
}

void append_rows(Text& out, const Bed& bed, char separator, Numbering numbering) {
  for (std::size_t i = 0; i < bed.size(); ++i) {
    for_each_column([&](const auto& column) {
      if (numbering.is_type(column))
        append(out, bed.material[i] + 1, separator);
      else
        append(out, (bed.*column.values)[i], separator);
    });
    end_row(out);
  }
}

const char* vtk_type(double) {
  return "Float64";
}
const char* vtk_type(const Vec3&) {
  return "Float64";
}
const char* vtk_type(std::int64_t) {
  return "Int64";
}
const char* vtk_type(std::int32_t) {
  return "Int32";
}

template <class T>
void vtp_array(Text& out, const char* name, const std::vector<T>& values, const char* shape = "") {
  fmt::format_to(std::back_inserter(out), "<DataArray type=\"{}\" Name=\"{}\"{}{} format=\"ascii\">\n",
                 vtk_type(T{}), name, std::is_same_v<T, Vec3> ? " NumberOfComponents=\"3\"" : "", shape);
  for (const T& value : values) {
    append(out, value, ' ');
    end_row(out);
  }
  fmt::format_to(std::back_inserter(out), "</DataArray>\n");
}

template <class T>
void vtp_field(Text& out, const char* name, const std::vector<T>& values) {
  vtp_array(out, name, values, fmt::format(" NumberOfTuples=\"{}\"", values.size()).c_str());
}

std::vector<std::int64_t> counting_from(std::int64_t first, std::size_t count) {
  std::vector<std::int64_t> numbers;
  for (std::size_t k = 0; k < count; ++k) numbers.push_back(first + static_cast<std::int64_t>(k));
  return numbers;
}

}  // namespace

std::string dump_text(const Bed& given) {
  const Bed bed = wrapped(given);
  Text text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS", bed.step,
                 bed.size());
  for (const bool periodic : bed.periodic) fmt::format_to(out, " {}", periodic ? "pp" : "ff");
  fmt::format_to(out, "\n");
  for (int axis = 0; axis < 3; ++axis) fmt::format_to(out, "{} {}\n", bed.box.min[axis], bed.box.max[axis]);
  fmt::format_to(out, "ITEM: ATOMS ");
  append_names(text, ' ', {.types = true});
  append_rows(text, bed, ' ', {.types = true});
  return fmt::to_string(text);
}

std::string csv_text(const Bed& given) {
  const Bed bed = wrapped(given);
  Text text;
  append_names(text, ',', {});
  append_rows(text, bed, ',', {});
  return fmt::to_string(text);
}

std::string vtp_text(const Bed& given) {
  const Bed bed = wrapped(given);
  Text text;
  auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
                 "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n");
  vtp_field(text, "TimeValue", std::vector<double>{bed.time_s});
  vtp_field(text, "Step", std::vector<std::int64_t>{bed.step});
  vtp_field(text, "Box", std::vector<Vec3>{bed.box.min, bed.box.max});
  vtp_field(text, "Periodic", std::vector<std::int32_t>{bed.periodic[0], bed.periodic[1], bed.periodic[2]});
  fmt::format_to(out, "</FieldData>\n<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\">\n<Points>\n",
                 bed.size());
  vtp_array(text, "position", bed.position_m);
  fmt::format_to(out, "</Points>\n<Verts>\n");
  vtp_array(text, "connectivity", counting_from(0, bed.size()));
  vtp_array(text, "offsets", counting_from(1, bed.size()));
  fmt::format_to(out, "</Verts>\n<PointData>\n");
  for_each_column([&](const auto& column) {
    if (column.view != std::string_view("position")) vtp_array(text, column.view, bed.*column.values);
  });
  fmt::format_to(out, "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  return fmt::to_string(text);
}

std::string walls_vtp_text(const Bed& bed) {
  std::string points, connectivity, offsets, wall_number, temperature, emissivity, role;
  std::size_t point_count = 0, cell_count = 0, ends = 0;
  for (std::size_t w = 0; w < bed.walls.size(); ++w) {
    const Wall& wall = bed.walls[w];
    const auto cell = [&](const auto& corners) {
      for (const auto corner : corners)
        connectivity += fmt::format("{} ", point_count + static_cast<std::size_t>(corner));
      ends += corners.size();
      ++cell_count;
      offsets += fmt::format("{} ", ends);
      wall_number += fmt::format("{} ", w);
      temperature += fmt::format("{} ", wall.temperature_K);
      emissivity += fmt::format("{} ", wall.emissivity);
      role += fmt::format("{} ", static_cast<int>(wall.role));
    };
    if (wall.triangles.empty()) {
      std::vector<std::size_t> all(wall.vertices.size());
      for (std::size_t k = 0; k < all.size(); ++k) all[k] = k;
      cell(all);
    }
    for (const auto& triangle : wall.triangles) cell(triangle);
    for (const Vec3& v : wall.vertices) points += fmt::format("{} {} {}\n", v.x, v.y, v.z);
    point_count += wall.vertices.size();
  }
  const auto array = [](const char* type, const char* name, const std::string& values) {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">{}</DataArray>\n", type, name,
                       values);
  };
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>\n"
      "<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n<Points><DataArray type=\"Float64\" Name=\"Points\" "
      "NumberOfComponents=\"3\" format=\"ascii\">\n{}</DataArray></Points>\n<Polys>\n{}{}</Polys>\n<CellData>\n{}{}{}{}"
      "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n",
      point_count, cell_count, points, array("Int64", "connectivity", connectivity),
      array("Int64", "offsets", offsets), array("Int32", "wall", wall_number),
      array("Float64", "temperature", temperature), array("Float64", "emissivity", emissivity),
      array("Int32", "role", role));
}

}  // namespace granrad
