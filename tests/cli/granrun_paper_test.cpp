// Requirement: the quick part of the paper's study and of the validation book runs, judges every number, and names no
// case or quantity that does not exist.
#include "granrun.h"
#include "tests/source_dir.h"

using namespace granrad::cli;

namespace {

int count(const std::string& text, const std::string& what) {
  int n = 0;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
  return n;
}

}  // namespace

TEST(GranrunPaper, StudiesAreReadAndEveryCaseIsListed) {
  for (const char* name : {"li_2024.toml", "validation.toml"}) {
    Scratch scratch;
    const auto study = fs::path(granrad::source_dir()) / "data" / "studies" / name;
    const auto outcome =
        granrun(scratch, "study " + study.string() + " --list -o " + (scratch.root / "o").string());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(count(content(scratch.root / "o" / "jobs.txt"), "\n"), 20) << name;
  }
}

TEST(GranrunPaper, QuickPartAgreesWhereItDidLong) {
  Scratch scratch;
  const auto study = fs::path(granrad::source_dir()) / "data" / "studies" / "li_2024.toml";
  const auto folder = scratch.root / "paper";
  const auto outcome = granrun(scratch, "study " + study.string() + " --quick -o " + folder.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto judged = content(folder / "claims.csv");
  EXPECT_GE(count(judged, ",agrees,"), 8) << judged;
  EXPECT_GE(count(judged, ",differs,"), 5) << "where the paper and physics part";
  EXPECT_NE(content(folder / "report.html").find("Fig. 7c"), std::string::npos);
}

namespace {

const fs::path book_study = fs::path(granrad::source_dir()) / "data" / "studies" / "validation.toml";

/// Verdict of a claim in claims.csv, whose first cell is its id and whose verdict stands before the reason.
bool has_verdict(const std::string& judged, const std::string& id, const std::string& verdict) {
  const auto at = judged.find("\n" + id + ",");
  const auto end = judged.find('\n', at + 1);
  return at != std::string::npos &&
         judged.substr(at, end - at).find("," + verdict + ",") != std::string::npos;
}

}  // namespace

// Rows of the validation book that take a second, in CI. Planted: 28.2 for 28.15 in the claims (V11i differs).
TEST(GranrunPaper, QuickRowsOfTheBookAgree) {
  Scratch scratch;
  const auto folder = scratch.root / "book", book = scratch.root / "book.md";
  const std::string study = "study " + book_study.string() + " -q -o " + folder.string();
  for (const char* name : {"test/lens", "test/heating", "test/impacts"}) {
    const auto outcome = granrun(scratch, study + " --case " + name);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  // Tables of what is there; the rest is stopped before it starts.
  EXPECT_EQ(granrun(scratch, study + " --walltime 00:00:00 --book " + book.string()).code, 75);
  const auto judged = content(folder / "claims.csv");
  for (const char* id : {"V11h", "V11i", "V11j", "V11l", "V11m", "V11n", "V11o"})
    EXPECT_TRUE(has_verdict(judged, id, "agrees")) << id << "\n" << judged;
  EXPECT_TRUE(has_verdict(judged, "V4c1", "not run"));
  EXPECT_NE(content(book).find("A part of the study"), std::string::npos) << "a book in part says so";
}

TEST(GranrunPaper, QuickPartOfTheBookHasItsVerdictsLong) {
  Scratch scratch;
  const auto folder = scratch.root / "book";
  const auto outcome = granrun(scratch, "study " + book_study.string() + " --quick -q -o " + folder.string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto judged = content(folder / "claims.csv");
  for (const char* id :
       {"V1a", "V1b", "V1c", "V1d",  "V1e",  "V1f",  "V2a",  "V2b",  "V2c",  "V5a",  "V5b", "V6",
        "V9a", "V9b", "V9c", "V11a", "V11b", "V11c", "V11d", "V11e", "V11f", "V11g", "V11k"})
    EXPECT_TRUE(has_verdict(judged, id, "agrees")) << id << "\n" << judged;
  for (const char* id : {"V2d", "V2e", "V5c", "V5d", "V5e"})
    EXPECT_TRUE(has_verdict(judged, id, "differs")) << id << ": known to differ, and told so\n" << judged;
}
