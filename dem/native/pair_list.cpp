#include "dem/native/pair_list.h"

#include <algorithm>

#include "dem/native/materials.h"

namespace granrad::native {
namespace {
constexpr std::int64_t look_ahead = 64;  ///< entries behind the end that prefetching may read
bool is_zero(double x, double y, double z) {
  return x == 0 && y == 0 && z == 0;
}
}  // namespace

void MemoryTable::build(const std::vector<Memory>& memories, const Rows& rows) {
  begin_.assign(rows.count + 2, 0);
  const auto between_particles = [](const Memory& m) { return m.second >= 0; };
  for (const auto& m : memories)
    if (between_particles(m)) ++begin_[rows.row_of[m.first] + 2], ++begin_[rows.row_of[m.second] + 2];
  for (std::size_t k = 2; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  entries_.resize(begin_.back());
  for (const auto& m : memories) {
    if (!between_particles(m)) continue;
    const auto i = rows.row_of[m.first], j = rows.row_of[m.second];
    entries_[begin_[i + 1]++] = {j, m.displacement};
    entries_[begin_[j + 1]++] = {i, Vec3{} - m.displacement};
  }
  begin_.pop_back();
}

Vec3 MemoryTable::find(std::int32_t i, std::int32_t j) const {
  if (begin_.empty()) return {};
  for (auto k = begin_[i]; k < begin_[i + 1]; ++k)
    if (entries_[k].other == j) return entries_[k].displacement;
  return {};
}

void PairList::add_near(std::int32_t i, const std::int32_t* found, std::int64_t count) {
  near_j_.insert(near_j_.end(), found, found + count);
  near_i_.insert(near_i_.end(), count, i);
}

void PairList::finish_near(std::int32_t idle_row) {
  idle_row_ = idle_row;
  near_count_ = static_cast<std::int64_t>(near_i_.size());
  while (near_i_.size() % 8) add_near(idle_row, idle_row + 1);
  fresh_ = true;
}

std::int64_t PairList::select(const Kernels& kernels, const RowView& rows, const StepConstants& constants) {
  const auto room = static_cast<std::int64_t>(near_i_.size()) + 8 + look_ahead + 8;
  next_first_.resize(room), next_second_.resize(room), next_source_.resize(room);
  return kernels.select_close(rows, constants, near_i_.data(), near_j_.data(),
                              static_cast<std::int64_t>(near_i_.size()), next_first_.data(),
                              next_second_.data(), next_source_.data());
}

void PairList::find_closing_speeds(const Kernels& kernels, const RowView& rows,
                                   const StepConstants& constants, bool first_only,
                                   std::vector<double>& closing) {
  const auto found = select(kernels, rows, constants);
  for (std::int64_t k = 0; k < found; ++k) {
    const auto i = next_first_[k], j = next_second_[k];
    const double *v = rows.velocity + 8 * std::int64_t(i), *w = rows.velocity + 8 * std::int64_t(j);
    const double speed = norm(Vec3{v[0] - w[0], v[1] - w[1], v[2] - w[2]});
    closing[i] = std::max(closing[i], speed);
    if (!first_only) closing[j] = std::max(closing[j], speed);
  }
}

void PairList::refresh(const Kernels& kernels, const RowView& rows, const StepConstants& constants,
                       const MemoryTable& memories) {
  const auto found = select(kernels, rows, constants);
  const auto padded = (found + 7) / 8 * 8;
  for (auto k = found; k < padded + look_ahead; ++k)
    next_first_[k] = idle_row_, next_second_[k] = idle_row_ + 1;
  for (auto& column : next_displacement_) column.resize(padded);
  const auto put = [&](std::int64_t k, const Vec3& s) {
    for (int a = 0; a < 3; ++a) next_displacement_[a][k] = s[a];
  };
  std::int64_t old = 0;
  for (std::int64_t k = 0; k < found; ++k) {
    if (fresh_) {
      put(k, memories.find(next_first_[k], next_second_[k]));
      continue;
    }
    while (old < tight_count_ && source_[old] < next_source_[k]) ++old;
    if (old < tight_count_ && source_[old] == next_source_[k])
      put(k, {displacement_[0][old], displacement_[1][old], displacement_[2][old]});
    else
      put(k, {});
  }
  for (auto k = found; k < padded; ++k) put(k, {});
  first_.swap(next_first_), second_.swap(next_second_), source_.swap(next_source_);
  for (int a = 0; a < 3; ++a) displacement_[a].swap(next_displacement_[a]);
  tight_count_ = found, padded_ = padded, fresh_ = false, varied_used_ = false;
}

void PairList::fill_coefficients(const Rows& rows, const std::vector<Material>& materials) {
  varied_.assign(varied_columns * padded_, 0);
  const auto body = [&](std::int32_t row) -> ContactBody {
    return {&materials[rows.material[row]], rows.radius[row], rows.mass[row]};
  };
  for (std::int64_t k = 0; k < tight_count_; ++k) {
    const auto a = body(first_[k]), b = body(second_[k]);
    const auto c = pair_coefficients(a, b);
    const double columns[varied_columns] = {
        c.effective_radius, c.normal,  c.tangential, c.normal_damping, c.tangential_damping,
        c.friction,         c.rolling, a.radius_m,   b.radius_m};
    for (int n = 0; n < varied_columns; ++n) varied_[n * padded_ + k] = columns[n];
  }
  varied_used_ = true;
}

ContactView PairList::view() {
  return {first_.data(),
          second_.data(),
          padded_,
          {displacement_[0].data(), displacement_[1].data(), displacement_[2].data()},
          varied_used_ ? varied_.data() : nullptr,
          padded_};
}

void PairList::collect(const Rows& rows, bool twins, std::vector<Memory>& memories) const {
  for (std::int64_t k = 0; k < tight_count_; ++k) {
    const double x = displacement_[0][k], y = displacement_[1][k], z = displacement_[2][k];
    if (is_zero(x, y, z) || (twins && first_[k] > second_[k])) continue;
    const auto a = rows.bed_index[first_[k]], b = rows.bed_index[second_[k]];
    if (a < b)
      memories.push_back({a, b, {x, y, z}});
    else
      memories.push_back({b, a, Vec3{} - Vec3{x, y, z}});
  }
}

std::int64_t PairList::touching_count() const {
  std::int64_t n = 0;
  for (std::int64_t k = 0; k < tight_count_; ++k)
    n += !is_zero(displacement_[0][k], displacement_[1][k], displacement_[2][k]);
  return n;
}

std::size_t PairList::bytes() const {
  return 4 * (near_i_.capacity() + near_j_.capacity() +
              2 * (first_.capacity() + second_.capacity() + source_.capacity())) +
         8 * (6 * displacement_[0].capacity() + varied_.capacity());
}

}  // namespace granrad::native
