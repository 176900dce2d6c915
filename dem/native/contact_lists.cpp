#include "dem/native/contact_lists.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "dem/scene/error.h"

namespace granrad::native {
namespace {
/// Half of the near list's skin and of the tight list's smallest margin, in radii: the measured optimum is
/// flat.
constexpr double half_skin = 0.25, smallest_margin = 0.01, widest_half_skin = 0.6;
const double diagonal = 1.0001 * std::sqrt(3.0);  ///< speed limits hold for each direction alone
double largest_component(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}
}  // namespace

ContactLists::ContactLists(const Kernels& kernels, int threads, ListSchedule schedule)
    : kernels_(kernels), schedule_(schedule), shares_(threads) {
  for (auto& s : shares_) s.outbox.resize(threads);
}

void ContactLists::restart(std::vector<Memory> memories) {
  memories_ = std::move(memories);
  stale_ = walls_stale_ = true;
  life_ = 0;
}

double ContactLists::margin_of(double speed, std::int64_t steps) const {
  return diagonal * (speed + spare_speed_m_s_) * step_s_ * double(steps);
}

void ContactLists::check_speeds(const Rows& rows, const Bed& bed) const {
  std::int64_t tunnels = rows.count;
#pragma omp parallel for num_threads(static_cast <int>(shares_.size())) schedule(static) \
    reduction(min                                                                        \
              : tunnels)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const Vec3 v = rows.velocity_of(i), p = rows.position_of(i);
    const bool sound =
        is_finite(v) && is_finite(p) && largest_component(v) <= fastest_step * rows.radius[i] / step_s_;
    if (!sound) tunnels = std::min(tunnels, i);
  }
  if (tunnels == rows.count) return;
  const Vec3 v = rows.velocity_of(tunnels), p = rows.position_of(tunnels);
  const double advised = 0.5 * fastest_step * rows.radius[tunnels] / largest_component(v);
  throw NumericalError(
      fmt::format("particle {} at ({:.6g}, {:.6g}, {:.6g}) m moves at {:.4g} m/s, more than {} of its "
                  "radius per step of {:.3g} s (it would tunnel) try a step of {:.2g} s, a higher Young's "
                  "modulus, or starting positions with less overlap",
                  bed.id[rows.bed_index[tunnels]], p.x, p.y, p.z, norm(v), fastest_step, step_s_, advised));
}

ContactLists::Motion ContactLists::measure(const Rows& rows, std::int64_t steps) const {
  Motion all;
  const Vec3 moved = drift();
  const double mean_reach = norm(mean_velocity_) * step_s_ * double(steps);
  double fastest = 0, travelled = 0, near_need = 0, wall_need = 0;
#pragma omp parallel for num_threads(static_cast <int>(shares_.size())) schedule(static) \
    reduction(max                                                                        \
              : fastest, travelled, near_need, wall_need)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const Vec3 p = rows.position_of(i);
    const double speed = largest_component(rows.velocity_of(i) - mean_velocity_),
                 margin = margin_of(speed, steps);
    fastest = std::max(fastest, speed);
    if (stale_) continue;
    const Vec3 a{near_origin_[3 * i], near_origin_[3 * i + 1], near_origin_[3 * i + 2]};
    const double way = norm(p - a - moved);
    travelled = std::max(travelled, way);
    near_need = std::max(near_need, way + margin);
    if (walls_stale_) continue;
    const Vec3 b{wall_origin_[3 * i], wall_origin_[3 * i + 1], wall_origin_[3 * i + 2]};
    wall_need = std::max(wall_need, norm(p - b) + margin + mean_reach);
  }
  all.fastest = fastest, all.travelled = travelled, all.near_need = near_need, all.wall_need = wall_need;
  return all;
}

void ContactLists::set_reaches(Rows& rows, std::int64_t steps) {
#pragma omp parallel for num_threads(static_cast <int>(shares_.size())) schedule(static)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const Vec3 v = rows.velocity_of(i);
    const double speed = largest_component(v - mean_velocity_);
    const double room = fastest_step * rows.radius[i] / step_s_ - largest_component(mean_velocity_);
    rows.position[4 * i + 3] = rows.radius[i] + margin_of(speed, steps);
    rows.velocity[8 * i + 3] = std::max(0.0, std::min(speed + spare_speed_m_s_, std::max(room, speed)));
  }
}

void ContactLists::sort_rows(Rows& rows, const Periods& periods, const Bed& bed, double cell_m) {
  const auto order = grid_.sort(rows, periods, bed.box, cell_m, static_cast<int>(shares_.size()));
  const auto permute = [&](auto& column, int width) {
    auto sorted = column;
#pragma omp parallel for num_threads(static_cast <int>(shares_.size())) schedule(static)
    for (std::int64_t i = 0; i < rows.count; ++i)
      std::copy_n(column.begin() + width * std::int64_t(order[i]), width, sorted.begin() + width * i);
    column.swap(sorted);
  };
  permute(rows.position, 4), permute(rows.velocity, 8), permute(rows.bed_index, 1);
  if (!rows.uniform)
    permute(rows.kick, 8), permute(rows.radius, 1), permute(rows.mass, 1), permute(rows.material, 1);
  for (std::int64_t i = 0; i < rows.count; ++i) rows.row_of[rows.bed_index[i]] = static_cast<std::int32_t>(i);
  near_origin_.resize(3 * rows.count);
  for (std::int64_t i = 0; i < rows.count; ++i)
    for (int a = 0; a < 3; ++a) near_origin_[3 * i + a] = rows.position[4 * i + a];
}

void ContactLists::find_near(const Rows& rows, const Periods& periods) {
  const std::int64_t n = rows.count;
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (std::int64_t i = 0; i < n; ++i)
    for (int a = 0; a < 3; ++a)
      low[a] = std::min(low[a], rows.position[4 * i + a]),
      high[a] = std::max(high[a], rows.position[4 * i + a]);
  double extent = 0;
  for (int a = 0; a < 3; ++a)
    extent = std::max(extent, periods.length[a] > 0 ? periods.length[a] : high[a] - low[a]);
  const double rounding = 1e-6 * extent;  // of single precision in the search
  std::vector<float> coordinate[4];
  for (auto& c : coordinate) c.resize(n + 16);
  for (std::int64_t i = 0; i < n; ++i) {
    for (int a = 0; a < 3; ++a) {
      double x = rows.position[4 * i + a] - low[a];
      if (periods.length[a] > 0) x -= periods.length[a] * std::floor(x * periods.inverse[a]);
      coordinate[a][i] = static_cast<float>(x);
    }
    coordinate[3][i] = static_cast<float>(rows.radius[i] + half_skin_m_ + 0.5 * listed_gap_m_ + rounding);
  }
  float period[3], inverse[3];
  for (int a = 0; a < 3; ++a)
    period[a] = static_cast<float>(periods.length[a]), inverse[a] = static_cast<float>(periods.inverse[a]);
  const auto threads = static_cast<int>(shares_.size());
  const auto owner_of = [&](std::int64_t row) {
    auto t = static_cast<int>(row * threads / std::max<std::int64_t>(n, 1));
    while (row >= shares_[t].range.end) ++t;
    while (row < shares_[t].range.begin) --t;
    return t;
  };
  for (int t = 0; t < threads; ++t) shares_[t].range = {n * t / threads, n * (t + 1) / threads};
#pragma omp parallel num_threads(threads)
  {
    const int t = omp_get_thread_num();
    Share& share = shares_[t];
    share.own.clear_near(), share.cross.clear_near();
    for (auto& box : share.outbox) box.clear();
    std::vector<std::int32_t> found(1024);
    for (auto i = share.range.begin; i < share.range.end; ++i) {
      const float p[4] = {coordinate[0][i], coordinate[1][i], coordinate[2][i], coordinate[3][i]};
      grid_.ranges_behind(i, [&](std::int32_t begin, std::int32_t end) {
        if (begin >= end) return;
        if (end - begin + 32 > static_cast<std::int32_t>(found.size())) found.resize(2 * (end - begin) + 32);
        const auto count =
            kernels_.find_close(&coordinate[0][begin], &coordinate[1][begin], &coordinate[2][begin],
                                &coordinate[3][begin], p, period, inverse, begin, end - begin, found.data());
        const auto row = static_cast<std::int32_t>(i);
        if (begin >= share.range.begin && end <= share.range.end)
          return share.own.add_near(row, found.data(), count);
        for (std::int64_t k = 0; k < count; ++k) {
          const auto j = found[k];
          if (j >= share.range.begin && j < share.range.end) {
            share.own.add_near(row, j);
          } else {
            share.cross.add_near(row, j);
            share.outbox[owner_of(j)].push_back({j, row});
          }
        }
      });
    }
#pragma omp barrier
    for (const auto& other : shares_)
      for (const auto& [i, j] : other.outbox[t]) share.cross.add_near(i, j);
    const auto idle = static_cast<std::int32_t>(n + 2 * t);
    share.own.finish_near(idle), share.cross.finish_near(idle);
  }
}

void ContactLists::find_walls(const Rows& rows, const Periods& periods, const WallSurface& surface) {
  wall_origin_.resize(3 * rows.count);
  listed_wall_gap_m_ = std::max(0.0, asked_gap_m_);
  const Vec3 moved = drift();
#pragma omp parallel num_threads(static_cast <int>(shares_.size()))
  {
    Share& share = shares_[omp_get_thread_num()];
    share.walls.find_near(surface, grid_, rows, periods, share.range, half_skin_m_ + listed_wall_gap_m_,
                          moved, half_skin_m_);
    for (auto i = share.range.begin; i < share.range.end; ++i)
      for (int a = 0; a < 3; ++a) wall_origin_[3 * i + a] = rows.position[4 * i + a];
  }
}

std::int64_t ContactLists::prepare(Rows& rows, Model& model, const Periods& periods, const Bed& bed,
                                   const WallSurface& surface) {
  if (life_ > 0) return life_;
  ++refreshes;
  step_s_ = model.constants.step_s;
  std::int64_t steps = schedule_.refresh_every;
  spare_speed_m_s_ =
      std::max(spare_speed_m_s_, smallest_margin * model.largest_radius / (step_s_ * double(steps)));
  check_speeds(rows, bed);
  Motion motion = measure(rows, steps);
  const bool due = (schedule_.rebuild_every > 0 && steps_since_sort_ >= schedule_.rebuild_every) ||
                   listed_gap_m_ < asked_gap_m_;
  const bool rebuild = stale_ || due || motion.near_need > half_skin_m_;
  if (rebuild) {
    ++rebuilds;
    if (!stale_) memories_ = collect(rows);
    Vec3 sum;
    for (std::int64_t i = 0; i < rows.count; ++i) sum += rows.velocity_of(i);
    mean_velocity_ = rows.count ? sum * (1.0 / double(rows.count)) : Vec3{};
    steps_since_sort_ = 0;
    stale_ = true;
    motion = measure(rows, steps);
    const double widest = widest_half_skin * model.largest_radius;
    half_skin_m_ = std::clamp(4 * margin_of(motion.fastest, steps), half_skin * model.largest_radius, widest);
    listed_gap_m_ = std::max(0.0, asked_gap_m_);
    sort_rows(rows, periods, bed, 2 * (model.largest_radius + half_skin_m_ + 0.5 * listed_gap_m_) * 1.00001);
    find_near(rows, periods);
    memory_table_.build(memories_, rows);
    std::vector<std::vector<WallMemory>> at_walls(shares_.size());
    for (const auto& m : memories_) {
      if (m.second >= 0) continue;
      const auto row = rows.row_of[m.first];
      for (std::size_t t = 0; t < shares_.size(); ++t)
        if (row >= shares_[t].range.begin && row < shares_[t].range.end)
          at_walls[t].push_back({row, -1 - m.second, m.displacement});
    }
    for (std::size_t t = 0; t < shares_.size(); ++t) {
      std::sort(at_walls[t].begin(), at_walls[t].end(),
                [](const WallMemory& a, const WallMemory& b) { return a.row < b.row; });
      shares_[t].walls.restore(std::move(at_walls[t]));
    }
    memories_.clear();
    stale_ = false, walls_stale_ = true;
  }
  if (walls_stale_ || motion.wall_need > half_skin_m_) {
    find_walls(rows, periods, surface);
    walls_stale_ = false;
  }
  while (steps > 1) {  // a fast particle shortens the life of the list
    motion = measure(rows, steps);
    if (std::max(motion.near_need, motion.wall_need) <= half_skin_m_) break;
    steps /= 2;
  }
  set_reaches(rows, steps);
  for (int a = 0; a < 3; ++a) model.move.mean_velocity[a] = mean_velocity_[a];
  const double mean_reach = norm(mean_velocity_) * step_s_ * double(steps);
  const bool varied = !rows.uniform;
#pragma omp parallel num_threads(static_cast <int>(shares_.size()))
  {
    const int t = omp_get_thread_num();
    Share& share = shares_[t];
    for (PairList* list : {&share.own, &share.cross}) {
      list->refresh(kernels_, rows.view(), model.constants, memory_table_);
      if (varied) list->fill_coefficients(rows, bed.materials);
    }
    share.walls.refresh(surface, rows, periods, bed.materials, mean_reach,
                        static_cast<std::int32_t>(rows.count + 2 * t));
  }
  life_ = promised_ = steps;
  return life_;
}

void ContactLists::spend(std::int64_t steps, bool limit_broken) {
  life_ -= steps;
  steps_since_sort_ += steps;
  // Lists that die early ask for more room, lists that live out their life for less.
  if (limit_broken && 2 * (promised_ - life_) < promised_) spare_speed_m_s_ *= 1.5;
  if (life_ == 0 && !limit_broken) spare_speed_m_s_ *= 0.98;
  if (limit_broken) life_ = 0;
}

std::vector<Memory> ContactLists::collect(const Rows& rows) const {
  if (stale_) return memories_;
  std::vector<std::vector<Memory>> parts(shares_.size());
#pragma omp parallel num_threads(static_cast <int>(shares_.size()))
  {
    const int t = omp_get_thread_num();
    shares_[t].own.collect(rows, false, parts[t]);
    shares_[t].cross.collect(rows, true, parts[t]);
    for (const auto& m : shares_[t].walls.collect())
      parts[t].push_back({rows.bed_index[m.row], -1 - m.feature, m.displacement});
  }
  std::vector<Memory> all;
  for (auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

ContactLists::CompleteGaps ContactLists::complete_gaps(const Rows& rows) const {
  CompleteGaps gaps;
  if (stale_) return gaps;
  const Motion motion = measure(rows, 0);
  gaps.particles_m = listed_gap_m_ + 2 * (half_skin_m_ - motion.near_need);
  if (!walls_stale_) gaps.walls_m = listed_wall_gap_m_ + half_skin_m_ - motion.wall_need;
  return gaps;
}

std::size_t ContactLists::bytes() const {
  std::size_t sum = 8 * (near_origin_.capacity() + wall_origin_.capacity());
  for (const auto& s : shares_) sum += s.own.bytes() + s.cross.bytes();
  return sum;
}

}  // namespace granrad::native
