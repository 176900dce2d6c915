#pragma once
#include "dem/native/kernels.h"

// The inner loops for a pack S. Nothing from the standard library is used here: an inline function compiled
// for AVX-512 must never be the copy the linker keeps for everyone.
namespace granrad::native {

inline constexpr std::int64_t chunk =
    32;  ///< contacts between gathering and scattering; their data stays in L1

template <class S>
struct KernelBodies {
  using V = typename S::V;
  using I = typename S::I;
  static constexpr int W = S::width;
  static constexpr std::int64_t packs = chunk / W;

  struct Gathered {
    V away[3], velocity[3], spin[3], other_spin[3];
  };
  struct Scattered {
    I force[3], torque[3], other_torque[3];
    bool live;
  };

  GRANRAD_INLINE HertzMindlin<V> broadcast(const HertzMindlin<double>& c) {
    return {S::set(c.effective_radius),   S::set(c.normal),   S::set(c.tangential), S::set(c.normal_damping),
            S::set(c.tangential_damping), S::set(c.friction), S::set(c.rolling)};
  }
  GRANRAD_INLINE HertzMindlin<V> varied_law(const ContactView& c, std::int64_t k) {
    const auto column = [&](int n) { return S::load(c.varied + n * c.stride + k); };
    return {column(effective_radius),   column(normal),   column(tangential), column(normal_damping),
            column(tangential_damping), column(friction), column(rolling)};
  }
  GRANRAD_INLINE double largest(V v) {
    double lane[W], m = -1e300;
    S::store(lane, v);
    for (double x : lane) m = x > m ? x : m;
    return m;
  }
  template <bool periodic>
  GRANRAD_INLINE void nearest_image(const StepConstants& k, V d[3]) {
    if constexpr (periodic)
      for (int a = 0; a < 3; ++a) d[a] -= S::set(k.period[a]) * S::round(d[a] * S::set(k.inverse_period[a]));
  }
  GRANRAD_INLINE void to_fixed3(const V v[3], V scale, I out[3]) {
    for (int a = 0; a < 3; ++a) out[a] = S::to_fixed(v[a] * scale);
  }

  /// One pack of contacts between particles.
  template <bool varied>
  GRANRAD_INLINE void contact(const ContactView& c, const StepConstants& constants,
                              const HertzMindlin<V>& uniform, std::int64_t k, const Gathered& in,
                              Scattered& out, V& deepest) {
    const V *d = in.away, half = S::set(0.5);
    const V square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    V ri, rj;
    if constexpr (varied)
      ri = S::load(c.varied + radius_first * c.stride + k),
      rj = S::load(c.varied + radius_second * c.stride + k);
    else
      ri = rj = S::set(constants.radius);
    const V sum = ri + rj;
    out.live = S::any(S::less(square, sum * sum));
    if (!out.live) {
      for (auto* s : c.displacement) S::store(s + k, V{});
      return;
    }
    const V distance = S::sqrt(square), inverse = S::set(1.0) / distance;
    ContactState<S> state;
    state.overlap = sum - distance;
    const V arm_i = ri - half * state.overlap, arm_j = rj - half * state.overlap;
    for (int a = 0; a < 3; ++a) {
      state.normal[a] = d[a] * inverse;
      state.velocity[a] = in.velocity[a];
      state.arm_spin[a] = varied ? arm_i * in.spin[a] + arm_j * in.other_spin[a] : arm_i * in.spin[a];
      state.displacement[a] = S::load(c.displacement[a] + k);
    }
    const HertzMindlin<V> law = varied ? varied_law(c, k) : uniform;
    const auto result = contact_force<S>(law, S::set(constants.step_s), state);
    const V smaller = varied ? S::select(S::less(ri, rj), ri, rj) : ri;
    deepest = S::max(deepest, state.overlap - S::set(deepest_overlap) * smaller);
    for (int a = 0; a < 3; ++a) S::store(c.displacement[a] + k, state.displacement[a]);
    to_fixed3(result.force, S::set(constants.force_scale), out.force);
    V ti[3], tj[3];
    for (int a = 0; a < 3; ++a) ti[a] = -arm_i * result.moment[a];
    if constexpr (varied) {
      V w[3], roll[3];
      for (int a = 0; a < 3; ++a) w[a] = in.spin[a] - in.other_spin[a];
      rolling_torque<S>(law, result.elastic, state.normal, w, roll);
      for (int a = 0; a < 3; ++a) tj[a] = -arm_j * result.moment[a] - roll[a], ti[a] += roll[a];
      to_fixed3(tj, S::set(constants.torque_scale), out.other_torque);
    }
    to_fixed3(ti, S::set(constants.torque_scale), out.torque);
  }

  /// In chunks of 32 contacts: gather the rows, work the law, scatter the forces. Three short loops keep the
  /// loads, the arithmetic and the read-modify-writes of different packs from waiting for each other.
  template <bool periodic, bool varied, bool first_only>
  static double pair_loop(const RowView& rows, const ContactView& c, const StepConstants& constants) {
    Gathered in[packs];
    Scattered out[packs];
    const HertzMindlin<V> uniform = broadcast(constants.pair);
    V deepest = S::set(-1.0);
    for (std::int64_t begin = 0; begin < c.count; begin += chunk) {
      const std::int64_t left = (c.count - begin) / W, n = left < packs ? left : packs;
      for (std::int64_t q = 0; q < n; ++q) {
        const std::int32_t *i = c.first + begin + q * W, *j = c.second + begin + q * W;
        for (int l = 0; l < W; ++l) {
          const std::int64_t ahead = j[chunk + l];
          S::prefetch(rows.position + 4 * ahead);
          S::prefetch(rows.velocity + 8 * ahead);
          if (!first_only) S::prefetch(rows.force + 8 * ahead);
        }
        V d[4];
        S::pair_positions(rows.position, i, j, d);
        for (int a = 0; a < 3; ++a) in[q].away[a] = d[a];
        nearest_image<periodic>(constants, in[q].away);
        if constexpr (varied)
          S::pair_velocities_apart(rows.velocity, i, j, in[q].velocity, in[q].spin, in[q].other_spin);
        else
          S::pair_velocities(rows.velocity, i, j, in[q].velocity, in[q].spin);
      }
      for (std::int64_t q = 0; q < n; ++q)
        contact<varied>(c, constants, uniform, begin + q * W, in[q], out[q], deepest);
      for (std::int64_t q = 0; q < n; ++q) {
        if (!out[q].live) continue;
        const std::int32_t *i = c.first + begin + q * W, *j = c.second + begin + q * W;
        if constexpr (first_only || varied) S::add_one(rows.force, i, out[q].force, out[q].torque);
        if constexpr (!first_only && varied) {
          const I opposite[3] = {-out[q].force[0], -out[q].force[1], -out[q].force[2]};
          S::add_one(rows.force, j, opposite, out[q].other_torque);
        }
        if constexpr (!first_only && !varied) S::add_pair(rows.force, i, j, out[q].force, out[q].torque);
      }
    }
    return largest(deepest);
  }

  template <bool first_only>
  static double pair_contacts(const RowView& r, const ContactView& c, const StepConstants& k) {
    if (c.varied)
      return k.periodic ? pair_loop<true, true, first_only>(r, c, k)
                        : pair_loop<false, true, first_only>(r, c, k);
    return k.periodic ? pair_loop<true, false, first_only>(r, c, k)
                      : pair_loop<false, false, first_only>(r, c, k);
  }

  template <bool varied>
  static double plane_loop(const RowView& rows, const ContactView& c, const PlaneView& planes,
                           const StepConstants& constants) {
    const HertzMindlin<V> uniform = broadcast(constants.wall);
    V deepest = S::set(-1.0);
    for (std::int64_t k = 0; k < c.count; k += W) {
      V p[4], v[8], plane[8], slide[4];
      S::columns4(rows.position, c.first + k, p);
      S::columns8(planes.geometry, c.second + k, plane);
      V h = (p[0] - plane[0]) * plane[4] + (p[1] - plane[1]) * plane[5] + (p[2] - plane[2]) * plane[6];
      const auto behind = S::less(h, V{});
      ContactState<S> state;
      const V r = varied ? S::load(c.varied + radius_first * c.stride + k) : S::set(constants.radius);
      state.overlap = r - S::abs(h);
      if (!S::any(S::less(V{}, state.overlap))) {
        for (auto* s : c.displacement) S::store(s + k, V{});
        continue;
      }
      S::columns8(rows.velocity, c.first + k, v);
      S::columns4(planes.velocity, c.second + k, slide);
      const V arm = r - S::set(0.5) * state.overlap;
      for (int a = 0; a < 3; ++a) {
        state.normal[a] = S::negate_where(behind, plane[4 + a]);
        state.velocity[a] = v[a] - slide[a];
        state.arm_spin[a] = arm * v[4 + a];
        state.displacement[a] = S::load(c.displacement[a] + k);
      }
      const HertzMindlin<V> law = varied ? varied_law(c, k) : uniform;
      const auto result = contact_force<S>(law, S::set(constants.step_s), state);
      deepest = S::max(deepest, state.overlap - S::set(deepest_overlap) * r);
      V torque[3];
      for (int a = 0; a < 3; ++a) {
        S::store(c.displacement[a] + k, state.displacement[a]);
        torque[a] = -arm * result.moment[a];
      }
      if constexpr (varied) {
        V roll[3];
        rolling_torque<S>(law, result.elastic, state.normal, v + 4, roll);
        for (int a = 0; a < 3; ++a) torque[a] += roll[a];
      }
      I f[3], t[3];
      to_fixed3(result.force, S::set(constants.force_scale), f);
      to_fixed3(torque, S::set(constants.torque_scale), t);
      S::add_one(rows.force, c.first + k, f, t);
    }
    return largest(deepest);
  }

  static double plane_contacts(const RowView& r, const ContactView& c, const PlaneView& p,
                               const StepConstants& k) {
    return c.varied ? plane_loop<true>(r, c, p, k) : plane_loop<false>(r, c, p, k);
  }

  static bool move(const RowView& rows, std::int64_t begin, std::int64_t end, const MoveConstants& m,
                   bool last) {
    const auto gravity = S::row_load(m.gravity_kick);
    bool too_fast = false;
    for (std::int64_t i = begin; i < end; ++i) {
      const auto push =
          S::row_multiply(S::row_take(rows.force + 8 * i), S::row_load(m.kick + m.kick_stride * i));
      const auto v = S::row_add(S::row_add(S::row_load(rows.velocity + 8 * i), push), gravity);
      S::row_store(rows.velocity + 8 * i, v);
      too_fast |= S::row_too_fast(v, m.reference + 4 * i);
      S::row_drift(rows.position + 4 * i, v, m.half_step_s, !last);
    }
    return too_fast;
  }

  template <bool periodic>
  static std::int64_t select_loop(const RowView& rows, const StepConstants& constants, const std::int32_t* i,
                                  const std::int32_t* j, std::int64_t count, std::int32_t* first,
                                  std::int32_t* second, std::int32_t* source) {
    std::int64_t found = 0;
    for (std::int64_t k = 0; k < count; k += W) {
      V d[4];
      S::pair_positions(rows.position, i + k, j + k, d);
      nearest_image<periodic>(constants, d);
      V u[3], spin[3];
      S::pair_velocities(rows.velocity, i + k, j + k, u, spin);
      const V way = S::set(constants.life_s) * S::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
      const V reach = d[3] + way;
      unsigned close = S::bits(S::less(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], reach * reach));
      for (int l = 0; l < W; ++l, close >>= 1) {
        first[found] = i[k + l], second[found] = j[k + l], source[found] = std::int32_t(k + l);
        found += close & 1;
      }
    }
    return found;
  }
  static std::int64_t select_close(const RowView& rows, const StepConstants& c, const std::int32_t* i,
                                   const std::int32_t* j, std::int64_t count, std::int32_t* first,
                                   std::int32_t* second, std::int32_t* source) {
    return c.periodic ? select_loop<true>(rows, c, i, j, count, first, second, source)
                      : select_loop<false>(rows, c, i, j, count, first, second, source);
  }
  static std::int64_t find_close(const float* x, const float* y, const float* z, const float* reach,
                                 const float p[4], const float period[3], const float inverse_period[3],
                                 std::int32_t first, std::int32_t count, std::int32_t* out) {
    return S::find_close(x, y, z, reach, p, period, inverse_period, first, count, out);
  }

  static constexpr Kernels table(const char* name) {
    return {name, pair_contacts<false>, pair_contacts<true>, plane_contacts, move, select_close, find_close};
  }
};

}  // namespace granrad::native
