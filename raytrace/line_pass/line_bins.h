#pragma once
#include <cstdint>
#include <deque>
#include <vector>

#include "raytrace/line_pass/line_lattice.h"

namespace granrad {

/// The discs of one direction, sorted by tile of the lattice and by depth: thrown into bins (tile x slab of
/// depth) small enough for the cache, and sorted there. A disc that reaches over a border is in each of the
/// tiles it meets; the margins hide the rest of it.
class LineBins {
 public:
  /// Projects and bins all spheres.
  void fill(const LineKernels& kernels, const LineSpheres& spheres, const LineLattice& lattice,
            const LineProjection& projection);
  /// The discs of a tile by depth, cells counted within it. Valid until the next call.
  const std::vector<LineRecord>& sorted(std::int32_t tile);

 private:
  struct Chunk {
    static constexpr int capacity = 101;
    LineRecord record[capacity];
    Chunk* next;
  };
  struct Bin {
    LineRecord *to = nullptr, *end = nullptr;
    Chunk *first = nullptr, *last = nullptr;
  };
  void put(const LineRecord& disc, std::int32_t slab, std::int32_t across, std::int32_t down,
           const LineLattice& lattice);
  void extend(Bin& bin);
  template <class Visit>
  void for_records(const Bin& bin, Visit&& visit) const;
  std::size_t count(const Bin& bin) const;
  template <class ForRecords>
  void sort(std::size_t count, std::uint32_t first_key, ForRecords&& for_records);

  std::int32_t slabs_ = 1;
  std::vector<Bin> bins_;
  std::deque<Chunk> chunks_;
  std::size_t used_ = 0;
  std::vector<LineRecord> projected_, half_sorted_, sorted_;
};

}  // namespace granrad
