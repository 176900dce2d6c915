#pragma once
#include <cstdint>
#include <vector>

#include "raytrace/line_pass/line_pass.h"

namespace granrad {

/// Void met along the lines of one direction: total length, and the number of gaps between neighbours.
struct ChordSums {
  double length_m = 0;
  std::int64_t gaps = 0;
};

/// Mean free length of a ray over all surfaces, and its standard error; 0 when not known.
struct MeanChord {
  double value_m = 0, standard_error_m = 0;
};

/// Of a closed enclosure: the void length of a direction is the same for all of them (the volume), so a few
/// sampled directions give it; gaps are counted along all `swept` directions. The error adds the scatter of
/// the samples to that of independent directions, a bound for evenly spread ones.
MeanChord mean_chord(const std::vector<ChordSums>& samples, double total_gaps, double swept);

/// For the direction `pass` was aimed at, gap by gap from the positions of both ends, in double precision; in
/// large enclosures on every k-th row of lines, and k times that, such that about a million gaps are looked
/// at. Lines that escape are left out. Slow beside the kernels: for a self-check on a few directions.
ChordSums chord_sums(LinePass& pass);

}  // namespace granrad
