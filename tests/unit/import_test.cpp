// Particles and walls come in from CSV, LIGGGHTS and LAMMPS dumps and STL, and bad files are refused line by
// line.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "dem/io/snapshot.h"
#include "dem/mesh/import_stl.h"
#include "tests/source_dir.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;

class Import : public testing::Test {
 protected:
  fs::path write(const std::string& text, const std::string& name = "file") const {
    return folder_.write(name, text);
  }
  Bed read(const std::string& text, double radius_m = 0) const {
    return read_snapshot(write(text), radius_m).bed;
  }
  /// Problems of a bad file, each without the name of the file.
  std::vector<std::string> problems_of(const std::string& text, double radius_m = 0) const {
    try {
      read(text, radius_m);
    } catch (const InputError& error) {
      std::vector<std::string> problems = error.problems();
      for (auto& p : problems) p = p.substr((folder_ / "file").string().size());
      return problems;
    }
    return {};
  }
  std::string problem_of(const std::string& text, double radius_m = 0) const {
    const auto problems = problems_of(text, radius_m);
    return problems.size() == 1 ? problems[0] : "not exactly one problem";
  }
  TemporaryFolder folder_;
};

TEST_F(Import, CsvColumnsComeInAnyOrder) {
  const Bed bed = read(
      "\xEF\xBB\xBF# a comment\r\n radius, z ,y,x,color,vy,omegaz,temperature\r\n"
      "4e-4,3,2,1,blue,0.5,7,310\r\n\r\n+5e-4,-3,2,1e-3,,0,0,320");
  ASSERT_EQ(bed.size(), 2u);
  EXPECT_EQ(bed.id, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(bed.position_m[0], (Vec3{1, 2, 3}));
  EXPECT_EQ(bed.position_m[1], (Vec3{1e-3, 2, -3}));
  EXPECT_EQ(bed.radius_m[1], 5e-4);
  EXPECT_EQ(bed.velocity_m_s[0], (Vec3{0, 0.5, 0}));
  EXPECT_EQ(bed.angular_velocity_rad_s[0], (Vec3{0, 0, 7}));
  EXPECT_EQ(bed.temperature_K[1], 320);
  EXPECT_EQ(bed.next_id, 3);
  EXPECT_EQ(read("x,y,z,diameter\n0,0,0,8e-4\n").radius_m[0], 4e-4);
  EXPECT_EQ(read("x,y,z\n0,0,0\n", 4e-4).radius_m[0], 4e-4);
  EXPECT_EQ(read("\"x\",\"y\",\"z\",\"radius\"\n0,0,0,8e-4\n").radius_m[0], 8e-4);
  EXPECT_EQ(read("x,y,z,radius\n").size(), 0u);
  EXPECT_FALSE(read_snapshot(write("x,y,z,radius\n0,0,0,1\n")).has_temperature);
}

TEST_F(Import, BadCsvIsRefusedLineByLine) {
  const std::string header = "id,x,y,z,radius,temperature\n";
  EXPECT_EQ(problem_of(""), ": is empty; its first line must be x,y,z,radius");
  EXPECT_EQ(problem_of("x;y;z;radius\n"),
            ":1: \"x;y;z;radius\" (columns are separated by commas: x,y,z,radius); replace ';'");
  EXPECT_EQ(problem_of("x\ty\tz\tradius\n"),
            ":1: \"x\ty\tz\tradius\" (columns are separated by commas: x,y,z,radius); replace '\\t'");
  EXPECT_EQ(problem_of("x,y,radius\n"), ":1: no column z (columns are x, y, radius)");
  EXPECT_EQ(problem_of("x,y,z\n1,2,3\n"),
            ":1: no column radius (columns are x, y, z); add it, or give the radius of all particles");
  EXPECT_EQ(problem_of("x,x,y,z,radius\n"), ":1: column x is given twice");
  EXPECT_EQ(problem_of(header + "1,0,0,0,1,300\n2,0,abc,0,1,300\n"), ":3: y = abc (must be a finite number)");
  EXPECT_EQ(problem_of(header + "1,0,,0,1,300\n"), ":2: y = nothing (must be a finite number)");
  EXPECT_EQ(problem_of(header + "1,nan,0,0,1,300\n"), ":2: x = nan (must be a finite number)");
  EXPECT_EQ(problem_of(header + "1,0,0,inf,1,300\n"), ":2: z = inf (must be a finite number)");
  EXPECT_EQ(problem_of(header + "1,0,0,1e999,1,300\n"), ":2: z = 1e999 (must be a finite number)");
  EXPECT_EQ(problem_of(header + "1,0,0,0,0,300\n"), ":2: radius = 0 (must be > 0)");
  EXPECT_EQ(problem_of(header + "1,0,0,0,1,-3\n"), ":2: temperature = -3 (must be > 0)");
  EXPECT_EQ(problem_of(header + "1.5,0,0,0,1,300\n"), ":2: id = 1.5 (must be a whole number >= 0)");
  EXPECT_EQ(problem_of(header + "1,0,0,0,1\n"), ":2: 5 values (the header names 6 columns)");
  EXPECT_EQ(problem_of(header + "4,0,0,0,1,300\n4,1,0,0,1,300\n"),
            ":3: id = 4 (also on line 2); ids must differ");
  std::string many = header;
  for (int k = 0; k < 25; ++k) many += "1,0,0,bad,1,300\n";
  const auto problems = problems_of(many);
  ASSERT_EQ(problems.size(), 21u);
  EXPECT_EQ(problems[19], ":21: z = bad (must be a finite number)");
  EXPECT_EQ(problems[20], ": and 5 more problems");
  EXPECT_THROW(read_snapshot(folder_ / "none.csv"), IoError);
  EXPECT_THROW(read_snapshot(folder_), IoError);
}

const std::string dump_head =
    "ITEM: TIMESTEP\n700\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp ff ff\n0 2\n-1 1\n0 4\n";

TEST_F(Import, DumpColumnsComeByName) {
  const Bed bed = read(dump_head +
                       "ITEM: ATOMS id type x y z vx vy vz radius f_Temp[0] c_cn \n"
                       "9 1 0.5 0.1 1 1 2 3 0.1 320 4\n2 1 1.5 0.1 1 0 0 0 0.2 310 4\n");
  EXPECT_EQ(bed.id, (std::vector<std::int64_t>{2, 9}));
  EXPECT_EQ(bed.radius_m, (std::vector<double>{0.2, 0.1}));
  EXPECT_EQ(bed.temperature_K, (std::vector<double>{310, 320}));
  EXPECT_EQ(bed.velocity_m_s[1], (Vec3{1, 2, 3}));
  EXPECT_EQ(bed.step, 700);
  EXPECT_EQ(bed.next_id, 10);
  EXPECT_EQ(bed.periodic, (std::array<bool, 3>{true, false, false}));
  EXPECT_EQ(bed.box.max, (Vec3{2, 1, 4}));
  const Bed scaled = read(dump_head + "ITEM: ATOMS id xs ys zs\n1 0.5 0.25 0.125\n2 0 0 1\n", 0.1);
  EXPECT_EQ(scaled.position_m[0], (Vec3{1, -0.5, 0.5}));
  EXPECT_EQ(scaled.position_m[1], (Vec3{0, -1, 4}));
  EXPECT_EQ(read(dump_head + "ITEM: ATOMS id xu yu zu\n1 2.5 0 0\n2 0 0 1\n", 0.1).position_m[0].x, 2.5);
  const Bed unwrapped = read(dump_head + "ITEM: ATOMS id xsu ysu zsu\n1 1.5 0.25 0.125\n2 0 0 1\n", 0.1);
  EXPECT_EQ(unwrapped.position_m[0], (Vec3{3, -0.5, 0.5}));
  const Bed both =
      read(dump_head + "ITEM: ATOMS id xu x xs y ys z zu\n1 9 1 9 0 9 0 9\n2 9 1 9 0 9 1 9\n", 0.1);
  EXPECT_EQ(both.position_m[1], (Vec3{1, 0, 1})) << "x before xu and xs";
  const Bed upright = read(
      "ITEM: UNITS\nsi\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS xy xz yz pp ff pp\n"
      "0 2 0\n-1 1 0.0\n0 4 0\nITEM: ATOMS id x y z\n1 0 0 0\n",
      0.1);
  EXPECT_EQ(upright.periodic, (std::array<bool, 3>{true, false, true})) << "tilted by nothing";
  EXPECT_EQ(upright.box.max, (Vec3{2, 1, 4}));
  const std::string first = dump_head + "ITEM: ATOMS id x y z\n1 0 0 0\n2 0 0 1\n";
  const Bed last = read(first + "ITEM: TIME\n0.7\n" +
                            "ITEM: TIMESTEP\n800\nITEM: NUMBER OF ATOMS\n1\n"
                            "ITEM: BOX BOUNDS ff ff ff\n0 2\n-1 1\n0 4\nITEM: ATOMS id x y z\n5 0 0 3\n",
                        0.1);
  EXPECT_EQ(last.id, std::vector<std::int64_t>{5}) << "the last snapshot of the file";
  EXPECT_EQ(last.step, 800);
  EXPECT_EQ(last.time_s, 0.7);
}

TEST_F(Import, BadDumpsAreRefused) {
  const std::string atoms = "ITEM: ATOMS id x y z radius\n";
  EXPECT_EQ(problem_of("ITEM: TIMESTEP\n1\n"),
            ":2: the snapshot is cut short: the file ends before ITEM: ATOMS");
  EXPECT_EQ(problem_of(dump_head + atoms + "1 0 0 0 1\n"), ":10: the snapshot is cut short: 1 of 2 atoms");
  EXPECT_EQ(problem_of(dump_head + atoms + "1 0 0 0 1\n2 0 0\n"),
            ":11: 3 values (the header names 5 columns)");
  EXPECT_EQ(problem_of(dump_head + atoms + "1 0 0 0 1\n2 0 0 nan 1\n"),
            ":11: z = nan (must be a finite number)");
  EXPECT_EQ(problem_of(dump_head + atoms + "1 0 0 0 1\n2 0 0 1 1\n3 0 0 2 1\n"),
            ":12: \"3 0 0 2 1\" (expected a line that starts with \"ITEM: \")");
  EXPECT_EQ(problem_of(dump_head + "ITEM: ATOMS id x y z\n1 0 0 0\n2 0 0 1\n"),
            ":9: no column radius (columns are id, x, y, z); add it, or give the radius of all particles");
  EXPECT_EQ(problem_of("ITEM: ATOMS id x y z\n"), ":1: ITEM: ATOMS stands before ITEM: NUMBER OF ATOMS");
  EXPECT_EQ(problem_of("ITEM: NUMBER OF ATOMS\nmany\n"),
            ":2: the number of atoms = \"many\" (must be a number >= 0)");
  EXPECT_EQ(problem_of("ITEM: BOX BOUNDS xy xz yz pp pp pp\n0 1 0\n0 1 0.5\n"),
            ":3: \"0 1 0.5\" (the box is tilted: only upright boxes are read); give x,y,z,radius as CSV");
  EXPECT_EQ(problem_of("ITEM: UNITS\ncgs\n"),
            ":2: units = \"cgs\" (lengths must be in metres); convert the dump to SI");
  EXPECT_EQ(problem_of("ITEM: BOX BOUNDS pp pp pp\n2 1\n"),
            ":2: \"2 1\" (box bounds must be two rising numbers)");
}

TEST_F(Import, TheReferenceDumpIsRead) {
  const Bed bed = read_snapshot(granrad::source_dir() + "/data/reference/snapshot_outlet_4x4.dump", 4e-4).bed;
  EXPECT_EQ(bed.size(), 10376u);
  EXPECT_EQ(bed.step, 130000);
  EXPECT_EQ(bed.radius_m[0], 4e-4);
  EXPECT_TRUE(std::is_sorted(bed.id.begin(), bed.id.end()));
  const auto at = bed.index_of(7852);
  ASSERT_GE(at, 0);
  EXPECT_EQ(bed.position_m[at], (Vec3{0.0128667, 0.00834203, 0.0666277}));
  EXPECT_EQ(bed.angular_velocity_rad_s[at], (Vec3{5.01503, 5.40672, -1.6048}));
}

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c +
         "\nendloop\nendfacet\n";
}

TEST_F(Import, StlKeepsSolidsAndMergesVertices) {
  const std::string square = facet("0 0 0", "10 0 0", "10 10 0") + facet("0 0 0", "10 10 0", "0 10 0");
  const auto one = import_stl(write("solid a\n" + square + "endsolid a\n", "one.stl"), 0.001, "wall");
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].name, "wall");
  EXPECT_EQ(one[0].vertices.size(), 4u);
  EXPECT_EQ(one[0].triangles.size(), 2u);
  EXPECT_NEAR(area(one[0]), 1e-4, 1e-12);
  const auto two = import_stl(
      write("solid a\n" + square + "endsolid a\nsolid b\n" + square + "endsolid b\n", "two.stl"), 1, "wall");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].name, "wall.a");
  EXPECT_EQ(two[1].name, "wall.b");
}

// Single precision moves the corners by up to 4e-6 m here, and particles at the wall lie behind it.
TEST_F(Import, TextStlKeepsItsDigitsFarFromTheOrigin) {
  const auto walls = import_stl(
      write("SOLID a\r\n" + facet("100.0001 100 +100", "100.01 1.00004e2 100", "100 100.01 100") +
                facet("100.0001 100 100", "100 100.01000000000001 100", "100 100.02 100") + "endsolid a\n",
            "far.stl"),
      1, "w");
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_EQ(walls[0].vertices.size(), 4u) << "the last digit of a corner aside, it is one";
  EXPECT_EQ(walls[0].vertices[0], (Vec3{100.0001, 100, 100}));
  EXPECT_EQ(walls[0].vertices[1], (Vec3{100.01, 100.004, 100}));
}

TEST_F(Import, BinaryStlIsRead) {
  std::string bytes(80, ' ');
  const std::uint32_t count = 1;
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  const float facet_data[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 0};
  bytes.append(reinterpret_cast<const char*>(facet_data), sizeof facet_data);
  bytes.append(2, '\0');
  const auto walls = import_stl(write(bytes, "binary.stl"), 1, "wall");
  ASSERT_EQ(walls.size(), 1u);
  EXPECT_DOUBLE_EQ(area(walls[0]), 1);
  bytes.replace(0, 12, "solid by CAD");
  EXPECT_DOUBLE_EQ(area(import_stl(write(bytes + std::string(30, '\0'), "more.stl"), 1, "wall")[0]), 1)
      << "what follows the last triangle is no triangle";
  try {
    import_stl(write(bytes.substr(0, 100), "cut.stl"), 1, "wall");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("cut short: 0 of 1 triangles"), std::string::npos)
        << error.what();
  }
}

TEST_F(Import, BadStlIsRefused) {
  EXPECT_THROW(import_stl(folder_ / "none.stl", 1, "w"), IoError);
  EXPECT_THROW(import_stl(write("hello", "text.stl"), 1, "w"), InputError);
  EXPECT_THROW(import_stl(write("", "empty.stl"), 1, "w"), InputError);
  const auto refused = [&](const std::string& text, const std::string& why) {
    try {
      import_stl(write(text, "bad.stl"), 1, "w");
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  const std::string good = facet("0 0 0", "1 0 0", "0 1 0");
  refused("solid a\n" + facet("0 0 0", "1 0 0", "nan 1 0") + "endsolid a\n", ":6: vertex coordinate = nan");
  refused("solid a\n" + facet("0 0 0", "1 0 0", "0 1") + "endsolid a\n",
          ":6: a vertex must be three numbers");
  refused("solid a\n" + good, "cut short");
  refused("solid a\nfacet\nvertex 0 0 0\nendfacet\n", ":4: a facet must have three vertices");
  refused("solid a\n" + good + "sphere\n", ":9: is not a line");
  refused("x,y,z,radius\n", "is not an STL file");
  refused("solid a\nendsolid a\n", "has no triangles");
  refused("solid a\n" + facet("0 0 0", "1 0 0", "2 0 0") + "endsolid a\n", "no triangle has an area");
}

}  // namespace
}  // namespace granrad
