#include "dem/io/point_data.h"

#include <fmt/core.h>

#include <cmath>

#include "dem/base/error.h"
#include "dem/io/particle_table.h"

namespace granrad {

namespace {

void read_fields(const PointData& data, Bed& bed) {
  const auto field = [&](const char* name, std::size_t count) -> const std::vector<double>* {
    const auto found = data.fields.find(name);
    return found != data.fields.end() && found->second.size() == count ? &found->second : nullptr;
  };
  for (const char* name : {"TimeValue", "Time", "TIME", "time"})
    if (const auto* time = field(name, 1); time && std::isfinite((*time)[0])) bed.time_s = (*time)[0];
  for (const char* name : {"Step", "CYCLE"})
    if (const auto* step = field(name, 1); step && std::abs((*step)[0]) < 9e15)
      bed.step = static_cast<std::int64_t>((*step)[0]);
  if (const auto* box = field("Box", 6))
    bed.box = {{(*box)[0], (*box)[1], (*box)[2]}, {(*box)[3], (*box)[4], (*box)[5]}};
  if (const auto* periodic = field("Periodic", 3))
    for (std::size_t axis = 0; axis < 3; ++axis) bed.periodic[axis] = (*periodic)[axis] != 0;
}

}  // namespace

Snapshot particles_of(const std::string& file, const PointData& data, double radius_m) {
  std::vector<std::string> names{"x", "y", "z"};
  std::size_t width = 3;
  for (const auto& array : data.arrays) {
    if (array.values.size() != array.components * data.points.size())
      throw InputError(fmt::format("{}: array {} has {} values for {} points", file, array.name,
                                   array.values.size(), data.points.size()));
    width += array.components;
    for (std::size_t k = 0; k < array.components; ++k)
      names.push_back(array.components == 1   ? array.name
                      : array.components == 3 ? fmt::format("{}:{}", array.name, k)
                                              : fmt::format("({}:{})", array.name, k));
  }
  ParticleTable table(file, 0, std::move(names), radius_m, ParticleTable::RowsAre::points);
  std::vector<double> row;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const Vec3& p = data.points[i];
    row.assign({p.x, p.y, p.z});
    row.reserve(width);
    for (const auto& array : data.arrays)
      for (std::size_t k = 0; k < array.components; ++k)
        row.push_back(array.values[i * array.components + k]);
    table.add_row(i, row);
  }
  Snapshot snapshot = table.finish();
  read_fields(data, snapshot.bed);
  return snapshot;
}

}  // namespace granrad
