// Requirement: granrun measure finds the conductivity of beds whose conductivity is known, and a run obeys it.
#include <cmath>
#include <nlohmann/json.hpp>

#include "coupling/results/results.h"
#include "coupling/simulation/history.h"
#include "granrun.h"
#include "tests/record.h"

using namespace granrad;
using namespace granrad::cli;

namespace {

/// Two plates across y, 20 diameters of 0.8 mm apart, periodic at the sides; gas lenses alone conduct.
const std::string slab = R"([scene]
name = "slab"
end_time_s = 30
)" + scene_text::alumina +
                         R"([gas]
conductivity_W_mK = 0.2
lens_radius_ratio = 1.6
[particles]
diameter_m = "0.8 mm"
temperature_K = 300
[box]
size_m = [0.0064, 0.016, 0.0064]
periodic = ["x", "z"]
[walls.y_min]
role = "isothermal"
temperature_K = 400
[walls.y_max]
role = "isothermal"
temperature_K = 400
[feed]
kind = "plug"
solid_fraction = 0.55
velocity_m_s = 0.1
[dem]
engine = "none"
[conduction]
solid = false
[output]
every_s = 0.25
frames_every_s = 30
)";

nlohmann::json measured(Scratch& scratch, const std::string& arguments) {
  const auto folder = scratch.root / "measure";
  fs::remove_all(folder);
  const auto outcome =
      granrun(scratch, "measure conductivity " + arguments + " --between y -o " + folder.string());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome.code == 0 ? nlohmann::json::parse(content(folder / "measure.json")) : nlohmann::json{};
}

}  // namespace

// Every sphere of a cubic lattice of 4 x 4 chains carries the same heat: k = G d / d^2 exactly. Planted: planes counted
// once a pair instead of by the part between them.
TEST(GranrunMeasure, ChainsConductAsTheirContacts) {
  Scratch scratch;
  const double d = 0.001;
  std::string csv = "x,y,z,radius\n";
  char line[128];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      for (int k = 0; k < 12; ++k) {
        std::snprintf(line, sizeof line, "%.9g,%.9g,%.9g,%.9g\n", (i + 0.5) * d, (k + 0.5) * d, (j + 0.5) * d,
                      d / 2);
        csv += line;
      }
  scratch.write("chains.csv", csv);
  auto text = edited(slab, "size_m = [0.0064, 0.016, 0.0064]", "size_m = [0.004, 0.012, 0.004]");
  text = edited(text, "diameter_m = \"0.8 mm\"\n", "file = \"chains.csv\"\n");
  text = edited(text, "[feed]\nkind = \"plug\"\nsolid_fraction = 0.55\nvelocity_m_s = 0.1\n", "");
  text = edited(text, "lens_radius_ratio = 1.6", "lens_radius_ratio = 1.2");
  const auto json = measured(scratch, scratch.write("chains.toml", text).string());
  // At contact and d = 0.8 mm the lens is 28.1515707342 R k_g; at 1 mm the minimum gap is smaller against R, so the
  // conductance comes from the ratio of the layers themselves: plate to plate, 11 pairs and 2 walls in series.
  const double k = json.at("k_W_mK"), overall = json.at("k_overall_W_mK"),
               R = json.at("wall_resistance_m2K_W");
  EXPECT_NEAR(json.at("k_gas_W_mK").get<double>(), k, 1e-9 * k);
  EXPECT_NEAR(0.012 / overall, 0.012 / k + 2 * R, 1e-6 * 0.012 / overall) << "bulk and two layers in series";
  record("chains_in_series", 0.012 / overall / (0.012 / k + 2 * R));
  EXPECT_LT(json.at("k_W_mK_error").get<double>(), 1e-6 * k) << "all columns are equal";
  // A lid out of reach: k would be a slope that only rounding makes. Planted: not asked, k comes with exit code 0.
  const auto apart = granrun(scratch, "measure conductivity " + (scratch.root / "chains.toml").string() +
                                          " --between y --set 'box.size_m=[0.004, 0.015, 0.004]' -o " +
                                          (scratch.root / "apart").string());
  EXPECT_EQ(apart.code, 2);
  EXPECT_NE(apart.err.find("does not reach both"), std::string::npos) << apart.err;
  const double lens = k * d / (0.2 * d / 2);  // G = k d of one chain in its square
  EXPECT_NEAR(lens, 28.15 + 0.45, 0.3) << "near the exact 28.15 of 0.8 mm, and growing slowly with d";
}

TEST(GranrunMeasure, NusseltNumberOfARunIsThatOfSlugFlowAtTheMeasuredConductivity) {
  Scratch scratch;
  const auto scene = scratch.write("slab.toml", slab).string();
  const auto json = measured(scratch, scene);
  const double L = 0.016, k = json.at("k_W_mK"), R = json.at("wall_resistance_m2K_W");
  ASSERT_EQ(granrun(scratch, "run " + scene + " -q -o " + (scratch.root / "run").string()).code, 0);
  const auto history = read_history(scratch.root / "run" / "history.csv");
  const double nusselt = summarise(history).mean("h_wp_W_m2K") * 2 * L / k;
  // x tan x = L / (2 k R), by bisection.
  double low = 0, high = 1.5707963;
  for (int n = 0; n < 60; ++n) {
    const double x = 0.5 * (low + high);
    (x * std::tan(x) < L / (2 * k * R) ? low : high) = x;
  }
  const double exact = 4 * low * low;
  EXPECT_GT(exact, 5) << "the layers do not decide";
  EXPECT_NEAR(nusselt / exact, 1, 0.02);
  record("nusselt_over_slug", nusselt / exact, json.at("k_W_mK_error").get<double>() / k);
}

TEST(GranrunMeasure, RefusesWhatHasNoPlatesOrNoBulk) {
  Scratch scratch;
  const auto scene = scratch.write("slab.toml", slab).string();
  const auto refused = [&](const std::string& options, const std::string& why) {
    const auto outcome =
        granrun(scratch, "measure conductivity " + scene + " -o " + (scratch.root / "no").string() + options);
    EXPECT_EQ(outcome.code, 2) << options;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(scratch.root / "no")) << options;
  };
  refused(" --between x", "there is no wall x_min");
  refused(" --between y --set 'box.size_m=[0.0064, 0.004, 0.0064]'", "diameters lie between the plates");
  refused(" --between y --set walls.y_min.contact=false --set walls.y_max.contact=false", "touches a plate");
  refused(" --between q", "q");
}
