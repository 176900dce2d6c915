// Compiled once for each instruction set, with GRANRAD_LINE_ISA as its name. Nothing but this file's own code
// and intrinsics may be included: an inline function of a library, compiled here for AVX-512, could be picked
// by the linker for everyone.
#include "raytrace/line_pass/line_kernel.h"

#if defined(__AVX512F__) || defined(__AVX2__)
#include <immintrin.h>
#endif

namespace granrad::GRANRAD_LINE_ISA {
namespace {

using Mask = std::uint32_t;

#if defined(__AVX512F__)

struct Tile {
  __m512i cells;

  static Mask disc(float du, float dv, float reach2) {
    const __m512 column = _mm512_setr_ps(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3);
    const __m512 row = _mm512_setr_ps(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
    const __m512 u = _mm512_add_ps(column, _mm512_set1_ps(du)), v = _mm512_add_ps(row, _mm512_set1_ps(dv));
    const __m512 d2 = _mm512_add_ps(_mm512_mul_ps(u, u), _mm512_mul_ps(v, v));
    return _mm512_cmp_ps_mask(d2, _mm512_set1_ps(reach2), _CMP_LT_OQ);
  }
  static __m128i row(const std::int32_t* p) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); }
  static Tile load(const std::int32_t* p, std::int32_t pitch) {
    __m512i t = _mm512_castsi128_si512(row(p));
    t = _mm512_inserti32x4(t, row(p + pitch), 1);
    t = _mm512_inserti32x4(t, row(p + 2 * pitch), 2);
    return {_mm512_inserti32x4(t, row(p + 3 * pitch), 3)};
  }
  Mask differs_from(std::int32_t value) const {
    return _mm512_cmpneq_epi32_mask(cells, _mm512_set1_epi32(value));
  }
  void store(std::int32_t* p, std::int32_t pitch, Mask mask, std::int32_t value) const {
    const __m512i t = _mm512_mask_mov_epi32(cells, static_cast<__mmask16>(mask), _mm512_set1_epi32(value));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm512_castsi512_si128(t));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p + pitch), _mm512_extracti32x4_epi32(t, 1));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p + 2 * pitch), _mm512_extracti32x4_epi32(t, 2));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p + 3 * pitch), _mm512_extracti32x4_epi32(t, 3));
  }
  /// Compresses in a register: the form that writes to memory is microcoded on some processors.
  void pack(Mask mask, std::int32_t* out) const {
    _mm512_storeu_si512(out, _mm512_maskz_compress_epi32(static_cast<__mmask16>(mask), cells));
  }
  void spill(std::int32_t* out) const { _mm512_storeu_si512(out, cells); }
  std::int32_t sum(Mask mask) const {
    return _mm512_mask_reduce_add_epi32(static_cast<__mmask16>(mask), cells);
  }
};

#elif defined(__AVX2__)

/// Positions of the bits set in a byte.
struct SetLanes {
  std::uint8_t first_to_last[256][8] = {};
  constexpr SetLanes() {
    for (int mask = 0; mask < 256; ++mask)
      for (int bit = 0, n = 0; bit < 8; ++bit)
        if (mask >> bit & 1) first_to_last[mask][n++] = static_cast<std::uint8_t>(bit);
  }
};
constexpr SetLanes set_lanes;

struct Tile {
  __m256i low, high;  // rows 0, 1 and rows 2, 3

  static Mask disc(float du, float dv, float reach2) {
    const __m256 column = _mm256_setr_ps(0, 1, 2, 3, 0, 1, 2, 3),
                 row = _mm256_setr_ps(0, 0, 0, 0, 1, 1, 1, 1);
    const __m256 u = _mm256_add_ps(column, _mm256_set1_ps(du)), u2 = _mm256_mul_ps(u, u);
    const __m256 base = _mm256_set1_ps(dv), r2 = _mm256_set1_ps(reach2);
    const __m256 v = _mm256_add_ps(row, base), w = _mm256_add_ps(_mm256_add_ps(row, _mm256_set1_ps(2)), base);
    const auto bits = [&](__m256 y) {
      return _mm256_movemask_ps(_mm256_cmp_ps(_mm256_add_ps(u2, _mm256_mul_ps(y, y)), r2, _CMP_LT_OQ));
    };
    return static_cast<Mask>(bits(v) | bits(w) << 8);
  }
  static __m128i row(const std::int32_t* p) { return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p)); }
  static Tile load(const std::int32_t* p, std::int32_t pitch) {
    return {_mm256_inserti128_si256(_mm256_castsi128_si256(row(p)), row(p + pitch), 1),
            _mm256_inserti128_si256(_mm256_castsi128_si256(row(p + 2 * pitch)), row(p + 3 * pitch), 1)};
  }
  static __m256i lanes(Mask mask, int shift) {
    const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
    const __m256i all = _mm256_set1_epi32(static_cast<int>(mask >> shift));
    return _mm256_cmpeq_epi32(_mm256_and_si256(all, bit), bit);
  }
  static int signs(__m256i lanes) { return _mm256_movemask_ps(_mm256_castsi256_ps(lanes)); }
  Mask differs_from(std::int32_t value) const {
    const __m256i v = _mm256_set1_epi32(value);
    return ~static_cast<Mask>(signs(_mm256_cmpeq_epi32(low, v)) | signs(_mm256_cmpeq_epi32(high, v)) << 8);
  }
  void store(std::int32_t* p, std::int32_t pitch, Mask mask, std::int32_t value) const {
    const __m256i v = _mm256_set1_epi32(value);
    const __m256i a = _mm256_blendv_epi8(low, v, lanes(mask, 0)),
                  b = _mm256_blendv_epi8(high, v, lanes(mask, 8));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p), _mm256_castsi256_si128(a));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p + pitch), _mm256_extracti128_si256(a, 1));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p + 2 * pitch), _mm256_castsi256_si128(b));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(p + 3 * pitch), _mm256_extracti128_si256(b, 1));
  }
  static void pack(__m256i half, Mask mask, std::int32_t* out) {
    const __m128i order = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(set_lanes.first_to_last[mask]));
    const __m256i packed = _mm256_permutevar8x32_epi32(half, _mm256_cvtepu8_epi32(order));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), packed);
  }
  void pack(Mask mask, std::int32_t* out) const {
    pack(low, mask & 0xff, out);
    pack(high, mask >> 8, out + __builtin_popcount(mask & 0xff));
  }
  void spill(std::int32_t* out) const {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out), low);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + 8), high);
  }
  std::int32_t sum(Mask mask) const {
    const __m256i s =
        _mm256_add_epi32(_mm256_and_si256(low, lanes(mask, 0)), _mm256_and_si256(high, lanes(mask, 8)));
    __m128i t = _mm_add_epi32(_mm256_castsi256_si128(s), _mm256_extracti128_si256(s, 1));
    t = _mm_add_epi32(t, _mm_shuffle_epi32(t, 0x4e));
    return _mm_cvtsi128_si32(_mm_add_epi32(t, _mm_shuffle_epi32(t, 0xb1)));
  }
};

#else

struct Tile {
  std::int32_t cells[16];

  static Mask disc(float du, float dv, float reach2) {
    Mask mask = 0;
    for (int k = 0; k < 16; ++k) {
      const int column = k % 4, row = k / 4;
      const float u = static_cast<float>(column) + du, v = static_cast<float>(row) + dv;
      mask |= static_cast<Mask>(u * u + v * v < reach2) << k;
    }
    return mask;
  }
  static Tile load(const std::int32_t* p, std::int32_t pitch) {
    Tile tile;
    for (int k = 0; k < 16; ++k) tile.cells[k] = p[k / 4 * pitch + k % 4];
    return tile;
  }
  Mask differs_from(std::int32_t value) const {
    Mask mask = 0;
    for (int k = 0; k < 16; ++k) mask |= static_cast<Mask>(cells[k] != value) << k;
    return mask;
  }
  void store(std::int32_t* p, std::int32_t pitch, Mask mask, std::int32_t value) const {
    for (; mask; mask &= mask - 1) {
      const int k = __builtin_ctz(mask);
      p[k / 4 * pitch + k % 4] = value;
    }
  }
  void pack(Mask mask, std::int32_t* out) const {
    for (; mask; mask &= mask - 1) *out++ = cells[__builtin_ctz(mask)];
  }
  void spill(std::int32_t* out) const {
    for (int k = 0; k < 16; ++k) out[k] = cells[k];
  }
  std::int32_t sum(Mask mask) const {
    std::int32_t total = 0;
    for (int k = 0; k < 16; ++k) total += cells[k] & -static_cast<std::int32_t>(mask >> k & 1);
    return total;
  }
};

#endif

/// Smallest integer >= t, for 0 <= t < 2^31; vectorises without SSE4.1.
inline std::int32_t ceiling(double t) {
  const auto whole = static_cast<std::int32_t>(t);
  return whole + (static_cast<double>(whole) < t);
}

void project(const LineSpheres& spheres, std::int32_t begin, std::int32_t end, const LineProjection& to,
             LineRecord* __restrict record) {
  const double *x = spheres.x, *y = spheres.y, *z = spheres.z;
  const float* reach = spheres.reach;
  for (std::int32_t i = begin; i < end; ++i, ++record) {
    const double u = x[i] * to.u[0] + y[i] * to.u[1] + z[i] * to.u[2] + to.u[3];
    const double v = x[i] * to.v[0] + y[i] * to.v[1] + z[i] * to.v[2] + to.v[3];
    const double depth = x[i] * to.key[0] + y[i] * to.key[1] + z[i] * to.key[2] + to.key[3];
    const std::int32_t column = ceiling(u - reach[i]), row = ceiling(v - reach[i]);
    *record = {static_cast<float>(column - u), static_cast<float>(row - v), row * to.pitch + column, i,
               static_cast<std::uint32_t>(static_cast<std::int32_t>(depth))};
  }
}

/// Calls visit(mask, cell) for every tile of a disc that has a cell inside it.
template <class Visit>
inline void for_tiles(const LineRecord& disc, float reach, std::int32_t pitch, Visit&& visit) {
  const float reach2 = reach * reach;
  if (2 * reach <= line_tile) {
    visit(Tile::disc(disc.du, disc.dv, reach2), disc.cell);
    return;
  }
  const int width = static_cast<int>(2 * reach) + 1;
  for (int b = 0; b < width; b += line_tile)
    for (int a = 0; a < width; a += line_tile) {
      const Mask mask = Tile::disc(disc.du + static_cast<float>(a), disc.dv + static_cast<float>(b), reach2);
      if (mask) visit(mask, disc.cell + b * pitch + a);
    }
}

constexpr int look_ahead = 12;

inline void prefetch_tile(const std::int32_t* p, std::int32_t pitch) {
  for (int row = 0; row < line_tile; ++row) __builtin_prefetch(p + row * pitch, 1);
}

/// Draws discs until `out` is nearly full; write(disc, tile, cell, mask, p) appends what a tile held and
/// returns the new end.
template <class Write>
inline std::int32_t draw(const LineRecord* record, std::int32_t begin, std::int32_t end,
                         const LineSpheres& spheres, std::int32_t* lattice, std::int32_t pitch,
                         std::int32_t* out, std::int64_t length, std::int64_t* out_end, Write&& write) {
  std::int32_t* p = out;
  std::int32_t t = begin;
  for (; t < end && p <= out + length; ++t) {
    const LineRecord disc = record[t];
    const std::int32_t surface = spheres.surface[disc.sphere];
    if (t + look_ahead < end) prefetch_tile(lattice + record[t + look_ahead].cell, pitch);
    for_tiles(disc, spheres.reach[disc.sphere], pitch, [&](Mask mask, std::int32_t cell) {
      const Tile tile = Tile::load(lattice + cell, pitch);
      mask &= tile.differs_from(outside_id);
      tile.store(lattice + cell, pitch, mask, surface);
      p = write(surface, tile, cell, mask, p);
    });
  }
  *out_end = p - out;
  return t;
}

std::int32_t emit(const LineRecord* record, std::int32_t begin, std::int32_t end, const LineSpheres& spheres,
                  std::int32_t* lattice, std::int32_t pitch, std::int32_t* out, std::int64_t capacity,
                  std::int64_t reserve, std::int64_t* out_end) {
  const auto write = [](std::int32_t surface, const Tile& tile, std::int32_t cell, Mask mask,
                        std::int32_t* p) {
    const int n = __builtin_popcount(mask);
    p[0] = surface;
    p[1] = cell;
    p[2] = static_cast<std::int32_t>(mask) | n << 16;
    tile.pack(mask, p + 3);
    return p + 3 + n;
  };
  return draw(record, begin, end, spheres, lattice, pitch, out, capacity - reserve, out_end, write);
}

std::int32_t emit_runs(const LineRecord* record, std::int32_t begin, std::int32_t end,
                       const LineSpheres& spheres, std::int32_t* lattice, std::int32_t pitch,
                       std::int32_t* out, std::int64_t capacity, std::int64_t reserve,
                       std::int64_t* out_end) {
  const auto write = [](std::int32_t surface, const Tile& tile, std::int32_t, Mask mask, std::int32_t* p) {
    std::int32_t all[16];
    tile.spill(all);
    std::int32_t* run = p + 2;
    while (mask) {
      const std::int32_t met = all[__builtin_ctz(mask)];
      const Mask others = mask & tile.differs_from(met);
      *run++ = static_cast<std::int32_t>(static_cast<std::uint32_t>(met) << line_run_bits) |
               (__builtin_popcount(mask ^ others) - 1);
      mask = others;
    }
    p[0] = surface;
    p[1] = static_cast<std::int32_t>(run - p) - 2;
    return run;
  };
  return draw(record, begin, end, spheres, lattice, pitch, out, capacity - reserve, out_end, write);
}

void receive(const LineRecord* first, std::int32_t count, std::int32_t step, const LineSpheres& spheres,
             const std::int32_t* power, std::int32_t* lattice, std::int32_t pitch, std::int64_t* received) {
  for (std::int32_t t = 0; t < count; ++t, first += step) {
    const LineRecord disc = *first;
    if (t + look_ahead < count) {
      const LineRecord& ahead = first[look_ahead * step];
      prefetch_tile(lattice + ahead.cell, pitch);
      __builtin_prefetch(power + ahead.sphere);
      __builtin_prefetch(received + ahead.sphere, 1);
    }
    const std::int32_t own = power[disc.sphere];
    std::int64_t sum = 0;
    for_tiles(disc, spheres.reach[disc.sphere], pitch, [&](Mask mask, std::int32_t cell) {
      const Tile tile = Tile::load(lattice + cell, pitch);
      mask &= tile.differs_from(outside_power);
      tile.store(lattice + cell, pitch, mask, own);
      sum += tile.sum(mask) - static_cast<std::int64_t>(__builtin_popcount(mask)) * own;
    });
    received[disc.sphere] += sum;
  }
}

}  // namespace

extern const LineKernels kernels;
const LineKernels kernels = {GRANRAD_LINE_NAME, project, emit, emit_runs, receive};

}  // namespace granrad::GRANRAD_LINE_ISA
