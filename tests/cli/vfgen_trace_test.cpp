// What vfgen trace and measure make of a bed, what they say of it, and the files they write.
#include "tests/cli/vfgen_fixture.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include "dem/base/files/hdf5_file.h"
#include "raytrace/exact.h"
#include "raytrace/rays/view_factor_file.h"
#include "tests/scene_text.h"
#include "tests/source_dir.h"

namespace granrad::vfgen_test {
namespace {

const std::string source_dir = granrad::source_dir();

// 4 sigma of 1e5 rays from each of two spheres at d* = 1.5; a wrong emission law is caught by raytrace's own
// tests.
TEST_F(Vfgen, TracesTwoSpheresInABox) {
  expect_says(
      vfgen("trace " + two_spheres() + " -o " + path("two.h5") + " --rays 100000 --box 0.01,0.004,0.004"), 0,
      "self-check passed");
  const auto file = granrad::read_view_factors(path("two.h5"));
  ASSERT_EQ(file.enclosure.sphere_count(), 2u);
  ASSERT_EQ(file.enclosure.walls.size(), 6u);
  EXPECT_EQ(file.enclosure.walls[5].name, "z_max");
  const double exact = granrad::exact_two_sphere(0.0004, 0.0004, 0.0012);
  const double found = file.closed.value[file.closed.pattern.row_begin[0]] / file.closed.area_m2[0];
  EXPECT_EQ(file.closed.pattern.column[file.closed.pattern.row_begin[0]], 1);
  EXPECT_NEAR(found, exact, 4 * std::sqrt(exact / 2e5));
}

TEST_F(Vfgen, SaysWhatAnErrorCost) {
  const auto csv = two_spheres();
  for (const char* method : {"embree", "lines"}) {
    const auto outcome =
        vfgen("trace " + csv + " -o " + path("e.h5") +
              " --error 0.03 --hot-walls y_min,y_max --box 0.01,0.004,0.004 --method " + method);
    expect_says(outcome, 0, "of the particle fluxes from y_min,y_max (3 % asked for)");
    EXPECT_EQ(outcome.text.find('\r'), std::string::npos);
    const auto file = granrad::read_view_factors(path("e.h5"));
    EXPECT_LE(file.spent.error, 0.03);
    EXPECT_GT(file.spent.error, 0);
    EXPECT_GT(file.spent.rays, 0);
    EXPECT_GE(file.spent.rounds, 1);
    EXPECT_EQ(file.error_target, 0.03);
    EXPECT_EQ(file.hot_walls, "y_min,y_max");
    EXPECT_EQ(file.sampling, method == std::string("lines") ? "lines" : "sobol");
    const granrad::Hdf5Reader raw(path("e.h5"));
    const auto bound = raw.read<double>("/view_factors/zero_hit_bound");
    EXPECT_EQ(bound, granrad::zero_hit_bound(file.counts));
    EXPECT_EQ(bound.back(), 1);  // the surroundings send no rays
  }
  expect_says(vfgen("trace " + csv + " -o " + path("r.h5") + " --rays 200 --sampling random"), 0, "spent");
  EXPECT_EQ(granrad::read_view_factors(path("r.h5")).sampling, "random");
}

/// A box of 10 x 4 x 4 mm as an STL of two solids; inward normals, each solid turned round on demand.
std::string box_stl(bool turn_sides, bool turn_ends, bool without_first) {
  const double x = 0.01, y = 0.004, z = 0.004;
  const std::vector<std::array<std::array<double, 3>, 4>> faces = {
      {{{0, 0, 0}, {0, y, 0}, {0, y, z}, {0, 0, z}}}, {{{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}}},
      {{{0, 0, 0}, {0, 0, z}, {x, 0, z}, {x, 0, 0}}}, {{{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}}},
      {{{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}}}, {{{0, 0, z}, {0, y, z}, {x, y, z}, {x, 0, z}}}};
  std::ostringstream text;
  for (std::size_t f = 0; f < 6; ++f) {
    if (f == 0) text << "solid sides\n";
    if (f == 4) text << "endsolid sides\nsolid ends\n";
    for (std::size_t t = without_first && f == 0 ? 1 : 0; t < 2; ++t) {
      std::array<std::size_t, 3> corner{0, t + 1, t + 2};
      if (f < 4 ? turn_sides : turn_ends) std::swap(corner[0], corner[2]);
      text << "facet normal 0 0 0\nouter loop\n";
      for (const auto c : corner)
        text << "vertex " << faces[f][c][0] << ' ' << faces[f][c][1] << ' ' << faces[f][c][2] << '\n';
      text << "endloop\nendfacet\n";
    }
  }
  text << "endsolid ends\n";
  return text.str();
}

TEST_F(Vfgen, TellsHowAnStlFitsTogether) {
  const auto traced = [&](bool turn_sides, bool turn_ends, bool without_first) {
    const auto stl = write("box.stl", box_stl(turn_sides, turn_ends, without_first));
    return vfgen("trace " + two_spheres() + " -o " + path("x.h5") + " --rays 1000 --walls " + stl);
  };
  expect_says(traced(false, false, false), 0, "12 triangles, closed, normals inward");
  const auto file = granrad::read_view_factors(path("x.h5"));
  ASSERT_EQ(file.enclosure.walls.size(), 2u);  // each solid is a wall, with rays in proportion to its area
  EXPECT_EQ(file.enclosure.walls[0].name, "walls.sides");
  EXPECT_EQ(file.enclosure.walls[1].name, "walls.ends");
  const auto density = [&](std::size_t i) {
    return static_cast<double>(file.counts.launched[i]) / file.counts.area_m2[i];
  };
  EXPECT_NEAR(density(2) / density(0), 1, 0.03);  // whole rays for each of 32 replicates
  EXPECT_NEAR(density(3) / density(0), 1, 0.03);
  expect_says(traced(false, false, true), 0, "not closed (3 open edges");
  // Turned to the particles, and said so: the same exchange as of the mesh that faces them.
  expect_says(traced(true, true, false), 0, "normals outward");
  expect_says(traced(true, true, false), 0, "wall walls.sides faced away from the particles and was turned");
  expect_says(traced(false, true, false), 0, "4 triangles turned to face as their neighbours");
  expect_says(traced(false, true, false), 0, "12 triangles, closed, normals inward");
  EXPECT_EQ(granrad::read_view_factors(path("x.h5")).counts.leaked, 0);
}

// Planted: the text taken for the name of a file, as it was (exit 3).
TEST_F(Vfgen, MeasureTakesMeshesInMillimetresToo) {
  const auto metres = write("metres.stl", box_stl(false, false, false));
  std::string small = box_stl(false, false, false);
  for (const char* number : {"0.004", "0.01"})
    for (std::size_t at = 0; (at = small.find(number, at)) != std::string::npos;)
      small.replace(at, std::string(number).size(), number == std::string("0.01") ? "10" : "4");
  const auto measured = [&](const std::string& walls) {
    const auto done = vfgen("measure " + two_spheres() + " --walls " + walls + " -o " + path("m") + " -q");
    EXPECT_EQ(done.code, 0) << done.text;
    std::ifstream in(path("m") + "/measure.json");
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const auto as_metres = measured(metres);
  EXPECT_GT(as_metres.size(), 100u);
  EXPECT_EQ(as_metres, measured(write("millimetres.stl", small) + ":0.001"));
}

// Planted: the time a trace took, written into the file.
TEST_F(Vfgen, SameBytesForAnyNumberOfThreads) {
  const auto bytes = [&](const std::string& name) {
    std::stringstream content;
    content << std::ifstream(path(name), std::ios::binary).rdbuf();
    return content.str();
  };
  for (const std::string method : {"embree", "lines"}) {
    for (const std::string threads : {"1", "2"})
      ASSERT_EQ(vfgen("trace " + two_spheres() + " -q -o " + path("t" + threads + ".h5") +
                      " --rays 1000 --box 0.01,0.004,0.004 --method " + method + " --threads " + threads)
                    .code,
                0);
    EXPECT_TRUE(bytes("t1.h5") == bytes("t2.h5")) << method;
  }
}

// A scalar text of variable length is a str in h5py, one of fixed length is bytes: format == "..." would
// fail.
TEST_F(Vfgen, AttributesAreTextsOfVariableLength) {
  ASSERT_EQ(vfgen("trace " + two_spheres() + " -q -o " + path("a.h5") + " --rays 10").code, 0);
  const auto dump = run("h5dump -a /format -a /method -a /failed " + path("a.h5"));
  ASSERT_EQ(dump.code, 0) << "h5dump is missing; apt-get install hdf5-tools";
  EXPECT_EQ(dump.text.find("STRSIZE 2"), std::string::npos) << dump.text;
  EXPECT_NE(dump.text.find("STRSIZE H5T_VARIABLE"), std::string::npos) << dump.text;
  EXPECT_EQ(granrad::read_view_factors(path("a.h5")).method, "embree");
}

// Planted: periods kept; the sphere beyond the box is folded back into it.
TEST_F(Vfgen, BoxEndsThePeriodsOfADump) {
  const auto dump =
      write("pp.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp ff\n0 0.01\n0 "
            "0.004\n0 0.004\nITEM: ATOMS id x y z\n1 0.002 0.002 0.002\n2 0.0032 0.002 0.002\n");
  const auto outcome =
      vfgen("trace " + dump + " --radius 4e-4 --box 0.003,0.004,0.004 --rays 1000 -o " + path("x.h5"));
  expect_says(outcome, 0, "1 particles with their centre outside the box were left out");
  const auto enclosure = granrad::read_view_factors(path("x.h5")).enclosure;
  EXPECT_EQ(enclosure.sphere_count(), 1u);
  EXPECT_EQ(enclosure.periodic, (std::array<bool, 3>{}));
}

// Planted: pairs of one size class alone, no periodic image, depth measured by the larger radius.
TEST_F(Vfgen, RemarksOnGrossOverlaps) {
  const auto tracing = [&](const std::string& file, const std::string& text) {
    return vfgen("trace " + write(file, text) + " --rays 10 -o " + path("x.h5"));
  };
  const std::string first = "x,y,z,radius\n0,0,0,1\n", far = "9,9,9,1\n";
  const auto deep = tracing("deep.csv", first + far + "1.4,0,0,1\n");
  expect_says(deep, 0, "deep.csv: 1 pair of particles, ids 1-3 overlap by more than half a radius");
  EXPECT_EQ(tracing("less.csv", first + far + "1.6,0,0,1\n").text.find("overlap"), std::string::npos);
  expect_says(tracing("small.csv", first + "1,0,0,0.1\n"), 0, "ids 1-2 overlap");
  EXPECT_EQ(tracing("poking.csv", first + "1.06,0,0,0.1\n").text.find("overlap"), std::string::npos);
  std::string row = "x,y,z,radius\n";
  for (int k = 0; k < 20; ++k) row += std::to_string(k) + ",0,0,1\n";
  expect_says(tracing("row.csv", row), 0, "19 pairs of particles, ids 1-2, 2-3, 3-4, 4-5, 5-6, ");
  expect_says(tracing("row.csv", row), 0, "10-11, ... overlap");

  fs::remove(path("x.h5"));
  const auto same = tracing("same.csv", first + far + "0,0,0,1\n9,9,9,0.5\n");
  expect_says(same, 2, "same.csv: 2 pairs of particles, ids 1-3, 2-4 are in the same place");
  EXPECT_FALSE(fs::exists(path("x.h5")));
  const auto periodic =
      write("pp.dump",
            "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n"
            "0 9\nITEM: ATOMS id x y z radius\n7 0.1 1 1 1\n4 8.9 1 1 1\n");
  expect_says(vfgen("trace " + periodic + " --rays 100 -o " + path("x.h5")), 0, "ids 4-7 overlap");
  // A radius in the wrong unit: everything overlaps, and it is said at once.
  std::string cloud = "x,y,z,radius\n";
  for (int k = 0; k < 3000; ++k) cloud += std::to_string(k) + ",0,0,5000\n";
  const auto text = tracing("cloud.csv", cloud).text;
  EXPECT_EQ(text.rfind("warning: ", 0), 0u) << text;
  EXPECT_NE(text.find("at least 100"), std::string::npos) << text;
}

TEST_F(Vfgen, AnErrorOutOfReachIsCode4) {
  expect_says(vfgen("trace " + two_spheres() + " --box 0.0101,0.0104,0.0204 --error 1e-6 -o " + path("x.h5")),
              4, "ask for less");
  EXPECT_FALSE(fs::exists(path("x.h5")));
}

// Tracing on until the most directions have missed it would take an hour: the suite's own limit ends it.
TEST_F(Vfgen, AnErrorOutOfReachOfLinesIsForeseen) {
  const auto outcome = vfgen("trace " + two_spheres() +
                             " --box 0.01,0.004,0.004 --method lines --error 1e-6 -o " + path("x.h5"));
  expect_says(outcome, 4, "error = 1e-06 (reached 0.0");
  expect_says(outcome, 4, "rays per particle, would need about");
  expect_says(outcome, 4, "the most are 1.6e+09, for about");
  EXPECT_FALSE(fs::exists(path("x.h5")));
}

}  // namespace
}  // namespace granrad::vfgen_test
