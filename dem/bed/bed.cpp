#include "dem/bed/bed.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "dem/base/constants.h"
#include "dem/bed/columns.h"

namespace granrad {

std::size_t Bed::add(const Vec3& position, const Vec3& velocity, double radius, double temperature,
                     std::int32_t material_index) {
  for_each_column([&](const auto& column) { (this->*column.values).push_back(column.initial); });
  id.back() = next_id++;
  position_m.back() = position;
  velocity_m_s.back() = velocity;
  radius_m.back() = radius;
  temperature_K.back() = temperature;
  material.back() = material_index;
  return id.size() - 1;
}

void Bed::permute(const std::vector<std::size_t>& order) {
  for_each_column([&](const auto& column) {
    auto& values = this->*column.values;
    auto permuted = values;
    for (std::size_t k = 0; k < order.size(); ++k) permuted[k] = values[order[k]];
    values = std::move(permuted);
  });
}

void Bed::remove_unless(const std::vector<char>& keep) {
  std::erase_if(contacts, [&](const ContactMemory& c) {
    const auto gone = [&](std::int64_t particle_id) {
      const auto index = index_of(particle_id);
      return index < 0 || !keep[index];
    };
    return gone(c.first) || (c.second >= 0 && gone(c.second));
  });
  for_each_column([&](const auto& column) {
    auto& values = this->*column.values;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < keep.size(); ++i)
      if (keep[i]) values[kept++] = values[i];
    values.resize(kept);
  });
}

std::int64_t Bed::index_of(std::int64_t particle_id) const {
  const auto at = std::lower_bound(id.begin(), id.end(), particle_id);
  return at != id.end() && *at == particle_id ? at - id.begin() : -1;
}

Vec3 wrapped_into_box(const Bed& bed, Vec3 p) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!bed.periodic[axis]) continue;
    const double low = bed.box.min[axis], high = bed.box.max[axis], period = high - low;
    if (p[axis] >= low && p[axis] < high) continue;  // most are; the division is dear
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

double mean_diameter_m(const std::vector<double>& radius_m) {
  if (radius_m.empty()) return 0;
  return 2 * std::accumulate(radius_m.begin(), radius_m.end(), 0.0) / static_cast<double>(radius_m.size());
}

double mass_kg(const Bed& bed, std::size_t i) {
  return sphere_volume(bed.radius_m[i]) * bed.materials[bed.material[i]].density_kg_m3;
}

}  // namespace granrad
