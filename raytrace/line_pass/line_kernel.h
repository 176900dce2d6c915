#pragma once
#include <cstdint>

namespace granrad {

/// A disc on the lattice of lines, in units of the spacing: `cell` is its first column in its first row,
/// (du, dv) the vector from the centre of the disc to that cell.
struct LineRecord {
  float du, dv;
  std::int32_t cell;
  std::int32_t sphere;
  std::uint32_t key;  ///< depth
};

/// Affine maps from positions to lattice columns, rows and depth keys; plain arrays, for the kernels.
struct LineProjection {
  double u[4], v[4], key[4];  ///< x, y, z, constant
  std::int32_t pitch;         ///< cells from one row to the next
};

struct LineSpheres {
  std::int32_t count;
  const double *x, *y, *z;
  const float* reach;           ///< radius in spacings
  const std::int32_t* surface;  ///< number of each in the results
  float max_reach;
};

/// Cells outside the walls hold this in the lattices of `emit` and `receive`.
constexpr std::int32_t outside_id = -1;
constexpr std::int32_t outside_power = INT32_MIN;
/// What came before on lines that enter a periodic scene from beyond its images.
constexpr std::int32_t unknown_id = -2;
/// A tile is 4 x 4 cells; lattices need this many spare columns and rows.
constexpr int line_tile = 4;
constexpr int line_key_bits = 22;

/// A surface met by `count` (1 .. 16) lines of a tile, in 32 bits.
constexpr int line_run_bits = 4;
constexpr std::int32_t line_run_surface(std::uint32_t run) {
  return static_cast<std::int32_t>(run >> line_run_bits);
}
constexpr std::uint32_t line_run_count(std::uint32_t run) {
  return (run & ((1u << line_run_bits) - 1)) + 1;
}

/// The inner loops, compiled once for each instruction set from line_kernel.cpp; all give equal
/// integers.
struct LineKernels {
  const char* name;

  /// Discs of spheres [begin, end), in order.
  void (*project)(const LineSpheres&, std::int32_t begin, std::int32_t end, const LineProjection&,
                  LineRecord* record);

  /// Draws discs [begin, end) in order; each tile met appends {surface, cell, mask | n << 16,
  /// predecessors...} to `out`, one predecessor (the id overwritten) for each of the n bits of the mask,
  /// lowest first. Stops when less than `reserve` integers are left. Returns the next disc; `out_end` the end
  /// of what was written.
  std::int32_t (*emit)(const LineRecord*, std::int32_t begin, std::int32_t end, const LineSpheres&,
                       std::int32_t* lattice, std::int32_t pitch, std::int32_t* out, std::int64_t capacity,
                       std::int64_t reserve, std::int64_t* out_end);

  /// The same without the places: each tile appends {surface, n, runs...}, one run for each of the n surfaces
  /// overwritten.
  std::int32_t (*emit_runs)(const LineRecord*, std::int32_t begin, std::int32_t end, const LineSpheres&,
                            std::int32_t* lattice, std::int32_t pitch, std::int32_t* out,
                            std::int64_t capacity, std::int64_t reserve, std::int64_t* out_end);

  /// Draws `count` discs from `first` on by `step` (1 or -1): the lattice holds the emissive power last seen,
  /// and received[sphere] grows by the sum over its cells of (power there - its own). Both arrays are in the
  /// order of the spheres.
  void (*receive)(const LineRecord* first, std::int32_t count, std::int32_t step, const LineSpheres&,
                  const std::int32_t* power, std::int32_t* lattice, std::int32_t pitch,
                  std::int64_t* received);
};

/// The best kernels this machine runs, or those named by the environment variable GRANRAD_SIMD
/// (avx512, avx2, baseline). Throws InputError for another name, or one this machine lacks.
const LineKernels& line_kernels();

}  // namespace granrad
