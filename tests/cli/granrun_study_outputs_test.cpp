// Requirement: what a study makes of its cases, claims, fits and traces, is what they give; one written wrong is refused.
#include "small_study.h"

using namespace granrad;
using namespace granrad::cli;

TEST(GranrunStudy, ClaimsAndFitsAreJudgedAndSweepIsItsOldName) {
  SmallStudy study;
  study.write(
      "claims.csv",
      "id,quantity,class,place,claim,unit,reference,uncertainty,tolerance_pct,ours,why\n"
      "1,ratio,A,here,\"h with itself, twice\",,2,,0.1,{e/emissivity-1:h_wp_W_m2K} / {e/emissivity-1:h_wp_W_m2K} * 2,\n"
      "2,ratio,A,here,wrong,,3,,0.1,2 * {e/emissivity-1:h_wp_W_m2K} / {e/emissivity-1:h_wp_W_m2K},planted\n"
      "3,none,P,there,no way,,1,,,,nobody knows how\n5,ratio,E,here,who knows,,3,?,,{e/emissivity-1:h_wp_W_m2K},\n4,exponent,A,here,near 1,,1,,40,{fit rad:b},\n");
  const std::string text =
      "[sweep]\nscene = \"plug.toml\"\n[[group]]\nname = \"e\"\n[[group.vary]]\nkey = \"material.emissivity\"\n"
      "values = [0.2, 0.4, 0.7, 1]\n[[fit]]\nname = \"rad\"\nx = \"material.emissivity\"\ny = \"h_rad_W_m2K\"\n"
      "form = \"power\"\ngroup = \"e\"\n[claims]\nfile = \"claims.csv\"\n[[figure]]\ntitle = \"h\"\n"
      "x = \"material.emissivity\"\ny = [\"h_rad_W_m2K\"]\n[[figure.curve]]\nlabel = \"line\"\nformula = \"10 * x\"\n";
  study.write("study.toml", text);
  const auto outcome = granrun(study, "sweep " + study.file.string() + " -o " + study.folder.string() +
                                          " --book " + (study.root / "book.md").string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(study.folder / "sweep.csv"));
  const auto judged = content(study.folder / "claims.csv");
  EXPECT_NE(judged.find("1,ratio,A,here,\"h with itself, twice\",,2,0,2,,0,agrees"), std::string::npos)
      << judged;
  EXPECT_NE(judged.find(",differs,planted"), std::string::npos) << judged;
  EXPECT_NE(judged.find(",uncertainty unknown,"), std::string::npos) << judged;
  EXPECT_NE(judged.find("not reproducible as stated"), std::string::npos) << judged;
  const auto book = content(study.root / "book.md");
  EXPECT_NE(book.find("**differs**"), std::string::npos) << "failures stay in the book";
  EXPECT_NE(book.find("--case e/emissivity-1"), std::string::npos) << book;
  EXPECT_NE(book.find("Made by granrad "), std::string::npos) << book;
  EXPECT_NE(book.find(" (4 cases). "), std::string::npos) << book;

  study.write("claims.csv", "id,reference,ours\n1,2,{e/emissivity-3:h_wp_W_m2K}\n2,2,1 +\n");
  const auto bad = study.run(text);
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.err.find("there is no such case"), std::string::npos) << bad.err;
  EXPECT_NE(bad.err.find("claim 2"), std::string::npos) << bad.err;
}

// Planted: the factors of the first particle in place of the wall's; a mean of RMSEs for the largest.
TEST(GranrunStudy, RunsAreTracedAndTheTracesFitted) {
  SmallStudy study;
  study.write("claims.csv",
              "id,reference,uncertainty,ours\na,1,?,{traced/one:y_min:to_particles}\n"
              "b,1,?,{table/all:pp_rmse}\nc,1,?,{table/all:pw_rmse}\n");
  const auto outcome = study.run(
      "[study]\n[[group]]\nname = \"flow\"\nscene = \"plug.toml\"\n[[group.case]]\nname = \"one\"\n"
      "[[group]]\nname = \"traced\"\nkind = \"trace\"\noptions = [\"--rays\", \"500\"]\n"
      "[[group.case]]\nname = \"one\"\nfrom = [\"flow/one\"]\n"
      "[[group]]\nname = \"table\"\nkind = \"fit\"\noptions = [\"--form\", \"transmittance\"]\n"
      "[[group.case]]\nname = \"all\"\nfrom = [\"traced/one\"]\n"
      "[claims]\nfile = \"claims.csv\"\n");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto judged = read_csv(study.folder / "claims.csv", true);
  const auto ours = judged.numbers("ours");

  double sum = 0, files = 0;
  for (const auto& entry : fs::directory_iterator(study.folder / "traced" / "one")) {
    if (entry.path().extension() != ".h5") continue;
    const auto csv = study.root / "e.csv";
    const auto exported = granrad::cli::run(
        study, "vfgen", "export -q --to csv " + entry.path().string() + " -o " + csv.string());
    ASSERT_EQ(exported.code, 0) << exported.err;
    for (const auto& row : rows(csv))
      if (row.at("from_name") == "y_min" && row.at("to_name").rfind("particle_", 0) == 0)
        sum += std::stod(row.at("factor"));
    files += 1;
  }
  ASSERT_GT(files, 0);
  EXPECT_NEAR(ours[0], sum / files, 1e-6 * sum);  // six digits are printed

  const auto table = content(study.folder / "table" / "all" / "table.toml");
  const auto stated = [&](const std::string& key) {
    return std::stod(table.substr(table.find("\n" + key + " = ") + key.size() + 4));
  };
  EXPECT_NEAR(ours[1], stated("pp_rmse"), 1e-6 * ours[1]);
  EXPECT_NEAR(ours[2], stated("pw_rmse"), 1e-6 * ours[2]);
}

TEST(GranrunStudy, AStudyThatIsWrittenWrongIsRefused) {
  SmallStudy study;
  const auto refused = [&](const std::string& text, const std::string& why) {
    const auto outcome = study.run(text);
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_NE(outcome.err.find(why), std::string::npos) << text << "\n" << outcome.err;
    EXPECT_FALSE(fs::exists(study.folder)) << text;
  };
  refused("[study]\nscene = \"plug.toml\"\n", "has no cases");
  refused("[[case]]\nname = \"a\"\n", "has no scene");
  refused(two_cases + "[[case]]\nname = \"emissivity-1\"\n", "two cases are named");
  refused(two_cases + "[[case]]\nname = \"a\"\nstart = \"b\"\n", "needs b, which is no other case");
  refused(two_cases + "[[case]]\nname = \"a\"\nkind = \"walk\"\n", "must be one of");
  refused(two_cases + "[[vary]]\nnames = [\"a\"]\nset = [[\"b=1\"], [\"b=2\"]]\n", "names");
  refused(two_cases + "[[probe]]\nname = \"a\"\nfrom_m = 2\nto_m = 1\n", "from < to");
  refused(two_cases + "[[case]]\nname = \"a\"\ncolour = 1\n", "unknown key 'colour'");
}
