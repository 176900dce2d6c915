#pragma once
#include <cstdint>

#include "dem/native/contact_law.h"
#include "dem/native/row_offset.h"

namespace granrad::native {

/// What a contact in mixed precision reads of a particle, in one line of the cache: the row of its position, and that
/// of its velocity rounded.
struct alignas(64) MixedRow {
  double position[4];
  float velocity[8];
};

/// Rows of all particles, in the engine's own order. 64-byte aligned.
struct RowView {
  double* position;     ///< [4] x, y, z at the middle of the step, reach (radius + what a change of its
                        ///< velocity may move it until the next refresh)
  double* velocity;     ///< [8] v, 0, omega, 0
  std::int64_t* force;  ///< [8] F, 0, torque, 0, in fixed point; zero between steps
  MixedRow* mixed;      ///< of the same positions and velocities, for mixed precision; nullptr in double
};

/// Columns of what differs from contact to contact (dem/native/contact_columns.h).
enum class BodyColumn {
  first_radius,
  second_radius,
  first_force_scale,
  second_force_scale,
  first_torque_scale,
  second_torque_scale,
  count
};
inline constexpr int body_columns = static_cast<int>(BodyColumn::count);

struct VariedView {
  const double* columns;  ///< nullptr: all contacts are `StepConstants::pair` or `wall`
  std::int64_t stride;    ///< from one column to the next
};

/// Contacts between two rows (`count` a multiple of 16), or a row and a plane (of 8); entries up to 64 beyond
/// it are valid rows (prefetching looks there).
struct ContactView {
  const RowOffset* first;
  const RowOffset* second;
  std::int64_t count;
  double* displacement[3];  ///< tangential springs, m
  float* rounded[3];        ///< the same where the law is in single precision
  VariedView varied;
  double* touch_sum;  ///< see TouchSum; nullptr: not recorded
};

/// Walls that act as planes: rows {point, 0, unit normal, 0} of eight and velocity rows {v, 0} of four
/// doubles.
struct PlaneView {
  const double* geometry;
  const double* velocity;
};

/// Fixed-point units per N and per N m of what acts on one particle (powers of two).
struct FixedScales {
  double force = 1, torque = 1;
};

/// What every contact of a step needs.
struct StepConstants {
  LawCoefficients pair, wall;  ///< when all particles are alike
  double radius;
  double step_s;
  double touch_units;  ///< of contact sums (TouchSum), 1/m; 0: none are recorded
  double life_s;       ///< of the tight lists, from one refresh to the next
  bool periodic;
  double period[3], inverse_period[3];  ///< zero where not periodic
  FixedScales scales;                   ///< of every particle where all are alike
};

/// What moving the particles needs. kick rows {dt/m x3, 0, dt/I x3, 0} divided by the fixed-point scales.
struct MoveConstants {
  const double* kick;                  ///< aligned like the rows
  std::int64_t kick_stride;            ///< 0: one row for all, 8: one each
  alignas(64) double gravity_kick[8];  ///< {g dt, 0 ...}
  const double* reference;             ///< rows {v at the last refresh, most it may change in each direction}
  double half_step_s;
};

/// An overlap deeper than this fraction of the (smaller) radius is beyond the model.
inline constexpr double deepest_overlap = 0.5;

/// The worst contact met in a step.
struct WorstContact {
  double beyond_m = -1;  ///< largest overlap - deepest_overlap x (smaller) radius
  double force_units =
      0;  ///< largest component of a force, in the finer of its two bodies' fixed-point units

  [[gnu::always_inline]] inline void include(const WorstContact& w) {
    beyond_m = w.beyond_m > beyond_m ? w.beyond_m : beyond_m;
    force_units = w.force_units > force_units ? w.force_units : force_units;
  }
};

using PairKernel = WorstContact (*)(const RowView&, const ContactView&, const StepConstants&);

/// The inner loops, compiled once for each instruction set from kernel_bodies.h and pair_bodies.h.
struct Kernels {
  const char* name;
  /// Adds forces to both rows; `pair_contacts_first` to the first row only (the second has another owner).
  PairKernel pair_contacts, pair_contacts_first;
  /// The same with the law in single precision and positions and velocities from `RowView::mixed`.
  PairKernel mixed_contacts, mixed_contacts_first;
  /// `second` numbers planes.
  WorstContact (*plane_contacts)(const RowView&, const ContactView&, const PlaneView&, const StepConstants&);
  /// v += F dt/m + g dt, omega likewise (and `mixed`), x += v dt/2, forces cleared, `count` rows of `list`.
  /// Unless `last`, x moves another half step, to the middle of the next one. True if a speed limit is broken
  /// (or not a number).
  bool (*move)(const RowView&, const std::int32_t* list, std::int64_t count, const MoveConstants&, bool last);
  /// The same bits as `steps` (at least one) calls of `move`, for rows without a force that break no limit; leaves
  /// `mixed` as it is. `last` holds of the last step.
  void (*fly)(const RowView&, const std::int32_t* list, std::int64_t count, const MoveConstants&,
              std::int64_t steps, bool last);
  /// Keeps the pairs closer than the sum of their reaches and of what they move towards each other in life_s:
  /// rows into `first`, `second`, their numbers into `source`. `count` is padded to a multiple of 8. Returns
  /// how many; writes up to 8 entries beyond.
  std::int64_t (*select_close)(const RowView&, const StepConstants&, const std::int32_t* i,
                               const std::int32_t* j, std::int64_t count, std::int32_t* first,
                               std::int32_t* second, std::int32_t* source);
  /// Keeps the pairs (i, j) whose surfaces are at most a gap apart, of rows placed at `place` (x, y, z, radius): their numbers
  /// and the distances of their centres. Reads i and j up to a multiple of 8, writes up to 8 entries beyond.
  std::int64_t (*find_near)(const double* place, double gap_m, const std::int32_t* i, const std::int32_t* j,
                            std::int64_t count, std::int32_t* number, double* distance_m);
  decltype(&ScalarPack::find_close) find_close;
};

const Kernels& avx512_kernels();
const Kernels& avx2_kernels();
const Kernels& baseline_kernels();

/// The best this machine runs, or what the environment variable GRANRAD_SIMD (avx512 | avx2 | baseline) asks
/// for. Throws InputError for another value or an instruction set the machine lacks.
const Kernels& select_kernels();

}  // namespace granrad::native
