// Requirement: heats on a recorded flow are those of the flow itself, as far as its snapshots tell: the same flow run
// coupled and replayed from its frames agrees within the scatter of the rows; who came and who left is counted, the
// ledger closes, a stopped replay goes on with the same bits, and dumps of the frames replay as the frames do.
// Planted and caught: heat of arrivals not counted (ledger); particles that stay found by the next id while the snapshot
// before is taken for the nearest (counts, mass flows).
#include <algorithm>
#include <cmath>

#include "coupling/simulation/history.h"
#include "dem/io/snapshot.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

/// A plug of about 400 alumina spheres between walls at 1000 K; `rest`: what moves it.
std::string scene(const std::string& rest) {
  return R"([scene]
name = "plug"
end_time_s = 0.2
)" + scene_text::alumina +
         R"([gas]
[box]
size_m = ["10 mm", "4 mm", "10 mm"]
[walls]
x_min = {role = "adiabatic"}
x_max = {role = "adiabatic"}
y_min = {role = "isothermal", temperature_K = 1000}
y_max = {role = "isothermal", temperature_K = 1000}
z_min = {role = "open", temperature_K = 300, contact = false}
z_max = {role = "open", temperature_K = 300, contact = false}
[radiation]
source = "paths"
every_s = 0.01
[output]
every_s = 0.02
frames_every_s = 0.005
)" + rest;
}

const char* const flow_keys = R"([particles]
diameter_m = "0.8 mm"
[feed]
kind = "plug"
solid_fraction = 0.25
mass_flow_kg_s = "1.59 g/s"
transverse_velocity_std_m_s = 0.01
seed = 3
)";

std::string replay_keys(const std::string& files, const std::string& more = "") {
  return "[dem]\nengine = \"replay\"\nfiles = \"" + files + "\"\n" + more;
}

class Replay : public testing::Test {
 protected:
  void run(const std::string& name, const std::string& keys, const std::string& options = "") {
    std::ofstream(scratch_.root / (name + ".toml")) << scene(keys);
    const Outcome outcome =
        granrun(scratch_, "run " + (scratch_.root / (name + ".toml")).string() + " -q --threads 1 -o " +
                              (scratch_.root / name).string() + " " + options);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  std::string history(const std::string& name) const { return content(scratch_.root / name / "history.csv"); }
  std::vector<double> column(const std::string& name, const std::string& of) const {
    return read_history(scratch_.root / name / "history.csv").at(of);
  }
  Scratch scratch_;
};

TEST_F(Replay, HeatsAreThoseOfTheFlow) {
  run("flow", flow_keys);
  run("again", replay_keys("flow/frames/f_*.hdf"));
  EXPECT_EQ(column("again", "particle_count"), column("flow", "particle_count"));
  for (const char* exact : {"mass_flow_in_kg_s", "mass_flow_out_kg_s"}) {
    const auto a = column("flow", exact), b = column("again", exact);
    for (std::size_t k = 0; k < a.size(); ++k)
      EXPECT_NEAR(a[k], b[k], 1e-12 * std::abs(a[k])) << exact << " row " << k;
  }
  for (const double defect : column("again", "energy_defect")) EXPECT_LT(std::abs(defect), 1e-9);
  for (const char* name : {"h_sfs_W_m2K", "h_rad_W_m2K", "h_wp_W_m2K", "mean_temperature_K"}) {
    const auto a = column("flow", name), b = column("again", name);
    double mean = 0, square = 0, level = 0;
    for (std::size_t k = 1; k < a.size(); ++k)
      mean += b[k] - a[k], square += (b[k] - a[k]) * (b[k] - a[k]), level += a[k];
    const double n = static_cast<double>(a.size() - 1);
    mean /= n, level /= n;
    const double error = std::sqrt(std::max(0.0, square / n - mean * mean) / (n - 1));
    EXPECT_LT(std::abs(mean), 4 * error + 2e-3 * level)
        << name << ": " << mean << " +- " << error << " of " << level;
    EXPECT_LT(std::abs(mean), 0.03 * level) << name;
  }

  run("half", replay_keys("flow/frames/f_*.hdf"), "--set scene.end_time_s=0.1");
  run("half", replay_keys("flow/frames/f_*.hdf"), "--resume");
  EXPECT_EQ(history("half"), history("again")) << "resumed";

  ASSERT_EQ(granrun(scratch_, "export " + (scratch_.root / "flow").string() + " --to dump -q").code, 0);
  fs::path last;
  for (const auto& entry : fs::directory_iterator(scratch_.root / "flow/frames"))
    last = std::max(last, entry.path());
  const Bed bed = read_frame(last).bed;
  std::stringstream step;
  step.precision(17);
  step << "step_s = " << bed.time_s / static_cast<double>(bed.step) << "\n";
  run("dumps", replay_keys("flow/export/f_*.dump", step.str()));
  const auto a = column("again", "Q_rad_W"), b = column("dumps", "Q_rad_W");
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-9 * std::abs(a[k]));
  run("between", replay_keys("flow/frames/f_*.hdf", "between = \"interpolated\"\n"));
  const auto c = column("between", "mean_temperature_K"), d = column("flow", "mean_temperature_K");
  EXPECT_NEAR(c.back() - 300, d.back() - 300, 0.05 * (d.back() - 300));
}

TEST_F(Replay, BadRecordingsAreRefused) {
  const auto refused = [&](const std::string& keys, const std::string& part) {
    std::ofstream(scratch_.root / "bad.toml") << scene(keys);
    const Outcome outcome = granrun(scratch_, "run " + (scratch_.root / "bad.toml").string() + " -q -o " +
                                                  (scratch_.root / "bad").string());
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(scratch_.root / "bad"));
  };
  const auto dump = [&](int number, int step) {
    std::ofstream(scratch_.root / ("d." + std::to_string(number) + ".dump"))
        << "ITEM: TIMESTEP\n"
        << step << "\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 0.01\n0 0.004\n0 0.01\n"
        << "ITEM: ATOMS id x y z radius\n1 5e-3 2e-3 " << 1e-3 * number << " 4e-4\n";
  };
  for (int k = 1; k < 12; ++k) dump(k, 1000 * k);
  refused(replay_keys("none.*.dump"), "dem.files = \"none.*.dump\" (no file has such a name)");
  refused(replay_keys(""), "dem.files");
  refused(replay_keys("d.*.dump"), "give dem.step_s");
  refused(replay_keys("d.*.dump", "step_s = 1e-6\n"), "the recording of 11 files is 0.01 s long");
  refused(replay_keys("d.*.dump", "step_s = 1e-4\n") + flow_keys, "leave [feed] out");
  refused("[dem]\nfiles = \"d.*.dump\"\n" + std::string(flow_keys), "is of engine = \"replay\" alone");
}

}  // namespace
