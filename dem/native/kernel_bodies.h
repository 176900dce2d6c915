#pragma once
#include "dem/native/pair_bodies.h"

// The inner loops for a pack S beside those over pairs.
namespace granrad::native {

template <class S>
struct KernelBodies {
  using V = typename S::V;
  using I = typename S::I;
  static constexpr int W = S::width;
  using Pairs = PairBodies<S>;

  GRANRAD_INLINE void to_fixed3(const V v[3], V scale, I out[3]) {
    for (int a = 0; a < 3; ++a) out[a] = S::to_fixed(v[a] * scale);
  }

  struct AtPlane {
    V height, radius, overlap, normal[3], velocity[3], spin[3];
    bool live;
  };
  template <bool varied>
  GRANRAD_INLINE void gather_plane(const RowView& rows, const ContactView& c, const PlaneView& planes,
                                   const StepConstants& constants, std::int64_t k, AtPlane& in) {
    V p[4], v[8], plane[8], slide[4];
    S::columns4(rows.position, c.first + k, p);
    S::columns8(planes.geometry, c.second + k, plane);
    in.height = (p[0] - plane[0]) * plane[4] + (p[1] - plane[1]) * plane[5] + (p[2] - plane[2]) * plane[6];
    in.radius = varied ? S::load(Pairs::column(c, BodyColumn::first_radius, k)) : S::set(constants.radius);
    in.overlap = in.radius - S::abs(in.height);
    in.live = S::any(S::less(V{}, in.overlap));
    if (!in.live) return;
    S::columns8(rows.velocity, c.first + k, v);
    S::columns4(planes.velocity, c.second + k, slide);
    const auto behind = S::less(in.height, V{});
    for (int a = 0; a < 3; ++a) {
      in.normal[a] = S::negate_where(behind, plane[4 + a]);
      in.velocity[a] = v[a] - slide[a], in.spin[a] = v[4 + a];
    }
  }

  template <bool varied>
  GRANRAD_INLINE void plane_contact(const RowView& rows, const ContactView& c, const StepConstants& constants,
                                    const typename Pairs::Law& uniform, std::int64_t k, const AtPlane& in,
                                    typename Pairs::Worst& worst) {
    if (!in.live) {
      for (auto* s : c.displacement) S::store(s + k, V{});
      return;
    }
    ContactState<S> state;
    state.overlap = in.overlap;
    const V r = in.radius, arm = r - S::set(0.5) * state.overlap;
    for (int a = 0; a < 3; ++a) {
      state.normal[a] = in.normal[a], state.velocity[a] = in.velocity[a];
      state.arm_spin[a] = arm * in.spin[a];
      state.displacement[a] = S::load(c.displacement[a] + k);
    }
    if (c.touch_sum) {
      const V area = S::set(4 * quarter_pi) * S::max(r * r - in.height * in.height, S::set(0.0));
      double* sum = c.touch_sum + k;
      S::store(sum, S::load(sum) + S::round(S::sqrt(area) * S::set(constants.touch_units)));
    }
    const typename Pairs::Law law = varied ? Pairs::varied_law(c, k) : uniform;
    const auto result = ContactLaw::force<S>(law, S::set(constants.step_s), state);
    worst.beyond = S::max(worst.beyond, state.overlap - S::set(deepest_overlap) * r);
    V torque[3];
    for (int a = 0; a < 3; ++a) {
      S::store(c.displacement[a] + k, state.displacement[a]);
      torque[a] = -arm * result.moment[a];
    }
    if constexpr (varied) {
      V roll[3];
      ContactLaw::rolling_torque<S>(law, result.elastic, state.normal, in.spin, roll);
      for (int a = 0; a < 3; ++a) torque[a] += roll[a];
    }
    const auto scale = [&](BodyColumn n, double uniform_scale) {
      return varied ? S::load(Pairs::column(c, n, k)) : S::set(uniform_scale);
    };
    const V force_scale = scale(BodyColumn::first_force_scale, constants.scales.force);
    worst.force = S::max(worst.force, force_scale * Pairs::largest_component(result.force));
    I f[3], t[3];
    to_fixed3(result.force, force_scale, f);
    to_fixed3(torque, scale(BodyColumn::first_torque_scale, constants.scales.torque), t);
    S::add_one(rows.force, c.first + k, f, t);
  }

  /// The next pack is gathered before the law of one is worked: see PairBodies::loop.
  template <bool varied>
  static WorstContact plane_loop(const RowView& rows, const ContactView& c, const PlaneView& planes,
                                 const StepConstants& constants) {
    const typename Pairs::Law uniform = Pairs::broadcast(constants.wall);
    typename Pairs::Worst worst;
    AtPlane in[2];
    if (c.count > 0) gather_plane<varied>(rows, c, planes, constants, 0, in[0]);
    for (std::int64_t p = 0; p < c.count / W; ++p) {
      if ((p + 1) * W < c.count)
        gather_plane<varied>(rows, c, planes, constants, (p + 1) * W, in[(p + 1) & 1]);
      plane_contact<varied>(rows, c, constants, uniform, p * W, in[p & 1], worst);
    }
    return {Pairs::largest(worst.beyond), Pairs::largest(worst.force)};
  }

  static WorstContact plane_contacts(const RowView& r, const ContactView& c, const PlaneView& p,
                                     const StepConstants& k) {
    return c.varied.columns ? plane_loop<true>(r, c, p, k) : plane_loop<false>(r, c, p, k);
  }

  static bool move(const RowView& rows, const std::int32_t* list, std::int64_t count, const MoveConstants& m,
                   bool last) {
    const auto gravity = S::row_load(m.gravity_kick);
    bool too_fast = false;
    for (std::int64_t k = 0; k < count; ++k) {
      const std::int64_t i = list[k];
      const auto push =
          S::row_multiply(S::row_take(rows.force + 8 * i), S::row_load(m.kick + m.kick_stride * i));
      const auto v = S::row_add(S::row_add(S::row_load(rows.velocity + 8 * i), push), gravity);
      S::row_store(rows.velocity + 8 * i, v);
      too_fast |= S::row_too_fast(v, m.reference + 4 * i);
      double* position = rows.position + 4 * i;
      S::place_store(position, S::place_drifted(S::place_load(position), v, m.half_step_s, !last));
      if (rows.mixed) {
        S::row_narrow(rows.mixed[i].velocity, v);
        S::copy_position(position, rows.mixed[i].position);
      }
    }
    return too_fast;
  }

  /// `rows_at_once` rows, whose sums do not wait for each other. A velocity is added to zero once, as `move` adds
  /// a force of zero: no zero is negative from there on.
  template <int rows_at_once, bool falls>
  GRANRAD_INLINE void fly_together(const RowView& rows, const std::int32_t* list, const MoveConstants& m,
                                   std::int64_t steps, bool last) {
    alignas(64) constexpr double none[8] = {};
    const auto gravity = S::row_load(m.gravity_kick), zero = S::row_load(none);
    typename S::Row v[rows_at_once];
    typename S::Place p[rows_at_once];
    for (int r = 0; r < rows_at_once; ++r) {
      v[r] = S::row_add(S::row_load(rows.velocity + 8 * std::int64_t(list[r])), zero);
      p[r] = S::place_load(rows.position + 4 * std::int64_t(list[r]));
    }
    const auto step = [&](bool twice) {
      for (int r = 0; r < rows_at_once; ++r) {
        if (falls) v[r] = S::row_add(v[r], gravity);
        p[r] = S::place_drifted(p[r], v[r], m.half_step_s, twice);
      }
    };
    for (std::int64_t k = 1; k < steps; ++k) step(true);
    step(!last);
    for (int r = 0; r < rows_at_once; ++r) {
      S::row_store(rows.velocity + 8 * std::int64_t(list[r]), v[r]);
      S::place_store(rows.position + 4 * std::int64_t(list[r]), p[r]);
    }
  }
  template <bool falls>
  static void fly_loop(const RowView& rows, const std::int32_t* list, std::int64_t count,
                       const MoveConstants& m, std::int64_t steps, bool last) {
    constexpr int together = 8;
    std::int64_t k = 0;
    for (; k + together <= count; k += together)
      fly_together<together, falls>(rows, list + k, m, steps, last);
    for (; k < count; ++k) fly_together<1, falls>(rows, list + k, m, steps, last);
  }
  static void fly(const RowView& rows, const std::int32_t* list, std::int64_t count, const MoveConstants& m,
                  std::int64_t steps, bool last) {
    bool falls = false;
    for (double g : m.gravity_kick) falls |= g != 0;
    falls ? fly_loop<true>(rows, list, count, m, steps, last)
          : fly_loop<false>(rows, list, count, m, steps, last);
  }

  template <bool periodic>
  static std::int64_t select_loop(const RowView& rows, const StepConstants& constants, const std::int32_t* i,
                                  const std::int32_t* j, std::int64_t count, std::int32_t* first,
                                  std::int32_t* second, std::int32_t* source) {
    std::int64_t found = 0;
    for (std::int64_t k = 0; k < count; k += W) {
      V d[4];
      S::pair_positions([&](std::int64_t row) { return rows.position + 4 * row; }, i + k, j + k, d);
      Pairs::template nearest_image<S, periodic>(constants, d);
      V u[3], spin[3];
      S::pair_velocities(rows.velocity, i + k, j + k, u, spin);
      const V approach = S::set(constants.life_s) * S::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
      const V reach = d[3] + approach;
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
  static std::int64_t find_near(const double* place, double gap_m, const std::int32_t* i,
                                const std::int32_t* j, std::int64_t count, std::int32_t* number,
                                double* distance_m) {
    std::int64_t found = 0;
    for (std::int64_t k = 0; k < count; k += W) {
      V d[4];
      S::pair_positions([&](std::int64_t row) { return place + 4 * row; }, i + k, j + k, d);
      const V square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], reach = d[3] + S::set(gap_m);
      unsigned apart = S::bits(S::less(reach * reach, square)) | S::bits(S::less(reach, S::set(0.0)));
      alignas(64) double distance[W];
      S::store(distance, S::sqrt(square));
      for (int l = 0; l < W; ++l, apart >>= 1) {
        number[found] = std::int32_t(k + l), distance_m[found] = distance[l];
        found += k + l < count && !(apart & 1);
      }
    }
    return found;
  }
  static std::int64_t find_close(const float* x, const float* y, const float* z, const float* reach,
                                 const float p[4], const float period[3], const float inverse_period[3],
                                 std::int32_t first, std::int32_t count, std::int32_t* out) {
    return S::find_close(x, y, z, reach, p, period, inverse_period, first, count, out);
  }

  static constexpr Kernels table(const char* name, PairKernel mixed, PairKernel mixed_first) {
    return {name,
            Pairs::template contacts<false>,
            Pairs::template contacts<true>,
            mixed,
            mixed_first,
            plane_contacts,
            move,
            fly,
            select_close,
            find_near,
            find_close};
  }
};

}  // namespace granrad::native
