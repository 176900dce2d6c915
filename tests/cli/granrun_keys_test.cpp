// Every key of the files of both programs is explained to users; an example is copied whole.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "coupling/granrun/keys.h"
#include "coupling/granrun/new_scene.h"
#include "coupling/simulation/heat_scene.h"
#include "coupling/study/run_study.h"
#include "coupling/study/study.h"
#include "dem/base/error.h"
#include "dem/base/files/data_folder.h"
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

TEST(Keys, EveryKeyOfAStudy) {
  expect_explained(key_catalogue(read_study_keys), 60);
}

/// Every key that was read of `file`, by table and name, is in the catalogue.
void expect_catalogued(const TomlDocument& document, const std::vector<KnownTable>& tables,
                       const std::string& file) {
  std::set<std::string> known;
  for (const auto& table : tables) {
    known.insert(table.name);
    for (const auto& key : table.keys) known.insert(table.name + "." + key.use.name);
  }
  std::size_t read = 0;
  for (const auto& use : document.uses()) {
    if (!use.given) continue;
    ++read;
    const bool is_table = use.kind == KeyKind::table || use.kind == KeyKind::tables;
    const std::string name = is_table && use.table.empty() ? use.name : use.table + "." + use.name;
    EXPECT_TRUE(known.count(name)) << file << ": " << name << " is read but not in the catalogue";
  }
  EXPECT_GE(read, 5u) << file;
}

std::vector<std::filesystem::path> toml_files(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder() / folder))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  return files;
}

// A key read only where another key has an unusual value hides from the exploration; a file that has it shows it.
TEST(Keys, WhatScenesAndStudiesHaveIsInTheCatalogue) {
  const auto scenes = key_catalogue(read_scene_keys), studies = key_catalogue(read_study_keys);
  std::size_t count = 0;
  for (const auto& file : toml_files("scenes")) {
    auto document = TomlDocument::from_file(file);
    read_scene_keys(document);
    expect_catalogued(document, scenes, file.filename());
    ++count;
  }
  EXPECT_GE(count, 15u);
  for (const auto& file : toml_files("studies")) {
    auto document = TomlDocument::from_file(file);
    read_study(document, file);
    expect_catalogued(document, studies, file.filename());
  }
  // Every key of a study at once.
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "plug.toml") << "";
  std::ofstream(folder.path() / "claims.csv") << "";
  const auto all = folder.path() / "study.toml";
  std::ofstream(all) << R"([study]
title = "All"
scene = "plug.toml"
kind = "run"
set = ["a.b=1"]
unset = ["a.c"]
options = ["-v"]
quick = true
quick_set = ["a.b=2"]
seeds = [1, 2]
seed_key = "feed.seed"
[[vary]]
key = "feed.solid_fraction"
values = [0.1, 0.2]
name = "phi"
quick = ["phi-0.1"]
[[vary]]
keys = ["a.d", "a.e"]
texts = ["'1 mm'"]
[[vary]]
names = ["fine"]
set = [["a.f=1"]]
[[case]]
name = "goes_on"
start = "first"
[[case]]
name = "first"
[[group]]
name = "g"
from = ["first"]
kind = "trace"
[[group.case]]
name = "one"
[[group.vary]]
key = "a.g"
values = [true]
[[column]]
name = "double"
formula = "2 * x"
[[fit]]
name = "f"
x = "a"
y = "b"
form = "line"
group = "g"
x_min = 1
x_max = 2
[[figure]]
title = "t"
text = "words"
x = "a"
y = ["b"]
x_label = "a"
y_label = "b"
groups = ["g"]
history = ["first"]
particles = ["first"]
profiles = ["first"]
by = "a.g"
log_x = true
log_y = true
[[figure.curve]]
label = "theirs"
formula = "x"
[claims]
file = "claims.csv"
)";
  auto document = TomlDocument::from_file(all);
  read_study(document, all);
  expect_catalogued(document, studies, "study.toml");
  // ... and the catalogue knows no more than these.
  std::set<std::string> given;
  for (const auto& use : document.uses())
    if (use.given) given.insert(use.table + "." + use.name);
  for (const auto& table : studies)
    for (const auto& key : table.keys)
      if (table.name == "study" || table.name == "vary" || table.name == "figure" || table.name == "fit") {
        EXPECT_TRUE(given.count(table.name + "." + key.use.name) || key.use.name == "from" ||
                    key.use.name == "start")
            << table.name << "." << key.use.name << " is not in the study above; add it";
      }
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
