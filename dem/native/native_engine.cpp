#include "dem/native/native_engine.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

#include "dem/base/clock.h"
#include "dem/base/error.h"
#include "dem/engine_native.h"
#include "dem/native/bed_transfer.h"
#include "dem/native/model.h"
#include "dem/native/near_from_lists.h"
#include "dem/native/step_barrier.h"
#include "dem/native/thread_choice.h"
#include "dem/step_clock.h"

namespace granrad::native {
namespace {

bool same_walls(const std::vector<Wall>& a, const std::vector<Wall>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Wall& v, const Wall& w) {
    return v.vertices == w.vertices && v.triangles == w.triangles && v.contact == w.contact &&
           v.velocity_m_s == w.velocity_m_s && v.opens_at_s == w.opens_at_s;
  });
}

bool same_box(const Bed& bed, const Box& box, const Periods& periods) {
  bool same = bed.box.min == box.min && bed.box.max == box.max;
  for (int a = 0; a < 3; ++a) same &= (periods.length[a] > 0) == bed.periodic[a];
  return same;
}

/// Threads that find enough work to be worth their barriers, of `most`; few different numbers as a bed grows.
int useful_threads(int most, std::int64_t particles) {
  constexpr std::int64_t particles_each = 400;
  const std::int64_t useful = particles / particles_each;
  if (useful >= most) return most;
  return std::max(1, static_cast<int>(std::bit_floor(static_cast<std::uint64_t>(useful))));
}

}  // namespace

struct NativeEngine::Impl {
  Vec3 gravity;
  double step_s;
  EngineOptions options;
  const Kernels& kernels;
  Rows rows;
  BedTransfer transfer;
  std::unique_ptr<ContactLists> lists;
  std::unique_ptr<WallSurface> surface;
  std::vector<Wall> walls;
  std::unique_ptr<Periods> periods;
  Box box{};
  Model model;
  ThreadChoice choice{1};
  int most_threads = 0;          ///< rows are laid out for
  std::int64_t touch_steps = 0;  ///< of the last advance
  double left_at_s = 0;          ///< time of the Bed after the last advance
  std::int64_t list_reads = 0;

  Impl(const Vec3& g, double step, const EngineOptions& o)
      : gravity(g), step_s(step), options(o), kernels(o.kernels ? *o.kernels : select_kernels()) {}

  void load(const Bed& bed);
  void choose_threads(std::int64_t particles);
  void load_walls(const Bed& bed);
  std::int64_t run(std::int64_t steps, bool finishes, bool& limit_broken);
  void check_overlaps(const Bed& bed);
  /// Whether this is the Bed the last advance left.
  bool holds(const Bed& bed) const;
};

bool NativeEngine::Impl::holds(const Bed& bed) const {
  return same_box(bed, box, *periods) && same_walls(bed.walls, walls) && bed.time_s == left_at_s &&
         transfer.holds(bed, rows);
}

void NativeEngine::Impl::load_walls(const Bed& bed) {
  const bool known = surface && same_walls(bed.walls, walls);
  if (!known) {
    walls = bed.walls;
    surface = std::make_unique<WallSurface>(walls);
  }
  surface->set_time(walls, bed.time_s);
  if (!known && lists) lists->walls_changed();
}

void NativeEngine::Impl::choose_threads(std::int64_t particles) {
  const int most = options.threads > 0 ? options.threads : omp_get_max_threads();
  if (most != most_threads) most_threads = most, rows.count = -1;
  const bool fixed = !options.adapts && options.threads > 0;
  const int useful = fixed ? most : useful_threads(most, particles);
  if (choice.most() != useful) choice = ThreadChoice(useful, !options.adapts);
}

void NativeEngine::Impl::load(const Bed& bed) {
  choose_threads(static_cast<std::int64_t>(bed.size()));
  if (!lists || !same_box(bed, box, *periods)) {
    lists = std::make_unique<ContactLists>(kernels, choice.threads(), options.schedule);
    periods = std::make_unique<Periods>(bed);
    box = bed.box;
    rows.count = -1;
  }
  load_walls(bed);
  const auto change = transfer.load(bed, rows, 0.5 * step_s, choice.threads(), most_threads);
  if (options.precision == Precision::mixed) rows.mixed.resize(rows.velocity.size() / 8);
  if (change == BedTransfer::Change::particles)
    model = make_model(bed, rows, *periods, gravity, step_s, options.precision, options.records_touches);
  if (change >= BedTransfer::Change::memory) lists->restart(BedTransfer::memories(bed));
  if (change == BedTransfer::Change::moved) lists->touch();
  model.move.kick = rows.uniform ? model.kick_row.data() : rows.kick.data();
  model.move.kick_stride = rows.uniform ? 0 : 8;
}

/// Up to `steps` steps with the lists as they are; fewer if a speed limit is broken. When the last of them
/// `finishes` the advance, positions stop at the end of the step instead of the middle of the next.
std::int64_t NativeEngine::Impl::run(std::int64_t steps, bool finishes, bool& limit_broken) {
  auto& shares = lists->shares();
  std::int64_t done = 0;
  limit_broken = false;
  model.move.kick = rows.uniform ? model.kick_row.data() : rows.kick.data();
  model.move.reference = rows.reference.data();
  const bool mixed = options.precision == Precision::mixed;
  const auto all_contacts = mixed ? kernels.mixed_contacts : kernels.pair_contacts;
  const auto first_contacts = mixed ? kernels.mixed_contacts_first : kernels.pair_contacts_first;
  const bool shared =
      std::any_of(shares.begin(), shares.end(), [](const Share& s) { return s.cross.tight_count() > 0; });
  StepBarrier barrier(static_cast<int>(shares.size()));
#pragma omp parallel num_threads(static_cast <int>(shares.size()))
  {
    Share& share = shares[omp_get_thread_num()];
    const RowView view = rows.view();
    WorstContact worst;
    bool stop = false;
    rows.fill_mixed(share.range.begin, share.range.end);
#pragma omp master
    rows.fill_mixed(rows.count, static_cast<std::int64_t>(rows.mixed.size()));  // the idle rows
    barrier.wait();
    std::int64_t k = 0;
    for (; k < steps && !stop; ++k) {
      worst.include(first_contacts(view, share.cross.view(), model.constants));
      worst.include(
          share.walls.add_forces(kernels, *surface, rows, *periods, model.constants, transfer.materials()));
      if (shared) barrier.wait();  // now no one else needs these rows where they are
      bool& too_fast = share.too_fast[k & 1];
      too_fast = false;
      const auto& bound = share.rows.bound();
      std::int64_t moved = 0;
      const auto move_rows_before = [&](std::int64_t row) {
        const auto end = share.rows.bound_before(row);
        too_fast |=
            kernels.move(view, bound.data() + moved, end - moved, model.move, finishes && k + 1 == steps);
        moved = end;
      };
      for (std::int64_t b = 0; b < share.own.blocks(); ++b) {
        worst.include(all_contacts(view, share.own.view_of(b), model.constants));
        move_rows_before(std::min(share.own.settled_before(b), share.range.end));
      }
      move_rows_before(share.range.end);
      barrier.wait();
      for (const auto& s : shares) stop |= s.too_fast[k & 1];
#pragma omp master
      done = k + 1, limit_broken = stop;
    }
    const auto& free = share.rows.free();
    kernels.fly(view, free.data(), std::ssize(free), model.move, k, finishes && k == steps);
    share.worst = worst;
  }
  return done;
}

void NativeEngine::Impl::check_overlaps(const Bed& bed) {
  const auto& shares = lists->shares();
  WorstContact all;
  for (const auto& s : shares) all.include(s.worst);
  if (!(all.force_units <= model.largest_force_units))
    throw NumericalError(advised(
        fmt::format(
            "a contact force near t = {:.6g} s exceeds {:.3g} times what bodies of its size bear at half "
            "a radius of overlap (fast bodies or spins, for a step of {:.3g} s)",
            bed.time_s, all.force_units / model.largest_force_units, step_s),
        "try a smaller step, or slower bodies at the start"));
  if (all.beyond_m <= 0) return;
  std::string where = "near a wall";
  double worst = 0;
  for (const auto& s : shares)
    for (std::int64_t k = 0; k < s.own.near_count() + s.cross.near_count(); ++k) {
      const bool cross = k >= s.own.near_count();
      const auto& list = cross ? s.cross : s.own;
      const auto i = list.near_firsts()[cross ? k - s.own.near_count() : k],
                 j = list.near_seconds()[cross ? k - s.own.near_count() : k];
      const double sum = rows.radius[i] + rows.radius[j];
      const double depth = (sum - norm(periods->nearest(rows.position_of(i) - rows.position_of(j)))) /
                           std::min(rows.radius[i], rows.radius[j]);
      if (depth <= worst) continue;
      worst = depth;
      const Vec3 p = rows.position_of(i);
      where = fmt::format("of particles {} and {} at ({:.6g}, {:.6g}, {:.6g}) m", bed.id[rows.bed_index[i]],
                          bed.id[rows.bed_index[j]], p.x, p.y, p.z);
    }
  throw NumericalError(
      advised(fmt::format("an overlap {} exceeds {} of the radius (beyond the contact model)", where,
                          deepest_overlap),
              "try a smaller step, a higher Young's modulus, or starting positions that overlap less"));
}

NativeEngine::NativeEngine(const Bed&, const Vec3& gravity, double step_s, const EngineOptions& options)
    : impl_(std::make_unique<Impl>(gravity, step_s, options)) {
  if (!(step_s > 0)) throw InputError(fmt::format("dem.step_s = {} (must be positive)", step_s));
}

NativeEngine::~NativeEngine() = default;

void NativeEngine::advance(Bed& bed, double until_s) {
  Impl& e = *impl_;
  const StepClock clock(bed, e.step_s);
  const std::int64_t last = clock.first_at_or_after(until_s);
  if (last <= bed.step) return;
  if (bed.size() == 0) {  // nothing to move, and no length to size cells by
    bed.step = last, bed.time_s = clock.time_s(last);
    return;
  }
  e.load(bed);
  e.lists->clear_touches();
  e.touch_steps = last - bed.step;
  std::int64_t step = bed.step;
  while (step < last) {
    if (e.choice.threads() != e.lists->threads()) e.lists->deal(e.choice.threads(), e.rows, *e.surface);
    const double opens = next_opening_s(e.walls, clock.time_s(step)), started_s = monotonic_s();
    auto steps = std::min(last - step, e.lists->prepare(e.rows, e.model, *e.periods, bed, *e.surface));
    steps = e.choice.longest_piece(steps);
    if (opens < clock.time_s(step + steps))
      steps = std::clamp<std::int64_t>(clock.first_at_or_after(opens) - step, 1, steps);
    bool limit_broken = false;
    const auto done = e.run(steps, step + steps == last, limit_broken);
    step += done;
    e.lists->spend(done, limit_broken);
    e.check_overlaps(bed);
    const double ended_s = monotonic_s();
    e.choice.spent(done, ended_s - started_s, ended_s);
    if (clock.time_s(step) >= opens) {
      e.surface->set_time(e.walls, clock.time_s(step));
      e.lists->walls_changed();
    }
  }
  e.transfer.store(e.rows, e.lists->shares(), bed);
  bed.step = last;
  bed.time_s = e.left_at_s = clock.time_s(last);
}

NearPairs NativeEngine::near_pairs(const Bed& bed, double max_gap_m) {
  Impl& e = *impl_;
  if (!e.lists || !e.holds(bed)) return granrad::near_pairs(bed, max_gap_m);
  e.lists->keep_complete_to(max_gap_m);
  const auto complete = e.lists->complete_gaps(e.rows);
  if (complete.particles_m < max_gap_m) return granrad::near_pairs(bed, max_gap_m);
  ++e.list_reads;
  NearPairs pairs;
  pairs.particles = near_particles(bed, e.rows, *e.lists, e.kernels, max_gap_m);
  if (!bed.walls.empty()) {
    const bool listed = complete.walls_m >= max_gap_m && e.surface->is_whole();
    const bool images = e.periods->any;
    const auto at_walls =
        listed && images ? particles_at_walls(*e.lists, e.rows) : std::vector<std::int32_t>{};
    pairs.walls = listed && !images
                      ? near_walls(*e.lists, e.rows, *e.surface, max_gap_m)
                      : granrad::near_walls(bed, *e.surface, max_gap_m, listed ? &at_walls : nullptr);
  }
  return pairs;
}

void NativeEngine::record_touches() {
  if (impl_->options.records_touches) return;
  impl_->options.records_touches = true;
  impl_->rows.count = -1;  // the model is made anew
}

std::optional<Touches> NativeEngine::touches(const Bed& bed) const {
  const Impl& e = *impl_;
  if (!e.options.records_touches || !e.lists || !e.holds(bed)) return {};
  const auto sums = e.lists->touches(e.rows, *e.surface);
  const double units = e.model.constants.touch_units;
  return Touches{touch_means<PairTouch>(sums.particles, bed.size(), units, e.touch_steps),
                 touch_means<WallTouch>(sums.walls, bed.size(), units, e.touch_steps)};
}

EngineThreads NativeEngine::threads() const {
  return {impl_->choice.threads(), impl_->most_threads};
}

EngineCounts NativeEngine::counts() const {
  EngineCounts c;
  if (!impl_->lists) return c;
  for (const auto& s : impl_->lists->shares()) {
    c.near_pairs += s.own.near_count() + s.cross.near_count();
    c.tight_pairs += s.own.tight_count() + s.cross.tight_count();
    c.touching += s.own.touching_count();
    c.wall_contacts += s.walls.contact_count();
  }
  c.rebuilds = impl_->lists->rebuilds, c.refreshes = impl_->lists->refreshes;
  c.list_reads = impl_->list_reads;
  const auto& r = impl_->rows;
  const double rows = 64.0 * double(r.mixed.capacity()) +
                      8.0 * double(r.position.capacity() + r.velocity.capacity() + r.force.capacity() +
                                   r.kick.capacity() + r.radius.capacity() + r.mass.capacity()) +
                      4.0 * double(3 * r.bed_index.capacity());
  c.bytes_per_particle = r.count > 0 ? (rows + double(impl_->lists->bytes())) / double(r.count) : 0;
  return c;
}

}  // namespace granrad::native

namespace granrad {

std::unique_ptr<Engine> make_native_engine(const Bed& bed, const Vec3& gravity_m_s2, double step_s,
                                           int threads, Precision precision) {
  native::EngineOptions options;
  options.threads = threads, options.precision = precision, options.adapts = true;
  return std::make_unique<native::NativeEngine>(bed, gravity_m_s2, step_s, options);
}

}  // namespace granrad
