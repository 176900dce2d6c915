#include "dem/bed/bed.h"

#include <algorithm>
#include <cmath>

#include "dem/base/constants.h"

namespace granrad {

std::size_t Bed::add(const Vec3& position, const Vec3& velocity, double radius, double temperature,
                     std::int32_t material_index) {
  id.push_back(next_id++);
  position_m.push_back(position);
  velocity_m_s.push_back(velocity);
  angular_velocity_rad_s.push_back({});
  radius_m.push_back(radius);
  temperature_K.push_back(temperature);
  radiative_heat_W.push_back(0);
  material.push_back(material_index);
  return id.size() - 1;
}

void Bed::remove_unless(const std::vector<char>& keep) {
  std::erase_if(contacts, [&](const ContactMemory& c) {
    const auto gone = [&](std::int64_t particle_id) {
      const auto index = index_of(particle_id);
      return index < 0 || !keep[index];
    };
    return gone(c.first) || (c.second >= 0 && gone(c.second));
  });
  const auto compact = [&](auto& column) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keep.size(); ++i)
      if (keep[i]) column[kept++] = column[i];
    column.resize(kept);
  };
  compact(position_m);
  compact(velocity_m_s);
  compact(angular_velocity_rad_s);
  compact(radius_m);
  compact(temperature_K);
  compact(radiative_heat_W);
  compact(material);
  compact(id);
}

std::int64_t Bed::index_of(std::int64_t particle_id) const {
  const auto at = std::lower_bound(id.begin(), id.end(), particle_id);
  return at != id.end() && *at == particle_id ? at - id.begin() : -1;
}

Vec3 wrapped_into_box(const Bed& bed, Vec3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!bed.periodic[axis]) continue;
    const double low = bed.box.min[axis], high = bed.box.max[axis], period = high - low;
    p[axis] = std::clamp(p[axis] - period * std::floor((p[axis] - low) / period), low, high);
  }
  return p;
}

Vec3 nearest_image(const Bed& bed, Vec3 apart) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!bed.periodic[axis]) continue;
    const double period = bed.box.max[axis] - bed.box.min[axis];
    apart[axis] -= period * std::round(apart[axis] / period);
  }
  return apart;
}

double mass_kg(const Bed& bed, std::size_t i) {
  const double r = bed.radius_m[i];
  return 4.0 / 3.0 * pi * r * r * r * bed.materials[bed.material[i]].density_kg_m3;
}

}  // namespace granrad
