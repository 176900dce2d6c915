#pragma once
#include "dem/native/kernels.h"

// The inner loop over contacts between particles for a pack S, in double or mixed precision. Nothing from the
// standard library is used here: an inline function compiled for AVX-512 must never be the copy the linker
// keeps for everyone.
namespace granrad::native {

inline constexpr double quarter_pi = 0.78539816339744830962;
/// Contacts between asking the caches for rows, or for springs, and reading them.
inline constexpr std::int64_t rows_ahead = 32, springs_ahead = 64;
/// Packs between gathering and the law, and between the law and scattering; their data stays in L1.
inline constexpr std::int64_t lead = 2;  // a power of two

/// S works the law in its own numbers V (of Lane). Differences of positions, the test for touching and the
/// sums are double in any case, in S::halves packs of D = S::Wide (one, S itself, in double precision).
template <class S>
struct PairBodies {
  using D = typename S::Wide;
  using V = typename S::V;
  using Lane = typename S::Lane;
  using Law = ContactLaw::Values<V>;
  static constexpr int W = S::width, H = S::halves;

  struct Gathered {
    V away[3], square, excess, distance, inverse, velocity[3], spin[3], other_spin[3];
  };
  struct Scattered {
    typename D::I force[H][3], torque[H][3], other_force[H][3], other_torque[H][3];
    bool live;
  };
  struct Worst {
    V beyond = S::set(-1.0), force = S::set(0.0);
  };

  GRANRAD_INLINE Law broadcast(const LawCoefficients& c) {
    return Law::each([&](int n) { return S::set(c.at(n)); });
  }
  GRANRAD_INLINE const double* column(const ContactView& c, BodyColumn n, std::int64_t k) {
    return c.varied.columns + static_cast<int>(n) * c.varied.stride + k;
  }
  GRANRAD_INLINE Law varied_law(const ContactView& c, std::int64_t k) {
    const double* first = c.varied.columns + body_columns * c.varied.stride + k;
    return Law::each([&](int n) { return S::load(first + n * c.varied.stride); });
  }
  GRANRAD_INLINE double largest(V v) {
    Lane lane[W];
    double m = -1e300;
    S::store(lane, v);
    for (double x : lane) m = x > m ? x : m;
    return m;
  }
  GRANRAD_INLINE V largest_component(const V f[3]) {
    return S::max(S::max(S::abs(f[0]), S::abs(f[1])), S::abs(f[2]));
  }
  template <class P, bool periodic>
  GRANRAD_INLINE void nearest_image(const StepConstants& k, typename P::V d[3]) {
    if constexpr (periodic)
      for (int a = 0; a < 3; ++a) d[a] -= P::set(k.period[a]) * P::round(d[a] * P::set(k.inverse_period[a]));
  }
  /// scale(h): fixed-point units of the contacts of half h.
  template <class Scale>
  GRANRAD_INLINE void to_fixed3(const V v[3], Scale scale, typename D::I out[H][3]) {
    typename D::V wide[H];
    for (int a = 0; a < 3; ++a) {
      S::widen(v[a], wide);
      for (int h = 0; h < H; ++h) out[h][a] = S::to_fixed(wide[h] * scale(h));
    }
  }

  /// The vector from j to i, its square, and by how much the square of the radii's sum exceeds that.
  template <bool periodic, bool varied>
  GRANRAD_INLINE void gather_positions(const RowView& rows, const ContactView& c, const StepConstants& k,
                                       std::int64_t at, Gathered& in) {
    typename D::V away[3][H], square[H], excess[H];
    for (int h = 0; h < H; ++h) {
      const std::int64_t from = at + h * D::width;
      typename D::V d[4], sum = D::set(2 * k.radius);
      D::pair_positions([&](RowOffset i) { return S::position(rows, i); }, c.first + from, c.second + from,
                        d);
      nearest_image<D, periodic>(k, d);
      if constexpr (varied)
        sum = D::load(column(c, BodyColumn::first_radius, from)) +
              D::load(column(c, BodyColumn::second_radius, from));
      for (int a = 0; a < 3; ++a) away[a][h] = d[a];
      square[h] = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      excess[h] = sum * sum - square[h];
    }
    for (int a = 0; a < 3; ++a) in.away[a] = S::narrow(away[a]);
    in.square = S::narrow(square), in.excess = S::narrow(excess);
  }

  /// Adds the root of the area of the disc in which the spheres intersect, pi/4 (D^2 - d^2)(d^2 - (ri - rj)^2)/d^2
  /// with D = ri + rj.
  template <bool varied>
  GRANRAD_INLINE void record_touch(const ContactView& c, const StepConstants& constants, std::int64_t k, V ri,
                                   V rj, const Gathered& in) {
    V area = S::set(quarter_pi) * S::max(in.excess, S::set(0.0));
    if constexpr (varied) area = area * (in.square - (ri - rj) * (ri - rj)) / in.square;
    typename D::V wide[H];
    S::widen(S::sqrt(area), wide);
    for (int h = 0; h < H; ++h) {
      double* sum = c.touch_sum + k + h * D::width;
      D::store(sum, D::load(sum) + D::round(wide[h] * D::set(constants.touch_units)));
    }
  }

  template <bool varied, bool first_only>
  GRANRAD_INLINE void contact(const ContactView& c, const StepConstants& constants, const Law& uniform,
                              std::int64_t k, const Gathered& in, Scattered& out, Worst& worst) {
    const V half = S::set(0.5);
    const auto* springs = S::springs(c);
    if (!out.live) {
      for (int a = 0; a < 3; ++a) S::store(springs[a] + k, V{});
      return;
    }
    V ri, rj;
    if constexpr (varied)
      ri = S::load(column(c, BodyColumn::first_radius, k)),
      rj = S::load(column(c, BodyColumn::second_radius, k));
    else
      ri = rj = S::set(constants.radius);
    if (c.touch_sum) record_touch<varied>(c, constants, k, ri, rj, in);
    ContactState<S> state;
    state.overlap = S::overlap(ri + rj, in.distance, in.excess);
    const V arm_i = ri - half * state.overlap, arm_j = rj - half * state.overlap;
    for (int a = 0; a < 3; ++a) {
      state.normal[a] = in.away[a] * in.inverse;
      state.velocity[a] = in.velocity[a];
      state.arm_spin[a] = varied ? arm_i * in.spin[a] + arm_j * in.other_spin[a] : arm_i * in.spin[a];
      state.displacement[a] = S::load(springs[a] + k);
    }
    const Law law = varied ? varied_law(c, k) : uniform;
    const auto result = ContactLaw::force<S>(law, S::set(constants.step_s), state);
    const V smaller = varied ? S::select(S::less(ri, rj), ri, rj) : ri;
    worst.beyond = S::max(worst.beyond, state.overlap - S::set(deepest_overlap) * smaller);
    for (int a = 0; a < 3; ++a) S::store(springs[a] + k, state.displacement[a]);
    V ti[3], tj[3];
    for (int a = 0; a < 3; ++a) ti[a] = -arm_i * result.moment[a];
    if constexpr (!varied) {
      worst.force = S::max(worst.force, largest_component(result.force));
      to_fixed3(
          result.force, [&](int) { return D::set(constants.scales.force); }, out.force);
      to_fixed3(
          ti, [&](int) { return D::set(constants.scales.torque); }, out.torque);
    } else {
      const auto scale = [&](BodyColumn n) {
        return [&c, k, n](int h) { return D::load(column(c, n, k + h * D::width)); };
      };
      const V finer = S::max(S::load(column(c, BodyColumn::first_force_scale, k)),
                             S::load(column(c, BodyColumn::second_force_scale, k)));
      worst.force = S::max(worst.force, finer * largest_component(result.force));
      V w[3], roll[3];
      for (int a = 0; a < 3; ++a) w[a] = in.spin[a] - in.other_spin[a];
      ContactLaw::rolling_torque<S>(law, result.elastic, state.normal, w, roll);
      for (int a = 0; a < 3; ++a) tj[a] = -arm_j * result.moment[a] - roll[a], ti[a] += roll[a];
      to_fixed3(result.force, scale(BodyColumn::first_force_scale), out.force);
      to_fixed3(ti, scale(BodyColumn::first_torque_scale), out.torque);
      if constexpr (!first_only) {
        const V back[3] = {-result.force[0], -result.force[1], -result.force[2]};
        to_fixed3(back, scale(BodyColumn::second_force_scale), out.other_force);
        to_fixed3(tj, scale(BodyColumn::second_torque_scale), out.other_torque);
      }
    }
  }

  template <bool varied, bool first_only>
  GRANRAD_INLINE void scatter(const RowView& rows, const ContactView& c, std::int64_t at,
                              const Scattered& out) {
    for (int h = 0; h < H; ++h) {
      const RowOffset *i = c.first + at + h * D::width, *j = c.second + at + h * D::width;
      const auto* f = out.force[h];
      if constexpr (first_only || varied) D::add_one(rows.force, i, f, out.torque[h]);
      if constexpr (!first_only && varied) D::add_one(rows.force, j, out.other_force[h], out.other_torque[h]);
      if constexpr (!first_only && !varied) D::add_pair(rows.force, i, j, f, out.torque[h]);
    }
  }

  template <bool periodic, bool varied, bool first_only>
  GRANRAD_INLINE void gather(const RowView& rows, const ContactView& c, const StepConstants& constants,
                             std::int64_t at, Gathered& in, bool& live) {
    const auto* motion = S::motion(rows);
    const auto* springs = S::springs(c);
    const RowOffset *i = c.first + at, *j = c.second + at;
    for (int l = 0; l < W; ++l) {
      const RowOffset ahead = j[rows_ahead + l];
      S::prefetch_row(rows, ahead);
      if (!first_only) D::prefetch(row_of<8>(rows.force, ahead));
    }
    for (int a = 0; a < 3; ++a) D::prefetch(springs[a] + at + springs_ahead);
    gather_positions<periodic, varied>(rows, c, constants, at, in);
    live = S::any(S::less(V{}, in.excess));
    if (!live) return;
    in.distance = S::sqrt(in.square), in.inverse = S::set(1.0) / in.distance;
    if constexpr (varied)
      S::pair_velocities_apart(motion, i, j, in.velocity, in.spin, in.other_spin);
    else
      S::pair_velocities(motion, i, j, in.velocity, in.spin);
  }

  /// Rows are gathered `lead` packs before the law is worked on them, and the forces scattered as many behind: what
  /// waits for memory, for a root and for the sums before it belongs to different packs, so that all three go on at
  /// once.
  template <bool periodic, bool varied, bool first_only>
  static WorstContact loop(const RowView& rows, const ContactView& c, const StepConstants& constants) {
    Gathered in[2 * lead];
    Scattered out[2 * lead];
    const Law uniform = broadcast(constants.pair);
    Worst worst;
    const std::int64_t packs = c.count / W, first = packs < lead ? packs : lead;
    const auto slot = [](std::int64_t p) { return p & (2 * lead - 1); };
    const auto gather_pack = [&](std::int64_t p) __attribute__((always_inline)) {
      gather<periodic, varied, first_only>(rows, c, constants, p * W, in[slot(p)], out[slot(p)].live);
    };
    const auto scatter_pack = [&](std::int64_t p) __attribute__((always_inline)) {
      if (out[slot(p)].live) scatter<varied, first_only>(rows, c, p * W, out[slot(p)]);
    };
    for (std::int64_t p = 0; p < first; ++p) gather_pack(p);
    for (std::int64_t p = 0; p < packs; ++p) {
      if (p >= lead) scatter_pack(p - lead);
      if (p + lead < packs) gather_pack(p + lead);
      contact<varied, first_only>(c, constants, uniform, p * W, in[slot(p)], out[slot(p)], worst);
    }
    for (std::int64_t p = packs - first; p < packs; ++p) scatter_pack(p);
    const double units = varied ? 1 : constants.scales.force;
    return {largest(worst.beyond), units * largest(worst.force)};
  }

  template <bool first_only>
  static WorstContact contacts(const RowView& r, const ContactView& c, const StepConstants& k) {
    if (c.varied.columns)
      return k.periodic ? loop<true, true, first_only>(r, c, k) : loop<false, true, first_only>(r, c, k);
    return k.periodic ? loop<true, false, first_only>(r, c, k) : loop<false, false, first_only>(r, c, k);
  }
};

}  // namespace granrad::native
