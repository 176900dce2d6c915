// Particles come in as other programs write them: names of columns that are nearly ours, several snapshots in a
// file, files that are being written, XYZ, gzip; and what our exports wrote comes back as it was.
// Made to see: a component of v taken for another; type taken for material; the cut snapshot read.
#include <cstdlib>

#include "dem/base/random.h"
#include "dem/io/export_text.h"
#include "tests/unit/import_fixture.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;

TEST_F(ImportFormats, NamesThatDifferInWritingAreTheSameQuantity) {
  for (const char* name : {"Temperature", "temp", "TEMP", "T", "t", "f_Temp", "f_Temp[0]", "f_Temp[1]",
                           "temperature_K", "T_K", "Temp (K)", "c_temp[3]", "v_Temp", "v_T", "f_T"}) {
    const Snapshot one = read(std::string("x,y,z,radius,") + name + "\n0,0,0,1,500\n");
    EXPECT_TRUE(one.has_temperature) << name;
    EXPECT_EQ(one.bed.temperature_K[0], 500) << name;
  }
  const Bed bed =
      read("Points:0,Points:1,Points:2,R,v:0,v:1,velocity_z,omega_x,wy,Omega:2\n1,2,3,4,5,6,7,8,9,10\n").bed;
  EXPECT_EQ(bed.position_m[0], (Vec3{1, 2, 3}));
  EXPECT_EQ(bed.radius_m[0], 4);
  EXPECT_EQ(bed.velocity_m_s[0], (Vec3{5, 6, 7}));
  EXPECT_EQ(bed.angular_velocity_rad_s[0], (Vec3{8, 9, 10}));
  EXPECT_EQ(read("X,Y,Z,Diameter_m\n0,0,0,8e-4\n").bed.radius_m[0], 4e-4);
  // a column of its own is not ours, however it begins
  EXPECT_EQ(read("x,y,z,radius,fx,fy,ix,tqx,mass,density,f_heatFlux,type\n0,0,0,1,9,9,9,9,9,9,9,1\n")
                .bed.velocity_m_s[0],
            Vec3{});
}

TEST_F(ImportFormats, NamesThatAreNearlyOursAreMetWithASuggestion) {
  expect_says(refusal("x,y,z,radius,temprature\n0,0,0,1,500\n"),
              ":1: column temprature is not known; did you mean temperature?");
  expect_says(refusal("x,y,z,radius,temperature_C\n0,0,0,1,25\n"), "did you mean temperature?");
  for (const char* name : {"T_C", "T (C)", "T [degC]", "Tp", "T_particle"})
    expect_says(refusal(std::string("x,y,z,radius,") + name + "\n0,0,0,1,25\n"), "did you mean temperature?");
  expect_says(refusal("x,y,z,radius_mm\n0,0,0,0.4\n", 4e-4), "did you mean radius?");
  expect_says(refusal("x,y,z,Radus\n0,0,0,0.4\n", 4e-4), "did you mean radius?");
  expect_says(refusal("x,y,z,radius,f_Temp[1],f_Temp[2]\n0,0,0,1,300,400\n"),
              "columns f_Temp[1] and f_Temp[2] could both be the temperature");
  EXPECT_EQ(refusal("x,y,z,radius,temperature,temperature_C\n0,0,0,1,300,27\n"), "read")
      << "the quantity is there";
  expect_says(refusal("x,y,z,radius,shapex,shapey,shapez,blockiness1\n0,0,0,1,1,1,2,2\n"),
              "superquadrics (only spheres");
  expect_says(refusal("x,y,z,radius,id_multisphere\n0,0,0,1,1\n"), "clumps of spheres");
}

const std::string head = "ITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 2\n-1 1\n0 4\n";

TEST_F(ImportFormats, ATypeCountsMaterialsFromOne) {
  const Snapshot one = read("ITEM: TIMESTEP\n5\n" + head + "ITEM: ATOMS id type x y z radius\n1 2 0 0 0 1\n");
  EXPECT_TRUE(one.has_types);
  EXPECT_EQ(one.bed.material[0], 1);
  expect_says(refusal("ITEM: TIMESTEP\n5\n" + head + "ITEM: ATOMS id type x y z radius\n1 0 0 0 0 1\n"),
              "type = 0 (must be a type number, from 1)");
}

std::string snapshot(int step, double x) {
  return "ITEM: TIMESTEP\n" + std::to_string(step) + "\n" + head + "ITEM: ATOMS id x y z radius\n1 " +
         std::to_string(x) + " 0 0 1\n";
}

TEST_F(ImportFormats, OneOfSeveralSnapshotsIsChosen) {
  const fs::path file = folder_.write("three", snapshot(10, 1) + snapshot(20, 2) + snapshot(30, 3));
  const SnapshotFile all(file);
  EXPECT_EQ(all.steps(), (std::vector<std::int64_t>{10, 20, 30}));
  using Kind = SnapshotChoice::Kind;
  EXPECT_EQ(read_snapshot(file, 0, {Kind::first}).bed.position_m[0].x, 1);
  EXPECT_EQ(read_snapshot(file, 0, {Kind::step, 20}).bed.position_m[0].x, 2);
  EXPECT_EQ(read_snapshot(file).bed.position_m[0].x, 3);
  EXPECT_THROW(read_snapshot(file, 0, {Kind::step, 25}), InputError);
}

TEST_F(ImportFormats, ADumpThatIsBeingWrittenGivesItsLastWholeSnapshot) {
  const std::string whole = snapshot(10, 1) + snapshot(20, 2);
  EXPECT_TRUE(read(whole).note.empty());
  const std::string next = snapshot(30, 3);
  for (std::size_t cut = 1; cut < next.size();
       ++cut) {  // in the header, between, in the row, before its newline
    const Snapshot last = read(whole + next.substr(0, cut));
    EXPECT_EQ(last.bed.step, 20) << cut;
    if (cut > 1) expect_says(last.note, "the last snapshot is not whole");
  }
  expect_says(refusal(snapshot(10, 1).substr(0, 60)), "cut short");
  expect_says(refusal("ITEM: TIMESTEP\n1\n" + head + "ITEM: ATOMS id x y z radius\nITEM: TIMESTEP\n2\n"),
              "cut short: 0 of 1");
}

TEST_F(ImportFormats, BlankAndCommentLinesMayStandFirst) {
  EXPECT_EQ(read("\n\n" + snapshot(10, 1)).bed.step, 10);
  EXPECT_EQ(read("\xEF\xBB\xBF# made by us\n \n" + snapshot(10, 1)).bed.step, 10);
  EXPECT_EQ(read("\n# comment\n\nx,y,z,radius\n\n1,2,3,4\n").bed.radius_m[0], 4);
}

TEST_F(ImportFormats, GzipIsUnpacked) {
  const fs::path file = folder_.write("bed.dump", snapshot(10, 1));
  ASSERT_EQ(std::system(("gzip " + file.string()).c_str()), 0);
  EXPECT_EQ(read_snapshot(file.string() + ".gz").bed.step, 10);
  EXPECT_THROW(read("\x1f\x8b garbage"), IoError);
}

TEST_F(ImportFormats, WhatIsNoneOfTheFormatsIsToldWhichThereAre) {
  for (const char* text :
       {"hello world\n", "PK\x03\x04zip", "BZh9", "{\"a\": 1}", "solid a\nendsolid a\n", "ply\nformat"})
    expect_says(refusal(text), "read are: frames of granrun (.hdf), CSV");
}

TEST_F(ImportFormats, Xyz) {
  const Bed plain = read("2\nany comment\nAl 1 2 3\nO 4 5 6\n", 0.5).bed;
  EXPECT_EQ(plain.position_m[1], (Vec3{4, 5, 6}));
  const std::string first =
      "1\nLattice=\"2 0 0 0 3 0 0 0 4\" Origin=\"-1 0 0\" Properties=species:S:1:pos:R:3:radius:R:1:velo:R:3:Temperature:R:1 "
      "Time=0.25 Timestep=7 pbc=\"T F F\"\nAl 0.5 1 2 0.1 4 5 6 700\n";
  const Bed bed = read(first).bed;
  EXPECT_EQ(bed.position_m[0], (Vec3{0.5, 1, 2}));
  EXPECT_EQ(bed.velocity_m_s[0], (Vec3{4, 5, 6}));
  EXPECT_EQ(bed.radius_m[0], 0.1);
  EXPECT_EQ(bed.temperature_K[0], 700);
  EXPECT_EQ(bed.time_s, 0.25);
  EXPECT_EQ(bed.step, 7);
  EXPECT_EQ(bed.box.min, (Vec3{-1, 0, 0}));
  EXPECT_EQ(bed.box.max, (Vec3{1, 3, 4}));
  EXPECT_EQ(bed.periodic, (std::array<bool, 3>{true, false, false}));
  EXPECT_EQ(read(first + "1\nProperties=pos:R:3:radius:R:1 Timestep=8\n1 1").bed.step, 7)
      << "the second is cut";
  expect_says(refusal("1\nLattice=\"2 1 0 0 3 0 0 0 4\"\nAl 0 0 0\n", 1), "tilted");
  expect_says(refusal("1\nProperties=pos:R\nAl 0 0 0\n", 1), "Properties");
  expect_says(refusal("2\n\nAl 0 0 0\n", 1), "cut short");
}

Bed random_bed(std::size_t n) {
  Bed bed;
  bed.box = {{-1, 0, 0.1}, {1, 1 / 3.0, 2}};
  bed.periodic = {true, false, false};
  bed.step = 12345;
  bed.time_s = 0.1 + 0.2;
  auto uniform = [k = std::uint64_t{0}]() mutable { return random_uniform2(3, 1, k++)[0]; };
  for (std::size_t i = 0; i < n; ++i) {
    bed.next_id += i % 2;
    bed.add({5 * uniform() - 2, -uniform(), uniform() * 1e-300}, {uniform(), -0.0, 1e300}, uniform() + 1e-9,
            300 + uniform(), static_cast<std::int32_t>(i % 3));
    bed.angular_velocity_rad_s.back() = {uniform(), uniform(), 1 / 3.0};
    bed.radiative_heat_W.back() = -uniform();
  }
  return bed;
}

TEST_F(ImportFormats, WhatWasExportedComesBackAsItWas) {
  const Bed bed = random_bed(50);
  for (const auto& [text, kind] :
       {std::pair{dump_text(bed), "dump"}, {vtp_text(bed), "vtp"}, {csv_text(bed), "csv"}}) {
    const Bed back = read(text).bed;
    ASSERT_EQ(back.size(), bed.size()) << kind;
    EXPECT_EQ(back.id, bed.id) << kind;
    EXPECT_EQ(back.material, bed.material) << kind;
    EXPECT_EQ(back.radius_m, bed.radius_m) << kind;
    EXPECT_EQ(back.velocity_m_s, bed.velocity_m_s) << kind;
    EXPECT_EQ(back.angular_velocity_rad_s, bed.angular_velocity_rad_s) << kind;
    EXPECT_EQ(back.temperature_K, bed.temperature_K) << kind;
    EXPECT_EQ(back.radiative_heat_W, bed.radiative_heat_W) << kind;
    for (std::size_t i = 0; i < bed.size(); ++i)
      EXPECT_EQ(back.position_m[i], wrapped_into_box(bed, bed.position_m[i])) << kind;
    if (kind == std::string("csv")) continue;
    EXPECT_EQ(back.periodic, bed.periodic) << kind;
    EXPECT_EQ(back.box.min, bed.box.min) << kind;
    EXPECT_EQ(back.box.max, bed.box.max) << kind;
    EXPECT_EQ(back.step, bed.step) << kind;
  }
  EXPECT_EQ(read(vtp_text(bed)).bed.time_s, bed.time_s);
}

}  // namespace
}  // namespace granrad
