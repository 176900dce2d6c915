#include "raytrace/paths/path_batches.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "dem/ranks/ranks.h"

namespace granrad {

namespace {

using Batches = std::vector<std::vector<Quanta>>;  ///< [batch][surface of a part]

SumAndError total_and_error(const std::vector<Quanta>& of_batch) {
  const double batches = static_cast<double>(of_batch.size());
  Quanta total = 0;
  for (const Quanta value : of_batch) total += value;
  const double mean = static_cast<double>(total) / batches;
  double squares = 0;
  for (const Quanta value : of_batch) {
    const double d = static_cast<double>(value) - mean;
    squares += d * d;
  }
  return {static_cast<double>(total), std::sqrt(squares * batches / (batches - 1))};
}

/// For each batch this rank worked at, its number and the heats of these surfaces.
std::vector<char> packed(const BatchTallies& found, RankPart surfaces) {
  std::vector<char> bytes;
  const auto add = [&](const void* data, std::size_t size) {
    const auto* begin = static_cast<const char*>(data);
    bytes.insert(bytes.end(), begin, begin + size);
  };
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!found[b]) continue;
    const auto number = static_cast<Quanta>(b);
    add(&number, sizeof number);
    add(found[b]->heat.data() + surfaces.begin,
        static_cast<std::size_t>(surfaces.end - surfaces.begin) * sizeof(Quanta));
  }
  return bytes;
}

void unpack(const std::vector<char>& bytes, Batches& batches) {
  const std::size_t surfaces = batches[0].size();
  Quanta value = 0;
  const char* from = bytes.data();
  const auto take = [&] {
    std::memcpy(&value, from, sizeof value);
    from += sizeof value;
    return value;
  };
  while (from != bytes.data() + bytes.size()) {
    auto& sum = batches[static_cast<std::size_t>(take())];
    for (std::size_t s = 0; s < surfaces; ++s) sum[s] += take();
  }
}

/// The sums of all ranks over the surfaces that are this one's part.
Batches gather_part(const BatchTallies& found, std::int64_t surfaces) {
  const RankPart mine = part_of_rank(surfaces);
  Batches batches(found.size(), std::vector<Quanta>(static_cast<std::size_t>(mine.end - mine.begin), 0));
  if (rank_count() == 1) {
    for (std::size_t b = 0; b < found.size(); ++b)
      if (found[b]) batches[b] = found[b]->heat;
    return batches;
  }
  std::vector<std::vector<char>> to;
  for (int r = 0; r < rank_count(); ++r) to.push_back(packed(found, part_of_rank(surfaces, r)));
  for (const auto& bytes : exchanged_bytes(to)) unpack(bytes, batches);
  return batches;
}

/// Slope of x over y of the walks, in parts.
int best_parts(const WalkMoments& m) {
  const double n = static_cast<double>(m.walks), y = static_cast<double>(m.y);
  const double with = static_cast<double>(m.xy) - static_cast<double>(m.x) * y / n;
  const double own = static_cast<double>(m.yy) - y * y / n;
  if (!(own > 0)) return 0;
  return static_cast<int>(
      std::clamp(std::round(clear_flight_parts * with / own), 0.0, 1.0 * clear_flight_parts));
}

}  // namespace

void take_out_clear_flights(BatchTallies& found) {
  constexpr std::size_t sums = 5;
  std::vector<std::int64_t> all(sums * found.size(), 0);
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!found[b]) continue;
    const WalkMoments& m = found[b]->moments;
    const std::int64_t own[sums] = {m.walks, m.x, m.y, m.xy, m.yy};
    std::copy(own, own + sums, all.begin() + static_cast<std::ptrdiff_t>(sums * b));
  }
  sum_over_ranks(all);
  for (std::size_t b = 0; b < found.size(); ++b) {
    if (!found[b]) continue;
    WalkMoments others;
    for (std::size_t other = 0; other < found.size(); ++other) {
      const std::int64_t* m = &all[sums * other];
      if (other != b) others.add({m[0], m[1], m[2], m[3], m[4]});
    }
    const int parts = best_parts(others);
    for (std::size_t s = 0; s < found[b]->heat.size(); ++s)
      found[b]->heat[s] = clear_flight_parts * found[b]->heat[s] - parts * found[b]->clear_heat[s];
  }
}

BatchSums sum_batches(const BatchTallies& found, const PathSurfaces& surfaces) {
  const auto count = static_cast<std::int64_t>(surfaces.count());
  const RankPart mine = part_of_rank(count);
  const Batches batches = gather_part(found, count);

  std::vector<SumAndError> own;
  std::vector<Quanta> given(found.size(), 0), of_batch(found.size());
  for (std::int64_t s = mine.begin; s < mine.end; ++s) {
    for (std::size_t b = 0; b < found.size(); ++b) {
      of_batch[b] = batches[b][static_cast<std::size_t>(s - mine.begin)];
      if (surfaces.is_wall(static_cast<std::int32_t>(s))) given[b] -= of_batch[b];
    }
    own.push_back(total_and_error(of_batch));
  }
  BatchSums sums;
  sums.surface = joined_over_ranks(own);
  const std::vector<Quanta> all_given = joined_over_ranks(given);
  std::fill(given.begin(), given.end(), 0);
  for (std::size_t k = 0; k < all_given.size(); ++k) given[k % given.size()] += all_given[k];
  sums.given = total_and_error(given);
  std::int64_t counts[2] = {0, 0};
  for (const auto& batch : found)
    if (batch) counts[0] += batch->segments, counts[1] += batch->lost;
  sum_over_ranks(counts);
  sums.segments = counts[0], sums.lost = counts[1];
  return sums;
}

}  // namespace granrad
