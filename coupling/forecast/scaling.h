#pragma once
#include <string>
#include <vector>

#include "coupling/forecast/forecast.h"

namespace granrad {

/// Seconds of the whole run by part, and memory, on each of some ranks: one a node, each with the threads of the trial.
struct RankForecast {
  int ranks = 1;
  double flow_s = 0, gather_s = 0, conduction_s = 0, radiation_s = 0, output_s = 0;
  double memory_bytes = 0;  ///< of each rank
  double total_s() const { return flow_s + gather_s + conduction_s + radiation_s + output_s; }
};

/// What the forecast for one rank becomes on `ranks`, for an engine: the native flow is repeated on every rank; that of
/// LIGGGHTS is shared, `liggghts_slowness` times as dear in all, and handed over at every heat step (gather_s, of which a
/// part is shared). There and in recorded flows ranks share the search of contacts; temperatures and the output are not
/// shared. Of the radiation, what is shared goes down with the ranks, and heats are exchanged over
/// a network of 1 GB/s and 50 us a step of log2 R steps. A model: it knows no waiting of uneven ranks.
RankForecast forecast_on_ranks(const Case& c, const Forecast& one, EngineKind engine, int ranks);

/// The ranks up to `most`, in powers of two, from which twice as many save less than a fifth of the time.
int where_it_stops_scaling(const Case& c, const Forecast& one, EngineKind engine, int most);

/// A table for 1, 2, 4 ... up to `ranks`, of both engines where the scene can run on LIGGGHTS, and what follows from it.
std::string scaling_text(const Case& c, const Forecast& one, int ranks);

/// A job for Slurm: as many nodes as ranks, the time forecast with a margin of a half and its memory, a stop five minutes
/// before the end, and going on in another job where the time was too short.
std::string slurm_script(const Case& c, const Forecast& one, int ranks, int threads,
                         const std::string& command);

}  // namespace granrad
