#include "dem/native/bed_transfer.h"

#include <fmt/format.h>

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include "dem/base/error.h"

namespace granrad::native {
namespace {

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

void check(const Bed& bed) {
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < bed.size() && problems.size() < 20; ++i) {
    const bool known =
        bed.material[i] >= 0 && bed.material[i] < static_cast<std::int32_t>(bed.materials.size());
    const auto complain = [&](const char* what, double value, const char* why) {
      problems.push_back(
          advised(fmt::format("particle {}: {} = {} ({})", bed.id[i], what, value, why), "correct the bed"));
    };
    if (!(bed.radius_m[i] > 0 && std::isfinite(bed.radius_m[i])))
      complain("radius", bed.radius_m[i], "must be positive");
    if (!is_finite(bed.position_m[i])) complain("position", NAN, "must be finite");
    if (!is_finite(bed.velocity_m_s[i]) || !is_finite(bed.angular_velocity_rad_s[i]))
      complain("velocity", NAN, "must be finite");
    if (!known) complain("material", bed.material[i], "no such material in the bed");
  }
  for (const auto& m : bed.materials) {
    const auto complain = [&](const char* what, double value, const char* why) {
      problems.push_back(fmt::format("material {}: {} = {} ({})", m.name, what, value, why));
    };
    if (bed.size() == 0) break;
    if (!(m.youngs_modulus_Pa > 0)) complain("youngs_modulus_Pa", m.youngs_modulus_Pa, "must be positive");
    if (!(m.density_kg_m3 > 0)) complain("density_kg_m3", m.density_kg_m3, "must be positive");
    if (!(m.restitution > 0 && m.restitution <= 1))
      complain("restitution", m.restitution, "must be in (0, 1]");
    if (!(m.friction >= 0)) complain("friction", m.friction, "must not be negative");
  }
  for (int a = 0; a < 3 && bed.size() > 0; ++a) {
    if (!bed.periodic[a]) continue;
    const double largest = *std::max_element(bed.radius_m.begin(), bed.radius_m.end());
    if (bed.box.size()[a] < 4 * largest)
      problems.push_back(advised(
          fmt::format("box.size_m[{}] = {} (periodic: a particle would touch itself)", a, bed.box.size()[a]),
          fmt::format("try at least {}", 4 * largest)));
  }
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace

bool BedTransfer::same_particles(const Bed& bed) const {
  return same_bits(bed.id, id_) && same_bits(bed.radius_m, radius_) && same_bits(bed.material, material_) &&
         std::equal(bed.materials.begin(), bed.materials.end(), materials_.begin(), materials_.end(),
                    same_numbers);
}

bool BedTransfer::holds(const Bed& bed, const Rows& rows) const {
  if (rows.count != static_cast<std::int64_t>(bed.size()) || !same_bits(bed.id, id_) ||
      !same_bits(bed.radius_m, radius_))
    return false;
  for (std::int64_t i = 0; i < rows.count; ++i)
    if (!(rows.position_of(i) == bed.position_m[rows.bed_index[i]])) return false;
  return true;
}

void BedTransfer::lay_out(const Bed& bed, Rows& rows, int threads) {
  check(bed);
  if (static_cast<std::int64_t>(bed.size()) + 2 * threads > RowOffset::most_rows)
    throw InputError(advised(fmt::format("{} particles (the engine numbers at most {})", bed.size(),
                                         RowOffset::most_rows - 2 * threads),
                             "try fewer"));
  id_ = bed.id, radius_ = bed.radius_m, material_ = bed.material, materials_ = bed.materials;
  const auto n = static_cast<std::int64_t>(bed.size()), all = n + 2 * threads;
  rows.count = n;
  rows.position.assign(4 * all, 0);
  rows.velocity.assign(8 * all, 0);
  rows.force.assign(8 * all, 0);
  rows.radius = bed.radius_m, rows.material = bed.material;
  rows.bed_index.resize(n), rows.row_of.resize(n), rows.mass.resize(n);
  rows.uniform = true;
  for (std::int64_t i = 0; i < n; ++i) {
    rows.bed_index[i] = rows.row_of[i] = static_cast<std::int32_t>(i);
    rows.mass[i] = mass_kg(bed, i);
    rows.uniform &= bed.radius_m[i] == bed.radius_m[0] && bed.material[i] == bed.material[0] &&
                    !ContactLaw::rolls(bed.materials[bed.material[i]]);
  }
  rows.bed_index.resize(all), rows.radius.resize(all), rows.mass.resize(all), rows.material.resize(all);
  // Idle rows: a pair far apart, whatever the period.
  for (int t = 0; t < threads; ++t)
    for (int a = 0; a < 3; ++a)
      rows.position[4 * (n + 2 * t + 1) + a] = bed.periodic[a] ? 0.5 * bed.box.size()[a] : 1e6;
}

BedTransfer::Change BedTransfer::load(const Bed& bed, Rows& rows, double half_step_s, int threads,
                                      int most_threads) {
  auto change = Change::none;
  if (rows.count != static_cast<std::int64_t>(bed.size()) || id_.empty() || !same_particles(bed)) {
    lay_out(bed, rows, most_threads);
    change = Change::particles;
  } else if (!same_bits(bed.contacts, contacts_)) {
    change = Change::memory;
  }
  bool moved = false;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(|| : moved)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const auto b = rows.bed_index[i];
    const Vec3 &x = bed.position_m[b], &v = bed.velocity_m_s[b], &w = bed.angular_velocity_rad_s[b];
    double *p = &rows.position[4 * i], *q = &rows.velocity[8 * i];
    for (int a = 0; a < 3; ++a) {
      moved = moved || p[a] != x[a] || q[a] != v[a] || q[4 + a] != w[a];
      p[a] = x[a] + half_step_s * v[a];
      q[a] = v[a], q[4 + a] = w[a];
    }
  }
  if (moved && change == Change::none) {
    check(bed);
    change = Change::moved;
  }
  return change;
}

std::vector<Memory> BedTransfer::memories(const Bed& bed) {
  std::vector<Memory> all;
  all.reserve(bed.contacts.size());
  for (const auto& c : bed.contacts) {
    const auto first = bed.index_of(c.first), second = c.second >= 0 ? bed.index_of(c.second) : c.second;
    if (first < 0 || (c.second >= 0 && second < 0)) continue;
    all.push_back({static_cast<std::int32_t>(first), second, c.displacement_m});
  }
  return all;
}

void BedTransfer::store(const Rows& rows, const std::vector<Share>& shares, Bed& bed) {
  const auto threads = static_cast<int>(shares.size());
  std::int64_t broken = -1;
#pragma omp parallel for num_threads(threads) schedule(static) reduction(max : broken)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const auto b = rows.bed_index[i];
    bed.position_m[b] = rows.position_of(i);
    bed.velocity_m_s[b] = rows.velocity_of(i);
    bed.angular_velocity_rad_s[b] = rows.spin_of(i);
    const double sum = bed.position_m[b].x + bed.position_m[b].y + bed.position_m[b].z +
                       dot(bed.velocity_m_s[b], bed.velocity_m_s[b]) +
                       dot(bed.angular_velocity_rad_s[b], bed.angular_velocity_rad_s[b]);
    if (!std::isfinite(sum)) broken = std::max<std::int64_t>(broken, b);
  }
  if (broken >= 0)
    throw NumericalError(advised(fmt::format("particle {} left the range of numbers", bed.id[broken]),
                                 "try a smaller step or less overlap at the start"));
  store_springs(rows, shares, bed);
}

/// Sorted by (first, second): by buckets of the first, which are short.
void BedTransfer::store_springs(const Rows& rows, const std::vector<Share>& shares, Bed& bed) {
  const auto threads = static_cast<int>(shares.size());
  bucket_.assign(rows.count + 2, 0);
  const auto next = [&](std::int64_t& place) {
    return threads == 1 ? place++ : std::atomic_ref(place).fetch_add(1, std::memory_order_relaxed);
  };
#pragma omp parallel num_threads(threads)
  shares[omp_get_thread_num()].visit_springs(
      rows, [&](std::int32_t a, std::int64_t, const Vec3&) { next(bucket_[a + 2]); });
  for (std::size_t k = 2; k < bucket_.size(); ++k) bucket_[k] += bucket_[k - 1];
  bed.contacts.resize(bucket_.back());
#pragma omp parallel num_threads(threads)
  {
    const auto put = [&](std::int32_t a, std::int64_t b, const Vec3& s) {
      // No negative zeros: equal states have equal bits.
      bed.contacts[next(bucket_[a + 1])] = {bed.id[a], b >= 0 ? bed.id[b] : b, s + Vec3{}};
    };
    shares[omp_get_thread_num()].visit_springs(rows, put);
#pragma omp barrier
#pragma omp for schedule(static)
    for (std::int64_t i = 0; i < rows.count; ++i)
      std::sort(bed.contacts.begin() + bucket_[i], bed.contacts.begin() + bucket_[i + 1],
                [](const ContactMemory& a, const ContactMemory& b) { return a.second < b.second; });
  }
  contacts_ = bed.contacts;
}

}  // namespace granrad::native
