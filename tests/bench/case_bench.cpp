// The paper's whole case beside LIGGGHTS: the moving bed of 13 576 spheres with conduction and radiation, 5 s
// of flow (500 000 steps), in double and in mixed precision, against the time LIGGGHTS takes for the flow
// alone. LIGGGHTS continues from our last frame for some thousand steps on one core; its time for all steps
// is that rate, halved as if a second core doubled it. Usage: case_bench [--quick] FOLDER
#include <fmt/format.h>
#include <fmt/os.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "dem/io/snapshot.h"
#include "tests/bench/bench_arguments.h"
#include "tests/bench/dem_bench_peers.h"
#include "tests/source_dir.h"

namespace granrad::bench {
namespace {

namespace fs = std::filesystem;

constexpr double step_s = 1e-5;
constexpr int threads = 2;
/// Room about the walls, and below them for what leaves the outlet meanwhile; more would only cost LIGGGHTS
/// time, whose bins fill the box.
constexpr double margin_m = 2e-3, way_out_m = 0.05;

double seconds_of(const std::string& command) {
  const auto start = std::chrono::steady_clock::now();
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

fs::path last_frame(const fs::path& run) {
  fs::path last;
  for (const auto& entry : fs::directory_iterator(run / "frames")) last = std::max(last, entry.path());
  return last;
}

/// LIGGGHTS knows walls as triangles and needs a box that holds everything; shutters that have opened and
/// walls without contact are not there.
Bed with_meshes(Bed bed) {
  std::erase_if(bed.walls, [&](const Wall& w) { return !w.contact || w.opens_at_s <= bed.time_s; });
  for (Wall& wall : bed.walls) {
    if (!wall.triangles.empty()) continue;
    for (std::int32_t k = 2; k < std::int32_t(wall.vertices.size()); ++k)
      wall.triangles.push_back({0, k - 1, k});
  }
  for (const Wall& wall : bed.walls)
    for (const Vec3& p : wall.vertices)
      for (int a = 0; a < 3; ++a) {
        bed.box.min[a] = std::min(bed.box.min[a], p[a] - margin_m);
        bed.box.max[a] = std::max(bed.box.max[a], p[a] + margin_m);
      }
  bed.box.min.z -= way_out_m;
  return bed;
}

/// Seconds of granrun for the scene up to end_s.
double granrun_seconds(const fs::path& out, double end_s, const std::string& precision) {
  fs::remove_all(out);
  return seconds_of(
      fmt::format("'{}' run '{}/data/scenes/moving_bed_4x4.toml' -q -o '{}' --threads {} --set "
                  "scene.end_time_s={} --set dem.precision={}",
                  GRANRUN, granrad::source_dir(), out.string(), threads, end_s, precision));
}

int run(const fs::path& folder, bool quick) {
  const double end_s = quick ? 0.1 : 5;
  const auto steps = static_cast<std::int64_t>(end_s / step_s + 0.5);
  const fs::path out = folder / "case";
  const double full = granrun_seconds(out, end_s, "double");
  const double mixed = granrun_seconds(folder / "case_mixed", end_s, "mixed");
  const Bed bed = with_meshes(read_frame(last_frame(out)).bed);
  const int warm_up = 200, measured = quick ? 500 : 4000;
  const auto rate = run_liggghts(folder, bed, {0, 0, -9.81}, warm_up, measured);
  auto csv = fmt::output_file((folder / "case_bench.csv").string());
  csv.print("case,ours,unit,peer,theirs,ratio\n");
  const double theirs = rate ? double(bed.size()) * double(steps) / (*rate * 1e6) / threads : 0;
  for (const auto& [name, ours] : {std::pair{"paper_case", full}, std::pair{"paper_case_mixed", mixed}}) {
    if (!rate) {
      fmt::print("{}_{}s ours {:.1f} s ({} particles; LIGGGHTS is not installed or failed)\n", name, end_s,
                 ours, bed.size());
      continue;
    }
    fmt::print("{}_{}s ours {:.1f} s liggghts {:.1f} s ratio {:.2f}\n", name, end_s, ours, theirs,
               theirs / ours);
    csv.print("{}_{}s,{:.4g},s,liggghts,{:.4g},{:.4g}\n", name, end_s, ours, theirs, theirs / ours);
  }
  return 0;
}

}  // namespace
}  // namespace granrad::bench

int main(int argc, char** argv) {
  const granrad::bench::BenchArguments given(argc, argv);
  return given.folder.empty() ? 2 : granrad::bench::run(given.folder, given.quick);
}
