// Requirement: validate, sweep, report and export produce their files, and a sweep skips what is finished.
#include <algorithm>
#include <cmath>

#include "coupling/simulation/history.h"
#include "granrun.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

std::size_t lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

}  // namespace

TEST(GranrunValidate, ComparesSourcesOnAFrozenBed) {
  Scratch scratch;
  const auto scene =
      scratch
          .write("plug.toml",
                 edited(small_plug, "[output]",
                        "[validate]\ntimes_s = [0.01, 0.04]\n[validate.reference]\nsource = \"embree\"\n"
                        "rays = 20000\n[[validate.compare]]\nsource = \"lines\"\n[[validate.compare]]\n"
                        "source = \"paths\"\nrays = 5000\n[output]"))
          .string();
  const auto folder = scratch.root / "v";
  const auto outcome = granrun(scratch, "validate " + scene + " -o " + folder.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto csv = content(folder / "validation.csv");
  EXPECT_EQ(
      csv.rfind("solid_fraction,source,rays,time_s,mean_temperature_K,mean_flux_W_m2,temperature_error_pct,"
                "flux_error_pct,particle_flux_rms_pct,reference_noise_pct,energy_defect,seconds_per_update\n",
                0),
      0u);
  ASSERT_EQ(lines(csv), 1u + 3 * 2) << csv;
  std::stringstream text(csv);
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    std::vector<std::string> cells;
    std::stringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 12u) << line;
    EXPECT_LT(std::abs(std::stod(cells[6])), 0.5) << line;
    // Embree and lines share one radiosity per adiabatic wall; paths do not and are noisy.
    EXPECT_LT(std::abs(std::stod(cells[7])), cells[1] == "paths" ? 6 : 1) << line;
    EXPECT_LT(std::stod(cells[10]), 1e-10) << line;
  }
  const auto page = content(folder / "report.html");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("Particle fluxes"), std::string::npos);
}

TEST(GranrunSweep, RunsEveryCaseOnceAndPrintsAJobsFile) {
  Scratch scratch;
  scratch.write("plug.toml", edited(small_plug, "end_time_s = 0.04", "end_time_s = 0.008"));
  const auto sweep =
      scratch
          .write("sweep.toml",
                 "[sweep]\nscene = \"plug.toml\"\n[[vary]]\nkey = \"material.emissivity\"\n"
                 "values = [0.4, 1]\n[[vary]]\nkey = \"radiation.source\"\ntexts = [\"paths\", \"none\"]\n"
                 "[[case]]\nname = \"hot\"\nset = [\"walls.y_min.temperature_K=1300\"]\n")
          .string();
  const auto folder = scratch.root / "study";
  ASSERT_EQ(granrun(scratch, "sweep " + sweep + " --list -o " + folder.string()).code, 0);
  EXPECT_EQ(lines(content(folder / "jobs.txt")), 5u);
  EXPECT_FALSE(fs::exists(folder / "hot"));
  const auto outcome = granrun(scratch, "sweep " + sweep + " -o " + folder.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder / "emissivity-0.4_source-paths" / "history.csv"));
  const auto summary = content(folder / "sweep.csv");
  EXPECT_EQ(lines(summary), 6u) << summary;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (!entry.is_directory()) continue;
    EXPECT_NE(content(entry.path() / "run.json").find("\"finished\": true"), std::string::npos)
        << entry.path();
  }

  const auto written = fs::last_write_time(folder / "hot" / "history.csv");
  ASSERT_EQ(granrun(scratch, "sweep " + sweep + " -o " + folder.string()).code, 0);
  EXPECT_EQ(fs::last_write_time(folder / "hot" / "history.csv"), written)
      << "finished cases are not run again";

  scratch.write(
      "bad.toml",
      "[sweep]\nscene = \"plug.toml\"\n[[vary]]\nkey = \"material.emissivity\"\nvalues = [0.4, 2]\n");
  EXPECT_EQ(granrun(scratch,
                    "sweep " + (scratch.root / "bad.toml").string() + " -o " + (scratch.root / "b").string())
                .code,
            2);
  EXPECT_FALSE(fs::exists(scratch.root / "b"));
}

TEST(GranrunExport, FramesReachOtherTools) {
  Scratch scratch;
  const auto scene =
      scratch.write("plug.toml", edited(small_plug, "step_s = 1e-5", "engine = \"none\"")).string();
  const auto folder = scratch.root / "case";
  ASSERT_EQ(granrun(scratch, "run " + scene + " -q -o " + folder.string()).code, 0);
  ASSERT_EQ(granrun(scratch, "export " + folder.string() + " --to dump").code, 0);
  ASSERT_EQ(granrun(scratch, "export " + folder.string() + " --to vtp").code, 0);
  const auto dump = content(folder / "export" / "f_000020000.dump");
  EXPECT_NE(dump.find("ITEM: ATOMS id type x y z radius"), std::string::npos);
  EXPECT_NE(content(folder / "export" / "f_000020000.vtp").find("<VTKFile type=\"PolyData\""),
            std::string::npos);
  // What was exported can start a scene again.
  const auto again =
      scratch
          .write("again.toml",
                 edited(edited(small_plug,
                               "[feed]\nkind = \"plug\"\nsolid_fraction = 0.25\nvelocity_m_s = 0.1\n"
                               "transverse_velocity_std_m_s = 0.02\nseed = 3\n",
                               ""),
                        "temperature_K = 300\n",
                        "temperature_K = 300\nfile = \"case/export/f_000020000.dump\"\n"))
          .string();
  const auto outcome = granrun(scratch, "check " + again);
  EXPECT_EQ(outcome.code, 0) << outcome.err;

  ASSERT_EQ(granrun(scratch, "report " + folder.string()).code, 0);
  const auto page = content(folder / "report.html");
  for (const char* text : {"<svg", "Wall-to-particle coefficients", "Profiles", "h_wp_W_m2K"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
}
