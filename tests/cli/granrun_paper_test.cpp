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
