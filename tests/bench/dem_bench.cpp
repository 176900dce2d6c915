// Speed of the native engine beside Debian's LIGGGHTS and LAMMPS on the same beds: dem_bench FOLDER
// [--quick]. Lines read `CASE ours VALUE UNIT PEER VALUE UNIT ratio R` (R > 1 in our favour); FOLDER gets
// dem_bench.csv and dem_bench.svg.
#include <fmt/format.h>
#include <fmt/os.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string_view>
#include <vector>

#include "coupling/heat/heat_step.h"
#include "dem/base/program.h"
#include "dem/base/random.h"
#include "dem/native/native_engine.h"
#include "tests/bench/bench_arguments.h"
#include "tests/bench/dem_bench_peers.h"
#include "tests/settled_bed.h"
#include "tests/source_dir.h"

namespace granrad::bench {
namespace {

constexpr double step = 1e-5, radius = 4e-4;
const std::filesystem::path data_folder = granrad::source_dir() + "/data/reference/liggghts_bench";
constexpr int piece = 100;  ///< steps of one advance, as in a coupled run

Material alumina() {
  Material m;
  m.density_kg_m3 = 3984, m.youngs_modulus_Pa = 5e6, m.poisson_ratio = 0.23, m.restitution = 0.45,
  m.friction = 0.4;
  m.conductivity_W_mK = 33, m.specific_heat_J_kgK = 755, m.real_youngs_modulus_Pa = 3.7e11;
  return m;
}

/// 12 500 spheres at solid fraction 0.07 in uniform motion, all directions periodic.
Bed dilute_plug() {
  Bed bed;
  bed.materials = {alumina()};
  bed.periodic = {true, true, true};
  const double pitch = std::cbrt(2.680825731e-10 / 0.07);
  const int nx = 25, ny = 20, nz = 25;
  bed.box = {{0, 0, 0}, {nx * pitch, ny * pitch, nz * pitch}};
  for (int k = 0; k < nx * ny * nz; ++k) {
    const auto a = random_uniform2(1, 0, k), b = random_uniform2(1, 1, k), v = random_normal2(1, 2, k);
    const double jitter = pitch - 2.05 * radius;
    bed.add({(k % nx) * pitch + jitter * a[0], (k / nx % ny) * pitch + jitter * a[1],
             (k / nx / ny) * pitch + jitter * b[0]},
            {1e-3 * v[0], 1e-3 * v[1], -0.1425}, radius, 300);
  }
  return bed;
}

Wall frustum(const std::string& name, double x0, double y0, double z0, double x1, double y1, double z1) {
  Wall w;
  w.name = name;
  for (const auto& [x, y, z] : {std::array{x0, y0, z0}, std::array{x1, y1, z1}})
    for (const auto& [sx, sy] : {std::array{-1, -1}, std::array{1, -1}, std::array{1, 1}, std::array{-1, 1}})
      w.vertices.push_back({1e-3 * sx * x, 1e-3 * sy * y, 1e-3 * z});
  for (int k = 0; k < 4; ++k) {
    const int l = (k + 1) % 4;
    w.triangles.push_back({k, l, l + 4});
    w.triangles.push_back({k, l + 4, k + 4});
  }
  return w;
}

/// The moving bed: hopper, channel and outlet of 4 x 4 mm as meshes, 10 376 particles in steady discharge.
Bed moving_bed() {
  Bed bed;
  bed.materials = {alumina()};
  std::ifstream in(granrad::source_dir() + "/data/reference/snapshot_outlet_4x4.dump");
  std::string line;
  while (std::getline(in, line) && line.rfind("ITEM: ATOMS", 0) != 0) {
  }
  double id, contacts;
  for (Vec3 p, v, w; in >> id >> p.x >> p.y >> p.z >> v.x >> v.y >> v.z >> w.x >> w.y >> w.z >> contacts;)
    bed.angular_velocity_rad_s[bed.add(p, v, radius, 300)] = w;
  bed.box = {{-0.016, -0.013, -0.12}, {0.016, 0.013, 0.102}};
  bed.walls = {frustum("chute", 15, 12, 70, 15, 12, 100), frustum("feed", 5, 2, 50, 15, 12, 70),
               frustum("channel", 5, 2, 0, 5, 2, 50), frustum("lower", 2, 2, -10, 5, 2, 0)};
  return bed;
}

struct Speed {
  double million_steps = 0;  ///< particle-steps per second
  double ns_per_contact = 0, bytes_per_particle = 0;
};

/// How to run: what may differ beside the bed. `conducts`: contacts and gas lenses exchange heat after each
/// piece, as in a coupled run.
struct Way {
  int threads = 1;
  Precision precision = Precision::full;
  bool conducts = false;
  const native::Kernels* kernels = nullptr;
};

void conduct(Bed& bed, native::NativeEngine& engine) {
  ConductionSettings settings;
  settings.gas = GasLens{};
  const auto pairs = engine.near_pairs(bed, lens_cutoff_gap_m(settings, radius));
  advance_temperatures(bed, conductances(bed, pairs, settings), piece * step);
}

/// Best of several parts of the run, each of whole pieces: load and store of the Bed as often as in a coupled
/// run.
Speed measure(Bed bed, const Vec3& gravity, int warm_up, int steps, const Way& way = {}) {
  native::EngineOptions options;
  options.threads = way.threads, options.kernels = way.kernels, options.precision = way.precision;
  native::NativeEngine engine(bed, gravity, step, options);
  const auto n = double(bed.size());
  if (way.conducts) conduct(bed, engine);  // the lists learn to what gap they are read
  engine.advance(bed, warm_up * step);
  double best = 1e300;
  constexpr int repeats = 5;
  std::int64_t done = warm_up;
  for (int r = 0; r < repeats; ++r) {
    const auto start = std::chrono::steady_clock::now();
    const std::int64_t until = done + steps / repeats;
    for (const auto before = done; done < until; (void)before) {
      done = std::min<std::int64_t>(until, done + piece);
      engine.advance(bed, double(done) * step);
      if (way.conducts) conduct(bed, engine);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count() / double(steps / repeats));
  }
  const auto counts = engine.counts();
  return {n / best * 1e-6,
          best * 1e9 / double(std::max<std::int64_t>(1, counts.touching + counts.wall_contacts)),
          counts.bytes_per_particle};
}

struct Line {
  std::string name;
  double ours;
  std::string unit, peer;
  double theirs;
};

class Report {
 public:
  explicit Report(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void add(const Line& l) {
    fmt::print("{} ours {:.3g} {} {} {:.3g} {} ratio {:.2f}\n", l.name, l.ours, l.unit, l.peer, l.theirs,
               l.unit, l.ours / l.theirs);
    std::fflush(stdout);
    lines_.push_back(l);
  }
  void note(const std::string& text) { fmt::print("{}\n", text); }
  void save() const {
    auto csv = fmt::output_file((folder_ / "dem_bench.csv").string());
    csv.print("case,ours,unit,peer,theirs,ratio\n");
    for (const auto& l : lines_)
      csv.print("{},{},{},{},{},{}\n", l.name, l.ours, l.unit, l.peer, l.theirs, l.ours / l.theirs);
    auto svg = fmt::output_file((folder_ / "dem_bench.svg").string());
    const double width = 900, left = 260, row = 34;
    double most = 1;
    for (const auto& l : lines_) most = std::max({most, l.ours, l.theirs});
    svg.print(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{}' height='{}' font-family='sans-serif' "
        "font-size='12'>\n"
        "<rect width='100%' height='100%' fill='white'/>\n<text x='10' y='20'>million particle-steps per "
        "second "
        "(dark: granrad, light: peer)</text>\n",
        width, 40 + row * double(lines_.size()));
    double y = 34;
    for (const auto& l : lines_) {
      const double scale = (width - left - 120) / most;
      svg.print(
          "<text x='10' y='{}'>{} / {}</text>\n<rect x='{}' y='{}' width='{}' height='12' fill='#1f4e79'/>\n"
          "<rect x='{}' y='{}' width='{}' height='12' fill='#9dc3e6'/>\n<text x='{}' y='{}'>{:.1f}x</text>\n",
          y + 16, l.name, l.peer, left, y, l.ours * scale, left, y + 13, l.theirs * scale,
          left + 8 + std::max(l.ours, l.theirs) * scale, y + 16, l.ours / l.theirs);
      y += row;
    }
    svg.print("</svg>\n");
  }

 private:
  std::filesystem::path folder_;
  std::vector<Line> lines_;
};

/// What the peers run: the decks stored beside the bed (300 steps of warm-up), or decks written for it.
enum class Decks { stored, both, liggghts };

/// Whom a case is measured against, the best of all rounds in million particle-steps per second.
struct Rival {
  std::string name;
  bool is_peer;  ///< else another way of our own
  std::function<std::optional<double>()> run;
  double best = 0;
};

/// Each rival is timed this often, in rotation, and its fastest time counts: other load changes within seconds.
constexpr int rounds = 3;

int run(const std::filesystem::path& folder, bool quick) {
  std::filesystem::create_directories(folder);
  Report report(folder);
  const Vec3 down{0, 0, -9.81};
  const int scale = quick ? 1 : 4, warm_up = 300;
  const auto compare = [&](const std::string& name, const Bed& bed, const Vec3& gravity, int steps,
                           int peer_steps, Decks decks) {
    const auto ours = [&](const Way& way) {
      return [&, way] { return std::optional(measure(bed, gravity, warm_up, steps, way).million_steps); };
    };
    const auto stored = [&](const std::string& program, const std::string& deck) {
      return run_stored(program, data_folder / deck, folder, bed, peer_steps);
    };
    std::vector<Rival> rivals;
    rivals.push_back({"liggghts", true, [&] {
                        return decks == Decks::stored
                                   ? stored("liggghts", "in.lig")
                                   : run_liggghts(folder, bed, gravity, warm_up, peer_steps);
                      }});
    if (decks != Decks::liggghts)
      rivals.push_back({"lammps", true, [&] {
                          return decks == Decks::stored ? stored("lammps", "in.lmp")
                                                        : run_lammps(folder, bed, warm_up, peer_steps);
                        }});
    if (decks == Decks::stored)
      rivals.push_back({"baseline", true, ours({.kernels = &native::baseline_kernels()})});
#if defined(__x86_64__)
    if (decks == Decks::stored && __builtin_cpu_supports("avx2"))
      rivals.push_back({"avx2", false, ours({.kernels = &native::avx2_kernels()})});
#endif
    rivals.push_back({"two_threads", false, ours({.threads = 2})});
    rivals.push_back({"mixed", false, ours({.precision = Precision::mixed})});
    rivals.push_back({"conducting", false, ours({.conducts = true})});
    Speed best;
    for (int round = 0; round < rounds; ++round) {
      const auto one = measure(bed, gravity, warm_up, steps);
      if (one.million_steps > best.million_steps) best = one;
      for (auto& rival : rivals) rival.best = std::max(rival.best, rival.run().value_or(0));
    }
    report.note(fmt::format("{}: {} particles, {:.1f} ns per contact, {:.0f} bytes per particle", name,
                            bed.size(), best.ns_per_contact, best.bytes_per_particle));
    for (const auto& rival : rivals) {
      if (rival.best == 0) continue;
      if (rival.is_peer)
        report.add({name, best.million_steps, "Mpsteps/s", rival.name, rival.best});
      else
        report.add(
            {name + "_" + rival.name, rival.best, "Mpsteps/s", "double_one_thread", best.million_steps});
    }
  };
  compare("bed_12k", settled_bed(1, 1), down, 1000 * scale, 500 * scale, Decks::stored);
  compare("moving_bed_meshes", moving_bed(), down, 1000 * scale, 500 * scale, Decks::liggghts);
  compare("plug_phi007", dilute_plug(), {}, 1000 * scale, 1000 * scale, Decks::liggghts);
  compare("bed_100k", settled_bed(4, 2), down, 500 * scale, 50 * scale, Decks::both);
  if (!quick) {
    const Bed million = settled_bed(10, 8);
    for (const auto& [name, way] :
         {std::pair{"bed_1M", Way{}}, std::pair{"bed_1M_mixed", Way{.precision = Precision::mixed}},
          std::pair{"bed_1M_two_threads", Way{.threads = 2}},
          std::pair{"bed_1M_mixed_two_threads", Way{.threads = 2, .precision = Precision::mixed}}})
      report.add({name, measure(million, down, 100, 500, way).million_steps, "Mpsteps/s", "goal", 25});
  }
  report.save();
  return 0;
}

}  // namespace
}  // namespace granrad::bench

int main(int argc, char** argv) {
  granrad::keep_freed_memory();
  const granrad::bench::BenchArguments given(argc, argv);
  return given.folder.empty() ? 2 : granrad::bench::run(given.folder, given.quick);
}
