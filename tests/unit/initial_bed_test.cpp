// The bed a scene begins with: from a file or a frame, and refused where it cannot be.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "dem/base/error.h"
#include "dem/bed/wall_shape.h"
#include "dem/io/snapshot.h"
#include "dem/scene/scene.h"
#include "tests/source_dir.h"
#include "tests/temporary_folder.h"
#include "tests/unit/plug_scene.h"

namespace granrad {
namespace {

namespace fs = std::filesystem;
using namespace plug_scene_text;

Scene scene_from_file(const fs::path& file, const std::string& more = "") {
  return parse(general + material + "[particles]\ntemperature_K = 350\nfile = '" + file.string() + "'\n" +
               more + box);
}

TEST(InitialBed, TakesParticlesFromAFileSortedById) {
  const TemporaryFolder folder;
  const auto file =
      folder.write("bed.csv", "id,x,y,z,radius\n7,0.002,0.002,0.01,0.0004\n3,0.004,0.002,0.01,0.0003\n");
  const Bed bed = initial_bed(scene_from_file(file));
  EXPECT_EQ(bed.id, (std::vector<std::int64_t>{3, 7}));
  EXPECT_EQ(bed.radius_m, (std::vector<double>{0.0003, 0.0004}));
  EXPECT_EQ(bed.temperature_K, (std::vector<double>{350, 350})) << "the file has none";
  EXPECT_EQ(bed.next_id, 8);
  EXPECT_EQ(bed.walls.size(), 6u);
  EXPECT_EQ(bed.materials.size(), 1u);
}

// Planted: the plane of a face taken as endless: what stands in a hopper above the channel is refused.
TEST(InitialBed, AFaceBoundsOnlyAsFarAsItGoesBesideOtherWalls) {
  const TemporaryFolder folder;
  const std::string hopper =
      "[walls.z_max]\ncontact = false\n[[polygon]]\nname = \"hopper\"\nrole = \"adiabatic\"\n"
      "vertices_m = [[0.03, 0, 0.06], [0.03, 0.004, 0.06], [0.01, 0.004, 0.05], [0.01, 0, 0.05]]\n";
  const auto above = folder.write("above.csv", "x,y,z,radius\n0.012,0.002,0.055,0.0004\n");
  EXPECT_NO_THROW(initial_bed(scene_from_file(above, hopper))) << "wider than the channel below it";
  const auto beside = folder.write("beside.csv", "x,y,z,radius\n0.012,0.002,0.02,0.0004\n");
  EXPECT_THROW(initial_bed(scene_from_file(beside, hopper)), InputError);
}

TEST(InitialBed, RefusesParticlesOutsideTheWallsAndDeepOverlaps) {
  const TemporaryFolder folder;
  std::string rows = "x,y,z,radius\n";
  for (int k = 0; k < 12; ++k) rows += "0.011,0.002," + std::to_string(0.002 + 0.002 * k) + ",0.0004\n";
  try {
    initial_bed(scene_from_file(folder.write("outside.csv", rows)));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("12 particles lie outside the walls of the box, ids 1, 2, 3, 4, 5, 6, 7, 8, "
                        "9, 10, ..."),
              std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(
      initial_bed(scene_from_file(folder.write("outside.csv", rows), "[walls.x_max]\ncontact = false\n")));

  const std::string first = "x,y,z,radius\n0.002,0.002,0.01,0.0004\n";
  EXPECT_NO_THROW(
      initial_bed(scene_from_file(folder.write("ok.csv", first + "0.00277,0.002,0.01,0.0004\n"))));
  try {
    initial_bed(scene_from_file(folder.write("deep.csv", first + "0.00275,0.002,0.01,0.0004\n")));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("1 pairs overlap by more than a tenth of a radius, ids 1-2"),
              std::string::npos)
        << error.what();
  }
  // Planted, seen: pairs alone looked at (the run goes on, the sphere leaves the wall).
  const auto cut = folder.write("cut.csv", "x,y,z,radius\n0.0003,0.002,0.01,0.0004\n");
  try {
    initial_bed(scene_from_file(cut));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("1 particles and walls overlap by more than a tenth of a radius, ids 1 with"),
              std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(initial_bed(scene_from_file(cut, "[dem]\nengine = \"none\"\n")));
}

TEST(InitialBed, AFrameBringsItsStateAndItsContacts) {
  const TemporaryFolder folder;
  const auto csv =
      folder.write("bed.csv", "x,y,z,radius\n0.002,0.002,0.01,0.0004\n0.0027999,0.002,0.01,0.0004\n");
  Bed saved = initial_bed(scene_from_file(csv));
  saved.velocity_m_s[1] = {0.1, 0.2, 0.3};
  saved.temperature_K[0] = 512;
  saved.time_s = 3;
  saved.step = 300;
  saved.contacts = {{1, -4, {1e-7, 0, 0}}, {1, 2, {0, 1e-7, 0}}};
  const fs::path frame = folder.write("frame.hdf", "");
  write_frame(frame, saved, {});
  const Bed same = initial_bed(scene_from_file(frame));
  EXPECT_EQ(same.velocity_m_s, saved.velocity_m_s);
  EXPECT_EQ(same.temperature_K, saved.temperature_K);
  EXPECT_EQ(same.contacts.size(), 2u);
  EXPECT_EQ(same.time_s, 0) << "a new run begins";
  EXPECT_EQ(same.step, 0);
  const Bed other_walls = initial_bed(scene_from_file(frame,
                                                      "[[polygon]]\nname = 'p'\nvertices_m = "
                                                      "[[0,0,0],[0.01,0,0],[0,0.004,0]]\n"));
  ASSERT_EQ(other_walls.contacts.size(), 1u) << "memory of walls that are not there is dropped";
  EXPECT_EQ(other_walls.contacts[0].second, 2);
}

}  // namespace
}  // namespace granrad
