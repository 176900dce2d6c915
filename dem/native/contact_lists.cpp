#include "dem/native/contact_lists.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>

#include "dem/base/error.h"

namespace granrad::native {
namespace {
/// Half of the near list's skin and of the tight list's smallest margin, in radii: the measured optimum is
/// flat. A row in fast flight has a wider skin of its own, so that a few do not end the list of all.
constexpr double half_skin = 0.25, smallest_margin = 0.01, widest_half_skin = 0.6, widest_own_skin = 4;
constexpr double skin_lives = 4, slow_share = 0.9;  ///< tight lists a skin is made for; rows that share one
constexpr int longest_life = 2;                     ///< of a tight list where little moves, in usual lives
const double diagonal = 1.0001 * std::sqrt(3.0);    ///< speed limits hold for each direction alone
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

void ContactLists::deal(int threads, const Rows& rows, const WallSurface& surface) {
  if (!stale_) memories_ = collect(rows);
  set_touches_aside(rows, surface);
  shares_ = std::vector<Share>(threads);
  for (auto& s : shares_) s.outbox.resize(threads);
  stale_ = walls_stale_ = true;
  life_ = 0;
}

void ContactLists::visit_touches(const Share& s, const Rows& rows, const WallSurface& surface,
                                 RecordedTouches& out) {
  const auto to = [](std::vector<TouchSum>& sums) {
    return [&sums](std::int32_t a, std::int32_t b, double units) { sums.push_back({a, b, units}); };
  };
  s.own.visit_touches(rows, false, to(out.particles));
  s.cross.visit_touches(rows, true, to(out.particles));
  s.walls.visit_touches(surface, rows, to(out.walls));
}

void ContactLists::set_touches_aside(const Rows& rows, const WallSurface& surface) {
  for (auto& s : shares_) {
    visit_touches(s, rows, surface, touched_);
    s.own.clear_touches(), s.cross.clear_touches(), s.walls.clear_touches();
  }
}

void ContactLists::clear_touches() {
  for (auto& s : shares_) s.own.clear_touches(), s.cross.clear_touches(), s.walls.clear_touches();
  touched_.particles.clear(), touched_.walls.clear();
}

RecordedTouches ContactLists::touches(const Rows& rows, const WallSurface& surface) const {
  RecordedTouches all = touched_;
  for (const auto& s : shares_) visit_touches(s, rows, surface, all);
  return all;
}

double ContactLists::margin_of(double speed, std::int64_t steps) const {
  return diagonal * (speed + spare_speed_m_s_) * step_s_ * double(steps);
}

void ContactLists::survey_speeds(const Rows& rows, const Bed& bed) {
  std::int64_t tunnels = rows.count;
  double sum = 0;
#pragma omp parallel for num_threads(threads()) schedule(static) reduction(min : tunnels) reduction(+ : sum)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const Vec3 v = rows.velocity_of(i), p = rows.position_of(i);
    const bool sound =
        is_finite(v) && is_finite(p) && largest_component(v) <= fastest_step * rows.radius[i] / step_s_;
    if (!sound) tunnels = std::min(tunnels, i);
    sum += largest_component(v - mean_velocity_);
  }
  usual_speed_m_s_ = rows.count ? sum / double(rows.count) : 0;
  if (tunnels == rows.count) return;
  const Vec3 v = rows.velocity_of(tunnels), p = rows.position_of(tunnels);
  const double slower = 0.5 * fastest_step * rows.radius[tunnels] / largest_component(v);
  throw NumericalError(advised(
      fmt::format("particle {} at ({:.6g}, {:.6g}, {:.6g}) m moves at {:.4g} m/s, more than {} of its radius "
                  "per step of {:.3g} s (it would tunnel)",
                  bed.id[rows.bed_index[tunnels]], p.x, p.y, p.z, norm(v), fastest_step, step_s_),
      fmt::format("try a step of {:.2g} s, a higher Young's modulus, or starting positions with less overlap",
                  slower)));
}

/// How far row i may still move from where it is: beside the mean within the near list, in all within the
/// wall list.
ContactLists::Slack ContactLists::slack_of(const Rows& rows, std::int64_t i, const Vec3& moved) const {
  const Vec3 p = rows.position_of(i);
  const auto distance_moved = [&](const std::vector<double>& from, const Vec3& beside) {
    return norm(p - Vec3{from[3 * i], from[3 * i + 1], from[3 * i + 2]} - beside);
  };
  return {skins_.half_m[i] - distance_moved(near_origin_, moved),
          walls_stale_ || !has_walls_ ? 1e300 : skins_.half_m[i] - distance_moved(wall_origin_, {})};
}

ContactLists::Slack ContactLists::measure_slack(const Rows& rows, std::int64_t steps) const {
  if (stale_) return {-1, -1};
  const Vec3 moved = drift();
  const double mean_reach = norm(mean_velocity_) * step_s_ * double(steps);
  double near = 1e300, walls = 1e300;
#pragma omp parallel for num_threads(threads()) schedule(static) reduction(min : near, walls)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const double margin = margin_of(largest_component(rows.velocity_of(i) - mean_velocity_), steps);
    const Slack slack = slack_of(rows, i, moved);
    near = std::min(near, slack.near_m - margin);
    walls = std::min(walls, slack.walls_m - margin - mean_reach);
  }
  return {near, walls};
}

/// A velocity may change by the spare speed and by what `closing_` expects, as far as the near and wall lists
/// hold and the row does not tunnel.
void ContactLists::set_reaches(Rows& rows, std::int64_t steps) {
  rows.reference.resize(4 * rows.count);
  const Vec3 moved = drift();
  const double life_s = step_s_ * double(steps), mean_reach = norm(mean_velocity_) * life_s;
#pragma omp parallel for num_threads(threads()) schedule(static)
  for (std::int64_t i = 0; i < rows.count; ++i) {
    const Vec3 v = rows.velocity_of(i);
    const Slack slack = slack_of(rows, i, moved);
    const double listed = std::min(slack.near_m, slack.walls_m - mean_reach) / (diagonal * life_s) -
                          largest_component(v - mean_velocity_);
    const double sound = fastest_step * rows.radius[i] / step_s_ - largest_component(v);
    const double change = std::max(0.0, std::min({spare_speed_m_s_ + closing_[i], listed, sound}));
    for (int a = 0; a < 3; ++a) rows.reference[4 * i + a] = v[a];
    rows.reference[4 * i + 3] = change;
    rows.position[4 * i + 3] = rows.radius[i] + diagonal * change * life_s;
  }
}

/// Sets the reaches, with what each row's partners and walls may soon do to its velocity.
void ContactLists::anticipate(Rows& rows, Model& model, const Periods& periods, const WallSurface& surface,
                              std::int64_t steps) {
  model.constants.life_s = step_s_ * double(steps);
  set_reaches(rows, steps);
#pragma omp parallel num_threads(threads())
  {
    Share& share = shares_[omp_get_thread_num()];
    share.own.find_closing_speeds(kernels_, rows.view(), model.constants, false, closing_);
    share.cross.find_closing_speeds(kernels_, rows.view(), model.constants, true, closing_);
    share.walls.find_closing_speeds(surface, rows, periods, model.constants.life_s, closing_);
  }
  const auto meets = [&](double speed) { return speed > 0.1 * spare_speed_m_s_; };
  if (std::any_of(closing_.begin(), closing_.end(), meets)) set_reaches(rows, steps);
}

std::int64_t ContactLists::wanted_life(double largest_radius) const {
  const double usual = schedule_.refresh_every, longest = longest_life * usual;
  const double closing_m = 2 * diagonal * usual_speed_m_s_ * step_s_;
  const double crossing = closing_m > 0 ? smallest_margin * largest_radius / closing_m : longest;
  return static_cast<std::int64_t>(std::clamp(crossing, usual, longest));
}

void ContactLists::sort_rows(Rows& rows, const Periods& periods, const Bed& bed, double cell_m) {
  const auto order = grid_.sort(rows, periods, bed.box, cell_m, threads());
  const auto permute = [&](auto& column, int width) {
    auto sorted = column;
#pragma omp parallel for num_threads(threads()) schedule(static)
    for (std::int64_t i = 0; i < rows.count; ++i)
      std::copy_n(column.begin() + width * std::int64_t(order[i]), width, sorted.begin() + width * i);
    column.swap(sorted);
  };
  permute(rows.position, 4), permute(rows.velocity, 8), permute(rows.bed_index, 1), permute(skins_.half_m, 1);
  if (!rows.uniform)
    permute(rows.kick, 8), permute(rows.scales, 1), permute(rows.radius, 1), permute(rows.mass, 1),
        permute(rows.material, 1);
  for (std::int64_t i = 0; i < rows.count; ++i) rows.row_of[rows.bed_index[i]] = static_cast<std::int32_t>(i);
  near_origin_.resize(3 * rows.count);
  for (std::int64_t i = 0; i < rows.count; ++i)
    for (int a = 0; a < 3; ++a) near_origin_[3 * i + a] = rows.position[4 * i + a];
}

void ContactLists::choose_skins(const Rows& rows, double largest_radius, std::int64_t steps) {
  std::vector<double> speed(rows.count), sorted;
  for (std::int64_t i = 0; i < rows.count; ++i)
    speed[i] = largest_component(rows.velocity_of(i) - mean_velocity_);
  sorted = speed;
  double slow = 0;
  if (!sorted.empty()) {
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(slow_share * double(rows.count - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    slow = *at;
  }
  const auto skin = [&](double v, double least, double most) {
    return std::clamp(skin_lives * margin_of(v, steps), least, std::max(least, most));
  };
  skins_.base_m = skins_.widest_m = skin(slow, half_skin * largest_radius, widest_half_skin * largest_radius);
  skins_.half_m.resize(rows.count);
  for (std::int64_t i = 0; i < rows.count; ++i) {
    skins_.half_m[i] = skin(speed[i], skins_.base_m, widest_own_skin * largest_radius);
    skins_.widest_m = std::max(skins_.widest_m, skins_.half_m[i]);
  }
}

void ContactLists::find_walls(const Rows& rows, const Periods& periods, const WallSurface& surface) {
  wall_origin_.resize(3 * rows.count);
  listed_wall_gap_m_ = std::max(0.0, asked_gap_m_);
  const Vec3 moved = drift();
#pragma omp parallel num_threads(threads())
  {
    Share& share = shares_[omp_get_thread_num()];
    share.walls.find_near(surface, grid_, rows, periods, share.range, skins_.half_m, listed_wall_gap_m_,
                          moved, skins_.widest_m);
    for (auto i = share.range.begin; i < share.range.end; ++i)
      for (int a = 0; a < 3; ++a) wall_origin_[3 * i + a] = rows.position[4 * i + a];
  }
}

bool ContactLists::rebuild_is_due(const Slack& slack) const {
  const bool scheduled = schedule_.rebuild_every > 0 && steps_since_sort_ >= schedule_.rebuild_every;
  return stale_ || scheduled || listed_gap_m_ < asked_gap_m_ || slack.near_m < 0;
}

void ContactLists::restore_walls(const Rows& rows) {
  std::vector<std::vector<WallMemory>> at_walls(shares_.size());
  for (const auto& m : memories_) {
    if (m.second >= 0) continue;
    const auto row = rows.row_of[m.first];
    for (std::size_t t = 0; t < shares_.size(); ++t)
      if (shares_[t].owns(row)) at_walls[t].push_back({row, -1 - m.second, m.displacement});
  }
  for (std::size_t t = 0; t < shares_.size(); ++t) {
    std::sort(at_walls[t].begin(), at_walls[t].end(),
              [](const WallMemory& a, const WallMemory& b) { return a.row < b.row; });
    shares_[t].walls.restore(std::move(at_walls[t]));
  }
}

void ContactLists::rebuild(Rows& rows, const Model& model, const Periods& periods, const Bed& bed,
                           const WallSurface& surface, std::int64_t steps) {
  ++rebuilds;
  set_touches_aside(rows, surface);  // rows get other numbers
  if (!stale_) memories_ = collect(rows);
  Vec3 sum;
  for (std::int64_t i = 0; i < rows.count; ++i) sum += rows.velocity_of(i);
  mean_velocity_ = rows.count ? sum * (1.0 / double(rows.count)) : Vec3{};
  steps_since_sort_ = 0;
  stale_ = true;
  listed_gap_m_ = std::max(0.0, asked_gap_m_);
  choose_skins(rows, model.largest_radius, steps);
  sort_rows(rows, periods, bed, 2 * (model.largest_radius + skins_.base_m + 0.5 * listed_gap_m_) * 1.00001);
  NearSearch(kernels_, grid_, rows, periods, skins_, listed_gap_m_).fill(shares_);
  memory_table_.build(memories_, rows);
  restore_walls(rows);
  memories_.clear();
  stale_ = false, walls_stale_ = true;
}

void ContactLists::refresh(Rows& rows, const Model& model, const Periods& periods, const Bed& bed,
                           const WallSurface& surface, std::int64_t steps) {
#pragma omp parallel num_threads(threads())
  {
    const int t = omp_get_thread_num();
    Share& share = shares_[t];
    for (PairList* list : {&share.own, &share.cross}) {
      list->refresh(kernels_, rows.view(), model.constants, memory_table_);
      if (!rows.uniform) list->fill_coefficients(rows, bed.materials);
    }
    share.walls.refresh(surface, rows, periods, bed.materials, model.constants,
                        static_cast<std::int32_t>(rows.count + 2 * t));
    share.rows.choose(share.range, share.own, share.cross, share.walls, rows, model.move, steps);
  }
}

std::int64_t ContactLists::prepare(Rows& rows, Model& model, const Periods& periods, const Bed& bed,
                                   const WallSurface& surface) {
  if (life_ > 0) return life_;
  ++refreshes;
  step_s_ = model.constants.step_s;
  survey_speeds(rows, bed);
  std::int64_t steps = wanted_life(model.largest_radius);
  has_walls_ = surface.facet_count() > 0;
  spare_speed_m_s_ =
      std::max(spare_speed_m_s_, smallest_margin * model.largest_radius / (step_s_ * double(steps)));
  closing_.assign(rows.count + 2 * shares_.size(), 0);
  Slack slack = measure_slack(rows, steps);
  const bool rebuilt = rebuild_is_due(slack);
  if (rebuilt) rebuild(rows, model, periods, bed, surface, steps);
  const bool walls_due = walls_stale_ || slack.walls_m < 0;
  if (walls_due) {
    find_walls(rows, periods, surface);
    walls_stale_ = false;
  }
  if (rebuilt || walls_due) slack = measure_slack(rows, steps);
  // A fast particle shortens the life of the list.
  while (steps > 1 && slack.least_m() < 0) slack = measure_slack(rows, steps /= 2);
  anticipate(rows, model, periods, surface, steps);
  refresh(rows, model, periods, bed, surface, steps);
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
  std::vector<std::vector<Memory>> parts(shares_.size());
#pragma omp parallel num_threads(threads())
  {
    const int t = omp_get_thread_num();
    shares_[t].visit_springs(rows, [&](std::int32_t a, std::int64_t b, const Vec3& s) {
      parts[t].push_back({a, b, s});
    });
  }
  std::vector<Memory> all;
  for (auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

ContactLists::CompleteGaps ContactLists::complete_gaps(const Rows& rows) const {
  CompleteGaps gaps;
  if (stale_) return gaps;
  const Slack slack = measure_slack(rows, 0);
  gaps.particles_m = listed_gap_m_ + 2 * slack.near_m;
  if (!walls_stale_) gaps.walls_m = listed_wall_gap_m_ + slack.walls_m;
  return gaps;
}

std::size_t ContactLists::bytes() const {
  std::size_t sum = 8 * (near_origin_.capacity() + wall_origin_.capacity());
  for (const auto& s : shares_) sum += s.own.bytes() + s.cross.bytes();
  return sum;
}

}  // namespace granrad::native
