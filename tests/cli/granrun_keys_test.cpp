// Every key of the files of both programs is explained to users; an example is copied whole.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coupling/granrun/new_scene.h"
#include "coupling/simulation/heat_scene.h"
#include "dem/base/error.h"
#include "dem/base/toml/key_reference.h"
#include "fit/correlation/correlation.h"
#include "tests/temporary_folder.h"

namespace granrad {
namespace {

void expect_explained(const std::vector<KnownTable>& tables, std::size_t at_least) {
  std::size_t count = 0;
  for (const auto& table : tables) {
    EXPECT_TRUE(table.name.empty() || !table.meaning.empty())
        << "[" << table.name
        << "] has no meaning: give it where the table is read, as table({\"name\", \"Meaning\"})";
    for (const auto& key : table.keys) {
      ++count;
      EXPECT_FALSE(key.use.meaning.empty())
          << table.name << "." << key.use.name
          << " has no meaning: give it where the key is read, as number({\"name\", \"meaning\"}, ...)";
      EXPECT_FALSE(key.default_varies && key.use.otherwise.empty())
          << table.name << "." << key.use.name
          << " has a default that follows from other keys: say from which, as {\"name\", \"meaning\", \"default\"}";
    }
  }
  EXPECT_GE(count, at_least);
}

TEST(Keys, EveryKeyOfAScene) {
  expect_explained(key_catalogue([](TomlDocument& document) {
                     const Scene flow = read_scene(document);
                     read_heat_scene(document, flow);
                   }),
                   90);
}

TEST(Keys, EveryKeyOfATable) {
  expect_explained(key_catalogue([](TomlDocument& document) { read_correlation(document, "table"); }), 20);
}

TEST(Keys, AnExampleIsCopiedWithWhatItNeeds) {
  const TemporaryFolder folder;
  const auto scene = folder.path() / "my" / "plug.toml";
  ASSERT_EQ(new_scene(scene, "plug"), exit_ok);
  EXPECT_TRUE(std::filesystem::exists(scene.parent_path() / "alumina.toml"));
  EXPECT_NO_THROW(read_case(scene, {}));
  EXPECT_THROW(new_scene(scene, "plug"), InputError);  // nothing is overwritten
  EXPECT_THROW(new_scene(folder.path() / "other.toml", "plugg"), InputError);
}

TEST(Keys, MaterialsAreFoundAmongTheInstalledData) {
  const TemporaryFolder folder;
  const auto scene = folder.path() / "plug.toml";
  new_scene(scene, "plug");
  std::filesystem::remove(folder.path() / "alumina.toml");
  EXPECT_EQ(read_case(scene, {}).flow.materials[0].density_kg_m3, 3984);
}

}  // namespace
}  // namespace granrad
