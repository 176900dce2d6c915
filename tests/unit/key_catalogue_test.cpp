// A catalogue of keys, collected from a reader alone, has every key the reader can ask for, with its range, default,
// meaning and the choices it depends on.
#include "dem/base/toml/key_catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dem/base/error.h"
#include "dem/base/toml/key_reference.h"

namespace granrad {
namespace {

/// Every way in which readers of the programs hide keys: absent tables, choices below choices, has(), lists.
void read(TomlDocument& document) {
  auto root = document.root();
  root.number({"end_s", "time to run"}, {.unit = "s", .min = 0, .min_exclusive = true});
  auto feed = root.table({"feed", "What enters"});
  if (feed.present()) {
    if (feed.choice({"kind", "of feed"}, {"plug", "hopper"}) == "hopper") {
      feed.integer({"count", "particles"}, 1, 1000);
      if (feed.boolean({"refill", "again"}, true))
        feed.number({"rate", "per time"}, {.unit = "1/s", .min = 0}, 2.5);
    }
    if (feed.has("note")) feed.string({"note", "anything"});
  }
  for (auto& wall : root.tables({"wall", "Walls"}))
    for (const char* face : {"in", "out"})
      wall.table({face, "A face", {}, "FACE"}).vec3({"at_m", "place"}, {.unit = "m"});
  if (root.table("out").number({"every_s", "time between rows", "end_s / 100"}, {.unit = "s", .min = 0}, 7) >
      1e9)
    throw InputError("never");
}

const KnownKey* find(const std::vector<KnownTable>& tables, const std::string& table,
                     const std::string& key) {
  for (const auto& t : tables)
    for (const auto& k : t.keys)
      if (t.name == table && k.use.name == key) return &k;
  return nullptr;
}

TEST(KeyCatalogue, FindsEveryKeyWhereverItHides) {
  const auto tables = key_catalogue(read);
  for (const auto& [table, key] : {std::pair{"", "end_s"},
                                   {"feed", "kind"},
                                   {"feed", "count"},
                                   {"feed", "refill"},
                                   {"feed", "rate"},
                                   {"feed", "note"},
                                   {"wall.FACE", "at_m"},
                                   {"out", "every_s"}})
    EXPECT_TRUE(find(tables, table, key)) << table << "." << key;
  const auto wall =
      std::find_if(tables.begin(), tables.end(), [](const auto& t) { return t.name == "wall"; });
  ASSERT_NE(wall, tables.end());
  EXPECT_TRUE(wall->list);
  EXPECT_EQ(wall->meaning, "Walls");
}

TEST(KeyCatalogue, KnowsDefaultsNeedsAndConditions) {
  const auto tables = key_catalogue(read);
  EXPECT_EQ(default_text(*find(tables, "", "end_s")), "required");
  EXPECT_EQ(default_text(*find(tables, "feed", "rate")), "2.5");
  EXPECT_EQ(default_text(*find(tables, "out", "every_s")), "end_s / 100");
  EXPECT_EQ(default_text(*find(tables, "feed", "note")), "");  // has() comes first, so it may be left out
  EXPECT_EQ(find(tables, "feed", "count")->when, "kind = \"hopper\"");
  EXPECT_EQ(find(tables, "feed", "kind")->when, "");
  EXPECT_EQ(values_text(find(tables, "feed", "count")->use), "integer in [1, 1000]");
}

TEST(KeyCatalogue, PrintsWhatEditorsAndPeopleRead) {
  const auto tables = key_catalogue(read);
  const auto page = reference_markdown(tables);
  EXPECT_NE(page.find("| `rate` | number >= 0 | 1/s | `2.5` | per time; *with* `kind = \"hopper\"` |"),
            page.npos)
      << page;
  EXPECT_NE(page.find("## `[[wall]]`"), page.npos);
  const auto schema = reference_schema(tables, "A test");
  EXPECT_NE(schema.find("\"exclusiveMinimum\": 0"), schema.npos);
  EXPECT_NE(reference_toml(tables, "A test").find("# rate = 2.5"), std::string::npos);
}

TEST(KeyCatalogue, DefaultsInForceAreCommentsBesideWhatIsGiven) {
  auto document = TomlDocument::from_string(
      "end_s = 3\n[feed]\nkind = \"hopper\"\ncount = 4\n[[wall]]\nin = {at_m = [0, 0, 1]}\nout = {at_m = [1, 0, 0]}\n",
      "f.toml");
  read(document);
  document.finish();
  const auto text = document.text_with_defaults();
  EXPECT_NE(text.find("\nkind = 'hopper'\n"), text.npos) << text;
  EXPECT_NE(text.find("\n# refill = true\n"), text.npos) << text;
  EXPECT_NE(text.find("\n# rate = 2.5\n"), text.npos) << text;
  EXPECT_NE(text.find("[out]\n# every_s = 7"), text.npos) << text;
  auto again = TomlDocument::from_string(text, "g.toml");  // comments change nothing
  read(again);
  again.finish();
  EXPECT_EQ(again.text_with_defaults(), text);
}

}  // namespace
}  // namespace granrad
