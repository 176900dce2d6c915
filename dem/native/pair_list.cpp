#include "dem/native/pair_list.h"

#include <algorithm>
#include <limits>

namespace granrad::native {
namespace {
constexpr std::int64_t look_ahead = 64;   ///< entries behind the end that prefetching may read
constexpr std::int64_t widest_pack = 16;  ///< contacts that a kernel works on at once
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

void PairList::add_near(std::int32_t i, std::int32_t j) {
  if (j < i)
    backward_.push_back({i, j});
  else
    near_i_.push_back(i), near_j_.push_back(j);
}

void PairList::add_near(std::int32_t i, const std::int32_t* found, std::int64_t count) {
  near_j_.insert(near_j_.end(), found, found + count);
  near_i_.insert(near_i_.end(), count, i);
}

void PairList::finish_near(std::int32_t idle_row) {
  idle_row_ = idle_row;
  // Pairs whose first row is the higher come first: behind them, rows are done with in their order.
  const auto put_first = [&](AlignedVector<std::int32_t>& column, auto member) {
    AlignedVector<std::int32_t> all;
    all.reserve(backward_.size() + column.size() + 8);
    for (const auto& pair : backward_) all.push_back(pair.*member);
    all.insert(all.end(), column.begin(), column.end());
    column.swap(all);
  };
  put_first(near_i_, &RowPair::first), put_first(near_j_, &RowPair::second);
  near_count_ = static_cast<std::int64_t>(near_i_.size());
  while (near_i_.size() % 8) near_i_.push_back(idle_row), near_j_.push_back(idle_row + 1);
  fresh_ = true;
}

std::int64_t PairList::select(const Kernels& kernels, const RowView& rows, const StepConstants& constants) {
  const auto near = static_cast<std::int64_t>(near_i_.size());
  for (auto* column : {&found_first_, &found_second_, &found_number_}) column->resize(near + 8);
  return kernels.select_close(rows, constants, near_i_.data(), near_j_.data(), near, found_first_.data(),
                              found_second_.data(), found_number_.data());
}

void PairList::find_closing_speeds(const Kernels& kernels, const RowView& rows,
                                   const StepConstants& constants, bool first_only,
                                   std::vector<double>& closing) {
  const auto found = select(kernels, rows, constants);
  for (std::int64_t k = 0; k < found; ++k) {
    const auto i = found_first_[k], j = found_second_[k];
    const double *v = rows.velocity + 8 * std::int64_t(i), *w = rows.velocity + 8 * std::int64_t(j);
    const double speed = norm(Vec3{v[0] - w[0], v[1] - w[1], v[2] - w[2]});
    closing[i] = std::max(closing[i], speed);
    if (!first_only) closing[j] = std::max(closing[j], speed);
  }
}

void PairList::refresh(const Kernels& kernels, const RowView& rows, const StepConstants& constants,
                       const MemoryTable& memories) {
  const auto found = select(kernels, rows, constants);
  padded_ = (found + widest_pack - 1) / widest_pack * widest_pack;
  next_springs_.resize(padded_, rows.mixed != nullptr), next_number_.resize(found);
  for (auto* column : {&first_, &second_}) column->resize(padded_ + look_ahead);
  if (fresh_) place_.assign(near_count_, -1), number_.clear();
  const auto spring_of = [&](std::int64_t k) {
    if (fresh_) return memories.find(found_first_[k], found_second_[k]);
    const auto place = place_[found_number_[k]];
    return place < 0 ? Vec3{} : springs_.get(place);
  };
  for (std::int64_t begin = 0; begin < found; begin += block) {
    const auto end = std::min(begin + block, found);
    auto front = begin, back = end;
    for (auto k = begin; k < end; ++k) {
      const Vec3 spring = spring_of(k);
      const auto place = spring == Vec3{} ? --back : front++;
      first_[place] = found_first_[k], second_[place] = found_second_[k];
      next_number_[place] = found_number_[k];
      next_springs_.put(place, spring);
    }
  }
  for (auto k = found; k < padded_; ++k) next_springs_.put(k, {});
  for (auto k = found; k < padded_ + look_ahead; ++k) first_[k] = idle_row_, second_[k] = idle_row_ + 1;
  carry_touches(constants.touch_units > 0);
  for (const auto n : number_) place_[n] = -1;
  for (std::int64_t k = 0; k < found; ++k) place_[next_number_[k]] = static_cast<std::int32_t>(k);
  number_.swap(next_number_), std::swap(springs_, next_springs_);
  tight_count_ = found, fresh_ = false;
  varied_.clear();
  find_settled();
}

void PairList::carry_touches(bool recorded) {
  next_touch_sum_.assign(recorded ? padded_ : 0, 0.0);
  if (!fresh_ && !touch_sum_.empty()) {
    for (std::size_t k = 0; k < next_number_.size(); ++k)
      if (const auto before = place_[next_number_[k]]; before >= 0)
        next_touch_sum_[k] = std::exchange(touch_sum_[before], 0.0);
    for (std::size_t k = 0; k < number_.size(); ++k)
      if (touch_sum_[k] != 0) left_.push_back({near_i_[number_[k]], near_j_[number_[k]], touch_sum_[k]});
  }
  touch_sum_.swap(next_touch_sum_);
}

void PairList::find_settled() {
  settled_before_.resize((padded_ + block - 1) / block);
  auto lowest = std::numeric_limits<std::int64_t>::max();
  auto k = tight_count_;
  for (auto b = blocks(); b-- > 0;) {
    settled_before_[b] = lowest;
    for (; k > b * block; --k)
      lowest = std::min<std::int64_t>(lowest, std::min(first_[k - 1], second_[k - 1]));
  }
}

void PairList::fill_coefficients(const Rows& rows, const std::vector<Material>& materials) {
  varied_.resize(padded_);
  const auto body = [&](std::int32_t row) -> ContactBody {
    return {&materials[rows.material[row]], rows.radius[row], rows.mass[row]};
  };
  for (std::int64_t k = 0; k < tight_count_; ++k) {
    const auto a = body(first_[k]), b = body(second_[k]);
    const auto i = first_[k], j = second_[k];
    varied_.put(k, {a.radius_m, rows.scales[i]}, {b.radius_m, rows.scales[j]},
                ContactLaw::coefficients(BodiesInContact::particles(a, b)));
  }
}

ContactView PairList::view(std::int64_t begin, std::int64_t end) {
  ContactView v{
      first_.data() + begin, second_.data() + begin, end - begin, {}, {}, varied_.view(begin), nullptr};
  if (!touch_sum_.empty()) v.touch_sum = touch_sum_.data() + begin;
  for (int a = 0; a < 3; ++a)
    v.displacement[a] = springs_.full(a) + begin, v.rounded[a] = springs_.rounded(a) + begin;
  return v;
}

std::int64_t PairList::touching_count() const {
  std::int64_t n = 0;
  for (std::int64_t k = 0; k < tight_count_; ++k) n += !(springs_.get(k) == Vec3{});
  return n;
}

std::size_t PairList::bytes() const {
  return 4 * (near_i_.capacity() + near_j_.capacity() + first_.capacity() + second_.capacity() +
              number_.capacity() + next_number_.capacity() + found_first_.capacity() +
              found_second_.capacity() + found_number_.capacity() + place_.capacity()) +
         springs_.bytes() + next_springs_.bytes() + varied_.bytes() +
         8 * (touch_sum_.capacity() + next_touch_sum_.capacity());
}

}  // namespace granrad::native
