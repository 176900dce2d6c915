#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"
#include "dem/base/files/hdf5_file.h"
#include "dem/bed/wall_columns.h"
#include "dem/io/frame_layout.h"
#include "dem/io/snapshot.h"

namespace granrad {

namespace {

template <class T>
std::vector<T> read_values(const Hdf5Reader& in, const std::string& name) {
  return in.read<T>(name);
}
template <>
std::vector<Vec3> read_values(const Hdf5Reader& in, const std::string& name) {
  const std::vector<double> flat = in.read<double>(name, 3);
  std::vector<Vec3> values(flat.size() / 3);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = {flat[3 * i], flat[3 * i + 1], flat[3 * i + 2]};
  return values;
}

bool holds(ColumnKind kind, double value) {
  return std::isfinite(value) && (kind == ColumnKind::real || value > 0);
}
bool holds(ColumnKind, const Vec3& value) {
  return is_finite(value);
}
bool holds(ColumnKind, std::int64_t value) {
  return value >= 0;
}
bool holds(ColumnKind, std::int32_t value) {
  return value >= 0;
}

/// Reads a frame whose contents may be anything: `sound` refuses what a Bed must not hold.
class FrameReader {
 public:
  explicit FrameReader(const std::filesystem::path& file) : file_(file.string()), in_(file) {}

  Snapshot read() {
    check_format();
    Snapshot snapshot;
    snapshot.origin = file_;
    Bed& bed = snapshot.bed;
    bed.time_s = in_.real_attribute("/granrad", "time_s");
    bed.step = in_.integer_attribute("/granrad", "step");
    bed.next_id = in_.integer_attribute("/granrad", "next_id");
    read_materials(bed);
    read_particles(bed);
    read_contacts(bed);
    read_walls(bed);
    const auto box = read_values<Vec3>(in_, "/granrad/box");
    const auto periodic = in_.read<std::uint8_t>("/granrad/periodic");
    sound(box.size() == 2 && periodic.size() == 3 && is_finite(box[0]) && is_finite(box[1]), "box");
    for (int axis = 0; axis < 3; ++axis)
      sound(box[0][axis] <= box[1][axis] && (!periodic[axis] || box[0][axis] < box[1][axis]), "box");
    bed.box = {box[0], box[1]};
    std::copy(periodic.begin(), periodic.end(), bed.periodic.begin());
    read_state(snapshot.state);
    return snapshot;
  }

 private:
  void check_format() {
    const auto refuse = [&] {
      throw InputError(
          fmt::format("{}: is not a frame of granrad (no /granrad with format \"{}\")", file_, frame_format));
    };
    if (!in_.has_attribute("/granrad", "format") || !in_.has_attribute("/granrad", "version")) refuse();
    version_ = in_.integer_attribute("/granrad", "version");
    if (version_ < 1 || version_ > frame_version)
      throw InputError(advised(fmt::format("{}: frame version {} (this program reads versions up to {})",
                                           file_, version_, frame_version),
                               "use the program that wrote it"));
    // Texts of version 1 have no checksum: none is read that is not needed.
    if (version_ > 1 && in_.text_attribute("/granrad", "format") != frame_format) refuse();
  }
  void sound(bool holds, const std::string& what) const {
    if (!holds)
      throw IoError(fmt::format("{}: {} of this frame is inconsistent (damaged file)", file_, what));
  }

  void read_particles(Bed& bed) const {
    for_each_column([&]<class T>(const BedColumn<T>& column) {
      std::vector<T>& values = bed.*column.values;
      if (version_ >= column.since_frame)
        values = read_values<T>(in_, fmt::format("/granrad/particles/{}", column.name));
      else
        values.assign(bed.size(), column.initial);
      sound(values.size() == bed.size(), fmt::format("the length of column {}", column.name));
      for (std::size_t i = 0; i < values.size(); ++i)
        sound(holds(column.kind, values[i]), fmt::format("{} of particle {}", column.name, bed.id[i]));
    });
    const std::size_t n = bed.size();
    sound(std::adjacent_find(bed.id.begin(), bed.id.end(), std::greater_equal<>()) == bed.id.end() &&
              (n == 0 || (bed.id.front() >= 0 && bed.id.back() < bed.next_id)),
          "the order of particle ids");
    for (std::size_t i = 0; i < n; ++i)
      sound(bed.material[i] < std::max<std::int32_t>(1, static_cast<std::int32_t>(bed.materials.size())),
            fmt::format("the material of particle {}", bed.id[i]));
  }

  void read_contacts(Bed& bed) const {
    const auto first = in_.read<std::int64_t>("/granrad/contacts/first");
    const auto second = in_.read<std::int64_t>("/granrad/contacts/second");
    const auto displacement = read_values<Vec3>(in_, "/granrad/contacts/displacement_m");
    sound(second.size() == first.size() && displacement.size() == first.size(), "contact memory");
    for (std::size_t k = 0; k < first.size(); ++k) {
      sound(is_finite(displacement[k]) &&
                (k == 0 || std::pair(first[k - 1], second[k - 1]) < std::pair(first[k], second[k])),
            "contact memory");
      bed.contacts.push_back({first[k], second[k], displacement[k]});
    }
  }

  void read_materials(Bed& bed) const {
    for (auto& name : in_.read_texts("/granrad/materials/name"))
      bed.materials.emplace_back().name = std::move(name);
    for (const auto& number : material_numbers()) {
      const auto column = in_.read<double>(std::string("/granrad/materials/") + number.key);
      sound(column.size() == bed.materials.size(), std::string("material ") + number.key);
      for (std::size_t m = 0; m < column.size(); ++m) {
        sound(std::isfinite(column[m]), std::string("material ") + number.key);
        bed.materials[m].*number.value = column[m];
      }
    }
  }

  void read_walls(Bed& bed) const {
    const std::string at = "/granrad/walls/";
    WallColumns c;
    c.name = in_.read_texts(at + "name");
    c.role = in_.read<std::int32_t>(at + "role");
    c.contact = in_.read<std::uint8_t>(at + "contact");
    c.temperature_K = in_.read<double>(at + "temperature_K");
    c.emissivity = in_.read<double>(at + "emissivity");
    c.opens_at_s = in_.read<double>(at + "opens_at_s");
    c.velocity_m_s = read_values<Vec3>(in_, at + "velocity_m_s");
    c.vertices_m = read_values<Vec3>(in_, at + "vertices_m");
    c.vertex_begin = in_.read<std::int64_t>(at + "vertex_begin");
    c.triangles = in_.read<std::int32_t>(at + "triangles", 3);
    c.triangle_begin = in_.read<std::int64_t>(at + "triangle_begin");
    try {
      bed.walls = walls_from(c);
    } catch (const InputError& error) {
      sound(false, error.what());
    }
  }

  void read_state(StateBlocks& state) const {
    for (const auto& block : in_.children("/granrad/state")) {
      StateBlock& columns = state[block];
      for (const auto& name : in_.children("/granrad/state/" + block)) {
        const std::string path = fmt::format("/granrad/state/{}/{}", block, name);
        if (in_.is_integer(path))
          columns.integers[name] = in_.read<std::int64_t>(path);
        else
          columns.reals[name] = in_.read<double>(path);
      }
    }
  }

  std::string file_;
  Hdf5Reader in_;
  std::int64_t version_ = 0;
};

}  // namespace

Snapshot read_frame(const std::filesystem::path& file) {
  return FrameReader(file).read();
}

}  // namespace granrad
