// Runs scenes one after another in one process, for judge.py: a thousand small scenes a minute instead of dozens.
//
//   stdin, a line a scene:  SCENE.toml                  run it to its end
//                           SCENE.toml FRAME THREADS    likewise, but in the middle written to FRAME and read back,
//                                                       then with so many threads
//   stdout, a line a scene: JSON: {"code": 0, "rows": ..., "walls": ..., ...} or {"code": 2, "error": ...}
//
// The rows are those of history.csv and walls.csv, the bounds are over every heat step. What a process adds (folders,
// locks, exit codes) judge.py asks the program itself, for some scenes.
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coupling/simulation/simulation.h"
#include "dem/base/error.h"

namespace granrad {
namespace {

using Json = nlohmann::json;

/// JSON has no name for a number that is not finite.
Json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : "inf";
}

/// What must hold at every step, whatever is written.
struct Extremes {
  double lowest_K = infinity, highest_K = -infinity;
  std::size_t fewest = SIZE_MAX, most = 0;
  bool finite = true;

  void look_at(const Bed& bed) {
    fewest = std::min(fewest, bed.size());
    most = std::max(most, bed.size());
    for (std::size_t i = 0; i < bed.size(); ++i) {
      lowest_K = std::min(lowest_K, bed.temperature_K[i]);
      highest_K = std::max(highest_K, bed.temperature_K[i]);
      finite = finite && std::isfinite(bed.temperature_K[i]) && std::isfinite(norm(bed.position_m[i])) &&
               std::isfinite(norm(bed.velocity_m_s[i])) && std::isfinite(bed.radiative_heat_W[i]);
    }
  }
};

void add_record(Json& result, Record record) {
  Json row = Json::object();
  std::size_t k = 0;
  for (const auto& column : history_columns()) row[column.name] = number(record.row.values()[k++]);
  result["rows"].push_back(row);
  for (const auto& wall : record.walls)
    result["walls"].push_back(
        {wall.wall, number(wall.area_m2), number(wall.Q_ss_W), number(wall.Q_sfs_W), number(wall.Q_rad_W)});
}

std::unique_ptr<Simulation> read_back(const Simulation& simulation, const Case& c, const std::string& frame,
                                      int threads) {
  simulation.write_checkpoint(frame);
  auto again = std::make_unique<Simulation>(c, threads);
  if (!again->resume(read_frame(frame))) throw NumericalError("the frame does not lead on");
  return again;
}

Json run(const std::string& scene, const std::string& frame, int threads) {
  omp_set_num_threads(1);
  const Case c = read_case(scene, {});
  auto simulation = std::make_unique<Simulation>(c, 1);
  simulation->start();
  Json result{{"code", 0}, {"rows", Json::array()}, {"walls", Json::array()}};
  Extremes extremes;
  extremes.look_at(simulation->bed());
  result["step_s"] = simulation->plan().step_s;
  result["first_count"] = simulation->bed().size();
  const auto middle = simulation->plan().end_tick / 2;
  while (!simulation->finished()) {
    simulation->advance();
    extremes.look_at(simulation->bed());
    if (simulation->plan().row_at(simulation->tick())) add_record(result, simulation->record());
    if (!frame.empty() && simulation->tick() == middle) {
      omp_set_num_threads(threads);
      simulation = read_back(*simulation, c, frame, threads);
    }
  }
  const Bed& bed = simulation->bed();
  result["temperatures"] = bed.temperature_K;
  result["bounds"] = {number(extremes.lowest_K), number(extremes.highest_K)};
  result["counts"] = {extremes.fewest, extremes.most};
  result["finite"] = extremes.finite;
  const FeedTotals fed = simulation->fed();
  result["fed"] = {fed.inserted, fed.removed};
  return result;
}

Json answer(const std::string& scene, const std::string& frame, int threads) {
  try {
    return run(scene, frame, threads);
  } catch (const Error& error) {
    return {{"code", static_cast<int>(error.exit_code())}, {"error", error.what()}};
  } catch (const std::exception& error) {
    return {{"code", -1}, {"error", error.what()}};
  }
}

}  // namespace
}  // namespace granrad

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string scene, frame;
    int threads = 1;
    words >> scene >> frame >> threads;
    std::cout << granrad::answer(scene, frame, threads)
                     .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
              << std::endl;
  }
}
