// Requirement: the words of scenes and files are the names of the enumerators; files of older versions stay readable, so
// the words are held here as they stand in the contracts.
#include "dem/base/toml/choice_names.h"

#include <gtest/gtest.h>

#include "coupling/simulation/radiation_source.h"
#include "coupling/study/study.h"
#include "dem/bed/wall.h"
#include "dem/scene/scene.h"

namespace granrad {
namespace {

using Words = std::vector<std::string>;

TEST(ChoiceNames, AreTheWordsOfScenesAndFiles) {
  EXPECT_EQ(wall_roles.all(), (Words{"isothermal", "adiabatic", "open", "excluded"}));
  EXPECT_EQ(engine_names.all(), (Words{"native", "liggghts", "none", "replay"}));
  EXPECT_EQ(radiation_names.all(), (Words{"none", "paths", "embree", "lines", "shading", "correlation"}));
  EXPECT_EQ(study_kinds.all(), (Words{"run", "validate", "measure", "trace", "fit", "command"}));
}

TEST(ChoiceNames, AreReadAsTheyAreWritten) {
  for (const auto role : {WallRole::isothermal, WallRole::adiabatic, WallRole::open, WallRole::excluded})
    EXPECT_EQ(wall_roles.value(to_string(role)), role);
  EXPECT_STREQ(to_string(WallRole::excluded), "excluded");
  EXPECT_FALSE(wall_roles.value("Open"));
  EXPECT_FALSE(wall_roles.value(""));
  EXPECT_FALSE(wall_roles.value("open "));
}

}  // namespace
}  // namespace granrad
