#include "coupling/granrun/export.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <iterator>

#include "coupling/simulation/case_folder.h"
#include "dem/base/error.h"
#include "dem/base/program.h"
#include "dem/base/text_file.h"
#include "dem/io/snapshot.h"

namespace granrad {

namespace {

std::string dump_text(const Bed& bed) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n", bed.step,
                 bed.size());
  for (int axis = 0; axis < 3; ++axis) fmt::format_to(out, "{} {}\n", bed.box.min[axis], bed.box.max[axis]);
  fmt::format_to(out, "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz temperature q_rad\n");
  for (std::size_t i = 0; i < bed.size(); ++i) {
    const Vec3 &p = bed.position_m[i], &v = bed.velocity_m_s[i], &w = bed.angular_velocity_rad_s[i];
    fmt::format_to(out, "{} {} {} {} {} {} {} {} {} {} {} {} {} {}\n", bed.id[i], bed.material[i] + 1, p.x,
                   p.y, p.z, bed.radius_m[i], v.x, v.y, v.z, w.x, w.y, w.z, bed.temperature_K[i],
                   bed.radiative_heat_W[i]);
  }
  return fmt::to_string(text);
}

void vtp_scalars(fmt::memory_buffer& text, const char* name, const std::vector<double>& values) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">\n", name);
  for (double value : values) fmt::format_to(out, "{}\n", value);
  fmt::format_to(out, "</DataArray>\n");
}

void vtp_vectors(fmt::memory_buffer& text, const char* name, const std::vector<Vec3>& values) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"3\" format=\"ascii\">\n",
                 name);
  for (const Vec3& value : values) fmt::format_to(out, "{} {} {}\n", value.x, value.y, value.z);
  fmt::format_to(out, "</DataArray>\n");
}

void vtp_numbers(fmt::memory_buffer& text, const char* name, std::size_t first, std::size_t count) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "<DataArray type=\"Int64\" Name=\"{}\" format=\"ascii\">\n", name);
  for (std::size_t k = 0; k < count; ++k) fmt::format_to(out, "{}\n", first + k);
  fmt::format_to(out, "</DataArray>\n");
}

std::string vtp_text(const Bed& bed) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  const std::size_t n = bed.size();
  fmt::format_to(
      out,
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" "
      "NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n</FieldData>\n<Piece NumberOfPoints=\"{}\" "
      "NumberOfVerts=\"{}\">\n<Points>\n",
      bed.time_s, n, n);
  vtp_vectors(text, "position", bed.position_m);
  fmt::format_to(out, "</Points>\n<Verts>\n");
  vtp_numbers(text, "connectivity", 0, n);
  vtp_numbers(text, "offsets", 1, n);
  fmt::format_to(out, "</Verts>\n<PointData>\n");
  vtp_scalars(text, "id", {bed.id.begin(), bed.id.end()});
  vtp_scalars(text, "radius", bed.radius_m);
  vtp_scalars(text, "temperature", bed.temperature_K);
  vtp_scalars(text, "q_rad", bed.radiative_heat_W);
  vtp_vectors(text, "v", bed.velocity_m_s);
  vtp_vectors(text, "omega", bed.angular_velocity_rad_s);
  fmt::format_to(out, "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n");
  return fmt::to_string(text);
}

}  // namespace

int export_case(const std::filesystem::path& where, const std::string& format, const RunOptions& options) {
  const CaseFolder folder(where);
  const auto frames = folder.frames();
  if (frames.empty())
    throw InputError(
        fmt::format("{} (has no frames yet) wait, or look into its history.csv", where.string()));
  Progress progress("export", static_cast<double>(frames.size()), options.quiet());
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Bed bed = read_frame(frames[k].file).bed;
    auto name = frames[k].file.filename();
    write_text_file(folder.root() / "export" / name.replace_extension(format),
                    format == "vtp" ? vtp_text(bed) : dump_text(bed));
    progress.update(static_cast<double>(k + 1));
  }
  progress.finish();
  if (!options.quiet()) fmt::print("{} frames in {}\n", frames.size(), (folder.root() / "export").string());
  return exit_ok;
}

}  // namespace granrad
